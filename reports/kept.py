"""Sections of kept records: what each ingredient of an experiment is worth, as ci/ablate kept it, as a chart and what each scene needs in words; beside
experiments, what runs of Rubin's fracture gave beside what was measured, and which way Wu's fracture had to go; the work-precision chart, error against wall time for
every method, and what follows for who uses the solver."""

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from reports.charts.precision import draw_front
from reports.charts.records import draw_ablation, draw_measured
from reports.figures import Figure, Table, Topic, words_of
from reports.words import NONE, Shown, experiment_name, listed, minus, mpa, number, plain, sentence, share, wall_time
from verification.ablation.table import CHANGES, NEEDED, SPARED, WANTED, Table as Kept, Tried, read_all
from verification.harness import store
from verification.harness.load import NoReference, value
from verification.measured import rubin
from verification.precision.measure import GROUPS, TOLERANCES, Dot, Panel, cheapest, choice_for, nearest, panel_of, pareto, run_at
from verification.precision.problem import DATA, STRATA, Method, Sheet, read_sheet
from verification.precision.problems import PROBLEMS

_INTERFACES = {"interface_1": "an interface that acts", "interface_2": "a second one"}  # rows that scenes share, whatever the law


def needs_topic(folder: Path) -> Topic | None:
    """The section of the front page from the kept tables; None where there are none."""
    kept = read_all(folder)
    if not kept:
        return None
    data = ablation_figure(kept)
    rows = [[f"{experiment_name(one.experiment)}, {plain(one.variant)}",
             *(listed([line.label for line in lines]) or NONE for lines in (one.needs(), one.spared(True))), f"{number(one.cpu_s, 3)}\u00a0s"] for one in kept]
    return Topic("needs", "What a scene needs", [f"{data.title}."], "ci/ablate", listed(sorted({one.version for one in kept})),
                 Figure("ablation", data, draw_ablation, "ablation", "ci/ablate"),
                 [Table(f"What each scene needs for {share(WANTED)}", ["Scene", "needs", "does not need", "CPU time"], rows)])


def ablation_figure(kept: Sequence[Kept]) -> Shown:
    """What is drawn: the tables in which more than the interfaces was left out.

    Rows of ingredients, columns of scenes. A cell, None where the scene does not have the ingredient: share (None where that cannot be said), whether
    something else happens, time over the scene's own.
    """
    whole = [one for one in kept if one.extent != "interfaces"] or list(kept)
    labels: dict[str, str] = {}
    for one in sorted(whole, key=lambda one: -sum(line.id in _INTERFACES for line in one.lines)):  # rows of all interfaces one below the other
        for line in one.lines:
            labels.setdefault(line.id, _INTERFACES.get(line.id, line.label))
    rows = [(label, [next((Shown(share=line.largest, changes=line.verdict == CHANGES, time=line.cpu_s / one.cpu_s) for line in one.lines
                           if line.id == name and line.applies), None) for one in whole]) for name, label in labels.items()]
    columns = [f"{experiment_name(one.experiment).replace('Experiment', 'Exp.')} {plain(one.variant)}" for one in whole]
    return Shown(title=finding(whole), columns=columns, rows=[row for row in rows if any(row[1])])


def finding(kept: Sequence[Kept]) -> str:
    """What all scenes need for 1 %, and what none does."""
    lines: dict[str, list[Tried]] = {}
    for line in (line for one in kept for line in one.lines if line.applies and not line.id.startswith("interface")):
        lines.setdefault(line.id, []).append(line)
    always, never = ([found[0].label for found in lines.values() if all(line.verdict in verdicts for line in found)]
                     for verdicts in ((NEEDED, CHANGES), (SPARED,)))
    told = [f"every scene that has them needs {listed(always)}"] if always else []
    told += [f"none needs {listed(never)}"] if never else []
    return f"For {share(WANTED)}: " + ("; ".join(told) if told else "what a scene needs differs from one to the next")


DRAWN = ("plain", "closing_stress", "tough")  # the finest run of each
SCALES = {rubin.LENGTH: ("mm", 1e3), rubin.WELL: ("MPa", 1e-6), rubin.OPENING: ("µm", 1e6)}
BORDERS_M, STRESS_PA, TOUGHNESS = [-0.025, 0.025], [5.0e6, 7.0e6, 11.2e6], 1.2e6  # Wu et al. 2008, as verification/measured/README.md has them
HELD = 1e9  # a toughness that no tip passes


