"""The figures of the page of the experiments, numbered as in the study: which data each is made from, what draws it, and which words are its caption."""

from functools import partial
from pathlib import Path

from reports.charts.cracks import draw_copies, draw_pressure
from reports.charts.experiments import draw_heights, draw_paths, draw_profiles
from reports.crack import copies_figure, divided, index_when_tip_passes, pressure_figure
from reports.curves import drawn_of, height_figure, path_figure, profile_figure
from reports.figures import Figure
from reports.runs import NotAvailable, Run, layout_of, load_run, output_times
from reports.words import Shown, listed, plain
from verification.harness.run import Job, make

MAGNIFIED = 300.0  # of openings in Fig 1: a millimetre becomes a third of a 1 m cell
FINE_TIP_M = 10.0
# Of the run that Fig 2 shows: cells small enough for a smooth field, until the tip has doubled its height; 5 s.
FINE = ("numerics.mechanics=quasistatic", "numerics.cell_m=0.25", "numerics.far_cell_m=0.5", f"stop.tip_y_m={FINE_TIP_M}", "output.fields_every_s=0.02")


def catalogue(runs: list[Run], root: Path, experiments: Path) -> list[Figure]:
    """The study's eight figures, from runs below a root folder."""
    of = {number: [run for run in runs if run.number == number] for number in range(1, 7)}
    upward, sideways = [of[number] for number in (1, 2, 3, 4)], [of[5], of[6]]
    first = partial(Figure, command="ci/reproduce --only exp1")
    return [
        first("fig1", lambda: copies_figure(_crack_choices(of[1]), MAGNIFIED), draw_copies, "fig1", label="Figure 1"),
        first("fig2", partial(_pressure_choice, of[1], root, experiments), draw_pressure, "fig2", label="Figure 2"),
        *(Figure(f"fig{number + 2}", partial(height_figure, of[number], sum(upward, [])), draw_heights, "heights", f"ci/reproduce --only exp{number}",
                 f"Figure {number + 2}", drawn_of(of[number])) for number in (1, 2, 3, 4)),
        Figure("fig7", partial(profile_figure, of[4]), draw_profiles, "fig7", "ci/reproduce --only exp4", "Figure 7", drawn_of(of[4])),
        Figure("fig8", partial(path_figure, sideways), draw_paths, "fig8", "ci/reproduce --only exp5,exp6", "Figure 8", drawn_of(sum(sideways, []))),
    ]  # fmt: skip


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


def _pressure_choice(group: list[Run], root: Path, experiments: Path) -> Shown:
    """Experiment 1 with a perfect interface just before the tip has doubled its height: in small cells, or where that cannot be run as it is."""
    run = _with_fields(group, ("perfect", "friction", "weak", "soft"))
    outcome, _ = make(Job(experiments / f"{run.experiment}.toml", "perfect", root / "figure2" / run.experiment / "perfect", FINE))
    run = load_run(root / "figure2" / run.experiment / "perfect") if outcome.ok else run
    if output_times(run).size == 0:
        raise NotAvailable("no output times")
    return pressure_figure(run, max(0, index_when_tip_passes(run, 2.0 * max(layout_of(run).fracture_y_m)) - 1))
