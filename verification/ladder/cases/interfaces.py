"""A pressurised crack near an interface: K at both tips near bonded, soft, free and frictionless interfaces, and first slip
of one with friction, against integral equations in the infinite plane.

Levels are named by the cells between the crack and the interface. Nearer than 4 cells a run flags K; nearer than 2.5 cells to faces that
are apart, and than 2 to another rock, there is none.
"""
from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from verification.harness.load import LoadError, Run, Tip, frames
from verification.harness.paths import ANALYTIC
from verification.harness.reference import value
from verification.ladder.case import Case, Level, Quantity, Sample

BONDED, SPRINGS, FRICTION = (ANALYTIC / f"near_{name}.toml" for name in ("bonded", "springs", "friction"))

HALF_LENGTH_M = 5.0
MIDDLE_M = 800.0  # of the block, where the interface is
E_PRIME_PA = 10.0e9 / 0.96  # of the rock in near_springs.toml

RINGS = "rings are of 4 cells or less at any cell size: the tip's own error in them stays the same share"
EDGES = "what is left at the widest block is the discretisation's"
LETS_GO = 0.3  # of what makes it slip: where the solver splits an interface with friction
SLIP = "the mean over a column (second order, slips later) stands against a crack that is 0.2 % too soft; columns move along the peak"


def path(run: Run) -> np.ndarray:
    """The fracture as the scene has it, m."""
    return np.array(run.scene["fracture"]["path_m"], dtype=float)


def rock(run: Run, layer: int, prefix: str = "") -> dict[str, float]:
    """Modulus and Poisson's ratio of a layer's rock as the references take them."""
    given = run.scene["rock"][run.scene["strata"]["layers"][layer]["rock"]]
    return {f"{prefix}{name}": float(given[name]) for name in ("youngs_modulus_Pa", "poisson_ratio")}


def crack(run: Run) -> dict[str, float]:
    """Half-length (m), distance to the interface (m) and net pressure (Pa) of a run's crack, which lies before the interface."""
    ends = path(run)
    distance = float(np.min(run.interfaces_m[0] - ends[:, 0 if run.along == "x" else 1]))
    net = run.summary.inlet_Pa - float(run.scene["in_situ"]["horizontal_Pa"])
    return {"half_length_m": 0.5 * math.dist(ends[0], ends[-1]), "distance_m": distance, "pressure_Pa": net}


def bonded(run: Run) -> tuple[str, dict[str, Any]]:
    """The reference of a crack near a bonded interface, with its settings."""
    name = "bonded_parallel" if run.along == "x" else "bonded_normal"
    return name, crack(run) | rock(run, 0) | rock(run, 1, "beyond_")


def springs(run: Run) -> tuple[str, dict[str, Any]]:
    """The same near springs."""
    law = run.scene["interface"]["springs"]
    stiffness = {name: float(law[name]) for name in ("normal_stiffness_Pa_m", "shear_stiffness_Pa_m")}
    return "spring_interface", crack(run) | rock(run, 0) | stiffness


def without_springs(law: str) -> Callable[[Run], tuple[str, dict[str, Any]]]:
    """The same near an interface that is 'free' or 'frictionless'."""
    return lambda run: ("spring_interface", crack(run) | rock(run, 0) | {"law": law})


Reference = Callable[[Run], tuple[str, dict[str, Any]]]


def upper(run: Run) -> Tip:
    """The tip that is nearer to an interface above the crack, or the upper one of a crack beside it."""
    return max(run.summary.tips, key=lambda tip: tip.y_m)


def lower(run: Run) -> Tip:
    """The other tip."""
    return min(run.summary.tips, key=lambda tip: tip.y_m)


def quantity(
    name: str, unit: str, measured: Callable[[Run], float], reference: Reference, exact: str, why: str = RINGS
) -> Quantity:
    """A number of a run beside a value of its reference."""

    def sample(run: Run) -> Sample:
        source, settings = reference(run)
        return Sample.of(measured(run), value(source, exact, **settings))

    return Quantity(name, unit, sample, why)


def both_tips(reference: Reference, why: str = RINGS) -> tuple[Quantity, ...]:
    """K_I from the interaction integral and J, each at both tips of a crack normal to the interface."""
    return (
        quantity("K_I, near tip", "Pa sqrt(m)", lambda run: upper(run).K_I_Pa_sqrt_m, reference, "K_I_near", why),
        quantity("K_I, far tip", "Pa sqrt(m)", lambda run: lower(run).K_I_Pa_sqrt_m, reference, "K_I_far", why),
        quantity("J, near tip", "N/m", lambda run: upper(run).J_N_m, reference, "J_near_N_m", why),
        quantity("J, far tip", "N/m", lambda run: lower(run).J_N_m, reference, "J_far_N_m", why),
    )


