"""Animations of the experiments from run folders: NAME.gif and, beside it, NAME.json with its caption and its alternative text.

usage: python3 -m reports.animation [--runs runs] [--out reports/out/animations] [--only exp1]     (after ci/reproduce)
"""

import sys
import time
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from reports.charts.animation import write_animation
from reports.runs import Arrays, NotAvailable, Run, fields_at, layout_of, load_runs, output_times
from reports.words import Shown, experiment_name, mechanics_name, mpa, number, plain
from verification.harness import store
from verification.harness.command import command
from verification.harness.paths import ROOT, RUNS

FRAMES = 40  # at most: a GIF of a megabyte and 5 seconds
SQUARES = 120  # of the stress along either side
# Of each experiment the interface that changes most; without inertia where there is such a run.
VARIANTS = ("soft", "weak_soft", "weak")


def chosen(runs: Iterable[Run]) -> list[Run]:
    """The run of each experiment that is animated, in their order."""
    best: dict[str, Run] = {}
    for run in runs:
        if run.variant in VARIANTS and run.drawable and (run.folder / "result.h5").is_file():
            rank = (VARIANTS.index(run.variant), run.mechanics == "explicit")
            old = best.get(run.experiment)
            if old is None or rank < (VARIANTS.index(old.variant), old.mechanics == "explicit"):
                best[run.experiment] = run
    return [best[name] for name in sorted(best)]


def largest_principal(points: Arrays) -> np.ndarray:
    """Largest principal stress in the plane, tension positive, Pa: (s_xx + s_yy)/2 + sqrt((s_xx - s_yy)^2/4 + s_xy^2)."""
    xx, yy, xy = (points[name].astype(float) for name in ("s_xx_Pa", "s_yy_Pa", "s_xy_Pa"))
    return 0.5 * (xx + yy) + np.hypot(0.5 * (xx - yy), xy)


def movie(run: Run) -> Shown:
    """What an animation of a run shows: a frame has the time (s), the inlet pressure (MPa), the tip's height (m), the fracture's path and arc (m), the
    pressure along it (MPa), its opening (mm) and the stress on a grid (MPa). Raises NotAvailable where the run lacks fields."""
    layout, times = layout_of(run), output_times(run)
    picked = np.unique(np.linspace(0, len(times) - 1, min(FRAMES, len(times))).astype(int))
    x, y = ((np.arange(SQUARES) + 0.5) * size / SQUARES for size in (layout.width_m, layout.height_m))
    at = np.stack([part.ravel() for part in np.meshgrid(x, y)], axis=-1)
    frames = []
    for index in map(int, picked):
        points, crack = fields_at(run, "particles", index), fields_at(run, "fracture", index)
        nearest = cKDTree(np.stack((points["x_m"], points["y_m"]), axis=-1)).query(at)[1]
        frames.append(Shown(
            time_s=float(times[index]), inlet_MPa=float(crack["inlet_Pa"]) / 1e6, height_m=float(crack["y_m"].max()), x_m=crack["x_m"], y_m=crack["y_m"],
            arc_m=crack["arc_m"], pressure_MPa=crack["pressure_Pa"] / 1e6, opening_mm=1e3 * crack["opening_m"],
            stress_MPa=largest_principal(points)[nearest].reshape(SQUARES, SQUARES) / 1e6,
        ))  # fmt: skip
    every = np.concatenate([frame.stress_MPa.ravel() for frame in frames])
    low, high = (float(value) for value in np.percentile(every, (1.0, 99.5)))
    name = f"{experiment_name(run.experiment)}, {plain(run.variant)} interface, {mechanics_name(run.mechanics)}"
    first, last = frames[0], frames[-1]
    grows = f"grows from {number(first.height_m)} to {number(last.height_m)} m while the inlet rises from {mpa(first.inlet_MPa * 1e6)} to {mpa(last.inlet_MPa * 1e6)}"
    where = f"interface{'s' if len(layout.interfaces) > 1 else ''} at {' and '.join(number(place.at_m) for place in layout.interfaces)} m"
    return Shown(
        title=name, layout=layout, frames=frames, stress_MPa=(low, high), time_s=run.history["time_s"], height_m=run.history["height_m"],
        caption=f"{name}: the fracture {grows}. Colours: largest principal stress (tension positive); dotted: {where}; right: pressure and opening along "
                f"the fracture, and its height. {len(frames)} of {len(times)} output times.",
        alt=f"Animation of {experiment_name(run.experiment)}: a fracture in layered rock, with {where}, {grows}.",
    )  # fmt: skip


def animations(runs: Iterable[Run], out: Path) -> list[Path]:
    """Write the animation of each experiment among the runs to a folder, with its caption and alternative text beside it; the paths of the GIFs.
    An experiment whose run lacks fields is told and left out. Some 4 seconds each."""
    made = []
    for run in chosen(runs):
        try:
            data = movie(run)
        except (NotAvailable, KeyError) as error:
            print(f"no animation of {run.experiment}/{run.variant}: {error}", file=sys.stderr)
            continue
        out.mkdir(parents=True, exist_ok=True)
        made.append(write_animation(data, out / f"{run.experiment}.gif"))
        store.write({"caption": data.caption, "alt": data.alt}, out / f"{run.experiment}.json")
    return made


def main(arguments: list[str] | None = None) -> int:
    """Write them; 1 where there is none to write."""
    parser = command("reports.animation", __doc__, "runs", "out", runs=RUNS, out=ROOT / "reports" / "out" / "animations")
    parser.add_argument("--only", default="", help="experiments by the beginnings of their names, comma-separated (default: all)")
    options = parser.parse_args(arguments)
    wanted, found = tuple(options.only.split(",")), 0
    runs = [run for run in load_runs(options.runs) if run.experiment.startswith(wanted)]
    for run in chosen(runs):
        since = time.monotonic()
        for path in animations([run], options.out):
            found += 1
            print(f"{path}: {path.stat().st_size / 1e3:.0f} kB, {time.monotonic() - since:.1f} s")
    if not found:
        print(f"{options.runs}: no run of an experiment with fields; ci/reproduce makes them", file=sys.stderr)
    return 0 if found else 1


if __name__ == "__main__":
    sys.exit(main())
