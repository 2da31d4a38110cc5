"""Rings for J that would reach over an interface: bonded to another rock, sliding, soft; rock near incompressibility, and rocks whose stiffnesses are far apart."""

from pathlib import Path

import numpy as np

from verification.harness.load import E_prime, Run, given, last, lower, upper, value
from verification.harness.paths import ANALYTIC
from verification.ladder.cases.interfaces import Reference, bonded, springs
from verification.ladder.cases.motion import laminate
from verification.stability.families.tip_places import LAYERS, near_K, near_setting
from verification.stability.family import (
    AT_REST, CRACK, MARKED, REFUSED, SETTLING, Check, Checked, Family, Parameter, Point, at_values, close, farthest_off, griffith_K, parted,
    sneddon_opening, walked, worse,
)  # fmt: skip

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


def near_rings(kind: str, how: str, reference: Reference) -> Family:
    """Rings of growing radius near an interface."""
    at = at_values(CRACK, lambda ring: (*AT_REST, *LAYERS[kind], *near_setting(GAP_CELLS), f"numerics.ring_cells={ring}"), "{:g} cells")
    return Family(
        f"rings_{kind}", f"Rings for J towards an interface 6 cells ahead: {how}",
        "K and J stay those of the integral equation: a ring never reaches over the interface; rings of more than 8 cells are refused.",
        Parameter("radius asked for", "cells"), walked(at, (3.0, 4.0, 5.0, 6.0, 8.0, 12.0), smoke=(8.0,), beyond=lambda ring: ring > 8.0),
        within(reference), beyond=(REFUSED,), section="Rings for J across interfaces",
    )  # fmt: skip


RING_FAMILIES = (
    near_rings("stiff_soft", "soft rock beyond", bonded), near_rings("soft_stiff", "stiff rock beyond", bonded), near_rings("springs", "springs", springs),
)  # fmt: skip

SECTION = "Rock: Poisson's ratio to 0.4999, stiffness contrast to 1e4"

POISSON = (0.2, 0.4, 0.45, 0.49, 0.495, 0.499, 0.4999)


def K_and_opening(run: Run) -> Checked:
    """K_I = p sqrt(pi a) and the opening 4 p a/E' (Sneddon)."""
    K = farthest_off([tip.K_I_Pa_sqrt_m for tip in run.summary.tips], griffith_K(run))
    return worse(close(K, griffith_K(run), 0.01, "K_I"), close(run.summary.mouth_opening_m, sneddon_opening(run), 0.02, "opening"))


def poisson(name: str, keys: tuple[str, ...], how: str, ratios: tuple[float, ...] = POISSON, locking: float = 0.495) -> Family:
    """A crack in rock of a Poisson's ratio; beyond `locking` the run says itself that it is too stiff."""

    def point(ratio: float) -> Point:
        settings = (*keys, f"rock.stiff.poisson_ratio={ratio}")
        return Point(f"{ratio:g}", 0.5 - ratio, CRACK, settings, smoke=ratio in (0.2, 0.4999), beyond=ratio > locking)

    return Family(
        f"poisson{name}", f"Poisson's ratio to {ratios[-1]:g}, {how}",
        "K_I and the opening are those of the closed form, or the run says that its functions lock.",
        Parameter("0.5 less Poisson's ratio", log=True), tuple(map(point, ratios)), K_and_opening, beyond=(MARKED,), section=SECTION,
    )  # fmt: skip


def both_K(run: Run) -> Checked:
    """K_I at both tips against the integral equation of Cook and Erdogan: the worse."""
    name, settings = bonded(run)
    return worse(*(
        close(tip(run).K_I_Pa_sqrt_m, value(name, f"K_I_{place}", **settings), 0.01, f"K_I, {place} tip") for place, tip in (("near", upper), ("far", lower))
    ))  # fmt: skip


def shared_load(run: Run) -> Checked:
    """Horizontal stress of each layer in the middle of the stack against their shares by stiffness (strata-reference loaded_layers)."""
    exact, edges = laminate(run), [0.0, *run.interfaces_m, given(run, "domain.height_m")]
    particles = last(run, "particles")[1]
    middle = np.abs(particles["x_m"] - 0.5 * given(run, "domain.width_m")) < 1.0
    checks = []
    for k, (below, above) in enumerate(zip(edges, edges[1:])):
        inside = middle & (np.abs(particles["y_m"] - (below + 0.5 * (above - below))) < 1.0)
        found = float(np.mean(particles["s_xx_Pa"][inside]))
        checks.append(close(found, float(exact[k]), 0.02, f"stress in layer {k}", scale=float(np.max(np.abs(exact)))))
    return worse(*checks)


def contrast(name: str, title: str, says: str, scene: Path, before: tuple[str, ...], after: tuple[str, ...], check: Check) -> Family:
    """Rocks whose moduli are apart by a factor, with scene keys before and after that of the modulus."""
    at = at_values(scene, lambda ratio: (*before, f"rock.soft.youngs_modulus_Pa={10.0e9 / ratio!r}", *after), "{:g}")
    return Family(
        f"contrast_{name}", f"Stiffness contrast to 1e4: {title}", says, Parameter("stiff over soft modulus", log=True),
        walked(at, (1.0, 10.0, 100.0, 1e3, 1e4), smoke=(10.0, 1e4), beyond=lambda ratio: ratio > 30.0), check, beyond=(MARKED,), section=SECTION,
    )  # fmt: skip


def crack_beside(held_by: str, other: str) -> Family:
    """A crack at 8 cells of 0.25 m from a rock that is softer or stiffer by a factor."""
    return contrast(
        f"in_{held_by}", f"a crack in the {held_by} rock, 8 cells from the other", "K_I of both tips is that of the integral equation.", CRACK,
        (*AT_REST, *parted(held_by, other), *near_setting(8.0)), (), both_K,
    )  # fmt: skip


ROCK_FAMILIES = (
    poisson("", AT_REST, "without inertia"),
    poisson("_linear", (*AT_REST, "numerics.shape=linear", "numerics.cell_m=0.25"), "without inertia, hat functions of 0.25 m", locking=0.45),
    poisson("_settled", SETTLING, "brought to rest by damping", (0.2, 0.4, 0.45, 0.49)),
    crack_beside("stiff", "soft"), crack_beside("soft", "stiff"),
    contrast("layers", "two layers under one load", "Each layer bears its share by stiffness, or the run says that its rocks differ too much.",
             ANALYTIC / "loaded_layers.toml", (), ("numerics.cell_m=0.5",), shared_load),
)  # fmt: skip

FAMILIES = (*RING_FAMILIES, *ROCK_FAMILIES)
