"""The part of the page on speed says what the last record says, of whichever machine, and nothing where there is none."""

from pathlib import Path

import pytest

from reports.benchmarks import RECORDS, event_figure, newest, rate_figure, run_table, scaling_figure, section
from reports.make_page import main
from verification.benchmarks.machine import Build, Load, Machine
from verification.benchmarks.record import STEP, Figure, Record, append, mark


def a_figure(name: str, seconds: float, per: str = STEP, **about: float) -> Figure:
    """A figure of three repetitions."""
    return Figure(name, per, tuple(seconds * factor for factor in (0.98, 1.0, 1.03)), about=about)


def some_figures(factor: float = 1.0) -> list[Figure]:
    """Rates, sizes, events and whole runs, all `factor` times as dear as the first ones."""
    rates = [(kinematics, shape, kernels, threads, base * more * slower / (1.0 + 0.85 * (threads - 1)))
             for kinematics, base in (("updated", 14e-9), ("total", 3e-9)) for shape, more in (("bspline2", 1.0), ("gimp", 1.1), ("linear", 0.6))
             for kernels, slower in (("fast", 1.0), ("plain", 5.0)) for threads in (1, 2) if (kinematics, shape) != ("total", "gimp")]
    events = {"growth/explicit/updated": 4e-3, "growth/explicit/total": 2e-3, "growth/quasistatic/cells80": 1.1e-2,
              "contact/explicit/soft/cells80": 5e-4, "flow/paper/cells80": 8e-7, "write/checkpoint": 6e-3, "stage/measure_tips/threads1": 1e-4}
    return [
        *(a_figure(f"step/{kinematics}/{shape}/flip/{kernels}/points4/cells80/threads{threads}", factor * seconds, particles=25600.0)
          for kinematics, shape, kernels, threads, seconds in rates),
        *(a_figure(f"scaling/{kinematics}/bspline2/flip/fast/points4/cells{cells}/threads1", factor * base, particles=4.0 * cells**2)
          for kinematics, base in (("updated", 14.3e-9), ("total", 3.06e-9)) for cells in (50, 160, 320, 1000)),
        *(a_figure(f"whole/quasistatic/exp1_soft/{points:g}", factor * 1e-5 * points**1.2, "run", particles=points)
          for points in (6400.0, 25600.0, 102400.0)),
        *(a_figure(name, factor * seconds, "event") for name, seconds in events.items()),
        a_figure("crack/graded/cell0.5m", factor * 0.08, "run", error=-4e-4),
        Figure("experiments/explicit/cell1m", "all variants", (), problem="3 of 23 runs came to their end in 150 s"),
    ]


def write_record(root: Path, date: str, cpu: str = "Some CPU", factor: float = 1.0) -> Path:
    """A record below a project's folder; returns its folder of runs."""
    marks = (mark("particle-steps of `updated`, 1 thread", 60.0, 71.4 / factor, "million/s", True),
             mark("all experiments, explicit/cell1m", 120.0, float("nan"), "s"))
    figures, build = tuple(some_figures(factor)), Build("0.3.0", "abc", "GNU 12.2", "-O3")
    append(Record(Machine(cpu, 2, "L2 1024K"), build, Load(0.0, 0.0), date, figures, False, marks), root / RECORDS)
    return root / "runs"


def test_titles_and_bars_follow_the_record() -> None:
    """Twice the cost is half the rate, the same exponents, and twice the price of growth."""
    once, twice = some_figures(), some_figures(2.0)
    assert rate_figure(once).title == (
        "Particle-steps a second on one thread: up to 119 million with updated kinematics and 556 million with total kinematics"
    )
    assert "up to 59.5 million" in rate_figure(twice).title
    panel = rate_figure(once).panels[0]
    first = panel.shapes[0][1][0]
    assert first.rate == pytest.approx(1e-6 / 14e-9) and first.low < first.rate < first.high and first.threads == 1
    assert panel.marks == {1: 60.0, 2: 110.0}
    for figures in (once, twice):
        curves = [curve for panel in scaling_figure(figures).panels for curve in panel.curves]
        assert [curve.exponent for curve in curves] == pytest.approx([1.0, 1.0, 1.2], abs=0.01)
        assert curves[0].points == (1e4, 25600.0, 102400.0, 409600.0, 4e6) and list(curves[0].seconds) == sorted(curves[0].seconds)
    assert event_figure(once).title.startswith("An increment of growth costs 4\u00a0ms (explicit, updated)")
    assert "8\u00a0ms" in event_figure(twice).title
    assert event_figure(once).events[0][0].startswith("growth")
    assert ("J and K at a tip", pytest.approx(1e-4)) in [(name, middle) for name, middle, *_ in event_figure(once).events]
    table = run_table(once)
    assert table["marked"] == [len(table["rows"]) - 1] and table["rows"][-1][1] == "–", "a batch that failed has no time"


def test_the_page_shows_the_newest_record(tmp_path: Path) -> None:
    """Of two machines the one that recorded last, and of its records the last; marks that are missed are marked; without a record nothing."""
    assert section(tmp_path / "runs") is None
    write_record(tmp_path, "2026-05-01T10:00:00+00:00", "Old CPU", 3.0)
    write_record(tmp_path, "2026-06-01T10:00:00+00:00", factor=2.0)
    runs = write_record(tmp_path, "2026-07-01T10:00:00+00:00")
    found = newest(tmp_path / RECORDS)
    assert found is not None and found.date.startswith("2026-07")
    assert main(["--page", "verification", "--runs", str(runs), "--out", str(tmp_path / "out"), "--strict"]) == 0
    page = (tmp_path / "out" / "verification.html").read_text(encoding="utf-8")
    for words in ("1 of 2 marks are reached; not all experiments, explicit/cell1m", "Recorded 2026-07-01", "Some CPU, 2 cores",
                  "71.4 million/s", "falls short", "3 of 23 runs came to their end", "K_I -0.040", "benchmark_rates.svg"):
        assert words in page, words
    assert '<tr class="wrong"><td>all experiments, explicit/cell1m' in page and '<tr class="wrong"><td>experiments/explicit' in page
    assert page.count('<tr class="wrong">') == 2 and (tmp_path / "out" / "figures" / "benchmark_events.png").is_file()
