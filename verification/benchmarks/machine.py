"""The machine that benchmarks run on, how busy it is, and what was built."""
from __future__ import annotations

import os
import re
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

from verification.harness.paths import ROOT, solver

# Above either, figures are not recorded without --force: load average when ci/bench began and processors at work for
# others just before the first benchmark, both in processors.
LARGEST_LOAD = 0.5
LARGEST_BUSY = 0.15


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
        if max(self.busy_before, self.busy_after) > LARGEST_BUSY:
            return f"other programs used {max(self.busy_before, self.busy_after):.2f} processors, more than {LARGEST_BUSY:g}"
        return ""


def parse_cpu(cpuinfo: str) -> str:
    """The processor's name with family, model and stepping, from the text of /proc/cpuinfo."""
    found = {}
    for line in cpuinfo.split("\n\n")[0].splitlines():
        name, _, value = line.partition(":")
        found[name.strip()] = value.strip()
    numbers = [found[name] for name in ("cpu family", "model", "stepping") if found.get(name)]
    return " ".join([found.get("model name", "unknown processor"), *numbers])


def caches_of(folder: Path = Path("/sys/devices/system/cpu/cpu0/cache")) -> str:
    """Data and unified caches of the first processor, such as "L1 32K L2 1024K L3 32768K"."""
    found = []
    for index in sorted(folder.glob("index*")):
        try:
            level, kind, size = ((index / name).read_text().strip() for name in ("level", "type", "size"))
        except OSError:
            continue
        if kind != "Instruction":
            found.append(f"L{level} {size}")
    return " ".join(found)


def this_machine() -> Machine:
    """The machine this runs on."""
    return Machine(parse_cpu(Path("/proc/cpuinfo").read_text(encoding="utf-8")), os.cpu_count() or 1, caches_of())


def busy_processors(seconds: float = 1.5, stat: Path = Path("/proc/stat")) -> float:
    """Processors at work over some seconds in which this program waits."""
    before = _idle_and_total(stat.read_text(encoding="utf-8"))
    time.sleep(seconds)
    after = _idle_and_total(stat.read_text(encoding="utf-8"))
    total = after[1] - before[1]
    return (os.cpu_count() or 1) * (1.0 - (after[0] - before[0]) / total) if total > 0 else 0.0


def _idle_and_total(stat: str) -> tuple[int, int]:
    """Ticks of all processors from the first line of /proc/stat: idle or waiting for a disk, and all."""
    ticks = [int(word) for word in stat.splitlines()[0].split()[1:9]]
    return ticks[3] + ticks[4], sum(ticks)


def _said(command: list[str]) -> str:
    """What a command says, empty where it cannot."""
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def this_build(context: dict[str, str] | None = None) -> Build:
    """Version and commit of the solver; compiler and flags as strata_bench says them in its context."""
    commit = _said(["git", "rev-parse", "--short=12", "HEAD"])
    changed = _said(["git", "status", "--porcelain", "--untracked-files=no", "--", "solver", "CMakeLists.txt"])
    context = context or {}
    flags = " ".join(word for word in context.get("flags", "").split() if not word.startswith("-W"))
    return Build(_said([str(solver()), "--version"]), commit + ("+" if changed else ""), context.get("compiler", ""),
                 flags)  # fmt: skip
