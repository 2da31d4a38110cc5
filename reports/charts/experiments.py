"""Draws the experiments: layouts, height against inlet pressure (Figs 3 to 6), openings (7), paths (8), and open choices."""

from collections.abc import Sequence
from typing import Any

from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from reports.charts.style import (
    COLOURS, DOTTED, FLAG, FLUID, INK, KIND_NAMES, MARKERS, PALE, entry, interface_lines, line_of, new_figure, panel_rows, put_legend,
)
from reports.shown import Shown

HEIGHT = "height above the symmetry line (m)"
_STIFF, _SOFT = "#d9d4ca", "#f4ecd2"
_CHOICE_DASHES: tuple[Any, ...] = ("-", (0, (5, 1.8)), (0, (1.2, 1.4)), (0, (5, 1.4, 1.2, 1.4)))


def draw_layout(axes: Axes, layout: Any, small: bool = False) -> None:
    """The layout of an experiment on axes of its own, m: layers, interfaces, fracture, edges and in-situ stress."""
    for layer in layout.layers:
        _draw_layer(axes, layout, layer, small)
    for place in layout.interfaces:
        line = axes.axhline if layout.along == "y" else axes.axvline
        line(place.at_m, color=COLOURS["weak"], linewidth=1.2 if small else 1.6)
        if not small and layout.along == "y":
            axes.annotate(f"interface at {place.at_m:g} m", (layout.width_m, place.at_m), xytext=(-3, 2), textcoords="offset points", ha="right",
                          va="bottom", fontsize=7, color=COLOURS["weak"])
    axes.plot(layout.fracture_x_m, layout.fracture_y_m, color=FLUID, linewidth=2.0 if small else 3.0, solid_capstyle="butt", zorder=5)
    axes.set(xlim=(0, layout.width_m), ylim=(0, layout.height_m))
    axes.set_aspect("equal")
    if small:
        axes.set_xticks([])
        axes.set_yticks([])
        for spine in axes.spines.values():
            spine.set_visible(True)
        return
    _draw_edges(axes, layout)
    axes.set(xlabel="x (m)", ylabel=HEIGHT)


def _draw_layer(axes: Axes, layout: Any, layer: Shown, small: bool) -> None:
    """One layer, filled by its stiffness, with its rock's name."""
    size = layer.to_m - layer.from_m
    if layout.along == "y":
        corner, sides, at = (0, layer.from_m), (layout.width_m, size), (0.04 * layout.width_m, layer.from_m + 0.5 * size)
        thin = size < 0.2 * layout.height_m
    else:
        corner, sides, at = (layer.from_m, 0), (size, layout.height_m), (layer.from_m + 0.06 * layout.width_m, 0.5 * layout.height_m)
        thin = size < 0.2 * layout.width_m
    axes.add_patch(Rectangle(corner, *sides, facecolor=_STIFF if layer.stiffness > 0.99 else _SOFT, edgecolor="none"))
    text = layer.rock if small else layer.line if thin else layer.label
    axes.text(*at, text, fontsize=6.5 if small or thin else 7.5, va="center", color=INK)


