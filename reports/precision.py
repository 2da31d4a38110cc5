"""The work-precision chart: error against wall time for every method, and what follows from it for who uses the solver."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from reports.words import listed, number, share
from verification.precision import store
from verification.precision.judge import TOLERANCES, Advice, Dot, Lack, Panel, advice, bounds, cheapest, in_group, nearest, panel_of, pareto
from verification.precision.problem import STRATA, Method
from verification.precision.problems import PROBLEMS

HOW_TO_MAKE = "ci/chart measures it, one run at a time on an idle machine"
LEAST_SHOWN = 1e-5  # errors below are drawn there


@dataclass(frozen=True)
class Look:
    """How a method is drawn, in words that the chart knows: family (a colour), shape (a mark), graded (filled), dashes."""

    family: str
    shape: str
    filled: bool
    dashes: str


@dataclass(frozen=True)
class CurveShown:
    """A method: wall times (s), errors as judged, and as measured where they are much smaller by luck (else None)."""

    label: str
    look: Look
    main: bool
    times_s: tuple[float, ...]
    errors: tuple[float, ...]
    lucky: tuple[float | None, ...]


@dataclass(frozen=True)
class LackShown:
    """A mark in the strip of failures, at the time (s) that was spent."""

    look: Look
    status: str
    time_s: float


@dataclass(frozen=True)
class PanelShown:
    """A wanted number: its curves, Pareto front (times in s, errors), failures, the reference's uncertainty, and the advice in words."""

    heading: str
    advice: tuple[str, ...]
    curves: tuple[CurveShown, ...]
    front: tuple[tuple[float, ...], tuple[float, ...]]
    chosen: tuple[tuple[float, float], ...]
    lacks: tuple[LackShown, ...]
    lacks_words: str
    uncertainty: float
    times_s: tuple[float, float]
    errors: tuple[float, float]


@dataclass(frozen=True)
class PrecisionFigure:
    """Panels under a finding."""

    title: str
    panels: tuple[PanelShown, ...]


@dataclass(frozen=True)
class Measurements:
    """All that was measured: panels, the machine in words, and notes on what is odd about the data."""

    panels: tuple[Panel, ...]
    recipe: tuple[tuple[str, str], ...]
    notes: tuple[str, ...]


def measurements(folder: Path = store.DATA) -> Measurements | None:
    """What the data say of every problem that was measured; None without any. Raises ValueError for data that cannot be read."""
    sheets = [(problem, sheet) for problem in PROBLEMS if (sheet := store.read(problem.name, folder)) is not None and sheet.points]
    if not sheets:
        return None
    panels = tuple(panel_of(problem, wanted, sheet) for problem, sheet in sheets for wanted in problem.wanted)
    return Measurements(panels, recipe([sheet for _, sheet in sheets]), notes([sheet for _, sheet in sheets]))


def recipe(sheets: Sequence[store.Sheet]) -> tuple[tuple[str, str], ...]:
    """Hardware and method of the measurements, as names with words."""
    points = [point for sheet in sheets for point in sheet.points]
    dates = sorted(point.date for point in points)
    machines = [sheet.machine for sheet in sheets]

    def each(*keys: str) -> str:
        """All that the machines say under some keys."""
        return "; ".join(dict.fromkeys(", ".join(str(one[key]) for key in keys) for one in machines))

    return (
        ("processor", f"{each('processor')}, {each('cores')} cores, {each('caches')}, {each('memory_GB')} GB; {each('system')}"),
        ("compiler", f"{each('compiler')}, {each('flags')}"),
        ("solver", f"strata {each('version')}, revision {each('revision')}"),
        ("measured", f"{dates[0]} to {dates[-1]} UTC, {len(points)} points, {sum(len(point.wall_s) for point in points)} runs that count"),
        ("recipe", "wall time of the whole process on one thread, start and output included, one run at a time on an idle machine; median of"
                   " five runs after a warm-up, of three above 2 s, a single run above 10 s (then marked)"),
    )  # fmt: skip