def beside_topic(path: Path) -> Topic | None:
    """The section of the front page from the kept record; None where there is none."""
    record = store.read(rubin.Record, path)
    if record is None:
        return None
    data = measured_figure(record)
    tables = [table_of(record)]
    says = [f"{data.title}. {words_of('measured_method')}"]
    try:
        fronts = wu_fronts()
        says.append(words_of("wu", fronts=fronts, margin=min(one.up_Pa - one.down_Pa for one in fronts)))
        rows = [[minus(f"{one.bottom_mm:.0f} to {one.top_mm:.0f}"), mpa(one.down_Pa, 1), mpa(one.up_Pa, 1)] for one in fronts]
        tables.append(Table("Wu et al. 2008: pressure at which each tip of a front goes on", ["Front (mm)", "lower tip, into 5 MPa", "upper tip, into 11.2 MPa"], rows))
    except (NoReference, OSError):  # the program is not built: the rest is from records
        pass
    return Topic("measured", "Beside measurements", says, "ci/verify", record.version, Figure("measured", data, draw_measured, "measured", "ci/verify"), tables)


def wu_fronts() -> Sequence[Shown]:
    """Wu's fronts from the second on, lowest and highest points (mm), with the even pressures (Pa) at which a crack of plane strain between them goes on
    downwards and upwards, by strata-reference."""
    found = []
    for y in list(rubin.table("wu2008_fronts_mm").values())[1::2][-2::-1]:
        bottom, top = -float(np.nanmax(y)), -float(np.nanmin(y))
        down, up = (value("layered_height", "start_Pa", border_m=BORDERS_M, stress_Pa=STRESS_PA, toughness_Pa_sqrt_m=tough, bottom_m=1e-3 * bottom, top_m=1e-3 * top)
                    for tough in ([TOUGHNESS, HELD, HELD], [HELD, HELD, TOUGHNESS]))
        found.append(Shown(bottom_mm=bottom, top_mm=top, down_Pa=down, up_Pa=up))
    return found


def measured_figure(record: rubin.Record) -> Shown:
    """A panel a quantity: measured points, and the course of some runs, the finest of each."""
    finest = {one.name: one for one in record.results}
    panels = []
    for name, (unit, factor) in SCALES.items():
        at, values = rubin.measured(name)
        curves = [(plain(which), finest[which].curves["t_s"], [factor * value for value in finest[which].curves[name]]) for which in DRAWN if which in finest]
        lowered = [factor * (value - rubin.reading_without_fluid_Pa()) for value in values] if name == rubin.WELL else []
        panels.append(Shown(heading=name.capitalize(), unit=unit, times=list(at), points=[factor * value for value in values], lowered=lowered, curves=curves))
    return Shown(title=errors_told(finest), panels=panels, zero_MPa=1e-6 * rubin.reading_without_fluid_Pa(), from_s=rubin.LATE_S, cell_mm=1e3 * finest["plain"].cell_m)


def errors_told(finest: dict[str, rubin.Result]) -> str:
    """The plain run's errors, and that of the pressure were all gauges off by what one shows."""
    length, opening, pressure = (finest["plain"].errors[name].late for name in (rubin.LENGTH, rubin.OPENING, rubin.WELL))
    return words_of("measured_finding", from_s=rubin.LATE_S, length=length, opening=opening, pressure=pressure, zero=finest["gauges_from_zero"].errors[rubin.WELL].late)


def table_of(record: rubin.Record) -> Table:
    """A row a variant and size: errors from 15 s on, and where the run is as long as the fracture was."""
    header = ["run", "what it does", "cells", *rubin.COLUMNS, "as long sooner by", "time"]
    rows = []
    for one in (*record.results, rubin.geos()):
        cells = [share(error.late) + (f" ({share(error.same_length)})" if math.isfinite(error.same_length) else "") for error in one.errors.values()]
        took = wall_time(one.wall_s) if math.isfinite(one.wall_s) else NONE
        rows.append([plain(one.name), one.says, f"{1e3 * one.cell_m:.2g} mm", *cells, minus(f"{one.early_s[0]:.1f} to {one.early_s[1]:.1f} s"), took])
    return Table(f"Rubin 1983: mean errors from {rubin.LATE_S:g} s on", header, rows, words_of("measured_note"))


LEAST_SHOWN = 1e-5  # errors below are drawn there


