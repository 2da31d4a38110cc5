"""Blocks whose edges are loaded and that an interface without friction parts: a free motion that nothing holds."""
from __future__ import annotations

import numpy as np

from verification.harness.given import last
from verification.harness.load import Run
from verification.harness.paths import ANALYTIC
from verification.stability.family import FAILED, Checked, Family, Parameter, Point, at_most

STRAIN_AT_MOST_M = 0.02  # 0.5 MPa over 5 GPa along 80 m is 8 mm; parts that move freely go metres


def held(run: Run) -> Checked:
    """The largest displacement of the rock."""
    particles = last(run, "particles")[1]
    return at_most(float(np.max(np.hypot(particles["u_x_m"], particles["u_y_m"]))), STRAIN_AT_MOST_M, "largest displacement")


def point(label: str, sides: str, beyond: bool) -> Point:
    """The fracture below an interface without strength and without friction; sides loaded or held."""
    law = 'interface.slick={law="weak",shear_strength_Pa=1.0,tensile_strength_Pa=1.0,residual_friction=0.0}'
    keys = (f"domain.sides={sides}", law, "output.fields_every_s=4")
    return Point(label, 0.0, ANALYTIC / "static_quasistatic.toml", keys, "free", smoke=beyond, beyond=beyond)


FAMILIES = (
    Family(
        "mechanism", "Loaded edges and an interface without friction, without inertia",
        "Parts that nothing holds end the run with exit status 3 and its reason; held sides keep it whole.", Parameter("residual friction"),
        (point("loaded, none", "traction", True), point("held, none", "fixed", False)), held, beyond=(FAILED,), section="Mechanisms",
    ),
)  # fmt: skip
