"""Boundary elements' paths and fields as the command line of strata-reference gives them, and what is made of them."""

import numpy as np
import pytest

from verification.harness.crack_paths import farthest, rise_at
from verification.harness.load import LoadError
from verification.harness.reference import values
from verification.ladder.fields import at_points, lattice


def test_farthest_and_rise_of_paths() -> None:
    """Of points from the line over the common length; where the path first gets there."""
    line = np.array([[0.0, 5.0], [0.0, 15.0]])
    assert farthest(np.array([[0.0, 5.0], [0.3, 8.0], [-0.5, 11.0]]), line) == pytest.approx(0.5)
    assert farthest(np.array([[0.0, 5.0], [0.3, 8.0], [4.0, 20.0]]), line) == pytest.approx(0.3)
    path = np.array([[0.0, 5.0], [0.5, 7.0], [1.5, 8.0], [0.9, 9.0], [2.0, 10.0]])
    assert rise_at(path, 1.0) == pytest.approx(2.5)
    with pytest.raises(LoadError, match="never"):
        rise_at(path, 3.0)


def test_places_return_to_the_lattice_that_single_precision_left() -> None:
    exact = (np.arange(80) + 0.5) * 0.125
    assert np.array_equal(lattice(exact.astype(np.float32).astype(float) + 1e-6, 0.125), exact)
    with pytest.raises(LoadError, match="lattice"):
        lattice(np.array([0.1, 0.3, 0.5 + 0.02]), 0.2)


def test_points_through_files_are_answered_as_those_in_the_command() -> None:
    x, y = [0.1, 0.25, 1.0 / 3.0], [0.7, 0.2, 0.9]
    settings = {"time": "sine", "angular_frequency_1_s": 3500.0, "time_s": 1e-3}
    through_files = at_points("manufactured_standing", ("u_x_m", "b_y_m_s2"), {"x_m": np.array(x), "y_m": np.array(y)}, settings)
    for found, quantity in zip(through_files, ("u_x_m", "b_y_m_s2")):
        assert np.array_equal(found, values("manufactured_standing", quantity, x_m=x, y_m=y, **settings))
        assert len(set(found)) == 3
