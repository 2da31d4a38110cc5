"""Rubin's fracture in a block of PMMA: a run read where and when the experiment was, and how far off each quantity is. No parameter is fitted."""

import math
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from verification.harness import store
from verification.harness.load import Array, LoadError, Run, columns_of, frames

HERE = Path(__file__).resolve().parent
SCENE, RECORD = HERE / "rubin.toml", HERE / "records" / "rubin.json"

Course = tuple[Array, Array]  # times (s, the experiment's clock) and values (SI)

START_S = 3.7  # the clock of the experiment at time 0 of a run: its first measurement, and the start of GEOS's run
LATE_S = 15.0  # "late": from here on
DEPTH_M = 0.055  # of the layer that breaks
FLUID_AT_41_MM_S = 19.0  # gauge 57 rises from its reading without fluid after this

# Quantities: the column of the data, the factor to SI, and from when on it is a measurement of the fluid or the fracture.
LENGTH, WELL, OPENING, NEAR, FAR = "length", "pressure at the well", "opening at 28.5 mm", "pressure at 15 mm", "pressure at 41 mm"
COLUMNS = {LENGTH: ("length_mm", 1e-3, 4.0), WELL: ("p_well_MPa", 1e6, 4.0), OPENING: ("aperture_lvdt_um", 1e-6, 4.0),
           NEAR: ("p_58_MPa", 1e6, 4.0), FAR: ("p_57_MPa", 1e6, 20.0)}  # fmt: skip
PRESSURES = (WELL, NEAR, FAR)
PLACES_M = {OPENING: 0.0285, NEAR: 0.015, FAR: 0.041}  # along the fracture, from the well


@dataclass(frozen=True)
class Variant:
    """Something that the plain run may lack: its name, what is done, the variant of the scene, and what is added to the run's pressures (Pa) before they
    are held against the gauges'."""

    name: str
    says: str
    scene: str = ""
    add_Pa: float = 0.0


@dataclass(frozen=True)
class Errors:
    """Mean relative errors, without sign, of a quantity: from 15 s on with the number of values, at all times, and where the run is as long as the
    fracture was (from 15 s on; NaN of the length itself)."""

    late: float
    values: int
    every: float
    same_length: float


@dataclass(frozen=True)
class Result:
    """A variant's run at a cell size (m): errors by quantity, how much earlier the run is as long as the fracture was (s, least and most from 15 s on),
    what marks it, its time, and curves in SI over the experiment's clock."""

    name: str
    says: str
    cell_m: float
    errors: dict[str, Errors]
    early_s: tuple[float, float]
    suspect: tuple[str, ...]
    wall_s: float
    curves: dict[str, tuple[float, ...]]


@dataclass(frozen=True)
class Record:
    """All results with the version of the solver."""

    version: str
    results: tuple[Result, ...]


