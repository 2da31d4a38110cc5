"""Runs and references as cases take them: what reads runs is the module that people install, verification/strata; here are the fields of all output times,
what a run was given and what it came to (SI), and strata-reference, which is asked for analytic values so that no test has to hold one."""

import json
import math
import subprocess
from collections.abc import Callable, Mapping
from functools import cache, reduce
from operator import getitem
from typing import Any

import h5py
import numpy as np

from verification.harness.paths import reference_program
from verification.strata import (  # noqa: F401
    GROWTH_M, Array, Event, LoadError, Run, Summary, Suspicion, Tip, columns_of, items_below, load, opened, read_history, read_summary,
)  # fmt: skip

# The monitor that says that speeds of growth are no result: no verdict is about speeds.
OF_SPEEDS = "surface_energy_share"


def frames(run: Run, group: str) -> list[tuple[float, dict[str, Array]]]:
    """Output times (s) of a group of result.h5, such as 'fracture', with the arrays stored at each, by their names."""
    with opened(run) as store:
        times = store["times"][()]
        return [(float(times[int(name)]), {path: item[()] for path, item in items_below(below) if isinstance(item, h5py.Dataset)})
                for name, below in sorted(store[group].items()) if name.isdigit()]  # fmt: skip


Point = tuple[float, float]


def given(run: Run, key: str) -> float:
    """The number of a scene key, "in_situ.horizontal_Pa" say."""
    return float(reduce(getitem, key.split("."), run.scene))  # type: ignore[arg-type]


def rock(run: Run, of: str | int = "stiff", prefix: str = "", density: bool = False) -> dict[str, float]:
    """Young's modulus, Poisson's ratio (and density) of a rock, by its name or its layer's number."""
    name = of if isinstance(of, str) else run.scene["strata"]["layers"][of]["rock"]
    keys = ("youngs_modulus_Pa", "poisson_ratio", *(("density_kg_m3",) if density else ()))
    return {f"{prefix}{key}": float(run.scene["rock"][name][key]) for key in keys}


def E_prime(run: Run, of: str | int = "stiff") -> float:
    """E/(1 - nu^2) of a rock, Pa."""
    E, nu = rock(run, of).values()
    return E / (1.0 - nu**2)


def net_Pa(run: Run, inlet_Pa: float | None = None) -> float:
    """An inlet pressure (at the run's end where none is given) above the closing stress, Pa."""
    return (run.summary.inlet_Pa if inlet_Pa is None else inlet_Pa) - given(run, "in_situ.horizontal_Pa")


def crack_ends(run: Run) -> tuple[Point, Point]:
    """Both ends of the scene's fracture, m."""
    (x, y), (end_x, end_y) = run.scene["fracture"]["path_m"][0], run.scene["fracture"]["path_m"][-1]
    return (float(x), float(y)), (float(end_x), float(end_y))


def half_length(run: Run) -> float:
    """Half the length of a straight crack with two tips, m."""
    return 0.5 * math.dist(*crack_ends(run))


def upper(run: Run) -> Tip:
    """The tip with the largest y; raises LoadError where there is none."""
    if not run.summary.tips:
        raise LoadError(f"{run.folder}: no tip")
    return max(run.summary.tips, key=lambda tip: tip.y_m)


def lower(run: Run) -> Tip:
    """The tip with the smallest y."""
    return min(run.summary.tips, key=lambda tip: tip.y_m)


def tip(name: str, which: Callable[[Run], Tip] = lambda run: run.summary.tips[0]) -> Callable[[Run], float]:
    """A value of a tip at the end, of the first one where none is chosen."""
    return lambda run: float(getattr(which(run), name))


def energy(name: str) -> Callable[[Run], float]:
    """A line of the energy ledger at the end, J per metre of thickness."""
    return lambda run: run.summary.energy[name]


def last(run: Run, group: str) -> tuple[float, dict[str, Array]]:
    """Time (s) and fields of a group of result.h5 at the last output; raises LoadError where there is none."""
    stored = frames(run, group)
    if not stored:
        raise LoadError(f"{run.folder}: no fields of {group}")
    return stored[-1]


