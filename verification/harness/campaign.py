"""The runs of all experiments: makes them side by side, longest first, then judges the claims and makes the page.

usage: ci/reproduce [--only exp1[,exp2...]] [--mechanics explicit|quasistatic|both] [--cell METRES] [--jobs N]

A run's folder is RUNS/MECHANICS/EXPERIMENT/VARIANT. A variant that only one mechanics can run is made in that one only. What is there
for the same scene and solver is not run again; a run that was interrupted goes on.
"""
from __future__ import annotations

import argparse
import subprocess
import sys
import threading
import time
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from verification.harness import claims
from verification.harness.cost import cost_of
from verification.harness.load import LoadError, load
from verification.harness.paths import EXPERIMENTS, ROOT, RUNS, solver
from verification.harness.refine import content_of
from verification.harness.run import Job, Outcome, done_before, key_of, load_outcome, run
from verification.harness.scenes import MECHANICS, mechanics_of, scenes_of, variants_of
from verification.harness.side_by_side import Task, duration, side_by_side

PAGE = ROOT / "reports" / "make_page.py"  # reads what is there and is not imported here


@dataclass(frozen=True)
class Campaign:
    """All runs of the experiments whose names begin with one of `only` (all where empty), in each mechanics, below one folder."""

    runs: Path
    only: tuple[str, ...] = ()
    settings: tuple[str, ...] = ()
    mechanics: tuple[str, ...] = MECHANICS
    experiments: Path = EXPERIMENTS

    def scenes(self) -> list[Path]:
        """The scene files of the campaign."""
        return [path for path in scenes_of(self.experiments) if not self.only or path.stem.startswith(self.only)]

    def jobs(self) -> list[Job]:
        """All jobs of the campaign, but for variants that the mechanics cannot run."""
        return [
            self.job(mechanics, scene, variant)
            for mechanics in self.mechanics
            for scene in self.scenes()
            for variant in variants_of(scene)
            if mechanics in mechanics_of(scene, variant)
        ]

    def name(self, job: Job) -> str:
        """A job's mechanics, experiment and variant."""
        return str(job.out.relative_to(self.runs))

    def job(self, mechanics: str, scene: Path, variant: str) -> Job:
        """One job of the campaign."""
        settings = (f"numerics.mechanics={mechanics}", *self.settings)
        return Job(scene, variant, self.runs / mechanics / scene.stem / variant, settings)


def expected_s(job: Job) -> float:
    """How long a run will take on one thread: as long as the last time, or by what its scene says, s."""
    before = load_outcome(job.out)
    if before is not None and before.ok:
        return before.wall_s
    content = content_of(job.scene, job.variant, job.settings)
    return cost_of(content, str(content["numerics"]["mechanics"])).seconds


def result_line(job: Job, outcome: Outcome) -> str:
    """A run's result in a few words."""
    if not outcome.ok:
        return f"FAILED: {outcome.reason}"
    try:
        found = load(job.out)
    except LoadError as error:
        return f"completed, but {error}"
    start = next((event.inlet_Pa for event in found.summary.events if event.kind == "start"), None)
    begun = f"starts at {start / 1e6:.3f} MPa" if start is not None else "never starts"
    top = float(found.history["tip_y_m"].max())
    return f"{begun}, tip at {top:.1f} m at {found.summary.inlet_Pa / 1e6:.3f} MPa ({outcome.wall_s:.1f} s)"


def made(job: Job, stop: threading.Event) -> Outcome:
    """Make a run; a folder that cannot be used fails it alone."""
    try:
        return run(job, stop=stop)
    except OSError as error:
        return Outcome(job.scene.stem, job.variant, "failed", 2, str(error), 0.0, "")


def make_runs(campaign: Campaign, at_a_time: int) -> int:
    """Make all runs with a line each; 3 where some did not complete, which are named at the end."""
    binary = solver()
    before = {job: done_before(job, key_of(job, binary)) for job in campaign.jobs()}
    rest = [job for job, outcome in before.items() if outcome is None]
    print(f"{len(rest)} runs to make, {len(before) - len(rest)} done before for the same scene and solver", flush=True)
    tasks = [
        Task(campaign.name(job), partial(made, job), partial(result_line, job), expected_s(job)) for job in rest
    ]
    outcomes = before | dict(zip(rest, side_by_side(tasks, at_a_time)))
    failed = [f"failed: {campaign.name(job)}: {outcome.reason}" for job, outcome in outcomes.items() if not outcome.ok]
    print("\n".join(failed), end="\n" if failed else "")
    return 3 if failed else 0


def main(arguments: list[str] | None = None) -> int:
    """The campaign from the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--experiments", type=Path, default=EXPERIMENTS)
    parser.add_argument("--runs", type=Path, default=RUNS)
    parser.add_argument("--out", type=Path, default=ROOT / "reports" / "out", help="folder for the page")
    parser.add_argument("--only", default="", help="beginnings of names of experiments, comma-separated")
    parser.add_argument("--mechanics", default="both", choices=(*MECHANICS, "both"))
    parser.add_argument("--set", dest="settings", action="append", default=[], metavar="KEY=VALUE", help="a scene key, in all runs")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time, each on one thread")
    parser.add_argument("--list", action="store_true", help="name the runs, make none")
    options = parser.parse_args(arguments)
    only = tuple(filter(None, options.only.split(",")))
    mechanics = MECHANICS if options.mechanics == "both" else (options.mechanics,)
    campaign = Campaign(options.runs.resolve(), only, tuple(options.settings), mechanics, options.experiments)
    if not campaign.scenes():
        parser.error(f"no experiment begins with {options.only}; there are {', '.join(path.stem for path in scenes_of(options.experiments))}")
    if options.list:
        print("\n".join(campaign.name(job) for job in campaign.jobs()))
        return 0
    start = time.monotonic()
    status = make_runs(campaign, options.jobs)
    folders = ["--experiments", str(options.experiments), "--runs", str(campaign.runs)]
    claims.main(folders)
    if subprocess.run([sys.executable, str(PAGE), *folders, "--out", str(options.out)], check=False).returncode != 0:
        return 1
    print(f"page: {options.out.resolve() / 'index.html'}  (runs and page: {duration(time.monotonic() - start)})")
    return status


if __name__ == "__main__":
    sys.exit(main())
