"""Small cut masses: a crack anywhere in a cell leaves copies of nodes with next to no mass on one of its sides."""

import math
from functools import partial

from verification.harness.load import Run, given, value
from verification.stability.family import FAILED, KINEMATICS, SCENES, STABLE, Checked, Edge, Family, Parameter, at_values, close, walked
from verification.stability.theory.step_limit import Block, courant_limit, damped_limit

SCENE = SCENES / "cut_mass.toml"
OFFSETS = (0.01, 0.03, 0.1, 0.2, 0.24, 0.26, 0.3, 0.4, 0.49, 0.5, 0.6, 0.7, 0.74, 0.76, 0.9, 0.97, 0.99)
MOST = 0.02  # error of K_I at 4 cells a half length, uniform cells
COURANT = {"total": 1.1, "updated": 0.65}  # a little below what a block without a crack stands
DAMPING_1_S, SPEED_M_S = 200.0, math.sqrt(1.0e10 / 2500.0 * 0.8 / (1.2 * 0.6))  # of the scene, with cells of 1 m
SECTION = "Small cut masses as a crack moves through a cell"


def check(run: Run) -> Checked:
    """K_I against that of the same block."""
    block = {"width_m": given(run, "domain.width_m"), "half_height_m": given(run, "domain.height_m")}
    expected = value("block_crack", "K_I", half_length_m=4.0, pressure_Pa=1.0e6, **block)
    found = run.summary.tips[0].K_I_Pa_sqrt_m
    return close(found, expected, MOST, f"K_I {1e-6 * found:.4f}, exact {1e-6 * expected:.4f} MPa m^0.5")


def settings(kinematics: str, offset: float, courant: float) -> tuple[str, ...]:
    """The keys of a run."""
    x = f"{10.0 + offset:g}"
    return f"numerics.kinematics={kinematics}", f"fracture.path_m=[[{x}, 0], [{x}, 4]]", f"numerics.courant={courant:.5g}"


def through_cell(kinematics: str) -> Family:
    """The walk through a cell at a long time step."""
    courant = COURANT[kinematics]
    return Family(
        f"cut_{kinematics}", f"Crack anywhere in a cell: {KINEMATICS[kinematics]}, c_P dt/h = {courant:g}",
        "K_I must be right wherever the crack is in its cell, at a time step little below that of a block without a crack.",
        Parameter("place of the crack in a cell"),
        walked(at_values(SCENE, lambda offset: settings(kinematics, offset, courant), "{:g}"), OFFSETS, smoke=(0.01, 0.49)), check,
        beyond=(STABLE,), section=SECTION, check_name="error of K_I",
    )  # fmt: skip


def over_step(offset: float) -> Family:
    """The walk over the time step with the crack at a place."""
    at = partial(at_values, SCENE, lambda courant: settings("total", offset, courant))
    return Family(
        f"cut_step_{100.0 * offset:.0f}", f"Time step with a crack at {offset:g} of a cell", "The longest step is that of the block without a crack.",
        Parameter("c_P dt/h"), walked(at("{:g}"), (0.5, 0.9, 1.1, 1.3, 1.6), smoke=(0.9, 1.3) if offset == 0.01 else (1.3,)), check,
        beyond=(FAILED,), section=SECTION, check_name="error of K_I",
        edge=Edge("2/omega_max of M^-1 K of a block without a crack, put together in Python, with the scene's damping: (omega dt)^2 <= 4 - 2 damping dt.",
                  lambda: damped_limit(courant_limit(Block("bspline2", 2), "total", 0.2), DAMPING_1_S / SPEED_M_S), at("courant {:.5g}"), (0.9, 1.4)),
    )  # fmt: skip


FAMILIES = (*map(through_cell, KINEMATICS), *map(over_step, (0.01, 0.24, 0.26, 0.5)))
