"""The crossing map from its tables: verification/crossing_map/records/crossing_map.svg and .png, and the table of where strata and the criteria part.

usage: python3 -m reports.crossing_map [--records DIR]      (after python3 -m verification.crossing_map)
"""

import argparse
import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from reports.charts.crossing_map import draw_crossing_map
from reports.charts.style import save
from reports.shown import Shown
from verification.crossing_map.criteria import blanton, first_slip, griffith_means, gu_weng, mean_slip, renshaw_pollard
from verification.crossing_map.maps import INCLINED_MPa, MAPS, RECORDS, Point, read_table
from verification.crossing_map.verdict import CROSSES, WAY_M

# The strength of rock that goes with K_Ic = 1.45 and an increment of 1 m: a crack of 1 m from a free face, K = 1.1215 T0 sqrt(pi d), releases as much.
STRENGTH_MPa = 1.45 / (1.1215 * math.sqrt(0.5 * math.pi))
CLOSING_MPa, K, TIP_M, HALF_M = 2.0, 1.45, 1.0, 10.0
NET_MPa = K / math.sqrt(math.pi * (HALF_M - 0.5 * TIP_M))  # of arrival: mean K_I^2 of a Griffith crack over the increment is K_Ic^2
LABELS = {
    "vertical_MPa": "stress normal to the interface (MPa)", "friction": "friction", "modulus_ratio": "modulus beyond over that below",
    "strength_MPa": "strength of the interface (MPa)", "closing_MPa": "closing stress (MPa)", "increment_m": "increment (m)",
    "angle_deg": "angle to the interface (degrees)",
}  # fmt: skip


def least(crosses: Callable[[float], bool], low: float = 1e-3, high: float = 1e3) -> float:
    """The least value that crosses, of those between two bounds, by halving their ratio; NaN where none does."""
    if not crosses(high):
        return math.nan
    for _ in range(50):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if crosses(middle) else (middle, high)
    return high


def crosses_above(points: Sequence[Point], y: float) -> float:
    """The least x of a row above which every run crosses; NaN where the last does not."""
    row = sorted((point for point in points if point.y == y), key=lambda point: point.x)
    held = [k for k, point in enumerate(row) if point.found.verdict != CROSSES]
    start = held[-1] + 1 if held else 0
    return row[start].x if start < len(row) else math.nan


def boundaries(friction: float, strength: float, closing: float) -> dict[str, float]:
    """The least s_v (MPa) at which each criterion lets a fracture normal to an interface cross."""
    return {
        "Renshaw & Pollard": renshaw_pollard(friction, strength, closing),
        "Gu & Weng": least(lambda s_v: gu_weng(friction, strength, s_v, closing)),
        "Blanton": blanton(strength, closing),
        "slip 1 m ahead of the tip": first_slip(friction, K, TIP_M),
        "mean over 2 m slides": mean_slip(friction, NET_MPa, HALF_M, WAY_M),
    }


def lines_of(name: str) -> dict[str, tuple[list[float], list[float]]]:
    """Lines over a map: x and y of each criterion."""
    one = MAPS[name]
    ys = list(np.linspace(one.y.first, one.y.last, 41))
    if name == "weak":
        return {"mean shear over 1 m, like rocks": ([1.0], [NET_MPa * griffith_means(HALF_M, 1.0)[0]])}
    if name == "inclined":
        along, across = INCLINED_MPa
        return {"Gu & Weng": ([least(lambda mu, y=y: gu_weng(mu, STRENGTH_MPa, along, across, math.radians(y)), 0.01, 10.0) for y in ys], ys)}
    at = {"friction": lambda y: (y, CLOSING_MPa), "closing": lambda y: (0.4, y), "increment": lambda y: (0.4, CLOSING_MPa)}[name]
    found = [boundaries(at(y)[0], STRENGTH_MPa / (math.sqrt(y) if name == "increment" else 1.0), at(y)[1]) for y in ys]
    shown = list(found[0]) if name == "friction" else ["Renshaw & Pollard", "Gu & Weng", "Blanton"]
    return {line: ([row[line] for row in found], ys) for line in shown}


def panel_of(name: str, folder: Path) -> Shown:
    """A map as it is drawn."""
    one = MAPS[name]
    points = read_table(one, folder)
    return Shown(heading=name, x_label=LABELS[one.x.column], y_label=LABELS[one.y.column], x_log=one.x.log, y_log=one.y.log, lines=lines_of(name),
                 x_range=(one.x.first, one.x.last), runs=[(point.x, point.y, point.found.verdict, point.found.rise_Pa / 1e6) for point in points])


def parting(folder: Path) -> str:
    """Where strata crosses beside where the criteria would, s_v in MPa, as a table in Markdown."""
    points = read_table(MAPS["friction"], folder)
    ys = sorted({point.y for point in points})
    rows = [(y, crosses_above(points, y), *boundaries(y, STRENGTH_MPa, CLOSING_MPa).values()) for y in ys[3::4]]
    heads = ["friction", "strata", *boundaries(1.0, STRENGTH_MPa, CLOSING_MPa)]
    return "\n".join(["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|", *("| " + " | ".join(f"{v:.3g}" for v in row) + " |" for row in rows)])


def main(arguments: list[str] | None = None) -> int:
    """Draw the map and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--records", type=Path, default=RECORDS)
    folder = parser.parse_args(arguments).records
    panels = [panel_of(name, folder) for name in MAPS if (folder / f"{name}.csv").is_file()]
    save(draw_crossing_map(Shown(title="A fracture crosses far below the stress that published criteria ask for", panels=panels)), folder, "crossing_map")
    print(parting(folder))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
