"""Benchmarks: what is read, stored and judged; a figure that is zero, doubled or of another machine is caught."""

import math
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from verification.benchmarks import kernels, machine, runs
from verification.benchmarks.__main__ import NOT_RECORDED, OK, WORSE, WRONG_USE, main
from verification.benchmarks.figure import CORE, MEMORY, NONE, Figure, exponent
from verification.benchmarks.judge import BROKEN, FASTER, GONE, NEW, SAME, SLOWER, UNJUDGED, Mark, best_crack, compare, compare_figure, marks, sizes
from verification.benchmarks.machine import Build, Load, Machine
from verification.benchmarks.records import (
    BadRecord, OtherMachine, Record, append, as_json, file_of, from_json, last_record, load_records, why_not_recorded,
)  # fmt: skip
from verification.benchmarks.runs import job_of, take, take_all
from verification.benchmarks.table import cost, report, told

HERE = Machine("Some CPU 25 17 1", 2, "L1 32K L2 1024K L3 32768K")
QUIET = Load(0.1, 0.02, 0.02)
BLOCK = "step/updated/bspline2/flip/fast/points4/cells80"


def a_figure(name: str = f"{BLOCK}/threads1", seconds: float = 1e-8, **more: Any) -> Figure:
    """A cost of so many seconds in five repetitions that differ by a few per cent."""
    values = tuple(float(f"{seconds * factor:.5g}") for factor in (1.0, 1.02, 0.99, 1.01, 1.0))
    made = Figure(name, "particle-step", values, peak_flop_s=(50e9,) * 5, stream_B_s=(40e9,) * 5, about={"flop_a_unit": 340.0, "particles": 25600.0})
    return replace(made, **more)


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


def test_a_cost_is_taken_relative_to_the_rate_beside_each_repetition() -> None:
    """A machine that is half as fast in some repetitions changes the cost and not the calibrated cost."""
    even = a_figure(peak_flop_s=(50e9,) * 5)
    uneven = replace(even, values=tuple(v * f for v, f in zip(even.values, (1, 2, 2, 2, 1))), peak_flop_s=tuple(50e9 / f for f in (1, 2, 2, 2, 1)))
    assert uneven.median > 1.9 * even.median
    assert uneven.calibrated == pytest.approx(even.calibrated, rel=1e-12) == pytest.approx(500.0, rel=0.01)
    assert replace(even, bound=MEMORY).calibrated == pytest.approx(400.0, rel=0.01)
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
    assert exponent([1e4, 1e5], [2e-3, 2e-2]) == pytest.approx(1.0, abs=1e-12)
    assert math.isnan(exponent([1e4], [1.0])) and math.isnan(exponent([1e4, 1e5], [0.0, 1.0]))


def test_repetitions_of_google_benchmark_become_one_figure() -> None:
    """Seconds a unit in the unit of time that is said; means and medians of its own are left out; large blocks wait for memory."""
    name = "step/updated/x/iterations:5"
    content = {"benchmarks": [an_entry(name, t) for t in (2.0, 3.0, 4.0)] + [{**an_entry(name, 9.0), "run_type": "aggregate"}]}
    content["benchmarks"] += [an_entry("scaling/x/iterations:5/manual_time", 1.0, particles=1e6, time_unit="us")]
    small, large = kernels.parse(content)
    assert small.name == "step/updated/x" and small.values == pytest.approx((2e-5, 3e-5, 4e-5)) and small.bound == CORE
    assert small.per == "particle-step" and small.threads == 2 and small.peak_flop_s == (5e10,) * 3
    assert small.round_trip_s == (6e-8,) * 3 and small.distance == pytest.approx(6e-8)
    alone = kernels.figure_of("step/x", [an_entry("step/x", 1.0, threads_used=1.0, round_trip_s=0.0)])
    assert alone.round_trip_s == () and math.isnan(alone.distance)
    assert small.about["kinematics"] == "updated" and small.about["flop_a_unit"] == 340.0
    call = kernels.figure_of("stage/surfaces/threads1", [an_entry("stage/surfaces/threads1", 1.0)])
    assert call.per == "call" and call.values == (1e-3,)
    assert large.name == "scaling/x" and large.bound == MEMORY and large.values == pytest.approx((1e-8,))


def test_a_benchmark_that_failed_is_a_failure() -> None:
    """Its message is told and it has no values, even where other repetitions have."""
    entries = [an_entry("step/a", 1.0), an_entry("step/a", 0.0, error_occurred=True, error_message="no such key")]
    figure = kernels.parse({"benchmarks": entries})[0]
    assert figure.values == () and figure.wrong() == "no such key"


