"""Prepares Figures 3 to 8 for drawing: heights, openings and paths from run folders; runs that would lie on one another are drawn once."""

from collections.abc import Callable, Sequence

import numpy as np

from reports.comparison import path_distance, shift_Pa
from reports.outcome import finding, outcome_of, outcomes_of
from reports.runs import NotAvailable, Run, fields_at, layout_of, lead_of, mechanics_in, output_times
from reports.words import Shown, listed, mechanics_name, metres, minus, number, plain, sentence

OPENING_INSTANTS = 7  # profiles a panel of Fig 7: as many as stay distinguishable in one colour scale
PANEL_ASPECT = 1.15  # height over width of a panel of Fig 8
LOWEST_ASPECT = 0.75  # of a panel for a path that turns sideways: room for its legend and inset
# Runs nearer than this lie within a line's width on one another: lines of 0.4 mm, panels of 90 mm, that is 1 MPa or the width of a window.
SAME_PA, SAME_SHARE = 5e3, 0.005


def drawn_of(runs: Sequence[Run]) -> list[Run]:
    """The study's variants that have a history."""
    return [run for run in runs if run.is_main and run.drawable]


def grouped(runs: Sequence[Run], same: Callable[[Run, Run], bool]) -> list[list[Run]]:
    """Runs that are the same to the eye together, those of the mechanics that leads first."""
    lead = lead_of(runs)
    groups: list[list[Run]] = []
    for run in sorted(runs, key=lambda run: run.mechanics != lead):
        own = next((group for group in groups if group[0].status == run.status and same(group[0], run)), None)
        if own is None:
            groups.append([run])
        else:
            own.append(run)
    return groups


def same_climb(run: Run, other: Run) -> bool:
    """Whether two runs come to every height at the same pressure, and end at the same height."""
    ends = [float(one.history["height_m"][-1]) for one in (run, other)]
    return abs(ends[0] - ends[1]) < 0.5 * run.cell_m and shift_Pa(run, other) < SAME_PA


def names_of(group: Sequence[Run], both: bool) -> str:
    """The variants of a group in words, with their mechanics where runs of both are shown."""
    names = {mechanics: listed([plain(run.variant) for run in group if run.mechanics == mechanics]) for mechanics in mechanics_in(group)[::-1]}
    if not both:
        return listed(list(dict.fromkeys(names.values())))
    if len(names) > 1 and len(set(names.values())) == 1:
        return f"{names.popitem()[1]}, with and without inertia"
    return "; ".join(f"{words}, {mechanics_name(mechanics)}" for mechanics, words in names.items())


def pressure_span(runs: Sequence[Run]) -> tuple[float, float]:
    """The range of inlet pressures (MPa) from a little before the first growth to the last end of all runs, for axes that experiments share."""
    drawn = drawn_of(runs)
    first = min((run.history["inlet_Pa"][_first_growth(run.history["height_m"], run.cell_m)] for run in drawn), default=2e6) / 1e6
    last = max((run.history["inlet_Pa"][-1] for run in drawn), default=4e6) / 1e6
    return (float(first) - 0.06 * (last - first) - 0.01, float(last) + 0.03 * (last - first) + 0.01)


def height_figure(runs: list[Run], every: Sequence[Run] = ()) -> Shown:
    """Height (m) against inlet pressure (MPa) for the study's variants of one experiment, on the axes of `every` run."""
    drawn = drawn_of(runs)
    if not drawn:
        raise NotAvailable("no run of this experiment has a history")
    lead, both = lead_of(drawn), len(mechanics_in(drawn)) > 1
    curves = [_height_curve(group, runs, lead, both) for group in grouped(drawn, same_climb)]
    title = told_of_lead(drawn, finding([outcome_of(run, runs) for run in drawn if run.mechanics == lead]))
    return Shown(title=title, name=f"Experiment {drawn[0].number}", layout=layout_of(drawn[0]), curves=curves, pressure_MPa=pressure_span(every or runs))


def told_of_lead(drawn: Sequence[Run], words: str) -> str:
    """A title, which says of which mechanics among two it tells."""
    return sentence(words if len(mechanics_in(drawn)) < 2 else f"{mechanics_name(lead_of(drawn))}: {words}")


def _first_growth(height_m: np.ndarray, cell_m: float) -> int:
    """Index of the last row before the height first rises by more than the motion of its tip: a quarter of a cell."""
    grown = np.flatnonzero(height_m > height_m[0] + 0.25 * cell_m)
    return max(0, int(grown[0]) - 1) if grown.size else height_m.size - 1


