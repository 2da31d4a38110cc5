"""The part of the page of verification on speed: what ci/bench recorded last, as charts and a table of marks."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from reports.charts.benchmark_chart import draw_events, draw_rates, draw_scaling
from reports.sections import Picture, Section, Table, put_figure
from reports.words import listed, mechanics_name, number

# Where records are, from the folder that the folder of runs stands in.
RECORDS = Path("verification") / "benchmarks" / "records"

SHAPES = {"bspline2": "quadratic B-spline", "gimp": "uGIMP", "linear": "linear"}
MARKS_M_S = {("updated", 1): 60.0, ("updated", 2): 110.0, ("total", 1): 300.0}  # million particle-steps a second, 80 x 80 cells


@dataclass(frozen=True)
class Bar:
    """A rate (million particle-steps a second) of a kernel and a number of threads, with its least and most."""

    kernels: str
    threads: int
    rate: float
    low: float
    high: float
    share: float | None  # of the cores' peak


@dataclass(frozen=True)
class RatePanel:
    """The rates of one kinematics: shape functions with their bars, and the marks by threads."""

    heading: str
    shapes: tuple[tuple[str, tuple[Bar, ...]], ...]
    marks: dict[int, float]


@dataclass(frozen=True)
class RateFigure:
    """Rates of explicit steps; the title is the finding."""

    title: str
    panels: tuple[RatePanel, ...]


@dataclass(frozen=True)
class Curve:
    """Cost (s) against points, in order of size, with the exponent of a power law through all of them."""

    label: str
    points: tuple[float, ...]
    seconds: tuple[float, ...]
    exponent: float


@dataclass(frozen=True)
class ScalingPanel:
    """Curves of one kind, and the exponent that they may have."""

    heading: str
    curves: tuple[Curve, ...]
    allowed: float


@dataclass(frozen=True)
class ScalingFigure:
    """How costs grow; the title is the finding."""

    title: str
    panels: tuple[ScalingPanel, ...]


@dataclass(frozen=True)
class EventFigure:
    """Costs of events (s): name, median, least and most, the dearest first."""

    title: str
    events: tuple[tuple[str, float, float, float], ...]


Figures = dict[str, dict[str, Any]]


def section(runs: Path, out: Path) -> Section | None:
    """The part of the page, from the newest record of any machine; None where nothing was recorded."""
    record = newest(runs.resolve().parent / RECORDS)
    if record is None:
        return None
    figures: Figures = {item["name"]: item for item in record["figures"] if item["values"]}
    pictures: list[Picture] = []
    rates, scaling, events = rate_figure(figures), scaling_figure(figures), event_figure(figures)
    if rates.panels:
        pictures.append(put_figure(draw_rates(rates), out, "benchmark_rates", rates.title, _RATE_CAPTION))
    if scaling.panels:
        pictures.append(put_figure(draw_scaling(scaling), out, "benchmark_scaling", scaling.title, _SCALING_CAPTION))
    if events.events:
        pictures.append(put_figure(draw_events(events), out, "benchmark_events", events.title, _EVENT_CAPTION))
    tables = [mark_table(record["marks"]), run_table(record["figures"])]
    return Section(title="Speed", intro=_intro(record), figures=pictures, tables=[table for table in tables if table["rows"]])


_RATE_CAPTION = (
    "Explicit steps of a block of 80 × 80 cells of 4 points with a pressurised crack: medians, with least and most as whiskers; above"
    " each bar the share of the cores' peak that the counted flop make (of the total formulation: those of its form with points)."
    " Dashes: the marks."
)
_SCALING_CAPTION = (
    "Cost against the number of points, both logarithmic, with the exponent of a power law fitted to all sizes. Dashed, from the"
    " smallest size: linear growth for a step, the power 1.5 for a run without inertia, neither to be exceeded."
)
_EVENT_CAPTION = (
    "What happens now and then in a run, on one thread, on a block of 80 × 80 cells and of more: medians (dots) with least and most."
    " Growth with inertia: the step in which the fracture grows less an ordinary one; without: the whole step, with its equilibria."
)


def newest(folder: Path) -> dict[str, Any] | None:
    """The last record of the machine that recorded last, as it was written."""
    found = []
    for path in sorted(folder.glob("*.jsonl")):
        lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line.strip()]
        found += [json.loads(lines[-1])] if lines else []
    return max(found, key=lambda record: record["date"], default=None)


def _intro(record: dict[str, Any]) -> str:
    """Which marks are reached, and on what."""
    machine, build = record["machine"], record["build"]
    short = [mark["what"] for mark in record["marks"] if not mark["reached"]]
    reached = len(record["marks"]) - len(short)
    words = f"{reached} of {len(record['marks'])} marks are reached" + (f"; not {listed(short)}" if short else "")
    where = f"{machine['cpu']}, {machine['cores']} cores, {machine['caches']}; {build['compiler']} {build['flags']}"
    return f"{words}. Recorded {record['date'][:10]} by ci/bench on {where}; strata {build['version']} {build['commit']}."


def _bounds(figure: dict[str, Any]) -> tuple[float, float, float]:
    """Median, least and most."""
    return figure["median"], min(figure["values"]), max(figure["values"])


def rate_figure(figures: Figures) -> RateFigure:
    """Bars of the kinematics, shapes, kernels and threads that were measured on the block of 80 x 80 cells."""
    panels = []
    for kinematics in ("updated", "total"):
        shapes = []
        for shape, words in SHAPES.items():
            bars = []
            for kernels in ("fast", "plain"):
                for threads in (1, 2):
                    figure = figures.get(f"step/{kinematics}/{shape}/flip/{kernels}/points4/cells80/threads{threads}")
                    if figure is not None:
                        middle, low, high = _bounds(figure)
                        bars.append(Bar(kernels, threads, 1e-6 / middle, 1e-6 / high, 1e-6 / low, figure["share_of_peak"]))
            if bars:
                shapes.append((words, tuple(bars)))
        if shapes:
            marks = {threads: value for (name, threads), value in MARKS_M_S.items() if name == kinematics}
            panels.append(RatePanel(f"kinematics = {kinematics}", tuple(shapes), marks))
    return RateFigure(_rate_title(panels), tuple(panels))


def _rate_title(panels: list[RatePanel]) -> str:
    """The best rates on one thread."""
    best = []
    for panel in panels:
        single = [bar.rate for _, bars in panel.shapes for bar in bars if bar.threads == 1]
        if single:
            best.append(f"{number(max(single), 3)} million with {panel.heading.split()[-1]} kinematics")
    return f"Particle-steps a second on one thread: up to {listed(best)}" if best else "No rates"


def scaling_figure(figures: Figures) -> ScalingFigure:
    """Explicit steps by kinematics, and whole runs without inertia."""
    steps = [curve for kinematics in ("updated", "total") if (curve := _step_curve(figures, kinematics)) is not None]
    runs = [figure for name, figure in figures.items() if name.startswith("whole/quasistatic/")]
    whole = _curve("Experiment 1, soft interface", [(float(figure["about"]["particles"]), figure["median"]) for figure in runs])
    panels = [ScalingPanel("a step with inertia, 1 thread", tuple(steps), 1.0)] if steps else []
    panels += [ScalingPanel("a run without inertia", (whole,), 1.5)] if whole else []
    told = [f"{curve.exponent:.2f} ({curve.label})" for panel in panels for curve in panel.curves]
    return ScalingFigure(f"Costs grow with the number of points to the power {listed(told)}", tuple(panels))


def _step_curve(figures: Figures, kinematics: str) -> Curve | None:
    """Seconds a step of the blocks of several sizes."""
    found = []
    for name, figure in figures.items():
        parts = name.split("/")
        own = parts[1:6] == [kinematics, "bspline2", "flip", "fast", "points4"] and parts[-1] == "threads1"
        if parts[0] in ("step", "scaling") and own:
            points = float(figure["about"]["particles"])
            found.append((points, figure["median"] * points))
    return _curve(kinematics, found)


def _curve(label: str, found: list[tuple[float, float]]) -> Curve | None:
    """A curve with its exponent by least squares; None of fewer than two sizes."""
    found = sorted(found)
    if len(found) < 2:
        return None
    x, y = [math.log(points) for points, _ in found], [math.log(seconds) for _, seconds in found]
    mean_x, mean_y = math.fsum(x) / len(x), math.fsum(y) / len(y)
    slope = math.fsum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / math.fsum((a - mean_x) ** 2 for a in x)
    return Curve(label, tuple(points for points, _ in found), tuple(seconds for _, seconds in found), slope)


_EVENT_KINDS = {"growth": "growth", "start": "start of a run", "contact": "contact", "flow": "flow step", "write": "writing"}


def event_figure(figures: Figures) -> EventFigure:
    """Events and the measurement of tips, the dearest first."""
    found = []
    for name, figure in figures.items():
        kind, *rest = name.split("/")
        if kind in _EVENT_KINDS:
            found.append((f"{_EVENT_KINDS[kind]}: {_event_words(rest)}", *_bounds(figure)))
        elif name == "stage/measure_tips/threads1":
            found.append(("J and K at a tip", *_bounds(figure)))
    found.sort(key=lambda item: -item[1])
    growth = {name: figures[f"growth/{name}"]["median"] for name in ("explicit/updated", "explicit/total", "quasistatic/cells80")
              if f"growth/{name}" in figures}  # fmt: skip
    told = [f"{number(1e3 * seconds, 2)}\u00a0ms ({_event_words(name.split('/'))})" for name, seconds in growth.items()]
    return EventFigure(f"An increment of growth costs {listed(told)}" if told else "What events cost", tuple(found))


def _event_words(parts: list[str]) -> str:
    """The rest of an event's name in words."""
    words = [f"{part[5:]}² cells" if part.startswith("cells") else part for part in parts]
    return ", ".join(mechanics_name(word) if word in ("explicit", "quasistatic") else word for word in words)