@pytest.mark.parametrize(
    "factor, verdict", [(1.0, SAME), (1.2, SAME), (1.3, SLOWER), (2.0, SLOWER), (0.9, SAME), (0.5, FASTER), (0.0, BROKEN), (-1.0, BROKEN)]
)
def test_the_verdict_follows_the_calibrated_ratio(factor: float, verdict: str) -> None:
    """A figure mutated by a factor, against itself as it was."""
    then = a_figure(seconds=4e-8)
    now = replace(then, values=tuple(factor * value for value in then.values))
    line = compare_figure(now, then)
    assert line.verdict == verdict
    if verdict != BROKEN:
        assert line.ratio == pytest.approx(factor)


def test_a_machine_at_half_speed_makes_nothing_slower() -> None:
    """Twice the time at half the rate is the same; at the same rate it is slower, at a quarter faster."""
    then = a_figure(seconds=4e-8)
    twice = replace(then, values=tuple(2.0 * value for value in then.values))
    for rate, verdict in ((25e9, SAME), (50e9, SLOWER), (12e9, FASTER)):
        assert compare_figure(replace(twice, peak_flop_s=(rate,) * 5), then).verdict == verdict


@pytest.mark.parametrize("trip, verdict", [(6e-8, SLOWER), (1e-7, SLOWER), (3.3e-7, UNJUDGED), (2e-8, UNJUDGED), (None, SLOWER)])
def test_threads_far_apart_are_not_judged_by_threads_close_by(trip: float | None, verdict: str) -> None:
    """Twice the cost on two threads counts where their processors are as far apart as then, or where that is not known."""
    then = a_figure(seconds=4e-8, threads=2, round_trip_s=(6e-8,) * 5)
    twice = replace(then, values=tuple(2.0 * value for value in then.values), round_trip_s=(trip,) * 5 if trip else ())
    assert compare_figure(twice, then).verdict == verdict
    assert compare_figure(replace(twice, threads=1), replace(then, threads=1)).verdict == SLOWER


def test_few_repetitions_missing_figures_and_failures_are_told_apart() -> None:
    """Too few are not judged; what has gone or broken is; what is new or failed before is not."""
    figure, few = a_figure(), replace(a_figure(seconds=9e-8), values=(9e-8,), peak_flop_s=(50e9,), stream_B_s=(40e9,))
    failed = replace(figure, values=(), problem="timed out")
    assert compare_figure(few, figure).verdict == UNJUDGED
    assert compare_figure(None, figure).verdict == GONE
    assert compare_figure(failed, figure).verdict == BROKEN
    assert compare_figure(failed, failed).verdict == UNJUDGED
    assert compare_figure(figure, None).verdict == NEW and compare_figure(figure, failed).verdict == NEW
    assert compare_figure(replace(figure, peak_flop_s=()), figure).verdict == BROKEN
    memory = Figure("memory/a", "point", (300.0,), unit="B", bound=NONE)
    assert compare_figure(replace(memory, values=(600.0,)), memory).verdict == SLOWER
    whole, part = a_record(figure), a_record(part=True)
    assert [line.verdict for line in compare(a_record(), whole)] == [GONE] and compare(part, whole) == []


def test_another_machine_is_not_compared(tmp_path: Path) -> None:
    """Any difference of the machine counts, also where a file was given the name of this one."""
    for other in (replace(HERE, cpu="Other"), replace(HERE, cores=4), replace(HERE, caches="L1 32K")):
        with pytest.raises(OtherMachine, match="this machine is"):
            compare(a_record(a_figure()), a_record(a_figure(), machine=other))
        assert file_of(other, tmp_path) != file_of(HERE, tmp_path)
        append(a_record(a_figure(), machine=other), tmp_path).rename(file_of(HERE, tmp_path))
        with pytest.raises(OtherMachine):
            last_record(HERE, tmp_path)


def test_a_record_comes_back_as_it_was(tmp_path: Path) -> None:
    """Written, read, and written after it another; the last counts. Failures keep their reason."""
    first = a_record(a_figure(), Figure("experiments/a", "run", (), problem="timed out"))
    second = replace(first, date="2026-02-02T03:04:05+00:00")
    assert last_record(HERE, tmp_path) is None
    for record in (first, second):
        append(record, tmp_path)
    assert last_record(HERE, tmp_path) == second and load_records(file_of(HERE, tmp_path)) == [first, second]
    file_of(HERE, tmp_path).write_text('{"format": 1, "machine"', encoding="utf-8")
    with pytest.raises(BadRecord, match="jsonl:1"):
        load_records(file_of(HERE, tmp_path))
    with pytest.raises(BadRecord, match="format 99"):
        from_json(as_json(first).replace('"format": 1', '"format": 99'))