def notes(sheets: Sequence[store.Sheet]) -> tuple[str, ...]:
    """What is odd about the data: disturbed runs, single runs, several machines or versions."""
    points = [point for sheet in sheets for point in sheet.points]
    found = []
    for count, words in (
        (sum(point.disturbed for point in points), "were disturbed by something else on the machine"),
        (sum(point.once for point in points), "are of a single run"),
    ):
        if count:
            found.append(f"{count} of {len(points)} points {words}")
    for key in ("processor", "revision"):
        several = sorted({str(sheet.machine[key]) for sheet in sheets})
        if len(several) > 1:
            found.append(f"problems were measured with different {key}: {', '.join(several)}")
    missing = [problem.name for problem in PROBLEMS if all(sheet.problem != problem.name for sheet in sheets)]
    if missing:
        found.append(f"not measured: {', '.join(missing)}")
    return tuple(found)


# --- words


def seconds(time_s: float) -> str:
    """A wall time."""
    if time_s >= 100.0:
        return f"{number(time_s / 60.0, 2)}\u00a0min"
    return f"{number(time_s, 2)}\u00a0s"


def percent(error: float) -> str:
    """An error as a percentage."""
    return share(error)


def choice_words(dot: Dot) -> str:
    """A dot as advice: what to use, and what it takes."""
    return f"{dot.name}: {seconds(dot.time_s)}"


def lack_words(best: Dot | None) -> str:
    """What to say where no method is within a tolerance."""
    if best is None:
        return "nothing was measured"
    return f"none reaches it; best {percent(best.judged)}: {choice_words(best)}"


def advice_lines(panel: Panel) -> tuple[str, ...]:
    """The cheapest ways of the solver to 1 % and 0.1 % in a panel."""
    own = [dot for dot in panel.dots if in_group(dot, "any method")]
    lines = []
    for error in TOLERANCES[1:]:
        dot = cheapest(own, error)
        best = nearest(own)
        lack = f"none (best: {percent(best.judged)} in {seconds(best.time_s)})" if best else "nothing was measured"
        lines.append(f"{percent(error)}: {choice_words(dot) if dot else lack}")
    return tuple(lines)


def lacks_words(lacks: Sequence[Lack]) -> str:
    """How many have nothing to show, by how they ended."""
    counts = {status: sum(lack.status == status for lack in lacks) for status in dict.fromkeys(lack.status for lack in lacks)}
    return ", ".join(f"{count} {status}" for status, count in counts.items())


# --- figures


def look_of(method: Method) -> Look:
    """How a method is drawn."""
    setting = method.setting
    if method.program != STRATA or setting is None:
        return Look("elements", "elements", True, "-")
    still = setting.mechanics == "quasistatic"
    family = "quasistatic" if still else "total" if setting.kinematics == "total" else "updated"
    usual = (setting.points, setting.courant, setting.kernels, setting.further) == (4, 0.5, "", ())
    plain = usual and setting.transfer in ("", "flip")
    return Look(family, setting.shape, max(setting.graded, setting.beyond_m) > 0.0, "-" if plain else {9: ":", 16: "--"}.get(setting.points, "-."))


def panel_shown(panel: Panel, spread: tuple[float, float] | None = None) -> PanelShown:
    """A panel as it is drawn; `spread`: the range of times (s) of all panels."""
    curves = []
    for method in panel.problem.methods:
        own = [dot for dot in panel.dots if dot.method is method]
        if own:
            lucky = tuple(max(abs(dot.error), LEAST_SHOWN) if dot.lucky else None for dot in own)
            curves.append(CurveShown(method.label, look_of(method), method.main, tuple(dot.time_s for dot in own),
                                     tuple(max(dot.judged, LEAST_SHOWN) for dot in own), lucky))  # fmt: skip
    solver = [dot for dot in panel.dots if in_group(dot, "any method")]
    front = pareto(solver)
    chosen = [dot for error in TOLERANCES[1:] if (dot := cheapest(solver, error)) is not None]
    every = [error for curve in curves for error in (*curve.errors, *(one for one in curve.lucky if one is not None))]
    return PanelShown(
        panel.wanted.title, advice_lines(panel), tuple(curves),
        (tuple(dot.time_s for dot in front), tuple(max(dot.judged, LEAST_SHOWN) for dot in front)),
        tuple((dot.time_s, max(dot.judged, LEAST_SHOWN)) for dot in chosen),
        tuple(LackShown(look_of(lack.method), lack.status, lack.time_s) for lack in panel.lacks), lacks_words(panel.lacks),
        panel.uncertainty, spread or bounds(dot.time_s for dot in panel.dots), bounds(every),
    )  # fmt: skip


