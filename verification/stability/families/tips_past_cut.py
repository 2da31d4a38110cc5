"""A tip from two cells below to four cells above an interface whose faces are apart: energy, first growth, finite increments."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from verification.harness.load import LoadError, Run
from verification.harness.reference import value
from verification.ladder.cases.crossing import LINE_M, SCENE, block, cut, fracture_setting, fresh_m, net_Pa
from verification.stability.family import MARKED, STABLE, Checked, Edge, Family, Parameter, Point, at_most, close, tip_is_near

CELL_M = 1.0  # of the scene
PLACES = (-2.0, -1.5, -1.0, -0.5, -0.25, -0.05, 0.0, 0.05, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0)  # cells beyond the interface
INCREMENTS = (0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0)  # cells
CELLS_OFF = 0.15  # what the energy may be off by, as a length of fracture in cells
SHARE_OFF = 0.05  # what a pressure may be off by
SHARE_OFF_FEW = 0.10  # the same of increments down to half a cell

SECTION = "Tips beside faces that are apart"
ABOUT = (
    "A soft interface of 0.5 MPa/m passes hardly any shear. Where the fracture ends on it the rock behind is cut through, and K of a tip"
    " just beyond begins at nothing. A tip on the interface belongs to the rock ahead; how far it must be past for its energy and"
    " its growth to be those of strata-reference cut_blocks and crossing_pressure is walked here, in cells. Nearer than 4 cells"
    " the run says that the tip is near. Below, where no closed form is, the energy is held between its bounds: freedom to slip only adds to"
    " it, from the rock without an interface to the rock cut through."
)
SPRINGS_PA_M, TOUGHNESS = 0.5e6, 1.45e6  # of the scene
LEAVES = ("fracture.crossing_increment_m=2.0", "fracture.increment_m=1.0")


def below(run: Run) -> Checked:
    """Energy of a tip below the interface, between its bounds: elements without an interface, and cut through."""
    solid = block(run) | {"interface_m": 0.5 * LINE_M}
    least = value("cut_blocks", "stored_J_m", fresh_m=0.5 * LINE_M + fresh_m(run), slipped_m=0.0, shear_stiffness_Pa_m=0.0,
                  pressure_Pa=net_Pa(run), **solid)  # fmt: skip
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


def leaving_Pa(run: Run) -> float:
    """Net pressure at which the tip first goes on beyond the interface, Pa."""
    from_m = max(LINE_M, LINE_M + fresh_m(run))
    gone = run.history["tip_y_m"] > from_m + 0.01 * CELL_M
    if not np.any(gone):
        raise LoadError(f"{run.folder}: the tip did not go on beyond the interface")
    return net_Pa(run, float(run.history["inlet_Pa"][gone][0]))


def leaves(run: Run) -> Checked:
    """The pressure at which the tip leaves interface or place, against that of K, or of the increment where it comes from below."""
    springs = {"shear_stiffness_Pa_m": SPRINGS_PA_M, "toughness_Pa_sqrt_m": TOUGHNESS}
    if fresh_m(run) > 0.0:
        exact = value("cut_blocks", "critical_pressure_Pa", fresh_m=fresh_m(run), **springs, **block(run))
    else:
        increment = float(run.scene["fracture"].get("crossing_increment_m", run.increment_m))
        exact = value("crossing_pressure", "net_pressure_Pa", increment_m=increment, **springs, **block(run))
    return close(leaving_Pa(run), exact, SHARE_OFF if "crossing_increment_m" in run.scene["fracture"] else SHARE_OFF_FEW, "net pressure")


def at(cells: float, variant: str, *keys: str, smoke: bool = False) -> Point:
    """A tip so many cells beyond the interface."""
    stop = (f"stop.tip_y_m={LINE_M + max(cells, 0.0) * CELL_M + 0.5!r}",) if variant == "grows" else ()
    return Point(f"{cells:.5g} cells", cells, SCENE, (fracture_setting(LINE_M + cells * CELL_M), *stop, *keys), variant,
                 smoke=smoke, beyond=unsound(cells, variant))  # fmt: skip


def unsound(cells: float, variant: str) -> bool | None:
    """Whether a place on the interface or below is beyond the edge: growth is nearer than half an increment; above the edge says it."""
    if cells > 0.0:
        return None
    return variant == "grows" and -1.0 < cells < 0.0


def walk(
    name: str, title: str, says: str, variant: str, check: Callable[[Run], Checked], check_name: str, *keys: str, remark: str = ""
) -> Family:
    """A family over the tip's place."""
    return Family(
        name=name, title=title, says=says, parameter=Parameter("tip beyond the interface", "cells"),
        points=tuple(at(cells, variant, *keys, smoke=cells in (0.0, 0.25, 3.0)) for cells in PLACES), check=check, beyond=(MARKED,),
        before=(STABLE, MARKED), flag=tip_is_near, section=SECTION, about=ABOUT, check_name=check_name, remark=remark,
        edge=Edge("No theory: how near the interface a tip is told apart from one on it is measured.",
                  at=lambda cells: at(cells, variant, *keys), bracket=(0.5, 0.25), unsound_above=False, by_check=True),
    )  # fmt: skip


def increment_point(cells: float, smoke: bool = False) -> Point:
    """A tip on the interface that goes on by so many cells at once, and ends there."""
    keys = (f"fracture.increment_m={cells * CELL_M!r}", f"stop.tip_y_m={LINE_M + 0.5 * cells * CELL_M!r}", "stop.inlet_Pa=6e6")
    return Point(f"{cells:.5g} cells", cells, SCENE, keys, "grows", smoke=smoke)


INCREMENT = Family(
    name="cut_increments", title="A tip on the interface that goes on by a finite increment",
    says="Half a cell and more at once: the pressure is that of the increment within a tenth. Less releases too much.",
    parameter=Parameter("increment", "cells", log=True),
    points=tuple(increment_point(cells, cells in (0.25, 2.0)) for cells in INCREMENTS), check=leaves,
    beyond=(MARKED,), before=(STABLE, MARKED), flag=tip_is_near, section=SECTION, about=ABOUT, check_name="relative error of the pressure",
    edge=Edge("No theory: how short an increment releases what it should is measured.", at=increment_point,
              bracket=(0.5, 0.25), unsound_above=False, by_check=True),
    remark="Marked is what ends nearer than 4 cells to the interface. A run that goes on past that says nothing of an increment of"
           " less than half a cell.",
)  # fmt: skip

FAMILIES = (
    walk("cut_energy", "Energy of a tip beside a soft interface",
         "Half a cell and more beyond, the energy is that of a fracture whose length is off by 0.15 cells at most.",
         "rest", energy, "error of the energy over 0.15 cells of fracture (below: from the middle of its bounds)"),
    walk("cut_start", "First growth beyond a soft interface",
         "Half a cell and more beyond, K reaches K_Ic at the pressure of the reference within 5 %. On the interface, and where the tip"
         " comes to it from a cell below or farther, it is the pressure of an increment of two cells.",
         "grows", leaves, "relative error of the pressure", *LEAVES,
         remark="From nearer below than half its length, here a cell, the increment goes past the interface at once, for a fifth of the"
                " pressure that it asks for from the interface: most of the energy is that of cutting the rock behind."),
    INCREMENT,
)  # fmt: skip
