"""Times kernels, events and whole runs, beside what the machine gives at the same time. See ci/bench --help."""

import argparse
import datetime
import math
import re
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from verification.benchmarks import machine, measure
from verification.benchmarks.machine import BAD, BAND, NEW, SLOWER, STEP, Figure, Line, Load, Record, busy_processors, compare, marks, this_build, this_machine
from verification.harness.command import aligned, command
from verification.harness.paths import RUNS

LAST = RUNS / "bench" / "last.json"
REPETITIONS = 5
OK, WORSE, WRONG_USE, NOT_RECORDED = 0, 1, 2, 4

# What --quick takes of the kernels: the marks on speed, and one of every kind of event.
QUICK_KERNELS = re.compile(r"step/\w+/\w+/flip/\w+/points4/cells80/|stage/|growth/explicit|contact/.*cells80|flow/.*cells80|write/")


def parse(arguments: Sequence[str] | None) -> argparse.Namespace:
    """The options."""
    parser = command("ci/bench", __doc__, "list", "out", out=LAST)
    parser.add_argument("--kernels", action="store_true", help="kernels and events only")
    parser.add_argument("--runs", action="store_true", help="whole runs only")
    parser.add_argument("--quick", action="store_true", help="fewer figures in fewer repetitions, under a minute; never recorded")
    parser.add_argument("--long", action="store_true", help="the experiments at 0.25 m as well, and explicit ones to their end")
    parser.add_argument("--only", default="", metavar="REGEX", help="figures whose names match")
    parser.add_argument("--record", action="store_true", help="keep what was measured in verification/benchmarks/records/")
    parser.add_argument("--force", action="store_true", help="record although the machine is busy")
    parser.add_argument("--load", type=float, default=None, help=argparse.SUPPRESS)  # load average when ci/bench began
    return parser.parse_args(arguments)


def measured(options: argparse.Namespace) -> Record:
    """Measure what was asked for."""
    average = options.load if options.load is not None else float(Path("/proc/loadavg").read_text().split()[0])
    busy, repetitions = busy_processors(), 2 if options.quick else REPETITIONS
    figures, context = [], {}
    if options.kernels or not options.runs:
        chosen = [name for name in measure.names() if not name.startswith("calibration/") and re.search(options.only, name)
                  and (not options.quick or QUICK_KERNELS.match(name))]  # fmt: skip
        figures, context = measure.measure(chosen, repetitions) if chosen else ([], {})
    if options.runs or not options.kernels:
        for whole in measure.wholes(options.quick, options.long, repetitions):
            if re.search(options.only, whole.name):
                figures.append(measure.whole_figure(whole))
                print(f"{whole.name}: {figures[-1].problem or f'{figures[-1].median:.3g} s'}", file=sys.stderr, flush=True)
    part = bool(options.quick or options.only or options.kernels != options.runs)
    date = datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds")
    found = Record(this_machine(), this_build(context), Load(average, busy, busy_processors()), date, tuple(figures), part)
    return replace(found, marks=marks(found))


# --- words
def told(value: float, unit: str) -> str:
    """A value with three digits and a unit that suits it."""
    if not math.isfinite(value):
        return "-"
    if unit == "s":
        factor, unit = next((one for one in ((1.0, "s"), (1e3, "ms"), (1e6, "us")) if value * one[0] >= 1.0), (1e9, "ns"))
        value *= factor
    return f"{value:.0f} {unit}".rstrip() if value >= 100.0 else f"{value:.3g} {unit}".rstrip()


def share(value: float | None) -> str:
    """A share in per cent."""
    return "" if value is None else f"{100.0 * value:.0f} %"


def figure_row(figure: Figure, line: Line | None) -> list[str]:
    """The cells of a figure: name, cost (particle-steps as a rate), spread, shares of core and memory, ratio to the last record, verdict."""
    cost = "-" if not figure.values else f"{machine.rate(figure):.1f} M/s" if figure.per == STEP else told(figure.median, figure.unit)
    ratio = "" if line is None or not math.isfinite(line.ratio) else f"{line.ratio:.2f}"
    verdict = figure.problem[:60] or ("" if line is None or line.verdict == NEW else line.verdict)
    return [figure.name, cost, share(figure.spread if len(figure.values) > 1 else None), share(figure.share_of_peak),
            share(figure.share("byte_a_unit", figure.stream_B_s)), ratio, verdict]  # fmt: skip


