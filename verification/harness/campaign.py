"""The runs of all experiments as a list: which there are, which are done, and one of them with a line of progress.

usage: python3 -m verification.harness.campaign prepare --runs DIR [--only exp1,exp2] [--settings "KEY=VALUE ..."]
       python3 -m verification.harness.campaign run EXPERIMENT VARIANT --runs DIR [--settings "KEY=VALUE ..."]
       python3 -m verification.harness.campaign failed --runs DIR
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
from verification.harness.run import Job, Outcome, done_before, key_of, load_outcome, run, variants_of

PROGRESS = "progress.jsonl"
DONE = ".done"


@dataclass(frozen=True)
class Campaign:
    """All runs of the experiments whose names begin with one of `only` (all where empty), below one folder."""

    runs: Path
    only: tuple[str, ...] = ()
    settings: tuple[str, ...] = ()

    def scenes(self) -> list[Path]:
        """The scene files of the campaign."""
        return [path for path in sorted(EXPERIMENTS.glob("*.toml")) if not self.only or path.stem.startswith(self.only)]

    def jobs(self) -> list[Job]:
        """All jobs of the campaign."""
        return [self.job(scene.stem, variant) for scene in self.scenes() for variant in variants_of(scene)]

    def job(self, experiment: str, variant: str) -> Job:
        """One job of the campaign."""
        return Job(EXPERIMENTS / f"{experiment}.toml", variant, self.runs / experiment / variant, self.settings)


def prepare(campaign: Campaign) -> tuple[int, int]:
    """Mark the runs that are done for this scene and solver, unmark the others; returns how many there are of both."""
    done, todo, binary = 0, 0, solver()
    campaign.runs.mkdir(parents=True, exist_ok=True)
    for job in campaign.jobs():
        marker = job.out / DONE
        if done_before(job, key_of(job, binary)):
            marker.touch()
            done += 1
        else:
            marker.unlink(missing_ok=True)
            todo += 1
    (campaign.runs / PROGRESS).write_text(json.dumps({"total": todo, "start": time.time()}) + "\n", encoding="utf-8")
    return done, todo


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


def run_one(campaign: Campaign, experiment: str, variant: str) -> int:
    """Run one job and print its line; 0 whatever came of it, unless it was interrupted."""
    job = campaign.job(experiment, variant)
    outcome = run(job)
    print(f"{progress(campaign.runs, job.out.name)}{experiment} {variant}: {result_line(job, outcome)}", flush=True)
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
    parser.add_argument("action", choices=("prepare", "run", "failed"))
    parser.add_argument("names", nargs="*", metavar="EXPERIMENT VARIANT")
    parser.add_argument("--runs", type=Path, default=ROOT / "runs")
    parser.add_argument("--only", default="", help="beginnings of names of experiments, comma-separated")
    parser.add_argument("--settings", default="", help="scene keys for all runs, KEY=VALUE separated by spaces")
    options = parser.parse_args(arguments)
    only = tuple(filter(None, options.only.split(",")))
    campaign = Campaign(options.runs.resolve(), only, tuple(options.settings.split()))
    if not campaign.scenes():
        parser.error(f"no experiment begins with {options.only}; there are {', '.join(experiment_names())}")
    if options.action == "run":
        if len(options.names) != 2:
            parser.error("run takes an experiment and a variant")
        return run_one(campaign, *options.names)
    if options.action == "failed":
        return report_failed(campaign)
    done, todo = prepare(campaign)
    print(f"{todo} runs to make, {done} done before for the same scene and solver")
    return 0


def experiment_names() -> list[str]:
    """The names of all experiments."""
    return [path.stem for path in sorted(EXPERIMENTS.glob("*.toml"))]


if __name__ == "__main__":
    sys.exit(main())
