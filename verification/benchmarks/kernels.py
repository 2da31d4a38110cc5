"""Runs strata_bench and reads what it says: a figure a benchmark."""

import json
import os
import re
import subprocess
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from verification.benchmarks.figure import CORE, MEMORY, Figure
from verification.harness.paths import ROOT

# Beyond this working set a step waits for memory rather than for the core (twice a last cache of 32 MB).
LARGE_B = 64e6

# What a unit of work is, by the first part of a benchmark's name.
PER = {
    "step": "particle-step", "scaling": "particle-step", "stage": "particle-step", "growth": "increment", "start": "start",
    "contact": "solve", "flow": "flow step", "write": "writing", "calibration": "measurement",
}  # fmt: skip

# Stages that do not pass over all particles: their unit is a call.
CALLS = ("stage/momentum", "stage/surfaces", "stage/measure_tips")

SCALE = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}


class NoBenchmark(Exception):
    """strata_bench could not be run, or said nothing that can be read; the message is its own."""


def bench_program() -> str:
    """The program with the kernels: $STRATA_BENCH, or that of the release build."""
    return os.environ.get("STRATA_BENCH", str(ROOT / "build" / "release" / "strata_bench"))


def _plain(name: str) -> str:
    """A benchmark's name without what Google Benchmark hangs on it (iterations:5, manual_time)."""
    return "/".join(part for part in name.split("/") if not part.startswith(("iterations:", "repeats:")) and part != "manual_time")


def names() -> list[str]:
    """All benchmarks there are, as strata_bench lists them."""
    try:
        done = subprocess.run([bench_program(), "--benchmark_list_tests=true"], capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        raise NoBenchmark(f"{bench_program()}: {error}") from error
    return [_plain(line) for line in done.stdout.splitlines() if line.strip()]


def measure(chosen: Iterable[str], repetitions: int, tell: Callable[[str], None]) -> tuple[list[Figure], dict[str, Any]]:
    """Run benchmarks by their names so many times each; the figures, and the context that strata_bench gives (compiler, flags)."""
    pattern = "^(" + "|".join(re.escape(name) for name in chosen) + ")(/iterations:[0-9]+)?(/manual_time)?$"
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "figures.json"
        status = _follow([bench_program(), f"--benchmark_filter={pattern}", f"--benchmark_repetitions={repetitions}",
                          "--benchmark_display_aggregates_only=true", f"--benchmark_out={out}", "--benchmark_out_format=json"], tell)  # fmt: skip
        try:
            content = json.loads(out.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise NoBenchmark(f"{bench_program()}: exit {status}, {error}") from error
    return parse(content), content.get("context", {})


def _follow(command: list[str], tell: Callable[[str], None]) -> int:
    """Run a command, tell the name of each benchmark once as its lines come; its exit status."""
    environment = {**os.environ, "OMP_PROC_BIND": "true", "OMP_PLACES": "cores"}
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=environment) as process:
        last = ""
        for line in process.stdout or ():
            name = _plain(re.sub("_(mean|median|stddev|cv)$", "", line.split(" ")[0]))
            if "/" in name and name != last:
                tell(last := name)
        return process.wait()


def parse(content: dict[str, Any]) -> list[Figure]:
    """The figures in what Google Benchmark wrote as JSON: repetitions of a name together, means and medians of its own left out."""
    runs: dict[str, list[dict[str, Any]]] = {}
    for entry in content.get("benchmarks", []):
        if entry.get("run_type", "iteration") == "iteration":
            runs.setdefault(_plain(entry["name"]), []).append(entry)
    return [figure_of(name, entries) for name, entries in runs.items()]


def figure_of(name: str, entries: list[dict[str, Any]]) -> Figure:
    """One figure from its repetitions: seconds a unit of work."""
    failed = [str(entry.get("error_message", "an error")) for entry in entries if entry.get("error_occurred")]
    a_call, one = name.startswith(CALLS), entries[0]
    per = "call" if a_call else PER.get(name.split("/")[0], "unit")
    if failed:
        return Figure(name, per, (), problem=failed[0])
    about: dict[str, Any] = dict(pair.partition("=")[::2] for pair in one.get("label", "").split())
    about |= {key: float(one[key]) for key in ("flop_a_unit", "byte_a_unit", "particles", "places") if one.get(key)}
    if about.get("kinematics") == "total":
        about["equivalent"] = "flop of the form with particles, which this one need not do"
    large = about.get("particles", 0.0) * about.get("byte_a_unit", 0.0) > LARGE_B
    seconds = tuple(float(e["real_time"]) * SCALE[e.get("time_unit", "ns")] / (1.0 if a_call else float(e["units"])) for e in entries)
    peak, stream, trip = (tuple(float(e[key]) for e in entries) for key in ("peak_flop_s", "stream_B_s", "round_trip_s"))
    threads = int(one["threads_used"])
    return Figure(name, per, seconds, threads=threads, bound=MEMORY if large else CORE, peak_flop_s=peak, stream_B_s=stream,
                  round_trip_s=trip if threads > 1 else (), about=about)  # fmt: skip


def rates(threads: int = 1) -> tuple[float, float]:
    """The machine's rates on so many threads now: flop/s and B/s."""
    found, _ = measure([f"calibration/threads{threads}"], 1, lambda name: None)
    if not found or found[0].wrong():
        raise NoBenchmark("strata_bench has no calibration")
    return found[0].peak_flop_s[0], found[0].stream_B_s[0]
