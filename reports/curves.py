"""The figures of the page of the experiments, numbered as in the study: which data each is made from, what draws it, and which words are its caption; and what
they show: the copies of nodes about a crack, the stress and pressure of a pressurised one, heights, openings and paths from run folders, of which runs that would lie
on one another are drawn once."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from reports.charts.experiments import draw_copies, draw_heights, draw_paths, draw_pressure, draw_profiles
from reports.figures import Figure
from reports.outcome import finding, outcome_of, outcomes_of, path_distance, shift_Pa
from reports.runs import Arrays, NotAvailable, Run, fields_at, interfaces_at, layout_of, lead_of, load_run, mechanics_in, output_times
from reports.words import Shown, listed, mechanics_name, metres, minus, mpa, number, plain, sentence, share
from verification.harness.run import Job, make

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
    steps = np.diff([x_m, y_m])
    x, y = steps[:, np.hypot(*steps) > 0]
    return float(np.degrees(np.abs(np.diff(np.unwrap(np.arctan2(y, x))))).max(initial=0.0))


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


SQUARES = 160  # of Fig 2 along either side
WINDOW_CELLS = 9  # width of Fig 1's panels: few enough for single nodes and particles to be told apart
REACH: dict[str, float] = {"bspline2": 1.5, "linear": 1.0, "gimp": 1.25}  # half support of a node, cells


def side_of(x_m: np.ndarray, y_m: np.ndarray, path_x_m: np.ndarray, path_y_m: np.ndarray) -> tuple[Arrays, ...]:
    """For points: sign of the distance to the extended polyline (on it counts as +), and whether behind its tip."""
    path = np.array([path_x_m, path_y_m])
    way = np.diff(path)
    long = np.hypot(*way) > 0.0
    way, last = way[:, long, None], np.count_nonzero(long) - 1
    off = np.array([x_m, y_m])[:, None] - path[:, :-1][:, long, None]  # of each point from the start of each segment
    s = (off * way).sum(axis=0) / (way**2).sum(axis=0)
    foot = np.clip(s, np.r_[-np.inf, np.zeros(last)][:, None], np.r_[np.ones(last), np.inf][:, None])
    nearest = np.hypot(*(off - foot * way)).argmin(axis=0)
    cross, s = (np.take_along_axis(of, nearest[None], axis=0)[0] for of in (off[0] * way[1] - off[1] * way[0], s))
    return np.where(cross >= 0.0, 1, -1), (nearest < last) | (s < 1.0)


def copies_figure(pairs: list[tuple[Run, int, str]], magnified: float) -> Shown:
    """Fig 1 from runs at given output times, each panel centred on its crack's tip or on an interface; openings are magnified."""
    panels = [_copies_panel(run, index, centre, magnified) for run, index, centre in pairs]
    if not panels:
        raise NotAvailable("no run has particles and a fracture")
    copies = [len(node.copies) for panel in panels for node in panel.nodes]
    title = f"{sum(count > 1 for count in copies)} of the {len(copies)} nodes shown carry a field for each side"
    return Shown(title=f"{title}, up to {max(copies)} where surfaces cross" if max(copies) > 2 else title, panels=panels, magnified=magnified)


def _copies_panel(run: Run, index: int, centre: str, magnified: float) -> Shown:
    """The surroundings of one crack at one output time, m; sides of particles as signs about (fracture, interface)."""
    layout, fracture, points = layout_of(run), fields_at(run, "fracture", index), fields_at(run, "particles", index)
    h, crack = layout.cell_m, (fracture["x_m"], fracture["y_m"])
    tip_m = float(crack[1].max())
    at_y = tip_m if centre == "tip" or not layout.heights_m else layout.heights_m[0]
    at_x, half = float(np.interp(at_y, crack[1], crack[0])), 0.5 * WINDOW_CELLS * h
    low = max(0.0, at_y - (1.35 if centre == "tip" else 1.0) * half)
    window = (at_x - half, at_x + half, low, low + 2.0 * half)
    laws = divided(run, index)
    x, y, margin = points["x_m"], points["y_m"], 2.0 * h
    inside = (x > window[0] - margin) & (x < window[1] + margin) & (y > window[2] - margin) & (y < window[3] + margin)
    x_m, y_m = points["x_m"][inside], points["y_m"][inside]
    # A row of signs for each particle: about the fracture, then about every interface.
    sides = np.stack([side_of(x_m, y_m, *crack)[0], *(np.where(y_m >= at, 1, -1) for at in laws)], axis=1)
    reach = REACH.get(str(run.scene.get("numerics", {}).get("shape", "bspline2")), 1.5) * h
    gx, gy = _lines(window[:2], h), _lines(window[2:], h)
    # Whether an interface has split within half a cell of a column of nodes.
    divides = {x: {at: bool((np.abs(split - x) <= 0.5 * h).any()) for at, split in laws.items()} for x in gx}
    return Shown(
        heading=f"Experiment {run.number}, {plain(run.variant)}, tip at {metres(tip_m)}", window_m=window, grid_x_m=gx, grid_y_m=gy,
        points_x_m=crack[0], points_y_m=crack[1], faces=_faces(fracture, magnified), particles=_grouped(x_m, y_m, sides),
        interfaces_m=[at for at, split in laws.items() if split.size and window[2] <= at <= window[3]],
        nodes=[_node((a, b), x_m, y_m, sides, crack, divides[a], reach) for a in gx for b in gy],
    )


