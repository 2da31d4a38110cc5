"""The paths of Experiments 5 and 6 with a perfect interface beside those of boundary elements in the infinite plane."""

from collections.abc import Iterator
from pathlib import Path

from reports.charts.parts import draw_path_check
from reports.figures import Figure, Section, Table, words_of
from reports.shown import Shown
from reports.words import mechanics_name
from verification.harness.crack_paths import INTERFACE_M, exact_path, farthest, grown, leaving_m
from verification.harness.load import Array, LoadError, Run, load
from verification.harness.reference import NoReference

TITLE = "Paths against boundary elements"
GROWTH_M = 20.0  # of the paths that are compared
KEPT_OFF_M = 0.5  # from the interface, to which they are compared
CELLS = 1.0  # farthest distance in cells that is asked for
SHIPPED = {5: "exp5_parallel_interface", 6: "exp6_stress_reversal"}
CASES = {"": "400 m, graded", "_block": "80 m", "_explicit": "80 m"}
TITLES = {5: "Experiment 5: away from the stiff rock", 6: "Experiment 6: to the soft rock"}
# The converged path of boundary elements of each experiment: increment (m) and turning. That of 6 is of first order in the
# increment (reference/crack_path.hpp) and not at its limit, which `_settled` tells; finer ones take minutes.
CONVERGED: dict[int, tuple[float, str]] = {5: (0.5, "corrected"), 6: (0.125, "forward")}


def path_of(experiment: int, block: str, words: str, run: Run, reference: Array) -> Shown:
    """A run's path (tips from the first on, x from the first crack, m) and how far it is from the converged path of boundary elements (off_m) and
    from the forward one of the run's own increment (same, off_same_m); `near` where either is within the cell that is asked for."""
    tips, cell_m = grown(run), float(run.scene["numerics"]["cell_m"])
    same = exact_path(experiment, run.increment_m, "forward", GROWTH_M)
    inside = tips[tips[:, 0] < INTERFACE_M - KEPT_OFF_M]
    off_m, off_same_m = farthest(inside, reference), farthest(inside, same)
    mechanics = mechanics_name(run.summary.mechanics)
    return Shown(experiment=experiment, block=block, where=block + words, mechanics=mechanics, cell_m=cell_m, increment_m=run.increment_m, tips=tips,
                 same=same, off_m=off_m, off_same_m=off_same_m, shipped=bool(words), near=min(off_m, off_same_m) <= CELLS * cell_m,
                 label=f"{mechanics}, {block}{words}, cells {cell_m:g} m, increments {run.increment_m:g} m")


def _folders(runs: Path, experiment: int) -> Iterator[tuple[Path, str, str]]:
    """Folders of runs to compare, each with its block and what is special about its flow."""
    for ending, block in CASES.items():
        for level in sorted((runs / "ladder" / "paths" / f"path_exp{experiment}{ending}").glob("*/summary.json")):
            yield level.parent, block, ""
    for mechanics in ("quasistatic", "explicit"):
        folder = runs / mechanics / SHIPPED[experiment] / "perfect"
        if (folder / "summary.json").is_file():
            yield folder, "80 m", ", study's flow"


def path_check(runs: Path) -> Shown | None:
    """All paths below `runs` beside the boundary elements': the figure, its paths, what could not be read; None where there are none.

    Lengths of a panel are in m, x from the first crack; `shows_same`: draw each run's own forward path of boundary elements. Raises NoReference
    without the program.
    """
    panels: list[Shown] = []
    missing: list[str] = []
    for experiment, (increment, turning) in CONVERGED.items():
        found: list[Shown] = []
        for folder, block, words in _folders(runs, experiment):
            try:
                found.append(path_of(experiment, block, words, load(folder), exact_path(experiment, increment, turning, GROWTH_M)))
            except LoadError as error:
                missing.append(f"{folder.relative_to(runs)}: {error}")
        if found:
            converged = exact_path(experiment, increment, turning, GROWTH_M)
            panels.append(Shown(heading=TITLES[experiment], converged=converged, shows_same=experiment == 6, runs=found, interface_m=INTERFACE_M,
                                converged_words=f"boundary elements, {turning}, increments {increment:g} m"))
    every = [path for panel in panels for path in panel.runs]
    if not panels:
        return None
    return Shown(figure=Shown(title=_finding(every), panels=panels, interface_m=INTERFACE_M, settled=_settled()), paths=every, missing=missing)


def _finding(paths: list[Shown]) -> str:
    """What the comparison shows, from the finest run of each experiment in the large block and uniform flow."""
    words = []
    for experiment in SHIPPED:
        own = [path for path in paths if path.experiment == experiment and not path.shipped]
        if own:
            best = min(own, key=lambda path: (path.block != CASES[""], path.cell_m))
            which = "converged path" if best.off_m <= best.off_same_m else "path in the same increments"
            off = min(best.off_m, best.off_same_m)
            words.append(f"Experiment {experiment}: {off:.2g} m from the boundary elements' {which} at {best.cell_m:g} m cells")
    return "; ".join(words) or "Paths of the experiments beside those of boundary elements"


def section(runs: Path) -> Section | None:
    """The part of the page of verification about paths; None where no path was run."""
    try:
        check = path_check(runs)
    except NoReference as error:
        return Section(title=TITLE, intro=f"strata-reference could not be asked: {error}", figures=[], tables=[])
    if check is None:
        return None
    table = Table(
        title=f"Largest distance of the paths over the first {GROWTH_M:g} m of growth, or to {KEPT_OFF_M:g} m from the interface",
        header=["experiment", "block", "mechanics", "cell (m)", "increment (m)", "last tip x, y (m)", "distance (m)", "in cells",
                "from forward path of that increment (m)"],
        rows=[[f"{path.experiment}", path.where, path.mechanics, f"{path.cell_m:g}", f"{path.increment_m:g}",
               f"{path.tips[-1, 0]:.2f}, {path.tips[-1, 1]:.2f}", f"{path.off_m:.3f}", f"{path.off_m / path.cell_m:.2f}", f"{path.off_same_m:.3f}"]
              for path in check.paths],
        marked=[k for k, path in enumerate(check.paths) if not path.near],
        note=words_of("path_check_note", leaving_m=leaving_m(), missing=check.missing),
    )
    intro = words_of("path_check_intro", near=sum(path.near for path in check.paths), count=len(check.paths))
    return Section(title=TITLE, intro=intro, figures=[Figure("path_check", check.figure, draw_path_check, "path_check")], tables=[table])


def _settled() -> str:
    """By how much the converged paths still moved when their increments were halved: at first order as far as their limit is."""
    told = []
    for experiment, (increment, turning) in CONVERGED.items():
        coarse, fine = (exact_path(experiment, size, turning, GROWTH_M) for size in (2.0 * increment, increment))
        left = ", and is as far from its limit (first order)" if turning == "forward" else ""
        moved = f"{farthest(coarse, fine):.2g} m when increments were halved to {increment:g} m"
        told.append(f"Experiment {experiment} moved by {moved}{left}")
    return "; ".join(told)
