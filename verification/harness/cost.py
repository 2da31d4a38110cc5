"""What runs will cost before they are made: particles times steps over speed, from the scene and from runs made before."""
from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from verification.harness.load import LoadError, Run, Summary, load

# Particle-steps a second on one thread where no run says better: explicit runs of the experiments did 3 to 12 million,
# quasi-static ones 1 to 5 million.
SPEED = {"explicit": 8.0e6, "quasistatic": 2.0e6}

# Steps of a quasi-static run an increment of growth: 7.5 in Experiment 1 with the study's flow, 5 to 20 elsewhere.
STEPS_AN_INCREMENT = 8.0


@dataclass(frozen=True)
class Cost:
    """An estimate: particles, steps, seconds on one thread, and whether a run of the same experiment was at hand."""

    particles: float
    steps: float
    seconds: float
    measured: bool


def wave_speed(rock: dict[str, Any]) -> float:
    """Speed of a P wave, m/s: sqrt(E (1 - nu)/((1 + nu)(1 - 2 nu) rho))."""
    E, nu, rho = (float(rock.get(key, default)) for key, default in
                  (("youngs_modulus_Pa", 1e10), ("poisson_ratio", 0.25), ("density_kg_m3", 2500.0)))  # fmt: skip
    return math.sqrt(E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu) * rho))


def duration_s(content: dict[str, Any]) -> float:
    """The longest that a scene can run, s: to its time, or up the ramp to its last pressure."""
    stop, inlet = content.get("stop", {}), content.get("fluid", {}).get("inlet", {})
    longest = [float(stop["time_s"])] if "time_s" in stop else []
    if "inlet_Pa" in stop and float(inlet.get("rate_Pa_s", 0.0)) > 0.0:
        longest.append((float(stop["inlet_Pa"]) - float(inlet.get("start_Pa", 0.0))) / float(inlet["rate_Pa_s"]))
    return min(longest, default=1.0)


def steps_of(content: dict[str, Any], mechanics: str) -> float:
    """Steps of a run at most (explicit, by courant) or by experience (quasi-static)."""
    numerics, fracture = content["numerics"], content.get("fracture", {})
    if mechanics == "explicit":
        fastest = max(wave_speed(rock) for rock in content["rock"].values())
        return duration_s(content) * fastest / (float(numerics.get("courant", 0.5)) * float(numerics["cell_m"]))
    tip = max((float(point[1]) for point in fracture.get("path_m", [])), default=0.0)
    way = float(content.get("stop", {}).get("tip_y_m", content["domain"]["height_m"])) - tip
    return STEPS_AN_INCREMENT * max(way / float(fracture.get("increment_m", 1.0)), 1.0)


def cost_of(content: dict[str, Any], mechanics: str, like: Summary | None = None, like_cell_m: float = 1.0) -> Cost:
    """The cost of a scene (its keys as they will be used); `like` is a run of the same experiment at another cell size.

    Particles are those of a uniform grid, or of `like` times the square of the ratio of cell sizes, which a graded grid falls short of. Steps are
    those of `like`, times the ratio of cell sizes where a wave limits the step.
    """
    numerics, domain = content["numerics"], content["domain"]
    cell = float(numerics["cell_m"])
    particles = float(domain["width_m"]) * float(domain["height_m"]) / cell**2 * float(numerics.get("particles_per_cell", 4))
    steps, speed = steps_of(content, mechanics), SPEED[mechanics]
    if like is not None and like.steps > 0 and like.particle_steps_per_s > 0.0:
        particles = like.particles * (like_cell_m / cell) ** 2
        steps = like.steps * (like_cell_m / cell if mechanics == "explicit" else 1.0)
        speed = like.particle_steps_per_s
    return Cost(particles, steps, particles * steps / speed, like is not None)


def nearest(folders: Iterable[Path], cell_m: float) -> tuple[Summary, float] | None:
    """The run among folders whose cells are nearest in size, with that size (m); None where none came to its end."""
    found: list[Run] = []
    for folder in folders:
        try:
            run = load(folder)
        except LoadError:
            continue
        if run.summary.status == "completed":
            found.append(run)
    if not found:
        return None
    best = min(found, key=lambda run: abs(math.log(float(run.scene["numerics"]["cell_m"]) / cell_m)))
    return best.summary, float(best.scene["numerics"]["cell_m"])
