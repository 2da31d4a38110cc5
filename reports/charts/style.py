"""Colours, lines and the small drawing helpers that all charts share."""

import io
import textwrap
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402  (after the choice of a backend without a display)
from matplotlib import colormaps  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: E402
from matplotlib.backends.backend_pdf import FigureCanvasPdf  # noqa: E402
from matplotlib.backends.backend_svg import FigureCanvasSVG  # noqa: E402
from matplotlib.colors import to_hex, to_rgb  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402

INK, PALE, FLUID, FLAG = "#1c1c1c", "#8a8a8a", "#1f5fa8", "#b3003c"
STIFF, SOFT = "#d9d4ca", "#f4ecd2"  # rock
PNG_DPI = 160
MM = 1.0 / 25.4
TWO_COLUMNS, ONE_COLUMN = 190.0, 85.0  # widths in journals, mm

# What a dark page shows instead: ink, grid, ground, rock, and lines that would be too dark there.
_DARK = {
    INK: "#e6e6e6", "#222222": "#dcdcdc", "#e4e4e4": "#3a3e44", "#dddddd": "#3a3e44", "#ffffff": "#16181c", STIFF: "#4a4740", SOFT: "#3c3826", FLUID: "#6aa9f0",
    FLAG: "#ff6f9c", "#0067a5": "#4fa8e0", "#d04a00": "#f08040", "#00845f": "#35b98f", "#a3397f": "#d77ab8", "#8a6a00": "#c9a53a", "#7a5230": "#b98a63",
    "#6b6b6b": "#a0a0a0", "#fbe4e2": "#45211e", "#c9d6e6": "#3a4f6e", "#3b5878": "#b9cbe6", "#f3eef2": "#2b2730", "#1d7a3e": "#3fae68", "#d00000": "#ff6b6b",
}
SHADES = tuple(to_hex(colormaps["viridis_r"](0.15 + 0.09 * k)) for k in range(8))  # from first to last, seen on white and, lighter, on dark
_DARK |= {shade: to_hex([0.75 * part + 0.25 for part in to_rgb(shade)]) for shade in SHADES}

# Wong's palette, safe for colour-blind readers, darkened a little for thin lines on white.
COLOURS: dict[str, str] = {
    "perfect": "#222222", "friction": "#0067a5", "weak": "#d04a00", "soft": "#00845f", "weak_soft": "#a3397f", "soft_weak": "#8a6a00",
}
# Nearly equal curves lie on one another from wide and pale to thin and dashed, so that none hides another.
WIDTHS: dict[str, float] = {"perfect": 3.6, "weak": 2.2, "friction": 1.3, "soft": 1.5, "weak_soft": 2.0, "soft_weak": 1.3}
DASHES: dict[str, Any] = {"perfect": "-", "friction": (0, (3.5, 2.5)), "weak": "-", "soft": (0, (3, 1.2, 1, 1.2)), "weak_soft": "-",
                          "soft_weak": (0, (5, 1.6))}
ALPHAS: dict[str, float] = {"perfect": 0.35}
DOTTED, DASHED = (0, (1, 1.5)), (0, (4, 2))
MARKERS, KIND_NAMES = {"arrest": "s", "restart": "^"}, {"arrest": "arrest at an interface or to the end", "restart": "restart"}

plt.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 7.0, "axes.titlesize": 7.5, "axes.titleweight": "bold", "axes.titlelocation": "left",
    "axes.labelsize": 7.0, "axes.edgecolor": INK, "axes.labelcolor": INK, "axes.linewidth": 0.7, "axes.spines.top": False,
    "axes.spines.right": False, "axes.axisbelow": True, "text.color": INK, "xtick.color": INK, "ytick.color": INK, "xtick.major.width": 0.7,
    "ytick.major.width": 0.7, "grid.color": "#e4e4e4", "grid.linewidth": 0.6, "legend.frameon": False, "legend.fontsize": 7.0,
    "legend.handlelength": 2.8, "pdf.fonttype": 42, "figure.facecolor": "white", "savefig.facecolor": "white", "svg.fonttype": "path", "svg.hashsalt": "strata",
    "mathtext.default": "regular",
})


def new_figure(width_mm: float, height_mm: float) -> Figure:
    """An empty figure of a size in mm."""
    return plt.figure(figsize=(width_mm * MM, height_mm * MM), layout="constrained")


def panel_grid(panels: int, row_mm: float, width_mm: float = TWO_COLUMNS, **share: bool) -> tuple[Figure, list[Axes], int]:
    """A figure with so many panels, each 60 mm wide or more, in rows of `row_mm`; panels and columns."""
    columns = max(1, min(int(width_mm / 60.0), panels))
    rows = -(-panels // columns)
    figure = new_figure(width_mm, 12.0 + row_mm * rows)
    every = [axes for line in figure.subplots(rows, columns, squeeze=False, **share) for axes in line]
    for axes in every[panels:]:
        axes.set_axis_off()
    return figure, every[:panels], columns


def wrapped(words: str, characters: int) -> str:
    """Words in lines of so many characters at most."""
    return "\n".join(textwrap.wrap(words, characters))


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


def save(figure: Figure, *paths: Path) -> None:
    """Write a figure to files, each as its ending says (.svg, .pdf, .png), and let it go.

    It is drawn once for each, in places that are found once: `savefig` draws twice for each, which is most of the time of a page.
    """
    if figure.axes:
        figure.get_layout_engine().execute(figure)
    figure.set_layout_engine("none")
    for path in paths:
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix == ".svg":
            text = io.StringIO()
            FigureCanvasSVG(figure).print_svg(text, metadata={"Date": None})
            path.write_text(_with_dark(text.getvalue()), encoding="utf-8")
        elif path.suffix == ".pdf":
            FigureCanvasPdf(figure).print_pdf(path, metadata={"CreationDate": None})
        else:
            figure.set_dpi(PNG_DPI)
            FigureCanvasAgg(figure).print_png(path)
    plt.close(figure)


def _with_dark(svg: str) -> str:
    """An SVG that takes the colours of a dark page where the reader asks for one."""
    rules = "".join(f'[style*="{kind}: {light}"]{{{kind}:{dark} !important}}' for light, dark in _DARK.items() for kind in ("fill", "stroke"))
    return svg.replace("</style>", f"@media (prefers-color-scheme: dark){{{rules}}}</style>", 1)


def entry(label: str, **look: Any) -> Line2D:
    """An entry of a legend."""
    return Line2D([], [], label=label, **look)


def put_legend(figure: Figure, handles: Sequence[Any], columns: int) -> None:
    """A legend below the charts, with room made for it."""
    rows = -(-sum(1 + str(handle.get_label()).count("\n") for handle in handles) // columns)
    bottom = (0.165 * rows + 0.08) / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0.0, bottom, 1.0, 1.0 - bottom))
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 0.0), ncol=columns)
