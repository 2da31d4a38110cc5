"""Reads a run's folder into plain data: scene, summary, history, and on demand what result.h5 holds."""

import csv
import json
import math
import tomllib
from collections.abc import Iterator
from dataclasses import MISSING, dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from verification.harness.store import built

Array = np.ndarray

# A tip moves with the rock by millimetres at most; farther than this it has grown, m.
GROWTH_M = 0.05


class LoadError(Exception):
    """A run's folder lacks a file, or one cannot be read; the message says which."""


@dataclass(frozen=True)
class Event:
    """Something that happened to a tip: kind, time (s), inlet pressure (Pa) and place (m)."""

    kind: str
    time_s: float
    inlet_Pa: float
    tip_x_m: float
    tip_y_m: float
    at_interface: bool  # decided by J with an interface too near for it to be trusted
    by: str  # what decided: "J", "energy", "failure"; empty of what nothing decides, an end say


@dataclass(frozen=True)
class Tip:
    """A tip at the end of a run: place (m), K (Pa sqrt(m)), J (N/m), ring spread (of J) and next kink (degrees). G_N_m is the energy released per
    length over the next finite increment (N/m), NaN where the run does not measure it."""

    x_m: float
    y_m: float
    K_I_Pa_sqrt_m: float
    K_II_Pa_sqrt_m: float
    J_N_m: float
    J_spread: float
    kink_deg: float
    G_N_m: float = math.nan


# The monitor that says that speeds of growth are no result: no verdict is about speeds.
OF_SPEEDS = "surface_energy_share"


@dataclass(frozen=True)
class Suspicion:
    """Why a run is suspect: the monitor, its value (NaN where it was no finite number), the threshold and a sentence. The threshold is NaN for a
    figure that marks a run only where it is no number."""

    monitor: str
    value: float
    threshold: float
    why: str


@dataclass(frozen=True)
class Summary:
    """What summary.json says, in SI units; `raw` is all of it."""

    scene: str
    variant: str
    status: str
    reason: str
    mechanics: str
    cells: int
    particles: int
    steps: int
    time_s: float
    inlet_Pa: float
    wall_s: float
    particle_steps_per_s: float
    peak_memory_MB: float
    version: str
    mouth_opening_m: float
    fracture_volume_m2: float
    energy: dict[str, float]
    tips: tuple[Tip, ...]
    events: tuple[Event, ...]
    monitors: dict[str, Any]
    raw: dict[str, Any] = field(repr=False)
    suspect: tuple[Suspicion, ...] = ()  # empty for a sound run


@dataclass(frozen=True)
class Run:
    """One run as its folder has it."""

    folder: Path
    scene: dict[str, Any] = field(repr=False)
    summary: Summary = field(repr=False)
    history: dict[str, Array] = field(repr=False)

    @property
    def name(self) -> str:
        """Scene and variant, as the folders say it."""
        return f"{self.folder.parent.name}/{self.folder.name}"

    @property
    def interfaces_m(self) -> list[float]:
        """Places of the interfaces along the stacking axis, m."""
        layers = self.scene["strata"]["layers"]
        return [sum(float(layer["thickness_m"]) for layer in layers[: k + 1]) for k in range(len(layers) - 1)]

    @property
    def along(self) -> str:
        """The stacking axis, 'x' or 'y'."""
        return str(self.scene["strata"].get("along", "y"))

    @property
    def increment_m(self) -> float:
        """Growth increment, m."""
        return float(self.scene["fracture"].get("increment_m", self.scene["numerics"]["cell_m"]))

    @cached_property
    def path(self) -> Array:
        """The fracture from its first vertex to its last tip, shape (n, 2), m."""
        points = [tuple(map(float, point)) for point in self.scene["fracture"]["path_m"]]
        for tip in zip(self.history["tip_x_m"], self.history["tip_y_m"]):
            if math.dist(points[-1], tip) > GROWTH_M:
                points.append((float(tip[0]), float(tip[1])))
        return np.array(points)


def picked(kind: type, content: dict[str, Any]) -> dict[str, Any]:
    """What a dataclass takes of a JSON object; raises KeyError for a key that is not there and has no default."""
    return {item.name: content[item.name] for item in fields(kind) if item.name in content or item.default is MISSING}


def read_summary(path: Path) -> Summary:
    """Read summary.json; null, which stands for not finite, as NaN."""
    try:
        raw = json.loads(path.read_text(encoding="utf-8"))
        words = {name: str(raw.get(name) or "") for name in ("scene", "variant", "status", "reason", "mechanics", "version")}
        lists = {name: [picked(kind, item) for item in raw[name] or ()] for name, kind in (("events", Event), ("tips", Tip))}
        lists["suspect"] = [picked(Suspicion, mark) for mark in raw.get("suspect") or ()]
        content = {**raw, **words, **lists, "monitors": raw.get("monitors") or {}, "raw": raw}
        return built(Summary, picked(Summary, content))
    except KeyError as error:
        raise LoadError(f"{path}: no key {error.args[0]}") from error
    except (OSError, ValueError, TypeError, AttributeError) as error:
        raise LoadError(f"{path}: {error}") from error


def columns_of(header: list[str], rows: list[list[str]]) -> dict[str, Array]:
    """The columns of a table by its header's names, NaN where a cell is no number."""

    def cell(text: str) -> float:
        try:
            return float(text)
        except ValueError:
            return math.nan

    return {name.strip(): np.array([cell(row[k]) for row in rows]) for k, name in enumerate(header)}


def read_history(path: Path) -> dict[str, Array]:
    """Read history.csv: a column a key, NaN where a cell is no number."""
    try:
        with path.open(encoding="utf-8", newline="") as stream:
            rows = [row for row in csv.reader(stream) if row]
    except OSError as error:
        raise LoadError(f"{path}: {error}") from error
    if len(rows) < 2:
        raise LoadError(f"{path}: no rows")
    ragged = next((n for n, row in enumerate(rows[1:], 2) if len(row) != len(rows[0])), None)
    if ragged is not None:
        raise LoadError(f"{path}:{ragged}: not as many cells as the header names")
    return columns_of(rows[0], rows[1:])


def load(folder: Path) -> Run:
    """Read a run's folder; raises LoadError where something is missing."""
    try:
        scene = tomllib.loads((folder / "scene.toml").read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise LoadError(f"{folder / 'scene.toml'}: {error}") from error
    return Run(folder, scene, read_summary(folder / "summary.json"), read_history(folder / "history.csv"))


def frames(run: Run, group: str) -> list[tuple[float, dict[str, Array]]]:
    """Output times (s) of a group of result.h5, such as 'fracture', with the arrays stored at each, by their names."""
    path = run.folder / "result.h5"
    try:
        with h5py.File(path, "r") as store:
            times = store["times"][()]
            return [(float(times[int(name)]), arrays_of(item)) for name, item in sorted(store[group].items()) if name.isdigit()]
    except (OSError, KeyError, IndexError) as error:
        raise LoadError(f"{path}: {error}") from error


def arrays_of(group: h5py.Group) -> dict[str, Array]:
    """All data sets below a group, by their names from it."""
    return {name: item[()] for name, item in items_below(group) if isinstance(item, h5py.Dataset)}


def items_below(group: h5py.Group, path: str = "") -> Iterator[tuple[str, h5py.Group | h5py.Dataset]]:
    """Everything below a group with its name from there; what has several names under each (visititems() takes one of them)."""
    for name, item in group.items():
        yield path + name, item
        if isinstance(item, h5py.Group):
            yield from items_below(item, f"{path}{name}/")
