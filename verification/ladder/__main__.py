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

import math
import platform
import sys
from dataclasses import asdict
from pathlib import Path

from verification.harness import store
from verification.harness.command import aligned, beginnings, command, count, ends_for_bad_input, number
from verification.ladder import gates as book
from verification.ladder.case import Families, about, chosen, families
from verification.ladder.gates import Gates
from verification.ladder.measure import RUNS, Row, Tally, accepted, judged, make_all, rows_of, rungs_of, tally

HEADER = ("case", "quantity", "level", "value", "reference", "error", "order", "cost", "gate", "verdict")
RIGHT = (3, 4, 5, 6, 7, 8)


def cells(row: Row) -> tuple[str, ...]:
    """A row's cells, in the header's order."""
    order = "-" if row.order is None else f"{row.order:.2f}"
    cost = f"{row.cost['wall_s']:.2f} s {count(row.cost['particles'])}p {count(row.cost['steps'])}st" if row.cost else "-"
    gate = f"{row.gate.error:g}" + (f" / {row.gate.order:g}" if row.gate.order is not None else "") if row.gate else "none"
    many = f" rms of {row.values}" if row.values > 1 else ""
    why = "; ".join(filter(None, (row.failure, *row.problems, row.note)))
    return (
        f"{row.case} ({row.mechanics})", f"{row.quantity} [{row.unit or '1'}]{many}", row.level,
        number(row.value), number(row.reference), "-" if math.isnan(row.error) else f"{row.error:+.2e}",
        f"({order})" if row.no_order and row.order is not None else order, cost, gate, f"{row.verdict}{': ' if why else ''}{why}",
    )  # fmt: skip


def text(rows: list[Row]) -> str:
    """The rows as a table, family by family; orders in brackets are not judged, the reason stands below their family."""
    if not rows:
        return "no rows"
    header, *lines = aligned([HEADER, *map(cells, rows)], RIGHT)
    found = [header]
    for family in dict.fromkeys(row.family for row in rows):
        own = [(row, line) for row, line in zip(rows, lines) if row.family == family]
        found += ["", family, *(line for _, line in own), *reasons([row for row, _ in own])]
    return "\n".join(found)


def reasons(rows: list[Row]) -> list[str]:
    """A line for each reason why no order is to be expected, with the cases and quantities that it is given for."""
    given: dict[str, dict[str, list[str]]] = {}
    for row in rows:
        if row.no_order:
            given.setdefault(row.no_order, {}).setdefault(f"{row.case} {row.quantity}", []).append(row.level)
    every = [f"{row.case} {row.quantity}" for row in rows]
    lines = []
    for reason, names in given.items():
        told = (name if len(levels) == every.count(name) else f"{name} at {', '.join(levels)}" for name, levels in names.items())
        lines.append(f"  no order: {reason}: {'; '.join(told)}")
    return lines


def write_json(path: Path, rows: list[Row], asked: Families, counted: Tally, stale: list[str], part: bool) -> None:
    """Write ladder.json: what the page shows; numbers that are not finite are null."""
    said = []
    for family, members in asked.items():
        own = [{"name": case.name, "says": case.says, "mechanics": case.mechanics, "scene": case.scene.name} for case in members]
        said.append({"name": family, "says": about(family), "cases": own})
    machine = f"{platform.machine()}, {platform.system()} {platform.release()}"
    content = {"part": part, "machine": machine, "tally": {**asdict(counted), "words": counted.words()}, "stale": stale, "families": said}
    store.write({**content, "rows": [{**asdict(row), "verdict": row.verdict} for row in rows]}, path)


def accept(rows: list[Row], known: Families, before: dict[str, Gates]) -> None:
    """Write the gates of families anew, without those of cases that there are no more; print what changed. `before`: their gates when the runs began.
    Files of other families are not touched, nor one that was changed since."""
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


def main(arguments: list[str] | None = None) -> int:
    """Run, judge, print and write; the exit status says what came of it."""
    parser = command("verification.ladder", __doc__, "family", "case", "smoke", "jobs", "accept", "out", "runs", "list", runs=RUNS)
    options = parser.parse_args(arguments)
    if options.jobs < 1:
        parser.error(f"--jobs {options.jobs} is not a number of threads")
    with ends_for_bad_input(parser):
        known = families()
        asked = chosen(known, beginnings(options.family), beginnings(options.case))
    if options.list:
        for family, members in asked.items():
            print(family)
            for case in members:
                print(f"  {case.name} ({case.mechanics}): {case.says}")
                print(f"    {', '.join(item.name for item in case.quantities)} at {', '.join(level.label for level in case.levels)}")
        return 0
    before = {family: book.read(family) for family in asked}
    made = make_all(rungs_of(asked, options.smoke, options.runs), options.jobs, tell=lambda line: print(line, file=sys.stderr, flush=True))
    measured = rows_of(made)
    if options.accept:
        accept(measured, known, before)
    rows = judged(measured, {family: book.read(family) for family in asked})
    part = bool(options.smoke or options.family or options.case)
    stale = [line for line in book.stale(known) if not part or line.split("/")[0] in asked]
    counted = tally(rows)
    out = options.out or options.runs / ("ladder_part.json" if part else "ladder.json")
    write_json(out, rows, asked, counted, stale, part)
    print(text(rows))
    for line in stale:
        print(f"gate of nothing: {line}")
    minutes, skipped = sum(outcome.wall_s for _, (outcome, _) in made) / 60.0, sum(outcome.skipped for _, (outcome, _) in made)
    print(f"{len(made)} runs, {skipped} of them made before, {minutes:.1f} thread-minutes in all")
    print(f"ladder: {counted.words()}{f'; {len(stale)} gates of nothing' if stale else ''}; written to {out}")
    return 3 if counted.failed else 1 if counted.wrong or stale or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