def measurements(folder: Path = DATA) -> Shown | None:
    """All that was measured: panels, the machine in words, notes on what is odd; None without data, ValueError where they cannot be read."""
    sheets = [(problem, sheet) for problem in PROBLEMS if (sheet := read_sheet(problem.name, folder)) is not None and sheet.points]
    if not sheets:
        return None
    panels = tuple(panel_of(problem, wanted, sheet) for problem, sheet in sheets for wanted in problem.wanted)
    measured = [sheet for _, sheet in sheets]
    version = listed(sorted({str(sheet.machine["version"]) for sheet in measured}))
    return Shown(panels=panels, recipe=recipe(measured), notes=notes(measured), version=version)


def recipe(sheets: Sequence[Sheet]) -> tuple[tuple[str, str], ...]:
    """Hardware and method of the measurements, as names with words."""
    points = [point for sheet in sheets for point in sheet.points]
    dates = sorted(point.date for point in points)

    def each(*keys: str) -> str:
        """All that the machines say under some keys."""
        return "; ".join(dict.fromkeys(", ".join(str(sheet.machine[key]) for key in keys) for sheet in sheets))

    return (
        ("processor", f"{each('processor')}, {each('cores')} cores, {each('caches')}, {each('memory_GB')} GB; {each('system')}"),
        ("compiler", f"{each('compiler')}, {each('flags')}"), ("solver", f"strata {each('version')}, revision {each('revision')}"),
        ("measured", f"{dates[0]} to {dates[-1]} UTC, {len(points)} points, {sum(len(point.wall_s) for point in points)} runs that count"),
        ("recipe", words_of("precision_recipe")),
    )


def notes(sheets: Sequence[Sheet]) -> tuple[str, ...]:
    """What is odd about the data: disturbed runs, single runs, several machines or versions."""
    points = [point for sheet in sheets for point in sheet.points]
    odd = {"were disturbed by something else on the machine": sum(point.disturbed for point in points),
           "are of a single run": sum(point.once for point in points)}
    found = [f"{count} of {len(points)} points {words}" for words, count in odd.items() if count]
    for key in ("processor", "revision"):
        if len(several := sorted({str(sheet.machine[key]) for sheet in sheets})) > 1:
            found.append(f"problems were measured with different {key}: {', '.join(several)}")
    missing = [problem.name for problem in PROBLEMS if all(sheet.problem != problem.name for sheet in sheets)]
    return (*found, *([f"not measured: {', '.join(missing)}"] if missing else []))


# --- figures
def look_of(method: Method) -> Shown:
    """How a method is drawn, in words that the chart knows: family (a colour), shape (a mark), graded (filled), dashes."""
    setting = method.setting
    if method.program != STRATA or setting is None:
        return Shown(family="elements", shape="elements", filled=True, dashes="-")
    family = "quasistatic" if setting.mechanics == "quasistatic" else "total" if setting.kinematics == "total" else "updated"
    usual = (setting.points, setting.courant, setting.kernels, setting.further) == (4, 0.5, "", ()) and setting.transfer in ("", "flip")
    dashes = "-" if usual else {9: ":", 16: "--"}.get(setting.points, "-.")
    return Shown(family=family, shape=setting.shape, filled=max(setting.graded, setting.beyond_m) > 0.0, dashes=dashes)


def bounds(values: Iterable[float]) -> tuple[float, float]:
    """Smallest and largest of positive numbers; NaN without any."""
    known = [value for value in values if value > 0.0 and math.isfinite(value)]
    return (min(known), max(known)) if known else (math.nan, math.nan)


def panel_shown(panel: Panel, spread: tuple[float, float] | None = None) -> Shown:
    """A wanted number as it is drawn: curves, Pareto front, failures, the reference's uncertainty; `spread`: of times (s) of all panels.

    A curve's errors are as judged; `lucky`: as measured where they are much smaller by luck, else None.
    """

    def places(dots: Iterable[Dot]) -> list[tuple[float, float]]:
        """Times and errors of dots."""
        return [(dot.time_s, max(dot.judged, LEAST_SHOWN)) for dot in dots]

    curves = []
    for method in panel.problem.methods:
        if own := [dot for dot in panel.dots if dot.method is method]:
            times_s, errors = map(list, zip(*places(own)))
            curves.append(Shown(label=method.label, look=look_of(method), main=method.main, times_s=times_s, errors=errors,
                                lucky=[max(abs(dot.error), LEAST_SHOWN) if dot.lucky else None for dot in own]))
    return Shown(
        heading=panel.wanted.title, curves=curves, front=tuple(map(list, zip(*places(pareto(panel.of()))))) or ([], []),
        chosen=places(filter(None, (cheapest(panel.of(), error) for error in TOLERANCES[1:]))),
        lacks=[Shown(look=look_of(lack.method), status=lack.status, time_s=lack.time_s) for lack in panel.lacks],
        lacks_words=", ".join(f"{count} {status}" for status, count in Counter(lack.status for lack in panel.lacks).items()),
        uncertainty=panel.uncertainty, times_s=spread or bounds(dot.time_s for dot in panel.dots),
        errors=bounds(error for curve in curves for error in (*curve.errors, *filter(None, curve.lucky))),
    )


