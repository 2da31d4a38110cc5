"""The machine that measures: what it is, how busy it is, and what was built on it."""

import os
import platform
import re
import subprocess
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from verification.harness.paths import ROOT, solver

# Above either nothing is recorded without --force: load average at the start, and processors at work for others.
LARGEST_LOAD, LARGEST_BUSY = 0.5, 0.15
WAIT_S = 90.0  # how long the chart waits for an idle machine


@dataclass(frozen=True)
class Machine:
    """What figures depend on: processor, number of processors, caches (innermost first)."""

    cpu: str
    cores: int
    caches: str

    @property
    def key(self) -> str:
        """A name for files: all of it in lower case."""
        return re.sub(r"[^a-z0-9]+", "_", f"{self.cpu} {self.cores} cores {self.caches}".lower()).strip("_")

    @property
    def words(self) -> str:
        """For people."""
        return f"{self.cpu}, {self.cores} cores, {self.caches}"


@dataclass(frozen=True)
class Build:
    """What was timed: version and commit (with + where files differ from it), compiler, flags."""

    version: str
    commit: str
    compiler: str = ""
    flags: str = ""


@dataclass(frozen=True)
class Load:
    """How busy the machine was, in processors: load average at the start, others' work just before and just after."""

    average: float
    busy_before: float
    busy_after: float = 0.0

    @property
    def noisy(self) -> str:
        """Why figures taken now are not to be trusted; empty where they are."""
        if self.average > LARGEST_LOAD:
            return f"the load average was {self.average:.2f} at the start, above {LARGEST_LOAD:g}"
        busy = max(self.busy_before, self.busy_after)
        return f"other programs used {busy:.2f} processors, more than {LARGEST_BUSY:g}" if busy > LARGEST_BUSY else ""


def first(pattern: str, file: Path) -> str:
    """The first match of a pattern's group in a file; nothing where there is none."""
    try:
        found = re.search(pattern, file.read_text(encoding="utf-8", errors="replace"), re.MULTILINE)
    except OSError:
        return ""
    return found.group(1).strip() if found else ""


def this_machine(info: Path = Path("/proc/cpuinfo"), caches: Path = Path("/sys/devices/system/cpu/cpu0/cache")) -> Machine:
    """The machine this runs on: name, family, model and stepping of its first processor, and that one's data and unified caches."""
    numbers = [first(rf"^{name}\s*:(.*)$", info) for name in ("cpu family", "model", "stepping")]
    cpu = " ".join([first(r"^model name\s*:(.*)$", info) or "unknown processor", *filter(None, numbers)])
    levels = [[first("(.*)", index / name) for name in ("level", "type", "size")] for index in sorted(caches.glob("index*"))]
    return Machine(cpu, os.cpu_count() or 1, " ".join(f"L{level} {size}" for level, kind, size in levels if level and kind != "Instruction"))


def busy_processors(seconds: float = 1.5) -> float:
    """Processors at work over some seconds in which this program waits, from the ticks in the first line of /proc/stat."""

    def ticks() -> tuple[int, int]:
        """Idle or waiting for a disk, and all."""
        every = [int(word) for word in Path("/proc/stat").read_text(encoding="utf-8").splitlines()[0].split()[1:9]]
        return every[3] + every[4], sum(every)

    idle, total = ticks()
    time.sleep(seconds)
    later, end = ticks()
    return (os.cpu_count() or 1) * (1.0 - (later - idle) / (end - total)) if end > total else 0.0


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


def _said(*command: str) -> str:
    """What a command says, empty where it cannot."""
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def this_build(context: Mapping[str, str]) -> Build:
    """Version and commit of the solver; compiler and flags as strata_bench says them in its context."""
    commit = _said("git", "rev-parse", "--short=12", "HEAD")
    changed = _said("git", "status", "--porcelain", "--untracked-files=no", "--", "solver", "CMakeLists.txt")
    flags = " ".join(word for word in context.get("flags", "").split() if not word.startswith("-W"))
    return Build(_said(str(solver()), "--version"), commit + ("+" if changed else ""), context.get("compiler", ""), flags)


def described() -> dict[str, Any]:
    """This machine as data: hardware, memory, system, compiler with its flags, version and revision of the solver."""
    machine, cache = this_machine(), solver().parent / "CMakeCache.txt"
    compiler, kind = (first(rf"^{key}:[A-Z]+=(.*)$", cache) for key in ("CMAKE_CXX_COMPILER", "CMAKE_BUILD_TYPE"))
    flags = " ".join(first(rf"^{key}:[A-Z]+=(.*)$", cache) for key in ("CMAKE_CXX_FLAGS", f"CMAKE_CXX_FLAGS_{kind.upper()}"))
    build = this_build({"compiler": (_said(compiler or "c++", "--version") or compiler).split("\n")[0], "flags": flags})
    memory = int(first(r"^MemTotal:\s*(\d+)", Path("/proc/meminfo")) or 0) / 1048576
    return {
        "processor": machine.cpu, "cores": machine.cores, "caches": machine.caches, "memory_GB": round(memory, 1),
        "system": f"{platform.system()} {platform.release()}", "compiler": build.compiler, "flags": build.flags, "version": build.version,
        "revision": build.commit,
    }  # fmt: skip


def made_here(known: Mapping[str, Any], here: Mapping[str, Any]) -> bool:
    """Whether measurements come from this hardware; those of which that cannot be told do not."""
    return all(known.get(key) == here[key] for key in ("processor", "cores", "caches"))
