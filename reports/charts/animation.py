"""Draws a run in motion: the stress with the fracture, the pressure and the opening along it, and its height against time."""

from pathlib import Path
from typing import Any

from matplotlib import colormaps
from matplotlib.animation import PillowWriter
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure

from reports.charts.style import COLOURS, DOTTED, FLUID, INK, PALE, new_figure, plt
from reports.words import Shown

DPI, PER_SECOND, HOLD = 80, 8, 12  # pixels an inch, frames a second, times that the last one is shown
STEPS = 12  # of colour: few enough for a GIF, whose frames then differ in little


def write_animation(data: Shown, path: Path) -> Path:
    """Write a GIF whose frames are those of the data."""
    figure = new_figure(229.0, 119.0)
    figure.suptitle(data.title, x=0.008, ha="left", fontsize=9, fontweight="bold", wrap=True)
    left, *right = figure.subplot_mosaic([["s", "p"], ["s", "w"], ["s", "h"]], width_ratios=(1.15, 1.0)).values()
    parts = [_draw_rock(figure, left, data), *_draw_lines(right, data)]
    figure.get_layout_engine().set(w_pad=0.1, h_pad=0.06)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # places found once: axes that move cost bytes
    writer = PillowWriter(fps=PER_SECOND)
    with writer.saving(figure, str(path), DPI):
        for frame in (*data.frames, *(data.frames[-1:] * HOLD)):
            for part in parts:
                part(frame)
            writer.grab_frame()
    plt.close(figure)
    return path


def _draw_rock(figure: Figure, axes: Axes, data: Shown) -> Any:
    """The stress in the whole block with interfaces and fracture; what changes it to a frame."""
    layout, (low, high) = data.layout, data.stress_MPa
    colours = colormaps["cividis"].resampled(STEPS)
    norm = BoundaryNorm([low + (high - low) * k / STEPS for k in range(STEPS + 1)], STEPS, extend="neither")
    image = axes.imshow(data.frames[0].stress_MPa, origin="lower", extent=(0, layout.width_m, 0, layout.height_m), cmap=colours, norm=norm)
    bar = figure.colorbar(image, ax=axes, location="left", shrink=0.8, pad=0.02, format="%.2f")
    bar.set_label("largest principal stress (MPa), tension positive")
    for place in layout.interfaces:
        line = axes.axhline if layout.along == "y" else axes.axvline
        line(place.at_m, color="white", linewidth=1.6)
        line(place.at_m, color=INK, linewidth=1.2, linestyle=DOTTED)
    halo = axes.plot([], [], color="white", linewidth=4.0)[0]
    crack = axes.plot([], [], color=COLOURS["weak"], linewidth=2.0)[0]
    axes.set(xlabel="x (m)", ylabel="y (m)")
    title = axes.set_title(" ")

    def change(frame: Shown) -> None:
        """Show a frame."""
        image.set_data(frame.stress_MPa)
        for line in (halo, crack):
            line.set_data(frame.x_m, frame.y_m)
        title.set_text(f"t = {frame.time_s:.2f} s, inlet {frame.inlet_MPa:.2f} MPa")

    return change


def _draw_lines(every: list[Axes], data: Shown) -> list[Any]:
    """Pressure and opening along the fracture, height against time; what changes each to a frame."""
    changes = []
    along = max(frame.arc_m[-1] for frame in data.frames)
    for axes, name, words in zip(every, ("pressure_MPa", "opening_mm"), ("pressure (MPa)", "opening (mm)")):
        values = [getattr(frame, name) for frame in data.frames]
        low, high = min(min(one) for one in values), max(max(one) for one in values)
        margin = 0.05 * (high - low) or 0.1
        axes.set(xlim=(0, along), ylim=(low - margin, high + margin), ylabel=words, xlabel="along the fracture (m)")
        line = axes.plot([], [], color=FLUID, linewidth=1.6)[0]
        changes.append(lambda frame, line=line, name=name: line.set_data(frame.arc_m, getattr(frame, name)))
    axes = every[-1]
    axes.plot(data.time_s, data.height_m, color=PALE, linewidth=1.0)
    for height in data.layout.heights_m:
        axes.axhline(height, color=PALE, linewidth=0.9, linestyle=DOTTED)
    done = axes.plot([], [], color=INK, linewidth=1.8)[0]
    dot = axes.plot([], [], "o", color=COLOURS["weak"], markersize=5)[0]
    axes.set(xlabel="time (s)", ylabel="height (m)")

    def change(frame: Shown) -> None:
        """Show a frame."""
        until = sum(1 for time in data.time_s if time <= frame.time_s)
        done.set_data(data.time_s[:until], data.height_m[:until])
        dot.set_data([frame.time_s], [frame.height_m])

    return [*changes, change]
