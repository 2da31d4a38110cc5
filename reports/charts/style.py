"""Colours, lines and the small drawing helpers that all charts share."""

import textwrap
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402  (after the choice of a backend without a display)
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: E402
from matplotlib.backends.backend_svg import FigureCanvasSVG  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402

INK, PALE, FLUID, FLAG = "#1c1c1c", "#8a8a8a", "#1f5fa8", "#b3003c"
PNG_DPI = 160

# Wong's palette, safe for colour-blind readers, darkened a little for thin lines on white.
COLOURS: dict[str, str] = {
    "perfect": "#222222", "friction": "#0067a5", "weak": "#d04a00", "soft": "#00845f", "weak_soft": "#a3397f", "soft_weak": "#8a6a00",
}
# Nearly equal curves lie on one another from wide and pale to thin and dashed, so that none hides another.
WIDTHS: dict[str, float] = {"perfect": 5.4, "weak": 3.2, "friction": 1.7, "soft": 1.9, "weak_soft": 2.6, "soft_weak": 1.7}
DASHES: dict[str, Any] = {"perfect": "-", "friction": (0, (3.5, 2.5)), "weak": "-", "soft": (0, (3, 1.2, 1, 1.2)), "weak_soft": "-",
                          "soft_weak": (0, (5, 1.6))}
ALPHAS: dict[str, float] = {"perfect": 0.35}
DOTTED, DASHED = (0, (1, 1.5)), (0, (4, 2))
MARKERS: dict[str, str] = {"start": "o", "reach_interface": "|", "arrest": "s", "restart": "^", "stop": "x"}
KIND_NAMES: dict[str, str] = {
    "start": "start of growth", "reach_interface": "reaches an interface", "arrest": "arrest", "restart": "restart", "stop": "end of run",
}

plt.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 9.0, "axes.titlesize": 9.5, "axes.titleweight": "bold", "axes.titlelocation": "left",
    "axes.labelsize": 9.0, "axes.edgecolor": INK, "axes.labelcolor": INK, "axes.linewidth": 0.7, "axes.spines.top": False,
    "axes.spines.right": False, "axes.axisbelow": True, "text.color": INK, "xtick.color": INK, "ytick.color": INK, "xtick.major.width": 0.7,
    "ytick.major.width": 0.7, "grid.color": "#e4e4e4", "grid.linewidth": 0.6, "legend.frameon": False, "legend.fontsize": 8.5,
    "legend.handlelength": 2.8, "figure.facecolor": "white", "savefig.facecolor": "white", "svg.fonttype": "path", "svg.hashsalt": "strata",
    "mathtext.default": "regular",
})


def new_figure(width_in: float, height_in: float, title: str = "", characters: int = 0) -> Figure:
    """An empty figure of a size in inches; the finding as its title, wrapped at so many characters, flush left."""
    figure = plt.figure(figsize=(width_in, height_in), layout="constrained")
    if title:
        figure.suptitle("\n".join(textwrap.wrap(title, characters)), x=0.008, ha="left", fontsize=11, fontweight="bold")
    return figure


def panel_grid(title: str, panels: int, row_in: float, **share: bool) -> tuple[Figure, list[Axes], int]:
    """A figure under its title with so many panels in rows of at most three, `row_in` inches each; panels and columns."""
    columns = min(3, panels)
    rows = -(-panels // columns)
    width = max(8.2, 3.9 * columns)  # room for a title even over one panel
    figure = new_figure(width, 1.0 + row_in * rows, title, int(10.4 * width))
    every = [axes for line in figure.subplots(rows, columns, squeeze=False, **share) for axes in line]
    for axes in every[panels:]:
        axes.set_axis_off()
    return figure, every[:panels], columns


def panel_rows(figure: Figure, rows: Sequence[Sequence[Any]], **share: bool) -> Iterator[tuple[Axes, Any, bool]]:
    """Axes for rows of panels that may be unlike in length, each with its panel and whether it is the first of its row."""
    for line, row in zip(figure.subplots(len(rows), max(map(len, rows)), squeeze=False, **share), rows):
        for axes in line[len(row):]:
            axes.set_axis_off()
        yield from ((axes, panel, k == 0) for k, (axes, panel) in enumerate(zip(line, row)))


def line_of(variant: str, beside: bool = False, solid: bool = False) -> dict[str, Any]:
    """Colour, width and dashes of a variant's line; thin and dashed where it is beside another mechanics, then solid."""
    colour, width = COLOURS.get(variant, PALE), WIDTHS.get(variant, 1.4)
    if beside:
        return {"color": colour, "linewidth": 1.1, "linestyle": (0, (4.5, 2.2)), "alpha": 0.85, "zorder": 3.9}
    dashes = "-" if solid else DASHES.get(variant, ":")
    return {"color": colour, "linewidth": width, "linestyle": dashes, "alpha": ALPHAS.get(variant, 1.0), "solid_capstyle": "butt",
            "zorder": 4.0 - 0.1 * width}


def interface_lines(axes: Axes, heights_m: Sequence[float]) -> None:
    """Horizontal lines at the heights of interfaces, m."""
    for height in heights_m:
        axes.axhline(height, color=PALE, linewidth=0.9, linestyle=DOTTED, zorder=1)


def save(figure: Figure, folder: Path, name: str) -> None:
    """Write a figure as SVG and PNG and let it go.

    Each is drawn once, in places that are found once: `savefig` draws twice for each, which is most of the time of a page.
    """
    folder.mkdir(parents=True, exist_ok=True)
    if figure.axes:
        figure.get_layout_engine().execute(figure)
    figure.set_layout_engine("none")
    FigureCanvasSVG(figure).print_svg(folder / f"{name}.svg", metadata={"Date": None})
    figure.set_dpi(PNG_DPI)
    FigureCanvasAgg(figure).print_png(folder / f"{name}.png")
    plt.close(figure)


def entry(label: str, **look: Any) -> Line2D:
    """An entry of a legend."""
    return Line2D([], [], label=label, **look)


def put_legend(figure: Figure, handles: Sequence[Any], columns: int) -> None:
    """A legend below the charts, with room made for it."""
    rows = -(-len(handles) // columns)
    bottom = (0.21 * rows + 0.12) / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0.0, bottom, 1.0, 1.0 - bottom))
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 0.0), ncol=columns)
