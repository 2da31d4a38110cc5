"""Kill runs at random moments and resume them; every one must end as a run that was left alone, to the last digit.

usage: python3 -m verification.faults [--kills 200] [--seed 1] [--checkpoint-every 0.02] [--record]

Exit status: 0 all the same, 1 something differs or is torn.
"""

import random
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

from verification.faults.same import differences, torn
from verification.harness import command, store
from verification.harness.paths import ANALYTIC, EXPERIMENTS, solver
from verification.harness.run import TOO_LONG, Job, command_of, ended

RECORD = Path(__file__).parent / "records" / "kills.json"
AGAIN = 0.4  # of the resumed runs are killed again

# Each mechanics and law of the fluid; all take a second or so.
QUASISTATIC, COARSE = "numerics.mechanics=quasistatic", ("numerics.cell_m=2", "fracture.increment_m=2")
EXP1, EXP5 = EXPERIMENTS / "exp1_single_interface.toml", EXPERIMENTS / "exp5_parallel_interface.toml"
HERE = Path()
KILLED = {
    "explicit total": Job(EXP1, "weak", HERE, (*COARSE, "stop.tip_y_m=40")),
    "explicit updated": Job(EXP1, "weak", HERE, ("numerics.kinematics=updated", *COARSE, "stop.time_s=0.9", "fluid.inlet={start_Pa=2.3e6, rate_Pa_s=0.7e6}")),
    "quasi-static paper": Job(EXP1, "soft", HERE, (QUASISTATIC, "stop.tip_y_m=40")),
    "quasi-static turning": Job(EXP5, "", HERE, (QUASISTATIC, *COARSE)),
    "quasi-static reynolds": Job(ANALYTIC / "kgd.toml", "", HERE, ("stop.time_s=4",)),
    "quasi-static leak-off": Job(ANALYTIC / "kgd_leakoff.toml", "", HERE, ("stop.time_s=60", 'fluid.inlet={table=[[0,5e-5],[20,5e-5],[20.001,0]],of="rate_m2_s"}')),
}


@dataclass
class Tally:
    """What became of the runs of a scene."""

    name: str
    wall_s: float                  # of the run left alone
    kills: int = 0
    trials: int = 0
    from_checkpoint: int = 0       # resumed after a kill,
    from_start: int = 0            # there being no checkpoint yet,
    before_folder: int = 0         # or, before the folder said of which scene it is, run again
    after_end: int = 0             # killed with the summary written
    identical: int = 0
    problems: list[str] = field(default_factory=list)


def run_words(job: Job, folder: Path, every_s: float) -> list[str]:
    """The command that makes a run into a folder, or resumes it where that says of which scene it is; a checkpoint every so often (s)."""
    begun = [str(solver()), "resume", str(folder), "--threads", "1", "--quiet"]
    words = begun if (folder / "scene.toml").is_file() else command_of(replace(job, out=folder), solver())
    return [*words, "--checkpoint-every", f"{every_s:g}"]


def try_once(job: Job, alone: Path, folder: Path, tally: Tally, every_s: float, rng: random.Random) -> None:
    """One run, killed at least once unless it ends before, resumed to its end and compared."""
    shutil.rmtree(folder, ignore_errors=True)
    kill = True
    while True:
        status, said = ended(run_words(job, folder, every_s), rng.uniform(0.0, 1.1 * tally.wall_s) if kill else None)
        if status != TOO_LONG:
            break
        tally.kills += 1
        left = {"summary.json": "after_end", "checkpoint.bin": "from_checkpoint", "scene.toml": "from_start"}
        next_begins = next((where for name, where in left.items() if (folder / name).exists()), "before_folder")
        setattr(tally, next_begins, getattr(tally, next_begins) + 1)
        tally.problems += [f"after kill {tally.kills}: {line}" for line in torn(folder)]
        kill = rng.random() < AGAIN
    tally.trials += 1
    found = [f"exit status {status}: {said.strip()}"] if status != 0 else differences(alone, folder)
    tally.identical += not found
    tally.problems += [f"trial {tally.trials}: {line}" for line in found[:5]]


def campaign(name: str, kills: int, every_s: float, seed: int) -> Tally:
    """Kill runs of a scene until there were `kills`; checkpoints every `every_s` seconds. Deterministic but for the clock."""
    rng = random.Random(f"{seed} {name}")
    with tempfile.TemporaryDirectory() as folder:
        alone, start = Path(folder) / "alone", time.monotonic()
        status, said = ended(run_words(KILLED[name], alone, 60.0), None)
        tally = Tally(name, time.monotonic() - start)
        if status != 0:
            tally.problems.append(f"the run left alone: exit status {status}: {said.strip()}")
            return tally
        while tally.kills < kills:
            try_once(KILLED[name], alone, Path(folder) / "killed", tally, every_s, rng)
    return tally


def table(tallies: list[Tally]) -> str:
    """The campaign as text."""
    header = ("scene", "kills", "checkpoint", "start", "no folder", "ended", "runs", "identical")
    numbers = [(t.kills, t.from_checkpoint, t.from_start, t.before_folder, t.after_end, t.trials, t.identical) for t in tallies]
    lines = command.aligned([header, *((t.name, *map(str, row)) for t, row in zip(tallies, numbers))], range(1, len(header)))
    return "\n".join([*lines, *(f"  {problem}" for t in tallies for problem in t.problems)])


def main(arguments: list[str] | None = None) -> int:
    """Command line."""
    parser = command.command("verification.faults", __doc__)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--checkpoint-every", type=float, default=0.02, metavar="S")
    parser.add_argument("--record", action="store_true", help=f"keep the figures in {RECORD.name}")
    options = parser.parse_args(arguments)
    tallies = []
    for k, name in enumerate(KILLED):
        share = options.kills * (k + 1) // len(KILLED) - options.kills * k // len(KILLED)
        tallies.append(campaign(name, share, options.checkpoint_every, options.seed))
        print(table(tallies[-1:]), flush=True)
    sums = {key: sum(getattr(tally, key) for tally in tallies) for key in ("kills", "trials", "identical", "from_checkpoint", "from_start")}
    if options.record:
        version = subprocess.run([str(solver()), "--version"], capture_output=True, text=True, check=True).stdout.strip()
        made = {"version": version, "seed": options.seed, "checkpoint_every_s": options.checkpoint_every}
        store.write({**made, **sums, "scenes": [asdict(tally) for tally in tallies]}, RECORD)
    print(f"{sums['kills']} kills, {sums['trials']} runs, {sums['identical']} identical")
    return 0 if all(tally.identical == tally.trials and not tally.problems for tally in tallies) else 1


if __name__ == "__main__":
    sys.exit(main())
