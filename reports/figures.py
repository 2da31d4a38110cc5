"""The catalogue of figures: which data each is made from, what draws it, and its caption."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from reports.charts.choice_chart import draw_choice
from reports.charts.crack_chart import draw_copies, draw_pressure
from reports.charts.height_chart import draw_heights
from reports.charts.ledger_chart import draw_ledger, draw_variants
from reports.charts.profile_chart import draw_paths, draw_profiles
from reports.charts.style import save
from reports.choices import ChoiceFigure, choice_figure
from reports.crack import CopiesFigure, PressureFigure, copies_figure, divided, index_when_tip_passes, pressure_figure
from reports.curves import (
    HeightFigure, PathFigure, ProfileFigure, height_figure, held, path_figure, profile_figure,
)
from reports.layout import layout_of
from reports.ledger import LedgerFigure, VariantFigure, ledger_figure, marks_of, variant_figure
from reports.runs import NotAvailable, Run, lead_of, mechanics_in, output_times
from reports.words import listed, mechanics_name, metres, mpa, plain
from verification.harness.choices import Point

MAGNIFIED = 300.0  # of openings in Fig 1: a millimetre becomes a third of a 1 m cell


@dataclass(frozen=True)
class Spec:
    """How one figure comes about."""

    name: str
    label: str
    experiment: int  # 0: of no single experiment
    part: str  # where on the page: "method", "experiment", "energy", "choice" or "variants"
    prepare: Callable[[], Any]
    draw: Callable[[Any], Any]
    caption: Callable[[Any], str]
    runs: Sequence[Run] = ()  # those drawn, whose marks the caption tells


@dataclass
class Made:
    """A figure on the page, or why there is none."""

    name: str
    label: str
    experiment: int
    part: str = "experiment"
    title: str = ""
    caption: str = ""
    reason: str = ""
    defect: str = field(default="", repr=False)

    @property
    def ok(self) -> bool:
        """Whether there is a figure."""
        return not self.reason


def catalogue(runs: list[Run], points: Sequence[Point] = ()) -> list[Spec]:
    """Every figure of the page, in order; those after the study's eight are numbered as they come."""
    of = _by_number(runs)
    specs = [
        Spec("fig1", "Figure 1", 0, "method", lambda: copies_figure(_crack_choices(of), MAGNIFIED), draw_copies, _copies_words),
        Spec("fig2", "Figure 2", 0, "method", lambda: _pressure_choice(of), draw_pressure, _pressure_words),
    ]
    for number in (1, 2, 3, 4):
        group = of.get(number, [])
        specs.append(Spec(f"fig{number + 2}", f"Figure {number + 2}", number, "experiment", _bind(height_figure, group),
                          draw_heights, _height_words(group), _drawn(group)))
    specs.append(Spec("fig7", "Figure 7", 4, "experiment", _bind(profile_figure, of.get(4, [])), draw_profiles, _profile_words,
                      _drawn(of.get(4, []))))
    sideways = [of.get(number, []) for number in (5, 6)]
    specs.append(Spec("fig8", "Figure 8", 5, "experiment", _bind(path_figure, sideways), draw_paths, _path_words,
                      _drawn([run for group in sideways for run in group])))
    for point in points:
        specs.append(Spec(f"choice_{point.id}", "", 0, "choice", _bind2(choice_figure, point, runs), draw_choice, _choice_words))
    groups = [of[number] for number in sorted(of)]
    present = mechanics_in(runs) or (lead_of(runs),)
    for mechanics in present:
        specs.append(Spec(f"variants_{mechanics}", "", 0, "variants", _bind2(variant_figure, groups, mechanics),
                          draw_variants, _variant_words))
    for number in sorted(of):
        for mechanics in mechanics_in(run for run in of[number] if run.drawable):
            specs.append(Spec(f"energy{number}_{mechanics}", "", number, "energy", _bind2(ledger_figure, of[number], mechanics),
                              draw_ledger, _ledger_words, _drawn(of[number], mechanics)))
    labels = iter(range(9, 9 + len(specs)))
    return [spec if spec.label else replace(spec, label=f"Figure {next(labels)}") for spec in specs]


def _drawn(runs: Sequence[Run], mechanics: str = "") -> list[Run]:
    """The runs that a figure of an experiment draws: its main variants with a history, of one mechanics or of all."""
    return [run for run in runs if run.is_main and run.drawable and mechanics in ("", run.mechanics)]


