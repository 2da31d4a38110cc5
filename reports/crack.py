"""Prepares Figures 1 and 2: the copies of nodes about a crack, and the stress and pressure of a pressurised one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from reports.layout import Layout, layout_of
from reports.runs import Arrays, NotAvailable, Run, fracture_at, interfaces_at, output_times, particles_at
from reports.words import metres, mpa, number, plain

REACH_OF_LONG = 1.5  # half the diagonal of a particle eight times as long as wide, over the root of its area
WINDOW_CELLS = 9  # width of Fig 1's panels: few enough for single nodes and particles to be told apart
REACH: dict[str, float] = {"bspline2": 1.5, "linear": 1.0, "gimp": 1.25}  # half support of a node, cells


@dataclass(frozen=True)
class Node:
    """A grid node in m with the sides its copies stand for: one tuple of signs a copy."""

    x_m: float
    y_m: float
    copies: tuple[tuple[int, ...], ...]


@dataclass(frozen=True)
class CopiesPanel:
    """The surroundings of a crack; m; sides of particles as signs about (fracture, interface)."""

    heading: str
    window_m: tuple[float, float, float, float]
    grid_x_m: tuple[float, ...]
    grid_y_m: tuple[float, ...]
    points_x_m: np.ndarray
    points_y_m: np.ndarray
    faces: tuple[tuple[np.ndarray, np.ndarray], ...]
    interfaces_m: tuple[float, ...]
    particles: dict[tuple[int, int], tuple[np.ndarray, np.ndarray]]
    nodes: tuple[Node, ...]


@dataclass(frozen=True)
class CopiesFigure:
    """Panels of Fig 1 and how much the openings in it are magnified."""

    title: str
    panels: tuple[CopiesPanel, ...]
    magnified: float


@dataclass(frozen=True)
class PressureFigure:
    """Fig 2 at one instant: stress in MPa on cells in m, and along the fracture: opening mm, permeability m2."""

    title: str
    edges_x_m: np.ndarray
    edges_y_m: np.ndarray
    s_xx_MPa: np.ndarray
    centre_MPa: float
    range_MPa: float
    view_m: tuple[float, float, float, float]
    crack_x_m: np.ndarray
    crack_y_m: np.ndarray
    interfaces_m: tuple[float, ...]
    arc_m: np.ndarray
    pressure: np.ndarray
    opening_mm: np.ndarray
    permeability_m2: np.ndarray
    inlet_MPa: float
    time_s: float
    source: str


def side_of(x_m: np.ndarray, y_m: np.ndarray, path_x_m: np.ndarray, path_y_m: np.ndarray) -> tuple[Arrays, ...]:
    """For points: sign of the distance to the extended polyline (on it counts as +), and whether behind its tip."""
    best = np.full(x_m.shape, np.inf)
    sign = np.ones(x_m.shape, dtype=int)
    behind = np.zeros(x_m.shape, dtype=bool)
    last = path_x_m.size - 2
    for k in range(path_x_m.size - 1):
        dx, dy = path_x_m[k + 1] - path_x_m[k], path_y_m[k + 1] - path_y_m[k]
        square = dx * dx + dy * dy
        if square == 0.0:
            continue
        s = ((x_m - path_x_m[k]) * dx + (y_m - path_y_m[k]) * dy) / square
        clipped = np.clip(s, 0.0 if k > 0 else -np.inf, np.inf if k == last else 1.0)
        distance = np.hypot(x_m - path_x_m[k] - clipped * dx, y_m - path_y_m[k] - clipped * dy)
        nearer = distance < best
        cross = (x_m - path_x_m[k]) * dy - (y_m - path_y_m[k]) * dx
        sign = np.where(nearer, np.where(cross >= 0.0, 1, -1), sign)
        behind = np.where(nearer, s < 1.0 if k == last else True, behind)
        best = np.where(nearer, distance, best)
    return sign, behind


def copies_figure(pairs: list[tuple[Run, int, str]], magnified: float) -> CopiesFigure:
    """Fig 1 from runs at given output times, each panel centred on its crack's tip or on an interface."""
    panels = tuple(_copies_panel(run, index, centre, magnified) for run, index, centre in pairs)
    if not panels:
        raise NotAvailable("no run has particles and a fracture")
    most = max(len(node.copies) for panel in panels for node in panel.nodes)
    shared = sum(len(node.copies) > 1 for panel in panels for node in panel.nodes)
    total = sum(len(panel.nodes) for panel in panels)
    title = f"{shared} of the {total} nodes shown carry a field for each side, up to {most} where surfaces cross"
    return CopiesFigure(title if most > 2 else title.split(", up")[0], panels, magnified)


