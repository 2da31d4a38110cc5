"""Figures, comparisons and marks as lines for a terminal."""

import math
from collections.abc import Sequence

from verification.benchmarks.figure import Figure
from verification.benchmarks.judge import BAD, BAND, NEW, Line, Mark
from verification.benchmarks.records import Record
from verification.harness.command import aligned

STEP = "particle-step"


def told(value: float, unit: str) -> str:
    """A value with three digits and a unit that suits it."""
    if not math.isfinite(value):
        return "-"
    if unit == "s":
        for factor, name in ((1.0, "s"), (1e3, "ms"), (1e6, "us"), (1e9, "ns")):
            if value * factor >= 1.0 or name == "ns":
                return f"{_three(value * factor)} {name}"
    return f"{_three(value)} {unit}".rstrip()


def _three(value: float) -> str:
    """Three digits, no exponent where it can be helped."""
    return f"{value:.0f}" if value >= 100.0 else f"{value:.3g}"


def share(value: float | None) -> str:
    """A share in per cent."""
    return "" if value is None else f"{100.0 * value:.0f} %"


def cost(figure: Figure) -> str:
    """A figure's cost in words: particle-steps as a rate."""
    if not figure.values:
        return "-"
    if figure.per == STEP:
        return f"{1e-6 / figure.median:.1f} M/s"
    return told(figure.median, figure.unit)


def figure_row(figure: Figure, line: Line | None) -> list[str]:
    """The cells of a figure: name, cost, spread, shares of core and memory, ratio to the last record, verdict."""
    shares = [share(figure.share_of_peak), share(figure.share_of_stream)]
    ratio = "" if line is None or not math.isfinite(line.ratio) else f"{line.ratio:.2f}"
    verdict = figure.problem[:60] if figure.problem else "" if line is None or line.verdict == NEW else line.verdict
    error = figure.about.get("error")
    note = f"K_I {100.0 * float(error):+.3f} %" if error is not None else ""
    return [figure.name, cost(figure), share(figure.spread if len(figure.values) > 1 else None), *shares, ratio, verdict or note]


HEADER = ["figure", "cost", "spread", "of peak", "of stream", "now/then", ""]


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Columns under their headings, the first and the last flush left."""
    return aligned([header, *rows], range(1, len(header) - 1))


def calibration_line(record: Record) -> str:
    """What the machine itself gave, over all figures."""

    def ranged(figures: Sequence[Figure], rate: str, unit: str, size: float, digits: int = 1) -> list[str]:
        values = sorted(value / size for figure in figures for value in getattr(figure, rate))
        words = [f"{value:.{digits}f}" for value in (values[len(values) // 2], values[0], values[-1])] if values else []
        return [f"{words[0]} {unit} ({words[1]} to {words[2]})"] if words else []

    parts = []
    for threads in sorted({figure.threads for figure in record.figures if figure.peak_flop_s}):
        own = [figure for figure in record.figures if figure.threads == threads]
        rates = [*ranged(own, "peak_flop_s", "GFlop/s", 1e9), *ranged(own, "stream_B_s", "GB/s", 1e9)]
        rates += ranged([figure for figure in own if threads > 1], "round_trip_s", "ns between processors and back", 1e-9, 0)
        parts.append(f"{threads} thread{'s' if threads > 1 else ''}: {', '.join(rates)}")
    return "calibration beside the figures, median (range): " + "; ".join(parts)


def mark_row(mark: Mark) -> list[str]:
    """The cells of a mark."""
    found = "-" if not math.isfinite(mark.found) else f"{_three(mark.found)} {mark.unit}".rstrip()
    wanted = f"{'at least' if mark.at_least else 'at most'} {mark.wanted:g} {mark.unit}".rstrip()
    return [mark.what, found, wanted, "reached" if mark.reached else "FALLS SHORT", mark.note[:70]]


def report(record: Record, lines: Sequence[Line], then: Record | None, marks: Sequence[Mark]) -> list[str]:
    """All that is said at the end."""
    of = {line.name: line for line in lines}
    said = [
        f"machine: {record.machine.cpu}, {record.machine.cores} cores, {record.machine.caches}",
        f"build:   {record.build.version} {record.build.commit}, {record.build.compiler} {record.build.flags}",
        f"load:    average {record.load.average:.2f} at the start, others used {record.load.busy_before:.2f} processors just before,"
        f" {record.load.busy_after:.2f} just after",
    ]
    if any(figure.peak_flop_s for figure in record.figures):
        said.append(calibration_line(record))
    said += ["", *table(HEADER, [figure_row(figure, of.get(figure.name)) for figure in record.figures])]
    rows = [mark_row(mark) for mark in marks]
    said += ["", *(table(["mark (2 cores)", "found", "wanted", "", ""], rows) if rows else ["no marks: they need more figures"])]
    if then is None:
        said += ["", "nothing recorded on this machine to compare with"]
    else:
        bad = [line for line in lines if line.verdict in BAD]
        same = (then.build.compiler, then.build.flags) == (record.build.compiler, record.build.flags)
        built = f"{then.build.version} {then.build.commit}{'' if same else ', by another compiler or flags'}"
        said += ["", f"against {then.date}, {built}: calibrated costs, band {BAND:g}"]
        said += [f"  {line.verdict.upper()}: {line.name}: {line.why}" for line in bad] or ["  nothing slower, nothing missing"]
    return said
