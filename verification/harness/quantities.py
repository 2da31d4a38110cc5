"""What of an experiment is followed as mesh, steps or block change: the same numbers of every run, with what they resolve.

Pressures are inlet pressures (Pa), heights those of the tip above the symmetry line (m), of two tips of each: the upper one goes up, the lower one
down. Nothing here is counted in cells, so that the numbers mean the same on every mesh.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import accumulate
from typing import Any

import numpy as np

from verification.harness.load import GROWTH_M, Array, Run
from verification.harness.observables import (
    SLACK_M, Measured, distances_to, exactly, final_angle_deg, final_height_m, grew, interface_height, lateral_deflection_m,
    nothing, path_length, pressure_at_height, resample, start_Pa, when_at,
)  # fmt: skip

NO_ARREST = "no arrest"  # the flag of a pause that is none

# A pause over which the inlet rises by this is an arrest (the solver's own word for it), Pa.
ARREST_PA = 0.05e6

# Above an interface, m, up to which a pause counts as one at it: the 4 cells of 1 m within which claims look for arrests.
ABOVE_M = 4.0

# Share of the margin in K to which a quasi-static run finds an event (event_tolerance in solver/quasistatic/load_steps.cpp).
EVENT_SHARE = 1e-4

HEIGHTS_M = (10.0, 15.0, 20.0, 40.0, 60.0)


@dataclass(frozen=True)
class Quantity:
    """A number that every run of an experiment has: its name (with the unit), what it is in words, and how to get it."""

    name: str
    label: str
    unit: str
    measure: Callable[[Run], Measured]


@dataclass(frozen=True)
class Pause:
    """A stay of the tip at a height, m, while the inlet rises from one pressure to another, Pa; infinite where the run ends first."""

    height_m: float
    from_Pa: float
    to_Pa: float

    @property
    def rise_Pa(self) -> float:
        """Rise of the inlet pressure."""
        return self.to_Pa - self.from_Pa


@dataclass(frozen=True)
class Side:
    """A tip that is followed: what its columns and names have, its label, and the sense in which it grows along y."""

    columns: str
    names: str
    label: str
    sense: int

    def y(self, run: Run) -> Array:
        """Its height in every row, m."""
        return run.history[f"{self.columns}y_m"]

    def x(self, run: Run) -> Array:
        """Its x in every row, m; that of the upper one where the run has no such column."""
        return run.history.get(f"{self.columns}x_m", run.history["tip_x_m"])

    def beyond(self, y: Array | float, height_m: float) -> Any:
        """How far places are beyond a height as this tip goes, m."""
        return self.sense * (y - height_m)


UPPER, LOWER = Side("tip_", "", "", 1), Side("lower_tip_", "lower_", ", lower tip", -1)


def pauses(run: Run, side: Side = UPPER) -> list[Pause]:
    """Every stay of a tip between two growth events, after the first one."""
    x, y, inlet = side.x(run), side.y(run), run.history["inlet_Pa"]
    starts = [0]
    for k in range(1, len(x)):
        if math.hypot(x[k] - x[starts[-1]], y[k] - y[starts[-1]]) > GROWTH_M:
            starts.append(k)
    ends = [float(inlet[k]) for k in starts[1:]] + [math.inf]
    return [Pause(float(y[k]), float(inlet[k]), end) for k, end in zip(starts[1:], ends[1:])]


def pause_at(run: Run, interface: int, side: Side = UPPER) -> Pause | Measured:
    """The longest pause at an interface (counted from 1 below), or why there is none. It counts from 1.5 increments before it, where growth would meet
    the interface, to 4 m beyond."""
    height = interface_height(run, interface)
    low, high = -1.5 * run.increment_m - SLACK_M, ABOVE_M + SLACK_M
    found = [pause for pause in pauses(run, side) if low <= side.beyond(pause.height_m, height) <= high]
    if not found:
        return nothing(f"does not reach the interface at {height:g} m")
    last_Pa = float(run.history["inlet_Pa"][-1])
    return max(found, key=lambda pause: min(pause.to_Pa, last_Pa) - pause.from_Pa)


def interface_quantities(number: int, of: int, side: Side = UPPER) -> list[Quantity]:
    """Arrest height, restart pressure and rise between them at one of so many interfaces across the fracture. All are of the longest pause there,
    flagged where it is no arrest; where the run ends in it, it leaves a bound of the last two."""

    def of_pause(value: Callable[[Pause], float]) -> Callable[[Run], Measured]:
        def measure(run: Run) -> Measured:
            found = pause_at(run, number, side)
            if isinstance(found, Measured):
                return found
            so_far = replace(found, to_Pa=min(found.to_Pa, float(run.history["inlet_Pa"][-1])))
            known = math.isfinite(value(found))
            flags = () if so_far.rise_Pa >= ARREST_PA else (NO_ARREST,)
            return Measured(value(so_far), value(found) if known else math.inf, "" if known else "does not grow on", flags)

        return measure

    where, name = f"{f' at interface {number}' if of > 1 else ''}{side.label}", f"{number}_{side.names}"
    return [
        Quantity(f"arrest_{name}m", f"arrest height{where}", "m", of_pause(lambda pause: pause.height_m)),
        Quantity(f"restart_{name}Pa", f"restart pressure{where}", "Pa", of_pause(lambda pause: pause.to_Pa)),
        Quantity(f"plateau_{name}Pa", f"rise while arrested{where}", "Pa", of_pause(lambda pause: pause.rise_Pa)),
    ]


def lowest_end_m(content: dict[str, Any]) -> float | None:
    """Height of the lower end of a fracture with two tips, m; None where the fracture begins on the symmetry line."""
    foot = min(float(point[1]) for point in content["fracture"]["path_m"])
    return None if content["domain"].get("bottom", "symmetry") == "symmetry" and foot == 0.0 else foot


def downward_quantities(foot_m: float, content: dict[str, Any], heights_m: Sequence[float]) -> list[Quantity]:
    """What is followed of the lower one of two tips: its pressures at heights that it may come down to, and how far down it gets."""
    lowest = float(content.get("stop", {}).get("lower_tip_y_m", 0.0))
    at = [Quantity(f"pressure_at_{height:g}_lower_Pa", f"pressure at {height:g} m{LOWER.label}", "Pa",
                   lambda run, height=height: when_at(run, run.history["inlet_Pa"], height, "lower_tip_y_m", LOWER.sense))
          for height in heights_m if lowest <= height < foot_m]  # fmt: skip
    return [*at, Quantity("final_height_lower_m", f"final height{LOWER.label}", "m", lambda run: exactly(float(np.min(LOWER.y(run)))))]


def quantities_of(content: dict[str, Any], heights_m: Sequence[float] = HEIGHTS_M) -> list[Quantity]:
    """What is followed of a scene (its keys with a variant's in place); heights above the tip's first and below its last only, and below the lower
    tip's first; of an interface what happens to the tip that goes towards it."""
    found = [Quantity("start_Pa", "start of growth", "Pa", start_Pa)]
    strata, foot = content.get("strata", {}), lowest_end_m(content)
    if foot is not None:
        found += [Quantity(f"start_{name}_Pa", f"start of the {name} tip", "Pa", partial(start_Pa, parameters={"tip": name})) for name in names_of_tips(content)]
    if strata.get("along", "y") == "y":
        across = [k for k, name in enumerate(strata.get("interfaces", []), 1) if name != "perfect"]
        heights = list(accumulate(float(layer.get("thickness_m", 0.0)) for layer in strata.get("layers", [])))
        for number in across:
            below = foot is not None and heights[number - 1] <= foot
            found += interface_quantities(number, len(across), LOWER if below else UPPER)
    tip = max(float(point[1]) for point in content["fracture"]["path_m"])
    top = float(content.get("stop", {}).get("tip_y_m", content["domain"]["height_m"]))
    for height in heights_m:
        if tip < height <= top:
            found.append(Quantity(f"pressure_at_{height:g}_Pa", f"pressure at {height:g} m", "Pa", partial(pressure_at_height, height_m=height)))
    found += [Quantity("final_height_m", "final height", "m", final_height_m),
              Quantity("final_Pa", "final pressure", "Pa", lambda run: exactly(run.summary.inlet_Pa))]  # fmt: skip
    if foot is not None:
        found += downward_quantities(foot, content, heights_m)
    turned = [Quantity("deflection_m", "farthest deflection", "m", lateral_deflection_m), Quantity("final_angle_deg", "final angle", "degrees", final_angle_deg)]
    return found + (turned if turns(content) else [])


def names_of_tips(content: dict[str, Any]) -> tuple[str, str]:
    """What the solver calls the two tips of a fracture as it begins: by y, or by x where they are level to half a cell."""
    (_, y0), (_, y1) = content["fracture"]["path_m"][0], content["fracture"]["path_m"][-1]
    return ("left", "right") if abs(float(y1) - float(y0)) < 0.5 * float(content["numerics"]["cell_m"]) else ("upper", "lower")


def closing_Pa(run: Run) -> float:
    """The least horizontal stress of the layers, in which a fracture opens first, Pa; where one is a formula the pressure that the run starts at."""
    in_situ, layers = run.scene.get("in_situ", {}), run.scene.get("strata", {}).get("layers", [])
    stresses = [layer.get("horizontal_Pa", in_situ.get("horizontal_Pa", 0.0)) for layer in layers] or [in_situ.get("horizontal_Pa", 0.0)]
    if any(isinstance(stress, str) for stress in stresses):
        return float(run.history["inlet_Pa"][0])
    return float(min(stresses))


def lack_words(measured: Measured, run: Run, unit: str) -> str:
    """Why a run has no value of a quantity, with the bound that it leaves."""
    bound = f", at least {measured.low:.6g} {unit}" if math.isfinite(measured.low) else ""
    return f"{measured.note.removeprefix(run.name).strip()}{bound}"


def turns(content: dict[str, Any]) -> bool:
    """Whether the fracture of a scene may leave its straight way."""
    return content["fracture"].get("direction", "straight") != "straight"


def noise_of(quantity: Quantity, run: Run, value: float) -> float:
    """Differences of a quantity below this are not seen by the solver. Pressures: without inertia an event is found to 1e-4 of its margin in K, that
    is of the net pressure; with inertia to a time step. Others: round-off."""
    if quantity.unit != "Pa":
        return 1e-6
    if run.summary.mechanics == "quasistatic":
        return EVENT_SHARE * abs(value - closing_Pa(run))
    rate = float(run.scene.get("fluid", {}).get("inlet", {}).get("rate_Pa_s", 0.0))
    return rate * run.summary.time_s / max(run.summary.steps, 1)


def path_gap(run: Run, against: Run, length_m: float = math.inf) -> tuple[float, float] | None:
    """Root mean square and largest distance of a path from another's, m, over the length both have (no more than length_m). Both are counted from
    their first points, so that blocks of different width compare; None where one does not grow."""
    if not (grew(run) and grew(against)):
        return None
    own, other, step = run.path - run.path[0], against.path - against.path[0], 0.25
    common = min(path_length(own), path_length(other), length_m)
    far = distances_to(resample(own, step)[: int(common / step + 1e-9) + 1], other)
    return float(np.sqrt(np.mean(far**2))), float(np.max(far))


# The height at which the pressure is compared where the base gets there, m; else the highest below that it reaches.
HEIGHT_M = 40.0

NOT_FOLLOWED = ("final_height", "final_Pa", "final_angle_deg", "deflection_m", "plateau")


@dataclass(frozen=True)
class Effect:
    """What a change moves a quantity by (None where it says nothing, with the reason), in the quantity's unit."""

    value: float | None
    note: str = ""


def followed(content: dict[str, Any], base: Run) -> list[Quantity]:
    """What is compared: start, arrests that the base has, and the pressure at a height that it reaches."""
    reached = [height for height in HEIGHTS_M if height <= min(float(base.history["tip_y_m"].max()), HEIGHT_M)]
    own = [(one, one.measure(base)) for one in quantities_of(content, reached[-1:]) if not one.name.startswith(NOT_FOLLOWED)]
    return [one for one, measured in own if measured.exact and NO_ARREST not in measured.flags]


def effects_of(quantities: Sequence[Quantity], with_path: bool, base: Run, run: Run, short: str = "") -> dict[str, Effect]:
    """What a run moves each quantity by against the base, by its name, and how far its path is off (`short`: a note on that)."""
    def moved(quantity: Quantity) -> Effect:
        found = quantity.measure(run)
        if not found.exact:
            return Effect(None, lack_words(found, run, quantity.unit))
        return Effect(found.low - quantity.measure(base).low, ", ".join(found.flags))

    effects = {quantity.name: moved(quantity) for quantity in quantities}
    if with_path:
        gap = path_gap(run, base)
        effects["path_m"] = Effect(None, "does not grow") if gap is None else Effect(gap[1], short)
    return effects
