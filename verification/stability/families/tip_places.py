"""Where a tip stands: within its cell, near an interface, near an edge of the block."""
from __future__ import annotations

import math
from collections.abc import Callable

from verification.harness.load import Run
from verification.harness.reference import value
from verification.stability.cracks import (
    AT_REST,
    CRACK,
    HALF_LENGTH_M,
    MIDDLE_M,
    NET_PA,
    SETTLING,
    crack_ends,
    griffith_K,
    half_length,
    layers_setting,
    path_setting,
    upper_tip,
)
from verification.stability.family import MARKED, Checked, Edge, Family, Parameter, Point, close, tip_is_near

SECTION = "Tips: within a cell, near an interface, near an edge"

# --- within a cell
SHARES = (0.0, 0.001, 0.01, 0.03, 0.1, 0.25, 0.5, 0.75, 0.9, 0.97, 0.99, 0.999, 1.0)
ABOUT = (
    "A tip within a cell: nodes split behind it only, so that K would jump by 6 % from one row of nodes to the next; a"
    " spring at the last row"
    " (tip tie) carries what is left of the cell. Near an interface no ring for J fits between the tip's own error and the"
    " other rock: from 4 cells"
    " on down K is flagged. Near an edge of the block the same, from 3.5 cells on down."
)


def K_in_cell(run: Run) -> Checked:
    """K_I of the tip that moves against p sqrt(pi a)."""
    return close(upper_tip(run).K_I_Pa_sqrt_m, griffith_K(run), 0.002, "K_I of the upper tip")


def K_of_hats(run: Run) -> Checked:
    """The same where hat functions alone cost 0.5 to 0.7 %."""
    return close(upper_tip(run).K_I_Pa_sqrt_m, griffith_K(run), 0.01, "K_I of the upper tip")


def in_cell(
    name: str, keys: tuple[str, ...], how: str, x_m: float = MIDDLE_M, shares: tuple[float, ...] = SHARES,
    check: Callable[[Run], Checked] = K_in_cell,
) -> Family:  # fmt: skip
    """A tip at a share of a cell above a row of nodes."""
    points = tuple(
        Point(f"{share:g}", share, CRACK, (*keys, path_setting((x_m, 11.0), (x_m, 21.0 + share))), smoke=share in (0.03, 0.5))
        for share in shares
    )
    return Family(
        name=f"tip_in_cell{name}", title=f"A tip within a cell, {how}", says="K_I must not depend on where in its cell a tip stands.",
        parameter=Parameter("tip above a row of nodes", "cells"), points=points, check=check, section=SECTION, about=ABOUT,
    )  # fmt: skip


# --- near an interface
DISTANCES = (0.01, 0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 3.9, 4.1, 5.0, 6.0, 8.0)


def near_setting(cells: float, parallel: bool = False) -> tuple[str, ...]:
    """A crack whose upper tip (or side) is so many cells of 0.25 m below (left of) the middle of the block; the grid is uniform there."""
    gap, a = 0.25 * cells, HALF_LENGTH_M
    if parallel:
        return (path_setting((MIDDLE_M - gap, MIDDLE_M - a), (MIDDLE_M - gap, MIDDLE_M + a)),)
    return (path_setting((MIDDLE_M, MIDDLE_M - gap - 2.0 * a), (MIDDLE_M, MIDDLE_M - gap)), "numerics.cell_m=0.25", "numerics.far_cell_m=1")


def gap_m(run: Run) -> float:
    """From the upper tip to the interface, m."""
    return MIDDLE_M - max(end[1] for end in crack_ends(run))


def bonded_K(run: Run) -> Checked:
    """K_I at the near tip against the integral equation of Cook and Erdogan."""
    rocks = [run.scene["rock"][layer["rock"]] for layer in run.scene["strata"]["layers"]]
    settings: dict[str, float] = {"half_length_m": half_length(run), "distance_m": gap_m(run), "pressure_Pa": NET_PA}
    for prefix, rock in zip(("", "beyond_"), rocks):
        settings |= {f"{prefix}{key}": float(rock[key]) for key in ("youngs_modulus_Pa", "poisson_ratio")}
    return close(upper_tip(run).K_I_Pa_sqrt_m, value("bonded_normal", "K_I_near", **settings), 0.01, "K_I of the near tip")


def spring_K(run: Run) -> Checked:
    """K_I at the tip near springs against their integral equation."""
    law, rock = run.scene["interface"]["springs"], run.scene["rock"]["stiff"]
    settings: dict[str, float] = {"half_length_m": half_length(run), "distance_m": gap_m(run), "pressure_Pa": NET_PA}
    settings |= {key: float(law[key]) for key in ("normal_stiffness_Pa_m", "shear_stiffness_Pa_m")}
    settings |= {key: float(rock[key]) for key in ("youngs_modulus_Pa", "poisson_ratio")}
    return close(upper_tip(run).K_I_Pa_sqrt_m, value("spring_interface", "K_I_near", **settings), 0.01, "K_I of the near tip")


