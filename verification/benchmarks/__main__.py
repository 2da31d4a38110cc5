"""Times kernels, events and whole runs, beside what the machine gives at the same time. See ci/bench --help."""

import argparse
import datetime
import re
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from verification.benchmarks import kernels, runs
from verification.benchmarks.figure import Figure
from verification.benchmarks.judge import BAD, SLOWER, Line, as_plain, compare, marks
from verification.benchmarks.machine import Load, busy_processors, this_build, this_machine
from verification.benchmarks.records import BadRecord, OtherMachine, Record, append, as_json, broken, last_record, why_not_recorded
from verification.benchmarks.table import report
from verification.harness.paths import RUNS

LAST = RUNS / "bench" / "last.json"
REPETITIONS = 5
OK, WORSE, WRONG_USE, NOT_RECORDED = 0, 1, 2, 4

# What --quick takes of the kernels: the marks on speed, and one of every kind of event.
QUICK_KERNELS = re.compile(r"step/\w+/\w+/flip/\w+/points4/cells80/|stage/|growth/explicit|contact/.*cells80|flow/.*cells80|write/")


def parse(arguments: Sequence[str] | None) -> argparse.Namespace:
    """The options."""
    parser = argparse.ArgumentParser(prog="ci/bench", description=__doc__)
    parser.add_argument("--kernels", action="store_true", help="kernels and events only")
    parser.add_argument("--runs", action="store_true", help="whole runs only")
    parser.add_argument("--quick", action="store_true", help="fewer figures in fewer repetitions, under a minute; never recorded")
    parser.add_argument("--long", action="store_true", help="the experiments at 0.25 m as well, and explicit ones to their end")
    parser.add_argument("--only", default="", metavar="REGEX", help="figures whose names match")
    parser.add_argument("--record", action="store_true", help="keep what was measured in verification/benchmarks/records/")
    parser.add_argument("--force", action="store_true", help="record although the machine is busy")
    parser.add_argument("--list", action="store_true", help="names of the kernels, nothing run")
    parser.add_argument("--load", type=float, default=None, help=argparse.SUPPRESS)  # load average when ci/bench began
    parser.add_argument("--out", type=Path, default=LAST, help="where the figures go (default: runs/bench/last.json)")
    return parser.parse_args(arguments)


def progress() -> Callable[[str], None]:
    """What tells a line with the seconds since now."""
    start = time.monotonic()
    return lambda words: print(f"[{time.monotonic() - start:5.0f} s] {words}", file=sys.stderr, flush=True)


def kernel_figures(options: argparse.Namespace, tell: runs.Tell) -> tuple[list[Figure], dict[str, str]]:
    """Figures of strata_bench, and its context."""
    chosen = [name for name in kernels.names() if not name.startswith("calibration/") and re.search(options.only, name)]
    if options.quick:
        chosen = [name for name in chosen if QUICK_KERNELS.match(name)]
    if not chosen:
        return [], {}
    return kernels.measure(chosen, 2 if options.quick else REPETITIONS, tell)


def run_figures(options: argparse.Namespace, tell: runs.Tell) -> list[Figure]:
    """Figures of whole runs."""
    quick, repetitions = options.quick, 2 if options.quick else REPETITIONS
    batches = runs.QUICK if quick else runs.LONG if options.long else runs.DEFAULT
    both = partial(kernels.rates, runs.JOBS)  # of as many threads as a batch has runs side by side
    parts = [
        ("crack/", lambda: runs.crack_figures(repetitions, quick, kernels.rates, tell)),
        ("whole/", lambda: runs.growth_figures(repetitions, quick, kernels.rates, tell)),
        ("memory/", lambda: runs.memory_figures(quick, tell)),
        *((f"{batch.name}/", lambda batch=batch: runs.batch_figures(batch, both, tell)) for batch in batches),
    ]
    return [figure for name, make in parts if re.search(options.only, name) for figure in make()]


def take_record(options: argparse.Namespace, tell: runs.Tell) -> Record:
    """Measure what was asked for."""
    average = options.load if options.load is not None else float(Path("/proc/loadavg").read_text().split()[0])
    busy = busy_processors()
    figures: list[Figure] = []
    context: dict[str, str] = {}
    if options.kernels or not options.runs:
        figures, context = kernel_figures(options, tell)
    if options.runs or not options.kernels:
        figures += run_figures(options, tell)
    part = bool(options.quick or options.only or options.kernels != options.runs)
    date = datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds")
    return Record(this_machine(), this_build(context), Load(average, busy, busy_processors()), date, tuple(figures), part)


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, compare, record; 0 where nothing is slower, 1 where something is, 2 wrong use, 4 not recorded."""
    options = parse(arguments)
    if options.quick and (options.record or options.long):
        print("ci/bench: --quick goes with neither --record nor --long", file=sys.stderr)
        return WRONG_USE
    tell = progress()
    try:
        re.compile(options.only)
        if options.list:
            print("\n".join(kernels.names()))
            return OK
        record = take_record(options, tell)
    except (re.error, kernels.NoBenchmark) as error:
        print(f"ci/bench: {error}", file=sys.stderr)
        return WRONG_USE
    if not record.figures:
        print(f"ci/bench: no figure matches {options.only}", file=sys.stderr)
        return WRONG_USE
    found = marks(record)
    record = replace(record, marks=as_plain(found))
    lines: list[Line] = []
    then, why = None, ""
    try:
        then = last_record(record.machine)
        lines = compare(record, then) if then else []
    except (OtherMachine, BadRecord) as error:
        why = str(error)
    print("\n".join(report(record, lines, then, found)))
    options.out.parent.mkdir(parents=True, exist_ok=True)
    options.out.write_text(as_json(record) + "\n", encoding="utf-8")
    print(f"figures: {options.out}")
    if why:
        print(f"ci/bench: not compared: {why}", file=sys.stderr)
    noisy = record.load.noisy
    if noisy:
        print(f"ci/bench: {noisy}: these are no results, and nothing is judged by them", file=sys.stderr)
    kept, reasons = OK, why_not_recorded(record)
    if options.record and reasons and not options.force:
        print(f"ci/bench: not recorded: {'; '.join(reasons)}", file=sys.stderr)
        kept = NOT_RECORDED
    elif options.record:
        print(f"recorded: {append(record)}")
    worse = any(line.verdict in BAD and (not noisy or line.verdict != SLOWER) for line in lines)
    return WORSE if worse or broken(record) else kept


if __name__ == "__main__":
    sys.exit(main())
