"""One run of the solver as a user makes it: how long it took, what it used, what it found."""
from __future__ import annotations

import os
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from verification.harness.load import LoadError, Summary, read_summary
from verification.harness.paths import solver


@dataclass(frozen=True)
class Setting:
    """A run to be made: a scene, its variant, further settings, threads."""

    scene: Path
    variant: str = ""
    settings: tuple[str, ...] = ()
    threads: int = 1

    @property
    def name(self) -> str:
        """Scene and variant."""
        return f"{self.scene.stem}/{self.variant or 'default'}"


@dataclass(frozen=True)
class Taken:
    """What a run took: seconds from start to end of the process, processor seconds; its summary."""

    setting: Setting
    seconds: float
    cpu_s: float
    summary: Summary | None
    problem: str = ""


def command_of(setting: Setting, out: Path) -> list[str]:
    """The command line of a run."""
    command = [str(solver()), "run", str(setting.scene), "--out", str(out), "--threads", str(setting.threads), "--quiet"]
    if setting.variant:
        command += ["--variant", setting.variant]
    for item in setting.settings:
        command += ["--set", item]
    return command


def take(setting: Setting, until: float = float("inf")) -> Taken:
    """Make a run in a folder that is not kept; it is ended where time.monotonic() passes `until`."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "run"
        log = Path(folder) / "log.txt"
        start = time.monotonic()
        if start >= until:
            return Taken(setting, 0.0, 0.0, None, "not begun: the time for these runs was over")
        with log.open("w", encoding="utf-8") as stream:
            process = subprocess.Popen(command_of(setting, out), stdout=stream, stderr=stream)
        status, usage, ended = _wait(process, until)
        seconds = time.monotonic() - start
        cpu_s = usage.ru_utime + usage.ru_stime
        if ended:
            return Taken(setting, seconds, cpu_s, None, "ended: the time for these runs was over")
        try:
            summary = read_summary(out / "summary.json")
        except LoadError as error:
            said = " / ".join(log.read_text(encoding="utf-8").strip().splitlines()[-2:])
            return Taken(setting, seconds, cpu_s, None, said or str(error))
    problem = "" if status == 0 else f"exit status {status}: {summary.reason}"
    return Taken(setting, seconds, cpu_s, summary, problem)


def _wait(process: subprocess.Popen[bytes], until: float) -> tuple[int, Any, bool]:
    """Wait for a process, ending it when its time is over: exit status, what it used, whether it was ended."""
    ended = False
    while True:
        pid, status, usage = os.wait4(process.pid, os.WNOHANG if until != float("inf") else 0)
        if pid == process.pid:
            process.returncode = os.waitstatus_to_exitcode(status)  # so that Popen does not wait for it again
            return process.returncode, usage, ended
        if time.monotonic() > until and not ended:
            process.terminate()
            ended = True
        time.sleep(0.01)


def take_all(settings: Sequence[Setting], jobs: int, limit_s: float, tell: Callable[[str], None]) -> tuple[float, list[Taken]]:
    """Make runs side by side, for `limit_s` at most; seconds from the first's start to the last's end, and each run."""
    start = time.monotonic()

    def one(setting: Setting) -> Taken:
        taken = take(setting, start + limit_s)
        tell(f"{setting.name}: {taken.problem or f'{taken.seconds:.2f} s'}")
        return taken

    with ThreadPoolExecutor(max_workers=jobs) as pool:
        taken = list(pool.map(one, settings))
    return time.monotonic() - start, taken