def _copies_panel(run: Run, index: int, centre: str, magnified: float) -> CopiesPanel:
    """The surroundings of one crack at one output time."""
    layout, fracture, points = layout_of(run), fracture_at(run, index), particles_at(run, index)
    h = layout.cell_m
    crack_x, crack_y = fracture["x_m"], fracture["y_m"]
    tip = int(np.argmax(crack_y))
    at_y = float(crack_y[tip]) if centre == "tip" or not layout.heights_m else layout.heights_m[0]
    at_x = float(np.interp(at_y, crack_y, crack_x))
    half = 0.5 * WINDOW_CELLS * h
    low = max(0.0, at_y - (1.35 if centre == "tip" else 1.0) * half)
    window = (at_x - half, at_x + half, low, low + 2.0 * half)
    laws = divided(run, index)
    inside = _inside(points, window, 2.0 * h)
    x_m, y_m = points["x_m"][inside], points["y_m"][inside]
    sides = _sides(x_m, y_m, crack_x, crack_y, list(laws))
    reach = REACH.get(str(run.scene.get("numerics", {}).get("shape", "bspline2")), 1.5) * h
    gx, gy = _lines(window[:2], h), _lines(window[2:], h)
    divides = {x: {at: _near(split, x, h) for at, split in laws.items()} for x in gx}
    return CopiesPanel(
        heading=f"Experiment {run.number}, {plain(run.variant)}, tip at {metres(float(crack_y[tip]))}",
        window_m=window,
        grid_x_m=gx,
        grid_y_m=gy,
        points_x_m=crack_x,
        points_y_m=crack_y,
        faces=_faces(fracture, magnified),
        interfaces_m=tuple(at for at, split in laws.items() if split.size and window[2] <= at <= window[3]),
        particles=_grouped(x_m, y_m, sides),
        nodes=tuple(
            _node(a, b, x_m, y_m, sides, (crack_x, crack_y), divides[a], reach)
            for a in gx for b in gy
        ),
    )


def divided(run: Run, index: int) -> dict[float, np.ndarray]:
    """For each interface across the fracture, its height in m and the x in m of its points where it has split."""
    layout, found = layout_of(run), {}
    if layout.along != "y":
        return found
    for points in interfaces_at(run, index):
        at = float(points.get("at_m", points["y_m"][0]))
        found[at] = points["x_m"][points["split"] > 0] if "split" in points else points["x_m"]
    return dict(sorted(found.items()))


def _near(split_x_m: np.ndarray, x_m: float, h: float) -> bool:
    """Whether an interface has split within half a cell of a column of nodes."""
    return bool((np.abs(split_x_m - x_m) <= 0.5 * h).any())


def _inside(points: Arrays, window: tuple[float, float, float, float], margin_m: float) -> np.ndarray:
    """Which particles lie in a window and a margin about it."""
    x, y = points["x_m"], points["y_m"]
    in_x = (x > window[0] - margin_m) & (x < window[1] + margin_m)
    return in_x & (y > window[2] - margin_m) & (y < window[3] + margin_m)


def _lines(span: tuple[float, float], h: float) -> tuple[float, ...]:
    """Grid lines within a span, m."""
    first, last = int(np.ceil(span[0] / h - 1e-9)), int(np.floor(span[1] / h + 1e-9))
    return tuple(k * h for k in range(first, last + 1))


def _sides(x_m: np.ndarray, y_m: np.ndarray, crack_x: np.ndarray, crack_y: np.ndarray, laws: list[float]) -> np.ndarray:
    """A row of signs for each particle: about the fracture, then about every interface."""
    about_crack, _ = side_of(x_m, y_m, crack_x, crack_y)
    return np.stack([about_crack, *(np.where(y_m >= at, 1, -1) for at in laws)], axis=1)


def _grouped(x_m: np.ndarray, y_m: np.ndarray, sides: np.ndarray) -> dict[tuple[int, int], tuple[np.ndarray, ...]]:
    """Particles by their side of the fracture and the number of interfaces below them."""
    above = (sides[:, 1:] > 0).sum(axis=1)
    groups = {}
    for crack in (-1, 1):
        for level in range(int(above.max(initial=0)) + 1):
            mask = (sides[:, 0] == crack) & (above == level)
            groups[(crack, level)] = (x_m[mask], y_m[mask])
    return groups


def _node(
    at_x: float, at_y: float, x_m: np.ndarray, y_m: np.ndarray, sides: np.ndarray,
    crack: tuple[np.ndarray, np.ndarray], divides: dict[float, bool], reach_m: float,
) -> Node:
    """A node with the distinct sides that the particles in its support lie on, of surfaces that divide there."""
    near = (np.abs(x_m - at_x) < reach_m) & (np.abs(y_m - at_y) < reach_m)
    _, behind = side_of(np.array([at_x]), np.array([at_y]), *crack)
    seen = sides[near].copy()
    if not behind[0]:
        seen[:, 0] = 0
    for column, (height, yes) in enumerate(divides.items(), 1):
        if not yes:
            seen[:, column] = 1 if at_y >= height else -1
    return Node(at_x, at_y, tuple(sorted({tuple(int(s) for s in row) for row in seen})))


