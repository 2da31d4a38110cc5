"""The part of the page of verification on speed: what ci/bench recorded last, as charts and a table of marks."""

import json
from pathlib import Path
from typing import Any

from reports.charts.parts import draw_events, draw_rates, draw_scaling
from reports.figures import Figure, Section, Table
from reports.shown import Shown
from reports.words import NONE, listed, mechanics_name, number
from verification.benchmarks.figure import exponent

RECORDS = Path("verification") / "benchmarks" / "records"  # from the folder that the folder of runs stands in
SHAPES = {"bspline2": "quadratic B-spline", "gimp": "uGIMP", "linear": "linear"}
MARKS_M_S = {("updated", 1): 60.0, ("updated", 2): 110.0, ("total", 1): 300.0}  # million particle-steps a second, 80 x 80 cells
Figures = dict[str, dict[str, Any]]


def section(runs: Path) -> Section | None:
    """The part of the page, from the newest record of any machine; None where nothing was recorded."""
    record = newest(runs.resolve().parent / RECORDS)
    if record is None:
        return None
    measured: Figures = {item["name"]: item for item in record["figures"] if item["values"]}
    rates, scaling, events = rate_figure(measured), scaling_figure(measured), event_figure(measured)
    drawn = (("rates", rates, draw_rates, rates.panels), ("scaling", scaling, draw_scaling, scaling.panels),
             ("events", events, draw_events, events.events))
    figures = [Figure(f"benchmark_{name}", data, draw, f"benchmark_{name}") for name, data, draw, any_ in drawn if any_]
    tables = [table for table in (mark_table(record["marks"]), run_table(record["figures"])) if table["rows"]]
    return Section(title="Speed", intro=_intro(record), figures=figures, tables=tables)


def newest(folder: Path) -> dict[str, Any] | None:
    """The last record of the machine that recorded last, as it was written."""
    files = [[line for line in path.read_text(encoding="utf-8").splitlines() if line.strip()] for path in sorted(folder.glob("*.jsonl"))]
    return max((json.loads(lines[-1]) for lines in files if lines), key=lambda record: record["date"], default=None)


def _intro(record: dict[str, Any]) -> str:
    """Which marks are reached, and on what."""
    machine, build = record["machine"], record["build"]
    short = [mark["what"] for mark in record["marks"] if not mark["reached"]]
    count = len(record["marks"])
    words = f"{count - len(short)} of {count} marks are reached" + (f"; not {listed(short)}" if short else "")
    where = f"{machine['cpu']}, {machine['cores']} cores, {machine['caches']}; {build['compiler']} {build['flags']}"
    return f"{words}. Recorded {record['date'][:10]} by ci/bench on {where}; strata {build['version']} {build['commit']}."


def _bounds(figure: dict[str, Any]) -> tuple[float, float, float]:
    """Median, least and most."""
    return figure["median"], min(figure["values"]), max(figure["values"])


def rate_figure(figures: Figures) -> Shown:
    """Rates (million particle-steps a second, with least and most, and share of the cores' peak) of the kinematics, shapes, kernels and threads
    that were measured on the block of 80 x 80 cells, and the marks by threads."""
    panels, best = [], []
    for kinematics in ("updated", "total"):
        shapes = []
        for shape, words in SHAPES.items():
            bars = []
            for kernels, threads in (("fast", 1), ("fast", 2), ("plain", 1), ("plain", 2)):
                figure = figures.get(f"step/{kinematics}/{shape}/flip/{kernels}/points4/cells80/threads{threads}")
                if figure is not None:
                    rate, high, low = (1e-6 / seconds for seconds in _bounds(figure))
                    bars.append(Shown(kernels=kernels, threads=threads, rate=rate, low=low, high=high, share=figure["share_of_peak"]))
            if bars:
                shapes.append((words, bars))
        if shapes:
            marks = {threads: value for (name, threads), value in MARKS_M_S.items() if name == kinematics}
            panels.append(Shown(heading=f"kinematics = {kinematics}", shapes=shapes, marks=marks))
            single = [bar.rate for _, bars in shapes for bar in bars if bar.threads == 1]
            best += [f"{number(max(single), 3)} million with {kinematics} kinematics"] if single else []
    return Shown(title=f"Particle-steps a second on one thread: up to {listed(best)}" if best else "No rates", panels=panels)


