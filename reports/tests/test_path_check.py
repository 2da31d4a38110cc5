"""The part of the page about paths: what counts as near, what the title says, what is drawn and what is said of nothing."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from reports import path_check
from reports.charts.parts import draw_path_check
from reports.figures import words_of
from reports.shown import Shown


STRAIGHT = np.array([[0.0, 5.0], [0.0, 30.0]])


def a_path(
    monkeypatch: pytest.MonkeyPatch, experiment: int, off_m: float, off_same_m: float, cell_m: float = 0.5, block: str = "400 m, graded",
) -> Shown:
    """A path of a run, straight and so far from the converged one and from that in its own increments."""
    monkeypatch.setattr(path_check, "grown", lambda run: STRAIGHT)
    monkeypatch.setattr(path_check, "exact_path", lambda *given: STRAIGHT + [off_same_m, 0.0])
    run = SimpleNamespace(increment_m=1.0, scene={"numerics": {"cell_m": cell_m}}, summary=SimpleNamespace(mechanics="quasistatic"))
    return path_check.path_of(experiment, block, "", run, STRAIGHT + [off_m, 0.0])  # type: ignore[arg-type]


@pytest.mark.parametrize("off_m, off_same_m, near", [(0.4, 3.0, True), (3.0, 0.4, True), (0.6, 0.7, False)])
def test_near_is_a_cell_from_either_path(monkeypatch: pytest.MonkeyPatch, off_m: float, off_same_m: float, near: bool) -> None:
    """The converged path or that in the same increments."""
    one = a_path(monkeypatch, 5, off_m, off_same_m)
    assert one.near == near and (one.off_m, one.off_same_m) == (pytest.approx(off_m), pytest.approx(off_same_m))


def test_the_title_tells_the_finest_run_of_the_large_block(monkeypatch: pytest.MonkeyPatch) -> None:
    """The large block counts before finer cells."""
    given = ((5, 0.3, 0.9, 1.0), (5, 0.1, 0.9), (5, 0.05, 0.9, 0.25, "80 m"), (6, 2.0, 0.02))
    title = path_check._finding([a_path(monkeypatch, *one) for one in given])
    assert "Experiment 5: 0.1 m from the boundary elements' converged path at 0.5 m cells" in title
    assert "Experiment 6: 0.02 m from the boundary elements' path in the same increments" in title


def test_chart_shows_every_run_and_the_interface_where_paths_come_near(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lines of each panel by their labels."""
    tips = np.array([[0.0, 5.0], [0.5, 7.0], [4.0, 9.0]])
    runs = {k: (a_path(monkeypatch, k, 0.1, 0.1), a_path(monkeypatch, k, 0.2, 0.1, 1.0)) for k in (5, 6)}
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
    assert path_check._settled() == (
        "Experiment 5 moved by 0.25 m when increments were halved to 0.5 m; Experiment 6 moved by 0.062 m when increments were halved to"
        " 0.125 m, and is as far from its limit (first order)"
    )
    assert "= 0.26 m (Cotterell" in words_of("path_check_note", leaving_m=path_check.leaving_m(), missing=[]), "1.45^2/8 m"


def test_nothing_is_said_where_nothing_was_run(tmp_path: Path) -> None:
    """No runs, no part of the page."""
    assert path_check.section(tmp_path) is None
