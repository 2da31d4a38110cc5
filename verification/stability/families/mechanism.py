"""Blocks whose edges are loaded and that an interface without friction parts: a free motion that nothing holds."""
from __future__ import annotations

import numpy as np

from verification.harness.load import Run, frames
from verification.stability.cracks import SCENES
from verification.stability.family import FAILED, Checked, Family, Parameter, Point, at_most

SCENE = SCENES.parents[1] / "analytic" / "static_quasistatic.toml"
STRAIN_AT_MOST_M = 0.02  # 0.5 MPa over 5 GPa along 80 m is 8 mm; parts that move freely go metres


def held(run: Run) -> Checked:
    """The largest displacement of the rock."""
    _, particles = frames(run, "particles")[-1]
    most = float(np.max(np.hypot(particles["u_x_m"], particles["u_y_m"])))
    return at_most(most, STRAIN_AT_MOST_M, "largest displacement")


def point(label: str, friction: float, sides: str, beyond: bool) -> Point:
    """The fracture below an interface without strength, of a residual friction; sides loaded or held."""
    law = f"interface.slick={{law=\"weak\",shear_strength_Pa=1.0,tensile_strength_Pa=1.0,residual_friction={friction}}}"
    return Point(label, friction, SCENE, (f"domain.sides={sides}", law, "output.fields_every_s=4"), "free", smoke=sides == "traction", beyond=beyond)


FAMILIES = (
    Family(
        name="mechanism", title="Loaded edges and an interface without friction, without inertia",
        says="Parts that nothing holds end the run with exit status 3 and its reason; held sides keep it whole.",
        parameter=Parameter("residual friction"),
        points=(
            point("loaded, none", 0.0, "traction", True), point("held, none", 0.0, "fixed", False),
        ),
        check=held, beyond=(FAILED,), section="Mechanisms",
        about="Where the sides are loaded and an interface has failed without friction, its two sides can move against"
              " each other freely: the"
              " equations are singular. Nothing is regularised silently.",
    ),
)  # fmt: skip
