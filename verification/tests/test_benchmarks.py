"""Benchmarks: what is read, stored and judged; a figure that is zero, doubled or of another machine is caught."""

import math
import os
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from verification.benchmarks import machine, measure
from verification.benchmarks.__main__ import NOT_RECORDED, OK, WORSE, WRONG_USE, main, report, told
from verification.benchmarks.machine import (
    BROKEN, FASTER, GONE, NEW, SAME, SLOWER, UNJUDGED, Build, Figure, Load, Machine, Record, append, as_json, compare, compare_figure, costs,
    exponent, mark, marks, records_in,
)  # fmt: skip
from verification.harness.paths import ANALYTIC
from verification.harness.run import Job

HERE = Machine("Some CPU 25 17 1", 2, "L1 32K L2 1024K L3 32768K")
QUIET = Load(0.1, 0.02, 0.02)
BLOCK = "step/updated/bspline2/flip/fast/points4/cells80"
CRACK = ANALYTIC / "static_quasistatic.toml"


def a_figure(name: str = f"{BLOCK}/threads1", seconds: float = 1e-8, **more: Any) -> Figure:
    """A cost of so many seconds in five repetitions that differ by a few per cent."""
    values = tuple(float(f"{seconds * factor:.5g}") for factor in (1.0, 1.02, 0.99, 1.01, 1.0))
    made = Figure(name, "particle-step", values, peak_flop_s=(50e9,) * 5, stream_B_s=(40e9,) * 5, about={"flop_a_unit": 340.0, "particles": 25600.0})
    return replace(made, **more)


def times(figure: Figure, factor: float, **more: Any) -> Figure:
    """A figure with its cost changed by a factor."""
    return replace(figure, values=tuple(factor * value for value in figure.values), **more)


def a_record(*figures: Figure, **more: Any) -> Record:
    """A whole record of this machine."""
    return replace(Record(HERE, Build("0.3.0", "abc", "GNU 12.2", "-O3"), QUIET, "2026-01-02T03:04:05+00:00", figures), **more)


def an_entry(name: str, real_time: float, **more: Any) -> dict[str, Any]:
    """A repetition as Google Benchmark writes it."""
    return {
        "name": name, "run_type": "iteration", "real_time": real_time, "time_unit": "ms", "units": 100.0, "threads_used": 2.0,
        "peak_flop_s": 5e10, "stream_B_s": 4e10, "round_trip_s": 6e-8, "flop_a_unit": 340.0, "byte_a_unit": 200.0, "particles": 100.0,
        "label": "kinematics=updated shape=bspline2", **more,
    }  # fmt: skip


# --- figures
def test_a_cost_is_taken_relative_to_the_rate_beside_each_repetition() -> None:
    """A machine that is half as fast in some repetitions changes the cost and not the calibrated cost."""
    even = a_figure(peak_flop_s=(50e9,) * 5)
    uneven = replace(even, values=tuple(v * f for v, f in zip(even.values, (1, 2, 2, 2, 1))), peak_flop_s=tuple(50e9 / f for f in (1, 2, 2, 2, 1)))
    assert uneven.median > 1.9 * even.median
    assert uneven.calibrated == pytest.approx(even.calibrated, rel=1e-12) == pytest.approx(500.0, rel=0.01)
    assert replace(even, bound="memory").calibrated == pytest.approx(400.0, rel=0.01)
    assert even.share_of_peak == pytest.approx(340.0 / 500.0, rel=0.01)
    assert even.spread == pytest.approx(0.03, rel=0.01)


@pytest.mark.parametrize(
    "values, said", [((), "nothing"), ((0.0,) * 5, "is none"), ((1e-8, -1e-8), "is none"), ((math.nan,), "is none"), ((1e-9,) * 5, "peak")]
)
def test_what_cannot_be_a_cost_is_refused(values: tuple[float, ...], said: str) -> None:
    """None, zero, negative, NaN, and more flop than the core has."""
    figure = replace(a_figure(), values=values, peak_flop_s=(50e9,) * len(values))
    assert said in figure.wrong()
    assert a_figure().wrong() == ""
    assert replace(figure, about={"equivalent": "yes", "flop_a_unit": 340.0}).wrong() == ("" if said == "peak" else figure.wrong())


def test_exponents() -> None:
    """Slopes of exact power laws; none from one size, or from a cost of zero."""
    assert exponent([1e4, 1e5, 4e6], [3 * n**1.5 for n in (1e4, 1e5, 4e6)]) == pytest.approx(1.5, abs=1e-12)
    assert math.isnan(exponent([1e4], [1.0])) and math.isnan(exponent([1e4, 1e5], [0.0, 1.0]))


