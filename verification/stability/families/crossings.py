"""A fracture that crosses an interface at an angle, two interfaces closer than a cell, a fracture that meets a corner or an edge."""

import math

import numpy as np

from verification.harness.load import LoadError, Run, given, last, path_key, rock
from verification.harness.paths import ANALYTIC
from verification.stability.family import (
    AT_REST, CRACK, MARKED, MIDDLE_M, REFUSED, STABLE, Checked, Family, Parameter, at_most, at_values, close, farthest_off, griffith_K,
    layers_setting, parted, tip_is_near, upright, walked,
)  # fmt: skip

SECTION = "Fractures that cross interfaces, corners, edges"
CROSSING_M = 13.0  # half length of these cracks: at 20 degrees their tips are 4.4 cells from the interface
ANGLES = (90.0, 75.0, 60.0, 45.0, 30.0, 20.0)

STIFF_SPRINGS = (*parted("stiff", "stiff", "springs"), *(f"interface.springs.{name}_stiffness_Pa_m=1e14" for name in ("normal", "shear")))
STUCK = (*parted("stiff", "stiff", "slick"), "interface.slick.coefficient=5")


def through(angle: float) -> str:
    """A crack whose middle is on the interface, at an angle (degrees) to it; more than 90 leans the other way."""
    dx, dy = CROSSING_M * math.cos(math.radians(angle)), CROSSING_M * math.sin(math.radians(angle))
    return path_key((MIDDLE_M - dx, MIDDLE_M - dy), (MIDDLE_M + dx, MIDDLE_M + dy))


def no_effect(run: Run) -> Checked:
    """K_I of both tips against p sqrt(pi a), as if there were no interface; J is finite and the fracture's points are apart."""
    K, fracture = griffith_K(run), last(run, "fracture")[1]
    steps = np.hypot(np.diff(fracture["x_m"]), np.diff(fracture["y_m"]))
    if not np.all(steps > 1e-3) or not all(math.isfinite(tip.J_N_m) for tip in run.summary.tips):
        raise LoadError(f"{run.folder}: a segment of no length, or J that is not finite")
    return close(farthest_off([tip.K_I_Pa_sqrt_m for tip in run.summary.tips], K), K, 0.025, "K_I")


def crossing(name: str, title: str, keys: tuple[str, ...]) -> Family:
    """A crack through an interface that must have no effect: K_I as in one rock."""
    return Family(
        f"crossing_{name}", title, "An interface that nothing moves has no effect: K_I is that of the crack in one rock, whatever the angle.",
        Parameter("angle between fracture and interface", "degrees"),
        walked(at_values(CRACK, lambda angle: (*AT_REST, *keys, through(angle)), "{:g} degrees"),
               (*ANGLES, *(180.0 - angle for angle in ANGLES[1:])), smoke=(90.0, 30.0)),
        no_effect, beyond=(STABLE, MARKED), section=SECTION,
        flag=lambda run: "both tips are near something" if all(tip["near"] for tip in run.summary.raw["tips"]) else "",
    )  # fmt: skip


SPRINGS = (1e9, 3e9)  # Pa/m
TABLES = tuple(
    f'interface.{name}={{law="soft",normal_stiffness_Pa_m={D!r},shear_stiffness_Pa_m={D!r},compression="spring"}}'
    for name, D in zip(("lower", "upper"), SPRINGS)
)


def hanging(run: Run) -> Checked:
    """u_y of a bar under its own weight with two springs in it: -(rho g/M)(H y - y^2/2), less rho g (H - y_k)/D_k above each."""
    E, nu, weight = rock(run, density=True).values()  # g is 1 m/s^2
    M, H = E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)), given(run, "domain.height_m")
    particles = last(run, "particles")[1]
    y = particles["y_m"]
    exact = -weight / M * (H * y - 0.5 * y**2)
    for place, D in zip(run.interfaces_m, SPRINGS):
        exact -= np.where(y > place, weight * (H - place) / D, 0.0)
    off = float(np.sqrt(np.mean((particles["u_y_m"] - exact) ** 2) / np.mean(exact**2)))
    return at_most(off, 2e-3, "rms of u_y off the closed form, over its own")