def front_figure(panels: Sequence[Panel]) -> PrecisionFigure:
    """All panels side by side, times on a common scale."""
    spread = bounds(dot.time_s for panel in panels for dot in panel.dots)
    return PrecisionFigure(finding(panels), tuple(panel_shown(panel, spread) for panel in panels))


def full_figure(panel: Panel) -> PrecisionFigure:
    """One wanted number with every method."""
    return PrecisionFigure(f"{panel.wanted.title}: {'; '.join(advice_lines(panel))}", (panel_shown(panel),))


def finding(panels: Sequence[Panel]) -> str:
    """What the chart shows, in a sentence."""
    own = [[dot for dot in panel.dots if in_group(dot, "any method")] for panel in panels]
    found = [dot for dots in own if (dot := cheapest(dots, 0.01)) is not None]
    if not found:
        return "No quantity is had within 1 %"
    still = sum(dot.method.setting is not None and dot.method.setting.mechanics == "quasistatic" for dot in found)
    slowest = max(dot.time_s for dot in found)
    which = "all" if still == len(found) else f"{still}"
    return (
        f"Within 1 %: {len(found)} of {len(panels)} quantities, the cheapest way to each in {seconds(min(dot.time_s for dot in found))} to"
        f" {seconds(slowest)}; {which} of these ways are without inertia"
    )


# --- tables


def advice_rows(rows: Sequence[Advice]) -> list[dict[str, object]]:
    """The table of advice for the template."""
    return [
        {
            "title": row.panel.wanted.title, "group": row.group, "first": row.group == "any method",
            "cells": [
                {"words": choice_words(dot), "error": percent(dot.judged), "ok": True} if dot else
                {"words": lack_words(row.best), "error": "", "ok": False}
                for dot in row.choices
            ],
            "says": row.panel.wanted.says,
        }
        for row in rows
    ]  # fmt: skip


def point_rows(panel: Panel) -> list[list[str]]:
    """Every measured point of a panel, by method and size."""
    rows = []
    for dot in panel.dots:
        point = dot.point
        flags = [word for word, on in (("disturbed", point.disturbed), ("one run", point.once), ("luck", dot.lucky)) if on]
        rows.append([dot.method.label, dot.level, f"{point.particles:,}".replace(",", "\u202f") if point.particles else "–",
                     f"{100.0 * dot.error:+.3g}\u00a0%".replace("-", "−"), percent(dot.judged), number(dot.time_s, 3),
                     _range(point.wall_s), number(min(point.cpu_s), 3) if point.cpu_s else "–", f"{len(point.wall_s)}",
                     ", ".join(flags)])  # fmt: skip
    return rows


def _range(times_s: Sequence[float]) -> str:
    """The spread of repeated times, s."""
    return f"{number(min(times_s), 3)} to {number(max(times_s), 3)}" if len(times_s) > 1 else "–"


def lack_rows(panel: Panel) -> list[list[str]]:
    """Every method and size that has nothing to show, with the reason; sizes of a method with the same reason together."""
    groups: dict[tuple[str, str, str], list[str]] = {}
    for lack in panel.lacks:
        groups.setdefault((lack.method.label, lack.status, lack.reason), []).append(lack.level)
    return [[label, listed(levels), status, reason] for (label, status, reason), levels in groups.items()]


def table_of(panels: Sequence[Panel]) -> list[dict[str, object]]:
    """The table that users need."""
    return advice_rows(advice(panels))


def reference_words(panel: Panel) -> str:
    """What the reference of a panel is, and how well it is known."""
    said = f"Errors are {panel.wanted.says}."
    if panel.uncertainty > 0.0 and not math.isnan(panel.uncertainty):
        said += f" The reference is known to {percent(panel.uncertainty)}."
    return said