def _faces(fracture: Arrays, magnified: float) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """The two faces of the fracture, apart by the magnified opening, m."""
    x, y, half = fracture["x_m"], fracture["y_m"], 0.5 * magnified * fracture["opening_m"]
    tx, ty = np.gradient(x), np.gradient(y)
    length = np.where(np.hypot(tx, ty) > 0, np.hypot(tx, ty), 1.0)
    nx, ny = ty / length, -tx / length
    return ((x - half * nx, y - half * ny), (x + half * nx, y + half * ny))


def pressure_figure(run: Run, index: int) -> PressureFigure:
    """Fig 2 from one run at one output time."""
    layout, fracture, points = layout_of(run), fracture_at(run, index), particles_at(run, index)
    edges_x, edges_y, field = raster(points, points["s_xx_Pa"] / 1e6, layout)
    time_s = float(output_times(run)[index])
    inlet = float(fracture.get("inlet_Pa", np.nanmax(fracture["pressure_Pa"])))
    arc = fracture.get("arc_m", _arc(fracture))
    change = field + layout.horizontal_Pa / 1e6
    filled = float(np.max(arc[fracture["pressure_Pa"] >= 0.5 * inlet], initial=0.0))
    opening_mm = 1e3 * fracture["opening_m"]
    title = (
        f"At {mpa(inlet)} the fracture is {metres(float(np.max(arc)))} long and up to"
        f" {number(float(opening_mm.max()), 2)}\u00a0mm open; its pressure exceeds half of the inlet's over"
        f" {metres(filled)} from the inlet"
    )
    return PressureFigure(
        title=title, edges_x_m=edges_x, edges_y_m=edges_y, s_xx_MPa=field,
        centre_MPa=-layout.horizontal_Pa / 1e6,
        range_MPa=max(float(np.nanpercentile(np.abs(change), 99.0)), abs(inlet - layout.horizontal_Pa) / 1e6),
        view_m=_view(layout, fracture),
        crack_x_m=fracture["x_m"], crack_y_m=fracture["y_m"], interfaces_m=layout.heights_m,
        arc_m=arc, pressure=fracture["pressure_Pa"] / inlet, opening_mm=opening_mm,
        permeability_m2=fracture["permeability_m2"], inlet_MPa=inlet / 1e6, time_s=time_s,
        source=f"Experiment {run.number}, {plain(run.variant)}",
    )


def _view(layout: Layout, fracture: Arrays) -> tuple[float, float, float, float]:
    """A square about the fracture three times its height, within the block, m."""
    size = min(3.0 * float(np.max(fracture["y_m"])), layout.height_m, layout.width_m)
    left = min(max(0.0, float(fracture["x_m"][0]) - 0.5 * size), layout.width_m - size)
    return (left, left + size, 0.0, size)


def _arc(fracture: Arrays) -> np.ndarray:
    """Arc length along a polyline, m."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(fracture["x_m"]), np.diff(fracture["y_m"])))])


def raster(points: Arrays, values: np.ndarray, layout: Layout) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Particle values averaged over squares of one particle's spacing; NaN where there is none.

    Particles of long cells, on a graded grid, count for the squares around them as well.
    """
    spacing = float(np.sqrt(np.median(points["volume_m2"]))) if "volume_m2" in points else layout.cell_m / 2.0
    count_x, count_y = max(1, round(layout.width_m / spacing)), max(1, round(layout.height_m / spacing))
    edges_x, edges_y = np.linspace(0, layout.width_m, count_x + 1), np.linspace(0, layout.height_m, count_y + 1)
    where = (points["x_m"], points["y_m"])
    total, _, _ = np.histogram2d(*where, bins=(edges_x, edges_y), weights=values)
    hits, _, _ = np.histogram2d(*where, bins=(edges_x, edges_y))
    mean = np.divide(total, hits, out=np.full_like(total, np.nan), where=hits > 0)
    if "volume_m2" in points:
        _spread(mean, (edges_x, edges_y), points, values)
    return edges_x, edges_y, mean.T


def _spread(mean: np.ndarray, edges: tuple[np.ndarray, np.ndarray], points: Arrays, values: np.ndarray) -> None:
    """Give empty squares the value of the nearest particle that is larger than most, and no farther than its own cell may reach."""
    large = points["volume_m2"] > 1.01 * np.median(points["volume_m2"])
    empty = np.argwhere(np.isnan(mean))
    if not large.any() or not len(empty):
        return
    centres = np.column_stack([0.5 * (edge[:-1] + edge[1:])[empty[:, axis]] for axis, edge in enumerate(edges)])
    away_m, nearest = cKDTree(np.column_stack([points["x_m"][large], points["y_m"][large]])).query(centres)
    within = away_m <= REACH_OF_LONG * np.sqrt(points["volume_m2"][large][nearest])
    mean[tuple(empty[within].T)] = values[large][nearest[within]]


def index_when_tip_passes(run: Run, height_m: float) -> int:
    """Output index at which the tip first is at a height in m or above; the last one where it never is."""
    count = output_times(run).size
    for index in range(count):
        if float(np.max(fracture_at(run, index)["y_m"])) >= height_m:
            return index
    return count - 1
