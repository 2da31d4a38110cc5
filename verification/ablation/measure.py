"""Runs a scene as it is and with each change alone, and takes what each moves.

A pressure counts by its net part, P less the stress that closes the fracture: a background can be added to both at will. A height counts
by the base's own, a path by its length. A change whose run has no value where the base has one changes what happens.
"""

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from verification.ablation.changes import Change
from verification.ablation.table import Table, Tried
from verification.harness import quantities as harness
from verification.harness.load import Run
from verification.harness.observables import path_length
from verification.harness.plan import Made
from verification.harness.quantities import NO_ARREST, Effect, Quantity, followed, turns
from verification.harness.refine import job_of
from verification.harness.run import Job

Effects = tuple[dict[str, Effect], dict[str, float]]  # in their units, and as shares
Maker = Callable[[Sequence[Job]], list[Made]]


class NoBase(Exception):
    """The scene's own run has no result; the message says why."""


def scale_of(quantity: Quantity, base: Run) -> float:
    """What a quantity's effect is a share of, in its unit; raises ValueError where it is nothing."""
    value = quantity.measure(base).low
    closing = float(base.scene.get("in_situ", {}).get("horizontal_Pa", 0.0)) if quantity.unit == "Pa" else 0.0
    if not abs(value - closing) > 0.0:
        raise ValueError(f"{quantity.name} of {base.name} is {value}: nothing to be a share of")
    return abs(value - closing)


def effects_of(quantities: Sequence[Quantity], with_path: bool, base: Run, run: Run, pauses: bool = False, short: str = "") -> Effects:
    """Effects of a run, as it is read, against the base, and the same as shares where they are known; raises ValueError for one that is no number.

    An arrest of the base that is none in the run is lost, since what is at the place is no pause; `pauses`: the pause there counts.
    """
    found = {name: Effect(None, NO_ARREST) if NO_ARREST in effect.note and not pauses else effect
             for name, effect in harness.effects_of(quantities, with_path, base, run, short).items()}  # fmt: skip
    scales = {one.name: (lambda one=one: scale_of(one, base)) for one in quantities} | {"path_m": lambda: path_length(base.path)}
    shares = {name: abs(effect.value) / scales[name]() for name, effect in found.items() if effect.value is not None}
    if not all(map(math.isfinite, shares.values())):
        raise ValueError(f"{run.name}: shares {shares} are not finite")
    return found, shares


def left_out(scene: Path, variant: str, settings: Sequence[str], changes: Sequence[Change], root: Path) -> tuple[Job, list[Job]]:
    """The runs of a scene as it is and of the changes that apply."""

    def job(name: str, further: Sequence[str] = ()) -> Job:
        return Job(scene, variant, root / scene.stem / (variant or "base") / name, (*settings, *further))

    return job("base"), [job(one.id, one.settings) for one in changes if one.settings]


def varied(
    scene: Path, mechanics: str, variant: str, settings: Sequence[str], content: dict[str, Any], changes: Sequence[Change], root: Path
) -> tuple[Job, list[Job]]:
    """The runs of a budget: base and half the cells are the refinement study's, others the base's settings with their own in place."""
    cell = float(content["numerics"]["cell_m"])
    others = [setting for setting in settings if setting.partition("=")[0] != "numerics.cell_m"]
    base, half = (job_of(scene, mechanics, variant, size, others) for size in (cell, cell / 2.0))

    def job(one: Change) -> Job:
        pairs = dict(setting.partition("=")[::2] for setting in (*base.settings, *one.settings))
        return Job(scene, variant, root / scene.stem / mechanics / variant / one.id, tuple(f"{key}={value}" for key, value in pairs.items()))

    return base, [half if one.id == "mesh_half" else job(one) for one in changes if one.settings]


def table_of(content: dict[str, Any], extent: str, changes: Sequence[Change], base: Job, jobs: Sequence[Job], made_by: Maker) -> Table:
    """The table of a scene (its keys with a variant's in place) from the runs of it as it is and of the changes that apply. Raises NoBase where the
    scene's own run fails."""
    [(outcome, own)] = made_by([base])
    if own is None or not outcome.ok:
        raise NoBase(f"{base.scene.stem} {base.variant}: {outcome.word}: {outcome.reason}")
    made = iter(made_by(jobs))
    quantities, with_path = followed(content, own), turns(content)

    def tried(one: Change) -> Tried:
        """A change, with its run where it has one."""
        if not one.settings:
            return Tried(one.id, one.label, one.done, one.settings, "", one.why_not, {}, {}, 0.0, one.group)
        ended, run = next(made)
        short = "up to where the run failed" if one.group and not ended.ok else ""
        # Where the path may turn only the ways of both are compared, a straight one too.
        found = ({}, {}) if run is None else effects_of(quantities, with_path, own, one.view.of(run, own), bool(one.group), short)
        return Tried(one.id, one.label, one.done, one.settings, ended.word, ended.reason, *found, 0.0 if one.group else ended.cpu_s, one.group)

    names = [(one.name, one.label, one.unit) for one in quantities] + [("path_m", "path", "m")] * with_path
    values = {one.name: one.measure(own).low for one in quantities}
    return Table(base.scene.stem, base.variant, extent, own.summary.version, outcome.cpu_s, tuple(names), values, tuple(map(tried, changes)))
