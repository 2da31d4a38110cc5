"""Reads run folders; what is missing or unreadable is recorded in the run, never raised."""

import csv
import json
import math
import re
import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from reports.words import number
from verification.harness.load import columns_of
from verification.harness.scenes import MECHANICS, STUDY_VARIANTS, mechanics_of, scenes_of, variants_of

Arrays = dict[str, np.ndarray]


class NotAvailable(Exception):
    """What a figure needs is not in the runs; the message says what."""


@dataclass
class Run:
    """One variant of one scene as its folder has it; SI units."""

    experiment: str
    variant: str
    folder: Path
    mechanics: str = MECHANICS[0]
    scene: dict[str, Any] = field(default_factory=dict)
    summary: dict[str, Any] = field(default_factory=dict)
    outcome: dict[str, Any] = field(default_factory=dict)
    history: Arrays = field(default_factory=dict)
    problems: list[str] = field(default_factory=list)

    @property
    def number(self) -> int:
        """The experiment's number, 0 where its name has none."""
        found = re.match(r"exp(\d+)", self.experiment)
        return int(found.group(1)) if found else 0

    @property
    def status(self) -> str:
        """'completed', 'failed', 'unfinished' where a run has not said how it ended, 'missing' where there is none."""
        ended = self.summary.get("status") or self.outcome.get("status")
        return str(ended or ("unfinished" if self.scene or self.history else "missing"))

    @property
    def reason(self) -> str:
        """Why the run is not complete, in its own words where it has any."""
        if self.status == "completed":
            return ""
        return str(self.summary.get("reason") or self.outcome.get("reason") or "; ".join(self.problems))

    @property
    def is_main(self) -> bool:
        """Whether the variant is one of the study's own interface types."""
        return self.variant in STUDY_VARIANTS

    @property
    def drawable(self) -> bool:
        """Whether the run has a scene and a history to draw, complete or not."""
        has_history = {"time_s", "inlet_Pa", "height_m"} <= self.history.keys() and self.history["inlet_Pa"].size > 0
        return has_history and {"domain", "strata", "rock"} <= self.scene.keys()

    @property
    def events(self) -> list[dict[str, Any]]:
        """The run's events in order of time."""
        return sorted(self.summary.get("events") or [], key=lambda event: float(event.get("time_s", 0.0)))

    @property
    def marks(self) -> list[str]:
        """Why the run's own monitors mark it as suspect, each with its value; empty for a sound run and for one that has none."""
        return [_mark_words(mark) for mark in self.summary.get("suspect") or [] if isinstance(mark, dict)]

    @property
    def cell_m(self) -> float:
        """Cell size, m."""
        return float(self.scene.get("numerics", {}).get("cell_m", 1.0))

    @property
    def path_m(self) -> np.ndarray:
        """The fracture from its first vertex to its last tip, shape (n, 2), m."""
        points = [tuple(map(float, point)) for point in self.scene.get("fracture", {}).get("path_m", [])]
        for tip in zip(self.history.get("tip_x_m", ()), self.history.get("tip_y_m", ())):
            if not points or math.dist(points[-1], tip) > 0.05 * self.cell_m:  # a tip moves with the rock by far less
                points.append((float(tip[0]), float(tip[1])))
        return np.array(points)


def _mark_words(mark: dict[str, Any]) -> str:
    """One mark of a summary in words: its sentence and, where it has one, its value against the threshold."""
    why, value, threshold = str(mark.get("why") or mark.get("monitor")), mark.get("value"), mark.get("threshold")
    if not isinstance(value, (int, float)) or not isinstance(threshold, (int, float)):
        return why
    return f"{why} ({number(float(value))} against {number(float(threshold))})"


def load_run(folder: Path) -> Run:
    """Read one run's folder: scene.toml, summary.json, history.csv and how its process ended, as whoever started it kept it."""
    above = folder.parent.parent.name
    run = Run(folder.parent.name, folder.name, folder, above if above in MECHANICS else MECHANICS[0])
    for name, key, read in _READERS:
        if not (folder / name).exists():
            run.problems += [f"no {name}"] if key != "outcome" else []
            continue
        try:
            setattr(run, key, read((folder / name).read_text(encoding="utf-8")))
        except (OSError, ValueError, csv.Error) as error:
            run.problems.append(f"{name} cannot be read: {error}")
    run.mechanics = str(run.summary.get("mechanics") or run.scene.get("numerics", {}).get("mechanics") or run.mechanics)
    return run


def _table(text: str) -> dict[str, Any]:
    """A JSON object."""
    content = json.loads(text)
    if not isinstance(content, dict):
        raise ValueError("not a table")
    return content


