"""The part of the page on speed says what the last record says, of whichever machine, and nothing where there is none."""

import json
from pathlib import Path
from typing import Any

import pytest

from reports.benchmarks import Figures, event_figure, newest, rate_figure, run_table, scaling_figure, section
from reports.make_verification import main


def a_figure(name: str, seconds: float, per: str = "particle-step", **more: Any) -> dict[str, Any]:
    """A figure as ci/bench stores it."""
    values = [seconds * factor for factor in (0.98, 1.0, 1.03)]
    return {"name": name, "per": per, "unit": "s", "values": values, "median": seconds, "spread": 0.05, "share_of_peak": 0.3,
            "about": {}, "problem": "", **more}


def some_figures(factor: float = 1.0) -> list[dict[str, Any]]:
    """Rates, sizes, events and whole runs, all `factor` times as dear as the first ones."""
    found = []
    for kinematics, base in (("updated", 14e-9), ("total", 3e-9)):
        for shape, more in (("bspline2", 1.0), ("gimp", 1.1), ("linear", 0.6)):
            for kernels, slower in (("fast", 1.0), ("plain", 5.0)):
                for threads in (1, 2):
                    if (kinematics, shape) == ("total", "gimp"):
                        continue
                    name = f"step/{kinematics}/{shape}/flip/{kernels}/points4/cells80/threads{threads}"
                    seconds = factor * base * more * slower / (1.0 + 0.85 * (threads - 1))
                    found.append(a_figure(name, seconds, about={"particles": 25600.0}))
        for cells in (50, 160, 320, 1000):
            name = f"scaling/{kinematics}/bspline2/flip/fast/points4/cells{cells}/threads1"
            found.append(a_figure(name, factor * base * 1.02, about={"particles": 4.0 * cells**2}))
    for points in (6400.0, 25600.0, 102400.0):
        found.append(a_figure(f"whole/quasistatic/exp1_soft/{points:g}", factor * 1e-5 * points**1.2, "run", about={"particles": points}))
    events = {"growth/explicit/updated": 4e-3, "growth/explicit/total": 2e-3, "growth/quasistatic/cells80": 1.1e-2,
              "contact/explicit/soft/cells80": 5e-4, "flow/paper/cells80": 8e-7, "write/checkpoint": 6e-3}
    found += [a_figure(name, factor * seconds, "event") for name, seconds in events.items()]
    found.append(a_figure("stage/measure_tips/threads1", factor * 1e-4, "call"))
    found.append(a_figure("crack/graded/cell0.5m", factor * 0.08, "run", about={"error": -4e-4, "particles": 9e3}))
    gone = {"values": [], "median": None, "spread": None, "problem": "3 of 23 runs came to their end in 150 s"}
    found.append(a_figure("experiments/explicit/cell1m", 1.0, "all variants", **gone))
    return found


def write_record(root: Path, date: str = "2026-03-01T10:00:00+00:00", cpu: str = "Some CPU", factor: float = 1.0) -> Path:
    """A record below a project's folder; returns its folder of runs."""
    mark = {"what": "particle-steps of `updated`, 1 thread", "wanted": 60.0, "found": 71.4 / factor, "unit": "million/s",
            "at_least": True, "note": "", "reached": factor < 1.1}
    lost = {**mark, "what": "all experiments, explicit/cell1m", "found": None, "reached": False, "at_least": False, "unit": "s"}
    record = {
        "format": 1, "machine": {"cpu": cpu, "cores": 2, "caches": "L2 1024K"}, "date": date, "part": False, "load": {},
        "build": {"version": "0.3.0", "commit": "abc", "compiler": "GNU 12.2", "flags": "-O3"}, "figures": some_figures(factor),
        "marks": [mark, lost],
    }
    folder = root / "verification" / "benchmarks" / "records"
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / f"{cpu}.jsonl").open("a", encoding="utf-8") as stream:
        stream.write(json.dumps(record) + "\n")
    return root / "runs"


def by_name(figures: list[dict[str, Any]]) -> Figures:
    """Figures by their names."""
    return {figure["name"]: figure for figure in figures}


def test_titles_and_bars_follow_the_record() -> None:
    """Twice the cost is half the rate, the same exponents, and twice the price of growth."""
    once, twice = by_name(some_figures()), by_name(some_figures(2.0))
    assert rate_figure(once).title == (
        "Particle-steps a second on one thread: up to 119 million with updated kinematics and 556 million with total kinematics"
    )
    assert "up to 59.5 million" in rate_figure(twice).title
    first = rate_figure(once).panels[0].shapes[0][1][0]
    assert first.rate == pytest.approx(1e-6 / 14e-9) and first.low < first.rate < first.high and first.threads == 1
    for figures in (once, twice):
        curves = [curve for panel in scaling_figure(figures).panels for curve in panel.curves]
        assert [curve.exponent for curve in curves] == pytest.approx([1.0, 1.0, 1.2], abs=0.01)
        assert curves[0].points == (1e4, 25600.0, 102400.0, 409600.0, 4e6) and list(curves[0].seconds) == sorted(curves[0].seconds)
    assert event_figure(once).title.startswith("An increment of growth costs 4\u00a0ms (explicit, updated)")
    assert "8\u00a0ms" in event_figure(twice).title
    assert event_figure(once).events[0][0].startswith("growth") and ("J and K at a tip", pytest.approx(1e-4)) in [
        (name, middle) for name, middle, *_ in event_figure(once).events]


def test_nothing_recorded_is_no_section(tmp_path: Path) -> None:
    """No folder, and an empty one."""
    assert section(tmp_path / "runs") is None
    (tmp_path / "verification" / "benchmarks" / "records").mkdir(parents=True)
    assert section(tmp_path / "runs") is None


def test_the_page_shows_the_newest_record(tmp_path: Path) -> None:
    """Of two machines the one that recorded last, and of its records the last; marks that are missed are marked."""
    write_record(tmp_path, "2026-05-01T10:00:00+00:00", "Old CPU", 3.0)
    write_record(tmp_path, "2026-06-01T10:00:00+00:00", factor=2.0)
    runs = write_record(tmp_path, "2026-07-01T10:00:00+00:00")
    found = newest(tmp_path / "verification" / "benchmarks" / "records")
    assert found is not None and found["date"].startswith("2026-07")
    assert main(["--runs", str(runs), "--out", str(tmp_path / "out"), "--strict"]) == 0
    page = (tmp_path / "out" / "verification.html").read_text(encoding="utf-8")
    for words in ("1 of 2 marks are reached; not all experiments, explicit/cell1m", "Recorded 2026-07-01", "Some CPU, 2 cores",
                  "71.4 million/s", "falls short", "3 of 23 runs came to their end", "K_I -0.040", "benchmark_rates.svg"):
        assert words in page, words
    assert page.count('<tr class="wrong">') == 2, "a mark and a batch"
    assert '<tr class="wrong"><td>all experiments, explicit/cell1m' in page and '<tr class="wrong"><td>experiments/explicit' in page
    for name in ("rates", "scaling", "events"):
        assert (tmp_path / "out" / "figures" / f"benchmark_{name}.png").is_file()


def test_what_did_not_end_has_no_time() -> None:
    """A batch that failed is shown with its reason."""
    table = run_table(some_figures())
    assert table["marked"] == [len(table["rows"]) - 1] and table["rows"][-1][1] == "–"
