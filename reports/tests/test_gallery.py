"""The gallery's pictures and rows, from the runs that its tests share."""

from pathlib import Path

import numpy as np
import pytest

from reports.charts.records import draw_gallery
from reports.charts.style import save
from reports.gallery import row, shown
from verification.gallery import FOLDER, SCENES, Scene
from verification.tests.cases import completed


@pytest.mark.smoke
@pytest.mark.parametrize("scene", SCENES, ids=[scene.name for scene in SCENES])
def test_a_scene_has_its_picture_and_its_row(tmp_path: Path, scene: Scene) -> None:
    """A source and a run of finite values over the same range; the row tells the expected number before the one that was got."""
    runs = [completed(FOLDER / f"{scene.name}.toml", variant) for variant in ("", *scene.variants)]
    data = shown(scene.name, runs)
    assert [curve[1] for curve in data.curves] == ["source", "run", "other"][: len(data.curves)] and len(data.curves) > len(scene.variants) + 1
    assert all(len(x) == len(y) > 1 and np.isfinite(x).all() and np.isfinite(y).all() for _, _, x, y, _ in data.curves)
    (source, run) = (y for _, _, _, y, _ in data.curves[:2])
    assert 0.6 < np.ptp(run) / np.ptp(source) < 1.6 or scene.name == "shut_in"  # which begins with the pressure that breaks its first metre
    save(draw_gallery(data), tmp_path / f"{scene.name}.svg")
    assert (tmp_path / f"{scene.name}.svg").stat().st_size < 60_000
    got, expected = scene.pair(runs[0])
    assert f"{scene.number}: {scene.told(expected)} ({scene.source}) | {scene.told(got)}, " in row(scene, runs[0], 1.0)
