"""Draws Figure 7, opening profiles at several times, and Figure 8, fracture paths."""

from __future__ import annotations

from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reports.charts.layout_chart import draw_layout
from reports.charts.style import COLOURS, INK, PALE, interface_lines, line_of, new_figure, put_title
from reports.curves import PathFigure, PathPanel, ProfileFigure, ProfilePanel


def draw_profiles(data: ProfileFigure) -> Figure:
    """Fig 7: one panel a variant on common axes."""
    rows = [[panel for panel in data.panels if panel.mechanics == name]
            for name in dict.fromkeys(panel.mechanics for panel in data.panels)]
    columns = max(len(row) for row in rows)
    figure = new_figure(5.4 * columns + 0.8, 0.6 + 5.6 * len(rows))
    put_title(figure, data.title, 56 * columns)
    every = figure.subplots(len(rows), columns, sharex=True, sharey=True, squeeze=False)
    for line, row in zip(every, rows):
        for axes in line[len(row):]:
            axes.set_axis_off()
        for axes, panel in zip(line, row):
            _draw_profile_panel(axes, panel)
            axes.set_xlim(0, 1.05 * data.opening_mm)
            axes.set_ylim(0, 1.04 * data.height_m)
        line[0].set_ylabel("height above the symmetry line (m)")
    return figure


def _draw_profile_panel(axes: Axes, panel: ProfilePanel) -> None:
    """The profiles of one variant, light first and dark last."""
    axes.grid(True)
    interface_lines(axes, panel.interfaces_m)
    colours = colormaps["viridis_r"]
    for profile in panel.profiles:
        axes.plot(profile.opening_mm, profile.height_m, color=colours(0.12 + 0.85 * profile.shade), linewidth=1.8,
                  label=f"{profile.time_s:.2f} s, {profile.inlet_MPa:.2f} MPa")
    axes.set_title(panel.heading)
    axes.set_xlabel("opening (mm)")
    axes.legend(title="time, inlet pressure", loc="upper right", title_fontsize=8.5)


def draw_paths(data: PathFigure) -> Figure:
    """Fig 8: one panel an experiment, its layout as an inset beside the paths."""
    figure = new_figure(6.4 * len(data.panels) + 0.4, 7.0)
    put_title(figure, data.title, 66 * len(data.panels))
    for axes, panel in zip(figure.subplots(1, len(data.panels), squeeze=False)[0], data.panels):
        _draw_path_panel(axes, panel)
    return figure


def _draw_path_panel(axes: Axes, panel: PathPanel) -> None:
    """The paths of one experiment in their window, m."""
    x0, x1, y0, y1 = panel.window_m
    axes.grid(True)
    for place in panel.layout.interfaces:
        if panel.layout.along == "x" and x0 <= place.at_m <= x1:
            axes.axvline(place.at_m, color=PALE, linewidth=1.2, linestyle=(0, (1, 1.5)))
            axes.annotate("interface", (place.at_m, y0), xytext=(3, 5), textcoords="offset points", va="bottom",
                          rotation=90, fontsize=7.5, color=INK)
    for path in panel.paths:
        colour = COLOURS.get(path.variant, PALE)
        axes.plot(path.x_m, path.y_m, label=path.label, **line_of(path.variant, path.beside, any(one.beside for one in panel.paths)))
        if path.beside:
            continue
        axes.plot([path.kink_at_m[0]], [path.kink_at_m[1]], marker="D", markersize=4.5, color=colour,
                  markeredgecolor="white", markeredgewidth=0.6, zorder=5)
    axes.set_xlim(x0, x1)
    axes.set_ylim(y0, y1)
    axes.set_box_aspect(panel.aspect)
    scale = "" if panel.magnified < 1.05 else f", horizontally magnified ×{panel.magnified:.2g}"
    axes.set_title(f"{panel.name}: paths{scale}")
    axes.set_xlabel("x (m)" + (f"   [{panel.aside}]" if panel.aside else ""))
    axes.set_ylabel("height above the symmetry line (m)")
    corner = "lower right" if panel.lean > 0 else "lower left"
    axes.legend(title="shift of the tip to the soft side, largest turn (◆)", loc=corner, title_fontsize=8.5,
                frameon=True, facecolor="white", edgecolor="none", framealpha=0.85)
    inset = axes.inset_axes((0.02 if panel.lean > 0 else 0.72, 0.70, 0.27, 0.29))
    draw_layout(inset, panel.layout, small=True)
