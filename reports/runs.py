"""Reads run folders (what is missing or unreadable is recorded in the run, never raised), and the geometry of an experiment from its resolved scene: layers,
interfaces, fracture, edges, in-situ stress."""

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

from reports.words import Shown, number
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


def layout_of(run: Run) -> Shown:
    """What a run's resolved scene looks like before anything happens; m and Pa, compression positive.

    A layer has its rock's name, its label (and a shorter one on one line), its places on the stacking axis and Young's modulus over the stiffest rock's; an
    interface its place, name and law; heights_m are those of interfaces across the fracture.
    """
    try:
        return _layout(run.scene, run.cell_m)
    except (KeyError, TypeError, IndexError) as error:
        raise NotAvailable(f"{run.experiment}/{run.variant}: scene.toml lacks {error}") from error


def _layout(scene: dict[str, Any], cell_m: float) -> Shown:
    """The layout of a scene's table."""
    domain, strata, in_situ = scene["domain"], scene["strata"], scene.get("in_situ", {})
    along = str(strata.get("along", "y"))
    layers = _layers(scene, float(domain["height_m" if along == "y" else "width_m"]))
    interfaces = [Shown(at_m=below.to_m, name=str(name), law=str(scene.get("interface", {}).get(name, {}).get("law", name)))
                  for below, name in zip(layers[:-1], strata.get("interfaces", []))]
    path = scene.get("fracture", {}).get("path_m", [])
    return Shown(
        width_m=float(domain["width_m"]), height_m=float(domain["height_m"]), along=along, layers=layers, interfaces=interfaces,
        heights_m=tuple(place.at_m for place in interfaces) if along == "y" else (), cell_m=cell_m,
        fracture_x_m=[float(point[0]) for point in path], fracture_y_m=[float(point[1]) for point in path],
        vertical_Pa=float(in_situ.get("vertical_Pa", 0.0)), horizontal_Pa=float(in_situ.get("horizontal_Pa", 0.0)),
    )


def _layers(scene: dict[str, Any], span_m: float) -> list[Shown]:
    """The layers with their places; the last one fills what is left of the span."""
    rocks = scene["rock"]
    stiffest = max(float(rock["youngs_modulus_Pa"]) for rock in rocks.values())
    layers: list[Shown] = []
    at = 0.0
    for entry in scene["strata"]["layers"]:
        rock = rocks[entry["rock"]]
        to = min(span_m, at + float(entry.get("thickness_m", span_m - at)))
        modulus, toughness = float(rock["youngs_modulus_Pa"]), float(rock.get("toughness_Pa_sqrt_m", 0.0))
        label = f"{entry['rock']}\nE {number(modulus / 1e9, 2)} GPa\n$K_{{Ic}}$ {number(toughness / 1e6)} MPa√m"
        line = f"{entry['rock']} {number(modulus / 1e9, 2)} GPa"
        layers.append(Shown(rock=str(entry["rock"]), from_m=at, to_m=to, label=label, line=line, stiffness=modulus / stiffest))
        at = to
    return layers


INTERFACE = "interface "  # begins the keys of what acts at a place, such as "interface 1 coefficient"


def settings_between(run: Run, base: Run) -> list[tuple[str, Any, Any]]:
    """The settings in which a run differs from another, interfaces by what acts there: key, value there, value here."""
    here, there = settings_of(run.scene), settings_of(base.scene)
    return [(key, there.get(key), here.get(key)) for key in sorted(here.keys() | there.keys()) if here.get(key) != there.get(key)]


def settings_of(scene: dict[str, Any]) -> dict[str, Any]:
    """What decides on a run, as dotted keys; for each interface the law that acts there, whatever its name."""
    flat = {key: value for key, value in flat_keys(scene).items() if key.split(".")[0] != "interface"}
    names = flat.pop("strata.interfaces", None) or []
    for place, name in enumerate(names, 1):
        for key, value in scene.get("interface", {}).get(name, {"law": name}).items():
            flat[f"{INTERFACE}{place} {key}"] = value
    return flat


def flat_keys(table: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """A nested table as dotted keys, without what does not decide on a run."""
    ignored = ("title", "variant", "variants", "claim", "output", "resolved_from") if not prefix else ()
    flat: dict[str, Any] = {}
    for key, value in table.items():
        if key in ignored:
            continue
        if isinstance(value, dict):
            flat.update(flat_keys(value, f"{prefix}{key}."))
        else:
            flat[prefix + key] = value
    return flat
