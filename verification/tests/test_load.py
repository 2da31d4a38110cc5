"""Run folders are read as the contract has them, and what is missing is named."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from verification.harness.load import LoadError, frames, load
from verification.tests.fake_run import climb, write_run


def test_a_whole_folder_is_read(tmp_path: Path) -> None:
    run = load(write_run(tmp_path / "exp" / "weak", climb(to_m=20.0, plateaus={10.0: 0.1e6})))
    assert [event.kind for event in run.summary.events] == ["start", "arrest", "restart", "arrest", "stop"]
    assert run.interfaces_m == [10.0]
    assert run.path.shape == (17, 2) and run.path[-1].tolist() == [40.0, 20.0]
    assert math.isnan(run.summary.tips[0].K_II_Pa_sqrt_m), "null stands for a number that is not finite"


def test_frames_of_the_result_are_read(tmp_path: Path) -> None:
    run = load(write_run(tmp_path / "exp" / "weak", climb(), failed_m=[(2.0e6, 0.0), (2.4e6, 3.0)]))
    times, arrays = zip(*frames(run, "interfaces"))
    assert times == pytest.approx([0.0, 0.4e6 / 0.35e6])
    assert np.sum(arrays[1]["0/split"]) == 6


@pytest.mark.parametrize("name", ["scene.toml", "summary.json", "history.csv"])
def test_a_missing_file_is_named(tmp_path: Path, name: str) -> None:
    folder = write_run(tmp_path / "exp" / "weak", climb())
    (folder / name).unlink()
    with pytest.raises(LoadError, match=name):
        load(folder)


@pytest.mark.parametrize("key", ["events", "inlet_Pa", "tips", "energy"])
def test_a_missing_key_is_named(tmp_path: Path, key: str) -> None:
    folder = write_run(tmp_path / "exp" / "weak", climb())
    summary = json.loads((folder / "summary.json").read_text())
    del summary[key]
    (folder / "summary.json").write_text(json.dumps(summary))
    with pytest.raises(LoadError, match=key):
        load(folder)


def test_a_torn_history_is_named_with_its_line(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "exp" / "weak", climb(to_m=7.0))
    with (folder / "history.csv").open("a") as stream:
        stream.write("1.0,2.0\n")
    with pytest.raises(LoadError, match="history.csv:6"):
        load(folder)


def test_what_a_quasistatic_run_adds_is_optional(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "exp" / "weak", climb(to_m=20.0, plateaus={10.0: 0.1e6}), mechanics="quasistatic")
    run = load(folder)
    assert math.isnan(run.summary.tips[0].G_N_m) and run.summary.monitors == {}
    summary = json.loads((folder / "summary.json").read_text())
    summary["tips"][0]["G_N_m"] = 205.0
    summary["events"][1] |= {"by": "energy", "at_interface": False}
    summary["events"][2] |= {"by": "J", "at_interface": True}
    summary["monitors"] = {"volume_balance": 1e-12, "mirror": True}
    (folder / "summary.json").write_text(json.dumps(summary))
    run = load(folder)
    assert run.summary.suspect == ()
    assert run.summary.tips[0].G_N_m == 205.0 and run.summary.monitors["mirror"] is True
    assert [(event.by, event.at_interface) for event in run.summary.events[1:3]] == [("energy", False), ("J", True)]


def test_marks_of_a_run_are_read(tmp_path: Path) -> None:
    """A mark's value may be null, which stands for no finite number; a torn mark is an error that names its key."""
    folder = write_run(tmp_path / "exp" / "weak", climb())
    assert load(folder).summary.suspect == ()
    summary = json.loads((folder / "summary.json").read_text())
    mark = {"monitor": "energy_closure", "value": 0.02, "threshold": 0.01, "why": "it stayed open"}
    summary["suspect"] = [mark, mark | {"monitor": "momentum", "value": None}]
    (folder / "summary.json").write_text(json.dumps(summary))
    first, second = load(folder).summary.suspect
    assert (first.monitor, first.value, first.threshold, first.why) == ("energy_closure", 0.02, 0.01, "it stayed open")
    assert second.monitor == "momentum" and math.isnan(second.value)
    del summary["suspect"][0]["why"]
    (folder / "summary.json").write_text(json.dumps(summary))
    with pytest.raises(LoadError, match="no key why"):
        load(folder)
