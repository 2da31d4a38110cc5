"""The machine that measures: what it is, and whether anything else is at work on it."""
from __future__ import annotations

import os
import platform
import re
import subprocess
import time
from dataclasses import asdict, dataclass
from datetime import datetime, timezone
from pathlib import Path

from verification.harness.paths import ROOT, solver

IDLE_LOAD = 0.35  # load average over a minute below which nothing else is at work
WAIT_S = 90.0  # how long to wait for that


@dataclass(frozen=True)
class Machine:
    """Hardware, system and program of a measurement."""

    processor: str
    cores: int
    memory_GB: float
    system: str
    compiler: str
    build: str
    version: str
    revision: str

    @property
    def identity(self) -> str:
        """What tells one machine from another: processor, cores and system."""
        return f"{self.processor}, {self.cores} cores, {self.system}"

    def as_json(self) -> dict[str, object]:
        """As plain data."""
        return asdict(self)


def said_by(*command: str) -> str:
    """First line of what a command prints; nothing where it cannot be run."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    except OSError:
        return ""
    return done.stdout.strip().splitlines()[0] if done.returncode == 0 and done.stdout.strip() else ""


def _first(pattern: str, file: Path) -> str:
    """The first match of a pattern's group in a file; nothing where there is none."""
    try:
        found = re.search(pattern, file.read_text(encoding="utf-8", errors="replace"), re.MULTILINE)
    except OSError:
        return ""
    return found.group(1).strip() if found else ""


def this_machine() -> Machine:
    """This machine, the solver and the compiler that built it."""
    cache = solver().parent / "CMakeCache.txt"
    compiler = _first(r"^CMAKE_CXX_COMPILER:[A-Z]+=(.*)$", cache)
    dirty = "+" if said_by("git", "status", "--porcelain", "--untracked-files=no", "--", "solver", "reference", "CMakeLists.txt") else ""
    return Machine(
        processor=_first(r"^model name\s*:\s*(.*)$", Path("/proc/cpuinfo")) or platform.processor() or platform.machine(),
        cores=os.cpu_count() or 1,
        memory_GB=round(int(_first(r"^MemTotal:\s*(\d+)", Path("/proc/meminfo")) or 0) / 1048576, 1),
        system=f"{platform.system()} {platform.release()}",
        compiler=said_by(compiler or "c++", "--version"),
        build=_first(r"^CMAKE_BUILD_TYPE:[A-Z]+=(.*)$", cache),
        version=said_by(str(solver()), "--version"),
        revision=f"{said_by('git', 'rev-parse', '--short', 'HEAD')}{dirty}",
    )  # fmt: skip


def now() -> str:
    """Date and time, UTC, to the second."""
    return datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M:%S")


def load() -> float:
    """Load average over the last minute."""
    return os.getloadavg()[0]


def others_running() -> int:
    """Threads that run or want to, besides the one that asks."""
    return max(int(_first(r"^procs_running (\d+)", Path("/proc/stat")) or 1) - 1, 0)


def becomes_idle(wait_s: float = WAIT_S) -> bool:
    """Wait until the machine is idle; False where it is not within wait_s."""
    start = time.monotonic()
    while load() > IDLE_LOAD:
        if time.monotonic() - start > wait_s:
            return False
        time.sleep(2.0)
    return True
