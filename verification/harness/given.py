"""What a run was given and what it came to, as references take it; SI."""

import math
from collections.abc import Callable
from functools import reduce
from operator import getitem

from verification.harness.load import Array, Event, LoadError, Run, Tip, frames

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