# --- what strata_bench says
def test_repetitions_of_google_benchmark_become_one_figure() -> None:
    """Seconds a unit in the unit of time that is said; means and medians of its own are left out; large blocks wait for memory."""
    name = "step/updated/x/iterations:5"
    content = {"benchmarks": [an_entry(name, t) for t in (2.0, 3.0, 4.0)] + [{**an_entry(name, 9.0), "run_type": "aggregate"}]}
    content["benchmarks"] += [an_entry("scaling/x/iterations:5/manual_time", 1.0, particles=1e6, time_unit="us")]
    small, large = measure.parse(content)
    assert small.name == "step/updated/x" and small.values == pytest.approx((2e-5, 3e-5, 4e-5)) and small.bound == "core"
    assert small.per == "particle-step" and small.threads == 2 and small.peak_flop_s == (5e10,) * 3
    assert small.round_trip_s == (6e-8,) * 3 and small.distance == pytest.approx(6e-8)
    assert small.about["kinematics"] == "updated" and small.about["flop_a_unit"] == 340.0
    assert large.name == "scaling/x" and large.bound == "memory" and large.values == pytest.approx((1e-8,))
    alone = measure.figure_of("step/x", [an_entry("step/x", 1.0, threads_used=1.0, round_trip_s=0.0)])
    assert alone.round_trip_s == () and math.isnan(alone.distance)
    call = measure.figure_of("stage/surfaces/threads1", [an_entry("stage/surfaces/threads1", 1.0)])
    assert call.per == "call" and call.values == (1e-3,)
    failed = measure.figure_of("step/a", [an_entry("step/a", 1.0), an_entry("step/a", 0.0, error_occurred=True, error_message="no such key")])
    assert failed.values == () and failed.wrong() == "no such key"


# --- now and then
TWO = {"threads": 2, "round_trip_s": (6e-8,) * 5}


@pytest.mark.parametrize(("factor", "now", "then", "verdict"), [
    *((factor, {}, {}, verdict) for factor, verdict in ((1.0, SAME), (1.2, SAME), (1.3, SLOWER), (2.0, SLOWER), (0.9, SAME), (0.5, FASTER), (0.0, BROKEN), (-1.0, BROKEN))),
    # Of a machine at half the rate, at the same, at a quarter.
    *((2.0, {"peak_flop_s": (rate,) * 5}, {}, verdict) for rate, verdict in ((25e9, SAME), (50e9, SLOWER), (12e9, FASTER))),
    # Two threads count where their processors are as far apart as then, or where that is not known; how far does not tell of one thread.
    *((2.0, {"round_trip_s": (trip,) * 5}, TWO, verdict) for trip, verdict in ((6e-8, SLOWER), (1e-7, SLOWER), (3.3e-7, UNJUDGED), (2e-8, UNJUDGED))),
    (2.0, {"round_trip_s": ()}, TWO, SLOWER), *((2.0, {"round_trip_s": (trip,) * 5}, TWO | {"threads": 1}, SLOWER) for trip in (3.3e-7, 2e-8)),
])  # fmt: skip
def test_the_verdict_follows_the_calibrated_ratio(factor: float, now: dict[str, Any], then: dict[str, Any], verdict: str) -> None:
    """A figure mutated by a factor, against itself as it was."""
    before = a_figure(seconds=4e-8, **then)
    line = compare_figure(times(before, factor, **now), before)
    assert line.verdict == verdict
    assert verdict == BROKEN or "peak_flop_s" in now or line.ratio == pytest.approx(factor)


def test_few_repetitions_missing_figures_and_failures_are_told_apart() -> None:
    """Too few are not judged; what has gone or broken is; what is new or failed before is not."""
    figure, few = a_figure(), replace(a_figure(seconds=9e-8), values=(9e-8,), peak_flop_s=(50e9,), stream_B_s=(40e9,))
    failed = replace(figure, values=(), problem="timed out")
    assert compare_figure(few, figure).verdict == UNJUDGED
    assert compare_figure(failed, figure).verdict == BROKEN
    assert compare_figure(failed, failed).verdict == UNJUDGED
    assert compare_figure(figure, None).verdict == NEW and compare_figure(figure, failed).verdict == NEW
    assert compare_figure(replace(figure, peak_flop_s=()), figure).verdict == BROKEN
    whole, part = a_record(figure), a_record(part=True)
    assert [line.verdict for line in compare(a_record(), whole)] == [GONE] and compare(part, whole) == []


