"""Prepares Figures 1 and 2: the copies of nodes about a crack, and the stress and pressure of a pressurised one."""

import numpy as np
from scipy.spatial import cKDTree

from reports.runs import Arrays, NotAvailable, Run, fields_at, interfaces_at, layout_of, output_times
from reports.words import Shown, mechanics_name, metres, mpa, number, plain, share

SQUARES = 160  # of Fig 2 along either side
WINDOW_CELLS = 9  # width of Fig 1's panels: few enough for single nodes and particles to be told apart
REACH: dict[str, float] = {"bspline2": 1.5, "linear": 1.0, "gimp": 1.25}  # half support of a node, cells


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
    count = output_times(run).size
    for index in range(count):
        if float(np.max(fields_at(run, "fracture", index)["y_m"])) >= height_m:
            return index
    return count - 1
