"""The runs of all experiments as a list: which there are, which are done, and one of them with a line of progress.

A run's folder is RUNS/MECHANICS/EXPERIMENT/VARIANT. A variant that only one mechanics can run is made in that one only.

usage: python3 -m verification.harness.campaign prepare --runs DIR [--only exp1,exp2] [--mechanics both] [--settings "KEY=VALUE ..."]
       python3 -m verification.harness.campaign run MECHANICS EXPERIMENT VARIANT --runs DIR [--settings "KEY=VALUE ..."]
       python3 -m verification.harness.campaign failed --runs DIR
       python3 -m verification.harness.campaign list --runs DIR
"""
from __future__ import annotations

import argparse
import json
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from verification.harness.load import LoadError, load
from verification.harness.paths import EXPERIMENTS, ROOT, solver
from verification.harness.run import Job, Outcome, done_before, key_of, load_outcome, run
from verification.harness.scenes import MECHANICS, mechanics_of, scenes_of, variants_of

PROGRESS = "progress.jsonl"
DONE = ".done"


@dataclass(frozen=True)
class Campaign:
    """All runs of the experiments whose names begin with one of `only` (all where empty), in each mechanics, below one folder."""

    runs: Path
    only: tuple[str, ...] = ()
    settings: tuple[str, ...] = ()
    mechanics: tuple[str, ...] = MECHANICS

    def scenes(self) -> list[Path]:
        """The scene files of the campaign."""
        return [path for path in scenes_of(EXPERIMENTS) if not self.only or path.stem.startswith(self.only)]

    def jobs(self) -> list[Job]:
        """All jobs of the campaign, but for variants that the mechanics cannot run."""
        return [
            self.job(mechanics, scene.stem, variant)
            for mechanics in self.mechanics
            for scene in self.scenes()
            for variant in variants_of(scene)
            if mechanics in mechanics_of(scene, variant)
        ]

    def job(self, mechanics: str, experiment: str, variant: str) -> Job:
        """One job of the campaign."""
        settings = (f"numerics.mechanics={mechanics}", *self.settings)
        return Job(EXPERIMENTS / f"{experiment}.toml", variant, self.runs / mechanics / experiment / variant, settings)


def prepare(campaign: Campaign) -> tuple[int, int]:
    """Mark the runs that are done for this scene and solver, unmark the others; returns how many there are of both."""
    done, remaining, binary = 0, 0, solver()
    campaign.runs.mkdir(parents=True, exist_ok=True)
    for job in campaign.jobs():
        marker = job.out / DONE
        if done_before(job, key_of(job, binary)):
            marker.touch()
            done += 1
        else:
            marker.unlink(missing_ok=True)
            remaining += 1
    (campaign.runs / PROGRESS).write_text(json.dumps({"total": remaining, "start": time.time()}) + "\n", encoding="utf-8")
    return done, remaining


def duration(seconds: float) -> str:
    """A time span (s) as minutes and seconds."""
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d} min"


def progress(runs: Path, name: str) -> str:
    """Note a finished run; says how many of how many are done and how much time (by the pace so far) is left."""
    path = runs / PROGRESS
    if not path.is_file():
        return ""
    with path.open("a", encoding="utf-8") as stream:
        stream.write(json.dumps({"run": name}) + "\n")
    head, *finished = path.read_text(encoding="utf-8").splitlines()
    total, start = json.loads(head)["total"], json.loads(head)["start"]
    elapsed = time.time() - start
    left = elapsed / len(finished) * max(total - len(finished), 0)
    return f"[{len(finished):2d}/{total}] {duration(elapsed)}, {duration(left)} left  "


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
    how = "done before" if outcome.skipped else f"{outcome.wall_s:.0f} s"
    return f"{begun}, tip at {top:.1f} m at {found.summary.inlet_Pa / 1e6:.3f} MPa ({how})"


def run_one(campaign: Campaign, mechanics: str, experiment: str, variant: str) -> int:
    """Run one job and print its line; 0 whatever came of it, unless it was interrupted."""
    job = campaign.job(mechanics, experiment, variant)
    outcome = run(job)
    print(f"{progress(campaign.runs, f'{mechanics}/{experiment}/{variant}')}{mechanics} {experiment} {variant}: {result_line(job, outcome)}", flush=True)
    return 130 if outcome.exit_status in (130, -2) else 0


def report_failed(campaign: Campaign) -> int:
    """Print the runs that did not complete; 3 if there are any."""
    bad = [(job, outcome) for job in campaign.jobs() if (outcome := load_outcome(job.out)) is None or not outcome.ok]
    for job, outcome in bad:
        print(f"failed: {job.out}: {outcome.reason if outcome else 'not run'}")
    return 3 if bad else 0


def main(arguments: list[str] | None = None) -> int:
    """The campaign from the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("action", choices=("prepare", "run", "failed", "list"))
    parser.add_argument("names", nargs="*", metavar="MECHANICS EXPERIMENT VARIANT")
    parser.add_argument("--runs", type=Path, default=ROOT / "runs")
    parser.add_argument("--only", default="", help="beginnings of names of experiments, comma-separated")
    parser.add_argument("--mechanics", default="both", choices=(*MECHANICS, "both"))
    parser.add_argument("--settings", default="", help="scene keys for all runs, KEY=VALUE separated by spaces")
    options = parser.parse_args(arguments)
    only = tuple(filter(None, options.only.split(",")))
    mechanics = MECHANICS if options.mechanics == "both" else (options.mechanics,)
    campaign = Campaign(options.runs.resolve(), only, tuple(options.settings.split()), mechanics)
    if not campaign.scenes():
        parser.error(f"no experiment begins with {options.only}; there are {', '.join(experiment_names())}")
    if options.action == "run":
        if len(options.names) != 3:
            parser.error("run takes a mechanics, an experiment and a variant")
        return run_one(campaign, *options.names)
    if options.action == "failed":
        return report_failed(campaign)
    if options.action == "list":
        print("\n".join(str(job.out.relative_to(campaign.runs)) for job in campaign.jobs()))
        return 0
    done, remaining = prepare(campaign)
    print(f"{remaining} runs to make, {done} done before for the same scene and solver")
    return 0


def experiment_names() -> list[str]:
    """The names of all experiments."""
    return [path.stem for path in scenes_of(EXPERIMENTS)]


if __name__ == "__main__":
    sys.exit(main())