# --- records
def test_records_come_back_as_they_were(tmp_path: Path) -> None:
    """Written, read, and written after it another; the last of the machine counts, whatever file another's is in."""
    first = a_record(a_figure(), Figure("experiments/a", "run", (), problem="timed out"))
    second = replace(first, date="2026-02-02T03:04:05+00:00")
    assert machine.last_of(HERE, tmp_path) is None
    path = [append(one, tmp_path) for one in (first, second)][0]
    assert machine.last_of(HERE, tmp_path) == second and records_in(path) == [first, second]
    for other in (replace(HERE, cpu="Other"), replace(HERE, cores=4), replace(HERE, caches="L1 32K")):
        assert machine.last_of(other, tmp_path) is None and other.key != HERE.key
        append(replace(first, machine=other), tmp_path).rename(path)
        assert machine.last_of(HERE, tmp_path) is None
    for text, said in (('{"format": 1, "machine"', "jsonl:1"), (as_json(first).replace('"format": 1', '"format": 99'), "format 99")):
        path.write_text(text, encoding="utf-8")
        with pytest.raises(ValueError, match=said):
            records_in(path)


def test_kept_records_can_be_read() -> None:
    """Those that come with the project, whichever version wrote them."""
    kept = [one for path in machine.RECORDS.glob("*.jsonl") for one in records_in(path)]
    assert kept and all(costs(one.figures, machine.GROWTH[0][1]) and one.marks for one in kept)


@pytest.mark.parametrize("figure, more, said", [
    (Figure("experiments/b", "run", (), problem="ended"), {}, ""),  # is a finding
    (Figure("step/b", "run", (), problem="no such key"), {}, "no figures: step/b"),
    (replace(a_figure("experiments/c"), values=(0.0,)), {}, "experiments/c"),
    (a_figure(), {"part": True}, "part"), (a_figure(), {"load": Load(2.0, 0.0)}, "load average"),
    (a_figure(), {"load": Load(0.0, 0.9)}, "other programs"), (a_figure(), {"load": Load(0.0, 0.0, 0.9)}, "other programs"),
])  # fmt: skip
def test_a_busy_machine_a_part_and_broken_figures_are_not_recorded(figure: Figure, more: dict[str, Any], said: str) -> None:
    """Each is a reason."""
    reasons = a_record(figure, **more).why_not_kept()
    assert len(reasons) == bool(said) and said in "".join(reasons)


def test_the_machine_is_described(tmp_path: Path) -> None:
    """From the texts of the system; how busy it is, from two looks at the clock of its processors."""
    info = tmp_path / "info"
    info.write_text("processor\t: 0\ncpu family\t: 25\nmodel\t\t: 17\nmodel name\t: AMD EPYC\nstepping\t: 1\n\nprocessor : 1\nmodel name : no\n")
    assert machine.this_machine(info).cpu == "AMD EPYC 25 17 1"
    assert HERE.key == "some_cpu_25_17_1_2_cores_l1_32k_l2_1024k_l3_32768k"
    assert machine.this_machine().cores == os.cpu_count() and machine.this_build({}).version
    assert -0.2 <= machine.busy_processors(0.05) <= 1.05 * (os.cpu_count() or 1)
    here = machine.described()
    assert machine.made_here(here, here) and not machine.made_here({**here, "caches": "L1 1K"}, here) and not machine.made_here({}, here)


# --- marks and words
def a_full_record(seconds: float) -> Record:
    """Figures on which all marks but those on experiments stand."""
    steps = [a_figure(f"{BLOCK}/threads{n}", seconds / n) for n in (1, 2)]
    steps += [a_figure(f"{BLOCK.replace('updated', 'total')}/threads1", seconds / 6.0)]
    for kinematics, points, cells in ((k, c * c * 4.0, c) for k in ("updated", "total") for c in (50, 320, 1000)):
        name = f"scaling/{kinematics}/bspline2/flip/fast/points4/cells{cells}/threads1"
        steps.append(a_figure(name, seconds * (1.0 if kinematics == "updated" else 1 / 6.0), about={"particles": points}))
    steps += [a_figure("scaling/updated/bspline2/flip/fast/points4/cells320/threads2", seconds / 2.0)]
    steps += [a_figure(f"whole/quasistatic/{n:g}", 1e-6 * n**1.4, per="run", about={"particles": n}) for n in (1e4, 1e5, 1e6)]
    return a_record(*steps)


def test_marks_are_reached_or_not() -> None:
    """At 70 million particle-steps a second all are, at half of it those on speed are not, and nothing found reaches none."""
    good = marks(a_full_record(1.0 / 70e6))
    assert len(good) == 9 and all(one["reached"] for one in good), good
    assert sum(not one["reached"] for one in marks(a_full_record(1.0 / 35e6))) == 5
    for value in (0.0, math.nan, -1.0):
        assert not mark("a", 10.0, value)["reached"] and not mark("a", 10.0, value, at_least=True)["reached"]
    sizes = costs(a_full_record(1e-8).figures, machine.GROWTH[0][1])
    assert [points for points, _ in sizes] == [1e4, 25600.0, 409600.0, 4e6] and sizes[-1][1] == pytest.approx(0.04)
    failed = a_record(Figure("experiments/quasistatic/cell1m", "all variants", (), problem="2 of 23 runs"))
    assert [one["reached"] for one in marks(failed)] == [False]


