"""What claims are about, as functions of run folders.

Every observable is an interval: a single number where a run shows it, and a bound where the run ended first. Heights are
tip y above the symmetry line (m); pressures are inlet pressures (Pa).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from verification.harness.load import GROWTH_M, Array, LoadError, Run, frames

# The flag of an arrest or plateau that rests on J where an interface is too near for it to be trusted.
BY_J = "J at interface"

Parameters = dict[str, Any]
NONE: Parameters = {}

# Heights are compared with this slack, m: far below any increment, above what the rock moves a tip.
SLACK_M = GROWTH_M


@dataclass(frozen=True)
class Measured:
    """A number known to lie in [low, high]; NaN in both where there is nothing to measure, then `note` says why."""

    low: float
    high: float
    note: str = ""
    flags: tuple[str, ...] = ()

    @property
    def exact(self) -> bool:
        """Whether the number itself is known."""
        return self.low == self.high

    @property
    def value(self) -> float | None:
        """The number, or the finite bound of it that is known, or None."""
        finite = [bound for bound in (self.low, self.high) if math.isfinite(bound)]
        return finite[0] if finite else None

    def holds(self, at_least: float | None, at_most: float | None) -> bool | None:
        """Whether the number is in the asked range; None where its bounds leave that open or there is no number."""
        if math.isnan(self.low) or math.isnan(self.high):
            return None
        asked_low = -math.inf if at_least is None else at_least
        asked_high = math.inf if at_most is None else at_most
        if self.low >= asked_low and self.high <= asked_high:
            return True
        return False if self.high < asked_low or self.low > asked_high else None


def exactly(number: float, *flags: str) -> Measured:
    """A number that is known."""
    return Measured(float(number), float(number), flags=flags)


def nothing(note: str) -> Measured:
    """No number, and why."""
    return Measured(math.nan, math.nan, note)


def difference(a: Measured, b: Measured) -> Measured:
    """a - b."""
    return Measured(a.low - b.high, a.high - b.low, "; ".join(filter(None, (a.note, b.note))), a.flags + b.flags)


def ratio(a: Measured, b: Measured) -> Measured:
    """a / b for two numbers that are not negative."""
    note, flags = "; ".join(filter(None, (a.note, b.note))), a.flags + b.flags
    if b.high == 0.0:
        beyond = math.inf if a.low > 0.0 else math.nan
        return Measured(beyond, beyond, note or "the number to divide by is zero", flags)
    low = a.low / b.high if math.isfinite(b.high) else 0.0
    return Measured(low, a.high / b.low if b.low > 0.0 else math.inf, note, flags)


def grew(run: Run) -> bool:
    """Whether any tip moved."""
    return len(run.path) > len(run.scene["fracture"]["path_m"])


def when_at(run: Run, values: Array, height_m: float, tip: str = "tip_y_m", way: int = 1) -> Measured:
    """What of values along the history belongs to a tip's first being at a height on its way up (1) or down (-1); at least the last one where it never gets
    there."""
    reached = np.flatnonzero(way * (run.history[tip] - height_m) >= -SLACK_M)
    if reached.size:
        return exactly(values[reached[0]])
    return Measured(float(values[-1]), math.inf, f"{run.name} does not reach {height_m:g} m")


def pressure_at_height(run: Run, height_m: float) -> Measured:
    """Inlet pressure at which the tip first is at a height, Pa."""
    return when_at(run, run.history["inlet_Pa"], height_m)


def interface_height(run: Run, number: int) -> float:
    """Height of an interface normal to the fracture, counted from 1 below, m."""
    if run.along != "y" or not 1 <= number <= len(run.interfaces_m):
        raise ValueError(f"{run.name} has no interface {number} across the fracture")
    return run.interfaces_m[number - 1]


def height_of(run: Run, given: Any) -> float:
    """A height given in m, or as {interface, plus_m}: so far above an interface, m."""
    if isinstance(given, dict):
        return interface_height(run, int(given["interface"])) + float(given.get("plus_m", 0.0))
    return float(given)


def resample(path: Array, step_m: float) -> Array:
    """Points every step (m) along a polyline, from its first point."""
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    at = np.arange(0.0, arc[-1] + 1e-9, step_m)
    return np.column_stack([np.interp(at, arc, path[:, 0]), np.interp(at, arc, path[:, 1])])


def path_length(path: Array) -> float:
    """Length of a polyline, m."""
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def distances_to(points: Array, path: Array) -> Array:
    """Distance of each point to a polyline, m."""
    a, d = path[:-1], np.diff(path, axis=0)
    length2 = np.maximum((d**2).sum(axis=1), 1e-300)
    along = np.clip(((points[:, None, :] - a) * d).sum(axis=2) / length2, 0.0, 1.0)
    feet = a + along[:, :, None] * d
    return np.sqrt(((points[:, None, :] - feet) ** 2).sum(axis=2)).min(axis=1)


def start_Pa(run: Run, parameters: Parameters = NONE) -> Measured:
    """Pressure of the first growth."""
    tip = parameters.get("tip")  # of which one, by its name
    start = next((event for event in run.summary.events if event.kind == "start" and tip in (None, event.tip)), None)
    if start is not None:
        return exactly(start.inlet_Pa)
    return Measured(run.summary.inlet_Pa, math.inf, f"{run.name}: its {tip} tip does not start to grow" if tip else f"{run.name} does not start to grow")


def final_height_m(run: Run, parameters: Parameters = NONE) -> Measured:
    """Height of the tip at the end of the run, above an interface (above_interface) where one is named."""
    number = int(parameters.get("above_interface", 0))
    foot = interface_height(run, number) if number else 0.0
    return exactly(float(np.max(run.history["tip_y_m"])) - foot)


def plateau_Pa(run: Run, parameters: Parameters = NONE) -> Measured:
    """Rise of the inlet pressure between arrest and restart, summed from 1.5 increments below an interface to 4 cells above."""
    # Growth would meet the interface from below; one that gives way attracts the tip and arrests it after the crossing, and up to 4 cells away K
    # and J are not independent of it.
    height, cell_m = interface_height(run, int(parameters["interface"])), float(run.scene["numerics"]["cell_m"])
    lowest, highest = height - 1.5 * run.increment_m - SLACK_M, height + 4.0 * cell_m + SLACK_M
    if np.max(run.history["tip_y_m"]) < lowest:
        return nothing(f"{run.name} does not reach the interface at {height:g} m")
    events = [event for event in run.summary.events if event.kind in ("arrest", "restart")]
    arrested = [(event, events[k + 1 :]) for k, event in enumerate(events) if event.kind == "arrest" and lowest <= event.tip_y_m <= highest]
    by_J = any(event.by == "J" and event.at_interface for event, _ in arrested)
    low, high, note = 0.0, 0.0, ""
    for event, later in arrested:
        after = next((one.inlet_Pa for one in later if one.kind == "restart"), None)
        low += (run.summary.inlet_Pa if after is None else after) - event.inlet_Pa
        high += (math.inf if after is None else after) - event.inlet_Pa
        note = f"{run.name} does not grow on from {event.tip_y_m:g} m" if after is None else note
    return Measured(low, high, note, (BY_J,) if by_J else ())


def arrests(run: Run, parameters: Parameters = NONE) -> Measured:
    """Number of arrests with the tip at or above a height (from_m) that the fracture has reached."""
    lowest = height_of(run, parameters["from_m"])
    if np.max(run.history["tip_y_m"]) < lowest - SLACK_M:
        return nothing(f"{run.name} does not reach {lowest:g} m")
    return exactly(sum(event.kind == "arrest" and event.tip_y_m >= lowest - SLACK_M for event in run.summary.events))


def lateral_deflection_m(run: Run, _: Parameters = NONE) -> Measured:
    """Farthest distance of the path from its first straight line, positive towards larger x."""
    if not grew(run):
        return nothing(f"{run.name} does not grow")
    offset = run.path[:, 0] - run.path[0, 0]
    return exactly(float(offset[np.argmax(np.abs(offset))]))


def final_angle_deg(run: Run, parameters: Parameters = NONE) -> Measured:
    """Angle between the last 5 m of the path and the horizontal, 0 to 90 degrees."""
    points = resample(run.path, 0.05)
    count = round(float(parameters.get("over_m", 5.0)) / 0.05)
    if not grew(run) or len(points) <= count:
        return nothing(f"{run.name} does not grow far enough")
    dx, dy = np.abs(points[-1] - points[-1 - count])
    return exactly(math.degrees(math.atan2(dy, dx)))


def length_m(x: Array, chosen: Array) -> float:
    """Length of the chosen ones of places along an interface, m. Each stands for half of the way to its neighbours, those at the ends for as much
    outwards as inwards."""
    if len(x) < 2:
        return 0.0
    order = np.argsort(x)
    ways = np.diff(x[order])
    lengths = 0.5 * (np.append(ways[0], ways) + np.append(ways, ways[-1]))
    return float(np.sum(lengths[chosen[order]]))


def failed_length_m(arrays: dict[str, Array], number: int) -> float:
    """Length of interface `number` (from 1) that has two separate sides at an output time, m."""
    place = str(number - 1)
    return length_m(arrays[f"{place}/x_m"], arrays[f"{place}/split"] > 0)


def interface_failure_excess_Pa(run: Run, parameters: Parameters) -> Measured:
    """Pressure at the first output with two cells of an interface failed, less that which brought the tip near to it."""
    number = int(parameters["interface"])
    near = pressure_at_height(run, interface_height(run, number) - 1.5 * run.increment_m)
    if not near.exact:
        return nothing(near.note)
    two_cells = 2.0 * float(run.scene["numerics"]["cell_m"])
    for time_s, arrays in frames(run, "interfaces"):
        if failed_length_m(arrays, number) >= two_cells - 1e-9:
            return exactly(float(np.interp(time_s, run.history["time_s"], run.history["inlet_Pa"])) - near.low)
    return Measured(run.summary.inlet_Pa - near.low, math.inf, f"{run.name}: interface {number} does not fail")


def between(combine: Callable[[Measured, Measured], Measured], one: Callable[[Run, Parameters], Measured]) -> Callable[..., Measured]:
    """An observable of one run, taken of two."""
    return lambda run, against, parameters: combine(one(run, parameters), one(against, parameters))


def at_height(*names: str) -> Callable[..., Measured]:
    """Columns of the history, in sum, at a height of the first run (height_m) less those of the other run there."""

    def function(run: Run, against: Run, parameters: Parameters) -> Measured:
        height = height_of(run, parameters["height_m"])
        one, other = (when_at(each, sum(each.history[name] for name in names), height) for each in (run, against))
        return difference(one, other)

    return function


def pressure_shift_Pa(run: Run, against: Run, parameters: Parameters) -> Measured:
    """Largest distance in pressure, whatever its sign, between two height curves over a range of heights."""
    if not grew(run) and not grew(against):
        return nothing("neither run grows")
    low, high, neither = 0.0, 0.0, 0
    lowest, highest = height_of(run, parameters["from_m"]), height_of(run, parameters["to_m"])
    for height in np.arange(lowest, highest + SLACK_M, max(run.increment_m, against.increment_m)):
        a, b = pressure_at_height(run, height), pressure_at_height(against, height)
        if not (a.exact or b.exact):
            neither += 1
            continue
        gap = difference(a, b)
        least = max(gap.low, -gap.high, 0.0)
        low, high = max(low, least), max(high, abs(gap.low), abs(gap.high))
    note = f"neither run reaches {neither} of the heights" if neither else ""
    return Measured(low, high, note)


def height_ratio(run: Run, against: Run, parameters: Parameters) -> Measured:
    """Height at the pressure which has brought the other run to a height, divided by that height."""
    height = height_of(run, parameters["height_m"])
    pressure = pressure_at_height(against, height)
    if not pressure.exact:
        return nothing(pressure.note)
    before = run.history["inlet_Pa"] <= pressure.low + 1e-6
    return exactly(float(np.max(run.history["tip_y_m"][before])) / height)


def path_change(run: Run, against: Run, _: Parameters) -> Measured:
    """Root mean square distance of the path from the other's over what that one turns away by, over the length both have."""
    if not (grew(run) and grew(against)):
        return nothing("one of the paths does not grow")
    common = min(path_length(run.path), path_length(against.path))
    steps = int(common / 0.25) + 1
    points, others = (resample(one.path, 0.25)[:steps] for one in (run, against))
    first = (against.path[1] - against.path[0]) / np.linalg.norm(against.path[1] - against.path[0])
    off = (others - against.path[0]) @ np.array([-first[1], first[0]])
    deflection = float(np.sqrt(np.mean(off**2)))
    if deflection < 0.1:
        return nothing(f"the other path is straight to {deflection:.2g} m: there is no deflection to measure against")
    flags = () if common >= 10.0 else (f"common path of {common:.1f} m only",)
    return exactly(float(np.sqrt(np.mean(distances_to(points, against.path) ** 2))) / deflection, *flags)


