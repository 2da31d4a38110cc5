"""A pressurised crack near an interface: K at both tips near bonded, soft, free and frictionless interfaces, and first slip
of one with friction, against integral equations in the infinite plane.

Levels are named by the cells between the crack and the interface. Nearer than 4 cells a run flags K; nearer than 2.5 cells to faces that
are apart, and than 2 to another rock, there is none.
"""

from collections.abc import Callable
from typing import Any

from verification.harness.load import Run, crack_ends, first_failed_Pa, given, half_length, lower, net_Pa, rock, tip, upper, value
from verification.harness.paths import ANALYTIC
from verification.ladder.case import Case, Level, Quantity, case_of

BONDED, SPRINGS, FRICTION = (ANALYTIC / f"near_{name}.toml" for name in ("bonded", "springs", "friction"))

HALF_LENGTH_M = 5.0
MIDDLE_M = 800.0  # of the block, where the interface is
E_PRIME_PA = 10.0e9 / 0.96  # of the rock in near_springs.toml

RINGS = "rings are of 4 cells or less at any cell size: the tip's own error in them stays the same share"
EDGES = "what is left at the widest block is the discretisation's"
LETS_GO = 0.3  # of what makes it slip: where the solver splits an interface with friction
SLIP = "the mean over a column (second order, slips later) stands against a crack that is 0.2 % too soft; columns move along the peak"
SMALL = "it is the block's edges that cost a per cent"

Reference = Callable[[Run], tuple[str, dict[str, Any]]]


def crack(run: Run) -> dict[str, float]:
    """Half-length (m), distance to the interface (m) and net pressure (Pa) of a run's crack, which lies before the interface."""
    distance = min(run.interfaces_m[0] - end[0 if run.along == "x" else 1] for end in crack_ends(run))
    return {"half_length_m": half_length(run), "distance_m": distance, "pressure_Pa": net_Pa(run)}


def bonded(run: Run) -> tuple[str, dict[str, Any]]:
    """A crack near a bonded interface."""
    name = "bonded_parallel" if run.along == "x" else "bonded_normal"
    return name, crack(run) | rock(run, 0) | rock(run, 1, "beyond_")


def springs(run: Run) -> tuple[str, dict[str, Any]]:
    """The same near springs."""
    stiffness = {name: given(run, f"interface.springs.{name}") for name in ("normal_stiffness_Pa_m", "shear_stiffness_Pa_m")}
    return "spring_interface", crack(run) | rock(run, 0) | stiffness


def without_springs(law: str) -> Reference:
    """The same near an interface that is 'free' or 'frictionless'."""
    return lambda run: ("spring_interface", crack(run) | rock(run, 0) | {"law": law})


def first_slip_Pa(run: Run) -> float:
    """The net pressure (Pa) at which a sticking interface is at LETS_GO of what makes it slip."""
    law = {"friction": LETS_GO * given(run, "interface.rough.coefficient"), "compression_Pa": given(run, "in_situ.vertical_Pa")}
    place = {key: crack(run)[key] for key in ("half_length_m", "distance_m")}
    return value("coulomb_first_slip", "net_pressure_Pa", **law, **place)


def quantity(name: str, unit: str, measured: Callable[[Run], float], reference: Reference, exact: str, why: str = RINGS) -> Quantity:
    """A number of a run beside a value of its reference."""

    return Quantity.of(name, unit, measured, lambda run: value(reference(run)[0], exact, **reference(run)[1]), why)


def both_tips(reference: Reference, why: str = RINGS) -> tuple[Quantity, ...]:
    """K_I from the interaction integral and J, each at both tips of a crack normal to the interface."""
    return tuple(
        quantity(f"{words}, {place} tip", unit, tip(name, which), reference, exact.format(place), why)
        for words, unit, name, exact in (("K_I", "Pa sqrt(m)", "K_I_Pa_sqrt_m", "K_I_{}"), ("J", "N/m", "J_N_m", "J_{}_N_m"))
        for place, which in (("near", upper), ("far", lower))
    )


MIXED = tuple(
    quantity(name, unit, tip(measured, which), bonded, exact)
    for name, unit, measured, which, exact in (
        ("K_I", "Pa sqrt(m)", "K_I_Pa_sqrt_m", upper, "K_I"), ("K_II", "Pa sqrt(m)", "K_II_Pa_sqrt_m", upper, "K_II"),
        ("kink angle", "degrees", "kink_deg", upper, "kink_deg"), ("J", "N/m", "J_N_m", upper, "J_N_m"),
        ("K_II, lower tip", "Pa sqrt(m)", "K_II_Pa_sqrt_m", lower, "K_II_minus"),
    )
)  # fmt: skip
SLIPS = (Quantity.of("net pressure at 0.3 of first slip", "Pa", first_failed_Pa, first_slip_Pa, SLIP),)


def path_setting(distance_m: float, parallel: bool, middle_m: float = MIDDLE_M) -> str:
    """The crack at a distance (m) before the interface in the middle of the block, as a scene key."""
    a = HALF_LENGTH_M
    if parallel:
        return f"fracture.path_m=[[{middle_m - distance_m},{middle_m - a}],[{middle_m - distance_m},{middle_m + a}]]"
    return f"fracture.path_m=[[{middle_m},{middle_m - distance_m - 2 * a}],[{middle_m},{middle_m - distance_m}]]"