def divided(run: Run, index: int) -> dict[float, np.ndarray]:
    """For each interface across the fracture, its height in m and the x in m of its points where it has split."""
    across = interfaces_at(run, index) if layout_of(run).along == "y" else []
    return dict(sorted((float(points["at_m"]), points["x_m"][points["split"] > 0]) for points in across))


def _lines(span: tuple[float, float], h: float) -> tuple[float, ...]:
    """Grid lines within a span, m."""
    first, last = int(np.ceil(span[0] / h - 1e-9)), int(np.floor(span[1] / h + 1e-9))
    return tuple(k * h for k in range(first, last + 1))


def _grouped(x_m: np.ndarray, y_m: np.ndarray, sides: np.ndarray) -> dict[tuple[int, int], tuple[np.ndarray, ...]]:
    """Particles by their side of the fracture and the number of interfaces below them."""
    above = (sides[:, 1:] > 0).sum(axis=1)
    masks = {(crack, level): (sides[:, 0] == crack) & (above == level) for crack in (-1, 1) for level in range(int(above.max(initial=0)) + 1)}
    return {group: (x_m[mask], y_m[mask]) for group, mask in masks.items()}


def _node(
    at_m: tuple[float, float], x_m: np.ndarray, y_m: np.ndarray, sides: np.ndarray, crack: tuple[np.ndarray, np.ndarray],
    divides: dict[float, bool], reach_m: float,
) -> Shown:
    """A node with a copy for each of the distinct sides that particles in its support lie on, of surfaces that divide there."""
    near = (np.abs(x_m - at_m[0]) < reach_m) & (np.abs(y_m - at_m[1]) < reach_m)
    _, behind = side_of(np.array([at_m[0]]), np.array([at_m[1]]), *crack)
    seen = sides[near].copy()
    if not behind[0]:
        seen[:, 0] = 0
    for column, (height, yes) in enumerate(divides.items(), 1):
        if not yes:
            seen[:, column] = 1 if at_m[1] >= height else -1
    return Shown(x_m=at_m[0], y_m=at_m[1], copies=sorted({tuple(int(s) for s in row) for row in seen}))


def _faces(fracture: Arrays, magnified: float) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """The two faces of the fracture, apart by the magnified opening, m."""
    x, y, half = fracture["x_m"], fracture["y_m"], 0.5 * magnified * fracture["opening_m"]
    tx, ty = np.gradient(x), np.gradient(y)
    length = np.where(np.hypot(tx, ty) > 0, np.hypot(tx, ty), 1.0)
    nx, ny = ty / length, -tx / length
    return ((x - half * nx, y - half * ny), (x + half * nx, y + half * ny))


def pressure_figure(run: Run, index: int) -> Shown:
    """Fig 2 from one run at one output time: stress in MPa on squares in m, and along the fracture opening in mm and permeability in mm2."""
    layout, fracture, points = layout_of(run), fields_at(run, "fracture", index), fields_at(run, "particles", index)
    x_m, y_m, pressure_Pa, opening_mm = fracture["x_m"], fracture["y_m"], fracture["pressure_Pa"], 1e3 * fracture["opening_m"]
    inlet, arc = float(fracture["inlet_Pa"]), fracture["arc_m"]
    title = (f"At {mpa(inlet)} the fracture is {metres(float(np.max(arc)))} long and up to {number(float(opening_mm.max()), 2)}\u00a0mm open; at its tip stand"
             f" {share(float(pressure_Pa[-1]) / inlet)} of the inlet's pressure")
    size = min(3.0 * float(np.max(y_m)), layout.height_m, layout.width_m)  # of a square view about the fracture, within the block
    left = min(max(0.0, float(x_m[0]) - 0.5 * size), layout.width_m - size)
    edges_x, edges_y = np.linspace(left, left + size, SQUARES + 1), np.linspace(0.0, size, SQUARES + 1)
    field = sampled(points, points["s_xx_Pa"] / 1e6, edges_x, edges_y)
    change = np.abs(field + layout.horizontal_Pa / 1e6)
    return Shown(
        title=title, edges_x_m=edges_x, edges_y_m=edges_y, s_xx_MPa=field, centre_MPa=-layout.horizontal_Pa / 1e6,
        range_MPa=max(float(np.percentile(change, 99.0)), abs(inlet - layout.horizontal_Pa) / 1e6), view_m=(left, left + size, 0.0, size),
        crack_x_m=x_m, crack_y_m=y_m, arc_m=arc, pressure=pressure_Pa / inlet, opening_mm=opening_mm,
        permeability_mm2=1e6 * fracture["permeability_m2"], inlet_MPa=inlet / 1e6, cell_m=layout.cell_m, time_s=float(output_times(run)[index]),
        source=f"Experiment {run.number}, {plain(run.variant)}, {mechanics_name(run.mechanics)}",
    )


