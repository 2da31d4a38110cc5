"""Where a tip stands: within its cell, near an interface, near an edge of the block; and from two cells below to four cells above an interface whose faces are
apart: energy, first growth, finite increments."""

from collections.abc import Callable
from typing import Any

import numpy as np

from verification.harness.load import LoadError, Run, crack_ends, given, half_length, net_Pa, path_key, rock, upper, value
from verification.ladder.cases.crossing import LINE_M, SCENE, block, critical_Pa, cut, fracture_setting, fresh_m
from verification.ladder.cases.interfaces import Reference, bonded, springs
from verification.stability.family import (
    AT_REST, CRACK, MARKED, MIDDLE_M, NET_PA, SETTLING, STABLE, At, Check, Checked, Edge, Family, Parameter, at_most, at_values, close, griffith_K,
    parted, tip_is_near, upright, walked,
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


PLACE_FAMILIES = (
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

CELL_M = 1.0  # of the scene
PLACES = (-2.0, -1.5, -1.0, -0.5, -0.25, -0.05, 0.0, 0.05, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0)  # cells beyond the interface
CELLS_OFF = 0.15  # what the energy may be off by, as a length of fracture in cells
SHARE_OFF = 0.05  # what a pressure may be off by
SHARE_OFF_FEW = 0.10  # the same of increments down to half a cell

BESIDE_CUTS = "Tips beside faces that are apart"


def below(run: Run) -> Checked:
    """Energy of a tip below the interface, between its bounds: elements without an interface, and cut through."""
    solid = block(run) | {"interface_m": 0.5 * LINE_M, "slipped_m": 0.0, "shear_stiffness_Pa_m": 0.0}
    least = value("cut_blocks", "stored_J_m", fresh_m=0.5 * LINE_M + fresh_m(run), pressure_Pa=net_Pa(run), **solid)
    most = cut(run, "stored_J_m", 0.0)
    middle, half = 0.5 * (least + most), 0.5 * (most - least)
    return close(run.summary.energy["stored_J"], middle, half / middle, f"energy between {least:.4g} and {most:.4g} J/m")


def energy(run: Run) -> Checked:
    """Energy beyond the interface, as the length of fracture by which it is off, in cells."""
    if fresh_m(run) < 0.0:
        return below(run)
    off = run.summary.energy["stored_J"] - cut(run, "stored_J_m")
    G = cut(run, "J_N_m", fresh_m(run) or CELL_M)
    return at_most(abs(off) / (G * CELL_M), CELLS_OFF, f"energy off by {off / (G * CELL_M):+.3f} cells of fracture")


def leaves(run: Run) -> Checked:
    """The net pressure at which the tip leaves interface or place, against that of K, or of the increment where it comes from below."""
    gone = run.history["tip_y_m"] > max(LINE_M, LINE_M + fresh_m(run)) + 0.01 * CELL_M
    if not np.any(gone):
        raise LoadError(f"{run.folder}: the tip did not go on beyond the interface")
    found = net_Pa(run, float(run.history["inlet_Pa"][gone][0]))
    given = run.scene["fracture"].get("crossing_increment_m")
    exact = critical_Pa(run) if fresh_m(run) > 0.0 else critical_Pa(run, float(given or run.increment_m))
    return close(found, exact, SHARE_OFF_FEW if given is None else SHARE_OFF, "net pressure")


def at(variant: str, *further: str) -> At:
    """A tip so many cells beyond the interface."""

    def keys(cells: float) -> tuple[str, ...]:
        stop = (f"stop.tip_y_m={LINE_M + max(cells, 0.0) * CELL_M + 0.5!r}",) if variant == "grows" else ()
        return fracture_setting(LINE_M + cells * CELL_M), *stop, *further

    return at_values(SCENE, keys, "{:.5g} cells", variant)


def edge(source: str, point: At) -> Edge:
    """Where the check ceases to hold, between half a cell and a quarter."""
    return Edge(f"No theory: {source} is measured.", at=point, bracket=(0.5, 0.25), unsound_above=False, by_check=True)


def place(name: str, title: str, says: str, variant: str, check: Callable[[Run], Checked], check_name: str, *keys: str) -> Family:
    """A family over the tip's place."""
    point = at(variant, *keys)

    def unsound(cells: float) -> bool | None:
        """On the interface or below: growth is nearer than half an increment; above the edge says it."""
        return None if cells > 0.0 else variant == "grows" and -1.0 < cells < 0.0

    return Family(
        name, title, says, Parameter("tip beyond the interface", "cells"),
        walked(point, PLACES, smoke=(0.0, 0.25, 3.0), beyond=unsound), check, beyond=(MARKED,), before=(STABLE, MARKED),
        flag=tip_is_near, section=BESIDE_CUTS, check_name=check_name,
        edge=edge("how near the interface a tip is told apart from one on it", point),
    )  # fmt: skip


# A tip on the interface that goes on by so many cells at once, and ends there.
BY_INCREMENT = at_values(SCENE, lambda cells: (f"fracture.increment_m={cells * CELL_M!r}", f"stop.tip_y_m={LINE_M + 0.5 * cells * CELL_M!r}", "stop.inlet_Pa=6e6"),
                         "{:.5g} cells", "grows")  # fmt: skip
CUT_FAMILIES = (
    place("cut_energy", "Energy of a tip beside a soft interface",
          "Half a cell and more beyond, the energy is that of a fracture whose length is off by 0.15 cells at most.",
          "rest", energy, "error of the energy over 0.15 cells of fracture (below: from the middle of its bounds)"),
    place("cut_start", "First growth beyond a soft interface",
          "Half a cell and more beyond, K reaches K_Ic at the pressure of the reference within 5 %. On the interface, and where the tip"
          " comes to it from a cell below or farther, it is the pressure of an increment of two cells.",
          "grows", leaves, "relative error of the pressure", "fracture.crossing_increment_m=2.0", "fracture.increment_m=1.0"),
    Family(
        "cut_increments", "A tip on the interface that goes on by a finite increment",
        "Half a cell and more at once: the pressure is that of the increment within a tenth. Less releases too much.",
        Parameter("increment", "cells", log=True), walked(BY_INCREMENT, (0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0), smoke=(0.25, 2.0)), leaves,
        beyond=(MARKED,), before=(STABLE, MARKED), flag=tip_is_near, section=BESIDE_CUTS, check_name="relative error of the pressure",
        edge=edge("how short an increment releases what it should", BY_INCREMENT),
    ),
)  # fmt: skip

FAMILIES = (*PLACE_FAMILIES, *CUT_FAMILIES)
