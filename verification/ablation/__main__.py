"""What each ingredient of an experiment is worth, left out alone (ci/ablate); what each factor of its error moves, varied alone (ci/budget)."""

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from verification.ablation import table as tables
from verification.ablation.changes import Change, factors_of, ingredients_of, named
from verification.ablation.table import Maker, NoBase, left_out, table_of, varied
from verification.harness.command import beginnings, command, ends_for_bad_input
from verification.harness.paths import EXPERIMENTS, RUNS, need_solver
from verification.harness.run import Job, affordable, make_all
from verification.harness.scenes import MECHANICS, chosen, content_of, mechanics_of, scene_of, scenes_of

ABLATION_RUNS, BUDGET_RUNS = RUNS / "ablation", RUNS / "budget"
LIMIT_S = 900.0  # a run of an ingredient left out that takes longer says nothing
EVERYTHING, INTERFACES, SOME = "everything", "interfaces", "some"  # how much of a scene is left out
WHOLE = ("perfect", "soft", "weak_soft", "soft_weak")  # variants of which everything is left out in turn

# What is budgeted without --variants: the perfect case and interfaces that act. Experiment 3 with perfect interfaces is Experiment 1's.
BUDGETED: dict[str, tuple[str, ...]] = {
    "exp1_single_interface": ("perfect", "weak", "soft"),
    "exp2_soft_above": ("perfect", "soft"),
    "exp3_two_interfaces": ("weak_soft", "soft_weak"),
    "exp4_soft_between": ("perfect", "soft"),
    "exp5_parallel_interface": ("perfect", "soft"),
    "exp6_stress_reversal": ("perfect", "soft"),
}

Planned = tuple[dict[str, Any], str, list[Change], Job, list[Job]]  # of a scene's variant, as table_of takes it
Plan = Callable[[Path, str], Planned | None]


def planned(parser: argparse.ArgumentParser, options: argparse.Namespace, plan: Plan, usual: dict[str, tuple[str, ...]]) -> list[Planned]:
    """What is to be made of the experiments and variants that are asked for; ends the command for bad input."""
    with ends_for_bad_input(parser):
        need_solver()
        scenes = [scene_of(name) for name in options.experiments] or scenes_of(EXPERIMENTS)
        every = [plan(scene, variant) for scene in scenes for variant in chosen(scene, options.variants or ",".join(usual.get(scene.stem, ())))]
        return [one for one in every if one is not None]


def made(every: Sequence[Planned], made_by: Maker, tell: Callable[[tables.Table], None]) -> int:
    """Make and tell each table; 0, 3 where a scene's own run failed."""
    status = 0
    for one in every:
        try:
            tell(table_of(*one, made_by))
        except NoBase as failure:
            print(failure, file=sys.stderr)
            status = 3
    return status


def ablate(arguments: list[str] | None = None) -> int:
    """What each ingredient of an experiment is worth: left out one at a time, with the effect beside the time saved.

    usage: ci/ablate [exp1 ...] [--variants soft,weak] [--ingredients inertia,flow] [--set KEY=VALUE]... [--out DIR] [--runs DIR]

    Without names: all experiments. Without --variants: all ingredients of the perfect case and of the one whose interfaces act most (soft;
    weak_soft and soft_weak in Experiment 3), and of the study's other variants the interfaces alone. Runs one at a time, in the scene's own
    mechanics (explicit). Tables are printed, and kept in verification/ablation/records (DIR) where nothing was chosen by --ingredients or --set.
    What cells, steps, rings and points a cell are worth ci/budget and ci/refine say. Exit status: 0, 3 where a scene's own run failed, 2 for bad input.
    """
    parser = command("ci/ablate", ablate.__doc__, "variants", "set", "out", "runs", out=tables.RECORDS, runs=ABLATION_RUNS)
    parser.add_argument("experiments", nargs="*", help="beginnings of names, or scene files (default: all)")
    parser.add_argument("--ingredients", default="", help="ids, comma-separated (default: all)")
    options = parser.parse_args(arguments)
    only = beginnings(options.ingredients)

    def plan(scene: Path, variant: str) -> Planned:
        extent = SOME if only else EVERYTHING if options.variants or variant in WHOLE else INTERFACES
        content = content_of(scene, variant, options.settings)
        changes = [one for one in named(ingredients_of(content), only) if extent != INTERFACES or one.id.startswith("interface")]
        return content, extent, changes, *left_out(scene, variant, options.settings, changes, options.runs.resolve())

    def tell(table: tables.Table) -> None:
        parts = [f"{words} {', '.join(line.label for line in lines)}" for words, lines in (("needs", table.needs()), ("not", table.spared(True))) if lines]
        print(f"{tables.words(table)}\n  for 1 %: {'; '.join(parts) or 'nothing that costs time'}\n", flush=True)
        if not only and (not options.settings or options.out != tables.RECORDS):
            tables.write(table, options.out)

    return made(planned(parser, options, plan, {}), lambda jobs: make_all(jobs, 1, force=True, limit_s=LIMIT_S), tell)


def budget(arguments: list[str] | None = None) -> int:
    """The error budget of an experiment: each factor varied alone from what the scene says, and what that moves.

    usage: ci/budget [exp1 ...] [--variants perfect,soft] [--factors mesh,ring] [--mechanics quasistatic|explicit]
                     [--set KEY=VALUE]... [--jobs 2] [--limit MINUTES] [--yes] [--out DIR]

    Without names: all experiments. What has been run for the same scene and solver is not run again; the base and the run with half
    the cells are those of ci/refine. Prints a table a variant and writes DIR/MECHANICS/EXPERIMENT.VARIANT.json (DIR: runs/budget). Exit status: 0 where
    all runs completed, 3 where some did not, 2 for bad input.
    """
    parser = command("ci/budget", budget.__doc__, "variants", "set", "jobs", "limit", "yes", "out", out=BUDGET_RUNS)
    parser.add_argument("experiments", nargs="*", help="beginnings of names, or scene files (default: all)")
    parser.add_argument("--factors", default="", help="mesh, step, ring, particles, increment, block, rate (default: all)")
    parser.add_argument("--mechanics", default="quasistatic", choices=MECHANICS)
    options = parser.parse_args(arguments)
    mechanics, failed = options.mechanics, []

    def plan(scene: Path, variant: str) -> Planned | None:
        if mechanics not in mechanics_of(scene, variant):
            return None
        content = content_of(scene, variant, (f"numerics.mechanics={mechanics}", *options.settings))
        changes = named(factors_of(content, mechanics), beginnings(options.factors))
        return content, mechanics, changes, *varied(scene, mechanics, variant, options.settings, content, changes, options.out.resolve())

    def tell(table: tables.Table) -> None:
        failed.extend(one for one in table.lines if one.applies and one.status != "completed")
        print(f"{tables.words(table)}\nwritten: {tables.write(table, options.out / mechanics)}", flush=True)

    every = planned(parser, options, plan, BUDGETED)
    if not affordable([job for _, _, _, base, jobs in every for job in (base, *jobs)], options):
        return 2
    status = made(every, lambda jobs: make_all(jobs, options.jobs), tell)
    return status or (3 if failed else 0)


if __name__ == "__main__":
    sys.exit(ablate())