def _draw_edges(axes: Axes, layout: Any) -> None:
    """In-situ stress as arrows from outside, and the words for each edge."""
    width, height = layout.width_m, layout.height_m
    arrow = {"arrowstyle": "-|>", "color": INK, "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0}
    for fraction in (0.25, 0.5, 0.75):
        axes.annotate("", (fraction * width, height), xytext=(0, 20), textcoords="offset points", arrowprops=arrow)
        axes.annotate("", (width, fraction * height), xytext=(20, 0), textcoords="offset points", arrowprops=arrow)
    axes.annotate(f"{layout.vertical_Pa / 1e6:g} MPa, top {layout.edges['top']}", (0.5 * width, height), xytext=(0, 22),
                  textcoords="offset points", ha="center", fontsize=7.5)
    axes.annotate(f"{layout.horizontal_Pa / 1e6:g} MPa, sides {layout.edges['sides']}", (width, 0.5 * height), xytext=(22, 0),
                  textcoords="offset points", va="center", rotation=90, fontsize=7.5)
    axes.plot([0, width], [0, 0], color=PALE, linewidth=2.5, linestyle=(0, (1, 1)), clip_on=False, zorder=6)
    axes.annotate(f"bottom: {layout.edges['bottom']}", (0.98 * width, 0), xytext=(0, 4), ha="right", textcoords="offset points", fontsize=7,
                  color=INK)


def draw_heights(data: Shown) -> Figure:
    """Layout, heights over the whole block, and the surroundings of the interfaces."""
    figure = new_figure(13.0, 5.6, data.title, 120)
    left, middle, right = figure.subplots(1, 3, gridspec_kw={"width_ratios": (1.0, 1.05, 1.25)})
    draw_layout(left, data.layout)
    left.set_title("Layout")
    overlaid = any(curve.beside for curve in data.curves)
    views = ((middle, (0, data.layout.height_m), data.pressure_MPa, "Whole block"), (right, data.zoom_m, data.zoom_MPa, "About the interfaces"))
    for axes, heights_m, pressures_MPa, title in views:
        axes.grid(True)
        interface_lines(axes, data.layout.heights_m)
        for curve in data.curves:  # the tip stays until the row that says it has grown
            axes.plot(curve.inlet_MPa, curve.height_m, drawstyle="steps-post", **line_of(curve.variant, curve.beside, overlaid))
            for mark in curve.marks:
                _draw_mark(axes, mark, curve)
            if curve.failed:
                axes.plot(curve.inlet_MPa[-1:], curve.height_m[-1:], marker="X", markersize=9, color=FLAG, zorder=6)
        axes.set(xlabel="inlet pressure (MPa)", ylabel="fracture height (m)", xlim=pressures_MPa, ylim=heights_m, title=title)
    _height_legend(figure, data)
    return figure


def _draw_mark(axes: Axes, mark: Shown, curve: Shown) -> None:
    """One event; an arrest decided by J at an interface gets a ring of its own. The mechanics shown beside is hollow."""
    colour = COLOURS.get(curve.variant, PALE)
    if curve.beside:
        look: dict[str, Any] = {"markersize": 4.2, "markerfacecolor": "white", "markeredgecolor": colour, "markeredgewidth": 0.8, "zorder": 4.5}
    else:
        thin = mark.kind in ("stop", "reach_interface")
        look = {"markersize": 6, "color": colour, "markeredgecolor": colour if thin else "white", "markeredgewidth": 1.6 if thin else 0.7,
                "zorder": 5}
    axes.plot([mark.inlet_MPa], [mark.height_m], marker=MARKERS[mark.kind], clip_on=True, **look)
    if mark.flag:
        axes.plot([mark.inlet_MPa], [mark.height_m], marker="o", markersize=13, markerfacecolor="none", markeredgecolor=FLAG, markeredgewidth=1.5,
                  zorder=6, clip_on=True)


def _height_legend(figure: Figure, data: Shown) -> None:
    """Variants and kinds of event below the charts."""
    told = [curve for curve in data.curves if not curve.beside]
    handles = [entry(curve.label, **line_of(curve.variant, solid=len(told) < len(data.curves))) for curve in told]
    beside = dict.fromkeys(curve.mechanics for curve in data.curves if curve.beside)
    handles += [entry(f"{name} (thin, hollow)", **{**line_of("", True), "color": INK}) for name in beside]
    kinds = {mark.kind for curve in data.curves for mark in curve.marks}
    handles += [entry(name, marker=MARKERS[kind], color=INK, linestyle="none") for kind, name in KIND_NAMES.items() if kind in kinds]
    if data.flagged:
        handles.append(entry("J at interface: not to be trusted", marker="o", markersize=11, markerfacecolor="none", markeredgecolor=FLAG,
                             markeredgewidth=1.5, linestyle="none"))
    put_legend(figure, handles, 6)


def draw_profiles(data: Shown) -> Figure:
    """Fig 7: one panel a variant on common axes, the profiles light first and dark last."""
    rows = [[panel for panel in data.panels if panel.mechanics == name] for name in dict.fromkeys(panel.mechanics for panel in data.panels)]
    columns = max(map(len, rows))
    figure = new_figure(5.4 * columns + 0.8, 0.6 + 5.6 * len(rows), data.title, 56 * columns)
    colours = colormaps["viridis_r"]
    for axes, panel, first in panel_rows(figure, rows, sharex=True, sharey=True):
        axes.grid(True)
        interface_lines(axes, panel.interfaces_m)
        for profile in panel.profiles:
            axes.plot(profile.opening_mm, profile.height_m, color=colours(0.12 + 0.85 * profile.shade), linewidth=1.8,
                      label=f"{profile.time_s:.2f} s, {profile.inlet_MPa:.2f} MPa")
        axes.set(title=panel.heading, xlabel="opening (mm)")
        axes.legend(title="time, inlet pressure", loc="upper right", title_fontsize=8.5)
        axes.set(xlim=(0, 1.05 * data.opening_mm), ylim=(0, 1.04 * data.height_m))
        if first:
            axes.set_ylabel(HEIGHT)
    return figure


def draw_paths(data: Shown) -> Figure:
    """Fig 8: one panel an experiment, its layout as an inset beside the paths."""
    figure = new_figure(6.4 * len(data.panels) + 0.4, 7.0, data.title, 66 * len(data.panels))
    for axes, panel, _ in panel_rows(figure, [data.panels]):
        _draw_path_panel(axes, panel)
    return figure


def _draw_path_panel(axes: Axes, panel: Shown) -> None:
    """The paths of one experiment in their window, m."""
    x0, x1, y0, y1 = panel.window_m
    axes.grid(True)
    for place in panel.layout.interfaces:
        if panel.layout.along == "x" and x0 <= place.at_m <= x1:
            axes.axvline(place.at_m, color=PALE, linewidth=1.2, linestyle=DOTTED)
            axes.annotate("interface", (place.at_m, y0), xytext=(3, 5), textcoords="offset points", va="bottom", rotation=90, fontsize=7.5, color=INK)
    for path in panel.paths:
        axes.plot(path.x_m, path.y_m, label=path.label, **line_of(path.variant, path.beside, any(one.beside for one in panel.paths)))
        if not path.beside:
            axes.plot([path.kink_at_m[0]], [path.kink_at_m[1]], marker="D", markersize=4.5, color=COLOURS.get(path.variant, PALE),
                      markeredgecolor="white", markeredgewidth=0.6, zorder=5)
    axes.set(xlim=(x0, x1), ylim=(y0, y1))
    axes.set_box_aspect(panel.aspect)
    scale = "" if panel.magnified < 1.05 else f", horizontally magnified ×{panel.magnified:.2g}"
    axes.set(title=f"{panel.name}: paths{scale}", xlabel="x (m)" + (f"   [{panel.aside}]" if panel.aside else ""), ylabel=HEIGHT)
    axes.legend(title="shift of the tip to the soft side, largest turn (◆)", loc="lower right" if panel.lean > 0 else "lower left",
                title_fontsize=8.5, frameon=True, facecolor="white", edgecolor="none", framealpha=0.85)
    draw_layout(axes.inset_axes((0.02 if panel.lean > 0 else 0.72, 0.70, 0.27, 0.29)), panel.layout, small=True)


SIGNS = {"reproduced": "✓", "only under a variant": "(✓)", "not reproduced": "✗"}


def draw_front_picture(panels: Sequence[Shown]) -> Figure:
    """The README's picture: two rows of three panels of curves, each claim's id with its verdicts below the title, and one legend."""
    figure = new_figure(11.0, 7.4)
    for axes, panel, _ in panel_rows(figure, [panels[:3], panels[3:]]):
        axes.grid(True)
        axes.set_title(f"{panel.title}\n\n", color=INK)
        for place in panel.interfaces_m if panel.is_path else ():
            axes.axvline(place, color=INK, linewidth=0.9, linestyle=DOTTED, zorder=1)
        interface_lines(axes, () if panel.is_path else panel.interfaces_m)
        for curve in panel.curves:
            axes.plot(curve.x, curve.height_m, drawstyle="default" if panel.is_path else "steps-post", **line_of(curve.variant, curve.beside, True))
        axes.set(xlabel="x (m)" if panel.is_path else "inlet pressure (MPa)", ylabel="height (m)")
        for place, (words, above) in enumerate((("without inertia", 1.08), ("with inertia", 1.02)), 1):
            told = "   ".join(f"{verdict[0]} {SIGNS.get(verdict[place], '?')}" for verdict in panel.verdicts)
            axes.text(0.0, above, f"{words}:  {told}", transform=axes.transAxes, fontsize=8.5)
    variants = dict.fromkeys(curve.variant for panel in panels for curve in panel.curves)
    lines = [entry(name.replace("_", " below "), **line_of(name, solid=True)) for name in variants]
    lines.append(entry("with inertia (thin, dashed)", color=INK, linewidth=1.1, linestyle=(0, (4.5, 2.2))))
    put_legend(figure, lines + [entry(f"{sign} claim {verdict}", linestyle="") for verdict, sign in SIGNS.items()], 5)
    return figure


def draw_choice(data: Shown) -> Figure:
    """An open point, a panel an experiment: the default wide and pale, the choices thin and dashed; the colour says which interface."""
    columns = max(len(row) for row in data.rows)
    width = max(8.2, 4.6 * columns + 0.6)
    figure = new_figure(width, 0.9 + 4.1 * len(data.rows), data.title, int(10.4 * width))
    for axes, panel, _ in panel_rows(figure, data.rows):
        axes.grid(True)
        for place in panel.interfaces:
            (axes.axvline if panel.is_path else axes.axhline)(place, color=PALE, linewidth=0.9, linestyle=DOTTED, zorder=1)
        for line in panel.lines:
            _draw_choice_line(axes, line, panel.is_path)
        axes.set(xlim=panel.x_range, ylim=panel.y_range, title=panel.heading, xlabel="x (m)" if panel.is_path else "inlet pressure (MPa)")
        axes.set(ylabel=HEIGHT if panel.is_path else "fracture height (m)")
    handles = [entry(name.replace("_", "–"), color=COLOURS.get(name, PALE), linewidth=2.4) for name in data.variants]
    names = [f"default: {data.default}", *data.choices]
    put_legend(figure, handles + [entry(name, color=INK, **_choice_look(index)) for index, name in enumerate(names)], 4 if columns > 1 else 2)
    return figure


def _choice_look(choice: int) -> dict[str, Any]:
    """Width and dashes of a choice's line; 0 is the default."""
    if choice == 0:
        return {"linewidth": 5.0, "alpha": 0.28, "linestyle": "-", "solid_capstyle": "butt", "zorder": 2.0}
    return {"linewidth": 1.5, "linestyle": _CHOICE_DASHES[choice % len(_CHOICE_DASHES)], "zorder": 3.0}


def _draw_choice_line(axes: Axes, line: Shown, is_path: bool) -> None:
    """One run."""
    colour = COLOURS.get(line.variant, PALE)
    axes.plot(line.x, line.y, drawstyle="default" if is_path else "steps-post", color=colour, **_choice_look(line.choice))
    if line.failed:
        axes.plot(line.x[-1:], line.y[-1:], marker="X", markersize=8, color=FLAG, zorder=6)
    elif line.choice:
        axes.plot(line.x[-1:], line.y[-1:], marker="x", markersize=4.5, color=colour, zorder=5)
