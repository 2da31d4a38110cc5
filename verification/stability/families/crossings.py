"""A fracture that crosses an interface at an angle, two interfaces closer than a cell, a fracture that meets a corner or an edge."""
from __future__ import annotations

import math

import numpy as np

from verification.harness.load import LoadError, Run, frames
from verification.stability.cracks import (
    AT_REST,
    CRACK,
    MIDDLE_M,
    SCENES,
    farthest_off,
    griffith_K,
    layers_setting,
    path_setting,
)
from verification.stability.family import MARKED, REFUSED, STABLE, Checked, Family, Parameter, Point, at_most, close, tip_is_near

SECTION = "Fractures that cross interfaces, corners, edges"
ABOUT = (
    "Where a fracture crosses an interface nodes have up to four copies, and the smaller the angle the less rock some of"
    " them have. Other codes"
    " give a fracture a segment of no length there, turn it back, or let the energy grow without bound."
)
CROSSING_M = 13.0  # half length of these cracks: at 20 degrees their tips are 4.4 cells from the interface
ANGLES = (90.0, 75.0, 60.0, 45.0, 30.0, 20.0)

# --- an interface that does nothing
SAME = layers_setting(("stiff", MIDDLE_M), ("stiff", None), interfaces=("springs",))
STIFF_SPRINGS = tuple(f"interface.springs.{name}_stiffness_Pa_m=1e14" for name in ("normal", "shear"))
STUCK = (
    *layers_setting(("stiff", MIDDLE_M), ("stiff", None), interfaces=("slick",)), "interface.slick.coefficient=5",
)  # fmt: skip


def through(angle: float, middle: float = MIDDLE_M) -> str:
    """A crack whose middle is on the interface, at an angle (degrees) to it; more than 90 leans the other way."""
    along = math.radians(angle)
    dx, dy = CROSSING_M * math.cos(along), CROSSING_M * math.sin(along)
    return path_setting((MIDDLE_M - dx, middle - dy), (MIDDLE_M + dx, middle + dy))


def no_effect(run: Run) -> Checked:
    """K_I of both tips against p sqrt(pi a), as if there were no interface; J is finite and the fracture's points are apart."""
    K = griffith_K(run)
    _, fracture = frames(run, "fracture")[-1]
    steps = np.hypot(np.diff(fracture["x_m"]), np.diff(fracture["y_m"]))
    if not np.all(steps > 1e-3) or not all(math.isfinite(tip.J_N_m) for tip in run.summary.tips):
        raise LoadError(f"{run.folder}: a segment of no length, or J that is not finite")
    return close(farthest_off([tip.K_I_Pa_sqrt_m for tip in run.summary.tips], K), K, 0.025, "K_I")


def crossing(name: str, title: str, keys: tuple[str, ...]) -> Family:
    """A crack through an interface that must have no effect: K_I as in one rock."""
    points = tuple(
        Point(f"{angle:g} degrees", angle, CRACK, (*AT_REST, *keys, through(angle)), smoke=angle in (90.0, 30.0))
        for angle in (*ANGLES, *(180.0 - angle for angle in ANGLES[1:]))
    )
    return Family(
        name=f"crossing_{name}", title=title,
        says="An interface that nothing moves has no effect: K_I is that of the crack in one rock, whatever the angle.",
        parameter=Parameter("angle between fracture and interface", "degrees"), points=points, check=no_effect, beyond=(STABLE, MARKED),
        section=SECTION, about=ABOUT, flag=tips_are_near,
    )  # fmt: skip


def tips_are_near(run: Run) -> str:
    """The mark of a run all of whose tips are too near to something."""
    return "both tips are near something" if all(tip["near"] for tip in run.summary.raw["tips"]) else ""


# --- two interfaces closer than a cell
GAPS = (0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0)
SPRINGS = (1e9, 3e9)  # Pa/m
BAR = SCENES.parents[1] / "analytic" / "own_weight.toml"


def hanging(run: Run) -> Checked:
    """u_y of a bar under its own weight with two springs in it: -(rho g/M)(H y - y^2/2), less rho g (H - y_k)/D_k above each."""
    rock = run.scene["rock"]["stiff"]
    E, nu, weight = float(rock["youngs_modulus_Pa"]), float(rock["poisson_ratio"]), float(rock["density_kg_m3"])  # g is 1 m/s^2
    M, H = E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)), float(run.scene["domain"]["height_m"])
    _, particles = frames(run, "particles")[-1]
    y = particles["y_m"]
    exact = -weight / M * (H * y - 0.5 * y**2)
    for place, D in zip(run.interfaces_m, SPRINGS):
        exact -= np.where(y > place, weight * (H - place) / D, 0.0)
    off = float(np.sqrt(np.mean((particles["u_y_m"] - exact) ** 2) / np.mean(exact**2)))
    return at_most(off, 2e-3, "rms of u_y off the closed form, over its own")


