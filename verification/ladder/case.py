"""What a rung of the accuracy ladder is: a scene at several sizes, and what of its runs is held against which reference.

A case only describes. `verification/ladder/cases/FAMILY.py` lists the cases of a family as CASES, `verification/ladder/gates/FAMILY.json`
holds what each may be off by.
"""

from __future__ import annotations

import importlib
import math
import tempfile
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from verification.harness.command import choose, folder_name, listed, refuse, twice
from verification.harness.load import Array, LoadError, Run, given, last, values
from verification.ladder import cases as package

@dataclass(frozen=True)
class Sample:
    """Values of a run beside the exact ones, same shape and unit; a single number is an array of one. weights (of the norm, such as volumes) default
    to 1. scale (same unit, > 0) replaces the size of the exact values where these are zero. reference_error is the reference's own relative error."""

    values: Array
    exact: Array
    weights: Array | None = None
    scale: float | None = None
    reference_error: float = 0.0

    @staticmethod
    def of(value: float, exact: float, scale: float | None = None, reference_error: float = 0.0) -> Sample:
        """The sample of a single number."""
        return Sample(np.array([value]), np.array([exact]), None, scale, reference_error)

    def error(self) -> float:
        """Relative error: signed for a single number, else sqrt(sum w (value - exact)^2 / sum w exact^2)."""
        off = self.values - self.exact
        size = self.norm(self.exact) if self.scale is None else self.scale
        if not size > 0.0:
            raise ValueError("the exact values are zero: a sample of them needs a scale")
        return float(off[0]) / size if off.size == 1 else self.norm(off) / size

    def norm(self, values: Array) -> float:
        """Weighted root mean square; for one value its size."""
        weights = np.ones(values.shape) if self.weights is None else self.weights
        return math.sqrt(float(np.sum(weights * values**2)) / float(np.sum(weights)))

    def mutants(self) -> dict[str, float]:
        """Errors that this sample would have had if the solver had been wrong in a plain way; a gate must refuse each."""
        if self.scale is not None and not np.any(self.exact):
            return {"off by its scale": Sample(self.values + self.scale, self.exact, self.weights, self.scale).error()}
        wrong = {"zero": 0.0 * self.values, "twice": 2.0 * self.values, "flipped sign": -self.values}
        return {name: Sample(values, self.exact, self.weights, self.scale).error() for name, values in wrong.items()}


@dataclass(frozen=True)
class Quantity:
    """Something measured on every run of a case: name, unit, and how to get its sample (raises LoadError if it cannot)."""

    name: str
    unit: str
    sample: Callable[[Run], Sample]
    # Why no order is to be expected at any level (an error that is the model's); empty where one is. One that begins with
    # "round-off" lets the gate be that of round-off (verification/ladder/gates.py), whatever was measured.
    no_order: str = ""
    # The same for single levels, by their labels: {"1 m": "the error changes its sign"} is of the order from the level before.
    no_order_at: Mapping[str, str] = field(default_factory=dict)

    @staticmethod
    def of(name: str, unit: str, value: Callable[[Run], float], exact: Callable[[Run], float], why: str = "", **further: Any) -> Quantity:
        """A single number of a run beside its exact one; `further`: of the quantity, or scale and reference_error of the sample."""
        own = {key: further.pop(key) for key in ("scale", "reference_error") if key in further}
        return Quantity(name, unit, lambda run: Sample.of(float(value(run)), exact(run), **own), why, **further)

    def reason(self, level: str) -> str:
        """Why no order is to be expected from the level before to this one; empty where one is."""
        return self.no_order or self.no_order_at.get(level, "")


@dataclass(frozen=True)
class Level:
    """One resolution: its label ("0.5 m"), the size that the order refers to (m, or s), and the scene keys that make it."""

    label: str
    size: float
    settings: tuple[str, ...] = ()
    variant: str = ""


@dataclass(frozen=True)
class Case:
    """A scene run at levels from coarse to fine, with the quantities to judge; the first `smoke` levels run in ci/test."""

    name: str  # unique, as in a file name
    says: str  # what it shows, a sentence
    scene: Path
    mechanics: str  # "explicit" or "quasistatic", as the runs have it
    levels: tuple[Level, ...]
    quantities: tuple[Quantity, ...]
    smoke: int = 2


def case_of(scene: Path, mechanics: str = "quasistatic", usual: tuple[Quantity, ...] = (), smoke_levels: int = 2) -> Callable[..., Case]:
    """What makes a case of a scene: by name, words and levels, and by quantities, smoke levels and mechanics where they are not as usual."""
    return lambda name, says, levels, quantities=usual, smoke=smoke_levels, mechanics=mechanics: Case(
        name, says, scene, mechanics, levels, quantities, smoke)  # fmt: skip


Keys = Callable[[float], tuple[str, ...]]  # the further scene keys of a size of cells (m)


def cell_levels(*cells_m: float, settings: tuple[str, ...] = (), variant: str = "", of: Iterable[Keys] = ()) -> tuple[Level, ...]:
    """Levels of cell sizes (m), coarse to fine, all with the same further settings, and with those that each size asks for."""
    return tuple(Level(f"{h:g} m", h, (f"numerics.cell_m={h!r}", *settings, *(key for keys in of for key in keys(h))), variant) for h in cells_m)