def _height_curve(group: Sequence[Run], runs: Sequence[Run], lead: str, both: bool) -> Shown:
    """The curve of runs that are alike, with its arrests and restarts; beside: of the mechanics that is shown for comparison."""
    run = group[0]
    keep = np.isfinite(run.history["inlet_Pa"]) & np.isfinite(run.history["height_m"])
    marks = [Shown(kind=kind, inlet_MPa=at_Pa / 1e6, height_m=arrest.height_m) for arrest in outcome_of(run, runs).arrests if arrest.tells
             for kind, at_Pa in (("arrest", arrest.from_Pa), ("restart", arrest.until_Pa)) if at_Pa is not None]
    return Shown(variant=run.variant, mechanics=run.mechanics, beside=run.mechanics != lead, inlet_MPa=run.history["inlet_Pa"][keep] / 1e6,
                 label=names_of(group, both) + ("" if run.status == "completed" else f" ({run.status})"), height_m=run.history["height_m"][keep], marks=marks,
                 failed=run.status == "failed")


def profile_figure(runs: list[Run], variants: tuple[str, ...] = ("perfect", "weak")) -> Shown:
    """Opening profiles (mm against m) at several common times, variant against variant on the same axes, in each mechanics."""
    chosen = {(run.mechanics, run.variant): run for run in runs if run.variant in variants and run.drawable}
    if not chosen:
        raise NotAvailable(f"no run of {listed(list(variants))} has a history")
    times = {name: output_times(run) for name, run in chosen.items()}
    first = min(float(run.history["time_s"][_first_growth(run.history["height_m"], run.cell_m)]) for run in chosen.values())
    wanted = np.linspace(first, max(float(value[-1]) for value in times.values()), OPENING_INSTANTS)
    present = mechanics_in(chosen.values())
    order = [(mechanics, name) for mechanics in reversed(present) for name in variants if (mechanics, name) in chosen]
    groups = grouped([chosen[key] for key in order], same_climb)
    panels = [_profile_panel(group, times[group[0].mechanics, group[0].variant], wanted, len(present) > 1) for group in groups]
    profiles = [profile for panel in panels for profile in panel.profiles]
    return Shown(
        title=told_of_lead(list(chosen.values()), finding(outcomes_of([chosen[key] for key in order if key[0] == present[-1]]))), panels=panels,
        opening_mm=max((float(profile.opening_mm.max()) for profile in profiles), default=1.0),
        height_m=max((float(profile.height_m.max()) for profile in profiles), default=1.0),
    )


def _profile_panel(group: Sequence[Run], times_s: np.ndarray, wanted_s: np.ndarray, named: bool) -> Shown:
    """The profiles of runs that are alike at the output times nearest to those wanted, each once; shade: 0 first to 1 last."""
    run = group[0]
    reached = wanted_s[wanted_s <= times_s[-1] * (1.0 + 1e-9)]
    profiles = []
    for index in sorted({int(np.argmin(np.abs(times_s - time))) for time in reached} | {times_s.size - 1}):
        fields, time_s = fields_at(run, "fracture", index), float(times_s[index])
        shade = np.clip((time_s - wanted_s[0]) / (float(wanted_s[-1] - wanted_s[0]) or 1.0), 0.0, 1.0)
        profiles.append(Shown(height_m=fields["y_m"], opening_mm=1e3 * fields["opening_m"], time_s=time_s, inlet_MPa=float(fields["inlet_Pa"]) / 1e6,
                              shade=float(shade)))
    end = profiles[-1]
    heading = (
        f"{names_of(group, named)}: at the end {metres(float(end.height_m.max()))} high,"
        f" {number(float(end.opening_mm.max()), 2)}\u00a0mm wide"
    )
    return Shown(variant=run.variant, mechanics=run.mechanics, heading=heading, profiles=profiles, interfaces_m=layout_of(run).heights_m)


def path_figure(groups: list[list[Run]]) -> Shown:
    """Final fracture paths of several experiments, zoomed so that their deviations are visible."""
    panels = [_path_panel(runs) for runs in groups if drawn_of(runs)]
    if not panels:
        raise NotAvailable("no run of these experiments has a history")
    drawn = drawn_of([run for runs in groups for run in runs])
    return Shown(title=told_of_lead(drawn, "; ".join(panel.heading for panel in panels)), panels=panels)


