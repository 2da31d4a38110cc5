"""Kills runs at random moments, resumes them, perhaps to kill them again, and holds what they end with against a run left alone."""

import random
import shutil
import signal
import subprocess
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

from verification.faults.same import differences, torn
from verification.harness.paths import ANALYTIC, EXPERIMENTS, solver

AGAIN = 0.4  # of the resumed runs are killed again


@dataclass(frozen=True)
class Killed:
    """A scene that is killed, with a variant and settings; all take a second or so."""

    name: str
    scene: Path
    variant: str
    settings: tuple[str, ...]


# Each mechanics and law of the fluid.
QUASISTATIC, COARSE = "numerics.mechanics=quasistatic", ("numerics.cell_m=2", "fracture.increment_m=2")
EXP1, EXP5 = EXPERIMENTS / "exp1_single_interface.toml", EXPERIMENTS / "exp5_parallel_interface.toml"
KILLED = (
    Killed("explicit total", EXP1, "weak", (*COARSE, "stop.tip_y_m=40")),
    Killed("explicit updated", EXP1, "weak",
           ("numerics.kinematics=updated", *COARSE, "stop.time_s=0.9", "fluid.inlet={start_Pa=2.3e6, rate_Pa_s=0.7e6}")),
    Killed("quasi-static paper", EXP1, "soft", (QUASISTATIC, "stop.tip_y_m=40")),
    Killed("quasi-static turning", EXP5, "", (QUASISTATIC, *COARSE)),
    Killed("quasi-static reynolds", ANALYTIC / "kgd.toml", "", ("stop.time_s=4",)),
)  # fmt: skip


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


def command(killed: Killed, folder: Path, every_s: float) -> list[str]:
    """The command that makes the run, or resumes it where the folder says of which scene it is."""
    options = ["--quiet", "--threads", "1", "--checkpoint-every", f"{every_s:g}"]
    if (folder / "scene.toml").is_file():
        return [str(solver()), "resume", str(folder), *options]
    chosen = ["--variant", killed.variant] if killed.variant else []
    settings = [part for setting in killed.settings for part in ("--set", setting)]
    return [str(solver()), "run", str(killed.scene), *chosen, *settings, "--out", str(folder), *options]


def run_until(arguments: list[str], limit_s: float | None) -> tuple[int, str]:
    """Start a process and kill it after limit_s: its exit status, -9 where it was killed, and what it said."""
    with tempfile.TemporaryFile("w+") as said:
        process = subprocess.Popen(arguments, stdout=said, stderr=said)
        try:
            status = process.wait(limit_s)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            status = process.wait()
        said.seek(0)
        return status, said.read()


def note_kill(tally: Tally, folder: Path) -> None:
    """Count a kill and where the next process will begin, and look whether anything is torn."""
    tally.kills += 1
    if (folder / "summary.json").exists():
        tally.after_end += 1
    elif (folder / "checkpoint.bin").exists():
        tally.from_checkpoint += 1
    elif (folder / "scene.toml").exists():
        tally.from_start += 1
    else:
        tally.before_folder += 1
    tally.problems += [f"after kill {tally.kills}: {line}" for line in torn(folder)]


def try_once(killed: Killed, alone: Path, work: Path, tally: Tally, every_s: float, rng: random.Random) -> None:
    """One run, killed at least once unless it ends before, resumed to its end and compared."""
    folder = work / "killed"
    shutil.rmtree(folder, ignore_errors=True)
    kill = True
    while True:
        limit_s = rng.uniform(0.0, 1.1 * tally.wall_s) if kill else None
        status, said = run_until(command(killed, folder, every_s), limit_s)
        if status != -signal.SIGKILL:
            break
        note_kill(tally, folder)
        kill = rng.random() < AGAIN
    tally.trials += 1
    found = [f"exit status {status}: {said.strip()}"] if status != 0 else differences(alone, folder)
    tally.identical += not found
    tally.problems += [f"trial {tally.trials}: {line}" for line in found[:5]]


def campaign(killed: Killed, kills: int, every_s: float, seed: int) -> Tally:
    """Kill runs of a scene until there were `kills`; checkpoints every `every_s` seconds. Deterministic but for the clock."""
    rng = random.Random(f"{seed} {killed.name}")
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        start = time.monotonic()
        status, said = run_until(command(killed, work / "alone", 60.0), None)
        tally = Tally(killed.name, time.monotonic() - start)
        if status != 0:
            tally.problems.append(f"the run left alone: exit status {status}: {said.strip()}")
            return tally
        while tally.kills < kills:
            try_once(killed, work / "alone", work, tally, every_s, rng)
    return tally
