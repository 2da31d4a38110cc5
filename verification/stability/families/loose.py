"""Parts that nothing holds along a cut without friction: with inertia they fly as Newton says, without there is no equilibrium."""

import numpy as np

from verification.harness.load import Run, given, last
from verification.harness.paths import ANALYTIC
from verification.stability.family import FAILED, KINEMATICS, SCENES, STABLE, Checked, Family, Parameter, Point, at_most, close

SCENE = SCENES / "loose.toml"
HEIGHT_M, DENSITY = 4.0, 2500.0  # of the upper block
PUSHED = 'body.acceleration_m_s2=["Y > 4 ? {0} : {1}", "0"]'
SECTION = "Traction edges with a frictionless cut"


def slip_m(run: Run) -> float:
    """Mean slip at the end."""
    return float(np.mean(np.abs(last(run, "interfaces")[1]["0/slip_m"])))


def check_flight(run: Run) -> Checked:
    """The slip against a t^2/2."""
    push = float(str(run.scene["body"]["acceleration_m_s2"][0]).split("?")[1].split(":")[0])
    return close(slip_m(run), 0.5 * push * run.summary.time_s**2, 0.01, f"slip {slip_m(run):.5g} m")


def check_springs(run: Run) -> Checked:
    """The mean slip against rho a H/D."""
    expected = DENSITY * HEIGHT_M / given(run, "interface.slick.shear_stiffness_Pa_m")
    return close(slip_m(run), expected, 1e-6, f"mean slip {slip_m(run):.5g} m")


def spring(stiffness: str, value: float | None = None) -> Point:
    """A run without inertia; a stiffness of nothing stands at 1 Pa/m on the axis."""
    settings = ("numerics.mechanics=quasistatic", "stop.time_s=0", f"interface.slick.shear_stiffness_Pa_m={stiffness}", PUSHED.format(1, -1))
    return Point(stiffness, float(stiffness) if value is None else value, SCENE, settings, smoke=stiffness in ("0", "1e6"), beyond=value is not None)


STRAIN_AT_MOST_M = 0.02  # 0.5 MPa over 5 GPa along 80 m is 8 mm; parts that move freely go metres


def held(run: Run) -> Checked:
    """The largest displacement of the rock."""
    particles = last(run, "particles")[1]
    return at_most(float(np.max(np.hypot(particles["u_x_m"], particles["u_y_m"]))), STRAIN_AT_MOST_M, "largest displacement")


def parted(label: str, sides: str, beyond: bool) -> Point:
    """The fracture below an interface without strength and without friction; sides loaded or held."""
    law = 'interface.slick={law="weak",shear_strength_Pa=1.0,tensile_strength_Pa=1.0,residual_friction=0.0}'
    keys = (f"domain.sides={sides}", law, "output.fields_every_s=4")
    return Point(label, 0.0, ANALYTIC / "static_quasistatic.toml", keys, "free", smoke=beyond, beyond=beyond)


FAMILIES = (
    Family(
        "loose_explicit", "Cut without friction, traction edges: with inertia", "The part that nothing holds moves as Newton says.",
        Parameter("push", "m/s^2", log=True),
        tuple(Point(f"{push:g} m/s2, {kinematics}", push, SCENE, (f"numerics.kinematics={kinematics}", PUSHED.format(push, 0)), smoke=push == 1.0)
              for kinematics in KINEMATICS for push in (0.01, 0.1, 1.0, 10.0)),
        check_flight, beyond=(STABLE,), section=SECTION, check_name="slip over that of Newton less 1",
    ),
    Family(
        "loose_quasistatic", "Cut without friction, traction edges: without inertia",
        "Springs hold the push, however soft (below 1e5 Pa/m they slip by more than half a cell, and the run is marked); without them the run ends and says"
        " that parts move freely.",
        Parameter("D along the cut", "Pa/m", log=True), (*map(spring, ("1e10", "1e8", "1e6", "1e5")), spring("0", 1.0)), check_springs,
        beyond=(FAILED,), section=SECTION, check_name="slip over rho a H/D less 1",
    ),
    Family(
        "mechanism", "Loaded edges and an interface without friction, without inertia",
        "Parts that nothing holds end the run with exit status 3 and its reason; held sides keep it whole.", Parameter("residual friction"),
        (parted("loaded, none", "traction", True), parted("held, none", "fixed", False)), held, beyond=(FAILED,), section="Mechanisms",
    ),
)  # fmt: skip
