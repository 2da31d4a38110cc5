"""Animations show what the runs hold, a frame an output time, and say so in words."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from reports.animation import animations, chosen, largest_principal, main, movie
from reports.charts.animation import write_animation
from reports.runs import load_run, load_runs
from reports.tests.synthetic import OUTPUTS, Plan, write_run
from reports.words import Shown

SOFT = Plan("soft", ("soft",), stop_at_m=10.0, restart_Pa=3.2e6)


def test_principal_stress_by_hand() -> None:
    """Mohr's circle: uniaxial tension 3, pure shear 2, and (1, -1) with shear 0 on any axes."""
    cases = [((3.0, 0.0, 0.0), 3.0), ((0.0, 0.0, 2.0), 2.0), ((0.0, 0.0, -2.0), 2.0), ((-5.0, -3.0, 0.0), -3.0), ((6.0, 0.0, 4.0), 8.0)]
    points = {name: np.array([stress[k] for stress, _ in cases]) for k, name in enumerate(("s_xx_Pa", "s_yy_Pa", "s_xy_Pa"))}
    assert largest_principal(points) == pytest.approx([expected for _, expected in cases])


def test_frames_are_the_output_times(tmp_path: Path) -> None:
    """Time, pressure, opening and stress of each are those of the made-up fields."""
    data = movie(load_run(write_run(tmp_path, 1, SOFT)))
    assert len(data.frames) == OUTPUTS and data.frames[0].height_m == 5.0
    assert [frame.time_s for frame in data.frames] == sorted(frame.time_s for frame in data.frames)
    for frame in data.frames:
        # By the made-up field: the pressure falls to half the inlet's at the tip, the opening is 0.1 mm sqrt(h^2 - s^2).
        assert frame.pressure_MPa[0] == pytest.approx(frame.inlet_MPa) and frame.pressure_MPa[-1] == pytest.approx(0.5 * frame.inlet_MPa)
        assert frame.opening_mm[0] == pytest.approx(0.1 * frame.height_m)
        row, column = np.unravel_index(np.argmax(frame.stress_MPa), frame.stress_MPa.shape)
        assert abs((row + 0.5) * 80 / 120 - frame.height_m) < 1.5 and abs((column + 0.5) * 80 / 120 - 40.0) < 1.5, "largest at the tip; points are 1 m apart"
    last = f"{data.frames[-1].height_m:.0f} m"
    assert last in data.caption and last in data.alt and "interface at 10 m" in data.alt


def test_the_soft_interface_without_inertia_comes_first(tmp_path: Path) -> None:
    """One run an experiment."""
    for number, plan in ((1, SOFT), (1, Plan("soft", ("soft",), mechanics="quasistatic")), (1, Plan("weak", ("weak",))), (3, Plan("weak_soft", ("weak", "soft")))):
        write_run(tmp_path, number, plan)
    assert [(run.number, run.variant, run.mechanics) for run in chosen(load_runs(tmp_path))] == [(1, "soft", "quasistatic"), (3, "weak_soft", "explicit")]


def test_a_gif_moves_and_its_words_stand_beside_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """First and last frame differ; a run that cannot be read is told and left out."""
    write_run(tmp_path, 1, SOFT)
    (write_run(tmp_path, 2, SOFT) / "result.h5").write_bytes(b"torn")
    assert main(["--runs", str(tmp_path), "--out", str(tmp_path / "out")]) == 0
    assert "no animation of exp2_soft_above/soft: " in capsys.readouterr().err
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["exp1_single_interface.gif", "exp1_single_interface.json"]
    with Image.open(tmp_path / "out" / "exp1_single_interface.gif") as picture:
        assert picture.n_frames == OUTPUTS
        first = np.asarray(picture.convert("RGB"))
        picture.seek(OUTPUTS - 1)
        assert np.mean(np.any(first != np.asarray(picture.convert("RGB")), axis=-1)) > 0.01
    assert (tmp_path / "out" / "exp1_single_interface.gif").stat().st_size < 1e6
    assert set(json.loads((tmp_path / "out" / "exp1_single_interface.json").read_text())) == {"caption", "alt"}


@pytest.mark.parametrize("name", ["stress_MPa", "pressure_MPa", "opening_mm", "y_m", "height_m", "time_s"])
def test_whatever_changes_is_seen(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Frames that differ in one thing are two pictures; equal ones are one."""
    monkeypatch.setattr("reports.charts.animation.HOLD", 0)
    data = movie(load_run(write_run(tmp_path, 1, SOFT)))
    first = data.frames[4]
    for shift, pictures in ((0.0, 1), (1.0, 2)):
        data.frames = [first, Shown(**{**vars(first), name: getattr(first, name) + shift})]
        with Image.open(write_animation(data, tmp_path / "two.gif")) as picture:
            assert picture.n_frames == pictures


def test_nothing_to_animate_is_said(tmp_path: Path) -> None:
    """By the exit status."""
    assert animations([], tmp_path / "out") == [] and main(["--runs", str(tmp_path), "--out", str(tmp_path / "out")]) == 1
