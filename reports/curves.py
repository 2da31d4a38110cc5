"""Prepares Figures 3 to 8 for drawing: heights, openings and paths from run folders."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from reports.layout import layout_of
from reports.outcome import Arrest, finding, held, outcome_of, outcomes_of
from reports.runs import NotAvailable, Run, fields_at, lead_of, mechanics_in, output_times
from reports.shown import Shown
from reports.words import listed, mechanics_name, metres, metres_signed, number, plain

OPENING_INSTANTS = 7  # profiles a panel of Fig 7: as many as stay distinguishable in one colour scale
MARKED: tuple[str, ...] = ("start", "reach_interface", "arrest", "restart", "stop")
PANEL_ASPECT = 1.15  # height over width of a panel of Fig 8
LOWEST_ASPECT = 0.75  # of a panel for a path that turns sideways: room for its legend and inset


def height_figure(runs: list[Run]) -> Shown:
    """Height (m) against inlet pressure (MPa) for the study's variants of one experiment; zoom is the range of both about the interfaces."""
    drawn = [run for run in runs if run.is_main and run.drawable]
    if not drawn:
        raise NotAvailable("no run of this experiment has a history")
    layout, lead = layout_of(drawn[0]), lead_of(drawn)
    curves = [_height_curve(run, runs, run.mechanics != lead) for run in drawn]
    last = max(float(curve.inlet_MPa[-1]) for curve in curves)
    first = min(*(float(curve.inlet_MPa[_first_growth(curve.height_m, layout.cell_m)]) for curve in curves), last)
    foot = min(float(curve.height_m[0]) for curve in curves)
    top = max(layout.heights_m, default=foot) + 8.0 * layout.cell_m
    near = max(float(curve.inlet_MPa[curve.height_m <= top].max()) for curve in curves)
    told = [run for run in drawn if run.mechanics == lead]
    return Shown(
        title=lead_words(drawn) + finding([outcome_of(run, runs) for run in told]), layout=layout, curves=curves,
        stays=[f"{plain(run.variant)} {stay}" for run in told if (stay := held(run, runs))],
        beside=list(dict.fromkeys(curve.mechanics for curve in curves if curve.beside)),
        zoom_m=(foot - layout.cell_m, top), pressure_MPa=_span(first, last), zoom_MPa=_span(first, near),
        flagged=any(mark.flag for curve in curves for mark in curve.marks),
    )


def lead_words(drawn: Sequence[Run]) -> str:
    """The beginning of a title that tells of one mechanics among two."""
    return "" if len(mechanics_in(drawn)) < 2 else f"{mechanics_name(lead_of(drawn)).capitalize()}: "


def _span(first_MPa: float, last_MPa: float) -> tuple[float, float]:
    """A range of pressures with some room before and after, MPa."""
    return (first_MPa - 0.12 * (last_MPa - first_MPa) - 0.01, last_MPa + 0.04 * (last_MPa - first_MPa) + 0.01)


def _first_growth(height_m: np.ndarray, cell_m: float) -> int:
    """Index of the last row before the height first rises by more than the motion of its tip: a quarter of a cell."""
    grown = np.flatnonzero(height_m > height_m[0] + 0.25 * cell_m)
    return max(0, int(grown[0]) - 1) if grown.size else height_m.size - 1


def _height_curve(run: Run, runs: Sequence[Run], beside: bool) -> Shown:
    """One run's curve with its marked events; beside: of the mechanics that is shown for comparison."""
    arrests = outcome_of(run, runs).arrests
    keep = np.isfinite(run.history["inlet_Pa"]) & np.isfinite(run.history["height_m"])
    return Shown(
        variant=run.variant, mechanics=mechanics_name(run.mechanics), beside=beside,
        label=plain(run.variant) + ("" if run.status == "completed" else f" ({run.status})"), inlet_MPa=run.history["inlet_Pa"][keep] / 1e6,
        height_m=run.history["height_m"][keep], marks=[_mark(arrests, event) for event in run.events if event.get("kind") in MARKED],
        failed=run.status == "failed",
    )


def _mark(arrests: tuple[Arrest, ...], event: dict[str, Any]) -> Shown:
    """An event as a mark; an arrest by J at an interface, unless energy confirms it, carries its flag."""
    y_m, kind, inlet = float(event["tip_y_m"]), str(event["kind"]), float(event["inlet_Pa"])
    flags = [arrest.flag for arrest in arrests if (arrest.height_m, arrest.from_Pa) == (y_m, inlet) and kind == "arrest"]
    return Shown(kind=kind, inlet_MPa=inlet / 1e6, height_m=y_m, flag=flags[0] if flags else "")


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
    panels = [_profile_panel(chosen[key], times[key], wanted, len(present) > 1) for key in order]
    profiles = [profile for panel in panels for profile in panel.profiles]
    return Shown(
        title=lead_words(list(chosen.values())) + finding(outcomes_of([chosen[key] for key in order if key[0] == present[-1]])), panels=panels,
        opening_mm=max((float(profile.opening_mm.max()) for profile in profiles), default=1.0),
        height_m=max((float(profile.height_m.max()) for profile in profiles), default=1.0),
    )


