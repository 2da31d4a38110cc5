"""Prepares one figure for each open point: every choice beside the default, as height curves or paths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reports.comparison import path_distance
from reports.layout import layout_of
from reports.runs import MAIN_VARIANTS, NotAvailable, Run, mechanics_in
from reports.words import mechanics_name, metres, mpa, number, plain
from verification.harness.choices import Choice, Point


@dataclass(frozen=True)
class ChoiceLine:
    """One run: x and y are MPa and m of height, or for a path both m; choice 0 is the default."""

    variant: str  # the interface type, which gives the colour
    choice: int
    x: np.ndarray
    y: np.ndarray
    failed: bool


@dataclass(frozen=True)
class ChoicePanel:
    """One experiment in one mechanics."""

    heading: str
    lines: tuple[ChoiceLine, ...]
    is_path: bool
    interfaces: tuple[float, ...]  # heights, or for paths places along x, m
    x_range: tuple[float, float]
    y_range: tuple[float, float]


@dataclass(frozen=True)
class ChoiceFigure:
    """An open point: a row of panels for each mechanics, or one row where each has one panel."""

    title: str
    rows: tuple[tuple[ChoicePanel, ...], ...]
    default: str
    choices: tuple[str, ...]
    variants: tuple[str, ...]


@dataclass(frozen=True)
class _Twin:
    """A run under a choice with the run under the default that it stands for."""

    choice: int
    kind: str
    run: Run
    default: Run


def choice_figure(point: Point, runs: Sequence[Run]) -> ChoiceFigure:
    """Every run of a point's choices beside the default it stands for."""
    of = {(run.mechanics, run.experiment, run.variant): run for run in runs if run.drawable}
    twins = [twin for index, choice in enumerate(point.choices, 1) for twin in _twins(choice, index, of)]
    if not twins:
        raise NotAvailable("none of its variants has been run beside its default")
    rows = []
    frames = {name: _frame([twin for twin in twins if twin.run.experiment == name])
              for name in sorted({twin.run.experiment for twin in twins})}
    for mechanics in reversed(mechanics_in(twin.run for twin in twins)):
        own = [[twin for twin in twins if (twin.run.mechanics, twin.run.experiment) == (mechanics, name)] for name in frames]
        rows.append(tuple(_panel(group, frames[group[0].run.experiment]) for group in own if group))
    if all(len(row) == 1 for row in rows):
        rows = [tuple(panel for row in rows for panel in row)]
    kinds = {twin.kind for twin in twins}
    return ChoiceFigure(
        title=_title(point, twins),
        rows=tuple(rows),
        default=point.default,
        choices=tuple(choice.name for choice in point.choices),
        variants=tuple(name for name in MAIN_VARIANTS if name in kinds),
    )


def _twins(choice: Choice, index: int, of: dict[tuple[str, str, str], Run]) -> list[_Twin]:
    """The runs of a choice that there are, each with its default; of quasi-static ones alone the default is one, too."""
    found = []
    for mechanics in dict.fromkeys(key[0] for key in of):
        for experiment, pairs in choice.runs.items():
            for kind, name in pairs.items():
                run, default = of.get((mechanics, experiment, name)), of.get((mechanics, experiment, kind))
                if name != kind and run is not None and default is not None:
                    found.append(_Twin(index, kind, run, default))
    return found


def _lines(twins: Sequence[_Twin], is_path: bool) -> list[ChoiceLine]:
    """The runs as lines, the defaults first."""
    defaults = {(twin.default.mechanics, twin.kind): twin.default for twin in twins}
    lines = [_line(run, kind, 0, is_path) for (_, kind), run in defaults.items()]
    return lines + [_line(twin.run, twin.kind, twin.choice, is_path) for twin in twins]


Frame = tuple[tuple[float, float], tuple[float, float]]


def _frame(twins: Sequence[_Twin]) -> Frame:
    """Ranges of x and y for all of one experiment's runs, the same in each mechanics."""
    is_path = layout_of(twins[0].default).along == "x"
    lines = _lines(twins, is_path)
    across = _range(np.concatenate([line.x for line in lines]), 1.0) if is_path else _pressures(lines)
    return across, _range(np.concatenate([line.y for line in lines]), 0.0)


def _panel(twins: Sequence[_Twin], frame: Frame) -> ChoicePanel:
    """One experiment's runs in one mechanics."""
    first = twins[0].default
    is_path = layout_of(first).along == "x"
    places = {place.at_m for twin in twins for run in (twin.default, twin.run) for place in layout_of(run).interfaces}
    return ChoicePanel(
        heading=f"Experiment {first.number}, {mechanics_name(first.mechanics)}",
        lines=tuple(_lines(twins, is_path)),
        is_path=is_path,
        interfaces=tuple(sorted(places)),
        x_range=frame[0],
        y_range=frame[1],
    )


