"""The picture of the example well, experiments/well/heights.svg: its layers, the fracture in them, the depth of its upper tip, and what moduli and a bedding plane add.

usage: python3 -m reports.well [--out experiments/well]     (makes its three runs, half a minute)
"""

import sys
from itertools import accumulate

import numpy as np

from reports.charts.records import draw_well
from reports.charts.style import save
from reports.words import Shown
from verification.harness.command import command
from verification.harness.load import EDGE_M, Run, column, frames, pressure_beyond, values
from verification.harness.paths import EXPERIMENTS, RUNS
from verification.harness.run import Job, make_all

SCENE = EXPERIMENTS / "well" / "well.toml"
BOTTOM_M = 2500.0  # depth of y = 0, the log's last row
VARIANTS = {"one_modulus": "strata, one modulus", "perfect": "strata, moduli of the log", "": "strata, moduli and bedding of the log"}


def fractures_of(run: Run) -> list[tuple[float, float, float]]:
    """The fracture at seven outputs, evenly apart until it is as long as it ends: pressure (MPa), depths of its lower and its upper end (m)."""
    stored = frames(run, "fracture")
    last = next(k for k, (_, fields) in enumerate(stored) if np.ptp(fields["y_m"]) > np.ptp(stored[-1][1]["y_m"]) - 1e-3)
    chosen = [stored[k] for k in np.linspace(0, last, 7).round().astype(int)]
    return [(float(np.interp(time_s, run.history["time_s"], run.history["inlet_Pa"])) / 1e6, BOTTOM_M - float(fields["y_m"].min()),
             BOTTOM_M - float(fields["y_m"].max())) for time_s, fields in chosen]  # fmt: skip


def heights_of(runs: list[Run]) -> Shown:
    """Layers and depths (m) against pressure (MPa), of the reference with one modulus, then of runs; the finding as title."""
    one, perfect, full = runs
    layers, column_of = full.scene["strata"]["layers"], column(one)
    column_of["upper_limit_m"] -= EDGE_M
    bottoms = [BOTTOM_M, *(BOTTOM_M - y for y in accumulate(layer["thickness_m"] for layer in layers[:-1]))]
    tops = [*bottoms[1:], BOTTOM_M - full.scene["domain"]["height_m"]]
    stop_Pa = full.scene["stop"]["inlet_Pa"]
    pressures = np.linspace(min(column_of["stress_Pa"]), stop_Pa, 400)
    curves = [("strata-reference layered_height, one modulus", pressures / 1e6, BOTTOM_M - values("layered_height", "top_m", **column_of, pressure_Pa=pressures.tolist()))]
    curves += [(name, run.history["inlet_Pa"] / 1e6, BOTTOM_M - run.history["tip_y_m"]) for run, name in zip(runs, VARIANTS.values())]
    heights = np.unique(one.history["tip_y_m"])[1:]  # above the initial tip, and below where a run keeps it
    heights = heights[heights < min(run.history["tip_y_m"].max() for run in (one, perfect))]
    passed, with_moduli = (np.array([pressure_beyond(run, y) for y in heights]) for run in (one, perfect))
    off = passed - values("layered_height", "pressure_to_pass_Pa", **column_of, height_m=heights.tolist())
    held_m = full.history["tip_y_m"].max()  # where the bedding plane holds the upper tip until the lower one ends the run
    held = full.summary.inlet_Pa - pressure_beyond(perfect, held_m)
    title = (f"Pressures that pass a height: strata within {np.abs(off).max() / 1e6:.2f} MPa of the reference with one modulus; the log's moduli "
             f"move them by up to {np.abs(with_moduli - passed).max() / 1e6:.2f} MPa, its weak bedding plane holds the upper tip at {BOTTOM_M - held_m:.0f} m "
             f"for {held / 1e6:.2f} MPa and more")
    shown = [Shown(rock=layer["rock"], top_m=top, thickness_m=bottom - top, stress_MPa=layer["horizontal_Pa"] / 1e6,
                   modulus_GPa=full.scene["rock"][layer["rock"]]["youngs_modulus_Pa"] / 1e9) for layer, top, bottom in zip(layers, tops, bottoms)]
    beds = [(top, name) for top, name in zip(tops, full.scene["strata"]["interfaces"]) if name != "perfect"]
    return Shown(title=title, layers=shown, curves=curves, bedding=beds, fractures=fractures_of(full), bottom_m=BOTTOM_M,
                 least_MPa=min(column_of["stress_Pa"]) / 1e6 - 0.5, stop_MPa=stop_Pa / 1e6)


def main(arguments: list[str] | None = None) -> int:
    """Make the runs and draw the picture."""
    options = command("reports.well", __doc__, "out", out=SCENE.parent).parse_args(arguments)
    made = make_all([Job(SCENE, variant, RUNS / "quasistatic" / "well" / (variant or "default")) for variant in VARIANTS], 2)
    runs = [run for outcome, run in made if outcome.ok and run is not None]
    if len(runs) < len(made):
        return 3
    save(draw_well(heights_of(runs)), options.out / "heights.svg")
    print(options.out / "heights.svg")
    return 0


if __name__ == "__main__":
    sys.exit(main())