def _path_panel(runs: list[Run]) -> Shown:
    """The paths of one experiment's main variants in a window (x0, x1, y0, y1), m.

    magnified: horizontal over vertical scale; aspect: height over width of the panel; lean: +1 where the paths end to the right of their start, -1 to
    the left (the other corners are free); aside: where the interface is when it is outside the window.
    """
    drawn = drawn_of(runs)
    layout, lead = layout_of(drawn[0]), lead_of(drawn)
    softer_left = layout.along == "x" and len(layout.layers) > 1 and not layout.layers[-1].stiffness < layout.layers[0].stiffness
    side = -1.0 if softer_left else 1.0  # the softer rock lies at smaller or larger x of the interface
    window = _window([_path([run], side, False, False) for run in drawn])
    near_m = SAME_SHARE * (window[1] - window[0])
    groups = grouped(drawn, lambda run, other: (apart := path_distance(run, other)) is not None and apart < near_m)
    paths = [_path(group, side, group[0].mechanics != lead, len(mechanics_in(drawn)) > 1) for group in groups]
    steep = (window[3] - window[2]) / (window[1] - window[0])
    magnified, name = max(1.0, steep / PANEL_ASPECT), f"Experiment {drawn[0].number}"
    return Shown(name=name, heading=f"{name}: {_drift(paths, side)}", layout=layout, paths=paths, window_m=window, magnified=magnified,
                 aspect=steep / magnified, lean=1 if sum(float(path.x_m[-1] - path.x_m[0]) for path in paths) > 0 else -1,
                 aside=_aside(layout, window))


def _path(group: Sequence[Run], side: float, beside: bool, both: bool) -> Shown:
    """The last path of runs that are alike and its largest turn; beside: of the mechanics shown for comparison."""
    run = group[0]
    fields = fields_at(run, "fracture", output_times(run).size - 1)
    x_m, y_m = fields["x_m"], fields["y_m"]
    label = f"{names_of(group, both)}: {minus(format(side * float(x_m[-1] - x_m[0]), '+.2f'))}\u00a0m, {number(largest_turn(x_m, y_m), 2)}°"
    names = list(dict.fromkeys(plain(one.variant) for one in group))
    return Shown(variant=run.variant, beside=beside, names=names, label=label, x_m=x_m, y_m=y_m)


def largest_turn(x_m: np.ndarray, y_m: np.ndarray) -> float:
    """The largest angle in degrees between neighbouring segments of a polyline."""
    step_x, step_y = np.diff(x_m), np.diff(y_m)
    long = np.hypot(step_x, step_y) > 0
    step_x, step_y = step_x[long], step_y[long]
    if step_x.size < 2:
        return 0.0
    cross = step_x[:-1] * step_y[1:] - step_y[:-1] * step_x[1:]
    along = step_x[:-1] * step_x[1:] + step_y[:-1] * step_y[1:]
    return float(np.max(np.abs(np.degrees(np.arctan2(cross, along)))))


def _window(paths: Sequence[Shown]) -> tuple[float, float, float, float]:
    """A window about all paths with a margin, never narrower than a twentieth of its height nor than 0.5 m."""
    x_m, y_m = (np.concatenate([getattr(path, axis) for path in paths]) for axis in ("x_m", "y_m"))
    low = float(y_m.min())
    height = 1.04 * max(float(y_m.max()) - low, 1.0)
    width = max(1.3 * float(np.ptp(x_m)), height / 20.0, 0.5)
    if width > 0.4 * height:  # so wide a path needs no magnification, nor so high a panel
        width = max(width, height / PANEL_ASPECT)
        height = max(height, LOWEST_ASPECT * width)
    middle = 0.5 * float(x_m.min() + x_m.max())
    return (middle - 0.5 * width, middle + 0.5 * width, low, low + height)


def _aside(layout: Shown, window: tuple[float, float, float, float]) -> str:
    """Where the interfaces lie that the window does not show."""
    if layout.along != "x" or not layout.fracture_x_m:
        return ""
    away = [place.at_m - layout.fracture_x_m[0] for place in layout.interfaces if not window[0] <= place.at_m <= window[1]]
    return "; ".join(f"interface {metres(abs(offset))} to the {'right' if offset > 0 else 'left'} of the start" for offset in away)


def _drift(paths: Sequence[Shown], side: float) -> str:
    """Which way each path ends, and how far, like paths told together."""
    told: dict[str, dict[str, list[str]]] = {"straight": {}, "towards the soft rock": {}, "towards the stiff rock": {}}
    for path in paths:
        if not path.beside:
            shift = side * float(path.x_m[-1] - path.x_m[0])
            where = [*told][(shift > 0) - (shift < 0)]
            told[where].setdefault(f" by {number(abs(shift), 2)}\u00a0m" if shift else "", []).extend(path.names)
    return "the fracture goes " + ", ".join(where + listed([f"{size} ({listed(names)})" for size, names in found.items()]) for where, found in told.items() if found)
