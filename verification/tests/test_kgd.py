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


# Mutations run at the viscosity vertex: half and twice the rate (a modelled half that gets all of it) put the length off by
# -27 and +41 %, the mouth by -29 and +42 %, the volume by half and twice. The pressure there does not depend on the rate; the
# two vertices differ in it by a factor of two.
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
