"""The runs of all experiments: makes them side by side, longest first, then judges the claims and makes the page.

usage: ci/reproduce [--only exp1[,exp2...]] [--mechanics explicit|quasistatic|both] [--cell METRES] [--jobs N]

A run's folder is RUNS/MECHANICS/EXPERIMENT/VARIANT. A variant that only one mechanics can run is made in that one only. What is there
for the same scene and solver is not run again; a run that was interrupted goes on.
"""

import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from verification.harness import claims
from verification.harness.command import beginnings, choose, command, ends_for_bad_input
from verification.harness.paths import EXPERIMENTS, ROOT, RUNS
from verification.harness.run import Job, Made, done_before, duration, make_all, name_of
from verification.harness.scenes import MECHANICS, mechanics_of, scenes_of, variants_of

PAGE = ROOT / "reports" / "make_page.py"  # reads what is there and is not imported here


def jobs_of(runs: Path, scenes: Sequence[Path], settings: Sequence[str] = (), mechanics: Sequence[str] = MECHANICS) -> list[Job]:
    """All runs of scenes in each mechanics, below one folder, but for variants that the mechanics cannot run."""
    return [
        Job(scene, variant, runs / one / scene.stem / variant, (f"numerics.mechanics={one}", *settings))
        for one in mechanics for scene in scenes for variant in variants_of(scene) if one in mechanics_of(scene, variant)
    ]  # fmt: skip


def result_line(made: Made) -> str:
    """A run's result in a few words."""
    outcome, found = made
    if not outcome.ok or found is None:
        return f"FAILED: {outcome.reason}"
    start = next((event.inlet_Pa for event in found.summary.events if event.kind == "start"), None)
    begun = f"starts at {start / 1e6:.3f} MPa" if start is not None else "never starts"
    top = float(found.history["tip_y_m"].max())
    return f"{begun}, tip at {top:.1f} m at {found.summary.inlet_Pa / 1e6:.3f} MPa ({outcome.wall_s:.1f} s)"


def make_runs(jobs: Sequence[Job], at_a_time: int) -> int:
    """Make all runs with a line each; 3 where some did not complete, which are named at the end."""
    outcomes = {job: done_before(job) for job in jobs}
    rest = [job for job, outcome in outcomes.items() if outcome is None]
    print(f"{len(rest)} runs to make, {len(jobs) - len(rest)} done before for the same scene and solver", flush=True)
    outcomes |= {job: outcome for job, (outcome, _) in zip(rest, make_all(rest, at_a_time, result_line))}
    failed = [f"failed: {name_of(job)}: {outcome.reason}" for job, outcome in outcomes.items() if outcome is not None and not outcome.ok]
    print("\n".join(failed), end="\n" if failed else "")
    return 3 if failed else 0


def main(arguments: list[str] | None = None) -> int:
    """The campaign from the command line."""
    parser = command(Path(__file__).name, __doc__, "mechanics", "set", "jobs", "list", "runs", "out", runs=RUNS, out=ROOT / "reports" / "out")
    parser.add_argument("--experiments", type=Path, default=EXPERIMENTS)
    parser.add_argument("--only", default="", help="beginnings of names of experiments, comma-separated")
    options = parser.parse_args(arguments)
    mechanics = MECHANICS if options.mechanics == "both" else (options.mechanics,)
    runs = options.runs.resolve()
    with ends_for_bad_input(parser):
        scenes = choose({path.stem: path for path in scenes_of(options.experiments)}, beginnings(options.only), "experiment begins with")
    jobs = jobs_of(runs, list(scenes.values()), options.settings, mechanics)
    if options.list:
        print("\n".join(map(name_of, jobs)))
        return 0
    start = time.monotonic()
    status = make_runs(jobs, options.jobs)
    folders = ["--experiments", str(options.experiments), "--runs", str(runs)]
    claims.main(folders)
    if subprocess.run([sys.executable, str(PAGE), *folders, "--out", str(options.out)], check=False).returncode != 0:
        return 1
    print(f"page: {options.out.resolve() / 'index.html'}  (runs and page: {duration(time.monotonic() - start)})")
    return status


if __name__ == "__main__":
    sys.exit(main())