def _line(run: Run, kind: str, choice: int, is_path: bool) -> ChoiceLine:
    """One run as a line."""
    if is_path:
        path = run.path_m
        return ChoiceLine(kind, choice, path[:, 0], path[:, 1], run.status == "failed")
    return ChoiceLine(kind, choice, run.history["inlet_Pa"] / 1e6, run.history["height_m"], run.status == "failed")


def _pressures(lines: Sequence[ChoiceLine]) -> tuple[float, float]:
    """The range of pressures from a little before the first growth to the last end, MPa."""
    starts = [line.x[max(0, int(np.argmax(line.y > line.y[0] + 0.25)) - 1)] for line in lines if (line.y > line.y[0] + 0.25).any()]
    last = max(float(line.x[-1]) for line in lines)
    first = min([float(start) for start in starts], default=last - 0.1)
    return (first - 0.06 * (last - first) - 0.01, last + 0.03 * (last - first) + 0.01)


def _range(values: np.ndarray, least: float) -> tuple[float, float]:
    """A range with a margin, at least so wide."""
    low, high = float(values.min()), float(values.max())
    room = max(0.04 * (high - low), 0.5 * (least - (high - low)), 0.0)
    return (low - room, high + room)


def _title(point: Point, twins: Sequence[_Twin]) -> str:
    """What each choice does at most, told of the mechanics that leads."""
    parts = []
    for index, choice in enumerate(point.choices, 1):
        own = [twin for twin in twins if twin.choice == index]
        lead = mechanics_in(twin.run for twin in own)[-1:]
        own = [twin for twin in own if twin.run.mechanics in lead]
        effect = _effect(own)
        if effect:
            parts.append(f"{choice.name}: {effect}")
    return f"{point.open[:1].upper()}{point.open[1:]} – " + "; ".join(parts)


def _effect(twins: Sequence[_Twin]) -> str:
    """The largest effects of a choice on start, climb and path, with the run they are seen in."""
    starts, climbs, paths, ends = [], [], [], []
    for twin in twins:
        name = f"{plain(twin.kind)}, Experiment {twin.run.number}"
        if layout_of(twin.run).along == "x":
            distance = path_distance(twin.run, twin.default)
            paths += [] if distance is None else [(distance, name)]
            continue
        here, there = first_growth_Pa(twin.run), first_growth_Pa(twin.default)
        starts += [] if here is None or there is None else [(here - there, name)]
        climbs += [(shift_Pa(twin.run, twin.default), name)]
        top, usual = float(np.max(twin.run.history["height_m"])), float(np.max(twin.default.history["height_m"]))
        ends += [(top - usual, f"ends at {metres(top)} instead of {metres(usual)}", name)] if abs(top - usual) > 1.5 else []
    parts: list[tuple[str, str]] = []
    if starts:
        shift, name = max(starts, key=lambda item: abs(item[0]))
        parts.append(("the same start", "") if abs(shift) < SAME_PA else (f"start {signed_mpa(shift)}", name))
    if climbs and max(climbs)[0] >= SAME_PA:
        parts.append((f"climb up to {mpa(max(climbs)[0], 3)} apart", max(climbs)[1]))
    if ends:
        _, words, name = max(ends, key=lambda item: abs(item[0]))
        parts.append((words, name))
    if paths:
        parts.append((f"path {number(max(paths)[0], 2)}\u00a0m away", max(paths)[1]))
    names = {name for _, name in parts if name}
    last = f" ({names.pop()})" if len(names) == 1 else ""
    return ", ".join(words if last or not name else f"{words} ({name})" for words, name in parts) + last


SAME_PA = 500.0  # half of the last digit that titles and tables show


def signed_mpa(pressure_Pa: float) -> str:
    """A difference of pressure in Pa written in MPa with its sign."""
    return f"{pressure_Pa / 1e6:+.3f}\u00a0MPa".replace("-", "−")


def first_growth_Pa(run: Run) -> float | None:
    """Inlet pressure of the first growth, Pa."""
    return next((float(event["inlet_Pa"]) for event in run.events if event.get("kind") == "start"), None)


def shift_Pa(run: Run, other: Run) -> float:
    """Largest distance in pressure between two height curves at whole metres that both reach, Pa."""
    tops = [float(np.max(one.history["height_m"])) for one in (run, other)]
    foot = max(float(one.history["height_m"][0]) for one in (run, other))
    heights = np.arange(np.floor(foot) + 1.0, min(tops) + 1e-6)
    if heights.size == 0:
        return 0.0
    return float(np.max(np.abs(_reached(run, heights) - _reached(other, heights))))


def _reached(run: Run, heights_m: np.ndarray) -> np.ndarray:
    """Inlet pressure at which the tip first comes within 0.05 m of each height, Pa."""
    best = np.maximum.accumulate(run.history["height_m"])
    return run.history["inlet_Pa"][np.searchsorted(best, heights_m - 0.05)]
