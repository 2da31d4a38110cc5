"""What a hundred thousand steps make of noise and of a wave: null space, damping of the transfers, drift of the energy."""

import math

import numpy as np

from verification.harness.load import LoadError, Run
from verification.stability.families.time_step import CELLS, POISSON, SCENE, WAYS, way_keys
from verification.stability.family import MARKED, STABLE, Checked, Family, Parameter, Point, at_most, close
from verification.stability.theory.step_limit import Block, amplitude_factor, null_share, plane_mode

COURANT = 0.5
STEP_S = COURANT * math.sqrt(2500.0 / 1.0e10 * 1.2 * 0.6 / 0.8)  # of the scene: h/c_P of 1 m cells
MOST_DRIFT = 0.01  # of the energy in 1e5 steps: what the mean over half a thousand rows leaves of the swing
HELD = Block("bspline2", 2, CELLS, True)


def point(label: str, value: float, way: str, steps: float, rows: int, smoke: bool, *keys: str) -> Point:
    """A run of so many steps in the held block by a transfer (or total), with so many rows of history."""
    time_s = steps * STEP_S
    times = (f"stop.time_s={time_s:.8g}", f"output.fields_every_s={time_s / rows:.8g}")
    return Point(label, value, SCENE, (*way_keys(way), *times, *keys), "held", smoke=smoke)


def way_of(run: Run) -> str:
    """The transfer of a run, or total."""
    numerics = run.scene["numerics"]
    return "total" if numerics["kinematics"] == "total" else str(numerics["transfer"])


def start(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The scene's noise, m/s."""
    return 1e-6 * np.sin(1e4 * x + 3e4 * y * y + 1.0), 1e-6 * np.sin(2e4 * y + 5e4 * x * x + 2.0)


def check_noise(run: Run) -> Checked:
    """The energy left against what no grid sees of the noise, or of all that nodes have seen where they keep it."""
    energy, way, few = run.summary.energy, way_of(run), run.summary.steps < 1000
    left = (energy["kinetic_J"] + energy["strain_J"]) / energy["initial_kinetic_J"]
    if way == "total":
        return at_most(left, 1.0, f"{left:.2g} of the points' energy, within its swing")
    if way != "flip":
        return at_most(left, 0.2 if few else 0.02, f"{left:.2g} of the energy is left")
    share = null_share(HELD, start)
    return close(left, share, 0.05 if few else 0.005, f"{left:.4f} of the energy is left, the null space has {share:.4f}")


def loss_of(way: str, mode: int) -> float:
    """Share of the energy of a mode that a step takes, by theory."""
    stiffness, smoothing = plane_mode(HELD, POISSON, mode)
    return -2.0 * math.log(amplitude_factor(way, COURANT**2 * stiffness, smoothing))


def check_wave(run: Run) -> Checked:
    """The loss of energy a step against theory; where there is none, over the whole run."""
    way, mode = way_of(run), round(float(str(run.scene["initial"]["velocity_m_s"][0]).split("sin(")[1].split("*")[0]))
    energy = run.history["kinetic_J"] + run.history["strain_J"]
    if way == "total":  # from the first to the second half: the mean of many rows is free of the swing
        half = len(energy) // 2
        found = float(np.mean(energy[-half:]) / np.mean(energy[:half]) - 1.0)
        return at_most(abs(found), MOST_DRIFT, f"energy drifts by {found:.1e} of itself in {run.summary.steps} steps")
    expected = loss_of(way, mode)
    if way == "flip":  # it keeps what no grid sees
        energy = energy - null_share(HELD, lambda x, y: (np.sin(mode * math.pi * x / CELLS), 0.0 * y)) * run.summary.energy["initial_kinetic_J"]
    if len(energy) < 10 or not np.all(energy > 0.0):
        raise LoadError(f"{run.folder}: no energies to follow")
    found = -float(np.polyfit(run.history["time_s"], np.log(energy), 1)[0]) * run.summary.time_s / run.summary.steps
    return close(found, expected, 0.03, f"{found:.4g} of the energy lost a step, theory says {expected:.4g}")


def noise(way: str) -> Family:
    """The walk over the number of steps."""
    points = tuple(point(f"{steps}", float(steps), way, steps, 50, steps == 1000) for steps in (100, 1000, 10000, 100000))
    return Family(
        f"noise_{way}", f"Noise over 1e5 steps: {WAYS[way]}", "Noise must not grow, and what is left of it is what theory says.", Parameter("steps", log=True),
        points, check_noise, beyond=(STABLE,), section="Null-space noise over 1e5 steps",
        check_name="energy left, less that of theory or over its bound",
    )  # fmt: skip


def moving(way: str, mode: int) -> Point:
    """A wave for as long as it takes to lose what can be measured, or for 1e5 steps."""
    wave_of = f'initial.velocity_m_s=["1e-4*sin({mode}*pi*X/6)", "0"]'
    if way == "total":
        short = mode == 1
        return point("mode 1, 1000 steps" if short else f"mode {mode}", float(mode), way, 1000 if short else 100000, 1000, short, wave_of)
    return point(f"mode {mode}", float(mode), way, min(max(4.0 / loss_of(way, mode), 60.0), 100000.0), 50, mode == 2 or mode == 1 and way == "flip", wave_of)


def wave(way: str) -> Family:
    """The walk over the wave's length."""
    return Family(
        f"wave_{way}", f"Damping of a wave: {WAYS[way]}", "A standing wave loses by the transfer what theory says, and nothing else.",
        Parameter("half waves in the block"), tuple(moving(way, mode) for mode in (1, 2, 3)), check_wave, beyond=(MARKED,) if way == "total" else (STABLE,),
        section="What transfers take from a wave", check_name="loss of energy a step less that of theory, or drift over 2 %",
    )  # fmt: skip


FAMILIES = (*map(noise, WAYS), *map(wave, WAYS))
