"""Prepares one figure for each open point: every choice beside the default, as height curves or paths."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from reports.comparison import path_distance
from reports.layout import layout_of
from reports.outcome import event_inlet
from reports.runs import MAIN_VARIANTS, NotAvailable, Run, mechanics_in
from reports.shown import Shown
from reports.words import mechanics_name, metres, mpa, number, plain, signed_mpa
from verification.harness.choices import Choice, Point

SAME_PA = 500.0  # half of the last digit that titles and tables show


class Twin(NamedTuple):
    """A run under a choice (1 is the first) with the run under the default that it stands for; the kind is the interface type."""

    choice: int
    kind: str
    run: Run
    default: Run

    @property
    def is_path(self) -> bool:
        """Whether the interface is parallel to the fracture, so that its path tells what it does."""
        return layout_of(self.default).along == "x"


def choice_figure(point: Point, runs: Sequence[Run]) -> Shown:
    """Every run of a point's choices beside the default it stands for: a row of panels for each mechanics, or one row where each has one."""
    of = {(run.mechanics, run.experiment, run.variant): run for run in runs if run.drawable}
    twins = [twin for index, choice in enumerate(point.choices, 1) for twin in _twins(choice, index, of)]
    if not twins:
        raise NotAvailable("none of its variants has been run beside its default")
    groups = {name: [twin for twin in twins if twin.run.experiment == name] for name in sorted({twin.run.experiment for twin in twins})}
    frames = {name: _frame(group) for name, group in groups.items()}
    rows = []
    for mechanics in reversed(mechanics_in(twin.run for twin in twins)):
        own = {name: [twin for twin in group if twin.run.mechanics == mechanics] for name, group in groups.items()}
        rows.append([_panel(group, frames[name]) for name, group in own.items() if group])
    if all(len(row) == 1 for row in rows):
        rows = [[panel for row in rows for panel in row]]
    kinds = {twin.kind for twin in twins}
    return Shown(title=_title(point, twins), rows=rows, default=point.default, choices=[choice.name for choice in point.choices],
                 variants=[name for name in MAIN_VARIANTS if name in kinds], are_paths=[twin.is_path for twin in twins])


def _twins(choice: Choice, index: int, of: dict[tuple[str, str, str], Run]) -> list[Twin]:
    """The runs of a choice that there are, each with its default; of quasi-static ones alone the default is one, too."""
    found = []
    for mechanics in dict.fromkeys(key[0] for key in of):
        for experiment, pairs in choice.runs.items():
            for kind, name in pairs.items():
                run, default = of.get((mechanics, experiment, name)), of.get((mechanics, experiment, kind))
                if name != kind and run is not None and default is not None:
                    found.append(Twin(index, kind, run, default))
    return found


def _lines(twins: Sequence[Twin]) -> list[Shown]:
    """The runs as lines, the defaults (choice 0) first: x and y are MPa and m of height, or for a path both m."""
    is_path = twins[0].is_path
    defaults = {(twin.default.mechanics, twin.kind): twin.default for twin in twins}
    runs = [(run, kind, 0) for (_, kind), run in defaults.items()] + [(twin.run, twin.kind, twin.choice) for twin in twins]
    lines = []
    for run, kind, choice in runs:
        x, y = run.path_m.T if is_path else (run.history["inlet_Pa"] / 1e6, run.history["height_m"])
        lines.append(Shown(variant=kind, choice=choice, x=x, y=y, failed=run.status == "failed"))
    return lines


Frame = tuple[tuple[float, float], tuple[float, float]]


def _frame(twins: Sequence[Twin]) -> Frame:
    """Ranges of x and y for all of one experiment's runs, the same in each mechanics."""
    lines = _lines(twins)
    across = _range(np.concatenate([line.x for line in lines]), 1.0) if twins[0].is_path else _pressures(lines)
    return across, _range(np.concatenate([line.y for line in lines]), 0.0)


def _panel(twins: Sequence[Twin], frame: Frame) -> Shown:
    """One experiment's runs in one mechanics; interfaces: heights, or for paths places along x, m."""
    first = twins[0].default
    places = {place.at_m for twin in twins for run in (twin.default, twin.run) for place in layout_of(run).interfaces}
    return Shown(heading=f"Experiment {first.number}, {mechanics_name(first.mechanics)}", lines=_lines(twins), is_path=twins[0].is_path,
                 interfaces=sorted(places), x_range=frame[0], y_range=frame[1])


def _pressures(lines: Sequence[Shown]) -> tuple[float, float]:
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


def _title(point: Point, twins: Sequence[Twin]) -> str:
    """What each choice does at most, told of the mechanics that leads."""
    parts = []
    for index, choice in enumerate(point.choices, 1):
        own = [twin for twin in twins if twin.choice == index]
        lead = mechanics_in(twin.run for twin in own)[-1:]
        effect = _effect([twin for twin in own if twin.run.mechanics in lead])
        parts += [f"{choice.name}: {effect}"] if effect else []
    return f"{point.open[:1].upper()}{point.open[1:]} – " + "; ".join(parts)


def _effect(twins: Sequence[Twin]) -> str:
    """The largest effects of a choice on start, climb and path, with the run they are seen in."""
    starts, climbs, paths, ends = [], [], [], []
    for twin in twins:
        name = f"{plain(twin.kind)}, Experiment {twin.run.number}"
        if layout_of(twin.run).along == "x":
            distance = path_distance(twin.run, twin.default)
            paths += [] if distance is None else [(distance, name)]
            continue
        here, there = event_inlet(twin.run, "start"), event_inlet(twin.default, "start")
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
        parts.append(max(ends, key=lambda item: abs(item[0]))[1:])
    if paths:
        parts.append((f"path {number(max(paths)[0], 2)}\u00a0m away", max(paths)[1]))
    names = {name for _, name in parts if name}
    last = f" ({names.pop()})" if len(names) == 1 else ""
    return ", ".join(words if last or not name else f"{words} ({name})" for words, name in parts) + last


def shift_Pa(run: Run, other: Run) -> float:
    """Largest distance between the inlet pressures of two runs at which the tip first comes to whole metres that both reach, Pa."""
    tops = [float(np.max(one.history["height_m"])) for one in (run, other)]
    foot = max(float(one.history["height_m"][0]) for one in (run, other))
    heights = np.arange(np.floor(foot) + 1.0, min(tops) + 1e-6) - 0.05  # so near counts as there
    if heights.size == 0:
        return 0.0
    first, second = (one.history["inlet_Pa"][np.searchsorted(np.maximum.accumulate(one.history["height_m"]), heights)] for one in (run, other))
    return float(np.max(np.abs(first - second)))