CLOSE = Family(
    "interfaces_close", "Two interfaces closer than a cell",
    "Springs in series, D1 D2/(D1 + D2), however near; where the upper one is neither on a grid line nor at mid-cell the scene is refused.",
    Parameter("distance of the interfaces", "cells"),
    walked(at_values(ANALYTIC / "own_weight.toml",
                     lambda cells: (*layers_setting(("stiff", 4.0), ("stiff", cells), ("stiff", None), interfaces=("lower", "upper")), *TABLES), "{:g} cells"),
           (0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0), smoke=(0.25, 0.5), beyond=lambda cells: cells in (0.25, 0.75)),
    hanging, beyond=(REFUSED,), section=SECTION,
)  # fmt: skip

BLOCK_M = 32.0


def diagonal(run: Run) -> Checked:
    """K_II of the tip near the corner against none, over K_I: the crack lies on the diagonal, which is a line of symmetry."""
    near = max(run.summary.tips, key=lambda tip: tip.x_m)
    return at_most(abs(near.K_II_Pa_sqrt_m) / near.K_I_Pa_sqrt_m, 0.02, "K_II over K_I on the diagonal")


def corner(cells: float) -> tuple[str, ...]:
    """A crack on the block's diagonal that ends so many cells of 1 m from both edges of a corner."""
    end = BLOCK_M - cells
    return *AT_REST, "domain.beyond_m=0", path_key((end - 7.0, end - 7.0), (end, end))


CORNERS = Family(
    "corner", "A fracture that ends in a corner of the block", "K by symmetry, or flagged: no ring for J fits there.",
    Parameter("distance of the tip from both edges", "cells", log=True),
    walked(at_values(CRACK, corner, "{:g} cells"), (0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0), smoke=(1.0, 6.0), beyond=lambda cells: cells < 3.5),
    diagonal, beyond=(MARKED,), flag=tip_is_near, section=SECTION,
)  # fmt: skip


def stops(run: Run) -> Checked:
    """How far from the top the fracture stopped, in cells: three and less than an increment more, with its reason."""
    tip = max(run.summary.raw["tips"], key=lambda tip: tip["y_m"])
    if tip["growing"] or "edge" not in tip["stopped_by"]:
        raise LoadError(f"{run.folder}: the tip at y = {tip['y_m']} m has not stopped at the edge")
    left = given(run, "domain.height_m") - float(tip["y_m"])
    return at_most(max(0.0, 3.0 - left) + max(0.0, left - 3.0), run.increment_m, "cells between where it stopped and three from the edge")


def growing(increment: float) -> tuple[str, ...]:
    """A fracture that grows up, and out at the top."""
    return ("domain.beyond_m=0", upright(MIDDLE_M, 25.0, 6.0), "fracture.growth=J", f"fracture.increment_m={increment}",
            "fluid.inlet={start_Pa=2.2e6,rate_Pa_s=0.2e6}", "stop={time_s=10,inlet_Pa=4e6}", "output.fields_every_s=10")  # fmt: skip


OUT = Family(
    "edge_growth", "A fracture that grows towards an edge", "It stops three cells before the edge, and says so.", Parameter("increment", "cells"),
    walked(at_values(CRACK, growing, "{:g} m"), (0.5, 1.0, 2.0, 4.0), smoke=(1.0,)), stops, beyond=(STABLE, MARKED), section=SECTION,
)  # fmt: skip

FAMILIES: tuple[Family, ...] = (
    crossing("springs", "A crack through springs of 1e14 Pa/m", STIFF_SPRINGS),
    crossing("friction", "A crack through an interface that friction holds", STUCK),
    CLOSE, CORNERS, OUT,
)  # fmt: skip