def test_a_busy_machine_a_part_and_broken_figures_are_not_recorded() -> None:
    """Each is a reason; a run that was ended in time is none, it is a finding."""
    assert why_not_recorded(a_record(a_figure(), Figure("experiments/b", "run", (), problem="ended"))) == []
    assert "no figures: step/b" in why_not_recorded(a_record(a_figure(), Figure("step/b", "run", (), problem="no such key")))[0]
    assert "experiments/c" in why_not_recorded(a_record(replace(a_figure("experiments/c"), values=(0.0,))))[0]
    for load in (Load(2.0, 0.0), Load(0.0, 0.9), Load(0.0, 0.0, 0.9)):
        assert len(why_not_recorded(a_record(a_figure(), load=load))) == 1
    assert "part" in why_not_recorded(a_record(part=True))[0]
    assert "no figures" in why_not_recorded(a_record(replace(a_figure(), values=(0.0,))))[0]


def test_the_machine_is_described() -> None:
    """From the texts of the system; how busy it is, from two looks at the clock of its processors."""
    text = "processor\t: 0\ncpu family\t: 25\nmodel\t\t: 17\nmodel name\t: AMD EPYC\nstepping\t: 1\n\nprocessor : 1\nmodel name : no\n"
    assert machine.parse_cpu(text) == "AMD EPYC 25 17 1"
    assert HERE.key == "some_cpu_25_17_1_2_cores_l1_32k_l2_1024k_l3_32768k"
    assert machine.this_machine().cores == os.cpu_count() and machine.this_build().version
    assert -0.2 <= machine.busy_processors(0.05) <= 1.05 * (os.cpu_count() or 1)
    here = machine.described()
    assert machine.made_here(here, here) and not machine.made_here({**here, "caches": "L1 1K"}, here) and not machine.made_here({}, here)
    assert machine._idle_and_total("cpu  10 1 5 100 20 0 3 1 0 0\ncpu0 1 2") == (120, 140)


def a_full_record(seconds: float) -> Record:
    """Figures on which all marks but those on experiments stand."""
    steps = [a_figure(f"{BLOCK}/threads{n}", seconds / n) for n in (1, 2)]
    steps += [a_figure(f"{BLOCK.replace('updated', 'total')}/threads1", seconds / 6.0)]
    for kinematics, points, cells in ((k, c * c * 4.0, c) for k in ("updated", "total") for c in (50, 320, 1000)):
        name = f"scaling/{kinematics}/bspline2/flip/fast/points4/cells{cells}/threads1"
        steps.append(a_figure(name, seconds * (1.0 if kinematics == "updated" else 1 / 6.0), about={"particles": points}))
    steps += [a_figure("scaling/updated/bspline2/flip/fast/points4/cells320/threads2", seconds / 2.0)]
    steps += [a_figure(f"whole/quasistatic/{n:g}", 1e-6 * n**1.4, about={"particles": n}) for n in (1e4, 1e5, 1e6)]
    steps += [a_figure("crack/graded/a", 0.09, about={"error": -9e-4}), a_figure("crack/graded/b", 0.01, about={"error": 2e-3})]
    return a_record(*steps)


def test_marks_are_reached_or_not() -> None:
    """At 70 million particle-steps a second all are, at half of it those on speed are not, and nothing found reaches none."""
    good = marks(a_full_record(1.0 / 70e6))
    assert len(good) == 10 and all(mark.reached for mark in good), [mark.what for mark in good if not mark.reached]
    assert sum(not mark.reached for mark in marks(a_full_record(1.0 / 35e6))) == 5
    found = best_crack(a_full_record(1e-8), 1e-3)
    assert found is not None and found.name == "crack/graded/a", "the faster one is not accurate enough"
    for value in (0.0, math.nan, -1.0):
        assert not Mark("a", 10.0, value, "s").reached and not Mark("a", 10.0, value, "s", True).reached
    assert [points for points, _ in sizes(a_full_record(1e-8), "updated")] == [1e4, 25600.0, 409600.0, 4e6]
    failed = a_record(Figure("experiments/quasistatic/cell1m", "all variants", (), problem="2 of 23 runs"))
    assert [mark.reached for mark in marks(failed)] == [False]


def test_the_table_says_all() -> None:
    """Rates of particle-steps, shares, ratios, verdicts; what got slower again below."""
    then, slow = a_record(a_figure(seconds=2e-8)), a_figure(seconds=5e-8)
    now = a_record(slow, Figure("experiments/a", "run", (), problem="timed out"))
    words = "\n".join(report(now, compare(now, then), then, marks(now)))
    for part in ("20.0 M/s", "2.50", "slower", "SLOWER: step/updated", "timed out", "14 %", "FALLS SHORT", "50.0 GFlop/s"):
        assert part in words, part
    assert "nothing recorded" in "\n".join(report(now, [], None, []))
    assert told(0.0123, "s") == "12.3 ms" and told(2e-6, "s") == "2 us" and told(311.0, "B") == "311 B" and told(math.nan, "s") == "-"
    assert cost(replace(slow, per="solve")) == "50 ns" and cost(replace(slow, values=())) == "-"


