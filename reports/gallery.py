"""The pictures and the table of experiments/gallery, from a run of each of its scenes.

usage: PYTHONPATH=. /usr/bin/python3 -m reports.gallery [--out experiments/gallery]     (a quarter of a minute)
"""

import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from reports.charts.records import draw_gallery
from reports.charts.style import save
from reports.words import Shown
import verification.gallery as gallery
from verification.harness.command import command
from verification.harness.front_table import with_table
from verification.harness.load import Array, Run, column, frames, given, net_Pa, rock, value, values
from verification.harness.paths import RUNS
from verification.harness.run import Job, Made, make, timed

MARKS = "<!-- gallery -->\n", "<!-- end of gallery -->"
Curve = tuple[str, str, Array, Array, bool]  # name, look, x, y, whether a value holds until the next


def against_time(run: Run, name: str, solution: str, quantity: str, settings: dict[str, float], factor: float = 1.0, less: float = 0.0) -> list[Curve]:
    """A column of the history over time, less something, beside a quantity of a solution of strata-reference at 30 times."""
    time_s = run.history["time_s"]
    times = np.linspace(0.02, 1.0, 30) * time_s[-1]
    return [(solution, "source", times, factor * np.array([value(solution, quantity, time_s=float(time), **settings) for time in times]), False),
            ("strata", "run", time_s, factor * (run.history[name] - less), False)]


def heights(run: Run) -> list[Curve]:
    """The upper tip's height over the pressure, beside its source."""
    pressure, own = run.history["inlet_Pa"], column(run)
    at = np.linspace(pressure[0], pressure[-1], 150)
    own["upper_limit_m"] = min(own["upper_limit_m"], float(run.history["tip_y_m"][-1]) + 2.0)
    return [("layered_height", "source", at / 1e6, values("layered_height", "top_m", **own, pressure_Pa=at.tolist()), False),
            ("strata", "run", pressure / 1e6, run.history["tip_y_m"], True)]


def slips(run: Run, outputs: dict[str, int], source: tuple[str, Array, Array]) -> list[Curve]:
    """Slip (mm) along the scene's interface from its left end (m), at some outputs by their names, over its source."""
    start = run.scene["strata"]["interfaces"][0]["from_m"]
    stored = [frames(run, "interfaces")[number][1] for number in outputs.values()]
    return [(source[0], "source", *source[1:], False)] + [(name, look, fields["0/x_m"] - start, 1e3 * fields["0/slip_m"], False)
                                                          for name, look, fields in zip(outputs, ("run", "other"), stored)]


def fault_slips(run: Run) -> list[Curve]:
    """Slip of the fault alone, an ellipse by its source, and at the end."""
    a, largest = gallery.fault_slip(run)
    x = np.linspace(0.0, 2.0 * a, 101)
    return slips(run, {"strata, alone": 0, "under 8 MPa of fluid": -1}, ("closed form", x, 1e3 * largest * np.sqrt(1.0 - (x / a - 1.0) ** 2)))


def starts(run: Run, other: Run) -> list[Curve]:
    """Height of the tip over the net pressure for both frictions, over the pressure of the start."""
    got, expected = gallery.inclined(run)
    across = gallery.start_of(run).inlet_Pa - got
    ends = np.array([run.history["tip_y_m"][0], run.history["tip_y_m"][-1]])
    return [("closed form: start", "source", np.full(2, expected / 1e6), ends, False)] + [
        (f"friction {given(one, 'interface.bedding.coefficient'):g}", look, (one.history["inlet_Pa"] - across) / 1e6, one.history["tip_y_m"], True)
        for one, look in ((run, "run"), (other, "other"))]  # fmt: skip


# What a scene's picture shows: the names of its axes, the curves of its runs, and the range of y where it is not theirs.
PICTURES: dict[str, tuple[Any, ...]] = {
    "kgd": ("time (s)", "half length (m)", lambda run: against_time(run, "tip_y_m", "kgd", "half_length_m", gallery.fed(run))),
    "layers": ("pressure (MPa)", "height of the upper tip (m)", heights),
    "junction": ("along the crack (m)", "slip (mm)", lambda run: slips(run, {"strata": -1}, ("Phan et al. 2003", *gallery.curve("slip")))),
    "inclined": ("net pressure (MPa)", "height of the tip (m)", starts),
    "barrier": ("pressure (MPa)", "height of the upper tip (m)", heights),
    "shut_in": ("time (s)", "net pressure (kPa)", lambda run: against_time(
        run, "inlet_Pa", "shut_in", "inlet_pressure_Pa", gallery.shut_in_settings(run), 1e-3, given(run, "in_situ.horizontal_Pa")), (0.0, 500.0)),
    "fault": ("along the fault (m)", "slip (mm)", fault_slips, (0.0, 1.6)),
    "sudden": ("time (s)", "$K_I$ (MPa m$^{1/2}$)", lambda run: against_time(
        run, "K_I_Pa_sqrt_m", "freund_step_pressure", "K_I", {"pressure_Pa": net_Pa(run), **rock(run, density=True)}, 1e-6)),
}  # fmt: skip


def shown(name: str, runs: Sequence[Run]) -> Shown:
    """What a scene's picture shows."""
    x, y, curves, y_range = (*PICTURES[name], (None, None))[:4]
    return Shown(x=x, y=y, y_range=y_range, curves=curves(*runs))


def made_runs(scene: gallery.Scene, runs: Path) -> tuple[list[Made], float]:
    """The runs of a scene and its variants, made anew, and the CPU time of the first (s)."""
    jobs = [Job(gallery.FOLDER / f"{scene.name}.toml", variant, runs / scene.name / (variant or "base")) for variant in ("", *scene.variants)]
    all_made = [timed(partial(make, job, force=True)) for job in jobs]
    return [one for one, _ in all_made], all_made[0][1][1]


def row(scene: gallery.Scene, run: Run, cpu_s: float) -> str:
    """The line of a scene in the README's table."""
    got, expected = scene.pair(run)
    return (f"| ![{scene.name}]({scene.name}.svg) | `{scene.name}.toml`: {scene.question} | {scene.number}: {scene.told(expected)} ({scene.source}) | "
            f"{scene.told(got)}, {100.0 * abs(got / expected - 1.0):.2g} % | {cpu_s:.1f} |")


def main(arguments: list[str] | None = None) -> int:
    """Make the runs, draw the pictures and write the table."""
    options = command("reports.gallery", __doc__, "out", out=gallery.FOLDER).parse_args(arguments)
    rows = ["| | scene | expected | got, off by | seconds |", "|---|---|---|---|---|"]
    for scene in gallery.SCENES:
        made, cpu_s = made_runs(scene, RUNS / "gallery")
        runs = [run for outcome, run in made if outcome.ok and run is not None]
        if len(runs) < len(made):
            print(f"{scene.name}: {made[0][0].reason}", file=sys.stderr)
            return 3
        save(draw_gallery(shown(scene.name, runs)), options.out / f"{scene.name}.svg")
        rows.append(row(scene, runs[0], cpu_s))
        print(rows[-1], flush=True)
    readme = gallery.FOLDER / "README.md"
    readme.write_text(with_table(readme.read_text(encoding="utf-8"), "\n".join(rows) + "\n", *MARKS), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
