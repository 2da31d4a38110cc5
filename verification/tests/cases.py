"""Runs that tests share, made once for the same scene and solver, also when several tests ask at the same time; runs of their own; a program on a terminal."""

import csv
import hashlib
import json
import os
import pty
import select
import subprocess
import textwrap
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from verification.harness import paths
from verification.harness.load import Run, load
from verification.harness.paths import solver
from verification.harness.run import Job, Outcome, claimed, run

RUNS = paths.RUNS / "tests"
SCENES = Path(__file__).parent / "scenes"


def first_scene(readme: Path = paths.ROOT / "README.md") -> str:
    """The first scene of a README."""
    return textwrap.dedent(next(part for part in readme.read_text(encoding="utf-8").split("\n\n") if part.startswith('    title = "My first'))) + "\n"


def make(scene: Path, variant: str = "", settings: tuple[str, ...] = ()) -> tuple[Outcome, Path]:
    """Make a run unless it is there; its outcome and folder, another one for other settings."""
    tag = hashlib.sha256("\n".join(settings).encode()).hexdigest()[:8] if settings else "as_is"
    folder = RUNS / scene.stem / f"{variant or 'base'}_{tag}"
    with claimed(folder):
        return run(Job(scene, variant, folder, settings)), folder


def completed(scene: Path, variant: str = "", settings: tuple[str, ...] = ()) -> Run:
    """Make a run that has to complete, and load it."""
    outcome, folder = make(scene, variant, settings)
    assert outcome.ok, f"{scene.stem} {variant}: {outcome.reason}"
    return load(folder)


def strata(folder: Path, *arguments: str | Path, **how: Any) -> subprocess.CompletedProcess[str]:
    """A command of the solver, run in a folder."""
    return subprocess.run([str(solver()), *map(str, arguments)], cwd=folder, capture_output=True, text=True, check=False, timeout=300, **how)


def summary_of(run: Path) -> dict[str, Any]:
    return dict(json.loads((run / "summary.json").read_text(encoding="utf-8")))


def rows_of(run: Path) -> list[dict[str, str]]:
    return list(csv.DictReader((run / "history.csv").read_text(encoding="utf-8").splitlines()))


def run_in(folder: Path, scene: str | Path, *settings: str, variant: str = "") -> subprocess.CompletedProcess[str]:
    """A run of a scene (its text, or its file) with these settings into folder/X, in place of one that is there."""
    file = scene if isinstance(scene, Path) else folder / "scene.toml"
    if isinstance(scene, str):
        file.write_text(scene, encoding="utf-8")
    chosen = [*(["--variant", variant] if variant else []), *(word for setting in settings for word in ("--set", setting))]
    return strata(folder, "run", file, *chosen, "--out", "X", "--replace", "--quiet", "--threads", "1")


def summary_in(folder: Path, scene: str | Path, *settings: str) -> dict[str, Any]:
    """The summary of such a run, which has to complete."""
    done = run_in(folder, scene, *settings)
    assert done.returncode == 0, done.stderr
    return summary_of(folder / "X")


def wait_for(file: Path) -> None:
    while not file.exists():
        time.sleep(0.005)


def on_terminal(command: Sequence[str | Path], folder: Path, typed: Sequence[tuple[str, str]] = (), **environment: str) -> str:
    """What a program shows on a terminal of its own. typed: keys, and the text that has to be shown, after them, before what comes next is typed."""
    ours, theirs = pty.openpty()
    variables = {**os.environ, "TERM": "xterm", **environment}
    with subprocess.Popen(list(map(str, command)), cwd=folder, env=variables, stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True) as program:
        os.close(theirs)
        shown, until, waiting = "", "", list(typed)
        seen, end = 0, time.monotonic() + 60  # of what was shown when the last keys were typed
        try:
            while time.monotonic() < end:
                if waiting and until in shown[seen:]:
                    keys, until = waiting.pop(0)
                    seen = len(shown)
                    os.write(ours, keys.encode())
                if select.select([ours], [], [], 0.1)[0]:
                    shown += os.read(ours, 4096).decode()
        except OSError:  # the program has ended
            pass
        finally:
            os.close(ours)
            program.kill()
        assert not waiting and until in shown[seen:], shown
    return shown