def _by_number(runs: list[Run]) -> dict[int, list[Run]]:
    """The runs of each numbered experiment."""
    groups: dict[int, list[Run]] = {}
    for run in runs:
        if run.number > 0:
            groups.setdefault(run.number, []).append(run)
    return groups


def _bind(function: Callable[[Any], Any], argument: Any) -> Callable[[], Any]:
    """The function applied to its argument, later."""
    return lambda: function(argument)


def _bind2(function: Callable[[Any, Any], Any], first: Any, second: Any) -> Callable[[], Any]:
    """The function applied to two arguments, later."""
    return lambda: function(first, second)


def suspect_words(runs: Sequence[Run]) -> str:
    """A sentence that names the runs of a figure that mark themselves as suspect, with why; nothing where none does."""
    marked = [(run, marks_of(run)) for run in runs]
    words = [
        f"Experiment {run.number} {plain(run.variant)}, {mechanics_name(run.mechanics)}: {'; '.join(marks)}"
        for run, marks in marked if marks
    ]
    return f" Suspect runs: {'. '.join(words)}." if words else ""


def make(spec: Spec, folder: Path) -> Made:
    """Make one figure's files; whatever is missing or wrong is told on the page and stops nothing."""
    made = Made(spec.name, spec.label, spec.experiment, spec.part)
    try:
        data = spec.prepare()
        save(spec.draw(data), folder, spec.name)
        made.title, made.caption = data.title, spec.caption(data) + suspect_words(spec.runs)
    except NotAvailable as lack:
        made.reason = str(lack)
    except Exception as error:  # a defect in one figure must not cost the reader all the others
        made.reason = f"could not be drawn: {type(error).__name__}: {error}"
        made.defect = traceback.format_exc()
    return made


def _with_fields(runs: list[Run], variants: tuple[str, ...]) -> Run:
    """The first of the named variants whose fields can be read."""
    for name in variants:
        for run in runs:
            if run.variant == name and run.drawable and (run.folder / "result.h5").exists():
                return run
    raise NotAvailable(f"no run of {listed([plain(name) for name in variants])} has fields")


def _crack_choices(of: dict[int, list[Run]]) -> list[tuple[Run, int, str]]:
    """A crack by itself, and one that has met an interface."""
    group = of.get(1, [])
    alone = _with_fields(group, ("perfect",))
    choices = [(alone, index_when_tip_passes(alone, 1.5 * max(layout_of(alone).fracture_y_m)), "tip")]
    for name in ("weak", "friction", "soft"):
        for met in (run for run in group if run.variant == name and run.drawable):
            beyond = max(layout_of(met).heights_m, default=0.0) + 3.0 * met.cell_m
            index = index_when_tip_passes(met, beyond)
            if any(split.size for split in divided(met, index).values()):
                return [*choices, (met, index, "interface")]
    return choices


def _pressure_choice(of: dict[int, list[Run]]) -> PressureFigure:
    """Experiment 1 with a perfect interface when the tip has doubled its height."""
    run = _with_fields(of.get(1, []), ("perfect", "friction", "weak", "soft"))
    if output_times(run).size == 0:
        raise NotAvailable("no output times")
    return pressure_figure(run, index_when_tip_passes(run, 2.0 * max(layout_of(run).fracture_y_m)))


def _copies_words(data: CopiesFigure) -> str:
    """Caption of Fig 1."""
    places = listed([panel.heading for panel in data.panels])
    return (
        f"A fracture as the solver sees it ({places}): a polyline of massless points, its faces drawn apart by the"
        f" opening magnified {data.magnified:g} times, particles coloured by the side they lie on, and the nodes of the"
        " grid. A node whose support holds particles on more than one side carries a copy of its fields for each:"
        " a sector stands for one copy. An interface divides nodes only where it has split. All lengths in metres."
    )


def _pressure_words(data: PressureFigure) -> str:
    """Caption of Fig 2."""
    return (
        f"{data.source} at t = {data.time_s:.3f} s. Left: total horizontal stress in MPa, tension positive, white at"
        f" its in-situ value of {data.centre_MPa:g} MPa. Right, against distance from the inlet in m: fluid pressure as"
        f" a fraction of the inlet's {data.inlet_MPa:.2f} MPa, opening w in mm, permeability w²/12 in m²."
    )


