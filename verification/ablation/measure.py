"""Runs a scene with each of its ingredients left out, one after the other on one thread, and takes effects and CPU time of each.

A pressure counts by its net part, P less the stress that closes the fracture: a background can be added to both at will. A height counts
by the base's own, a path by its length. An ingredient whose run has no value where the base has one changes what happens.
"""

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from verification.ablation.ingredients import Ingredient, ingredients_of, named
from verification.ablation.table import Table, Tried
from verification.harness import paths
from verification.harness import quantities as harness
from verification.harness.load import Run
from verification.harness.observables import path_length
from verification.harness.plan import make
from verification.harness.quantities import NO_ARREST, Effect, Quantity, followed, turns
from verification.harness.run import Job, Outcome, timed
from verification.harness.scenes import content_of

RUNS = paths.RUNS / "ablation"
LIMIT_S = 900.0  # a run that takes longer says nothing
EVERYTHING, INTERFACES = "everything", "interfaces"  # how much of a scene is tried

Say = Callable[[str], None]
Effects = tuple[dict[str, Effect], dict[str, float]]  # in their units, and as shares


class NoBase(Exception):
    """The scene's own run has no result; the message says why."""


def made(job: Job) -> tuple[Outcome, Run | None, float]:
    """Run a job anew: how it ended, its data if it has any, and its CPU time, s."""
    (outcome, found), (_, cpu) = timed(lambda: make(job, force=True, limit_s=LIMIT_S))
    return outcome, found, cpu


def scale_of(quantity: Quantity, base: Run) -> float:
    """What a quantity's effect is a share of, in its unit; raises ValueError where it is nothing."""
    value = quantity.measure(base).low
    closing = float(base.scene.get("in_situ", {}).get("horizontal_Pa", 0.0)) if quantity.unit == "Pa" else 0.0
    if not abs(value - closing) > 0.0:
        raise ValueError(f"{quantity.name} of {base.name} is {value}: nothing to be a share of")
    return abs(value - closing)


def effects_of(quantities: Sequence[Quantity], with_path: bool, base: Run, run: Run) -> Effects:
    """Effects of a run, as it is read, against the base, and the same as shares where they are known; raises ValueError for one that is no number.

    An arrest of the base that is none in the run is lost: what is at the place is no pause.
    """
    found = {name: Effect(None, NO_ARREST) if NO_ARREST in effect.note else effect
             for name, effect in harness.effects_of(quantities, with_path, base, run).items()}  # fmt: skip
    scales = {one.name: (lambda one=one: scale_of(one, base)) for one in quantities} | {"path_m": lambda: path_length(base.path)}
    shares = {name: abs(effect.value) / scales[name]() for name, effect in found.items() if effect.value is not None}
    if not all(map(math.isfinite, shares.values())):
        raise ValueError(f"{run.name}: shares {shares} are not finite")
    return found, shares


def table_of(
    scene: Path, variant: str, extent: str = EVERYTHING, settings: Sequence[str] = (), only: Sequence[str] = (), runs: Path = RUNS,
    say: Say = lambda _: None,
) -> Table:  # fmt: skip
    """The table of a scene's variant (of its interfaces alone, if that is the extent), or of the ingredients named by `only`.

    Raises NoBase where the scene's own run fails, ValueError for a name that is no ingredient.
    """
    try:
        content = content_of(scene, variant, settings)
    except ValueError as refused:
        raise NoBase(f"{scene.stem} {variant}: {refused}") from refused
    chosen = [one for one in named(ingredients_of(content), only) if extent != INTERFACES or one.id.startswith("interface")]

    def job(name: str, further: Sequence[str] = ()) -> Job:
        return Job(scene, variant, runs / scene.stem / (variant or "base") / name, (*settings, *further))

    outcome, base, cpu = made(job("base"))
    say(f"{scene.stem} {variant}: {outcome.status}, {cpu:.2f} s {outcome.reason}".rstrip())
    if base is None or not outcome.ok:
        raise NoBase(f"{scene.stem} {variant}: {outcome.reason}")
    lines = []
    for one in chosen:
        lines.append(_line(one, job(one.id, one.settings), content, base))
        say(_said(lines[-1], cpu))
    quantities = followed(content, base)
    names = [(one.name, one.label, one.unit) for one in quantities] + [("path_m", "path", "m")] * turns(content)
    values = {one.name: one.measure(base).low for one in quantities}
    return Table(scene.stem, variant, "some" if only else extent, base.summary.version, cpu, tuple(names), values, tuple(lines))


def _line(one: Ingredient, job: Job, content: dict[str, Any], base: Run) -> Tried:
    """One ingredient left out."""
    if one.why_not:
        return Tried(one.id, one.label, one.done, one.settings, "", one.why_not, {}, {}, 0.0)
    outcome, found, cpu = made(job)
    if found is None:
        return Tried(one.id, one.label, one.done, one.settings, outcome.word if not outcome.ok else "failed", outcome.reason, {}, {}, cpu)
    # Where the path may turn only the ways of both are compared, a straight one too.
    effects = effects_of(followed(content, base), turns(content), base, one.view.of(found, base))
    return Tried(one.id, one.label, one.done, one.settings, outcome.status, outcome.reason, *effects, cpu)


def _said(line: Tried, base_s: float) -> str:
    """A line of the table in words."""
    if not line.applies:
        return f"  {line.label}: {line.reason}"
    largest = "-" if line.largest is None else f"{100.0 * line.largest:.2f} %"
    lost = f", without {', '.join(line.lost)}" if line.lost else ""
    return f"  {line.label}: {line.done}: {largest}{lost}, {line.cpu_s / base_s:.2f} of the time: {line.verdict} {line.reason}".rstrip()