LAYERS = {
    "stiff_soft": layers_setting(("stiff", MIDDLE_M), ("soft", None)),
    "soft_stiff": layers_setting(("soft", MIDDLE_M), ("stiff", None)),
    "springs": layers_setting(("stiff", MIDDLE_M), ("stiff", None), interfaces=("springs",)),
}


def near_interface(kind: str, how: str, check: Callable[[Run], Checked]) -> Family:
    """A tip at so many cells from an interface."""

    def at(cells: float) -> Point:
        return Point(f"{cells:.5g} cells", cells, CRACK, (*AT_REST, *LAYERS[kind], *near_setting(cells)))

    points = tuple(
        Point(f"{cells:g} cells", cells, CRACK, (*AT_REST, *LAYERS[kind], *near_setting(cells)), smoke=cells in (1.0, 6.0))
        for cells in DISTANCES
    )
    return Family(
        name=f"tip_near_{kind}", title=f"A tip near an interface: {how}",
        says="K is that of the integral equation within 1 %, or it is flagged.",
        parameter=Parameter("distance of the tip from the interface", "cells", log=True), points=points, check=check, beyond=(MARKED,),
        edge=Edge(
            "Rings for J have an outer radius of 2.5 cells at least, lest the tip's own error fill them, and end a cell"
            " before the interface,"
            " where functions reach over it; with half a cell to spare: 4.",
            predicted=lambda: 4.0, at=at, bracket=(6.0, 2.0), unsound_above=False,
        ),
        flag=tip_is_near, section=SECTION,
    )  # fmt: skip


# --- near an edge
EDGE_CELLS = (1.0, 1.5, 2.0, 3.0, 3.4, 3.6, 4.0, 5.0, 6.0, 8.0, 12.0)
BLOCK_M = 1600.0  # so large that its other edges are not felt


def edge_setting(cells: float) -> tuple[str, ...]:
    """A crack normal to the block's top, its upper tip so many cells of 0.25 m below it."""
    top, x, a = BLOCK_M - 0.25 * cells, 0.5 * BLOCK_M, HALF_LENGTH_M
    sides = ",".join(f'{side}="traction"' for side in ("bottom", "sides", "top"))
    return (f"domain={{width_m={BLOCK_M},height_m={BLOCK_M},beyond_m=0,{sides}}}", "numerics.cell_m=0.25", "numerics.far_cell_m=100",
            path_setting((x, top - 2.0 * a), (x, top)))  # fmt: skip


def edge_K(run: Run) -> Checked:
    """K_I of the near tip against the integral equation of a crack normal to a free surface."""
    top = float(run.scene["domain"]["height_m"]) - max(end[1] for end in crack_ends(run))
    exact = value("spring_interface", "K_I_near", law="free", half_length_m=half_length(run), distance_m=top, pressure_Pa=NET_PA,
                  **{key: float(run.scene["rock"]["stiff"][key]) for key in ("youngs_modulus_Pa", "poisson_ratio")})  # fmt: skip
    return close(upper_tip(run).K_I_Pa_sqrt_m, exact, 0.02, "K_I of the near tip")


def near_edge() -> Family:
    """A tip at so many cells from an edge of the block."""

    def at(cells: float) -> Point:
        return Point(f"{cells:.5g} cells", cells, CRACK, (*AT_REST, *edge_setting(cells)))

    points = tuple(
        Point(f"{cells:g} cells", cells, CRACK, (*AT_REST, *edge_setting(cells)), smoke=cells in (2.0, 6.0)) for cells in EDGE_CELLS
    )
    return Family(
        name="tip_near_edge", title="A tip near a loaded edge of the block",
        says="K is that of the integral equation of a crack normal to a free surface within 2 %, or it is flagged.",
        parameter=Parameter("distance of the tips from the edge", "cells", log=True), points=points, check=edge_K, beyond=(MARKED,),
        edge=Edge("A ring of 2.5 cells and a cell that functions reach on: 3.5.", predicted=lambda: 3.5, at=at, bracket=(6.0, 2.0),
                  unsound_above=False),
        flag=tip_is_near, section=SECTION,
    )  # fmt: skip


FAMILIES = (
    in_cell("", AT_REST, "without inertia"),
    in_cell("_mid", AT_REST, "without inertia, the crack at mid-cell", MIDDLE_M + 0.5),
    in_cell("_linear", (*AT_REST, "numerics.shape=linear"), "without inertia, hat functions", check=K_of_hats),
    in_cell("_settled", SETTLING, "brought to rest by damping", MIDDLE_M, (0.0, 0.03, 0.5, 0.97)),
    near_interface("stiff_soft", "bonded, soft rock beyond", bonded_K),
    near_interface("soft_stiff", "bonded, stiff rock beyond", bonded_K),
    near_interface("springs", "springs of E'/a", spring_K),
    near_edge(),
)
