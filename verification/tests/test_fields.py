"""Fields of particles for the ladder: where points start, and references at many points through files."""

import numpy as np
import pytest

from verification.harness.load import LoadError
from verification.harness.reference import values
from verification.ladder.fields import at_points, lattice


def test_places_return_to_the_lattice_that_single_precision_left() -> None:
    exact = (np.arange(80) + 0.5) * 0.125
    assert np.array_equal(lattice(exact.astype(np.float32).astype(float) + 1e-6, 0.125), exact)


def test_places_off_the_lattice_are_refused() -> None:
    with pytest.raises(LoadError, match="lattice"):
        lattice(np.array([0.1, 0.3, 0.5 + 0.02]), 0.2)


def test_points_through_files_are_answered_as_those_in_the_command() -> None:
    x, y = [0.1, 0.25, 1.0 / 3.0], [0.7, 0.2, 0.9]
    settings = {"time": "sine", "angular_frequency_1_s": 3500.0, "time_s": 1e-3}
    through_files = at_points("manufactured_standing", ("u_x_m", "b_y_m_s2"), {"x_m": np.array(x), "y_m": np.array(y)}, settings)
    for found, quantity in zip(through_files, ("u_x_m", "b_y_m_s2")):
        assert np.array_equal(found, values("manufactured_standing", quantity, x_m=x, y_m=y, **settings))
        assert len(set(found)) == 3