Families = dict[str, tuple[Case, ...]]


def families() -> Families:
    """All families by name; raises ValueError for one that is not as it should be."""
    found = {name: tuple(cases) for name, cases in listed(package, "CASES").items()}
    for family, members in found.items():
        check(family, members)
    return found


def about(family: str) -> str:
    """What a family's module says of itself in its first sentences; nothing for one that is not there."""
    try:
        module = importlib.import_module(f"{package.__name__}.{family}")
    except ModuleNotFoundError:
        return ""
    return " ".join((module.__doc__ or "").strip().split("\n\n")[0].split())


def check(family: str, members: Iterable[Case]) -> None:
    """Names are unique, sizes fall from level to level, something is measured; raises ValueError otherwise."""
    members = tuple(members)
    double = {f"{family}: cases": twice(case.name for case in members)}
    wrong = {}
    for case in members:
        where, labels, sizes = f"{family}/{case.name}", [level.label for level in case.levels], [level.size for level in case.levels]
        double[f"{where}: levels"] = twice(map(folder_name, labels))
        double[f"{where}: quantities"] = twice(quantity.name for quantity in case.quantities)
        strangers = {label for quantity in case.quantities for label in quantity.no_order_at} - set(labels)
        wrong |= {
            f"{where}: no_order_at names no level: {', '.join(sorted(strangers))}": strangers,
            f"{where} has no levels or no quantities": not case.levels or not case.quantities,
            f"{where}: no scene {case.scene}": not case.scene.is_file(),
            f"{where}: sizes {sizes} do not fall from level to level": not all(a > b > 0.0 for a, b in zip(sizes, [*sizes[1:], 0.5 * sum(sizes[-1:])])),
            f"{where}: {case.smoke} smoke levels of {len(case.levels)}": not 1 <= case.smoke <= len(case.levels),
        }
    wrong |= {f"{what} of the same name: {', '.join(names)}": names for what, names in double.items()}
    refuse(wrong)


def chosen(known: Families, wanted: Iterable[str] = (), names: Iterable[str] = ()) -> Families:
    """The cases whose families and names begin as is asked (all where nothing is); raises ValueError for a beginning that none has."""
    own = choose(known, wanted)
    kept = choose({case.name: case for members in own.values() for case in members}, names, "case")
    found = {family: tuple(case for case in members if case.name in kept) for family, members in own.items()}
    return {family: members for family, members in found.items() if members}


# --- fields of the particles at a run's end beside a reference solution at the same material points
# Names in the fields of a run, units, and names in strata-reference.
DISPLACEMENT = ("u_x_m", "u_y_m")
VELOCITY = ("v_x_m_s", "v_y_m_s")
STRESS = ("s_xx_Pa", "s_yy_Pa", "s_xy_Pa")


@dataclass(frozen=True)
class End:
    """Particles at the last output: time and time step (s), places where they started (m), fields by name, volumes (m^2)."""

    time_s: float
    step_s: float
    X: Array
    Y: Array
    fields: dict[str, Array]


def lattice(places: Array, spacing: float) -> Array:
    """Places (m) moved to the lattice where particles of a uniform grid start, which single precision has left by a little."""
    on = (np.round(places / spacing - 0.5) + 0.5) * spacing
    if np.abs(on - places).max() > 0.02 * spacing:
        raise LoadError("particles do not start on the lattice of a uniform grid")
    return on


def end_of(run: Run) -> End:
    """The particles at the run's last output."""
    time_s, particles = last(run, "particles")
    fields = {name: array.astype(float) for name, array in particles.items()}
    spacing = given(run, "numerics.cell_m") / math.sqrt(given(run, "numerics.particles_per_cell"))
    places = [lattice(fields[f"{axis}_m"] - fields[f"u_{axis}_m"], spacing) for axis in "xy"]
    return End(time_s, time_s / run.summary.steps if run.summary.steps else 0.0, places[0], places[1], fields)


def at_points(name: str, quantities: tuple[str, ...], places: dict[str, Array], settings: dict[str, float | str]) -> list[Array]:
    """Quantities of strata-reference at lists of places by their keys ("y_m"), which go through files: they may be long."""
    with tempfile.TemporaryDirectory() as folder:
        files = {}
        for key, numbers in places.items():
            path = Path(folder) / key
            np.savetxt(path, numbers, fmt="%.17g")
            files[key] = f"@{path}"
        return [values(name, quantity, **settings, **files) for quantity in quantities]


Exact = Callable[[Run, End, tuple[str, ...], float], list[Array]]  # of fields by their names at a time, s


def field_quantity(name: str, unit: str, fields: tuple[str, ...], exact: Exact, **further: object) -> Quantity:
    """All components of a field beside the exact ones, in the norm by volume. Velocities of explicit runs are half a step behind the output's time,
    so the exact ones are taken there."""

    def sample(run: Run) -> Sample:
        end = end_of(run)
        behind = 0.5 * end.step_s if fields[0].startswith("v_") else 0.0
        found = np.concatenate([end.fields[field] for field in fields])
        wanted = np.concatenate(exact(run, end, fields, end.time_s - behind))
        return Sample(found, wanted, np.tile(end.fields["volume_m2"], len(fields)))

    return Quantity(name, unit, sample, **further)  # type: ignore[arg-type]