@cache
def table(name: str = "rubin1983") -> dict[str, Array]:
    """The columns of a file of data as typed."""
    lines = [line.split(",") for line in (HERE / "data" / f"{name}.csv").read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return columns_of(lines[0], lines[1:])


def measured(quantity: str) -> Course:
    """A quantity where it was measured."""
    column, factor, from_s = COLUMNS[quantity]
    known = table()["t_s"] > from_s
    return table()["t_s"][known], factor * table()[column][known]


def reading_without_fluid_Pa() -> float:
    """The mean of what gauge 57 reads before the fluid, or even the fracture, comes to it, Pa."""
    return 1e6 * float(np.mean(table()["p_57_MPa"][table()["t_s"] < FLUID_AT_41_MM_S]))


def variants() -> tuple[Variant, ...]:
    """The plain run first; README.md has the sources."""
    zero = reading_without_fluid_Pa()
    return (
        Variant("plain", "sizes, rock, fluid and rate as typed in GEOS"),
        Variant("gauges_from_zero", f"all gauges read {1e-6 * zero:.3f} MPa too much, as gauge 57 does without fluid", "", zero),
        Variant("closing_stress", f"{1e-6 * zero:.3f} MPa press the faces together", "closing_stress"),
        Variant("no_air", "nothing fills the crack ahead of the fluid: 0.101 MPa below the air outside", "no_air", -101325.0),
        Variant("short_notch", "a first fracture of 4 mm in place of 24 mm", "short_notch"),
        Variant("plane_stress", "no constraint across the 55 mm", "plane_stress"),
        Variant("held_sides", "bonds that hold the free sides", "held_sides"),
        Variant("cold_oil", "oil of 20 in place of 25 degrees C", "cold_oil"),
        Variant("stiff", "E 3.8 GPa, the largest of the handbooks", "stiff"),
        Variant("tough", "K_Ic 1.6 MPa sqrt(m), the largest of the handbooks", "tough"),
    )


def courses(run: Run, add_Pa: float = 0.0) -> dict[str, Course]:
    """Each quantity of a run over the experiment's clock: times (s) and values (SI). Between two steps of growth the length is read along the line
    through what it was at each as the tip gave way: before the step. Raises LoadError for a run that does not grow."""
    time_s, tip_m = run.history["time_s"], run.history["tip_y_m"]
    steps = np.flatnonzero(np.diff(tip_m) > 0.0)
    if steps.size < 2:
        raise LoadError(f"{run.folder}: the fracture did not grow twice")
    found = {LENGTH: (time_s[steps + 1] + START_S, tip_m[steps]), WELL: (time_s + START_S, run.history["inlet_Pa"] + add_Pa)}
    stored = frames(run, "fracture")
    for quantity, place_m in PLACES_M.items():
        name, more = ("opening_m", 0.0) if quantity == OPENING else ("pressure_Pa", add_Pa)
        values = [np.interp(place_m, fields["y_m"], fields[name], right=0.0) + more for _, fields in stored]
        found[quantity] = np.array([time for time, _ in stored]) + START_S, np.array(values)
    return found


def read(course: Course, at: Array) -> Array:
    """A course where it is asked for, NaN beyond its ends; the times of a course rise."""
    return np.interp(at, *course, left=np.nan, right=np.nan)


def late_error(course: Course, quantity: str) -> float:
    """The mean relative error, without sign, of a quantity's course from 15 s on, where the run got so far."""
    at, values = measured(quantity)
    return float(np.nanmean(np.abs(read(course, at) / values - 1.0)[at >= LATE_S]))


def errors_of(found: dict[str, Course]) -> tuple[dict[str, Errors], tuple[float, float]]:
    """The errors of each quantity and how much earlier the run is as long (s, least and most)."""
    times, lengths = measured(LENGTH)
    reached = read((found[LENGTH][1], found[LENGTH][0]), lengths)
    early = (times - reached)[times >= LATE_S]
    errors = {}
    for quantity, course in found.items():
        at, values = measured(quantity)
        off, alike = (read(course, when) / values - 1.0 for when in (at, reached[-at.size :]))
        same = math.nan if quantity == LENGTH else float(np.nanmean(np.abs(alike[at >= LATE_S])))
        errors[quantity] = Errors(late_error(course, quantity), int(np.sum(np.isfinite(off) & (at >= LATE_S))), float(np.nanmean(np.abs(off))), same)
    return errors, (float(np.nanmin(early)), float(np.nanmax(early)))


def judged(name: str, says: str, found: dict[str, Course], cell_m: float, wall_s: float = math.nan, marks: tuple[str, ...] = ()) -> Result:
    """The errors of courses, with what is drawn of them."""
    errors, early = errors_of(found)
    grid = np.arange(8.0, 70.0, 2.0)
    curves = {quantity: tuple(map(float, read(found[quantity], grid))) for quantity in (LENGTH, WELL, OPENING)} | {"t_s": tuple(map(float, grid))}
    return Result(name, says, cell_m, errors, early, marks, wall_s, curves)


def result(variant: Variant, run: Run) -> Result:
    """What a variant's run gives."""
    marks = tuple(mark.monitor for mark in run.summary.suspect)
    return judged(variant.name, variant.says, courses(run, variant.add_Pa), float(run.scene["numerics"]["cell_m"]), run.summary.wall_s, marks)


def geos() -> Result:
    """What GEOS stores of its own run, read in the same way; its length is that of whole elements."""
    stored = table("geos_model_results")
    names = {WELL: "p_well_Pa", OPENING: "aperture_m", NEAR: "p_58_Pa", FAR: "p_57_Pa"}
    at = stored["t_s"] + START_S
    found = {LENGTH: (at, stored["area_m2"] / DEPTH_M)} | {quantity: (at, stored[name]) for quantity, name in names.items()}
    return judged("GEOS", "its own stored run, 80 x 18 bricks on half the block", found, 0.1525 / 80)


def kept() -> Record | None:
    """The record of the repository."""
    return store.read(Record, RECORD)
