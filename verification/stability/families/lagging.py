"""The study's flow with a permeability foreseen, and flow and rock in one system: steps that grow long."""

from functools import lru_cache

import numpy as np

from verification.harness.load import LoadError, Run, frames, given
from verification.stability.family import CRACK, STABLE, Checked, Family, Parameter, Point, at_values, close, walked
from verification.stability.theory.flow import compliance, paper, reynolds

START_PA, RATE_PA_S, TIME_S = 0.05e6, 0.35e6, 2.0  # net pressure at the start, its rise at the inlet (the study's), and for how long
INTERVALS_S = (0.02, 0.1, 0.5, 2.0)
VISCOSITIES_PA_S = (0.1, 0.3, 1.0)
CLOSING_PA = 2.0e6  # of the scene


@lru_cache
def resolved(viscosity_Pa_s: float) -> float:
    """Net pressure at the tip (Pa) by 2000 equal steps of the model."""
    return float(paper([TIME_S / 2000] * 2000, START_PA, RATE_PA_S, viscosity_Pa_s)[-1])


def tip_pressure(run: Run) -> Checked:
    """Net pressure at the tip at the end."""
    found = float(frames(run, "fracture")[-1][1]["pressure_Pa"][-1]) - CLOSING_PA
    return close(found, resolved(given(run, "fluid.viscosity_Pa_s")), 0.015, f"{run.summary.steps} steps; net pressure at the tip {found:.0f} Pa")


def lagging(viscosity_Pa_s: float, every_s: float, smoke: bool = False) -> Point:
    """A run of a viscosity with outputs so far apart."""
    keys = ("fluid.law=paper", f"fluid.viscosity_Pa_s={viscosity_Pa_s!r}", f"fluid.inlet={{start_Pa={CLOSING_PA + START_PA!r},rate_Pa_s={RATE_PA_S!r}}}",
            f"stop.time_s={TIME_S!r}", f"output.fields_every_s={every_s!r}")  # fmt: skip
    label = f"{every_s:g} s" if viscosity_Pa_s == 1.0 else f"{every_s:g} s, {viscosity_Pa_s:g} Pa s"
    return Point(label, every_s, CRACK, keys, smoke=smoke)


LAG = Family(
    "lag", "Permeability that is foreseen: outputs far apart",
    "Steps are held back by what an opening foreseen wrong does to the pressure, so that the tip's is within 1.5 % however far outputs are apart.",
    Parameter("time between outputs, the longest step", "s", log=True),
    (*(lagging(1.0, every, every == 2.0) for every in INTERVALS_S), *(lagging(viscosity, 2.0) for viscosity in VISCOSITIES_PA_S[:-1])),
    tip_pressure, check_name="net pressure at the tip, relative difference", section="Permeability while the fracture opens",
)  # fmt: skip

NET_PA, RISE_PA, MANY = 0.3e6, 0.1e6, 10  # net pressure at the start, its rise at the inlet over the run, longest steps in it


@lru_cache
def opened(time_s: float) -> float:
    """By how much the mean opening of the crack grows (m), by 400 equal steps of the model."""
    rest = float((compliance(20)[0] @ np.full(20, NET_PA)).mean())
    return float(reynolds([time_s / 400] * 400, NET_PA, RISE_PA / time_s, 20)[1].mean()) - rest


def mean_opening(run: Run) -> Checked:
    """Growth of the mean opening against the model."""
    every = frames(run, "fracture")
    found = float(every[-1][1]["opening_m"].mean() - every[0][1]["opening_m"].mean())
    if len(every) != MANY + 1:
        raise LoadError(f"{run.folder}: {len(every)} outputs")
    return close(found, opened(every[-1][0]), 0.08, f"{run.summary.steps} steps")


def coupled(step_s: float) -> tuple[str, ...]:
    """A run whose steps nothing holds back until they are so long."""
    inlet = f"fluid.inlet={{start_Pa={2.0e6 + NET_PA!r},rate_Pa_s={RISE_PA / (MANY * step_s)!r}}}"
    held_by_nothing = ("numerics.flow_error=1", "numerics.flow_change=1")
    return "fluid.law=reynolds", *held_by_nothing, inlet, f"stop.time_s={MANY * step_s!r}", f"output.fields_every_s={step_s!r}"


TOGETHER = Family(
    "together", "Flow and rock in one system: runs with long steps",
    "Runs under reynolds whose step control is off follow the crack within 8 % at steps so long that flow and rock one after the other would let errors grow (solver/tests/test_reynolds.cpp).",
    Parameter("longest step", "s", log=True), walked(at_values(CRACK, coupled, "{:g} s"), (0.1, 1.0, 10.0, 100.0), smoke=(1.0,)), mean_opening, beyond=(STABLE,),
    check_name="growth of the mean opening, relative difference", section="Flow that conserves mass, with the rock",
)  # fmt: skip

FAMILIES = (LAG, TOGETHER)
