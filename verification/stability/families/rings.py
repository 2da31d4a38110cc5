"""Rings for J that would reach over an interface: bonded to another rock, sliding, soft."""
from __future__ import annotations

from collections.abc import Callable

from verification.harness.load import Run
from verification.stability.cracks import AT_REST, CRACK
from verification.stability.families.tip_places import LAYERS, bonded_K, near_setting, spring_K
from verification.stability.family import REFUSED, Checked, Family, Parameter, Point, close

RINGS = (3.0, 4.0, 5.0, 6.0, 8.0, 12.0)
GAP_CELLS = 6.0
ABOUT = (
    "J does not depend on its path only where nothing but one rock and the crack is inside. A ring that reaches over"
    " another rock, a face that"
    " slides or a spring gives another J for each radius, without a sign of it but the spread. Here the widest ring that"
    " is asked for grows past"
    " an interface 6 cells ahead of the tip: rings end a cell before it, whatever is asked for."
)


def within(check: Callable[[Run], Checked]) -> Callable[[Run], Checked]:
    """The check of K, and that J is K's and the ring ends a cell before the interface."""

    def both(run: Run) -> Checked:
        tip = max(run.summary.raw["tips"], key=lambda tip: tip["y_m"])
        rock = run.scene["rock"][run.scene["strata"]["layers"][0]["rock"]]
        E_prime = float(rock["youngs_modulus_Pa"]) / (1.0 - float(rock["poisson_ratio"]) ** 2)
        K = check(run)
        by_J = close((tip["J_N_m"] * E_prime) ** 0.5, K.reference, 0.02, "K by J")
        asked = float(run.scene["numerics"]["ring_cells"]) * 0.25
        ring = close(tip["ring_m"], min(asked, (GAP_CELLS - 1.0) * 0.25), 1e-6, "radius of the ring, m")
        return next((checked for checked in (ring, by_J) if not checked.holds), K)

    return both


def family(kind: str, how: str, check: Callable[[Run], Checked]) -> Family:
    """Rings of growing radius near an interface."""
    points = tuple(
        Point(f"{ring:g} cells", ring, CRACK, (*AT_REST, *LAYERS[kind], *near_setting(GAP_CELLS), f"numerics.ring_cells={ring}"), smoke=ring == 8.0,
              beyond=ring > 8.0)
        for ring in RINGS
    )
    return Family(
        name=f"rings_{kind}", title=f"Rings for J towards an interface 6 cells ahead: {how}",
        says="K and J stay those of the integral equation: a ring never reaches over the interface; rings of more than 8"
             " cells are refused.",
        parameter=Parameter("radius asked for", "cells"), points=points, check=within(check), beyond=(REFUSED,),
        section="Rings for J across interfaces", about=ABOUT,
    )  # fmt: skip


FAMILIES = (
    family("stiff_soft", "soft rock beyond", bonded_K), family("soft_stiff", "stiff rock beyond", bonded_K), family("springs", "springs", spring_K),
)  # fmt: skip
