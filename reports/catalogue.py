"""The figures of the page of the experiments: which data each is made from, what draws it, and its caption."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from reports.charts.cracks import draw_copies, draw_pressure
from reports.charts.energies import draw_ledger, draw_variants
from reports.charts.experiments import draw_choice, draw_heights, draw_paths, draw_profiles
from reports.choices import choice_figure
from reports.crack import copies_figure, divided, index_when_tip_passes, pressure_figure
from reports.curves import height_figure, path_figure, profile_figure
from reports.figures import Figure
from reports.layout import layout_of
from reports.ledger import ledger_figure, variant_figure
from reports.outcome import held
from reports.runs import NotAvailable, Run, lead_of, mechanics_in, output_times
from reports.shown import Shown
from reports.words import listed, mechanics_name, metres, mpa, plain
from verification.harness.choices import Point

MAGNIFIED = 300.0  # of openings in Fig 1: a millimetre becomes a third of a 1 m cell


def catalogue(runs: list[Run], points: Sequence[Point] = ()) -> list[Figure]:
    """Every figure of the page, in order; those after the study's eight are numbered as they come."""
    of: dict[int, list[Run]] = {}
    for run in runs:
        of.setdefault(run.number, []).append(run)
    of = {number: of[number] for number in sorted(of) if number > 0}
    one, four, sideways = of.get(1, []), of.get(4, []), [of.get(number, []) for number in (5, 6)]
    figures = [
        Figure("fig1", lambda: copies_figure(_crack_choices(one), MAGNIFIED), draw_copies, _copies_words, part="method"),
        Figure("fig2", partial(_pressure_choice, one), draw_pressure, _pressure_words, part="method"),
        *(Figure(f"fig{number + 2}", partial(height_figure, own), draw_heights, _height_words(own), experiment=number, part="experiment", runs=_drawn(own))
          for number in (1, 2, 3, 4) for own in (of.get(number, []),)),
        Figure("fig7", partial(profile_figure, four), draw_profiles, _profile_words, experiment=4, part="experiment", runs=_drawn(four)),
        Figure("fig8", partial(path_figure, sideways), draw_paths, _path_words, experiment=5, part="experiment", runs=_drawn(sum(sideways, []))),
        *(Figure(f"choice_{point.id}", partial(choice_figure, point, runs), draw_choice, _choice_words, part="choice") for point in points),
        *(Figure(f"variants_{mechanics}", partial(variant_figure, list(of.values()), mechanics), draw_variants, _variant_words, part="variants")
          for mechanics in mechanics_in(runs) or (lead_of(runs),)),
        *(Figure(f"energy{number}_{mechanics}", partial(ledger_figure, own, mechanics), draw_ledger, _ledger_words, experiment=number, part="energy",
                 runs=_drawn(own, mechanics)) for number, own in of.items() for mechanics in mechanics_in(run for run in own if run.drawable)),
    ]
    return [replace(figure, label=f"Figure {number}") for number, figure in enumerate(figures, 1)]


def _drawn(runs: Sequence[Run], mechanics: str = "") -> list[Run]:
    """The runs that a figure of an experiment draws: its main variants with a history, of one mechanics or of all."""
    return [run for run in runs if run.is_main and run.drawable and mechanics in ("", run.mechanics)]


def _with_fields(runs: list[Run], variants: tuple[str, ...]) -> Run:
    """The first of the named variants whose fields can be read."""
    for name in variants:
        for run in runs:
            if run.variant == name and run.drawable and (run.folder / "result.h5").exists():
                return run
    raise NotAvailable(f"no run of {listed([plain(name) for name in variants])} has fields")


def _crack_choices(group: list[Run]) -> list[tuple[Run, int, str]]:
    """A crack of Experiment 1 by itself, and one that has met an interface."""
    alone = _with_fields(group, ("perfect",))
    choices = [(alone, index_when_tip_passes(alone, 1.5 * max(layout_of(alone).fracture_y_m)), "tip")]
    for name in ("weak", "friction", "soft"):
        for met in (run for run in group if run.variant == name and run.drawable):
            index = index_when_tip_passes(met, max(layout_of(met).heights_m, default=0.0) + 3.0 * met.cell_m)
            if any(split.size for split in divided(met, index).values()):
                return [*choices, (met, index, "interface")]
    return choices


def _pressure_choice(group: list[Run]) -> Shown:
    """Experiment 1 with a perfect interface when the tip has doubled its height."""
    run = _with_fields(group, ("perfect", "friction", "weak", "soft"))
    if output_times(run).size == 0:
        raise NotAvailable("no output times")
    return pressure_figure(run, index_when_tip_passes(run, 2.0 * max(layout_of(run).fracture_y_m)))


# --- captions


