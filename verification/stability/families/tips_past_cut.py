"""A tip from two cells below to four cells above an interface whose faces are apart: energy, first growth, finite increments."""

from collections.abc import Callable

import numpy as np

from verification.harness.load import LoadError, Run, net_Pa, value
from verification.ladder.cases.crossing import LINE_M, SCENE, block, critical_Pa, cut, fracture_setting, fresh_m
from verification.stability.family import MARKED, STABLE, At, Checked, Edge, Family, Parameter, at_most, at_values, close, tip_is_near, walked

CELL_M = 1.0  # of the scene
PLACES = (-2.0, -1.5, -1.0, -0.5, -0.25, -0.05, 0.0, 0.05, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0)  # cells beyond the interface
CELLS_OFF = 0.15  # what the energy may be off by, as a length of fracture in cells
SHARE_OFF = 0.05  # what a pressure may be off by
SHARE_OFF_FEW = 0.10  # the same of increments down to half a cell

SECTION = "Tips beside faces that are apart"


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
        flag=tip_is_near, section=SECTION, check_name=check_name,
        edge=edge("how near the interface a tip is told apart from one on it", point),
    )  # fmt: skip


def increment(cells: float) -> tuple[str, ...]:
    """A tip on the interface that goes on by so many cells at once, and ends there."""
    return f"fracture.increment_m={cells * CELL_M!r}", f"stop.tip_y_m={LINE_M + 0.5 * cells * CELL_M!r}", "stop.inlet_Pa=6e6"


BY_INCREMENT = at_values(SCENE, increment, "{:.5g} cells", "grows")
FAMILIES = (
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
        beyond=(MARKED,), before=(STABLE, MARKED), flag=tip_is_near, section=SECTION, check_name="relative error of the pressure",
        edge=edge("how short an increment releases what it should", BY_INCREMENT),
    ),
)  # fmt: skip
