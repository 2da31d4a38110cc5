"""Distances between paths, and boundary elements' paths as the command line gives them."""

import numpy as np
import pytest

from verification.harness.crack_paths import exact_path, farthest, first_kink_deg, rise_at
from verification.harness.load import LoadError


def test_farthest_is_of_points_from_the_line_over_the_common_length() -> None:
    line = np.array([[0.0, 5.0], [0.0, 15.0]])
    assert farthest(np.array([[0.0, 5.0], [0.3, 8.0], [-0.5, 11.0]]), line) == pytest.approx(0.5)
    assert farthest(np.array([[0.0, 5.0], [0.3, 8.0], [4.0, 20.0]]), line) == pytest.approx(0.3)


def test_rise_is_where_the_path_first_gets_there() -> None:
    path = np.array([[0.0, 5.0], [0.5, 7.0], [1.5, 8.0], [0.9, 9.0], [2.0, 10.0]])
    assert rise_at(path, 1.0) == pytest.approx(2.5)
    with pytest.raises(LoadError, match="never"):
        rise_at(path, 3.0)


def test_experiments_turn_as_the_parallel_crack_says() -> None:
    assert first_kink_deg(5) == pytest.approx(2.82, abs=0.005)
    assert first_kink_deg(6) == pytest.approx(-3.31, abs=0.005)
    away, to_it = exact_path(5, 1.0, "corrected", 3.0), exact_path(6, 1.0, "forward", 3.0)
    assert away.shape == to_it.shape == (4, 2)
    assert np.all(np.diff(away[:, 0]) < 0.0) and np.all(np.diff(to_it[:, 0]) > 0.0)
    assert np.allclose(np.hypot(*np.diff(to_it, axis=0).T), 1.0)
