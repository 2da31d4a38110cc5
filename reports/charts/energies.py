"""Draws the energy ledgers and the dot plot of all variants."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reports.charts.style import COLOURS, FLAG, FLUID, INK, KIND_NAMES, MARKERS, entry, new_figure, put_legend
from reports.shown import Shown

_COLOURS: dict[str, tuple[str, ...]] = {
    "stored": ("#55b890", "#00845f", "#a5dcc5"), "dissipated": ("#d04a00", "#a3397f", "#b98a00", "#7a5230", "#3aa0c8", "#5a5a9a", "#1a1a1a"),
}


def draw_ledger(data: Shown) -> Figure:
    """Energies against inlet pressure, one column a variant: supplied and stored above, dissipated below."""
    count = len(data.panels)
    figure = new_figure(max(7.0, 3.3 * count + 1.0), 6.4, data.title, max(72, 34 * count))
    rows = figure.subplots(2, count, sharey="row", squeeze=False)
    names = {family: dict.fromkeys(name for panel in data.panels for name in panel.energies_kJ[family]) for family in _COLOURS}
    looks = {(family, name): colours[k % len(colours)] for family, colours in _COLOURS.items() for k, name in enumerate(names[family])}
    for above, below, panel in zip(*rows, data.panels):
        above.plot(panel.inlet_MPa, panel.supplied_kJ, color=FLUID, linewidth=1.8)
        for name, energy_kJ in panel.energies_kJ["stored"].items():
            above.plot(panel.inlet_MPa, energy_kJ, color=looks["stored", name], linestyle="--", linewidth=1.8)
        for name, energy_kJ in panel.energies_kJ["dissipated"].items():
            below.plot(panel.inlet_MPa, energy_kJ, color=looks["dissipated", name], linewidth=1.8)
        below.plot(panel.inlet_MPa, panel.unexplained_kJ, color=FLAG, linestyle=":", linewidth=1.8)
        above.set_title(panel.heading)
        below.set_xlabel("inlet pressure (MPa)")
        for axes in (above, below):
            axes.grid(True)
    rows[0][0].set_ylabel("supplied, stored\n(kJ per metre of thickness)")
    rows[1][0].set_ylabel("dissipated\n(kJ per metre of thickness)")
    handles = [entry("net work of fluid, in-situ stress and edges", color=FLUID, linewidth=1.8)]
    handles += [entry(f"{name} ({family})", color=colour, linestyle="--" if family == "stored" else "-", linewidth=1.8)
                for (family, name), colour in looks.items()]
    put_legend(figure, [*handles, entry("unexplained", color=FLAG, linestyle=":", linewidth=1.8)], max(2, min(4, count + 1)))
    return figure


def draw_variants(data: Shown) -> Figure:
    """Every variant's start, arrests, restarts and end, a line each."""
    figure = new_figure(11.0, 0.255 * sum(len(block) + 1.4 for _, block in data.blocks) + 1.6, data.title, 105)
    axes = figure.subplots()
    axes.grid(True, axis="x")
    at, ticks, labels = 0.0, [], []
    for heading, block in data.blocks:
        axes.text(-0.005, at, heading, transform=axes.get_yaxis_transform(), ha="right", va="center", fontweight="bold")
        at += 1.0
        for row in block:
            _draw_row(axes, row, at)
            ticks.append(at)
            labels.append(row.label)
            at += 1.0
        at += 0.4
    axes.set_yticks(ticks, labels)
    axes.tick_params(axis="y", length=0)
    axes.set(ylim=(at, -0.8), xlabel="inlet pressure (MPa)")
    handles = [entry(name, marker=MARKERS[kind], color=INK, linestyle="none") for kind, name in KIND_NAMES.items()]
    handles += [entry("arrested", color=INK, linewidth=4.5, alpha=0.35), entry("paused, not by an interface", color=INK, linewidth=1.0)]
    handles.append(entry("J at interface", marker="o", markersize=10, markerfacecolor="none", markeredgecolor=FLAG, linestyle="none"))
    put_legend(figure, handles, 5)
    return figure


def _draw_row(axes: Axes, row: Shown, at: float) -> None:
    """One variant's marks."""
    colour = COLOURS.get(row.variant, "#5a5a5a")
    for dot in row.dots:
        if dot.until_MPa is not None:
            look = {"alpha": 0.35, "linewidth": 4.5} if dot.kind == "arrest" else {"linewidth": 1.0}
            axes.plot([dot.inlet_MPa, dot.until_MPa], [at, at], color=colour, solid_capstyle="butt", zorder=2, **look)
        if dot.kind == "pause":
            continue
        thin = dot.kind in ("stop", "reach_interface")
        axes.plot([dot.inlet_MPa], [at], marker=MARKERS[dot.kind], color=colour, markersize=6, zorder=3,
                  markeredgecolor=colour if thin else "white", markeredgewidth=1.5 if thin else 0.6)
        if dot.flag and dot.kind == "arrest":
            axes.plot([dot.inlet_MPa], [at], marker="o", markersize=11, markerfacecolor="none", markeredgecolor=FLAG, markeredgewidth=1.4, zorder=4)
    if row.note:
        place = row.dots[-1].inlet_MPa if row.dots else axes.get_xlim()[0]
        axes.annotate(row.note, (place, at), xytext=(9, 0), textcoords="offset points", va="center", fontsize=7.5, color=FLAG)
