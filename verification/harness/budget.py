"""The error budget of an experiment: each factor varied alone from what the scene says, and what that moves.

usage: ci/budget [exp1 ...] [--variants perfect,soft] [--factors mesh,ring] [--mechanics quasistatic|explicit]
                 [--set KEY=VALUE]... [--jobs 2] [--limit MINUTES] [--yes] [--out DIR]

Without names: all experiments. What has been run for the same scene and solver is not run again; the base and the run with half
the cells are those of ci/refine. Writes DIR/EXPERIMENT.json (DIR: runs/budget) and prints it; reports/budget.py draws it.
"""
from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from verification.harness.factors import Alternative, Factor, factors_of
from verification.harness.load import Run
from verification.harness.paths import EXPERIMENTS, RUNS, solver
from verification.harness.quantities import HEIGHTS_M, Quantity, path_gap, quantities_of, turns
from verification.harness.refine import (
    LIMIT_MIN, REFINE_RUNS, REFUSED, affordable, chosen, content_of, job_of, make_all, scene_of, value_words,
)  # fmt: skip
from verification.harness.run import Job, Outcome
from verification.harness.scenes import MECHANICS, mechanics_of, scenes_of

BUDGET_RUNS = RUNS / "budget"

# What is run without --variants: the perfect case and interfaces that act. Experiment 3 with perfect interfaces is Experiment 1's.
VARIANTS: dict[str, tuple[str, ...]] = {
    "exp1_single_interface": ("perfect", "weak", "soft"),
    "exp2_soft_above": ("perfect", "soft"),
    "exp3_two_interfaces": ("weak_soft", "soft_weak"),
    "exp4_soft_between": ("perfect", "soft"),
    "exp5_parallel_interface": ("perfect", "soft"),
    "exp6_stress_reversal": ("perfect", "soft"),
}

# The height at which the pressure is compared where the base gets there, m; else the highest below that it reaches.
HEIGHT_M = 40.0

# Groups of factors that are summed: what the numbers owe to the method, and all that was varied.
NUMERICAL, ALL = "numerical", "all"


@dataclass(frozen=True)
class Effect:
    """What an alternative moves a quantity by (None where it says nothing, with the reason), in the quantity's unit."""

    value: float | None
    note: str = ""


@dataclass(frozen=True)
class Tried:
    """An alternative that was run: how it ended and its effects by the names of quantities."""

    label: str
    settings: tuple[str, ...]
    status: str
    reason: str
    effects: dict[str, Effect]


@dataclass(frozen=True)
class Line:
    """A factor of the budget: its alternatives, or why it does not apply."""

    id: str
    label: str
    group: str
    tried: tuple[Tried, ...]
    why_not: str = ""

    def size(self, quantity: str) -> float | None:
        """The largest effect of its alternatives on a quantity, whatever its sign; None where none has one."""
        known = [abs(one.effects[quantity].value or 0.0) for one in self.tried
                 if quantity in one.effects and one.effects[quantity].value is not None]  # fmt: skip
        return max(known, default=None)

    def failed(self, quantity: str) -> list[str]:
        """The alternatives that say nothing of a quantity."""
        return [one.label for one in self.tried if quantity not in one.effects or one.effects[quantity].value is None]


@dataclass(frozen=True)
class Total:
    """All factors of a group together: root of the sum of squares (they are independent) and plain sum (all push one way)."""

    rss: float
    sum: float
    left_out: tuple[str, ...]


@dataclass(frozen=True)
class Budget:
    """The budget of a variant in one mechanics."""

    mechanics: str
    variant: str
    status: str
    reason: str
    base: dict[str, float | None]
    quantities: tuple[tuple[str, str, str], ...]  # name, label, unit
    lines: tuple[Line, ...]
    totals: dict[str, dict[str, Total]]  # quantity, group


# --- jobs


def setting_pairs(settings: Sequence[str]) -> dict[str, str]:
    """Settings KEY=VALUE as pairs; the last of a key counts."""
    return dict(setting.partition("=")[::2] for setting in settings)


