"""The machine that measures: what it is, what was built on it, and whether anything else is at work on it."""
from __future__ import annotations

import os
import platform
import re
import subprocess
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from verification.benchmarks.machine import LARGEST_BUSY, LARGEST_LOAD, Build, busy_processors, this_build
from verification.benchmarks.machine import Machine as Hardware
from verification.benchmarks.machine import this_machine as this_hardware
from verification.harness.paths import solver

WAIT_S = 90.0  # how long to wait for an idle machine


@dataclass(frozen=True)
class Machine:
    """Where a measurement was made: hardware, memory, system, compiler with its flags, version and revision of the solver."""

    processor: str
    cores: int
    caches: str
    memory_GB: float
    system: str
    compiler: str
    flags: str
    version: str
    revision: str

    @property
    def identity(self) -> str:
        """What tells one machine from another: the hardware."""
        return Hardware(self.processor, self.cores, self.caches).key

    def as_json(self) -> dict[str, object]:
        """As plain data."""
        return asdict(self)


def made_here(sheet_machine: Mapping[str, Any], here: Machine) -> bool:
    """Whether measurements come from this hardware; those of which that cannot be told do not."""
    try:
        return Machine(**sheet_machine).identity == here.identity
    except TypeError:
        return False


def first(pattern: str, file: Path) -> str:
    """The first match of a pattern's group in a file; nothing where there is none."""
    try:
        found = re.search(pattern, file.read_text(encoding="utf-8", errors="replace"), re.MULTILINE)
    except OSError:
        return ""
    return found.group(1).strip() if found else ""


def built_with(cache: Path) -> dict[str, str]:
    """Compiler and flags of a build folder's CMakeCache.txt, as this_build takes them."""
    compiler, kind = (first(rf"^{key}:[A-Z]+=(.*)$", cache) for key in ("CMAKE_CXX_COMPILER", "CMAKE_BUILD_TYPE"))
    flags = " ".join(first(rf"^{key}:[A-Z]+=(.*)$", cache) for key in ("CMAKE_CXX_FLAGS", f"CMAKE_CXX_FLAGS_{kind.upper()}"))
    try:
        said = subprocess.run([compiler or "c++", "--version"], capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        said = ""
    return {"compiler": said.splitlines()[0] if said else compiler, "flags": flags}


def this_machine() -> Machine:
    """This machine, the solver and the compiler that built it."""
    hardware: Hardware = this_hardware()
    build: Build = this_build(built_with(solver().parent / "CMakeCache.txt"))
    memory = int(first(r"^MemTotal:\s*(\d+)", Path("/proc/meminfo")) or 0) / 1048576
    return Machine(hardware.cpu, hardware.cores, hardware.caches, round(memory, 1), f"{platform.system()} {platform.release()}",
                   build.compiler, build.flags, build.version, build.commit)  # fmt: skip


def now() -> str:
    """Date and time, UTC, to the second."""
    return datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M:%S")


def others_running() -> int:
    """Threads that run or want to, besides the one that asks."""
    return max(int(first(r"^procs_running (\d+)", Path("/proc/stat")) or 1) - 1, 0)


def becomes_idle(wait_s: float = WAIT_S) -> bool:
    """Wait until nothing else is at work; False where that takes more than wait_s."""
    start = time.monotonic()
    while busy_processors() > LARGEST_BUSY or os.getloadavg()[0] > LARGEST_LOAD:
        if time.monotonic() - start > wait_s:
            return False
    return True