MIXED = (
    quantity("K_I", "Pa sqrt(m)", lambda run: upper(run).K_I_Pa_sqrt_m, bonded, "K_I"),
    quantity("K_II", "Pa sqrt(m)", lambda run: upper(run).K_II_Pa_sqrt_m, bonded, "K_II"),
    quantity("kink angle", "degrees", lambda run: upper(run).kink_deg, bonded, "kink_deg"),
    quantity("J", "N/m", lambda run: upper(run).J_N_m, bonded, "J_N_m"),
    quantity("K_II, lower tip", "Pa sqrt(m)", lambda run: lower(run).K_II_Pa_sqrt_m, bonded, "K_II_minus"),
)


def first_slip(run: Run) -> Sample:
    """The net pressure (Pa) at which the first place of the interface let go: sticking, at LETS_GO of what makes it slip."""
    _, fields = frames(run, "interfaces")[-1]
    failed_s = fields["0/failed_s"]
    if not np.any(failed_s >= 0.0):
        raise LoadError(f"{run.folder}: the interface did not slip")
    inlet, in_situ = run.scene["fluid"]["inlet"], run.scene["in_situ"]
    pressure = float(inlet["start_Pa"]) + float(inlet["rate_Pa_s"]) * float(np.min(failed_s[failed_s >= 0.0]))
    given = crack(run)
    settings = {
        "friction": LETS_GO * float(run.scene["interface"]["rough"]["coefficient"]),
        "compression_Pa": float(in_situ["vertical_Pa"]),
        "half_length_m": given["half_length_m"],
        "distance_m": given["distance_m"],
    }
    return Sample.of(pressure - float(in_situ["horizontal_Pa"]), value("coulomb_first_slip", "net_pressure_Pa", **settings))


def path_setting(distance_m: float, parallel: bool, middle_m: float = MIDDLE_M) -> str:
    """The crack at a distance (m) before the interface in the middle of the block, as a scene key."""
    a = HALF_LENGTH_M
    if parallel:
        return f"fracture.path_m=[[{middle_m - distance_m},{middle_m - a}],[{middle_m - distance_m},{middle_m + a}]]"
    return f"fracture.path_m=[[{middle_m},{middle_m - distance_m - 2 * a}],[{middle_m},{middle_m - distance_m}]]"


def levels(variant: str, distance_m: float, *cells: int, settings: tuple[str, ...] = ()) -> tuple[Level, ...]:
    """Levels by the number of cells in the distance (m) between crack and interface."""
    where = path_setting(distance_m, variant.startswith("parallel"))
    return tuple(
        Level(f"{n} cells", distance_m / n, (f"numerics.cell_m={distance_m / n!r}", where, *settings), variant) for n in cells
    )


def block_levels(*widths_m: float) -> tuple[Level, ...]:
    """Levels by the block's width (m), 4 cells from the interface; edges cost as the square of their size."""
    found = []
    for width in widths_m:
        block = (f"domain.width_m={width}", f"domain.height_m={width}", "numerics.cell_m=0.25")
        layers = f'strata.layers=[{{rock="stiff",thickness_m={width / 2}}},{{rock="soft"}}]'
        settings = (*block, layers, path_setting(1.0, False, width / 2))
        found.append(Level(f"{width:g} m block", 100.0 / width, settings, "normal_in_stiff"))
    return tuple(found)


def normal(held_by: str, distance_m: float, *cells: int, smoke: int = 1) -> Case:
    """A crack normal to a bonded interface."""
    name = f"bonded_normal_{held_by}_{distance_m:g}"
    says = f"crack in {held_by} rock, {distance_m:g} m from the other rock, normal to it"
    return Case(name, says, BONDED, "quasistatic", levels(f"normal_in_{held_by}", distance_m, *cells), both_tips(bonded), smoke)


def parallel(held_by: str, distance_m: float, *cells: int, smoke: int = 1) -> Case:
    """A crack parallel to a bonded interface."""
    name, says = f"bonded_parallel_{held_by}_{distance_m:g}", f"crack in {held_by} rock, {distance_m:g} m beside the other rock"
    return Case(name, says, BONDED, "quasistatic", levels(f"parallel_in_{held_by}", distance_m, *cells), MIXED, smoke)