def job_with(base: Job, factor: Factor, alternative: Alternative, root: Path) -> Job:
    """The run of an alternative: the base's settings with its own in their place."""
    pairs = setting_pairs(base.settings) | setting_pairs(alternative.settings)
    folder = root / base.scene.stem / base.settings[0].partition("=")[2] / base.variant / f"{factor.id}_{alternative.id}"
    return Job(base.scene, base.variant, folder, tuple(f"{key}={value}" for key, value in pairs.items()))


def base_cell(scene: Path, variant: str, settings: Sequence[str]) -> float:
    """The cell size that a variant says, m."""
    return float(content_of(scene, variant, settings)["numerics"]["cell_m"])


def jobs_of(
    scene: Path, mechanics: str, variant: str, factors: Sequence[Factor], settings: Sequence[str], root: Path, refined: Path
) -> dict[tuple[str, str], Job]:
    """The runs of a budget by factor and alternative; the base is ("", "")."""
    cell = base_cell(scene, variant, settings)
    base = job_of(scene, mechanics, variant, cell, _without(settings, "numerics.cell_m"), refined)
    jobs = {("", ""): base}
    for factor in factors:
        for alternative in factor.alternatives:
            if factor.id == "mesh":
                job = job_of(scene, mechanics, variant, cell / 2.0, _without(settings, "numerics.cell_m"), refined)
            else:
                job = job_with(base, factor, alternative, root)
            jobs[factor.id, alternative.id] = job
    return jobs


def _without(settings: Sequence[str], key: str) -> tuple[str, ...]:
    """Settings but for those of one key."""
    return tuple(setting for setting in settings if setting.partition("=")[0] != key)


# --- what the runs say

Made = tuple[Outcome, Run | None]


def followed(content: dict[str, Any], base: Run) -> list[Quantity]:
    """What a budget is made of: start, arrests that the base has, and the pressure at a height that it reaches."""
    top = float(base.history["tip_y_m"].max())
    reached = [height for height in HEIGHTS_M if height <= min(top, HEIGHT_M)]
    found = []
    for quantity in quantities_of(content, reached[-1:]):
        if quantity.name in ("final_height_m", "final_Pa", "final_angle_deg", "deflection_m") or quantity.name.startswith("plateau"):
            continue
        measured = quantity.measure(base)
        if "no arrest" in measured.flags or not measured.exact:
            continue
        found.append(quantity)
    return found


def effects_of(quantities: Sequence[Quantity], with_path: bool, base: Run, made: Made) -> dict[str, Effect]:
    """What a run moves each quantity by against the base."""
    outcome, found = made
    if found is None or outcome.exit_status == REFUSED:
        return {}
    effects: dict[str, Effect] = {}
    for quantity in quantities:
        measured = quantity.measure(found)
        if measured.exact:
            effects[quantity.name] = Effect(measured.low - quantity.measure(base).low, ", ".join(measured.flags))
        else:
            bound = f", at least {value_words(measured.low, quantity.unit)}" if math.isfinite(measured.low) else ""
            effects[quantity.name] = Effect(None, f"{measured.note.removeprefix(found.name).strip()}{bound}")
    if with_path:
        gap = path_gap(found, base)
        short = "" if outcome.ok else "up to where the run failed"
        effects["path_m"] = Effect(None, "does not grow") if gap is None else Effect(gap[1], short)
    return effects


def tried(alternative: Alternative, job: Job, made: Made, effects: dict[str, Effect]) -> Tried:
    """An alternative with what came of it."""
    outcome = made[0]
    status = "refused" if outcome.exit_status == REFUSED else outcome.status
    return Tried(alternative.label, job.settings, status, outcome.reason, effects)


def total_of(lines: Sequence[Line], quantity: str) -> Total:
    """All factors together, each with its largest effect; those that say nothing, or fail in part, are named."""
    sizes = [line.size(quantity) for line in lines]
    known = [size for size in sizes if size is not None]
    out = []
    for line in lines:
        failed = line.failed(quantity)
        out += [f"{line.label} ({', '.join(failed)})"] if failed else []
        out += [f"{line.label} ({line.why_not})"] if line.why_not else []
    return Total(math.sqrt(math.fsum(size**2 for size in known)), math.fsum(known), tuple(out))


