"""Draws the experiments: the copies of nodes about a crack (Fig 1), a pressurised crack (2), height against inlet pressure beside the layers (3 to 6), openings (7),
paths (8), and the README's picture."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle, Wedge

from reports.charts.style import (
    COLOURS, DOTTED, FLAG, FLUID, INK, KIND_NAMES, MARKERS, ONE_COLUMN, PALE, SHADES, SOFT, STIFF, TWO_COLUMNS, entry, interface_lines, line_of,
    new_figure, panel_rows, put_legend, wrapped,
)  # fmt: skip
from reports.words import Shown

HEIGHT = "height above the symmetry line (m)"


def draw_layout(axes: Axes, layout: Shown, thick: str, thin: str) -> None:
    """Layers, interfaces and the first fracture of an experiment on axes of their own, m; thick, thin: which words of a layer stand in it."""
    for layer in layout.layers:
        corner, sides = ((0, layer.from_m), (layout.width_m, layer.to_m - layer.from_m))
        if layout.along == "x":
            corner, sides = corner[::-1], (sides[1], layout.height_m)
        axes.add_patch(Rectangle(corner, *sides, facecolor=STIFF if layer.stiffness > 0.99 else SOFT, edgecolor="none"))
        text = getattr(layer, thin if layer.to_m - layer.from_m < 0.2 * layout.height_m else thick)
        axes.text(corner[0] + 0.04 * layout.width_m, corner[1] + 0.5 * sides[1], text, fontsize=6.0, va="center", color=INK)
    for place in layout.interfaces:
        (axes.axhline if layout.along == "y" else axes.axvline)(place.at_m, color=COLOURS["weak"], linewidth=1.2)
    axes.plot(layout.fracture_x_m, layout.fracture_y_m, color=FLUID, linewidth=2.4, solid_capstyle="butt", zorder=5)
    axes.set(xlim=(0, layout.width_m), ylim=(0, layout.height_m), xticks=[])
    for spine in axes.spines.values():
        spine.set_visible(True)


def draw_heights(data: Shown, width_mm: float) -> Figure:
    """The layers on the left, and at the same heights the tip against inlet pressure on axes that all experiments share."""
    wide = width_mm > ONE_COLUMN
    figure = new_figure(width_mm, 88.0 if wide else 82.0)
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=(1.0, 3.4) if wide else (1.0, 2.6))
    draw_layout(left, data.layout, "label", "line" if wide else "rock")
    left.set(ylabel=HEIGHT, title="Layers")
    right.grid(True)
    interface_lines(right, data.layout.heights_m)
    overlaid = any(curve.beside for curve in data.curves)
    for curve in data.curves:  # the tip stays until the row that says it has grown
        look = line_of(curve.variant, curve.beside, overlaid)
        right.plot(curve.inlet_MPa, curve.height_m, drawstyle="steps-post", **look)
        for mark in () if curve.beside else curve.marks:
            right.plot([mark.inlet_MPa], [mark.height_m], marker=MARKERS[mark.kind], markersize=4.5, color=look["color"], markeredgecolor="white",
                       markeredgewidth=0.6, linestyle="none", zorder=5)
        if curve.failed:
            right.plot(curve.inlet_MPa[-1:], curve.height_m[-1:], marker="X", markersize=7, color=FLAG, zorder=6)
    right.set(xlabel="inlet pressure (MPa)", xlim=data.pressure_MPa, title=data.name)
    handles = [entry(wrapped(curve.label, 64 if wide else 48), **line_of(curve.variant, curve.beside, overlaid)) for curve in data.curves]
    kinds = {mark.kind for curve in data.curves for mark in curve.marks}
    handles += [entry(name, marker=MARKERS[kind], color=INK, linestyle="none", markersize=4.5) for kind, name in KIND_NAMES.items() if kind in kinds]
    put_legend(figure, handles, 2 if wide else 1)
    return figure


def draw_profiles(data: Shown, width_mm: float) -> Figure:
    """Fig 7: a panel a run on common axes, the profiles light first and dark last."""
    columns = min(len(data.panels), 3 if width_mm > ONE_COLUMN else 2)
    rows = [data.panels[k : k + columns] for k in range(0, len(data.panels), columns)]
    figure = new_figure(width_mm, 8.0 + 78.0 * len(rows))
    for axes, panel, first in panel_rows(figure, rows, sharex=True, sharey=True):
        axes.grid(True)
        interface_lines(axes, panel.interfaces_m)
        for profile in panel.profiles:
            axes.plot(profile.opening_mm, profile.height_m, color=SHADES[round(profile.shade * (len(SHADES) - 1))], linewidth=1.4, label=f"{profile.inlet_MPa:.2f}")
        axes.set_title(wrapped(panel.heading, 34 if width_mm > ONE_COLUMN else 20))
        axes.set(xlabel="opening (mm)", xlim=(0, 1.05 * data.opening_mm), ylim=(0, 1.04 * data.height_m), ylabel=HEIGHT if first else "")
        axes.legend(title="inlet (MPa)", loc="upper right", title_fontsize=7.0, fontsize=6.0)
    return figure


def draw_paths(data: Shown, width_mm: float) -> Figure:
    """Fig 8: a panel an experiment, its layout as an inset beside the paths."""
    wide = width_mm > ONE_COLUMN
    rows = [data.panels] if wide else [[panel] for panel in data.panels]
    figure = new_figure(width_mm, 118.0 * len(rows))
    for axes, panel, _ in panel_rows(figure, rows):
        _draw_path_panel(axes, panel)
    return figure


def _draw_path_panel(axes: Axes, panel: Shown) -> None:
    """The paths of one experiment in their window, m."""
    x0, x1, y0, y1 = panel.window_m
    axes.grid(True)
    for place in panel.layout.interfaces:
        if panel.layout.along == "x" and x0 <= place.at_m <= x1:
            axes.axvline(place.at_m, color=PALE, linewidth=1.2, linestyle=DOTTED)
            axes.annotate("interface", (place.at_m, y0), xytext=(3, 5), textcoords="offset points", va="bottom", rotation=90, fontsize=6.5, color=INK)
    overlaid = any(one.beside for one in panel.paths)
    for path in panel.paths:
        axes.plot(path.x_m, path.y_m, **line_of(path.variant, path.beside, overlaid))
    scale = "" if panel.magnified < 1.05 else f", x drawn {panel.magnified:.2g} times as large"
    axes.set(xlim=(x0, x1), ylim=(y0, y1), title=f"{panel.name}{scale}", xlabel="x (m)" + (f"; {panel.aside}" if panel.aside else ""), ylabel=HEIGHT)
    axes.set_box_aspect(panel.aspect)
    handles = [entry(wrapped(path.label, 44), **line_of(path.variant, path.beside, overlaid)) for path in panel.paths]
    axes.legend(handles=handles, title="end of the path to the soft side, largest turn", loc="upper left", bbox_to_anchor=(0.0, -0.13), title_fontsize=7.0,
                fontsize=6.5)
    inset = axes.inset_axes((0.02 if panel.lean > 0 else 0.72, 0.70, 0.27, 0.29))
    draw_layout(inset, panel.layout, "rock", "rock")
    inset.set_aspect("equal")
    inset.set_yticks([])


SIGNS = {"reproduced": "✓", "only under a variant": "(✓)", "not reproduced": "✗"}


def draw_front_picture(panels: Sequence[Shown]) -> Figure:
    """The README's picture: two rows of three panels of curves, each claim's id with its verdicts below the title, and one legend."""
    figure = new_figure(TWO_COLUMNS, 128.0)
    for axes, panel, _ in panel_rows(figure, [panels[:3], panels[3:]]):
        axes.grid(True)
        axes.set_title(f"{panel.title}\n\n", color=INK)
        for place in panel.interfaces_m if panel.is_path else ():
            axes.axvline(place, color=INK, linewidth=0.9, linestyle=DOTTED, zorder=1)
        interface_lines(axes, () if panel.is_path else panel.interfaces_m)
        for curve in panel.curves:
            axes.plot(curve.x, curve.height_m, drawstyle="default" if panel.is_path else "steps-post", **line_of(curve.variant, curve.beside, True))
        axes.set(xlabel="x (m)" if panel.is_path else "inlet pressure (MPa)", ylabel="height (m)")
        for place, (words, above) in enumerate((("1 m cells, without inertia", 1.08), ("1 m cells, with inertia", 1.02)), 1):
            told = "   ".join(f"{verdict[0]} {SIGNS.get(verdict[place], '?')}" for verdict in panel.verdicts)
            axes.text(0.0, above, f"{words}:  {told}", transform=axes.transAxes, fontsize=6.0)
    variants = dict.fromkeys(curve.variant for panel in panels for curve in panel.curves)
    lines = [entry(name.replace("_", " below "), **line_of(name, solid=True)) for name in variants]
    lines.append(entry("with inertia (thin, dashed)", color=INK, linewidth=1.1, linestyle=(0, (4.5, 2.2))))
    put_legend(figure, lines + [entry(f"{sign} claim {verdict}", linestyle="") for verdict, sign in SIGNS.items()], 5)
    return figure


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
        _draw_copies(axes, panel)
    handles = [
        entry("crack points, polyline", color=FLUID, marker="o", markersize=4, markerfacecolor="white"),
        entry(f"faces, opening ×{data.magnified:g}", color=INK, linewidth=1.4), entry("interface", color=COLOURS["weak"], linewidth=1.6),
        entry("particles on the left", color=_SIDES[-1][0], marker=".", linestyle="none"),
        entry("on the right (lighter: above)", color=_SIDES[1][0], marker=".", linestyle="none"),
        entry("node; a sector a copy", color=PALE, marker="o", linestyle="none"),
    ]
    put_legend(figure, handles, 3 if wide else 1)
    return figure


def _draw_copies(axes: Axes, panel: Shown) -> None:
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
