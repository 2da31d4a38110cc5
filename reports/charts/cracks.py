"""Draws Figure 1, the copies of nodes about a crack, and Figure 2, a pressurised crack."""

from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Wedge

from reports.charts.style import COLOURS, FLUID, INK, ONE_COLUMN, PALE, entry, new_figure, panel_rows, put_legend
from reports.words import Shown

# By side of the fracture (0: ahead of its tip), then below and above the first interface.
_SIDES: dict[int, tuple[str, str, str]] = {
    -1: ("#2f6db3", "#8db8e2", "#c9dff3"), 1: ("#c2571a", "#f0a878", "#f9d9c2"), 0: ("#7a7a7a", "#c4c4c4", "#e2e2e2"),
}
# A copy's sector by its signs about (fracture, first interface); None: whichever is not split.
_SECTORS: dict[tuple[int, int | None], tuple[float, float]] = {
    (-1, None): (90, 270), (1, None): (-90, 90), (0, None): (0, 360), (-1, -1): (180, 270), (-1, 1): (90, 180), (1, -1): (270, 360),
    (1, 1): (0, 90), (0, -1): (180, 360), (0, 1): (0, 180),
}


def draw_copies(data: Shown, width_mm: float) -> Figure:
    """Fig 1: panels of nodes with their copies, particles by side, crack points and opened faces."""
    wide = width_mm > ONE_COLUMN
    rows = [data.panels] if wide else [[panel] for panel in data.panels]
    figure = new_figure(width_mm, 14.0 + len(rows) * (1.02 * width_mm / len(rows[0]) + 6.0))
    for axes, panel, _ in panel_rows(figure, rows):
        _draw_panel(axes, panel)
    handles = [
        entry("crack points, polyline", color=FLUID, marker="o", markersize=4, markerfacecolor="white"),
        entry(f"faces, opening ×{data.magnified:g}", color=INK, linewidth=1.4), entry("interface", color=COLOURS["weak"], linewidth=1.6),
        entry("particles on the left", color=_SIDES[-1][0], marker=".", linestyle="none"),
        entry("on the right (lighter: above)", color=_SIDES[1][0], marker=".", linestyle="none"),
        entry("node; a sector a copy", color=PALE, marker="o", linestyle="none"),
    ]
    put_legend(figure, handles, 3 if wide else 1)
    return figure


def _draw_panel(axes: Axes, panel: Shown) -> None:
    """One crack's surroundings, m."""
    x0, x1, y0, y1 = panel.window_m
    axes.add_collection(LineCollection([((x, y0), (x, y1)) for x in panel.grid_x_m], colors="#dddddd", linewidths=0.7))
    axes.add_collection(LineCollection([((x0, y), (x1, y)) for y in panel.grid_y_m], colors="#dddddd", linewidths=0.7))
    for (side, level), (x_m, y_m) in panel.particles.items():
        axes.plot(x_m, y_m, ".", markersize=2.2, color=_SIDES[side][min(level, 2)], zorder=2)
    for height in panel.interfaces_m:
        axes.plot([x0, x1], [height, height], color=COLOURS["weak"], linewidth=1.6, zorder=3)
    for x_m, y_m in panel.faces:
        axes.plot(x_m, y_m, color=INK, linewidth=1.4, zorder=4)
    axes.plot(panel.points_x_m, panel.points_y_m, "-o", color=FLUID, linewidth=1.2, markersize=4, markerfacecolor="white", zorder=6)
    for node in panel.nodes:
        _draw_node(axes, node, 0.014 * (x1 - x0))
    axes.set(xlim=(x0, x1), ylim=(y0, y1))
    axes.set_aspect("equal")
    axes.set(title=panel.heading, xlabel="x (m)", ylabel="height above the symmetry line (m)")


def _draw_node(axes: Axes, node: Shown, radius_m: float) -> None:
    """A node: a small dot where it has one copy, a disc with a sector for each where it has more."""
    if len(node.copies) < 2:
        axes.plot([node.x_m], [node.y_m], "o", markersize=1.8, color=PALE, zorder=3)
        return
    split_by_crack = any(copy[0] != node.copies[0][0] for copy in node.copies)
    split_by_interface = any(copy[1:] != node.copies[0][1:] for copy in node.copies)
    for copy in node.copies:
        second = copy[1] if split_by_interface and len(copy) > 1 else None
        colour = _SIDES[copy[0]][1 if len(copy) > 1 and copy[1] > 0 else 0]
        axes.add_patch(Wedge((node.x_m, node.y_m), 1.6 * radius_m, *_SECTORS[(copy[0] if split_by_crack else 0, second)], facecolor=colour,
                             edgecolor="white", linewidth=0.4, zorder=5))


def draw_pressure(data: Shown, width_mm: float) -> Figure:
    """Fig 2: horizontal stress about the crack; pressure, opening and permeability along it."""
    wide = width_mm > ONE_COLUMN
    figure = new_figure(width_mm, 92.0 if wide else 170.0)
    left, right = figure.subfigures(1, 2, width_ratios=(1.2, 1.0)) if wide else figure.subfigures(2, 1, height_ratios=(1.0, 1.0))
    field = left.subplots()
    image = field.pcolormesh(data.edges_x_m, data.edges_y_m, data.s_xx_MPa, cmap="RdBu_r", rasterized=True,
                             vmin=data.centre_MPa - data.range_MPa, vmax=data.centre_MPa + data.range_MPa)
    field.plot(data.crack_x_m, data.crack_y_m, color="#1c1c1d", linewidth=1.2)
    field.set_aspect("equal")
    field.set(xlim=data.view_m[:2], ylim=data.view_m[2:], xlabel="x (m)", ylabel="height above the symmetry line (m)", title="Horizontal stress")
    left.colorbar(image, ax=field, shrink=0.85, extend="both").set_label("total, MPa, tension positive; white: in situ")
    rows = right.subplots(3, 1, sharex=True)
    lines = (
        (data.pressure, FLUID, "pressure over\nthat of the inlet"), (data.opening_mm, COLOURS["soft"], "opening (mm)"),
        (data.permeability_mm2, COLOURS["weak"], "permeability\nw²/12 (mm²)"),
    )
    for axes, (values, colour, label) in zip(rows, lines):
        axes.grid(True)
        axes.plot(data.arc_m, values, "-o", color=colour, markersize=1.8, linewidth=1.2)
        axes.set_ylabel(label)
        axes.set_ylim(bottom=0)
    rows[0].set_title("Along the fracture")
    rows[2].set_xlabel("distance from the inlet along the fracture (m)")
    return figure
