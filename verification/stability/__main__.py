"""Walks the families of the stability atlas across their edges and judges what was found.

usage: ci/atlas [--family NAME[,NAME...]] [--smoke] [--accept] [--list]

Runs go to runs/atlas/FAMILY/POINT; what is there for the same scene, settings and solver is not run again. Without --accept nothing is
written: what differs from the records (verification/stability/records) is told. --smoke judges by the recorded edges.
Exit status: 0 all as declared and as recorded, 1 some are not, 2 wrong use.
"""

import argparse
import sys
from dataclasses import replace

from verification.harness.command import beginnings, choose, command, ends_for_bad_input
from verification.harness.paths import solver
from verification.harness.run import say
from verification.stability import runner
from verification.stability.families import families
from verification.stability.family import Family
from verification.stability.runner import RUNS, changes, problems, walk


def judged(family: Family, options: argparse.Namespace) -> list[str]:
    """Walk a family; what is wrong with it, and with what was recorded of it."""
    before = runner.read(family.name)
    now = walk(family, options.smoke, options.runs, tell=say)
    if options.smoke:
        now = replace(now, edge=before.edge if before is not None else None)
    wrong = problems(family, now, options.smoke)
    told = changes(before, now)
    for line in told:
        print(f"  {line}")
    if options.accept:
        runner.write(now)
    else:
        wrong += told
    if now.edge is not None and now.edge.measured is not None:
        theory = "" if now.edge.difference is None else f", predicted {now.edge.predicted:.5g} ({100.0 * now.edge.difference:+.2f} %)"
        print(f"{family.name}: edge {now.edge.measured:.5g}{theory}")
    cpu_s = sum(point.cpu_s for point in now.points)
    say(f"{family.name}: {'; '.join(wrong) or 'as it is to be'} ({cpu_s:.1f} s of CPU time)")
    return wrong


def main(arguments: list[str] | None = None) -> int:
    """Walk what is asked for."""
    parser = command("ci/atlas", __doc__, "family", "smoke", "accept", "list", "runs", runs=RUNS)
    options = parser.parse_args(arguments)
    with ends_for_bad_input(parser):
        asked = choose(families(), beginnings(options.family))
    if options.list:
        for family in asked.values():
            print(f"{family.name}: {family.title} ({len(family.points)} points)")
        return 0
    if options.smoke and options.accept:
        parser.error("--accept needs all points: without --smoke")
    if not solver().is_file():
        parser.error(f"there is no {solver()}: build it first")
    wrong = sum(bool(judged(family, options)) for family in asked.values())
    print(f"{len(asked)} families, {f'{wrong} NOT' if wrong else 'all'} as they are to be")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
