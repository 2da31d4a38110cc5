"""Points that change cells under large strain: hat functions, averaged ones and quadratic B-splines."""

import math

import numpy as np

from verification.harness.load import Run
from verification.ladder.case import STRESS, field_quantity
from verification.ladder.cases.manufactured import exact_by
from verification.stability.family import MARKED, SCENES, STABLE, At, Checked, Edge, Family, Parameter, Point, at_most, walked

CELL_M = 0.0625  # of the scene; points stand at a quarter and three quarters
AMPLITUDES_M = (0.002, 0.006, 0.010, 0.014, 0.018, 0.022, 0.028, 0.036, 0.046)
MOST = {"linear": 0.1, "gimp": 0.05, "bspline2": 0.05}  # error of the stresses, of their norm, with 16 cells a side


def body(amplitude: float) -> str:
    """The body force of the motion, m/s^2: b = u_tt - (dF_xx/dX)(lambda + 2 mu - J sigma_xx)/(rho F_xx^2), and the like along y."""
    grown = f"{amplitude!r}*pi"
    F_x, F_y = f"(1+{grown}*cos(pi*X)*sin(4000*t))", f"(1-{grown}*cos(pi*Y)*sin(4000*t))"
    stiff, lame, shear = "4e6*0.8/0.72", "4e6*0.2/0.72", "4e6/1.2"
    first, second = (
        f"{amplitude!r}*sin(pi*{axis})*sin(4000*t)*(-4000^2 + pi^2*({stiff} - {lame}*ln({F_x}*{F_y}) - {shear}*ln({F}))/{F}^2)"
        for axis, F in (("X", F_x), ("Y", F_y))
    )
    return f'body.acceleration_m_s2=["{first}", "-1*{second}"]'


def first_crossing() -> float:
    """The amplitude (m) at which the first point of the lattice reaches a border of its cell."""
    places = (np.arange(round(2.0 / CELL_M)) + 0.5) * 0.5 * CELL_M
    towards_right = np.ceil(places / CELL_M) * CELL_M - places
    towards_left = places - np.floor(places / CELL_M) * CELL_M
    along = np.sin(math.pi * places)
    return float(min(np.min(towards_right / along), np.min(towards_left / along)))


def check(run: Run) -> Checked:
    """The stresses of all points against the exact ones."""
    amplitude = float(str(run.scene["body"]["acceleration_m_s2"][0]).split("*")[0])
    motion = {"side_m": 1.0, "amplitude_m": amplitude, "halves": 1, "law": "hencky", "angular_frequency_1_s": 4000.0, "phase_rad": math.pi}
    error = abs(field_quantity("stress", "Pa", STRESS, exact_by("manufactured_finite", motion, "tau")).sample(run).error())
    return at_most(error, MOST[str(run.scene["numerics"]["shape"])], f"stress off by {100.0 * error:.2g} % of its norm")


def at(shape: str) -> At:
    """A run with an amplitude under a shape."""

    def point(value: float) -> Point:
        amplitude = float(f"{value:.6g}")
        speed = f'initial.velocity_m_s=["4000*{amplitude!r}*sin(pi*X)", "-4000*{amplitude!r}*sin(pi*Y)"]'
        return Point(f"{1000.0 * amplitude:.5g} mm", amplitude, SCENES / "crossing.toml", (f"numerics.shape={shape}", body(amplitude), speed))

    return point


def family(shape: str, name: str, edge: Edge | None = None) -> Family:
    """The walk over the amplitude under a shape."""
    return Family(
        f"crossing_{shape}", f"Cell crossing: {name}", "Stresses must be right, or the run marked, however far points go.", Parameter("amplitude", "m"),
        walked(at(shape), AMPLITUDES_M, smoke=(0.010, 0.028)), check, beyond=(STABLE, MARKED) if edge is None else (MARKED,), before=(STABLE, MARKED),
        edge=edge, section="Cell crossing under large strain", check_name="error of the stress over its bound",
    )  # fmt: skip


FAMILIES = (
    family("linear", "hat functions", Edge("Geometry: the first point of the lattice to reach a border of its cell, h/4 away, at A sin(pi X) = h/4.",
                                           first_crossing, at("linear"), (0.010, 0.022), by_check=True)),
    family("gimp", "uGIMP"), family("bspline2", "quadratic B-spline"),
)  # fmt: skip
