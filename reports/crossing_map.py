"""The crossing map from its tables: verification/crossing_map/records/crossing_map.png, and the table of where strata and the criteria part.

usage: python3 -m reports.crossing_map [--records DIR]      (after python3 -m verification.crossing_map)
"""

import argparse
import math
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from reports.charts.records import draw_crossing_map
from reports.charts.style import TWO_COLUMNS, save
from reports.figures import Figure, Table, Topic, words_of
from reports.words import Shown
from verification.crossing_map.verdict import (
    CROSSES, MAPS, RECORDS, WAY_M, INCLINED_MPa, Verdicts, bears, blanton, first_slip, griffith_means, gu_weng, mean_slip, read_table,
    renshaw_pollard,
)  # fmt: skip

# The strength of rock that goes with K_Ic = 1.45 and an increment of 1 m: a crack of 1 m from a free face, K = 1.1215 T0 sqrt(pi d), releases as much.
STRENGTH_MPa = 1.45 / (1.1215 * math.sqrt(0.5 * math.pi))
CLOSING_MPa, K, TIP_M, HALF_M = 2.0, 1.45, 1.0, 10.0
NET_MPa = K / math.sqrt(math.pi * (HALF_M - 0.5 * TIP_M))  # of arrival: mean K_I^2 of a Griffith crack over the increment is K_Ic^2
S_V = (0.1, 100.0)  # MPa, within which criteria are asked


def crosses_above(verdicts: Verdicts, y: float) -> float:
    """The least x of a row from which on every run crosses; NaN where the last does not."""
    row = sorted((x, found.verdict) for (x, at), found in verdicts.items() if at == y)
    start = max((k + 1 for k, (_, word) in enumerate(row) if word != CROSSES), default=0)
    return row[start][0] if start < len(row) else math.nan


def boundaries(friction: float, strength: float, closing: float) -> dict[str, float]:
    """The least s_v (MPa) at which each criterion lets a fracture normal to an interface cross, and closed forms of slip."""
    low, high = (gu_weng(strength, s_v, closing) - friction for s_v in S_V)  # falls as s_v rises
    asked = S_V[0] if low <= 0.0 else S_V[1] if high >= 0.0 else brentq(lambda s_v: gu_weng(strength, s_v, closing) - friction, *S_V, rtol=1e-6)
    return {
        "Renshaw & Pollard": renshaw_pollard(friction, strength, closing),
        "Gu & Weng": float(asked),
        "Blanton": blanton(strength, closing),
        "slip 1 m ahead of the tip": first_slip(friction, K, TIP_M),
        "mean over 2 m slides": mean_slip(friction, NET_MPa, HALF_M, WAY_M),
    }


def lines_of(name: str, verdicts: Verdicts) -> dict[str, tuple[list[float], list[float]]]:
    """Lines over a map: x and y of each criterion."""
    ends = [[end(at[k] for at in verdicts) for end in (min, max)] for k in (0, 1)]
    ys = list(np.linspace(*ends[1], 31))
    if name in ("weak", "strength"):
        like = [1.0] if name == "weak" else list(np.geomspace(*ends[0], 9))
        return {"mean shear over 1 m, like rocks": (like, [NET_MPa * griffith_means(HALF_M, 1.0)[0]] * len(like))}
    if name == "contrast":  # under 1 MPa
        slides = [mean_slip(mu, NET_MPa, HALF_M, WAY_M) for mu in ys]
        return {"mean over 2 m slides, like rocks": ([1.0], [float(np.interp(1.0, slides[::-1], ys[::-1]))])}
    if name == "inclined":
        return {"Gu & Weng": ([gu_weng(STRENGTH_MPa, *INCLINED_MPa, math.radians(y)) for y in ys], ys)}
    given = {"friction": lambda y: (y, 1.0, CLOSING_MPa), "closing": lambda y: (0.4, 1.0, y), "increment": lambda y: (0.4, y, CLOSING_MPa)}[name]
    found = [boundaries(mu, STRENGTH_MPa / math.sqrt(increment), closing) for mu, increment, closing in map(given, ys)]
    return {line: ([row[line] for row in found], ys) for line in list(found[0])[: 5 if name == "friction" else 3]}


def panel_of(name: str, folder: Path) -> Shown:
    """A map as it is drawn: of the inclined one what is at rest before the fracture does anything."""
    one, verdicts = MAPS[name], read_table(MAPS[name], folder)
    shown = {at: found for at, found in verdicts.items() if name != "inclined" or bears(*at)}
    return Shown(heading=name, x=one.x, y=one.y, lines=lines_of(name, shown),
                 runs=[(*at, found.verdict, found.rise_Pa / 1e6) for at, found in shown.items()])


def parting(folder: Path) -> str:
    """Where strata crosses beside where the criteria would, s_v in MPa, as a table in Markdown."""
    verdicts = read_table(MAPS["friction"], folder)
    found = {y: {"friction": y, "strata": crosses_above(verdicts, y), **boundaries(y, STRENGTH_MPa, CLOSING_MPa)} for y in sorted({y for _, y in verdicts})}
    rows = [["---"] * 7, *([f"{value:.2f}" for value in found[y].values()] for y in (0.1, 0.2, 0.4, 0.6, 0.9) if y in found)]
    return "\n".join("| " + " | ".join(row) + " |" for row in (next(iter(found.values())), *rows))


def map_figure(folder: Path) -> Shown:
    """All maps of a folder as they are drawn."""
    panels = [panel_of(name, folder) for name in MAPS if (folder / f"{name}.csv").is_file()]
    border = crosses_above(read_table(MAPS["friction"], folder), 0.4)
    asked = renshaw_pollard(0.4, STRENGTH_MPa, CLOSING_MPa)
    title = f"At friction 0.4 the fracture crosses where the stress normal to the interface is {border:.2g}\u00a0MPa or more; Renshaw & Pollard ask for {asked:.2g}\u00a0MPa"
    return Shown(title="Verdicts" if math.isnan(border) else title, panels=panels, runs=sum(len(panel.runs) for panel in panels))


def topic(folder: Path) -> Topic | None:
    """The section of the front page from the kept tables; None without that of friction."""
    if not (folder / "friction.csv").is_file():
        return None
    data = map_figure(folder)
    header, _, *rows = [line.strip("| ").split(" | ") for line in parting(folder).splitlines()]
    return Topic("crossing", "Where a fracture crosses an interface", [f"{data.title}.", words_of("crossing")], "ci/crossing_map", "",
                 Figure("crossing_map", data, draw_crossing_map, "crossing_map", "ci/crossing_map"),
                 [Table("Stress normal to the interface, MPa, from which on a fracture crosses, by friction", header, rows)])


def main(arguments: list[str] | None = None) -> int:
    """Draw the map and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--records", type=Path, default=RECORDS)
    folder = parser.parse_args(arguments).records
    save(draw_crossing_map(map_figure(folder), TWO_COLUMNS), folder / "crossing_map.png")
    if (folder / "friction.csv").is_file():
        print(parting(folder))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