def _copies_words(data: Shown) -> str:
    """Caption of Fig 1."""
    return (
        f"A fracture as the solver sees it ({listed([panel.heading for panel in data.panels])}): a polyline of massless points, its faces drawn apart by"
        f" the opening magnified {data.magnified:g} times, particles coloured by the side they lie on, and the nodes of the grid. A node whose support"
        " holds particles on more than one side carries a copy of its fields for each: a sector stands for one copy. An interface divides nodes only"
        " where it has split. All lengths in metres."
    )


def _pressure_words(data: Shown) -> str:
    """Caption of Fig 2."""
    return (
        f"{data.source} at t = {data.time_s:.3f} s. Left: total horizontal stress in MPa, tension positive, white at its in-situ value of"
        f" {data.centre_MPa:g} MPa. Right, against distance from the inlet in m: fluid pressure as a fraction of the inlet's {data.inlet_MPa:.2f} MPa,"
        " opening w in mm, permeability w²/12 in m²."
    )


def _height_words(runs: list[Run]) -> Callable[[Shown], str]:
    """What writes the caption of one of Figs 3 to 6."""

    def words(data: Shown) -> str:
        """Caption with every variant's longest arrest."""
        lead = lead_of(run for run in runs if run.is_main)
        beside = dict.fromkeys(curve.mechanics for curve in data.curves if curve.beside)
        overlaid = f" Thin and dashed with hollow marks: {listed(list(beside))}." if beside else ""
        stays = [f"{plain(run.variant)} {stay}" for run in _drawn(runs, lead) if (stay := held(run, runs))]
        arrests = f" Longest arrests: {listed(stays)}." if stays else " No variant was arrested."
        flag = " A ring marks an arrest decided by a J-integral taken so near to an interface that it is not to be trusted." if data.flagged else ""
        return (
            "Left: layout, lengths in m, with the in-situ stress in MPa; the fracture in blue. Middle and right: height of the tip above the symmetry"
            f" line in m against inlet pressure in MPa; dotted lines: interfaces at {listed(list(map(metres, data.layout.heights_m)))}."
            f"{overlaid}{arrests}{flag}"
        )

    return words


def _profile_words(data: Shown) -> str:
    """Caption of Fig 7."""
    names = listed(list(dict.fromkeys(plain(panel.variant) for panel in data.panels)))
    return (
        f"Opening of the fracture in mm against height in m for {names} interfaces, from the start of growth (light) to the end of the run (dark), at"
        " the same times in every panel as far as its run lasted, and at its end. Dotted lines: interfaces."
    )


def _path_words(data: Shown) -> str:
    """Caption of Fig 8."""
    turns = [(panel.name, [f"{plain(path.variant)} {path.kink_deg:.2g}°" for path in panel.paths if not path.beside]) for panel in data.panels]
    beside = " (thin and dashed: explicit)" if any(path.beside for panel in data.panels for path in panel.paths) else ""
    return (
        f"Final paths in m{beside}; the horizontal scale is magnified where the panel says so. Insets: layout, fracture in blue, interface in red."
        f" Diamonds: largest turn between two neighbouring segments ({'; '.join(f'{name} {listed(each)}' for name, each in turns)})."
    )


def _choice_words(data: Shown) -> str:
    """Caption of an open point's figure."""
    are_paths = [panel.is_path for row in data.rows for panel in row]
    places = "paths in m" if all(are_paths) else "heights of the tip in m against inlet pressure in MPa"
    if any(are_paths) and not all(are_paths):
        places += ", or paths in m where the interface is parallel"
    return (
        f"Every run of this choice beside the default it stands for: {places}. Wide and pale: the default ({data.default}); dashed:"
        f" {listed(data.choices)}. The colour is that of the interface type; dotted: interfaces, of default and choice alike. A red cross marks a run"
        " that failed."
    )


def _variant_words(data: Shown) -> str:
    """Caption of the dot plot."""
    return (
        f"Inlet pressure in MPa at which each of {sum(len(rows) for _, rows in data.blocks)} {mechanics_name(data.mechanics)} runs starts to grow, reaches"
        " an interface, is arrested, starts again and ends. A band is an arrest at an interface or to the end; a thin line is a pause away from interfaces,"
        " or one that the run with perfect interfaces makes as well. Grey: readings of what the study leaves open; the tables of the experiments say in"
        " which settings each differs."
    )


def _ledger_words(data: Shown) -> str:
    """Caption of an energy ledger."""
    return (
        f"Energy since the start of the {mechanics_name(data.mechanics)} runs in kJ per metre of thickness against inlet pressure in MPa (up to"
        f" {mpa(1e6 * max(float(panel.inlet_MPa[-1]) for panel in data.panels))}). Above: the net work supplied and what of it is stored; below: what is"
        " dissipated, and what supply, storage and dissipation leave unexplained. 'Open by' is the latter at the end of the run as the solver gives it, a"
        " share of the largest energy so far (mostly the work of the fluid alone)."
    )