def sampled(points: Arrays, values: np.ndarray, edges_x_m: np.ndarray, edges_y_m: np.ndarray) -> np.ndarray:
    """The value of the particle nearest to the middle of each square, a row a height."""
    x_m, y_m = np.meshgrid(*(0.5 * (edges[:-1] + edges[1:]) for edges in (edges_x_m, edges_y_m)))
    return values[cKDTree(np.column_stack([points["x_m"], points["y_m"]])).query(np.stack([x_m, y_m], axis=-1))[1]]


def index_when_tip_passes(run: Run, height_m: float) -> int:
    """Output index at which the tip first is at a height in m or above; the last one where it never is."""
    last = output_times(run).size - 1
    return next((index for index in range(last) if float(np.max(fields_at(run, "fracture", index)["y_m"])) >= height_m), last)


MAGNIFIED = 300.0  # of openings in Fig 1: a millimetre becomes a third of a 1 m cell
FINE_TIP_M = 10.0
# Of the run that Fig 2 shows: cells small enough for a smooth field, until the tip has doubled its height; 5 s.
FINE = ("numerics.mechanics=quasistatic", "numerics.cell_m=0.25", "numerics.far_cell_m=0.5", f"stop.tip_y_m={FINE_TIP_M}", "output.fields_every_s=0.02")


def catalogue(runs: list[Run], root: Path, experiments: Path) -> list[Figure]:
    """The study's eight figures, from runs below a root folder."""
    of = {number: [run for run in runs if run.number == number] for number in range(1, 7)}
    upward, sideways = [of[number] for number in (1, 2, 3, 4)], [of[5], of[6]]
    first = partial(Figure, command="ci/reproduce --only exp1")
    return [
        first("fig1", lambda: copies_figure(_crack_choices(of[1]), MAGNIFIED), draw_copies, "fig1", label="Figure 1"),
        first("fig2", partial(_pressure_choice, of[1], root, experiments), draw_pressure, "fig2", label="Figure 2"),
        *(Figure(f"fig{number + 2}", partial(height_figure, of[number], sum(upward, [])), draw_heights, "heights", f"ci/reproduce --only exp{number}",
                 f"Figure {number + 2}", drawn_of(of[number])) for number in (1, 2, 3, 4)),
        Figure("fig7", partial(profile_figure, of[4]), draw_profiles, "fig7", "ci/reproduce --only exp4", "Figure 7", drawn_of(of[4])),
        Figure("fig8", partial(path_figure, sideways), draw_paths, "fig8", "ci/reproduce --only exp5,exp6", "Figure 8", drawn_of(sum(sideways, []))),
    ]  # fmt: skip


def _with_fields(runs: list[Run], variants: tuple[str, ...]) -> Run:
    """The first of the named variants whose fields can be read."""
    for name in variants:
        for run in runs:
            if run.variant == name and run.drawable and (run.folder / "result.h5").exists():
                return run
    raise NotAvailable(f"no run of {listed([plain(name) for name in variants])} has fields")


def _crack_choices(group: list[Run]) -> list[tuple[Run, int, str]]:
    """A crack of Experiment 1 by itself, and one that has met an interface."""
    alone = _with_fields(group, ("perfect",))
    choices = [(alone, index_when_tip_passes(alone, 1.5 * max(layout_of(alone).fracture_y_m)), "tip")]
    for name in ("weak", "friction", "soft"):
        for met in (run for run in group if run.variant == name and run.drawable):
            index = index_when_tip_passes(met, max(layout_of(met).heights_m, default=0.0) + 3.0 * met.cell_m)
            if any(split.size for split in divided(met, index).values()):
                return [*choices, (met, index, "interface")]
    return choices


def _pressure_choice(group: list[Run], root: Path, experiments: Path) -> Shown:
    """Experiment 1 with a perfect interface just before the tip has doubled its height: in small cells, or where that cannot be run as it is."""
    run = _with_fields(group, ("perfect", "friction", "weak", "soft"))
    outcome, _ = make(Job(experiments / f"{run.experiment}.toml", "perfect", root / "figure2" / run.experiment / "perfect", FINE))
    run = load_run(root / "figure2" / run.experiment / "perfect") if outcome.ok else run
    if output_times(run).size == 0:
        raise NotAvailable("no output times")
    return pressure_figure(run, max(0, index_when_tip_passes(run, 2.0 * max(layout_of(run).fracture_y_m)) - 1))