def in_both(make: Callable[..., Case], distance_m: float, *cells: int, smoke: int = 1) -> tuple[Case, ...]:
    """A crack in either rock at a distance (m) from the interface."""
    return tuple(make(held_by, distance_m, *cells, smoke=smoke) for held_by in ("stiff", "soft"))


def stiffness_settings(stiffness: float) -> tuple[str, ...]:
    """Springs of D a/E' = stiffness, alike along and across, as scene keys."""
    D = stiffness * E_PRIME_PA / HALF_LENGTH_M
    return tuple(f"interface.springs.{name}_stiffness_Pa_m={D!r}" for name in ("normal", "shear"))


def sprung(stiffness: float, *cells: int) -> Case:
    """A crack normal to a soft interface of D a/E' = stiffness, 1 m from it."""
    law = stiffness_settings(stiffness)
    says = f"crack 1 m from springs of D a/E' = {stiffness:g}, normal to them"
    made = levels("springs", 1.0, *cells, settings=law)
    return Case(f"springs_{stiffness:g}", says, SPRINGS, "quasistatic", made, both_tips(springs), 1)


# Wide columns slip late: the ramp goes on to 8 % above the reference instead of 3 %.
LONGER = {
    f"friction_{share}": (f"stop.time_s={stop}", f"output.fields_every_s={stop}") for share, stop in ((4, 0.98), (6, 1.12))
}


def slipping(coefficient: float, *cells: int) -> Case:
    """A crack 1 m from an interface with friction, under a rising pressure."""
    slip = Quantity("net pressure at 0.3 of first slip", "Pa", first_slip, SLIP)
    variant = f"friction_{10 * coefficient:g}"
    made = levels(variant, 1.0, *cells[:1], settings=LONGER[variant]) + levels(variant, 1.0, *cells[1:])
    says = f"crack 1 m from an interface with friction {coefficient:g}: when that is at 0.3 of its first slip"
    return Case(f"slip_{coefficient:g}", says, FRICTION, "quasistatic", made, (slip,), 1)


NO_SPRINGS = stiffness_settings(1e-6)  # K is 4e-6 below that near a free surface

SMALL = "it is the block's edges that cost a per cent"


def small_levels(variant: str) -> tuple[Level, ...]:
    """Levels of a crack 5 m from the interface in the middle of a block of 160 m, with cells of one size."""
    return tuple(Level(f"{n} cells", 5.0 / n, tuple(f"numerics.{key}={5.0 / n!r}" for key in ("cell_m", "far_cell_m")), variant) for n in (2, 4))


CASES = (
    *in_both(normal, 1.0, 2, 4, 8, 16, smoke=2),
    *in_both(normal, 0.5, 2, 4, 8),
    *in_both(normal, 2.5, 4, 8, 16),
    Case("block_edges", "what the edges of the block cost: its width doubled", BONDED, "quasistatic",
         block_levels(200.0, 400.0, 800.0, 1600.0), both_tips(bonded, EDGES), 1),
    *in_both(parallel, 2.5, 2, 4, 8, 16, smoke=2),
    *in_both(parallel, 1.25, 2, 4, 8),
    *in_both(parallel, 5.0, 4, 8, 16),
    *(sprung(stiffness, 4, 8) for stiffness in (0.01, 0.1, 1.0, 10.0, 100.0)),
    Case("free", "crack 1 m from springs so soft that they are a free surface", SPRINGS, "quasistatic",
         levels("springs", 1.0, 4, 8, settings=NO_SPRINGS), both_tips(without_springs("free")), 1),
    Case("frictionless", "crack 1 m from a closed interface without friction", SPRINGS, "quasistatic",
         levels("frictionless", 1.0, 4, 8), both_tips(without_springs("frictionless")), 1),
    slipping(0.4, 4, 8, 16),
    slipping(0.6, 4, 8, 16),
    Case("small_block", "crack 5 m from a bonded interface in a uniform block of 160 m, without inertia", BONDED, "quasistatic",
         small_levels("small_block"), both_tips(bonded, SMALL), 1),
    Case("small_block_settling", "the same brought to rest by damping: the same K", BONDED, "explicit",
         small_levels("small_block_settling"), both_tips(bonded, SMALL), 1),
)  # fmt: skip
