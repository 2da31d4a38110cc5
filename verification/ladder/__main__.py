"""The accuracy ladder: runs scenes with known answers at several sizes, prints error and order, and judges them by gates.

usage: python3 -m verification.ladder [--family a,b] [--case x] [--smoke] [--jobs 2] [--accept] [--out FILE]

Cases are in verification/ladder/cases/FAMILY.py, gates in verification/ladder/gates/FAMILY.json. A row is a quantity of a case at
a level: value and reference (of many values their rms), relative error, observed order from the level before (in brackets where
none is to be expected), cost, gate (largest error / smallest order), verdict. --accept writes gates anew from what was measured
(1.5 times the error, order less 0.3) and prints what changed: say in CHANGELOG.md why a gate became wider. A gate that a better
result left too wide is noted and fails nothing. --out: for the page (default: runs/ladder/ladder.json, of a part ladder_part.json).
Exit status: 0 all pass, 1 a gate does not hold, is missing, belongs to nothing or lets wrong results pass, or there is nothing
to judge, 2 wrong use, 3 a run failed.
"""

import sys

from verification.harness.choose import beginnings
from verification.harness.command import command
from verification.ladder import gates as book
from verification.ladder.catalogue import Families, chosen, families
from verification.ladder.gates import Gates
from verification.ladder.judge import accepted, judged, tally
from verification.ladder.measure import Row, rows_of
from verification.ladder.runner import RUNS, make_all, rungs_of
from verification.ladder.table import text, write_json


def accept(rows: list[Row], known: Families, before: dict[str, Gates]) -> None:
    """Write the gates of families anew, without those of cases that there are no more; print what changed.

    `before`: their gates when the runs began. Files of other families are not touched, nor one that was changed since.
    """
    now, refused = accepted(rows, before)
    for family, old in before.items():
        if book.read(family) != old:
            refused.append(f"{family}: its gates were changed while the runs were made; accept again")
            continue
        kept = {key: now[family][key] for key in book.keys_of(known, family) if key in now[family]}
        for line in book.changes(old, kept):
            print(f"gate {family}/{line}")
        if kept != old:
            book.write(family, kept)
    for line in refused:
        print(f"no gate accepted: {line}")


def show(asked: Families) -> None:
    """Print what cases there are."""
    for family, members in asked.items():
        print(family)
        for case in members:
            print(f"  {case.name} ({case.mechanics}): {case.says}")
            print(f"    {', '.join(item.name for item in case.quantities)} at {', '.join(level.label for level in case.levels)}")


def main(arguments: list[str] | None = None) -> int:
    """Run, judge, print and write; the exit status says what came of it."""
    parser = command("verification.ladder", __doc__, "family", "case", "smoke", "jobs", "accept", "out", "runs", "list", runs=RUNS)
    options = parser.parse_args(arguments)
    if options.jobs < 1:
        parser.error(f"--jobs {options.jobs} is not a number of threads")
    try:
        known = families()
        asked = chosen(known, beginnings(options.family), beginnings(options.case))
    except ValueError as error:
        parser.error(str(error))
    if options.list:
        show(asked)
        return 0
    before = {family: book.read(family) for family in asked}
    made = make_all(rungs_of(asked, options.smoke, options.runs), options.jobs, tell=lambda line: print(line, file=sys.stderr, flush=True))
    measured = rows_of(made)
    if options.accept:
        accept(measured, known, before)
    rows = judged(measured, {family: book.read(family) for family in asked})
    part = bool(options.smoke or options.family or options.case)
    stale = [line for line in book.stale(known) if not part or line.split("/")[0] in asked]
    count = tally(rows)
    out = options.out or options.runs / ("ladder_part.json" if part else "ladder.json")
    write_json(out, rows, asked, count, stale, part)
    print(text(rows))
    for line in stale:
        print(f"gate of nothing: {line}")
    minutes = sum(one.outcome.wall_s for one in made) / 60.0
    skipped = sum(one.outcome.skipped for one in made)
    print(f"{len(made)} runs, {skipped} of them made before, {minutes:.1f} thread-minutes in all")
    print(f"ladder: {count.words()}{f'; {len(stale)} gates of nothing' if stale else ''}; written to {out}")
    return 3 if count.failed else 1 if count.wrong or stale or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
