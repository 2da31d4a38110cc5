"""Reads what a run of strata has left in its folder.

    import strata
    run = strata.load("runs/mine")
    run.history["inlet_Pa"], run.units["inlet_Pa"]         # a column, its unit
    state = run.at(time_s=1.2)                             # the fields at the output time nearest to it
    state.particles["stress_Pa"][:, 1], state.fracture["opening_m"]

All in SI. Names end in their unit; arrays are those of numpy; n stands for the number of points.
"""

import csv
import json
import math
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import MISSING, dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

import h5py
import numpy as np

Array = np.ndarray
T = TypeVar("T")

# A tip moves with the rock by millimetres at most; farther than this it has grown, m.
GROWTH_M = 0.05

# Fields that result.h5 holds a component each, (n, components).
COMPONENTS = {
    "position_m": ("x_m", "y_m"), "displacement_m": ("u_x_m", "u_y_m"), "velocity_m_s": ("v_x_m_s", "v_y_m_s"), "stress_Pa": ("s_xx_Pa", "s_yy_Pa", "s_xy_Pa"),
}  # fmt: skip


class LoadError(Exception):
    """A run's folder, a file or a field is not there or cannot be read; the message says which and why."""


@dataclass(frozen=True)
class Event:
    """Something that happened to a tip: kind, time (s), inlet pressure (Pa) and place (m)."""

    kind: str
    time_s: float
    inlet_Pa: float
    tip_x_m: float
    tip_y_m: float
    at_interface: bool  # decided by J with an interface too near for it to be trusted
    by: str  # what decided: "J", "K", "energy"; empty of what nothing decides, an end say
    tip: str = ""  # which of two tips: "upper" or "lower", where they are level "left" or "right"


@dataclass(frozen=True)
class Tip:
    """A tip at the end of a run: place (m), K (Pa sqrt(m)), J (N/m), ring spread (of J) and next kink (degrees), NaN where there is no such number.
    G_N_m is the energy released per length over the next finite increment (N/m), NaN where the run does not measure it."""

    x_m: float
    y_m: float
    K_I_Pa_sqrt_m: float
    K_II_Pa_sqrt_m: float
    J_N_m: float
    J_spread: float
    kink_deg: float
    G_N_m: float = math.nan
    tip: str = ""  # which of two: "upper" or "lower", where they are level "left" or "right"


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


@dataclass(frozen=True, eq=False)
class State:
    """The fields at an output time (s), each by the name it has in result.h5 (Run.descriptions says what it is) and, of those with components, as
    one array as well: "position_m", "displacement_m", "velocity_m_s" (n, 2), "stress_Pa" (n, 3: xx, yy, xy of the total stress, tension positive)."""

    time_s: float
    particles: dict[str, Array]  # in the order of their ids
    fracture: dict[str, Array]  # at the vertices along its path; empty where the scene has none
    interfaces: dict[int, dict[str, Array]]  # by their number in the scene, from 0: those that may act


@dataclass(frozen=True)
class Run:
    """One run as its folder has it: the scene with every key, the summary, and the columns of the history, (rows) each."""

    folder: Path
    scene: dict[str, Any] = field(repr=False)
    summary: Summary = field(repr=False)
    history: dict[str, Array] = field(repr=False)

    @property
    def name(self) -> str:
        """Scene and variant, as the folders say it."""
        return f"{self.folder.parent.name}/{self.folder.name}"

    @property
    def tips(self) -> tuple[Tip, ...]:
        """The tips at the end of the run."""
        return self.summary.tips

    @property
    def events(self) -> tuple[Event, ...]:
        """What happened to the tips, in order of time."""
        return self.summary.events

    @property
    def suspect(self) -> tuple[Suspicion, ...]:
        """Why the run is not to be trusted; empty for a sound run."""
        return self.summary.suspect

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
        """The fracture from its other end at the start to the last place of its leading tip, shape (n, 2), m. What a lower tip has grown is not in it:
        at(time_s).fracture["position_m"] is the whole."""
        points = [tuple(map(float, point)) for point in self.scene["fracture"]["path_m"]]
        first = (self.history["tip_x_m"][0], self.history["tip_y_m"][0])
        if math.dist(points[0], first) < math.dist(points[-1], first):
            points.reverse()
        for tip in zip(self.history["tip_x_m"], self.history["tip_y_m"]):
            if math.dist(points[-1], tip) > GROWTH_M:
                points.append((float(tip[0]), float(tip[1])))
        return np.array(points)

    @cached_property
    def units(self) -> dict[str, str]:
        """The unit of every column of the history ("inlet_Pa") and of every field ("fracture/opening_m"), as result.h5 has it."""
        return self._said("unit")

    @cached_property
    def descriptions(self) -> dict[str, str]:
        """What every column of the history and every field is, in words, by the names of `units`."""
        return self._said("description")

    def _said(self, attribute: str) -> dict[str, str]:
        found = {}
        with opened(self) as store:
            for path, item in items_below(store):
                if attribute in item.attrs:
                    kind, name = path.split("/")[0], path.split("/")[-1]  # without the output time and the interface's number
                    found.setdefault(name if kind in ("history", name) else f"{kind}/{name}", str(item.attrs[attribute]))
        return found

    @cached_property
    def times_s(self) -> Array:
        """The output times, s, (outputs)."""
        with opened(self) as store:
            return np.asarray(store["times"])

    def at(self, time_s: float) -> State:
        """The fields at the output time nearest to a time (s), which State.time_s tells. Raises LoadError for a time before the first or after the last
        output, and for fields that are not there."""
        times = self.times_s
        if not len(times) or not times[0] <= time_s <= times[-1]:
            known = f"output times are {times[0]:.6g} to {times[-1]:.6g} s" if len(times) else "it has no output"
            raise LoadError(f"{self.folder}: {time_s:.6g} s is outside the run: {known}")
        k = int(np.argmin(np.abs(times - time_s)))
        with opened(self) as store:
            at = {kind: store.get(f"{kind}/{k:05d}", {}) for kind in ("fracture", "interfaces")}
            interfaces = {int(name): joined(item) for name, item in at["interfaces"].items()}
            return State(float(times[k]), joined(store[f"particles/{k:05d}"]), joined(at["fracture"]), interfaces)


