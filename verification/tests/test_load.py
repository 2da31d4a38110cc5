"""Run folders are read as the contract has them, and what is missing is named."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from verification.harness.load import LoadError, frames, load
from verification.tests.fake_run import changed, climb, write_run

MARK = {"monitor": "energy_closure", "value": 0.02, "threshold": 0.01, "why": "it stayed open"}


def written(tmp_path: Path, to_m: float = 20.0, **options: Any) -> Path:
    return write_run(tmp_path / "exp" / "weak", climb(to_m=to_m, plateaus={10.0: 0.1e6}), **options)


def test_a_whole_folder_is_read(tmp_path: Path) -> None:
    run = load(written(tmp_path, failed_m=[(2.0e6, 0.0), (2.4e6, 3.0)]))
    assert [event.kind for event in run.summary.events] == ["start", "arrest", "restart", "arrest", "stop"]
    assert run.interfaces_m == [10.0] and run.summary.suspect == ()
    assert run.path.shape == (17, 2) and run.path[-1].tolist() == [40.0, 20.0]
    assert math.isnan(run.summary.tips[0].K_II_Pa_sqrt_m), "null stands for a number that is not finite"
    times, arrays = zip(*frames(run, "interfaces"))
    assert times == pytest.approx([0.0, 0.4e6 / 0.35e6]) and np.sum(arrays[1]["0/split"]) == 6


@pytest.mark.parametrize("name", ["scene.toml", "summary.json", "history.csv"])
def test_a_missing_file_is_named(tmp_path: Path, name: str) -> None:
    (written(tmp_path) / name).unlink()
    with pytest.raises(LoadError, match=name):
        load(tmp_path / "exp" / "weak")


@pytest.mark.parametrize(("change", "why"), [
    *(({key: None}, key) for key in ("events", "inlet_Pa", "tips", "energy")),
    ({"suspect": [{key: value for key, value in MARK.items() if key != "why"}]}, "no key why"),
])  # fmt: skip
def test_a_missing_key_is_named(tmp_path: Path, change: dict[str, Any], why: str) -> None:
    with pytest.raises(LoadError, match=why):
        load(changed(written(tmp_path), **change))


def test_a_torn_history_is_named_with_its_line(tmp_path: Path) -> None:
    folder = written(tmp_path, 7.0)
    with (folder / "history.csv").open("a") as stream:
        stream.write("1.0,2.0\n")
    with pytest.raises(LoadError, match="history.csv:6"):
        load(folder)


def test_what_a_quasistatic_run_adds_is_optional(tmp_path: Path) -> None:
    folder = written(tmp_path, mechanics="quasistatic")
    plain = load(folder).summary
    assert math.isnan(plain.tips[0].G_N_m) and plain.monitors == {}
    raw = plain.raw
    raw["events"][1] |= {"by": "energy", "at_interface": False}
    raw["events"][2] |= {"by": "J", "at_interface": True}
    summary = load(changed(folder, tips=[raw["tips"][0] | {"G_N_m": 205.0}], events=raw["events"], monitors={"mirror": True})).summary
    assert summary.tips[0].G_N_m == 205.0 and summary.monitors["mirror"] is True
    assert [(event.by, event.at_interface) for event in summary.events[1:3]] == [("energy", False), ("J", True)]


def test_marks_of_a_run_are_read(tmp_path: Path) -> None:
    """A mark's value may be null, which stands for no finite number."""
    first, second = load(changed(written(tmp_path), suspect=[MARK, MARK | {"monitor": "momentum", "value": None}])).summary.suspect
    assert (first.monitor, first.value, first.threshold, first.why) == tuple(MARK.values())
    assert second.monitor == "momentum" and math.isnan(second.value)