@dataclass(frozen=True)
class Observable:
    """A named observable: its function of one run, or of two that it compares, its unit and what it is in words."""

    unit: str
    function: Callable[..., Measured]
    words: str = ""
    compares: bool = False

    @property
    def meaning(self) -> str:
        """One sentence on what it is."""
        return self.words or (self.function.__doc__ or "").strip()


_ENERGY = "Energy in interfaces, per metre of thickness, when the tip is at a height, less that of the other run."
_AT_HEIGHT = "Pressure that brings the tip to a height less that of the other run."

OBSERVABLES: dict[str, Observable] = {
    "start_Pa": Observable("Pa", start_Pa),
    "final_height_m": Observable("m", final_height_m),
    "plateau_Pa": Observable("Pa", plateau_Pa),
    "arrests": Observable("", arrests),
    "lateral_deflection_m": Observable("m", lateral_deflection_m),
    "final_angle_deg": Observable("degrees", final_angle_deg),
    "interface_failure_excess_Pa": Observable("Pa", interface_failure_excess_Pa),
    "interface_energy_difference_J": Observable("J/m", at_height("interface_strain_J", "friction_J", "failure_J"), _ENERGY, True),
    "start_shift_Pa": Observable("Pa", between(difference, start_Pa), "Pressure of the first growth less that of the other run.", True),
    "plateau_difference_Pa": Observable("Pa", between(difference, plateau_Pa), "Plateau at an interface less that of the other run.", True),
    "plateau_ratio": Observable("", between(ratio, plateau_Pa), "Plateau at an interface divided by that of the other run.", True),
    "pressure_shift_Pa": Observable("Pa", pressure_shift_Pa, compares=True),
    "pressure_at_height_difference_Pa": Observable("Pa", at_height("inlet_Pa"), _AT_HEIGHT, True),
    "height_ratio": Observable("", height_ratio, compares=True),
    "path_change": Observable("", path_change, compares=True),
}


def measure(name: str, parameters: Parameters, run: Run, against: Run | None) -> Measured:
    """The named observable of a run, or of a run against another; equal notes and flags are given once."""
    observable = OBSERVABLES[name]
    if observable.compares and against is None:
        raise ValueError(f"{name} compares two runs")
    try:
        found = observable.function(*((run, against) if observable.compares else (run,)), parameters)
    except LoadError as error:
        return nothing(str(error))
    return replace(found, flags=tuple(dict.fromkeys(found.flags)))
