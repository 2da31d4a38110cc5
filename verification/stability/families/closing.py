"""A fracture that closes under falling pressure: its permeability goes to nothing, and must not take the pressure with it."""
from __future__ import annotations

import numpy as np

from verification.harness.load import LoadError, Run, frames
from verification.harness.paths import ROOT
from verification.stability.family import MARKED, STABLE, Checked, Family, Parameter, Point, at_most

SCENE = ROOT / "verification" / "stability" / "scenes" / "closing.toml"
MOST = 1e-3  # of the pressure at the start: how far pressures may leave the range between it and the inlet's

ABOUT = (
    "A fracture is open under 3 MPa, 1 MPa above the closing stress; the inlet's pressure then falls to 0.6 MPa. Its faces meet from the inlet on, and without a"
    " floor of the opening nothing conducts there any more: the fluid behind stays where it is, at a little more than the closing stress. Diffusion"
    " makes no pressure outside the range of those it was given: everything must stay finite and between the inlet's and the first."
)


def check(run: Run) -> Checked:
    """How far any pressure left the range between the inlet's and that of the start."""
    start = float(run.scene["fluid"]["inlet"]["start_Pa"])
    worst = 0.0
    for _, fields in frames(run, "fracture"):
        pressure, opening = fields["pressure_Pa"], fields["opening_m"]
        if not (np.all(np.isfinite(pressure)) and np.all(np.isfinite(opening))):
            raise LoadError(f"{run.folder}: a pressure or an opening is not finite")
        worst = max(worst, float(pressure.max()) - start, float(pressure[0] - pressure.min()))
    if run.summary.inlet_Pa > 0.5 * start:
        raise LoadError(f"{run.folder}: the inlet's pressure has not fallen")
    return at_most(worst / start, MOST, f"pressures leave their range by {100.0 * worst / start:.2g} %")


def point(label: str, value: float, *settings: str, smoke: bool = False) -> Point:
    """A run with further settings."""
    return Point(label, value, SCENE, settings, smoke=smoke)


PERMEABLE = ("0", "1e-7", "1e-6", "1e-5", "1e-4")
RATES = (5.0, 20.0, 80.0, 320.0)

FAMILIES = (
    *(Family(
        f"closing_{rule.replace('-', '_')}", f"k to 0 at closure: {rule}", "Pressures stay finite, and between the inlet's and that of the start.",
        Parameter("least opening", "m"), tuple(point(floor, float(floor), f"fluid.minimum_opening_m={floor}", f"fluid.time_rule={rule}", smoke=floor == "0") for floor in PERMEABLE),
        check, beyond=(STABLE,), section="Permeability to nothing as a fracture closes", about=ABOUT, check_name="excursion of the pressure over 0.1 %",
    ) for rule in ("trapezoid", "backward-euler")),
    Family(
        "closing_rate", "k to 0 at closure: rate of closing, no floor", "However fast the faces meet, pressures stay finite.", Parameter("fall of the inlet's pressure", "MPa/s", log=True),
        tuple(point(f"{rate:g}", rate, f"fluid.inlet.rate_Pa_s=-{rate}e6", f"stop.time_s={2.4 / rate:g}", f"output.fields_every_s={0.12 / rate:g}", smoke=rate == 80.0) for rate in RATES),
        check, beyond=(STABLE, MARKED), section="Permeability to nothing as a fracture closes", check_name="excursion of the pressure over 0.1 %",
    ),
)  # fmt: skip
