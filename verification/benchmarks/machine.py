"""The machine that measures: what it is, how busy it is, and what was built on it; measured figures, kept as a line of JSON a record in a file a machine, and what
they say: beside the last record of the same machine, and against marks."""

import json
import math
import os
import platform
import re
import statistics
import subprocess
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from verification.harness.paths import ROOT, solver
from verification.harness.store import built, plain

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


RECORDS = Path(__file__).parent / "records"
FORMAT = 1
DIGITS = 5  # of stored numbers
STEP = "particle-step"

# A figure is slower where its calibrated cost is more than this times the last record's, and faster below its inverse. On an
# idle machine medians of five repetitions keep within a few per cent; virtual machines drift by a tenth.
BAND = 1.25
FARTHER = 2.0  # times the round trip between processors: figures on several threads are then those of another machine
ENOUGH = 5  # repetitions on both sides; of fewer a median is no median

SLOWER, FASTER, SAME, NEW, GONE, BROKEN, UNJUDGED = "slower", "faster", "same", "new", "gone", "broken", "not judged"
BAD = (SLOWER, GONE, BROKEN)


@dataclass(frozen=True)
class Figure:
    """A cost, the less the better: seconds a unit of work (`per`), one value a repetition.

    peak_flop_s and stream_B_s: the machine's rates beside each repetition, on as many threads; bound: whether the cost is taken relative to the
    core's or the memory's. round_trip_s: what a line of memory takes from one thread's processor to the other's and back, of figures on several
    threads: a virtual machine may find its processors on one cache now and on two later. about: what was run. problem: why there is no value.
    """

    name: str
    per: str
    values: tuple[float, ...]
    unit: str = "s"
    threads: int = 1
    bound: str = "core"
    peak_flop_s: tuple[float, ...] = ()
    stream_B_s: tuple[float, ...] = ()
    round_trip_s: tuple[float, ...] = ()
    about: dict[str, Any] = field(default_factory=dict)
    problem: str = ""

    @property
    def median(self) -> float:
        """The median of the repetitions; NaN where there is none."""
        return statistics.median(self.values) if self.values else math.nan

    @property
    def spread(self) -> float:
        """(largest - smallest)/median of the repetitions; NaN where there is none."""
        return (max(self.values) - min(self.values)) / self.median if self.values and self.median > 0.0 else math.nan

    @property
    def calibrated(self) -> float:
        """Median of the cost times the rate beside it: what the machine could have done meanwhile (flop or B); NaN without a rate."""
        rates = self.peak_flop_s if self.bound == "core" else self.stream_B_s
        return statistics.median(map(math.prod, zip(self.values, rates))) if 0 < len(self.values) == len(rates) else math.nan

    @property
    def distance(self) -> float:
        """The median round trip between processors (s); NaN of one thread or where none was measured."""
        return statistics.median(self.round_trip_s) if self.threads > 1 and self.round_trip_s else math.nan

    @property
    def share_of_peak(self) -> float | None:
        """Counted flop a second over those of the cores in use; None where none are counted."""
        return self.share("flop_a_unit", self.peak_flop_s)

    def share(self, counted: str, rates: Sequence[float]) -> float | None:
        """A counted amount a second over a rate, such as bytes over the memory's (above 1 where data stay in a cache)."""
        amount = float(self.about.get(counted, 0.0))
        known = amount > 0.0 and 0 < len(self.values) == len(rates)
        return statistics.median(amount / (value * rate) for value, rate in zip(self.values, rates)) if known else None

    def wrong(self) -> str:
        """Why the figure cannot be one: a problem, nothing measured, a cost that is no positive number, more flop than there are."""
        if self.problem or not self.values:
            return self.problem or "nothing was measured"
        if not all(math.isfinite(value) and value > 0.0 for value in self.values):
            return f"a cost of {min(self.values)} {self.unit} is none"
        share = self.share_of_peak or 0.0
        return f"{share:.2f} of the core's peak: it cannot have done the work" if share > 1.0 and not self.about.get("equivalent") else ""