def start_of(run: Run) -> Event:
    """The first growth of a fracture; raises LoadError where there is none."""
    for event in run.summary.events:
        if event.kind == "start":
            return event
    raise LoadError(f"{run.folder}: the fracture did not start")


def first_failed_Pa(run: Run) -> float:
    """Net pressure at which the first place of the lowest interface let go, Pa; raises LoadError where none did."""
    failed_s = last(run, "interfaces")[1]["0/failed_s"].astype(float)
    if not (failed_s >= 0.0).any():
        raise LoadError(f"{run.folder}: the interface did not let go")
    return net_Pa(run, given(run, "fluid.inlet.start_Pa") + given(run, "fluid.inlet.rate_Pa_s") * float(failed_s[failed_s >= 0.0].min()))


def path_key(*points: Point) -> str:
    """The fracture along these points (m), as a scene key."""
    return "fracture.path_m=[" + ",".join(f"[{x!r},{y!r}]" for x, y in points) + "]"


class NoReference(Exception):
    """The reference program does not know what it was asked, or failed; the message is its own."""


Setting = float | str | list[float]


@cache
def _answer(name: str, settings: tuple[str, ...]) -> dict[str, Any]:
    """What strata-reference says for a name and settings."""
    command = [str(reference_program()), name, *(word for setting in settings for word in ("--set", setting))]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise NoReference(f"{' '.join(command)}: exit {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def settings_of(settings: Mapping[str, Any]) -> tuple[str, ...]:
    """Settings as the program takes them, numbers with all their digits."""
    return tuple(f"{key}={given!r}" if isinstance(given, (float, list)) else f"{key}={given}" for key, given in settings.items())


def values(name: str, quantity: str, **settings: Setting) -> np.ndarray:
    """One quantity of a named reference solution at each of the places or times that a setting lists, SI."""
    found = _answer(name, settings_of(settings))["values"]
    if quantity not in found:
        raise NoReference(f"{name} has no {quantity}; it has {', '.join(sorted(found))}")
    return np.atleast_1d(np.array(found[quantity]["value"], dtype=float))


def value(name: str, quantity: str, **settings: Setting) -> float:
    """One value of a named reference solution, SI."""
    return float(values(name, quantity, **settings).item())


def relative_error(name: str, **settings: Setting) -> float:
    """The relative error that a named reference solution gives of itself."""
    return float(_answer(name, settings_of(settings))["error_estimate"]["relative"])


EDGE_M = 2.0  # the lower tip is held so far from the rock's fine cells


def column(run: Run) -> dict[str, Any]:
    """Borders, stresses and toughness of a run's layers and its crack, as layered_height takes them; mirrored where the bottom is a mirror."""
    layers = run.scene["strata"]["layers"]
    stress = [float(layer.get("horizontal_Pa", run.scene["in_situ"]["horizontal_Pa"])) for layer in layers]
    toughness = [float(run.scene["rock"][layer["rock"]]["toughness_Pa_sqrt_m"]) for layer in layers]
    border = np.cumsum([layer["thickness_m"] for layer in layers[:-1]]).tolist()
    (_, bottom), (_, top) = run.scene["fracture"]["path_m"]
    height = given(run, "domain.height_m")
    limits = {"lower_limit_m": EDGE_M, "upper_limit_m": height}
    if run.scene["domain"]["bottom"] == "symmetry":
        border, stress, toughness = [-y for y in border[::-1]] + border, stress[:0:-1] + stress, toughness[:0:-1] + toughness
        bottom, limits["lower_limit_m"] = -top, -height
    return {"border_m": border, "stress_Pa": stress, "toughness_Pa_sqrt_m": toughness, "bottom_m": bottom, "top_m": top, **limits}


def pressure_beyond(run: Run, y: float) -> float:
    """Inlet pressure at which the tip leaves a height, Pa: that of the first row with a higher one."""
    higher = np.flatnonzero(run.history["tip_y_m"] > y + 1e-6)
    if not higher.size:
        raise LoadError(f"{run.folder}: the tip did not pass {y} m")
    return float(run.history["inlet_Pa"][higher[0]])