def totals_of(lines: Sequence[Line], quantities: Sequence[tuple[str, str, str]]) -> dict[str, dict[str, Total]]:
    """Totals of each quantity: of the numerical factors and of all; factors shown beside the others are in neither."""
    summed = [line for line in lines if line.group != "beside"]
    numerical = [line for line in summed if line.group == NUMERICAL]
    return {name: {NUMERICAL: total_of(numerical, name), ALL: total_of(summed, name)} for name, _, _ in quantities}


def budget_of(
    scene: Path, mechanics: str, variant: str, factors: Sequence[Factor], jobs: dict[tuple[str, str], Job],
    made: dict[tuple[str, str], Made], settings: Sequence[str] = (),
) -> Budget:  # fmt: skip
    """The budget from the runs made of it."""
    outcome, base = made["", ""]
    if base is None or not outcome.ok:
        status = "refused" if outcome.exit_status == REFUSED else "failed"
        return Budget(mechanics, variant, status, outcome.reason, {}, (), (), {})
    content = content_of(scene, variant, settings)
    quantities, with_path = followed(content, base), turns(content)
    names = [(one.name, one.label, one.unit) for one in quantities] + [("path_m", "path, largest distance", "m")] * with_path
    lines = []
    for factor in factors:
        ran = []
        for alternative in factor.alternatives:
            key = factor.id, alternative.id
            ran.append(tried(alternative, jobs[key], made[key], effects_of(quantities, with_path, base, made[key])))
        lines.append(Line(factor.id, factor.label, factor.group, tuple(ran), factor.why_not))
    values: dict[str, float | None] = {one.name: one.measure(base).low for one in quantities}
    return Budget(mechanics, variant, "completed", "", values, tuple(names), tuple(lines), totals_of(lines, names))


# --- what is written


def table(budget: Budget) -> str:
    """One budget as a table in text."""
    lines = [f"\n{budget.mechanics} {budget.variant}"]
    if budget.status != "completed":
        return lines[0] + f": {budget.status}: {budget.reason}"
    head = [f"{label} ({'kPa' if unit == 'Pa' else unit})" for _, label, unit in budget.quantities]
    widths = [max(len(name), 12) + 2 for name in head]
    lines.append(f"  {'':44}" + "".join(f"{name:>{width}}" for name, width in zip(head, widths)))
    base = [value_words(budget.base.get(name), unit) + (" MPa" if unit == "Pa" else "") for name, _, unit in budget.quantities]
    lines.append(f"  {'base':44}" + "".join(f"{value:>{width}}" for value, width in zip(base, widths)))
    for line in budget.lines:
        for one in line.tried:
            cells = [effect_words(one.effects.get(name), unit, budget.base.get(name)) for name, _, unit in budget.quantities]
            lost = dict.fromkeys(effect.note for effect in one.effects.values() if effect.value is None)
            failed = "  " + "; ".join(lost) if one.status == "completed" else f"  {one.status}: {one.reason[:150]}"
            label = f"{line.label}: {one.label}"
            lines.append(f"  {label:44}" + "".join(f"{cell:>{width}}" for cell, width in zip(cells, widths)) + failed.rstrip())
        if line.why_not:
            lines.append(f"  {line.label}: {line.why_not}")
    for group in (NUMERICAL, ALL):
        for word, attribute in (("root of squares", "rss"), ("plain sum", "sum")):
            cells = [amount(getattr(budget.totals[name][group], attribute), unit, "") for name, _, unit in budget.quantities]
            label = f"{'all factors' if group == ALL else 'numerical factors'}, {word}"
            lines.append(f"  {label:44}" + "".join(f"{cell:>{width}}" for cell, width in zip(cells, widths)))
    return "\n".join(lines)


def effect_words(effect: Effect | None, unit: str, base: float | None) -> str:
    """An effect with its share of the base, or a dash."""
    if effect is None or effect.value is None:
        return "-"
    share = f" {100.0 * effect.value / base:+.2f}%" if base else ""
    return amount(effect.value, unit, "+") + share


