"""Reads run folders; what is missing or unreadable is recorded in the run, never raised."""

from __future__ import annotations

import csv
import json
import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np

Arrays = dict[str, np.ndarray]

MAIN_VARIANTS: tuple[str, ...] = ("perfect", "friction", "weak", "soft", "weak_soft", "soft_weak")


class NotAvailable(Exception):
    """What a figure needs is not in the runs; the message says what."""


@dataclass
class Run:
    """One variant of one scene as its folder has it; SI units."""

    experiment: str
    variant: str
    folder: Path
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
        return self.variant in MAIN_VARIANTS

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
    def cell_m(self) -> float:
        """Cell size, m."""
        return float(self.scene.get("numerics", {}).get("cell_m", 1.0))


def load_run(folder: Path) -> Run:
    """Read one run's folder: scene.toml, summary.json and history.csv."""
    run = Run(experiment=folder.parent.name, variant=folder.name, folder=folder)
    readers = (("scene.toml", _read_scene), ("summary.json", _read_summary), ("history.csv", _read_history),
               ("outcome.json", _read_outcome))
    for name, read in readers:
        path = folder / name
        if not path.exists():
            run.problems += [f"no {name}"] if name != "outcome.json" else []
            continue
        try:
            read(path, run)
        except (OSError, ValueError, csv.Error) as error:
            run.problems.append(f"{name} cannot be read: {error}")
    return run


def _read_scene(path: Path, run: Run) -> None:
    """Put the resolved scene into the run."""
    run.scene = tomllib.loads(path.read_text(encoding="utf-8"))


def _read_summary(path: Path, run: Run) -> None:
    """Put the summary into the run."""
    content = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(content, dict):
        raise ValueError("not a table")
    run.summary = content


def _read_outcome(path: Path, run: Run) -> None:
    """Put into the run how its process ended, as whoever started it kept it."""
    content = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(content, dict):
        raise ValueError("not a table")
    run.outcome = content


def _read_history(path: Path, run: Run) -> None:
    """Put the history's numeric columns into the run; a row cut short by an interruption is dropped."""
    with path.open(encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.reader(stream) if row]
    if not rows:
        raise ValueError("empty")
    whole = [row for row in rows[1:] if len(row) == len(rows[0])]
    for column, name in enumerate(rows[0]):
        run.history[name.strip()] = np.array([_float(row[column]) for row in whole])


def _float(text: str) -> float:
    """A cell of the history as a number, NaN where it is none."""
    try:
        return float(text)
    except ValueError:
        return float("nan")


def load_runs(root: Path) -> list[Run]:
    """Read every run of a numbered experiment below runs/<scene>/<variant>/, the study's variants first."""
    folders = [path for path in sorted(root.glob("*/*/")) if path.is_dir() and not path.name.startswith(".")]
    markers = ("scene.toml", "summary.json", "history.csv", "result.h5", "outcome.json")
    runs = [load_run(path) for path in folders if any((path / name).exists() for name in markers)]
    return sorted((run for run in runs if run.number > 0), key=order)


def order(run: Run) -> tuple[int, str, int, str]:
    """Sort key: experiment, then the study's variants in their usual order, then the others by name."""
    rank = MAIN_VARIANTS.index(run.variant) if run.is_main else len(MAIN_VARIANTS)
    return (run.number, run.experiment, rank, run.variant)


def load_claims(root: Path) -> list[dict[str, Any]]:
    """Read the harness's verdicts from runs/claims.json; none where there is no such file."""
    path = root / "claims.json"
    if not path.exists():
        return []
    content = json.loads(path.read_text(encoding="utf-8"))
    claims = content.get("claims", []) if isinstance(content, dict) else content
    return [claim for claim in claims if isinstance(claim, dict)]


def scene_variants(experiments: Path) -> dict[str, list[str]]:
    """The variants that each scene of a folder declares, to show those that were not run."""
    declared: dict[str, list[str]] = {}
    for path in sorted(experiments.glob("exp*.toml")):
        try:
            declared[path.stem] = list(tomllib.loads(path.read_text(encoding="utf-8")).get("variants", {}))
        except (OSError, tomllib.TOMLDecodeError):
            declared[path.stem] = []
    return declared


def add_missing(runs: list[Run], declared: dict[str, list[str]], root: Path) -> list[Run]:
    """The runs and, as 'missing', every declared variant without a folder."""
    have = {(run.experiment, run.variant) for run in runs}
    absent = [
        Run(experiment=stem, variant=name, folder=root / stem / name, problems=["not run"])
        for stem, names in declared.items()
        for name in names
        if (stem, name) not in have
    ]
    return sorted([*runs, *absent], key=order)


def output_times(run: Run) -> np.ndarray:
    """Times at which the run wrote its fields, s."""
    with _open(run) as store:
        if "times" in store:
            return np.asarray(store["times"], dtype=float)
        if "fracture" not in store:
            raise NotAvailable(f"{run.experiment}/{run.variant}: result.h5 has no output times")
        return np.array([float(group.attrs["time_s"]) for _, group in sorted(store["fracture"].items())])


def fracture_at(run: Run, index: int) -> Arrays:
    """The fracture's points and what they carry at one output time; SI units."""
    return _group(run, "fracture", index)


def particles_at(run: Run, index: int) -> Arrays:
    """The particles at one output time with the fields that do not change; SI units."""
    return _group(run, "particles", index)


def interfaces_at(run: Run, index: int) -> list[Arrays]:
    """Every interface's points at one output time; none where the run has no interface; SI units."""
    with _open(run) as store:
        parent = store.get(f"interfaces/{index:05d}")
        if parent is None:
            return []
        return [_arrays(group) for _, group in sorted(parent.items()) if isinstance(group, h5py.Group)]


def _open(run: Run) -> h5py.File:
    """The run's result.h5, opened for reading."""
    try:
        return h5py.File(run.folder / "result.h5", "r")
    except OSError as error:
        raise NotAvailable(f"{run.experiment}/{run.variant}: result.h5 cannot be read ({error})") from error


def _group(run: Run, parent: str, index: int) -> Arrays:
    """One output time's group with its parent's static datasets and its scalar attributes."""
    with _open(run) as store:
        group = store.get(f"{parent}/{index:05d}")
        if group is None:
            raise NotAvailable(f"{run.experiment}/{run.variant}: result.h5 has no {parent}/{index:05d}")
        return {**_arrays(store[parent]), **_arrays(group)}


def _arrays(group: h5py.Group) -> Arrays:
    """The datasets of a group and its numeric attributes."""
    found = {name: np.asarray(item) for name, item in group.items() if isinstance(item, h5py.Dataset)}
    for name, value in group.attrs.items():
        if np.isscalar(value) and not isinstance(value, (str, bytes)):
            found.setdefault(name, np.asarray(value))
    return found
