"""The part of the page about paths: what counts as near, what the title says, what is drawn and what is said of nothing."""

from pathlib import Path

import numpy as np
import pytest

from reports import path_check
from reports.charts.parts import draw_path_check
from reports.figures import words_of
from reports.path_check import SolverPath, _finding, _row, _settled, section
from reports.shown import Shown


def a_path(experiment: int, off_m: float, off_same_m: float, cell_m: float = 0.5, block: str = "400 m, graded") -> SolverPath:
    """A path of a run that leans to the right."""
    tips = np.array([[0.0, 5.0], [0.2, 7.0], [4.8, 9.0]])
    return SolverPath(experiment, block, "quasistatic", "", cell_m, 1.0, tips, tips + 0.1, off_m, off_same_m)


def test_near_is_a_cell_from_the_converged_path_or_from_that_of_the_same_increment() -> None:
    """Either path will do, and a cell is the limit."""
    assert a_path(5, 0.4, 3.0).within
    assert a_path(6, 3.0, 0.4).within
    assert not a_path(6, 0.6, 0.7).within


def test_title_and_rows_tell_the_finest_run_of_the_large_block() -> None:
    """The large block counts before finer cells."""
    paths = [a_path(5, 0.3, 0.9, 1.0), a_path(5, 0.1, 0.9), a_path(5, 0.05, 0.9, 0.25, "80 m"), a_path(6, 2.0, 0.02)]
    title = _finding(paths)
    assert "Experiment 5: 0.1 m from the boundary elements' converged path at 0.5 m cells" in title
    assert "Experiment 6: 0.02 m from the boundary elements' path in the same increments" in title
    assert _row(paths[1])[-4:] == ["4.80, 9.00", "0.100", "0.20", "0.900"]


def test_chart_shows_every_run_and_the_interface_where_paths_come_near() -> None:
    """Lines of each panel by their labels."""
    tips = np.array([[0.0, 5.0], [0.5, 7.0], [4.0, 9.0]])
    runs = {k: (a_path(k, 0.1, 0.1), a_path(k, 0.2, 0.1, 1.0)) for k in (5, 6)}
    panels = [Shown(heading=f"panel {k}", converged=tips, converged_words="converged", shows_same=k == 6, runs=runs[k],
                    interface_m=5.0) for k in (5, 6)]
    figure = draw_path_check(Shown(title="a title", panels=panels))
    for axes, dashed in zip(figure.axes, (0, 3)):
        labels = [str(line.get_label()) for line in axes.get_lines()]
        assert sum("cells" in label for label in labels) == 2
        assert sum("boundary" in label for label in labels) == (1 if dashed else 0)
        assert len(labels) == 1 + 2 + 1 + dashed  # converged, runs, interface, dashed and its entry


def test_how_far_converged_paths_are_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """From the paths themselves: with half an increment off at each, halving moves them by half of the smaller one."""

    def leaning(experiment: int, increment_m: float, turning: str, growth_m: float) -> np.ndarray:
        """A straight path, half an increment to the side."""
        return np.array([[0.5 * increment_m, 5.0], [0.5 * increment_m, 5.0 + growth_m]])

    monkeypatch.setattr(path_check, "exact_path", leaning)
    assert _settled() == (
        "Experiment 5 moved by 0.25 m when increments were halved to 0.5 m; Experiment 6 moved by 0.062 m when increments were halved to"
        " 0.125 m, and is as far from its limit (first order)"
    )
    assert "= 0.26 m (Cotterell" in words_of("path_check_note", leaving_m=path_check.leaving_m(), missing=[]), "1.45^2/8 m"


def test_nothing_is_said_where_nothing_was_run(tmp_path: Path) -> None:
    """No runs, no part of the page."""
    assert section(tmp_path) is None