def test_the_table_says_all() -> None:
    """Rates of particle-steps, shares, ratios, verdicts; what got slower again below."""
    then, slow = a_record(a_figure(seconds=2e-8)), a_figure(seconds=5e-8)
    now = a_record(slow, Figure("experiments/a", "run", (), problem="timed out"))
    words = "\n".join(report(replace(now, marks=marks(now)), compare(now, then), then))
    for part in ("20.0 M/s", "2.50", "slower", "SLOWER: step/updated", "timed out", "14 %", "FALLS SHORT", "50.0 GFlop/s"):
        assert part in words, part
    assert "nothing recorded" in "\n".join(report(now, [], None))
    assert told(0.0123, "s") == "12.3 ms" and told(2e-6, "s") == "2 us" and told(311.0, "B") == "311 B" and told(math.nan, "s") == "-"


# --- whole runs
def test_batches_are_all_default_variants() -> None:
    """23 runs, each a variant that its scene has; below the scenes' cells weak interfaces are fine along all their length."""
    jobs = measure.batch("quasistatic", 1.0, 1, 10.0).jobs
    assert len(jobs) == len(set(jobs)) == 23
    assert all(f"[variants.{job.variant}]" in job.scene.read_text(encoding="utf-8") for job in jobs)
    assert not any("fine_" in key for job in jobs for key in job.settings)
    small = measure.batch("quasistatic", 0.25, 1, 10.0).jobs
    wide = sorted((job.scene.stem[:4], job.variant) for job in small if "numerics.fine_right_m=80" in job.settings)
    assert wide == [("exp1", "weak"), ("exp2", "weak"), ("exp3", "soft_weak"), ("exp3", "weak_soft"), ("exp4", "weak")]
    assert len(small) == 23 and small[0].scene.stem in measure.TURNING


def test_runs_are_timed_and_those_that_fail_or_take_too_long_are_told() -> None:
    """The equilibrium of the block: seconds, points. Out of time: not begun, or ended; bad input: its words, and no time for its batch."""
    good, bad = (Job(CRACK, "", Path(), (key,)) for key in ("numerics.cell_m=4", "no.such=1"))
    for repetitions in (1, 3):
        alone = measure.whole_figure(measure.Whole("whole/a", (good,), repetitions), lambda threads: (5e10, 4e10))
        assert alone.wrong() == "" and len(alone.values) == repetitions and alone.about["particles"] == 1600 and alone.per == "run"
    both = measure.whole_figure(measure.Whole("experiments/a", (good, bad), 3), lambda threads: (5e10, 4e10))
    assert both.values == () and both.problem.startswith("1 of 2 runs") and "no.such" in both.problem
    long = Job(CRACK, "", Path(), ("numerics.cell_m=0.25",))
    assert "not begun" in measure.taken(long, time.monotonic())[0] and "not done after" in measure.taken(long, time.monotonic() + 0.1)[0]


# --- the whole of it, at its quickest
def test_the_quickest_benchmark_runs_and_is_judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """One kernel through the command line: measured, kept, compared with itself; a record mutated to half its cost is a failure."""
    monkeypatch.setattr(machine, "append", lambda one: append(one, tmp_path))
    monkeypatch.setattr(machine, "last_of", lambda there, own=machine.last_of: own(there, tmp_path))
    monkeypatch.setattr("verification.benchmarks.__main__.busy_processors", lambda: 0.0)
    out = tmp_path / "last.json"
    options = ["--kernels", "--only", "^stage/surfaces", "--load", "0", "--out", str(out)]
    assert main([*options, "--record"]) == NOT_RECORDED, "a part is none"
    assert main([*options, "--record", "--force"]) == OK
    first = records_in(tmp_path / f"{machine.this_machine().key}.jsonl")[0]
    assert len(first.figures) == 1 and first.figures[0].wrong() == "" and len(first.figures[0].values) == 5
    assert records_in(out)[0].figures[0].calibrated > 0.0
    for factor, status in ((1e3, OK), (1e-3, WORSE)):
        append(replace(first, figures=(times(first.figures[0], factor),)), tmp_path)
        assert main(options) == status
    assert "SLOWER: stage/surfaces" in capsys.readouterr().out
    assert main(["--only", "no such", "--kernels"]) == WRONG_USE