def scaling_figure(figures: Figures) -> Shown:
    """How costs grow: explicit steps by kinematics, and whole runs without inertia, each panel with the exponent that it may have."""
    steps = [curve for kinematics in ("updated", "total") if (curve := _step_curve(figures, kinematics)) is not None]
    runs = [figure for name, figure in figures.items() if name.startswith("whole/quasistatic/")]
    whole = _curve("Experiment 1, soft interface", [(float(figure["about"]["particles"]), figure["median"]) for figure in runs])
    panels = [Shown(heading="a step with inertia, 1 thread", curves=steps, allowed=1.0)] if steps else []
    panels += [Shown(heading="a run without inertia", curves=[whole], allowed=1.5)] if whole else []
    told = [f"{curve.exponent:.2f} ({curve.label})" for panel in panels for curve in panel.curves]
    return Shown(title=f"Costs grow with the number of points to the power {listed(told)}", panels=panels)


def _step_curve(figures: Figures, kinematics: str) -> Shown | None:
    """Seconds a step of the blocks of several sizes."""
    found = []
    for name, figure in figures.items():
        parts = name.split("/")
        if parts[0] in ("step", "scaling") and parts[1:6] == [kinematics, "bspline2", "flip", "fast", "points4"] and parts[-1] == "threads1":
            points = float(figure["about"]["particles"])
            found.append((points, figure["median"] * points))
    return _curve(kinematics, found)


def _curve(label: str, found: list[tuple[float, float]]) -> Shown | None:
    """Cost (s) against points, in order of size, with the exponent of a power law by least squares; None of fewer than two sizes."""
    found = sorted(found)
    if len(found) < 2:
        return None
    points, seconds = zip(*found)
    return Shown(label=label, points=points, seconds=seconds, exponent=exponent(points, seconds))


_EVENT_KINDS = {"growth": "growth", "start": "start of a run", "contact": "contact", "flow": "flow step", "write": "writing"}
_TOLD = ("growth/explicit/updated", "growth/explicit/total", "growth/quasistatic/cells80")  # by the title


def event_figure(figures: Figures) -> Shown:
    """Events and the measurement of tips (name; s: median, least, most), the dearest first."""
    found = []
    for name, figure in figures.items():
        kind, *rest = name.split("/")
        if kind in _EVENT_KINDS:
            found.append((f"{_EVENT_KINDS[kind]}: {_event_words(rest)}", *_bounds(figure)))
        elif name == "stage/measure_tips/threads1":
            found.append(("J and K at a tip", *_bounds(figure)))
    told = [number(1e3 * figures[name]["median"], 2) + f"\u00a0ms ({_event_words(name.split('/')[1:])})" for name in _TOLD if name in figures]
    title = f"An increment of growth costs {listed(told)}" if told else "What events cost"
    return Shown(title=title, events=sorted(found, key=lambda item: -item[1]))


def _event_words(parts: list[str]) -> str:
    """The rest of an event's name in words."""
    words = [f"{part[5:]}² cells" if part.startswith("cells") else part for part in parts]
    return ", ".join(mechanics_name(word) if word in ("explicit", "quasistatic") else word for word in words)


def mark_table(marks: list[dict[str, Any]]) -> Table:
    """What was to be reached on two cores, and what was found."""
    rows, marked = [], []
    for mark in marks:
        found = NONE if mark["found"] is None else f"{number(mark['found'], 3)} {mark['unit']}".rstrip()
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
        value = NONE if not figure["values"] else f"{number(figure['median'], 3)} {figure['unit']}"
        if not figure["values"]:
            marked.append(len(rows))
        spread = "" if figure["spread"] is None or len(figure["values"]) < 2 else f"{100.0 * figure['spread']:.0f}\u00a0%"
        told = figure["problem"] or (f"K_I {100.0 * error:+.3f}\u00a0%" if error is not None else "")
        rows.append([figure["name"], value, figure["per"], str(len(figure["values"])), spread, told])
    return Table(title="Whole runs", header=["What", "Median", "of", "Repetitions", "Spread", ""], rows=rows, marked=marked,
                 note="Spread: (most − least)/median. A run that did not come to its end has no time.")
