"""Draws the experiments: height against inlet pressure beside the layers (Figs 3 to 6), openings (7), paths (8), and the README's picture."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from reports.charts.style import (
    COLOURS, DOTTED, FLAG, FLUID, INK, KIND_NAMES, MARKERS, ONE_COLUMN, PALE, SHADES, SOFT, STIFF, TWO_COLUMNS, entry, interface_lines, line_of, new_figure, panel_rows,
    put_legend, wrapped,
)
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
