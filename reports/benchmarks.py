"""The part of the page of verification on speed: what ci/bench recorded last, as charts and tables of marks and whole runs."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from reports.charts.parts import draw_events, draw_rates, draw_scaling
from reports.figures import Figure as Drawn
from reports.figures import Section, Table
from reports.shown import Shown
from reports.words import NONE, listed, mechanics_name, number
from verification.benchmarks.record import GROWTH, SPEEDS, Figure, Record, costs, exponent, rate, records_in

RECORDS = Path("verification") / "benchmarks" / "records"  # from the folder that the folder of runs stands in
SHAPES = {"bspline2": "quadratic B-spline", "gimp": "uGIMP", "linear": "linear"}
MARKED = re.compile(r"step/(\w+)/.*/cells80/threads(\d)")  # figures whose marks stand beside the bars
CURVES = ("updated", "total", "Experiment 1, soft interface")  # of the patterns of GROWTH
EVENTS = {"growth": "growth", "start": "start of a run", "contact": "contact", "flow": "flow step", "write": "writing"}
TOLD = ("growth/explicit/updated", "growth/explicit/total", "growth/quasistatic/cells80")  # by the title
Figures = Sequence[Figure]


def section(runs: Path) -> Section | None:
    """The part of the page, from the newest record of any machine; None where nothing was recorded."""
    record = newest(runs.resolve().parent / RECORDS)
    if record is None:
        return None
    good = [figure for figure in record.figures if figure.values]
    rates, scaling, events = rate_figure(good), scaling_figure(good), event_figure(good)
    drawn = (("rates", rates, draw_rates, rates.panels), ("scaling", scaling, draw_scaling, scaling.panels),
             ("events", events, draw_events, events.events))
    figures = [Drawn(f"benchmark_{name}", data, draw, f"benchmark_{name}") for name, data, draw, any_ in drawn if any_]
    tables = [table for table in (mark_table(record.marks), run_table(record.figures)) if table["rows"]]
    short = [mark["what"] for mark in record.marks if not mark["reached"]]
    reached = f"{len(record.marks) - len(short)} of {len(record.marks)} marks are reached" + (f"; not {listed(short)}" if short else "")
    build = record.build
    return Section(title="Speed", intro=f"{reached}. Recorded {record.date[:10]} by ci/bench on {record.machine.words};"
                   f" {build.compiler} {build.flags}; strata {build.version} {build.commit}.", figures=figures, tables=tables)


def newest(folder: Path) -> Record | None:
    """The last record of the machine that recorded last."""
    return max((records[-1] for path in sorted(folder.glob("*.jsonl")) if (records := records_in(path))), key=lambda one: one.date, default=None)


def rate_figure(figures: Figures) -> Shown:
    """Rates (million particle-steps a second, with least and most, and share of the cores' peak) of the kinematics, shapes, kernels and threads
    that were measured on the block of 80 x 80 cells, and the marks by threads."""
    known, panels, best = {figure.name: figure for figure in figures}, [], []
    marks = {found.groups(): wanted for _, name, wanted in SPEEDS if (found := MARKED.fullmatch(name))}
    for kinematics in ("updated", "total"):
        shapes = []
        for shape, words in SHAPES.items():
            names = [(kernels, threads, f"step/{kinematics}/{shape}/flip/{kernels}/points4/cells80/threads{threads}")
                     for kernels in ("fast", "plain") for threads in (1, 2)]
            bars = [Shown(kernels=kernels, threads=threads, rate=rate(one), low=1e-6 / max(one.values), high=1e-6 / min(one.values),
                          share=one.share_of_peak) for kernels, threads, name in names if (one := known.get(name))]
            shapes += [(words, bars)] if bars else []
        if shapes:
            panels.append(Shown(heading=f"kinematics = {kinematics}", shapes=shapes,
                                marks={int(threads): value for (name, threads), value in marks.items() if name == kinematics}))
            single = [bar.rate for _, bars in shapes for bar in bars if bar.threads == 1]
            best += [f"{number(max(single), 3)} million with {kinematics} kinematics"] if single else []
    return Shown(title=f"Particle-steps a second on one thread: up to {listed(best)}" if best else "No rates", panels=panels)


def scaling_figure(figures: Figures) -> Shown:
    """How costs (s) grow with points: explicit steps by kinematics, and whole runs without inertia, each panel with the exponent that it may have."""
    curves = [Shown(label=label, points=points, seconds=seconds, exponent=exponent(points, seconds))
              for label, (_, pattern, _) in zip(CURVES, GROWTH) if len(found := costs(figures, pattern)) > 1 for points, seconds in [zip(*found)]]
    groups = (("a step with inertia, 1 thread", 1.0, CURVES[:2]), ("a run without inertia", 1.5, CURVES[2:]))
    panels = [Shown(heading=heading, curves=own, allowed=allowed) for heading, allowed, labels in groups
              if (own := [curve for curve in curves if curve.label in labels])]
    told = [f"{curve.exponent:.2f} ({curve.label})" for curve in curves]
    return Shown(title=f"Costs grow with the number of points to the power {listed(told)}", panels=panels)


def event_figure(figures: Figures) -> Shown:
    """Events and the measurement of tips (name; s: median, least, most), the dearest first."""
    words = {one.name: _event_words(one.name.split("/")) for one in figures}
    found = [(words[one.name], one.median, min(one.values), max(one.values)) for one in figures if words[one.name]]
    told = [f"{number(1e3 * one.median, 2)}\u00a0ms ({words[name].split(': ')[1]})" for name in TOLD for one in figures if one.name == name]
    title = f"An increment of growth costs {listed(told)}" if told else "What events cost"
    return Shown(title=title, events=sorted(found, key=lambda item: -item[1]))


def _event_words(parts: list[str]) -> str:
    """An event's name in words; nothing for what is none."""
    if parts == ["stage", "measure_tips", "threads1"]:
        return "J and K at a tip"
    rest = [f"{part[5:]}² cells" if part.startswith("cells") else mechanics_name(part) for part in parts[1:]]
    return f"{EVENTS[parts[0]]}: {', '.join(rest)}" if parts[0] in EVENTS else ""


def mark_table(marks: Sequence[dict[str, Any]]) -> Table:
    """What was to be reached on two cores, and what was found."""

    def told(value: float | None, unit: str) -> str:
        """A value with its unit."""
        return NONE if value is None else f"{number(value, 3)} {unit}".rstrip()

    rows = [[mark["what"], told(mark["found"], mark["unit"]), f"{'at least' if mark['at_least'] else 'at most'} {told(mark['wanted'], mark['unit'])}",
             "reached" if mark["reached"] else "falls short", mark["note"]] for mark in marks]
    return Table(title="Marks on two cores", header=["What", "Found", "Wanted", "", ""], rows=rows,
                 marked=[k for k, mark in enumerate(marks) if not mark["reached"]])


def run_table(figures: Figures) -> Table:
    """Whole batches of experiments, runs alone (not those of a batch), memory a point where it was recorded."""
    shown = [one for one in figures if one.name.startswith(("crack/", "whole/", "memory/")) or one.per == "all variants"]
    rows = []
    for one in shown:
        error = one.about.get("error")
        value, spread = (f"{number(one.median, 3)} {one.unit}", f"{100.0 * one.spread:.0f}\u00a0%") if one.values else (NONE, "")
        rows.append([one.name, value, one.per, str(len(one.values)), spread if len(one.values) > 1 else "",
                     one.problem or (f"K_I {100.0 * error:+.3f}\u00a0%" if error is not None else "")])
    return Table(title="Whole runs", header=["What", "Median", "of", "Repetitions", "Spread", ""], rows=rows,
                 marked=[k for k, one in enumerate(shown) if not one.values],
                 note="Spread: (most − least)/median. A run that did not come to its end has no time.")
