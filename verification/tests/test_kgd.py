"""Flow that conserves mass and the rock in one system: a fracture fed at a constant rate against its two vertices."""
from __future__ import annotations

import pytest

from verification.harness.compare import compare, require, within
from verification.harness.paths import ANALYTIC
from verification.harness.reference import value
from verification.tests.cases import completed

SCENE = ANALYTIC / "kgd.toml"
RATE_M2_S, TIME_S, CLOSING_PA = 1.0e-4, 100.0, 20.0e6


def reference(vertex: str, quantity: str) -> float:
    """A value of the vertex's self-similar solution at the scene's time, SI."""
    return value(f"kgd_{vertex}", quantity, rate_m2_s=RATE_M2_S, time_s=TIME_S)


# The two vertices differ by 24 % in length and by a factor of two in pressure, and each goes with a power of the rate:
# half or twice the rate, a mirrored half that gets all of it, or a storage without dw/dt fail by tens of per cents.
@pytest.mark.slow
@pytest.mark.parametrize(("vertex", "allowed"), [("toughness", 0.02), ("viscosity", 0.03)])
def test_a_fed_fracture_grows_as_the_vertex_says(vertex: str, allowed: float) -> None:
    """Length, mouth opening and net inlet pressure after 100 s in a block 16 fracture lengths to either side; volume kept."""
    run = completed(SCENE, vertex, ())
    summary = run.summary
    measured = {
        "half_length_m": summary.tips[0].y_m,
        "mouth_opening_m": summary.mouth_opening_m,
        "inlet_pressure_Pa": summary.inlet_Pa - CLOSING_PA,
    }
    require(*(compare(name, found, within(reference(vertex, name), allowed)) for name, found in measured.items()))
    assert abs(float(run.history["fluid_volume_balance"][-1])) < 1e-8
    # Half of what was fed, the modelled half's share; compression and roughness keep about 1e-4 of it.
    assert summary.fracture_volume_m2 == pytest.approx(0.5 * RATE_M2_S * TIME_S, rel=1e-3)
