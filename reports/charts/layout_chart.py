"""Draws a layout: layers, interfaces, fracture, edges and in-situ stress."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from reports.charts.style import COLOURS, FLUID, INK, PALE
from reports.layout import Layer, Layout

_STIFF, _SOFT = "#d9d4ca", "#f4ecd2"


def draw_layout(axes: Axes, layout: Layout, small: bool = False) -> None:
    """The layout of an experiment on axes of its own, m."""
    for layer in layout.layers:
        _draw_layer(axes, layout, layer, small)
    for place in layout.interfaces:
        line = axes.axhline if layout.along == "y" else axes.axvline
        line(place.at_m, color=COLOURS["weak"], linewidth=1.2 if small else 1.6)
        if not small and layout.along == "y":
            axes.annotate(
                f"interface at {place.at_m:g} m", (layout.width_m, place.at_m), xytext=(-3, 2),
                textcoords="offset points", ha="right", va="bottom", fontsize=7, color=COLOURS["weak"],
            )
    axes.plot(layout.fracture_x_m, layout.fracture_y_m, color=FLUID, linewidth=2.0 if small else 3.0,
              solid_capstyle="butt", zorder=5)
    axes.set_xlim(0, layout.width_m)
    axes.set_ylim(0, layout.height_m)
    axes.set_aspect("equal")
    if small:
        axes.set_xticks([])
        axes.set_yticks([])
        for spine in axes.spines.values():
            spine.set_visible(True)
        return
    _draw_edges(axes, layout)
    axes.set_xlabel("x (m)")
    axes.set_ylabel("height above the symmetry line (m)")


def _draw_layer(axes: Axes, layout: Layout, layer: Layer, small: bool) -> None:
    """One layer, filled by its stiffness, with its rock's name."""
    size = layer.to_m - layer.from_m
    colour = _STIFF if layer.stiffness > 0.99 else _SOFT
    if layout.along == "y":
        axes.add_patch(Rectangle((0, layer.from_m), layout.width_m, size, facecolor=colour, edgecolor="none"))
        at = (0.04 * layout.width_m, layer.from_m + 0.5 * size)
        thin = size < 0.2 * layout.height_m
    else:
        axes.add_patch(Rectangle((layer.from_m, 0), size, layout.height_m, facecolor=colour, edgecolor="none"))
        at = (layer.from_m + 0.06 * layout.width_m, 0.5 * layout.height_m)
        thin = size < 0.2 * layout.width_m
    text = layer.rock if small else layer.line if thin else layer.label
    axes.text(*at, text, fontsize=6.5 if small or thin else 7.5, va="center", color=INK)


def _draw_edges(axes: Axes, layout: Layout) -> None:
    """In-situ stress as arrows from outside, and the words for each edge."""
    width, height = layout.width_m, layout.height_m
    arrow = {"arrowstyle": "-|>", "color": INK, "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0}
    for fraction in (0.25, 0.5, 0.75):
        axes.annotate("", (fraction * width, height), xytext=(0, 20), textcoords="offset points", arrowprops=arrow)
        axes.annotate("", (width, fraction * height), xytext=(20, 0), textcoords="offset points", arrowprops=arrow)
    axes.annotate(f"{layout.vertical_Pa / 1e6:g} MPa, top {layout.edges['top']}", (0.5 * width, height),
                  xytext=(0, 22), textcoords="offset points", ha="center", fontsize=7.5)
    axes.annotate(f"{layout.horizontal_Pa / 1e6:g} MPa, sides {layout.edges['sides']}", (width, 0.5 * height),
                  xytext=(22, 0), textcoords="offset points", va="center", rotation=90, fontsize=7.5)
    axes.plot([0, width], [0, 0], color=PALE, linewidth=2.5, linestyle=(0, (1, 1)), clip_on=False, zorder=6)
    axes.annotate(f"bottom: {layout.edges['bottom']}", (0.98 * width, 0), xytext=(0, 4), ha="right",
                  textcoords="offset points", fontsize=7, color=INK)