def picked(kind: type[T], content: dict[str, Any]) -> T:
    """A dataclass of what it takes of a JSON object, null as NaN where it asks for a number; raises KeyError for a key that is not there and has no
    default."""
    known = {item.name: content[item.name] for item in fields(kind) if item.name in content or item.default is MISSING}  # type: ignore[arg-type]
    return kind(**{name: number(value) if kind.__annotations__[name] is float else value for name, value in known.items()})


def number(value: Any) -> float:
    """A number of a JSON object; null, which stands for not finite, is NaN."""
    return math.nan if value is None else float(value)


def read_summary(path: Path) -> Summary:
    """Read summary.json; null, which stands for not finite, as NaN."""
    try:
        raw = json.loads(path.read_text(encoding="utf-8"))
        words = {name: str(raw.get(name) or "") for name in ("scene", "variant", "status", "reason", "mechanics", "version")}
        lists = {name: tuple(picked(kind, item) for item in raw[name] or ()) for name, kind in (("events", Event), ("tips", Tip))}
        lists["suspect"] = tuple(picked(Suspicion, mark) for mark in raw.get("suspect") or ())
        energy = {name: number(value) for name, value in raw["energy"].items()}
        return picked(Summary, {**raw, **words, **lists, "energy": energy, "monitors": raw.get("monitors") or {}, "raw": raw})
    except FileNotFoundError as error:
        raise LoadError(f"{path.parent}: the run has not ended: there is no {path.name}. `strata resume {path.parent}` goes on with it") from error
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


def load(folder: Path | str) -> Run:
    """Read a run's folder; raises LoadError for one that is not there, that holds no run or one that has not ended, and for files that cannot be
    read."""
    folder = Path(folder)
    if not folder.is_dir():
        raise LoadError(f"{folder}: no such folder")
    try:
        scene = tomllib.loads((folder / "scene.toml").read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise LoadError(f"{folder}: holds no run: there is no scene.toml") from error
    except (OSError, ValueError) as error:
        raise LoadError(f"{folder / 'scene.toml'}: {error}") from error
    return Run(folder, scene, read_summary(folder / "summary.json"), read_history(folder / "history.csv"))


@contextmanager
def opened(run: Run) -> Iterator[h5py.File]:
    """The run's result.h5 to be read; raises LoadError for a file or something in it that is not there, with the version of strata that wrote it."""
    path = run.folder / "result.h5"
    try:
        with h5py.File(path, "r") as store:
            yield store
    except KeyError as error:
        raise LoadError(f"{path}: {error.args[0]}; strata {run.summary.version or 'of no known version'} wrote it") from error
    except (OSError, IndexError) as error:
        raise LoadError(f"{path}: {error}") from error


def joined(group: h5py.Group | dict[str, Any]) -> dict[str, Array]:
    """The data sets of a group, and those that are components of one thing as one array as well."""
    found = {name: item[()] for name, item in group.items() if isinstance(item, h5py.Dataset)}
    return found | {name: np.stack([found[part] for part in parts], axis=-1) for name, parts in COMPONENTS.items() if parts[0] in found}


def items_below(group: h5py.Group, path: str = "") -> Iterator[tuple[str, h5py.Group | h5py.Dataset]]:
    """Everything below a group with its name from there; what has several names under each (visititems() takes one of them)."""
    for name, item in group.items():
        yield path + name, item
        if isinstance(item, h5py.Group):
            yield from items_below(item, f"{path}{name}/")
