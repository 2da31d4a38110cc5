"""Stick-slip and chatter: two blocks that are pressed together and pushed past each other; interface springs from soft to stiff, explicit: a pulse meets them in a
column of rock, against the exact wave."""

from collections.abc import Mapping

import numpy as np

from verification.harness.load import LoadError, Run, given
from verification.ladder.cases.waves import SCENE as COLUMN, VELOCITY
from verification.stability.family import KINEMATICS, MARKED, SCENES, STABLE, Checked, Edge, Family, Parameter, Point, at_most, at_values, close, walked

NORMAL_PA, HEIGHT_M, WIDTH_M, DENSITY = 1.0e6, 16.0, 2.0, 2500.0  # of the scene, a block's width
PUSH_FROM_S, PUSH_M_S3, END_S = 0.05, 2000.0, 0.15
MOST_PUSH_PA = DENSITY * WIDTH_M * PUSH_M_S3 * (END_S - PUSH_FROM_S)
READ_FROM = "5"  # the run that slides longest tells best when it began


def slip_m(coefficient: float, time_s: float = END_S) -> float:
    """Slip of two rigid blocks at a time."""
    since = time_s - PUSH_FROM_S - coefficient * NORMAL_PA / (DENSITY * WIDTH_M * PUSH_M_S3)
    return 2.0 * PUSH_M_S3 * max(since, 0.0) ** 3 / 6.0


def check(run: Run) -> Checked:
    """The work of friction against that of rigid blocks, over what a slide without friction would have made of mu N."""
    mu = given(run, "interface.rough.coefficient")
    strength = mu * NORMAL_PA * HEIGHT_M
    found, expected = run.summary.energy["friction_J"], strength * slip_m(mu)
    return close(found, expected, 0.02, f"work of friction {found:.4g} J/m, of rigid blocks {expected:.4g} J/m", scale=strength * slip_m(0.0))


def onset(runs: Mapping[str, Run]) -> float:
    """Push over mu N at which the slide began: the power of friction rises with the square of the time since then."""
    run = runs.get(READ_FROM)
    if run is None:
        raise LoadError(f"the run {READ_FROM} did not complete")
    time, energy = run.history["time_s"], run.history["friction_J"]
    root = np.sqrt(np.maximum(np.diff(energy) / np.diff(time), 0.0))
    middle = 0.5 * (time[1:] + time[:-1])
    late = root > 0.2 * root.max()
    slope, constant = np.polyfit(middle[late], root[late], 1)
    push = DENSITY * WIDTH_M * PUSH_M_S3 * (-constant / slope - PUSH_FROM_S)
    return float(push / (given(run, "interface.rough.coefficient") * NORMAL_PA))


def family(kinematics: str) -> Family:
    """The walk over the push's largest value by mu N."""
    at = at_values(SCENES / "sliding.toml", lambda ratio: (
        f"numerics.kinematics={kinematics}", f"interface.rough.coefficient={MOST_PUSH_PA / NORMAL_PA / ratio:.6g}"), "{:g}")  # fmt: skip
    return Family(
        f"sliding_{kinematics}", f"Stick and slip: {KINEMATICS[kinematics]}",
        "Blocks stick until the push is mu N, then slide as rigid ones do, and the work of friction is mu N times the slip.",
        Parameter("largest push over mu N"),
        walked(at, (0.5, 0.9, 1.2, 2.0, 3.0, 5.0), smoke=(0.5, 2.0) if kinematics == "total" else (2.0,)),
        check, beyond=(STABLE,), section="Contact: stick, slip and chatter", check_name="work of friction less that of rigid blocks",
        edge=Edge("Coulomb: the slide begins at a push of mu N.", lambda: 1.0, read=onset),
    )  # fmt: skip


SLIDING_FAMILIES = tuple(map(family, KINEMATICS))

MOST = {"total": 0.033, "updated": 0.065}  # error of the velocity, of its norm: what such cells make of a pulse that meets no interface (ladder: plane_wave)


def wave_check(run: Run) -> Checked:
    """The velocity all along the column against the exact wave."""
    error = abs(VELOCITY.sample(run).error())
    return at_most(error, MOST[str(run.scene["numerics"]["kinematics"])], f"velocity off by {100.0 * error:.2g} % of its norm")


def sprung(kinematics: str, decade: int) -> Point:
    """A run with springs of a power of ten."""
    springs = (f"interface.spring.{name}_stiffness_Pa_m=1e{decade}" for name in ("normal", "shear"))
    keys = (f"numerics.kinematics={kinematics}", "numerics.cell_m=0.125", *springs)
    return Point(f"1e{decade}", 10.0**decade, COLUMN, keys, "spring", smoke=decade in (3, 15))


SPRING_FAMILIES = tuple(
    Family(
        f"springs_{kinematics}", f"Springs of an interface: {points}",
        "Springs of any stiffness pass the pulse as the exact wave has it, with the rock's own time step.", Parameter("D", "Pa/m", log=True),
        tuple(sprung(kinematics, decade) for decade in range(3, 16)), wave_check,
        beyond=(STABLE, MARKED), section="Stiff and soft springs of an interface", check_name="error of the velocity over its bound",
    )
    for kinematics, points in KINEMATICS.items()
)  # fmt: skip

FAMILIES = (*SLIDING_FAMILIES, *SPRING_FAMILIES)
