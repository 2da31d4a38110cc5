"""Rings for J that would reach over an interface: bonded to another rock, sliding, soft."""

from verification.harness.load import E_prime, Run, given
from verification.ladder.cases.interfaces import Reference, bonded, springs
from verification.stability.families.tip_places import LAYERS, near_K, near_setting
from verification.stability.family import AT_REST, CRACK, REFUSED, Check, Checked, Family, Parameter, at_values, close, walked

GAP_CELLS = 6.0


def within(reference: Reference) -> Check:
    """The check of K, and that J is K's and the ring ends a cell before the interface."""

    def both(run: Run) -> Checked:
        tip = max(run.summary.raw["tips"], key=lambda tip: tip["y_m"])
        K = near_K(reference)(run)
        by_J = close((tip["J_N_m"] * E_prime(run, 0)) ** 0.5, K.reference, 0.02, "K by J")
        asked = given(run, "numerics.ring_cells") * 0.25
        ring = close(tip["ring_m"], min(asked, (GAP_CELLS - 1.0) * 0.25), 1e-6, "radius of the ring, m")
        return next((checked for checked in (ring, by_J) if not checked.holds), K)

    return both


def family(kind: str, how: str, reference: Reference) -> Family:
    """Rings of growing radius near an interface."""
    at = at_values(CRACK, lambda ring: (*AT_REST, *LAYERS[kind], *near_setting(GAP_CELLS), f"numerics.ring_cells={ring}"), "{:g} cells")
    return Family(
        f"rings_{kind}", f"Rings for J towards an interface 6 cells ahead: {how}",
        "K and J stay those of the integral equation: a ring never reaches over the interface; rings of more than 8 cells are refused.",
        Parameter("radius asked for", "cells"), walked(at, (3.0, 4.0, 5.0, 6.0, 8.0, 12.0), smoke=(8.0,), beyond=lambda ring: ring > 8.0),
        within(reference), beyond=(REFUSED,), section="Rings for J across interfaces",
    )  # fmt: skip


FAMILIES = (
    family("stiff_soft", "soft rock beyond", bonded), family("soft_stiff", "stiff rock beyond", bonded), family("springs", "springs", springs),
)  # fmt: skip