def _columns(text: str) -> Arrays:
    """The numeric columns of a history; a row cut short by an interruption is dropped, a cell that is no number NaN."""
    rows = [row for row in csv.reader(text.splitlines()) if row]
    if not rows:
        raise ValueError("empty")
    return columns_of(rows[0], [row for row in rows[1:] if len(row) == len(rows[0])])


_READERS: tuple[tuple[str, str, Callable[[str], Any]], ...] = (
    ("scene.toml", "scene", tomllib.loads), ("summary.json", "summary", _table), ("history.csv", "history", _columns),
    ("outcome.json", "outcome", _table),
)


def load_runs(root: Path) -> list[Run]:
    """Read every run of a numbered experiment below runs/<mechanics>/<scene>/<variant>/, the study's variants first."""
    places = [path for mechanics in MECHANICS for path in sorted((root / mechanics).glob("*/*/"))]
    folders = [path for path in places if path.is_dir() and not path.name.startswith(".")]
    markers = ("scene.toml", "summary.json", "history.csv", "result.h5", "outcome.json")
    runs = [load_run(path) for path in folders if any((path / name).exists() for name in markers)]
    return sorted((run for run in runs if run.number > 0), key=order)


def order(run: Run) -> tuple[int, str, int, str, int]:
    """Sort key: experiment, then the study's variants in their usual order, then the others by name, each by mechanics."""
    rank = STUDY_VARIANTS.index(run.variant) if run.is_main else len(STUDY_VARIANTS)
    last = MECHANICS.index(run.mechanics) if run.mechanics in MECHANICS else len(MECHANICS)
    return (run.number, run.experiment, rank, run.variant, last)


def mechanics_in(runs: Iterable[Run]) -> tuple[str, ...]:
    """The mechanics that some runs were made in, in their order."""
    found = {run.mechanics for run in runs if run.status != "missing"}
    return tuple(mechanics for mechanics in MECHANICS if mechanics in found)


def lead_of(runs: Iterable[Run]) -> str:
    """The mechanics that a figure tells of first: quasi-static where there is any such run to draw."""
    return (mechanics_in(run for run in runs if run.drawable) or MECHANICS)[-1]


def add_missing(runs: list[Run], experiments: Path, root: Path) -> list[Run]:
    """The runs and, as 'missing', every one that the scenes of a folder ask for without a folder, in those mechanics that anything was run in."""
    have = {(run.experiment, run.variant, run.mechanics) for run in runs}
    wanted = mechanics_in(runs) or MECHANICS
    absent = []
    for path in scenes_of(experiments):
        try:
            declared = [(path.stem, name, one) for name in variants_of(path) for one in mechanics_of(path, name) if one in wanted]
        except (OSError, tomllib.TOMLDecodeError):
            continue
        absent += [Run(stem, name, root / one / stem / name, one, problems=["not run"])
                   for stem, name, one in declared if (stem, name, one) not in have]
    return sorted([*runs, *absent], key=order)


def output_times(run: Run) -> np.ndarray:
    """Times at which the run wrote its fields, s."""
    with _open(run) as store:
        if "times" not in store:
            raise NotAvailable(f"{run.experiment}/{run.variant}: result.h5 has no output times")
        return np.asarray(store["times"], dtype=float)


def fields_at(run: Run, parent: str, index: int) -> Arrays:
    """The points of the "fracture" or the "particles" at one output time with what they carry and what does not change; SI units."""
    with _open(run) as store:
        group = store.get(f"{parent}/{index:05d}")
        if group is None:
            raise NotAvailable(f"{run.experiment}/{run.variant}: result.h5 has no {parent}/{index:05d}")
        return {**_arrays(store[parent]), **_arrays(group)}


def interfaces_at(run: Run, index: int, names: tuple[str, ...] = ()) -> list[Arrays]:
    """Every interface's points at one output time, of its datasets `names` (all where none); none where the run has no
    interface; SI units."""
    with _open(run) as store:
        parent = store.get(f"interfaces/{index:05d}")
        if parent is None:
            return []
        groups = [group for _, group in sorted(parent.items()) if isinstance(group, h5py.Group)]
        if names:
            return [{name: np.asarray(group[name]) for name in names if name in group} for group in groups]
        return [_arrays(group) for group in groups]


def _open(run: Run) -> h5py.File:
    """The run's result.h5, opened for reading."""
    try:
        return h5py.File(run.folder / "result.h5", "r")
    except OSError as error:
        raise NotAvailable(f"{run.experiment}/{run.variant}: result.h5 cannot be read ({error})") from error


def _arrays(group: h5py.Group) -> Arrays:
    """The datasets of a group and its numeric attributes."""
    found = {name: np.asarray(item) for name, item in group.items() if isinstance(item, h5py.Dataset)}
    for name, value in group.attrs.items():
        if np.isscalar(value) and not isinstance(value, (str, bytes)):
            found.setdefault(name, np.asarray(value))
    return found
