"""What each ingredient of an experiment is worth: left out one at a time, with the effect beside the time saved.

usage: ci/ablate [exp1 ...] [--variants soft,weak] [--ingredients inertia,flow] [--set KEY=VALUE]... [--out DIR] [--runs DIR]

Without names: all experiments. Without --variants: all ingredients of the perfect case and of the one whose interfaces act most (soft;
weak_soft and soft_weak in Experiment 3), and of the study's other variants the interfaces alone. Runs one at a time, in the scene's own
mechanics (explicit). Tables are printed, and kept in verification/ablation/records (DIR) where nothing was chosen by --ingredients or --set.
What cells, steps, rings and points a cell are worth ci/budget and ci/refine say.
"""

import sys

from verification.ablation import table as tables
from verification.ablation.measure import EVERYTHING, INTERFACES, RUNS, NoBase, table_of
from verification.harness.choose import beginnings
from verification.harness.command import command
from verification.harness.paths import EXPERIMENTS, need_solver
from verification.harness.scenes import chosen, scene_of, scenes_of

WHOLE = ("perfect", "soft", "weak_soft", "soft_weak")  # variants of which everything is left out in turn


def main(arguments: list[str] | None = None) -> int:
    """Measure, print and keep the tables; 0, 3 where a scene's own run failed, 2 for bad input."""
    parser = command("ci/ablate", __doc__, "variants", "set", "out", "runs", out=tables.RECORDS, runs=RUNS)
    parser.add_argument("experiments", nargs="*", help="beginnings of names, or scene files (default: all)")
    parser.add_argument("--ingredients", default="", help="ids, comma-separated (default: all)")
    options = parser.parse_args(arguments)
    only = beginnings(options.ingredients)
    keep = not only and (not options.settings or options.out != tables.RECORDS)
    good = True
    try:
        need_solver()
        for scene in [scene_of(name) for name in options.experiments] or scenes_of(EXPERIMENTS):
            for variant in chosen(scene, options.variants):
                extent = EVERYTHING if options.variants or variant in WHOLE else INTERFACES
                try:
                    table = table_of(scene, variant, extent, options.settings, only, options.runs.resolve(), print)
                except NoBase as failure:
                    print(failure, file=sys.stderr)
                    good = False
                    continue
                parts = [f"{words} {tables.named(lines)}" for words, lines in (("needs", table.needs()), ("not", table.spared(True))) if lines]
                print(f"  for 1 %: {'; '.join(parts) or 'nothing that costs time'}\n")
                if keep:
                    tables.write(table, options.out)
    except ValueError as error:
        parser.error(str(error))
    return 0 if good else 3


if __name__ == "__main__":
    sys.exit(main())