def calibration_line(now: Record) -> str:
    """What the machine itself gave beside the figures: the median rates by threads."""
    parts = []
    for threads in sorted({figure.threads for figure in now.figures if figure.peak_flop_s}):
        own = [figure for figure in now.figures if figure.threads == threads]
        words = []
        for rate, unit, size in (("peak_flop_s", "GFlop/s", 1e9), ("stream_B_s", "GB/s", 1e9), ("round_trip_s", "ns between processors", 1e-9)):
            if values := sorted(value / size for figure in own for value in getattr(figure, rate)):
                words.append(f"{values[len(values) // 2]:.1f} {unit} ({values[0]:.1f} to {values[-1]:.1f})")
        parts.append(f"{threads} threads: {', '.join(words)}")
    return f"calibration beside the figures, median (range): {'; '.join(parts)}"


def report(now: Record, lines: Sequence[Line], then: Record | None) -> list[str]:
    """All that is said at the end."""
    of, built, load = {line.name: line for line in lines}, now.build, now.load
    rows = [figure_row(figure, of.get(figure.name)) for figure in now.figures]
    kept = [[one["what"], told(one["found"], one["unit"]), f"{'at least' if one['at_least'] else 'at most'} {told(one['wanted'], one['unit'])}",
             "reached" if one["reached"] else "FALLS SHORT", one["note"][:70]] for one in now.marks]  # fmt: skip
    said = [
        f"machine: {now.machine.words}", f"build:   {built.version} {built.commit}, {built.compiler} {built.flags}",
        f"load:    average {load.average:.2f} at the start, others used {load.busy_before:.2f} processors before, {load.busy_after:.2f} after",
        calibration_line(now), "", *aligned([["figure", "cost", "spread", "of peak", "of stream", "now/then", ""], *rows], range(1, 6)),
        "", *aligned([["mark (2 cores)", "found", "wanted", "", ""], *kept], range(1, 4)), "",
    ]  # fmt: skip
    if then is None:
        return [*said, "nothing recorded on this machine to compare with"]
    bad = [f"  {line.verdict.upper()}: {line.name}: {line.why}" for line in lines if line.verdict in BAD]
    other = "" if (then.build.compiler, then.build.flags) == (built.compiler, built.flags) else ", by another compiler or flags"
    return [*said, f"against {then.date}, {then.build.version} {then.build.commit}{other}: calibrated costs, band {BAND:g}",
            *(bad or ["  nothing slower, nothing missing"])]  # fmt: skip


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, compare, record; 0 where nothing is slower, 1 where something is, 2 wrong use, 4 not recorded."""
    options = parse(arguments)
    try:
        re.compile(options.only)
        if options.quick and (options.record or options.long):
            raise measure.NoBenchmark("--quick goes with neither --record nor --long")
        if options.list:
            print("\n".join(measure.names()))
            return OK
        now = measured(options)
        if not now.figures:
            raise measure.NoBenchmark(f"no figure matches {options.only}")
    except (re.error, measure.NoBenchmark) as error:
        print(f"ci/bench: {error}", file=sys.stderr)
        return WRONG_USE
    then = None
    try:
        then = machine.last_of(now.machine)
    except ValueError as error:
        print(f"ci/bench: not compared: {error}", file=sys.stderr)
    lines = compare(now, then) if then else []
    print("\n".join(report(now, lines, then)))
    options.out.parent.mkdir(parents=True, exist_ok=True)
    options.out.write_text(machine.as_json(now) + "\n", encoding="utf-8")
    print(f"figures: {options.out}")
    noisy, reasons, kept = now.load.noisy, now.why_not_kept(), OK
    if noisy:
        print(f"ci/bench: {noisy}: these are no results, and nothing is judged by them", file=sys.stderr)
    if options.record and reasons and not options.force:
        print(f"ci/bench: not recorded: {'; '.join(reasons)}", file=sys.stderr)
        kept = NOT_RECORDED
    elif options.record:
        print(f"recorded: {machine.append(now)}")
    worse = any(line.verdict in BAD and (not noisy or line.verdict != SLOWER) for line in lines)
    return WORSE if worse or now.broken() else kept


if __name__ == "__main__":
    sys.exit(main())
