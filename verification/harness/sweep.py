"""The runs of a scene's [sweep], made here or as a Slurm job array, and one table of all of them.

usage: ci/sweep SCENE [--jobs N] [--threads N] [--out DIR] [--lean] [--longest S] [--observe MODULE:FUNCTION]
                [--slurm [--chunk N] [--sbatch OPTIONS]]

Makes what is not there for the same scene and solver below DIR (runs/sweep/SCENE), a folder a run; runs that were cut short go on. Then writes
DIR/sweep.csv, a row a run: keys, how it ended and why, what was observed; and DIR/sweep.h5, the same with each run's history. Both are the same to the
byte however often all of this was killed. --jobs threads work side by side, --threads of them in a run. --lean keeps no fields of a run. --observe names
what is taken of a run, verification.harness.sweep:observed for one. --slurm has an element of a job array make --chunk runs, with OPTIONS of sbatch.
Exit status: 0 all runs completed, 3 some did not (the table says why), 2 for bad input.
"""

import argparse
import csv
import hashlib
import importlib
import json
import math
import shlex
import shutil
import subprocess
import sys
import time
import tomllib
import typing
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from threading import Event
from typing import Any

import h5py
import numpy as np

from verification.harness import store
from verification.harness.campaign import result_line
from verification.harness.command import command
from verification.harness.load import LoadError, Run, read_history
from verification.harness.paths import ROOT, RUNS, need_solver, solver
from verification.harness.run import CUT_SHORT, FINAL, Job, Made, Task, claimed, done_before, duration, load_outcome, make, say, side_by_side, summary_in

TRIES = 3  # of runs that are killed each time

Row = dict[str, Any]
OBSERVED = "verification.harness.sweep:observed"

# Slurm: the most elements of an array (its own bound is 1001 by default), how often the queue is looked at (s), what a controller that is away makes
# its commands say.
MOST_ELEMENTS, LOOK_S = 1000, 2.0
AWAY = ("Unable to contact slurm controller", "Connection refused", "timed out", "Zero Bytes", "connect failure")


