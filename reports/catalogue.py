"""The figures of the page of the experiments: which data each is made from, what draws it, and which words are its caption."""

from collections.abc import Sequence
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
from reports.runs import NotAvailable, Run, lead_of, mechanics_in, output_times
from reports.shown import Shown
from reports.words import listed, plain
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
        Figure("fig1", lambda: copies_figure(_crack_choices(one), MAGNIFIED), draw_copies, "fig1", part="method"),
        Figure("fig2", partial(_pressure_choice, one), draw_pressure, "fig2", part="method"),
        *(Figure(f"fig{number + 2}", partial(height_figure, own), draw_heights, "heights", experiment=number, part="experiment", runs=_drawn(own))
          for number in (1, 2, 3, 4) for own in (of.get(number, []),)),
        Figure("fig7", partial(profile_figure, four), draw_profiles, "fig7", experiment=4, part="experiment", runs=_drawn(four)),
        Figure("fig8", partial(path_figure, sideways), draw_paths, "fig8", experiment=5, part="experiment", runs=_drawn(sum(sideways, []))),
        *(Figure(f"choice_{point.id}", partial(choice_figure, point, runs), draw_choice, "choice", part="choice") for point in points),
        *(Figure(f"variants_{mechanics}", partial(variant_figure, list(of.values()), mechanics), draw_variants, "variants", part="variants")
          for mechanics in mechanics_in(runs) or (lead_of(runs),)),
        *(Figure(f"energy{number}_{mechanics}", partial(ledger_figure, own, mechanics), draw_ledger, "energy", experiment=number, part="energy",
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