@dataclass(frozen=True)
class Record:
    """Figures with where, when and of what they were taken."""

    machine: Machine
    build: Build
    load: Load
    date: str
    figures: tuple[Figure, ...]
    part: bool = False  # only some of the figures were asked for, or in fewer repetitions
    marks: tuple[dict[str, Any], ...] = ()  # what the figures reach

    def figure(self, name: str) -> Figure | None:
        """A figure by its name."""
        return next((figure for figure in self.figures if figure.name == name), None)

    def broken(self) -> list[str]:
        """Names of what is no figure; experiments that do not come to their end in time are a finding and not broken."""
        return [figure.name for figure in self.figures if figure.wrong() and not (figure.problem and figure.name.startswith("experiments/"))]

    def why_not_kept(self) -> list[str]:
        """What speaks against keeping it: a busy machine, a part only, figures that are none."""
        broken = self.broken()
        return [*filter(None, [self.load.noisy, "only a part of the figures was taken" if self.part else "",
                               f"these are no figures: {', '.join(broken[:5])}" if broken else ""])]  # fmt: skip


# --- kept
def as_json(record: Record) -> str:
    """A record as one line; with each figure what is made of its repetitions, for other readers."""
    content = plain(record, DIGITS)
    for kept, figure in zip(content["figures"], record.figures):
        kept |= plain({name: getattr(figure, name) for name in ("median", "spread", "calibrated", "share_of_peak")}, DIGITS)
    return json.dumps({"format": FORMAT, **content}, allow_nan=False)


def records_in(path: Path) -> list[Record]:
    """All records of a file, the oldest first; none where there is no file. Raises ValueError."""
    known, found = {item.name for item in fields(Figure)}, []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines() if path.is_file() else [], 1):
        try:
            content = json.loads(line)
            if (version := content.pop("format")) != FORMAT:
                raise ValueError(f"format {version}, not {FORMAT}")
            content["figures"] = [{key: value for key, value in figure.items() if key in known} for figure in content["figures"]]
            found.append(built(Record, content))
        except (ValueError, KeyError, TypeError) as error:
            raise ValueError(f"{path}:{number}: {type(error).__name__}: {error}") from error
    return found


def last_of(machine: Machine, folder: Path = RECORDS) -> Record | None:
    """The last record of a machine, if there is one."""
    return next((one for one in reversed(records_in(folder / f"{machine.key}.jsonl")) if one.machine == machine), None)


def append(record: Record, folder: Path = RECORDS) -> Path:
    """Add a record to its machine's file; returns the file."""
    path = folder / f"{record.machine.key}.jsonl"
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", encoding="utf-8") as stream:
        stream.write(as_json(record) + "\n")
    return path


# --- now and then
@dataclass(frozen=True)
class Line:
    """A figure now beside then: ratio of calibrated costs (above 1: slower), the verdict and why."""

    name: str
    ratio: float
    verdict: str
    why: str = ""


def compare_figure(now: Figure, then: Figure | None) -> Line:
    """The verdict on one figure."""
    wrong = now.wrong()
    if wrong:
        before = now.problem and then is not None and then.problem
        return Line(now.name, math.nan, UNJUDGED if before else BROKEN, f"as when it was recorded: {wrong}" if before else wrong)
    if then is None or then.wrong():
        return Line(now.name, math.nan, NEW, "nothing to compare with" if then is None else "it failed when it was recorded")
    ratio = now.calibrated / then.calibrated
    if not math.isfinite(ratio) or ratio <= 0.0:
        return Line(now.name, ratio, BROKEN, "it has no calibration beside it")
    few, apart = min(len(now.values), len(then.values)), now.distance / then.distance
    if few < ENOUGH:
        return Line(now.name, ratio, UNJUDGED, f"{few} repetitions are too few")
    if math.isfinite(apart) and not 1.0 / FARTHER < apart < FARTHER:
        why = f"processors are {1e9 * now.distance:.0f} ns apart and back, {1e9 * then.distance:.0f} when it was recorded"
        return Line(now.name, ratio, UNJUDGED, why)
    if ratio > BAND:
        return Line(now.name, ratio, SLOWER, f"{ratio:.2f} times the recorded cost, more than {BAND:g}")
    return Line(now.name, ratio, FASTER if ratio < 1.0 / BAND else SAME)


def compare(now: Record, then: Record) -> list[Line]:
    """A line a figure, of a whole record also for each kernel of then that was not measured now."""
    here = {figure.name for figure in now.figures}
    gone = [] if now.part else [one for one in then.figures if one.name not in here and one.per not in ("run", "point")]
    return [*(compare_figure(figure, then.figure(figure.name)) for figure in now.figures),
            *(Line(one.name, math.nan, GONE, "it was recorded before and was not measured now") for one in gone)]  # fmt: skip


