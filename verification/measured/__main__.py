"""Runs of experiments that were measured: the errors of each quantity, and of everything that a run may lack, one at a time.

usage: python3 -m verification.measured [--smoke] [--jobs N] [--accept] [--runs DIR]

All variants at cells of 2 mm, the plain one at 1 mm as well; --smoke: the plain one at 2 mm alone. Errors are held against those of the record,
verification/measured/records/rubin.json, which --accept writes anew. Exit status: 0 as recorded, 1 not, 3 a run failed.
"""

import sys
from pathlib import Path

import numpy as np

from verification.harness import paths, store
from verification.harness.command import aligned, command, number
from verification.harness.load import Run, load
from verification.harness.run import Job, make_all
from verification.measured import rubin

RUNS = paths.RUNS / "measured"
COARSE_M, FINE_M = 0.002, 0.001
SAME = 0.001  # errors of the same run on other processors differ by less than a tenth of it


def job(variant: str, cell_m: float, runs: Path = RUNS) -> Job:
    """The run of a variant of the scene at a cell size; the fracture grows by a cell at a time."""
    settings = (f"numerics.cell_m={cell_m!r}", f"fracture.increment_m={cell_m!r}")
    return Job(rubin.SCENE, variant, runs / "rubin" / (variant or "plain") / f"{1e3 * cell_m:g}mm", settings)


def differences(new: rubin.Record, old: rubin.Record | None) -> list[str]:
    """What is not as recorded, a line each."""
    known = {(one.name, one.cell_m): one for one in old.results} if old else {}
    told = []
    for one in new.results:
        before = known.get((one.name, one.cell_m))
        told += [f"{one.name}, {1e3 * one.cell_m:g} mm: not in the record"] if before is None else [
            f"{one.name}, {1e3 * one.cell_m:g} mm, {quantity}: {100 * errors.late:.2f} %, recorded {100 * before.errors[quantity].late:.2f} %"
            for quantity, errors in one.errors.items() if not abs(errors.late - before.errors[quantity].late) <= SAME
        ]  # fmt: skip
    return told


def text(record: rubin.Record) -> str:
    """The results as a table: mean relative errors from 15 s on (and at equal length), %."""
    rows = [["", "cells", *rubin.COLUMNS, "early by, s", "s"]]
    for one in (*record.results, rubin.geos()):
        cells = [f"{100 * error.late:.1f}" + (f" ({100 * error.same_length:.1f})" if name != rubin.LENGTH else "") for name, error in one.errors.items()]
        rows.append([one.name, f"{1e3 * one.cell_m:.2g} mm", *cells, " to ".join(f"{time:.1f}" for time in one.early_s), number(one.wall_s, 3)])
    return "\n".join(aligned(rows, range(2, len(rows[0]))))


def where_as_long(run: Run) -> str:
    """Where a run is as long as the fracture was: how much sooner (s), and its opening (%) and pressures (MPa) less those measured; a line a reading."""
    found = rubin.courses(run)
    times, lengths = rubin.measured(rubin.LENGTH)
    reached = rubin.read((found[rubin.LENGTH][1], found[rubin.LENGTH][0]), lengths)
    columns = [1e3 * lengths, times - reached]
    for name in (rubin.OPENING, *rubin.PRESSURES):
        at, values = rubin.measured(name)
        off = rubin.read(found[name], reached[-at.size :]) - values
        columns.append(np.pad(100.0 * off / values if name == rubin.OPENING else 1e-6 * off, (times.size - at.size, 0), constant_values=np.nan))
    heads = ["length, mm", "sooner by, s", f"{rubin.OPENING}, %", *(f"{name}, MPa" for name in rubin.PRESSURES)]
    return "\n".join(aligned([heads, *([number(value, 3) for value in row] for row in zip(*columns))], range(len(heads))))


def main(arguments: list[str] | None = None) -> int:
    """Run, print, compare with the record or write it."""
    parser = command("python3 -m verification.measured", __doc__, "smoke", "jobs", "accept", "runs", runs=RUNS)
    options = parser.parse_args(arguments)
    wanted = [(one, COARSE_M) for one in rubin.variants()[: 1 if options.smoke else None]]
    wanted += [] if options.smoke else [(one, FINE_M) for one in rubin.variants() if not one.scene]
    jobs = {(one.scene, cell_m): job(one.scene, cell_m, options.runs.resolve()) for one, cell_m in wanted}
    made = dict(zip(jobs, make_all(list(jobs.values()), options.jobs)))
    failed = [f"{jobs[key].out}: {outcome.reason}" for key, (outcome, _) in made.items() if not outcome.ok]
    if failed:
        print(*failed, sep="\n", file=sys.stderr)
        return 3
    runs = {key: load(one.out) for key, one in jobs.items()}
    record = rubin.Record(next(iter(runs.values())).summary.version, tuple(rubin.result(one, runs[one.scene, cell_m]) for one, cell_m in wanted))
    print(text(record))
    plain = min((one for one in record.results if one.name == "plain"), key=lambda one: one.cell_m)
    print(f"plain, {1e3 * plain.cell_m:g} mm, all readings:", ", ".join(f"{name} {100 * error.every:.1f} %" for name, error in plain.errors.items()))
    print(where_as_long(runs["", plain.cell_m]))
    if options.accept and not options.smoke:
        print(f"written: {store.write(record, rubin.RECORD, lines=('results',), digits=4)}")
        return 0
    told = differences(record, rubin.kept())
    print(*(told or ["all as recorded"]), sep="\n")
    return 1 if told else 0


if __name__ == "__main__":
    sys.exit(main())