def amount(value: float, unit: str, sign: str) -> str:
    """A difference in kPa or its own unit."""
    return f"{value / 1e3:{sign}.2f}" if unit == "Pa" else f"{value:{sign}.3f}"


def write(target: Path, scene: Path, settings: Sequence[str], budgets: Sequence[Budget], version: str) -> None:
    """Write the budgets of an experiment."""
    target.parent.mkdir(parents=True, exist_ok=True)
    content = {"experiment": scene.stem, "settings": list(settings), "version": version, "budgets": [asdict(one) for one in budgets]}
    target.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


@dataclass(frozen=True)
class Case:
    """A variant of an experiment with the factors that are varied and their runs."""

    scene: Path
    variant: str
    factors: tuple[Factor, ...]
    jobs: dict[tuple[str, str], Job]


def case_of(scene: Path, variant: str, options: argparse.Namespace, refined: Path) -> Case:
    """What is to be run of a variant."""
    content = content_of(scene, variant, options.settings)
    wanted = [name for name in options.factors.split(",") if name]
    factors = tuple(one for one in factors_of(content, options.mechanics) if not wanted or one.id in wanted)
    jobs = jobs_of(scene, options.mechanics, variant, factors, options.settings, options.out.resolve(), refined)
    return Case(scene, variant, factors, jobs)


def parse(arguments: list[str] | None) -> tuple[argparse.ArgumentParser, argparse.Namespace]:
    """The command line."""
    parser = argparse.ArgumentParser(prog="ci/budget", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("experiments", nargs="*", help="beginnings of names, or scene files (default: all)")
    parser.add_argument("--variants", default="", help="names, comma-separated (default: the perfect case and interfaces that act)")
    parser.add_argument("--factors", default="", help="mesh, step, ring, particles, increment, block, rate (default: all)")
    parser.add_argument("--mechanics", default="quasistatic", choices=MECHANICS)
    parser.add_argument("--set", dest="settings", action="append", default=[], metavar="KEY=VALUE", help="a scene key")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time")
    parser.add_argument("--limit", type=float, default=LIMIT_MIN, help="minutes above which --yes is asked for")
    parser.add_argument("--yes", action="store_true", help="run whatever it costs")
    parser.add_argument("--out", type=Path, default=BUDGET_RUNS)
    parser.add_argument("--refined", type=Path, default=REFINE_RUNS, help="where ci/refine has its runs")
    return parser, parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> int:
    """The budgets from the command line; 0 where all runs completed, 3 where some did not, 2 for bad input."""
    parser, options = parse(arguments)
    try:
        scenes = [scene_of(name) for name in options.experiments] or scenes_of(EXPERIMENTS)
        cases = []
        for scene in scenes:
            variants = options.variants or ",".join(VARIANTS.get(scene.stem, ()))
            cases += [case_of(scene, name, options, options.refined.resolve()) for name in chosen(scene, variants)
                      if options.mechanics in mechanics_of(scene, name)]  # fmt: skip
    except ValueError as error:
        parser.error(str(error))
    if not solver().is_file():
        parser.error(f"there is no solver at {solver()}: build it first (ci/reproduce and ci/test do)")
    jobs = [job for case in cases for job in case.jobs.values()]
    if not affordable(jobs, options):
        return 2
    good = True
    for scene in dict.fromkeys(case.scene for case in cases):
        budgets, version = [], ""
        for case in (one for one in cases if one.scene == scene):
            made = dict(zip(case.jobs, make_all(list(case.jobs.values()), options.jobs)))
            good = good and all(outcome.ok for outcome, _ in made.values())
            version = next((run.summary.version for _, run in made.values() if run), version)
            budgets.append(budget_of(scene, options.mechanics, case.variant, case.factors, case.jobs, made, options.settings))
            print(table(budgets[-1]))
            write(options.out / f"{scene.stem}.json", scene, options.settings, budgets, version)
    print(f"\nwritten below {options.out}")
    return 0 if good else 3


if __name__ == "__main__":
    sys.exit(main())
