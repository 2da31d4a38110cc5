"""Where a tip stands: within its cell, near an interface, near an edge of the block."""

from typing import Any

from verification.harness.load import Run, crack_ends, given, half_length, path_key, rock, upper, value
from verification.ladder.cases.interfaces import Reference, bonded, springs
from verification.stability.family import (
    AT_REST, CRACK, MARKED, MIDDLE_M, NET_PA, SETTLING, At, Check, Edge, Family, Parameter, at_values, close, griffith_K, parted, tip_is_near,
    upright, walked,
)  # fmt: skip

SECTION = "Tips: within a cell, near an interface, near an edge"


SHARES = (0.0, 0.001, 0.01, 0.03, 0.1, 0.25, 0.5, 0.75, 0.9, 0.97, 0.99, 0.999, 1.0)


def in_cell(
    name: str, keys: tuple[str, ...], how: str, x_m: float = MIDDLE_M, shares: tuple[float, ...] = SHARES, tolerance: float = 0.002
) -> Family:
    """A tip at a share of a cell above a row of nodes; K_I of it against p sqrt(pi a)."""
    at = at_values(CRACK, lambda share: (*keys, path_key((x_m, 11.0), (x_m, 21.0 + share))), "{:g}")
    return Family(
        f"tip_in_cell{name}", f"A tip within a cell, {how}", "K_I must not depend on where in its cell a tip stands.",
        Parameter("tip above a row of nodes", "cells"), walked(at, shares, smoke=(0.03, 0.5)),
        lambda run: close(upper(run).K_I_Pa_sqrt_m, griffith_K(run), tolerance, "K_I of the upper tip"), section=SECTION,
    )  # fmt: skip


LAYERS = {"stiff_soft": parted("stiff", "soft"), "soft_stiff": parted("soft", "stiff"), "springs": parted("stiff", "stiff", "springs")}
BLOCK_M = 1600.0  # so large that its other edges are not felt


def near_setting(cells: float) -> tuple[str, ...]:
    """A crack whose upper tip is so many cells of 0.25 m below the middle of the block; the grid is uniform there."""
    return upright(MIDDLE_M, MIDDLE_M - 0.25 * cells), "numerics.cell_m=0.25", "numerics.far_cell_m=1"


def edge_setting(cells: float) -> tuple[str, ...]:
    """A crack normal to the block's top, its upper tip so many cells of 0.25 m below it."""
    sides = ",".join(f'{side}="traction"' for side in ("bottom", "sides", "top"))
    return (f"domain={{width_m={BLOCK_M},height_m={BLOCK_M},beyond_m=0,{sides}}}", "numerics.cell_m=0.25", "numerics.far_cell_m=100",
            upright(0.5 * BLOCK_M, BLOCK_M - 0.25 * cells))  # fmt: skip


def near_K(reference: Reference, tolerance: float = 0.01) -> Check:
    """K_I at the near tip against its integral equation (of Cook and Erdogan where the interface is bonded)."""
    return lambda run: close(
        upper(run).K_I_Pa_sqrt_m, value(reference(run)[0], "K_I_near", **reference(run)[1]), tolerance, "K_I of the near tip")  # fmt: skip


def below_edge(run: Run) -> tuple[str, dict[str, Any]]:
    """The reference of a crack normal to a free surface."""
    top = given(run, "domain.height_m") - max(end[1] for end in crack_ends(run))
    return "spring_interface", {"law": "free", "half_length_m": half_length(run), "distance_m": top, "pressure_Pa": NET_PA, **rock(run)}


def towards(
    name: str, title: str, says: str, parameter: str, at: At, cells: tuple[float, ...], smoke: tuple[float, ...], check: Check, edge: float, why: str
) -> Family:
    """A tip at so many cells from something, flagged from an edge (cells) on down."""
    return Family(
        f"tip_near_{name}", title, says, Parameter(parameter, "cells", log=True), walked(at, cells, smoke), check, beyond=(MARKED,),
        edge=Edge(why, lambda: edge, at, (6.0, 2.0), unsound_above=False), flag=tip_is_near, section=SECTION,
    )  # fmt: skip


def near_interface(kind: str, how: str, reference: Reference) -> Family:
    """A tip at so many cells from an interface."""
    return towards(
        kind, f"A tip near an interface: {how}", "K is that of the integral equation within 1 %, or it is flagged.",
        "distance of the tip from the interface", at_values(CRACK, lambda cells: (*AT_REST, *LAYERS[kind], *near_setting(cells)), "{:.5g} cells"),
        (0.01, 0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 3.9, 4.1, 5.0, 6.0, 8.0), (1.0, 6.0), near_K(reference), 4.0,
        "Rings for J have an outer radius of 2.5 cells at least, lest the tip's own error fill them, and end a cell before the interface,"
        " where functions reach over it; with half a cell to spare: 4.",
    )  # fmt: skip


FAMILIES = (
    in_cell("", AT_REST, "without inertia"),
    in_cell("_mid", AT_REST, "without inertia, the crack at mid-cell", MIDDLE_M + 0.5),
    in_cell("_linear", (*AT_REST, "numerics.shape=linear"), "without inertia, hat functions", tolerance=0.01),  # which cost 0.5 to 0.7 %
    in_cell("_settled", SETTLING, "brought to rest by damping", MIDDLE_M, (0.0, 0.03, 0.5, 0.97)),
    near_interface("stiff_soft", "bonded, soft rock beyond", bonded),
    near_interface("soft_stiff", "bonded, stiff rock beyond", bonded),
    near_interface("springs", "springs of E'/a", springs),
    towards("edge", "A tip near a loaded edge of the block",
            "K is that of the integral equation of a crack normal to a free surface within 2 %, or it is flagged.",
            "distance of the tips from the edge", at_values(CRACK, lambda cells: (*AT_REST, *edge_setting(cells)), "{:.5g} cells"),
            (1.0, 1.5, 2.0, 3.0, 3.4, 3.6, 4.0, 5.0, 6.0, 8.0, 12.0), (2.0, 6.0), near_K(below_edge, 0.02), 3.5,
            "A ring of 2.5 cells and a cell that functions reach on: 3.5."),
)  # fmt: skip