def test_memory_a_point_is_that_beyond_what_every_process_holds() -> None:
    """30 MB of the process itself do not count; two runs are needed."""
    assert runs.memory_figure("memory/a", [(1e5, 30e6 + 1e5 * 250), (4e5, 30e6 + 4e5 * 250)]).median == pytest.approx(250.0)
    assert runs.memory_figure("memory/a", [(1e5, 1e6)]).wrong() and runs.memory_figure("memory/a", [], "no room").wrong() == "no room"


def test_batches_are_all_default_variants() -> None:
    """23 runs, each a variant that its scene has."""
    settings = runs.jobs_of(runs.Batch("quasistatic", 1.0, 1, 10.0))
    assert len(settings) == len(set(settings)) == 23
    for setting in settings:
        assert f"[variants.{setting.variant}]" in setting.scene.read_text(encoding="utf-8")
    assert not any("fine_" in key for setting in settings for key in setting.settings)
    small = runs.jobs_of(runs.Batch("quasistatic", 0.25, 1, 10.0))
    wide = sorted((setting.scene.stem[:4], setting.variant) for setting in small if "numerics.fine_right_m=80" in setting.settings)
    assert wide == [("exp1", "weak"), ("exp2", "weak"), ("exp3", "soft_weak"), ("exp3", "weak_soft"), ("exp4", "weak")]
    assert len(small) == 23 and small[0].scene.stem in runs.TURNING


def test_a_run_is_timed_and_one_that_takes_too_long_is_ended(tmp_path: Path) -> None:
    """The equilibrium of the block: seconds, memory, summary. Out of time: not begun, or ended; bad input: its words."""
    good = take(job_of(runs.CRACK, "numerics.cell_m=4"))
    assert good.problem == "" and good.summary is not None and 0.0 < good.summary.wall_s < good.seconds
    assert good.summary.peak_memory_MB > 5.0
    assert "no.such" in take(job_of(runs.CRACK, "no.such=1")).problem
    long = job_of(runs.BLOCK, "numerics.cell_m=0.5", "stop.time_s=100")
    seconds, (ended, late) = take_all([long, long], 1, 0.3, lambda words: None)
    assert "ended" in ended.problem and "not begun" in late.problem and seconds < 30.0


def test_failed_batches_are_figures_without_values(monkeypatch: pytest.MonkeyPatch) -> None:
    """One run that fails leaves the batch without a time, with how many came to their end."""
    bad = job_of(runs.CRACK, "no.such=1")
    monkeypatch.setattr(runs, "jobs_of", lambda batch: [job_of(runs.CRACK, "numerics.cell_m=4"), bad])
    whole, first, second = runs.batch_figures(runs.Batch("quasistatic", 4.0, 3, 60.0), lambda: (5e10, 4e10), lambda words: None)
    assert whole.values == () and whole.problem.startswith("1 of 2 runs") and second.problem and not first.problem


def test_the_quickest_benchmark_runs_and_is_judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """One kernel through the command line: measured, kept, compared with itself; a record mutated to half its cost is a failure."""
    from verification.benchmarks import __main__ as program
    from verification.benchmarks import records

    monkeypatch.setattr(program, "append", lambda record: records.append(record, tmp_path))
    monkeypatch.setattr(program, "last_record", lambda there: records.last_record(there, tmp_path))
    monkeypatch.setattr(program, "busy_processors", lambda: 0.0)
    out = tmp_path / "last.json"
    options = ["--kernels", "--only", "^stage/surfaces", "--load", "0", "--out", str(out)]
    assert main([*options, "--record"]) == NOT_RECORDED, "a part is none"
    assert main([*options, "--record", "--force"]) == OK
    first = records.load_records(file_of(machine.this_machine(), tmp_path))[0]
    assert len(first.figures) == 1 and first.figures[0].wrong() == "" and len(first.figures[0].values) == 5
    assert from_json(out.read_text(encoding="utf-8")).figures[0].calibrated > 0.0
    for factor, status in ((1e3, OK), (1e-3, WORSE)):
        figure = replace(first.figures[0], values=tuple(factor * value for value in first.figures[0].values))
        records.append(replace(first, figures=(figure,)), tmp_path)
        assert main(options) == status
    assert "SLOWER: stage/surfaces" in capsys.readouterr().out
    assert main(["--only", "no such", "--kernels"]) == main(["--quick", "--record"]) == main(["--only", "("]) == WRONG_USE