# --- marks
_BLOCK = "bspline2/flip/fast/points4"  # of points that FLIP moves, with the wide kernels
SPEEDS = (  # what, figure, million particle-steps a second
    ("particle-steps of `updated`, 1 thread", f"step/updated/{_BLOCK}/cells80/threads1", 60.0),
    ("particle-steps of `updated`, 2 threads", f"step/updated/{_BLOCK}/cells80/threads2", 110.0),
    ("at 320 x 320 cells, 80 % of the mark, 1 thread", f"scaling/updated/{_BLOCK}/cells320/threads1", 48.0),
    ("at 320 x 320 cells, 80 % of the mark, 2 threads", f"scaling/updated/{_BLOCK}/cells320/threads2", 88.0),
    ("particle-steps of `total`, equivalent, 1 thread", f"step/total/{_BLOCK}/cells80/threads1", 300.0),
)
DROP = 0.8  # of the speed at 80 x 80 cells that is kept at 320 x 320, beyond the caches
GROWTH = (  # what, figures of several sizes, exponent of cost against points
    ("exponent of a step's cost, `updated`", rf"(step|scaling)/updated/{_BLOCK}/cells\d+/threads1", 1.05),
    ("exponent of a step's cost, `total`", rf"(step|scaling)/total/{_BLOCK}/cells\d+/threads1", 1.05),
    ("exponent of a run without inertia", "whole/quasistatic/.*", 1.5),
)
BATCHES = (("quasistatic/cell1m", 10.0), ("explicit/cell1m", 120.0), ("quasistatic/cell0.25m", 300.0))  # s


def exponent(sizes: Sequence[float], costs: Sequence[float]) -> float:
    """The slope of log cost against log size by least squares; NaN of fewer than two sizes or where a cost is none."""
    if len(set(sizes)) < 2 or not all(math.isfinite(cost) and cost > 0.0 for cost in costs):
        return math.nan
    return statistics.linear_regression(list(map(math.log, sizes)), list(map(math.log, costs))).slope


def costs(figures: Iterable[Figure], pattern: str) -> list[tuple[float, float]]:
    """Points and seconds a whole step or run of the figures whose names match, in order of size."""
    found = {float(one.about["particles"]): one.median * (float(one.about["particles"]) if one.per == STEP else 1.0)
             for one in figures if one.values and re.fullmatch(pattern, one.name)}  # fmt: skip
    return sorted(found.items())


def rate(figure: Figure | None) -> float:
    """Millions of particle-steps a second."""
    return 1e-6 / figure.median if figure is not None and figure.values and figure.median > 0.0 else math.nan


def mark(what: str, wanted: float, found: float, unit: str = "", at_least: bool = False, note: str = "") -> dict[str, Any]:
    """Something that is to be reached on two cores, and whether it is: never where nothing was found."""
    good = math.isfinite(found) and found > 0.0 and (found >= wanted if at_least else found <= wanted)
    return {"what": what, "wanted": wanted, "found": found, "unit": unit, "at_least": at_least, "note": note, "reached": good}


def marks(record: Record) -> tuple[dict[str, Any], ...]:
    """All marks of which the record has what they are about."""
    found = []
    for what, name, wanted in SPEEDS:
        if (figure := record.figure(name)) is not None:
            apart = f"processors {1e9 * figure.distance:.0f} ns apart and back" if math.isfinite(figure.distance) else ""
            found.append(mark(what, wanted, rate(figure), "million/s", True, apart))
    drop = rate(record.figure(SPEEDS[2][1])) / rate(record.figure(SPEEDS[0][1]))
    if math.isfinite(drop):
        found.append(mark("at 320 x 320 cells, of what is found at 80 x 80", DROP, drop, "", True))
    for what, pattern, wanted in GROWTH:
        if len(sizes := costs(record.figures, pattern)) > 2:
            found.append(mark(what, wanted, exponent(*zip(*sizes)), note=f"{sizes[0][0]:.3g} to {sizes[-1][0]:.3g} points"))
    for name, limit_s in BATCHES:
        if (figure := record.figure(f"experiments/{name}")) is not None:
            found.append(mark(f"all experiments, {name}", limit_s, figure.median, "s", note=figure.problem))
    return tuple(found)