def _profile_panel(run: Run, times_s: np.ndarray, wanted_s: np.ndarray, named: bool) -> Shown:
    """The profiles of one run at the output times nearest to those wanted, each once; shade: 0 first to 1 last."""
    reached = wanted_s[wanted_s <= times_s[-1] * (1.0 + 1e-9)]
    profiles = []
    for index in sorted({int(np.argmin(np.abs(times_s - time))) for time in reached} | {times_s.size - 1}):
        fields, time_s = fields_at(run, "fracture", index), float(times_s[index])
        inlet = fields.get("inlet_Pa", np.interp(time_s, run.history["time_s"], run.history["inlet_Pa"]))
        shade = np.clip((time_s - wanted_s[0]) / (float(wanted_s[-1] - wanted_s[0]) or 1.0), 0.0, 1.0)
        profiles.append(Shown(height_m=fields["y_m"], opening_mm=1e3 * fields["opening_m"], time_s=time_s, inlet_MPa=float(inlet) / 1e6,
                              shade=float(shade)))
    end = profiles[-1]
    heading = (
        f"{plain(run.variant)}{f', {mechanics_name(run.mechanics)}' if named else ''}: at the end {metres(float(end.height_m.max()))} high,"
        f" {number(float(end.opening_mm.max()), 2)}\u00a0mm wide"
    )
    return Shown(variant=run.variant, mechanics=run.mechanics, heading=heading, profiles=profiles, interfaces_m=layout_of(run).heights_m)


def path_figure(groups: list[list[Run]]) -> Shown:
    """Final fracture paths of several experiments, zoomed so that their deviations are visible."""
    panels = [_path_panel(runs) for runs in groups if any(run.is_main and run.drawable for run in runs)]
    if not panels:
        raise NotAvailable("no run of these experiments has a history")
    drawn = [run for runs in groups for run in runs if run.is_main and run.drawable]
    kinks = {panel.name: [f"{plain(path.variant)} {path.kink_deg:.2g}°" for path in panel.paths if not path.beside] for panel in panels}
    return Shown(title=lead_words(drawn) + "; ".join(panel.heading for panel in panels), panels=panels,
                 turns=[f"{name} {listed(each)}" for name, each in kinks.items()])


def _path_panel(runs: list[Run]) -> Shown:
    """The paths of one experiment's main variants in a window (x0, x1, y0, y1), m.

    magnified: horizontal over vertical scale; aspect: height over width of the panel; lean: +1 where the paths end to the right of their start, -1 to
    the left (the other corners are free); aside: where the interface is when it is outside the window.
    """
    drawn = [run for run in runs if run.is_main and run.drawable]
    layout, lead = layout_of(drawn[0]), lead_of(drawn)
    softer_left = layout.along == "x" and len(layout.layers) > 1 and not layout.layers[-1].stiffness < layout.layers[0].stiffness
    side = -1.0 if softer_left else 1.0  # the softer rock lies at smaller or larger x of the interface
    paths = [_path(run, side, run.mechanics != lead) for run in sorted(drawn, key=lambda run: run.mechanics != lead)]
    window = _window(paths)
    steep = (window[3] - window[2]) / (window[1] - window[0])
    magnified, name = max(1.0, steep / PANEL_ASPECT), f"Experiment {drawn[0].number}"
    return Shown(name=name, heading=f"{name}: {_drift(paths, side)}", layout=layout, paths=paths, window_m=window, magnified=magnified,
                 aspect=steep / magnified, lean=1 if sum(float(path.x_m[-1] - path.x_m[0]) for path in paths) > 0 else -1,
                 aside=_aside(layout, window))


def _path(run: Run, side: float, beside: bool) -> Shown:
    """The last path of a run, its largest turn and where that is; beside: of the mechanics shown for comparison."""
    fields = fields_at(run, "fracture", output_times(run).size - 1)
    x_m, y_m = fields["x_m"], fields["y_m"]
    kink, at = largest_turn(x_m, y_m)
    name = plain(run.variant) + (f", {mechanics_name(run.mechanics)}" if beside else "")
    label = f"{name}: {metres_signed(side * float(x_m[-1] - x_m[0]))}, {number(kink, 2)}°"
    return Shown(variant=run.variant, beside=beside, label=label, x_m=x_m, y_m=y_m, kink_deg=kink, kink_at_m=at)


def largest_turn(x_m: np.ndarray, y_m: np.ndarray) -> tuple[float, tuple[float, float]]:
    """The largest angle in degrees between neighbouring segments of a polyline, and its place in m."""
    step_x, step_y = np.diff(x_m), np.diff(y_m)
    length = np.hypot(step_x, step_y)
    step_x, step_y = step_x[length > 0], step_y[length > 0]
    if step_x.size < 2:
        return 0.0, (float(x_m[0]), float(y_m[0]))
    cross = step_x[:-1] * step_y[1:] - step_y[:-1] * step_x[1:]
    along = step_x[:-1] * step_x[1:] + step_y[:-1] * step_y[1:]
    turn = np.abs(np.degrees(np.arctan2(cross, along)))
    worst = int(np.argmax(turn))
    corners_x, corners_y = x_m[1:][length > 0], y_m[1:][length > 0]
    return float(turn[worst]), (float(corners_x[worst]), float(corners_y[worst]))


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
    toward = {path.variant: side * float(path.x_m[-1] - path.x_m[0]) for path in paths if not path.beside}
    parts = []
    for sign, where in ((1.0, "towards the soft rock"), (-1.0, "towards the stiff rock")):
        each = [f"{number(abs(shift), 2)}\u00a0m ({plain(name)})" for name, shift in toward.items() if sign * shift > 0]
        parts += [f"{where} by {listed(each)}"] if each else []
    still = [plain(name) for name, shift in toward.items() if shift == 0]
    return "the fracture goes " + ", ".join(parts + ([f"straight ({listed(still)})"] if still else []))
