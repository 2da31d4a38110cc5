"""Runs a scene with each of its ingredients left out, one after the other on one thread, and takes the CPU time of each."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from verification.ablation.effects import Tried, effects_of, tried
from verification.ablation.ingredients import LEFT_OUT, Ingredient, ingredients_of, named
from verification.ablation.store import Table
from verification.harness import paths
from verification.harness.load import Run
from verification.harness.plan import make
from verification.harness.quantities import followed, turns
from verification.harness.run import Job, Outcome, timed
from verification.harness.scenes import content_of

RUNS = paths.RUNS / "ablation"
LIMIT_S = 900.0  # a run that takes longer says nothing

# How much of a scene is tried: all ingredients, those that it has, or its interfaces alone.
EVERYTHING, OWN, INTERFACES = "everything", "own", "interfaces"

Say = Callable[[str], None]


class NoBase(Exception):
    """The scene's own run has no result; the message says why."""


def made(job: Job) -> tuple[Outcome, Run | None, float]:
    """Run a job anew: how it ended, its data if it has any, and its CPU time, s."""
    (outcome, found), (_, cpu) = timed(lambda: make(job, force=True, limit_s=LIMIT_S))
    return outcome, found, cpu


def table_of(
    scene: Path, variant: str, extent: str = EVERYTHING, settings: Sequence[str] = (), only: Sequence[str] = (), runs: Path = RUNS,
    say: Say = lambda _: None,
) -> Table:  # fmt: skip
    """The table of a scene's variant, of so much of it (EVERYTHING, OWN, INTERFACES), or of the ingredients named by `only`.

    Raises NoBase where the scene's own run fails, ValueError for a name that is no ingredient.
    """
    try:
        content = content_of(scene, variant, settings)
    except ValueError as refused:
        raise NoBase(f"{scene.stem} {variant}: {refused}") from refused
    wanted: dict[str, Callable[[Ingredient], bool]] = {
        EVERYTHING: lambda _: True, OWN: lambda one: one.group != LEFT_OUT, INTERFACES: lambda one: one.id.startswith("interface"),
    }  # fmt: skip
    chosen = [one for one in named(ingredients_of(content), only) if wanted[extent](one)]

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


def _line(ingredient: Ingredient, job: Job, content: dict[str, Any], base: Run) -> Tried:
    """One ingredient left out."""
    if ingredient.why_not:
        return tried(ingredient, "", "", ({}, {}), 0.0)
    outcome, found, cpu = made(job)
    if found is None:
        return tried(ingredient, outcome.word if not outcome.ok else "failed", outcome.reason, ({}, {}), cpu)
    # Where the path may turn only the ways of both are compared, a straight one too.
    effects = effects_of(followed(content, base), turns(content), base, ingredient.view.of(found, base))
    return tried(ingredient, outcome.status, outcome.reason, effects, cpu)


def _said(line: Tried, base_s: float) -> str:
    """A line of the table in words."""
    if not line.applies:
        return f"  {line.label}: {line.reason}"
    largest = "-" if line.largest is None else f"{100.0 * line.largest:.2f} %"
    lost = f", without {', '.join(line.lost)}" if line.lost else ""
    return f"  {line.label}: {line.done}: {largest}{lost}, {line.cpu_s / base_s:.2f} of the time: {line.verdict} {line.reason}".rstrip()
