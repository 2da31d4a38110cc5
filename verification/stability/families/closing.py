"""A fracture that closes under falling pressure: its permeability goes to nothing, and must not take the pressure with it."""

import numpy as np

from verification.harness.load import LoadError, Run, frames, given
from verification.stability.family import MARKED, SCENES, STABLE, Checked, Family, Parameter, Point, at_most, at_values, walked

SCENE = SCENES / "closing.toml"
MOST = 1e-3  # of the pressure at the start: how far pressures may leave the range between it and the inlet's
SECTION, EXCURSION = "Permeability to nothing as a fracture closes", "excursion of the pressure over 0.1 %"


def check(run: Run) -> Checked:
    """How far any pressure left the range between the inlet's and that of the start."""
    start, worst = given(run, "fluid.inlet.start_Pa"), 0.0
    for _, fields in frames(run, "fracture"):
        pressure, opening = fields["pressure_Pa"], fields["opening_m"]
        if not (np.all(np.isfinite(pressure)) and np.all(np.isfinite(opening))):
            raise LoadError(f"{run.folder}: a pressure or an opening is not finite")
        worst = max(worst, float(pressure.max()) - start, float(pressure[0] - pressure.min()))
    if run.summary.inlet_Pa > 0.5 * start:
        raise LoadError(f"{run.folder}: the inlet's pressure has not fallen")
    return at_most(worst / start, MOST, f"pressures leave their range by {100.0 * worst / start:.2g} %")


def over_floor(rule: str) -> Family:
    """The walk over the least opening under a time rule."""
    floors = ("0", "1e-7", "1e-6", "1e-5", "1e-4")
    points = (Point(least, float(least), SCENE, (f"fluid.minimum_opening_m={least}", f"fluid.time_rule={rule}"), smoke=least == "0") for least in floors)
    return Family(f"closing_{rule.replace('-', '_')}", f"k to 0 at closure: {rule}", "Pressures stay finite, and between the inlet's and that of the start.",
                  Parameter("least opening", "m"), tuple(points), check, beyond=(STABLE,), section=SECTION, check_name=EXCURSION)  # fmt: skip


FAMILIES = (
    over_floor("trapezoid"), over_floor("backward-euler"),
    Family(
        "closing_rate", "k to 0 at closure: rate of closing, no floor", "However fast the faces meet, pressures stay finite.",
        Parameter("fall of the inlet's pressure", "MPa/s", log=True), walked(at_values(
            SCENE, lambda rate: (f"fluid.inlet.rate_Pa_s=-{rate}e6", f"stop.time_s={2.4 / rate:g}", f"output.fields_every_s={0.12 / rate:g}"), "{:g}",
        ), (5.0, 20.0, 80.0, 320.0), smoke=(80.0,)),
        check, beyond=(STABLE, MARKED), section=SECTION, check_name=EXCURSION,
    ),
)  # fmt: skip
