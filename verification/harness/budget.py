"""The error budget of an experiment: each factor varied alone from what the scene says, and what that moves.

usage: ci/budget [exp1 ...] [--variants perfect,soft] [--factors mesh,ring] [--mechanics quasistatic|explicit]
                 [--set KEY=VALUE]... [--jobs 2] [--limit MINUTES] [--yes] [--out DIR]

Without names: all experiments. What has been run for the same scene and solver is not run again; the base and the run with half
the cells are those of ci/refine. Writes DIR/EXPERIMENT.json (DIR: runs/budget) and prints it.
"""

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from verification.harness import store
from verification.harness.choose import beginnings
from verification.harness.command import aligned, command
from verification.harness.factors import Factor, factors_of
from verification.harness.paths import EXPERIMENTS, RUNS, need_solver
from verification.harness.plan import Made, affordable, make_all
from verification.harness.quantities import Effect, effects_of, followed, turns
from verification.harness.refine import REFINE_RUNS, job_of, value_words
from verification.harness.run import Job
from verification.harness.scenes import MECHANICS, chosen, content_of, mechanics_of, scene_of, scenes_of

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

# Groups of factors that are summed: what the numbers owe to the method, and all that was varied.
NUMERICAL, ALL = "numerical", "all"


@dataclass(frozen=True)
class Tried:
    """An alternative that was run: how it ended and its effects by the names of quantities."""

    label: str
    settings: tuple[str, ...]
    status: str
    reason: str
    effects: dict[str, Effect]

    def value(self, quantity: str) -> float | None:
        """Its effect on a quantity; None where it says nothing."""
        return self.effects[quantity].value if quantity in self.effects else None


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
        return max((abs(value) for one in self.tried if (value := one.value(quantity)) is not None), default=None)


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


Key = tuple[str, str]  # factor and alternative; the base is ("", "")


def jobs_of(
    scene: Path, mechanics: str, variant: str, factors: Sequence[Factor], settings: Sequence[str], root: Path, refined: Path
) -> dict[Key, Job]:
    """The runs of a budget: base and half the cells are the refinement study's, others the base's settings with their own in place."""
    cell = float(content_of(scene, variant, (f"numerics.mechanics={mechanics}", *settings))["numerics"]["cell_m"])
    others = [setting for setting in settings if setting.partition("=")[0] != "numerics.cell_m"]
    base, half = (job_of(scene, mechanics, variant, size, others, refined) for size in (cell, cell / 2.0))
    jobs = {("", ""): base}
    for factor in factors:
        for alternative in factor.alternatives:
            pairs = dict(setting.partition("=")[::2] for setting in (*base.settings, *alternative.settings))
            folder = root / scene.stem / mechanics / variant / f"{factor.id}_{alternative.id}"
            own = Job(scene, variant, folder, tuple(f"{key}={value}" for key, value in pairs.items()))
            jobs[factor.id, alternative.id] = half if factor.id == "mesh" else own
    return jobs


def total_of(lines: Sequence[Line], quantity: str) -> Total:
    """All factors together, each with its largest effect; those that say nothing, or fail in part, are named."""
    known = [size for line in lines if (size := line.size(quantity)) is not None]
    failed = [(line, ", ".join(one.label for one in line.tried if one.value(quantity) is None)) for line in lines]
    out = tuple(f"{line.label} ({why})" for line, lost in failed for why in (lost, line.why_not) if why)
    return Total(math.sqrt(math.fsum(size**2 for size in known)), math.fsum(known), out)


def totals_of(lines: Sequence[Line], quantities: Sequence[tuple[str, str, str]]) -> dict[str, dict[str, Total]]:
    """Totals of each quantity: of the numerical factors and of all; factors shown beside the others are in neither."""
    groups = {NUMERICAL: [line for line in lines if line.group == NUMERICAL], ALL: [line for line in lines if line.group != "beside"]}
    return {name: {group: total_of(own, name) for group, own in groups.items()} for name, _, _ in quantities}


def budget_of(
    scene: Path, mechanics: str, variant: str, factors: Sequence[Factor], jobs: dict[Key, Job], made: dict[Key, Made], settings: Sequence[str] = ()
) -> Budget:
    """The budget from the runs made of it."""
    outcome, base = made["", ""]
    if base is None or not outcome.ok:
        return Budget(mechanics, variant, outcome.word if not outcome.ok else "failed", outcome.reason, {}, (), (), {})
    content = content_of(scene, variant, (f"numerics.mechanics={mechanics}", *settings))
    quantities, with_path = followed(content, base), turns(content)
    names = [(one.name, one.label, one.unit) for one in quantities] + [("path_m", "path, largest distance", "m")] * with_path

    def tried(key: Key, label: str) -> Tried:
        outcome, run = made[key]
        short = "" if outcome.ok else "up to where the run failed"
        effects = effects_of(quantities, with_path, base, run, short) if run is not None else {}
        return Tried(label, jobs[key].settings, outcome.word, outcome.reason, effects)

    lines = [Line(factor.id, factor.label, factor.group, tuple(tried((factor.id, one.id), one.label) for one in factor.alternatives), factor.why_not)
             for factor in factors]  # fmt: skip
    values: dict[str, float | None] = {one.name: one.measure(base).low for one in quantities}
    return Budget(mechanics, variant, "completed", "", values, tuple(names), tuple(lines), totals_of(lines, names))


