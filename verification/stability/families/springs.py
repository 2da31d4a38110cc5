"""Interface springs from soft to stiff, explicit: a pulse meets them in a column of rock, against the exact wave."""
from __future__ import annotations

from verification.harness.load import Run
from verification.ladder.cases.waves import SCENE, measured
from verification.stability.family import MARKED, STABLE, Checked, Family, Parameter, Point, at_most

DECADES = range(3, 16)
CELL_M = 0.125
MOST = {"total": 0.033, "updated": 0.065}  # error of the velocity, of its norm: what such cells make of a pulse that meets no interface (ladder: plane_wave)

ABOUT = (
    "A pulse of velocity meets an interface whose springs have 1e3 to 1e15 Pa/m, and is turned, split or let through; the exact wave of a layered column"
    " with a spring (strata-reference layered_wave) is the reference. Springs are taken at the step's end: a free one would need steps of"
    " 2 sqrt(m/(D A)), a nanosecond at 1e15 Pa/m."
)


def check(run: Run) -> Checked:
    """The velocity all along the column against the exact wave."""
    velocity = next(quantity for quantity in measured() if quantity.name == "velocity")
    error = abs(velocity.sample(run).error())
    return at_most(error, MOST[str(run.scene["numerics"]["kinematics"])], f"velocity off by {100.0 * error:.2g} % of its norm")


def family(kinematics: str) -> Family:
    """The walk over the springs' stiffness in a kinematics."""
    points = tuple(
        Point(f"1e{decade}", 10.0**decade, SCENE,
              (f"numerics.kinematics={kinematics}", f"numerics.cell_m={CELL_M}", f"interface.spring.normal_stiffness_Pa_m=1e{decade}", f"interface.spring.shear_stiffness_Pa_m=1e{decade}"),
              "spring", smoke=decade in (3, 15))
        for decade in DECADES
    )  # fmt: skip
    return Family(
        f"springs_{kinematics}", f"Springs of an interface: {'points in their places' if kinematics == 'total' else 'points that move'}",
        "Springs of any stiffness pass the pulse as the exact wave has it, with the rock's own time step.", Parameter("D", "Pa/m", log=True), points, check,
        beyond=(STABLE, MARKED), section="Stiff and soft springs of an interface", about=ABOUT, check_name="error of the velocity over its bound",
    )  # fmt: skip


FAMILIES = (family("total"), family("updated"))