def jobs_of(scene: Path, out: Path, threads: int = 1) -> list[Job]:
    """The runs of a scene's sweep as `strata sweep` has them; raises ValueError with what it refuses."""
    done = subprocess.run([str(solver()), "sweep", str(scene)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise ValueError(done.stderr.strip())
    return [Job(scene, run["variant"], out / "runs" / run["name"], tuple(run["set"]), threads) for run in tomllib.loads(done.stdout)["runs"]]


def axes_of(job: Job) -> dict[str, str]:
    """What a run's scene has that others of the sweep have not, by keys."""
    given = (setting.partition("=")[::2] for setting in job.settings)
    return ({"variant": job.variant} if job.variant else {}) | {key: value.strip("\"'") for key, value in given}


def observed(run: Run) -> Row:
    """What a run shows in numbers: inlet pressures of its first events (Pa) and how many of each there were, tips and fracture at the end, marks."""
    row: Row = {}
    for kind in ("start", "reach_interface", "arrest", "restart", "stop"):
        events = [event for event in run.summary.events if event.kind == kind]
        row[f"{kind}_Pa"] = events[0].inlet_Pa if events else math.nan
        if kind in ("arrest", "restart"):
            row[f"{kind}s"] = len(events)
        if kind == "arrest":
            row["arrest_y_m"] = events[0].tip_y_m if events else math.nan
    ends = sorted(run.summary.tips, key=lambda tip: tip.y_m)
    row |= {"lowest_tip_y_m": ends[0].y_m if ends else math.nan}
    for name in ("x_m", "y_m", "K_I_Pa_sqrt_m", "K_II_Pa_sqrt_m", "J_N_m"):
        row[f"highest_tip_{name}"] = getattr(ends[-1], name) if ends else math.nan
    row |= {name: getattr(run.summary, name) for name in ("inlet_Pa", "time_s", "mouth_opening_m", "fracture_volume_m2")}
    row |= {"suspect": " ".join(mark.monitor for mark in run.summary.suspect)}
    for name in ("x_m", "K_I_Pa_sqrt_m", "K_II_Pa_sqrt_m", "J_N_m", "G_N_m"):
        row[f"lowest_tip_{name}"] = getattr(ends[0], name) if ends else math.nan
    return row | {"highest_tip_G_N_m": ends[-1].G_N_m if ends else math.nan}


def observer(name: str) -> Callable[[Run], Row]:
    """The function MODULE:FUNCTION; raises ValueError where there is none."""
    module, _, function = name.partition(":")
    try:
        return typing.cast(Callable[[Run], Row], getattr(importlib.import_module(module), function))
    except (ImportError, AttributeError, ValueError) as error:
        raise ValueError(f"--observe {name}: {error}. Write MODULE:FUNCTION") from error


def made(job: Job, observe: str, lean: bool, longest_s: float | None, stop: Event) -> Made:
    """Make a run and keep what is observed of it beside its summary."""
    with claimed(job.out):
        outcome, run = make(job, stop, limit_s=longest_s)
        kept: Row = {"key": outcome.key, "observe": observe}
        if run is not None and outcome.ok and (not outcome.skipped or not kept.items() <= kept_of(job).items()):
            try:
                kept["row"] = observer(observe)(run)
            except (LoadError, LookupError, ValueError, TypeError, ArithmeticError, OSError) as error:
                kept["why"] = f"not observed: {type(error).__name__}: {error}"
            store.write(kept, job.out / "row.json")
            for name in ("result.h5", "result.xdmf") if lean else ():
                (job.out / name).unlink(missing_ok=True)
    return outcome, run


def kept_of(job: Job) -> Row:
    """What is kept of a run's observation; nothing where there is none."""
    path = job.out / "row.json"
    return dict(json.loads(path.read_text(encoding="utf-8"))) if path.is_file() else {}


def missing(jobs: Sequence[Job], observe: str) -> list[Job]:
    """Those that have no outcome, or whose observation is another."""
    found = {job: done_before(job) for job in jobs}
    return [job for job, outcome in found.items()
            if outcome is None or (outcome.ok and not {"key": outcome.key, "observe": observe}.items() <= kept_of(job).items())]  # fmt: skip


def row_of(job: Job) -> Row:
    """A run's row: its name and keys, how it ended, what was observed."""
    outcome, kept = load_outcome(job.out), kept_of(job)
    status, reason = ("missing", "not made") if outcome is None else (outcome.word, outcome.reason or str(summary_in(job.out).get("reason", "")))
    if status == "completed" and "row" not in kept:
        status, reason = "failed", kept.get("why", "completed, but what it wrote cannot be read")
    return {"run": job.out.name, **axes_of(job), "status": status, "reason": reason, **(kept["row"] if status == "completed" else {})}


def write_csv(rows: Sequence[Row], path: Path) -> Path:
    """A table with a line a row; what is no number, or is not there, is an empty cell."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    new = path.with_name(f"{path.name}.new")
    with new.open("w", encoding="utf-8", newline="") as file:
        lines = csv.DictWriter(file, names, lineterminator="\n")
        lines.writeheader()
        lines.writerows(rows)
    return new.replace(path)


def column(values: Sequence[Any]) -> np.ndarray:
    """A column of numbers (NaN where there is none) if all that is there are, else of words."""
    try:
        return np.array([math.nan if value in (None, "") else float(value) for value in values])
    except ValueError:
        return np.array(["" if value is None else str(value) for value in values], dtype=h5py.string_dtype())


def write_h5(rows: Sequence[Row], jobs: Sequence[Job], path: Path) -> Path:
    """The table by columns in /table, and each run's history as rows by columns in /histories/RUN, whose columns it names."""
    new = path.with_name(f"{path.name}.new")
    with h5py.File(new, "w") as file:
        for name in dict.fromkeys(name for row in rows for name in row):
            file.create_dataset(f"table/{name}", data=column([row.get(name) for row in rows]))
        for job, row in zip(jobs, rows):
            if row["status"] == "completed":
                history = read_history(job.out / "history.csv")
                file.create_dataset(f"histories/{row['run']}", data=np.column_stack(list(history.values()))).attrs["columns"] = list(history)
    return new.replace(path)


def here(jobs: Sequence[Job], at_a_time: int, how: argparse.Namespace) -> None:
    """Make runs side by side."""
    side_by_side([Task(job.out.name, partial(made, job, how.observe, how.lean, how.longest), result_line, 1.0, job.threads) for job in jobs], at_a_time)


def cut_short(job: Job) -> bool:
    """Whether a run was killed, or what was to make it."""
    outcome = load_outcome(job.out)
    return outcome is None or outcome.exit_status in CUT_SHORT


def asked(*words: str) -> str:
    """What a command of Slurm says; waits for a controller that is away, raises ValueError for what it refuses."""
    while True:
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode == 0:
            return done.stdout.strip()
        if not any(word in done.stderr for word in AWAY):
            raise ValueError(f"{' '.join(words[:1])}: {done.stderr.strip()}")
        say(f"slurm: waiting for its controller: {done.stderr.strip().splitlines()[-1]}")
        time.sleep(LOOK_S)


def by_slurm(rest: Sequence[Job], elements: Sequence[int], element: Sequence[str], out: Path, threads: int, options: Sequence[str]) -> None:
    """Have elements of a job array make runs, each by a command that is given its number; one that is in the queue already is waited for."""
    name = f"sweep-{hashlib.sha256(str(out).encode()).hexdigest()[:12]}"
    (out / "slurm").mkdir(parents=True, exist_ok=True)
    queue = ("squeue", "--noheader", f"--name={name}", "--format=%i")
    start, said = time.monotonic(), -1
    if not asked(*queue):
        numbers, run = ",".join(map(str, elements)), f'exec {shlex.join(element)} "$SLURM_ARRAY_TASK_ID"'
        asked("sbatch", "--no-requeue", f"--array={numbers}", f"--job-name={name}", f"--cpus-per-task={threads}", f"--chdir={ROOT}", f"--output={out}/slurm/%a.txt",
              *options, "--wrap", run)  # fmt: skip
        say(f"slurm: {len(elements)} elements of a job array, {name}; `scancel --name={name}` ends them, this command may be ended and given again")
    while asked(*queue):
        done = sum(outcome is not None and outcome.exit_status in FINAL for outcome in (load_outcome(job.out) for job in rest))
        if done != said:
            say(f"[{done}/{len(rest)}] {duration(time.monotonic() - start)}")
        said = done
        time.sleep(LOOK_S)


def main(arguments: list[str] | None = None) -> int:
    """A sweep from the command line."""
    parser = command("ci/sweep", __doc__, "jobs", "out")
    parser.add_argument("scene", type=Path)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--lean", action="store_true")
    parser.add_argument("--observe", default=OBSERVED)
    parser.add_argument("--longest", type=float, help="seconds after which a run is given up")
    parser.add_argument("--slurm", action="store_true")
    parser.add_argument("--chunk", type=int, default=1)
    parser.add_argument("--sbatch", default="", help="options of sbatch, in quotes")
    parser.add_argument("--element", type=int, help="make these runs only (of the job array)")
    options = parser.parse_args(arguments)
    scene, observe = options.scene.resolve(), options.observe
    out = (options.out or RUNS / "sweep" / scene.stem).resolve()
    try:
        need_solver()
        observer(observe)
        if options.slurm and shutil.which("sbatch") is None:
            raise ValueError("there is no sbatch: --slurm is for a machine from which jobs are submitted")
        jobs = jobs_of(scene, out, options.threads)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    chunk = max(options.chunk, math.ceil(len(jobs) / MOST_ELEMENTS))
    if options.element is not None:
        here(jobs[options.element * chunk :][:chunk], options.threads, options)
        return 0
    rest = missing(jobs, observe)
    say(f"{len(rest)} runs to make, {len(jobs) - len(rest)} done before for the same scene and solver")
    element = [sys.executable, "-s", "-m", "verification.harness.sweep", str(scene), f"--out={out}", f"--threads={options.threads}", f"--chunk={chunk}",
               f"--observe={observe}", *["--lean"] * options.lean, *[f"--longest={options.longest}"] * bool(options.longest), "--element"]  # fmt: skip
    idle = 0
    while rest and idle < TRIES:
        if options.slurm:
            try:
                by_slurm(rest, sorted({jobs.index(job) // chunk for job in rest}), element, out, options.threads, shlex.split(options.sbatch))
            except ValueError as error:
                print(error, file=sys.stderr)
                return 2
        else:
            here(rest, options.jobs, options)
        before, rest = len(rest), [job for job in missing(rest, observe) if cut_short(job)]
        idle = idle + 1 if len(rest) == before else 0
    rows = [row_of(job) for job in jobs]
    failed = [row for row in rows if row["status"] != "completed"]
    print(*(f"{row['status']}: {row['run']}: {row['reason']}" for row in failed), f"{len(rows)} runs, {len(failed)} failed", sep="\n")
    print(f"{write_csv(rows, out / 'sweep.csv')}\n{write_h5(rows, jobs, out / 'sweep.h5')}")
    return 3 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