def levels(variant: str, distance_m: float, *cells: int, settings: tuple[str, ...] = ()) -> tuple[Level, ...]:
    """Levels by the number of cells in the distance (m) between crack and interface."""
    keys = (path_setting(distance_m, variant.startswith("parallel")), *settings)
    return tuple(Level(f"{n} cells", distance_m / n, (f"numerics.cell_m={distance_m / n!r}", *keys), variant) for n in cells)


def block_level(width: float) -> Level:
    """A level by the block's width (m), 4 cells from the interface; edges cost as the square of their size."""
    block = (f"domain.width_m={width}", f"domain.height_m={width}", "numerics.cell_m=0.25")
    layers = f'strata.layers=[{{rock="stiff",thickness_m={width / 2}}},{{rock="soft"}}]'
    return Level(f"{width:g} m block", 100.0 / width, (*block, layers, path_setting(1.0, False, width / 2)), "normal_in_stiff")


def small_levels(variant: str) -> tuple[Level, ...]:
    """Levels of a crack 5 m from the interface in the middle of a block of 160 m, with cells of one size."""
    return tuple(Level(f"{n} cells", 5.0 / n, tuple(f"numerics.{key}={5.0 / n!r}" for key in ("cell_m", "far_cell_m")), variant) for n in (2, 4))


def stiffness_settings(stiffness: float) -> tuple[str, ...]:
    """Springs of D a/E' = stiffness, alike along and across, as scene keys."""
    D = stiffness * E_PRIME_PA / HALF_LENGTH_M
    return tuple(f"interface.springs.{name}_stiffness_Pa_m={D!r}" for name in ("normal", "shear"))


near_bonded, near_springs, near_friction = (case_of(scene, smoke_levels=1) for scene in (BONDED, SPRINGS, FRICTION))


def in_both(lies: str, distance_m: float, *cells: int, smoke: int = 1) -> tuple[Case, ...]:
    """A crack in either rock at a distance (m) from the other one, normal or parallel to their border."""
    where = "{:g} m from the other rock, normal to it" if lies == "normal" else "{:g} m beside the other rock"
    return tuple(
        near_bonded(f"bonded_{lies}_{held_by}_{distance_m:g}", f"crack in {held_by} rock, {where.format(distance_m)}",
                    levels(f"{lies}_in_{held_by}", distance_m, *cells), both_tips(bonded) if lies == "normal" else MIXED, smoke)
        for held_by in ("stiff", "soft")
    )  # fmt: skip


def slipping(coefficient: float, longer_s: float) -> Case:
    """A crack 1 m from an interface with friction, under a rising pressure; wide columns slip late, so that their ramp goes on for longer:
    to 8 % above the reference instead of 3 %."""
    variant, says = f"friction_{10 * coefficient:g}", f"crack 1 m from an interface with friction {coefficient:g}: when that is at 0.3 of its first slip"
    own = levels(variant, 1.0, 4, settings=(f"stop.time_s={longer_s}", f"output.fields_every_s={longer_s}")) + levels(variant, 1.0, 8, 16)
    return near_friction(f"slip_{coefficient:g}", says, own, SLIPS)


CASES = (
    *in_both("normal", 1.0, 2, 4, 8, 16, smoke=2),
    *in_both("normal", 0.5, 2, 4, 8),
    *in_both("normal", 2.5, 4, 8, 16),
    near_bonded("block_edges", "what the edges of the block cost: its width doubled",
                tuple(block_level(width) for width in (200.0, 400.0, 800.0, 1600.0)), both_tips(bonded, EDGES)),
    *in_both("parallel", 2.5, 2, 4, 8, 16, smoke=2),
    *in_both("parallel", 1.25, 2, 4, 8),
    *in_both("parallel", 5.0, 4, 8, 16),
    *(near_springs(f"springs_{stiffness:g}", f"crack 1 m from springs of D a/E' = {stiffness:g}, normal to them",
                   levels("springs", 1.0, 4, 8, settings=stiffness_settings(stiffness)), both_tips(springs)) for stiffness in (0.01, 0.1, 1.0, 10.0, 100.0)),
    near_springs("free", "crack 1 m from springs so soft that they are a free surface",  # K is 4e-6 below that near one
                 levels("springs", 1.0, 4, 8, settings=stiffness_settings(1e-6)), both_tips(without_springs("free"))),
    near_springs("frictionless", "crack 1 m from a closed interface without friction",
                 levels("frictionless", 1.0, 4, 8), both_tips(without_springs("frictionless"))),
    slipping(0.4, 0.98),
    slipping(0.6, 1.12),
    near_bonded("small_block", "crack 5 m from a bonded interface in a uniform block of 160 m, without inertia",
                small_levels("small_block"), both_tips(bonded, SMALL)),
    near_bonded("small_block_settling", "the same brought to rest by damping: the same K",
                small_levels("small_block_settling"), both_tips(bonded, SMALL), mechanics="explicit"),
)  # fmt: skip