def gap_point(gap: float) -> Point:
    """Two springs at 4 m and so many cells of 1 m above."""
    tables = tuple(
        f'interface.{name}={{law="soft",normal_stiffness_Pa_m={D!r},shear_stiffness_Pa_m={D!r},compression="spring"}}'
        for name, D in zip(("lower", "upper"), SPRINGS)
    )
    layers = layers_setting(("stiff", 4.0), ("stiff", gap), ("stiff", None), interfaces=("lower", "upper"))
    return Point(f"{gap:g} cells", gap, BAR, (*layers, *tables), smoke=gap in (0.25, 0.5), beyond=gap in (0.25, 0.75))


CLOSE = Family(
    name="interfaces_close", title="Two interfaces closer than a cell",
    says="Springs in series, D1 D2/(D1 + D2), however near; where the upper one is neither on a grid line nor at mid-cell"
         " the scene is refused.",
    parameter=Parameter("distance of the interfaces", "cells"), points=tuple(gap_point(gap) for gap in GAPS), check=hanging, beyond=(REFUSED,),
    section=SECTION,
)  # fmt: skip


# --- corners and edges
CORNER = (0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0)
BLOCK_M = 32.0


def diagonal(run: Run) -> Checked:
    """K_II of the tip near the corner against none, over K_I: the crack lies on the diagonal, which is a line of symmetry."""
    near = max(run.summary.tips, key=lambda tip: tip.x_m)
    return at_most(abs(near.K_II_Pa_sqrt_m) / near.K_I_Pa_sqrt_m, 0.02, "K_II over K_I on the diagonal")


def corner_point(cells: float) -> Point:
    """A crack on the block's diagonal that ends so many cells of 1 m from both edges of a corner."""
    end = BLOCK_M - cells
    keys = ("domain.beyond_m=0", path_setting((end - 7.0, end - 7.0), (end, end)))
    return Point(f"{cells:g} cells", cells, CRACK, (*AT_REST, *keys), smoke=cells in (1.0, 6.0), beyond=cells < 3.5)


CORNERS = Family(
    name="corner", title="A fracture that ends in a corner of the block", says="K by symmetry, or flagged: no ring for J fits there.",
    parameter=Parameter("distance of the tip from both edges", "cells", log=True), points=tuple(corner_point(cells) for cells in CORNER),
    check=diagonal, beyond=(MARKED,), flag=tip_is_near, section=SECTION,
)  # fmt: skip

INCREMENTS = (0.5, 1.0, 2.0, 4.0)


def stops(run: Run) -> Checked:
    """How far from the top the fracture stopped, in cells: three and less than an increment more, with its reason."""
    tip = max(run.summary.raw["tips"], key=lambda tip: tip["y_m"])
    if tip["growing"] or "edge" not in tip["stopped_by"]:
        raise LoadError(f"{run.folder}: the tip at y = {tip['y_m']} m has not stopped at the edge")
    left = float(run.scene["domain"]["height_m"]) - float(tip["y_m"])
    return at_most(max(0.0, 3.0 - left) + max(0.0, left - 3.0), run.increment_m, "cells between where it stopped and three from the edge")


def growing_point(increment: float, side: str) -> Point:
    """A fracture that grows up, and out at the top, alone or with an interface beside it."""
    keys: tuple[str, ...] = (
        "domain.beyond_m=0", path_setting((MIDDLE_M, 19.0), (MIDDLE_M, 25.0)), "fracture.growth=J", f"fracture.increment_m={increment}",
        "fluid.inlet={start_Pa=2.2e6,rate_Pa_s=0.2e6}", "stop={time_s=10,inlet_Pa=4e6}", "output.fields_every_s=10",
    )  # fmt: skip
    if side:
        keys += layers_setting(("stiff", 29.0), ("stiff", None), interfaces=("slick",)) + ("interface.slick.coefficient=0.6",)
    return Point(f"{increment:g} m", increment, CRACK, keys, smoke=increment == 1.0)


OUT = Family(
    name="edge_growth", title="A fracture that grows towards an edge", says="It stops three cells before the edge, and says so.",
    parameter=Parameter("increment", "cells"), points=tuple(growing_point(increment, "") for increment in INCREMENTS), check=stops,
    beyond=(STABLE, MARKED), section=SECTION,
)  # fmt: skip


FAMILIES: tuple[Family, ...] = (
    crossing("springs", "A crack through springs of 1e14 Pa/m", (*SAME, *STIFF_SPRINGS)),
    crossing("friction", "A crack through an interface that friction holds", STUCK),
    CLOSE, CORNERS, OUT,
)  # fmt: skip