def mark_table(marks: list[dict[str, Any]]) -> Table:
    """What was to be reached on two cores, and what was found."""
    rows, marked = [], []
    for mark in marks:
        found = "–" if mark["found"] is None else f"{number(mark['found'], 3)} {mark['unit']}".rstrip()
        wanted = f"{'at least' if mark['at_least'] else 'at most'} {number(mark['wanted'], 3)} {mark['unit']}".rstrip()
        if not mark["reached"]:
            marked.append(len(rows))
        rows.append([mark["what"], found, wanted, "reached" if mark["reached"] else "falls short", mark["note"]])
    return Table(title="Marks on two cores", header=["What", "Found", "Wanted", "", ""], rows=rows, marked=marked)


def run_table(figures: list[dict[str, Any]]) -> Table:
    """Whole batches of experiments, the crack in the block, memory a point."""
    rows, marked = [], []
    for figure in figures:
        kind = figure["name"].split("/")[0]
        if kind not in ("crack", "whole", "memory") and figure["per"] != "all variants":
            continue
        error = figure["about"].get("error")
        value = "–" if not figure["values"] else f"{number(figure['median'], 3)} {figure['unit']}"
        if not figure["values"]:
            marked.append(len(rows))
        spread = "" if figure["spread"] is None or len(figure["values"]) < 2 else f"{100.0 * figure['spread']:.0f}\u00a0%"
        told = figure["problem"] or (f"K_I {100.0 * error:+.3f}\u00a0%" if error is not None else "")
        rows.append([figure["name"], value, figure["per"], str(len(figure["values"])), spread, told])
    return Table(title="Whole runs", header=["What", "Median", "of", "Repetitions", "Spread", ""], rows=rows, marked=marked,
                 note="Spread: (most − least)/median. A run that did not come to its end has no time.")  # fmt: skip
