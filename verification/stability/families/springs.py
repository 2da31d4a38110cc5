"""Interface springs from soft to stiff, explicit: a pulse meets them in a column of rock, against the exact wave."""

from verification.harness.load import Run
from verification.ladder.cases.waves import SCENE, VELOCITY
from verification.stability.family import KINEMATICS, MARKED, STABLE, Checked, Family, Parameter, Point, at_most

MOST = {"total": 0.033, "updated": 0.065}  # error of the velocity, of its norm: what such cells make of a pulse that meets no interface (ladder: plane_wave)


def check(run: Run) -> Checked:
    """The velocity all along the column against the exact wave."""
    error = abs(VELOCITY.sample(run).error())
    return at_most(error, MOST[str(run.scene["numerics"]["kinematics"])], f"velocity off by {100.0 * error:.2g} % of its norm")


def point(kinematics: str, decade: int) -> Point:
    """A run with springs of a power of ten."""
    springs = (f"interface.spring.{name}_stiffness_Pa_m=1e{decade}" for name in ("normal", "shear"))
    keys = (f"numerics.kinematics={kinematics}", "numerics.cell_m=0.125", *springs)
    return Point(f"1e{decade}", 10.0**decade, SCENE, keys, "spring", smoke=decade in (3, 15))


FAMILIES = tuple(
    Family(
        f"springs_{kinematics}", f"Springs of an interface: {points}",
        "Springs of any stiffness pass the pulse as the exact wave has it, with the rock's own time step.", Parameter("D", "Pa/m", log=True),
        tuple(point(kinematics, decade) for decade in range(3, 16)), check,
        beyond=(STABLE, MARKED), section="Stiff and soft springs of an interface", check_name="error of the velocity over its bound",
    )
    for kinematics, points in KINEMATICS.items()
)  # fmt: skip