def _height_words(runs: list[Run]) -> Callable[[HeightFigure], str]:
    """What writes the caption of one of Figs 3 to 6."""

    def words(data: HeightFigure) -> str:
        """Caption with every variant's longest arrest."""
        lead = lead_of(run for run in runs if run.is_main)
        known = [run for run in runs if run.is_main and run.drawable and run.mechanics == lead]
        beside = dict.fromkeys(curve.mechanics for curve in data.curves if curve.beside)
        overlaid = f" Thin and dashed with hollow marks: {listed(list(beside))}." if beside else ""
        stays = [f"{plain(run.variant)} {held(run, runs)}" for run in known if held(run, runs)]
        arrests = f" Longest arrests: {listed(stays)}." if stays else " No variant was arrested."
        places = [metres(height) for height in data.layout.heights_m]
        flag = (
            " A ring marks an arrest decided by a J-integral taken so near to an interface that it is not to be"
            " trusted." if data.flagged else ""
        )
        return (
            f"Left: layout, lengths in m, with the in-situ stress in MPa; the fracture in blue. Middle and right:"
            f" height of the tip above the symmetry line in m against inlet pressure in MPa; dotted lines: interfaces"
            f" at {listed(places)}.{overlaid}{arrests}{flag}"
        )

    return words


def _profile_words(data: ProfileFigure) -> str:
    """Caption of Fig 7."""
    names = listed(list(dict.fromkeys(plain(panel.variant) for panel in data.panels)))
    return (
        f"Opening of the fracture in mm against height in m for {names} interfaces, from the start of growth (light) to"
        " the end of the run (dark), at the same times in every panel as far as its run lasted, and at its end. Dotted"
        " lines: interfaces."
    )


def _path_words(data: PathFigure) -> str:
    """Caption of Fig 8."""
    kinks = [
        f"{panel.name} {listed([f'{plain(path.variant)} {path.kink_deg:.2g}°' for path in panel.paths if not path.beside])}"
        for panel in data.panels
    ]
    return (
        f"Final paths in m{_beside_words(data)}; the horizontal scale is magnified where the panel says so. Insets: layout, fracture in blue,"
        f" interface in red. Diamonds: largest turn between two neighbouring segments ({'; '.join(kinks)})."
    )


def _beside_words(data: PathFigure) -> str:
    """What the thin lines of Fig 8 are."""
    return " (thin and dashed: explicit)" if any(path.beside for panel in data.panels for path in panel.paths) else ""


def _choice_words(data: ChoiceFigure) -> str:
    """Caption of an open point's figure."""
    places = "heights of the tip in m against inlet pressure in MPa"
    if all(panel.is_path for row in data.rows for panel in row):
        places = "paths in m"
    elif any(panel.is_path for row in data.rows for panel in row):
        places += ", or paths in m where the interface is parallel"
    return (
        f"Every run of this choice beside the default it stands for: {places}. Wide and pale: the default"
        f" ({data.default}); dashed: {listed(list(data.choices))}. The colour is that of the interface type; dotted: interfaces,"
        " of default and choice alike. A red cross marks a run that failed."
    )


def _variant_words(data: VariantFigure) -> str:
    """Caption of the dot plot."""
    count = sum(len(rows) for _, rows in data.blocks)
    return (
        f"Inlet pressure in MPa at which each of {count} {mechanics_name(data.mechanics)} runs starts to grow, reaches an interface, is arrested, starts"
        " again and ends. A band is an arrest at an interface or to the end; a thin line is a pause away from"
        " interfaces, or one that the run with perfect interfaces makes as well. Grey: readings of what the study leaves open;"
        " the tables of the experiments say in which settings each differs."
    )


def _ledger_words(data: LedgerFigure) -> str:
    """Caption of an energy ledger."""
    last = max(float(panel.supplied.inlet_MPa[-1]) for panel in data.panels)
    return (
        f"Energy since the start of the {mechanics_name(data.mechanics)} runs in kJ per metre of thickness against inlet pressure in MPa"
        f" (up to {mpa(1e6 * last)}). Above: the net work supplied and what of it is stored; below: what is dissipated,"
        " and what supply, storage and dissipation leave unexplained. 'Open by' is the latter at the end of the run as"
        " the solver gives it, a share of the largest energy so far (mostly the work of the fluid alone)."
    )