def amount(value: float, unit: str, sign: str = "") -> str:
    """A difference in kPa or its own unit."""
    return f"{value / 1e3:{sign}.2f}" if unit == "Pa" else f"{value:{sign}.3f}"


def effect_words(value: float | None, unit: str, base: float | None) -> str:
    """An effect with its share of the base, or a dash."""
    return "-" if value is None else amount(value, unit, "+") + (f" {100.0 * value / base:+.2f}%" if base else "")


def table(budget: Budget) -> str:
    """One budget as a table in text."""
    head = f"\n{budget.mechanics} {budget.variant}"
    if budget.status != "completed":
        return f"{head}: {budget.status}: {budget.reason}"
    units = [(name, unit) for name, _, unit in budget.quantities]
    rows = [["", *(f"{label} ({'kPa' if unit == 'Pa' else unit})" for _, label, unit in budget.quantities), ""]]
    rows.append(["base", *(value_words(budget.base.get(name), unit) + (" MPa" if unit == "Pa" else "") for name, unit in units), ""])
    for line in budget.lines:
        for one in line.tried:
            cells = [effect_words(one.value(name), unit, budget.base.get(name)) for name, unit in units]
            lost = "; ".join(dict.fromkeys(effect.note for effect in one.effects.values() if effect.value is None))
            rows.append([f"{line.label}: {one.label}", *cells, lost if one.status == "completed" else f"{one.status}: {one.reason[:150]}"])
        if line.why_not:
            rows.append([f"{line.label}: {line.why_not}", *[""] * len(units), ""])
    for group, what in ((NUMERICAL, "numerical factors"), (ALL, "all factors")):
        totals = [(budget.totals[name][group], unit) for name, unit in units]
        rows.append([f"{what}, root of squares", *(amount(total.rss, unit) for total, unit in totals), ""])
        rows.append([f"{what}, plain sum", *(amount(total.sum, unit) for total, unit in totals), ""])
    return "\n".join([head, *(f"  {line}" for line in aligned(rows, range(1, len(units) + 1)))])


def main(arguments: list[str] | None = None) -> int:
    """The budgets from the command line; 0 where all runs completed, 3 where some did not, 2 for bad input."""
    parser = command("ci/budget", __doc__, "variants", "set", "jobs", "limit", "yes", "out", out=BUDGET_RUNS)
    parser.add_argument("experiments", nargs="*", help="beginnings of names, or scene files (default: all)")
    parser.add_argument("--factors", default="", help="mesh, step, ring, particles, increment, block, rate (default: all)")
    parser.add_argument("--mechanics", default="quasistatic", choices=MECHANICS)
    parser.add_argument("--refined", type=Path, default=REFINE_RUNS, help="where ci/refine has its runs")
    options = parser.parse_args(arguments)
    wanted, root, settings = beginnings(options.factors), options.out.resolve(), options.settings
    cases: dict[Path, list[tuple[str, list[Factor], dict[Key, Job]]]] = {}
    try:
        for scene in [scene_of(name) for name in options.experiments] or scenes_of(EXPERIMENTS):
            for variant in chosen(scene, options.variants or ",".join(VARIANTS.get(scene.stem, ()))):
                if options.mechanics in mechanics_of(scene, variant):
                    every = factors_of(content_of(scene, variant, (f"numerics.mechanics={options.mechanics}", *settings)), options.mechanics)
                    factors = [one for one in every if not wanted or one.id in wanted]
                    jobs = jobs_of(scene, options.mechanics, variant, factors, settings, root, options.refined.resolve())
                    cases.setdefault(scene, []).append((variant, factors, jobs))
        need_solver()
    except ValueError as error:
        parser.error(str(error))
    if not affordable([job for own in cases.values() for _, _, jobs in own for job in jobs.values()], options):
        return 2
    good = True
    for scene, own in cases.items():
        budgets, version = [], ""
        for variant, factors, jobs in own:
            made = dict(zip(jobs, make_all(list(jobs.values()), options.jobs)))
            good = good and all(outcome.ok for outcome, _ in made.values())
            version = next((run.summary.version for _, run in made.values() if run), version)
            budgets.append(budget_of(scene, options.mechanics, variant, factors, jobs, made, settings))
            print(table(budgets[-1]))
            content = {"experiment": scene.stem, "settings": list(settings), "version": version, "budgets": budgets}
            store.write(content, options.out / f"{scene.stem}.json")
    print(f"\nwritten below {options.out}")
    return 0 if good else 3


if __name__ == "__main__":
    sys.exit(main())
