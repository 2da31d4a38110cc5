"""What each choice at a point that the study leaves open moves at most, against the default that it stands for."""

from collections.abc import Sequence

import numpy as np

from reports.comparison import path_distance, shift_Pa
from reports.outcome import event_inlet
from reports.runs import Run, layout_of, mechanics_in
from reports.words import NONE, mechanics_name, metres, mpa, number, plain
from verification.harness.choices import Choice, Point

SAME_PA = 500.0  # half of the last digit that tables show
Twins = Sequence[tuple[Run, Run]]  # a run of a choice with its default


def choice_rows(points: Sequence[Point], runs: Sequence[Run]) -> list[tuple[str, str, str, str]]:
    """A row a choice: open point, default, choice, and its largest effects in the mechanics that leads."""
    of = {(run.mechanics, run.experiment, run.variant): run for run in runs if run.drawable}
    return [(point.open, point.default, choice.name, _effect_words(_twins(choice, of))) for point in points for choice in point.choices]


def _twins(choice: Choice, of: dict[tuple[str, str, str], Run]) -> list[tuple[Run, Run]]:
    """The runs of a choice that there are, each with its default."""
    pairs = [((mechanics, experiment, name), (mechanics, experiment, kind)) for mechanics in dict.fromkeys(key[0] for key in of)
             for experiment, names in choice.runs.items() for kind, name in names.items() if name != kind]
    return [(of[one], of[other]) for one, other in pairs if one in of and other in of]


def _effect_words(twins: Twins) -> str:
    """The largest effects on start, climb and path, with the run they are seen in; a dash where nothing was run."""
    lead = mechanics_in(run for run, _ in twins)[-1:]
    starts, climbs, paths, ends = [], [], [], []
    for run, default in [(run, default) for run, default in twins if run.mechanics in lead]:
        name = f"{plain(default.variant)}, Experiment {run.number}"
        if layout_of(run).along == "x":
            distance = path_distance(run, default)
            paths += [] if distance is None else [(distance, name)]
            continue
        here, there = event_inlet(run, "start"), event_inlet(default, "start")
        starts += [] if here is None or there is None else [(here - there, name)]
        climbs += [(shift_Pa(run, default), name)]
        top, usual = (float(np.max(one.history["height_m"])) for one in (run, default))
        ends += [(top - usual, f"ends at {metres(top)} instead of {metres(usual)}", name)] if abs(top - usual) > 1.5 else []
    parts: list[tuple[str, str]] = []
    if starts:
        shift, name = max(starts, key=lambda item: abs(item[0]))
        parts.append(("the same start", "") if abs(shift) < SAME_PA else (f"start {mpa(shift, 3, '+')}", name))
    if climbs and max(climbs)[0] >= SAME_PA:
        parts.append((f"climb up to {mpa(max(climbs)[0], 3)} apart", max(climbs)[1]))
    if ends:
        parts.append(max(ends, key=lambda item: abs(item[0]))[1:])
    if paths:
        parts.append((f"path {number(max(paths)[0], 2)}\u00a0m away", max(paths)[1]))
    told = ", ".join(f"{words} ({name})" if name else words for words, name in parts)
    return f"{told}; {mechanics_name(lead[0])}" if told else NONE