def front_figure(panels: Sequence[Panel]) -> Shown:
    """All panels side by side, times on a common scale."""
    spread = bounds(dot.time_s for panel in panels for dot in panel.dots)
    return Shown(title=chart_finding(panels), panels=[panel_shown(panel, spread) for panel in panels])


def chart_finding(panels: Sequence[Panel]) -> str:
    """What the chart shows, in a sentence."""
    found = [dot for panel in panels if (dot := cheapest(panel.of(), 0.01)) is not None]
    still = sum(dot.method.setting is not None and dot.method.setting.mechanics == "quasistatic" for dot in found)
    return words_of("precision_finding", times=[dot.time_s for dot in found], panels=len(panels), still=still)


# --- tables
def chart_table(panels: Sequence[Panel]) -> list[list[str]]:
    """The table that users need: for each panel and group that has anything (the first has a row anyway) the cheapest way to each tolerance."""

    def cell(own: Sequence[Dot], error: float) -> str:
        """The cheapest way to a tolerance, or that there is none."""
        dot = cheapest(own, error)
        told = dot or nearest(own)
        words = f"{told.name}: {wall_time(told.time_s)}" if told else ""
        return f"{words} ({share(dot.judged)})" if dot else f"none reaches it; best {share(told.judged)}: {words}" if told else "nothing was measured"

    return [[panel.wanted.title, group, *(cell(own, error) for error in TOLERANCES)]
            for panel in panels for group in GROUPS if (own := panel.of(group)) or group == GROUPS[0]]


def lack_rows(panels: Sequence[Panel]) -> list[list[str]]:
    """Every method and size that has nothing to show, with the reason; sizes of a method with the same reason together."""
    groups: dict[tuple[str, str, str, str], list[str]] = {}
    for panel in panels:
        for lack in panel.lacks:
            groups.setdefault((panel.wanted.title, lack.method.label, lack.status, lack.reason), []).append(lack.level)
    return [[title, label, listed(levels), status, reason] for (title, label, status, reason), levels in groups.items()]


def recommendations(panels: Sequence[Panel]) -> list[str]:
    """What the chart says each experiment should be run with, and why, a sentence or two a problem."""
    told = []
    for problem in dict.fromkeys(panel.problem.name for panel in panels if panel.problem.experiments):
        own = [panel for panel in panels if panel.problem.name == problem]
        if (choice := choice_for(own, TOLERANCES[1])) is not None:
            method, level = own[0].problem.shipped
            label = next((one.label for one in own[0].problem.methods if one.name == method), method)
            told.append(words_of("precision_advice", experiments=list(map(str, own[0].problem.experiments)), dots=choice[0], within=choice[1], errors=_errors(choice[0], own),
                                 label=label, level=level, shipped=(found := run_at(own, method, level)), shipped_errors=_errors(found or (), own)))
    return told


def _errors(dots: Sequence[Dot], panels: Sequence[Panel]) -> str:
    """The errors of a run in all panels."""
    return listed([f"{share(dot.judged)} ({panel.wanted.title})" for dot, panel in zip(dots, panels)])


def chart_topic(folder: Path = DATA) -> Topic | None:
    """The section of the front page; None without data, ValueError where they cannot be read."""
    found = measurements(folder)
    if found is None:
        return None
    tables = [Table("Cheapest way to each accuracy", ["Quantity", "Method", *(f"within {share(error)}" for error in TOLERANCES)], chart_table(found.panels)),
              Table("Refused, failed, too long, without a value", ["Quantity", "Method", "Sizes", "How it ended", "Why"], lack_rows(found.panels)),
              Table("How it was measured", ["", ""], found.recipe, " ".join(sentence(note) for note in found.notes))]
    data = front_figure(found.panels)
    return Topic("precision", "Error against time: which method for which accuracy", [f"{data.title}.", *recommendations(found.panels)], "ci/chart", found.version,
                 Figure("precision", data, draw_front, "precision", "ci/chart"), tables)
