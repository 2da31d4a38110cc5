"""The example well: its scene is what `strata log` makes of its log, and with one modulus its fracture is as high as the reference says.

Mutations that were tried by hand and failed here: layers stacked downwards, stresses of the neighbours, the toughness of the layer above.
"""

import csv
from pathlib import Path

import numpy as np
import pytest

from verification.harness.column import column
from verification.harness.paths import EXPERIMENTS
from verification.harness.reference import values
from verification.tests.cases import completed, strata

LOG, SCENE = (EXPERIMENTS / "well" / name for name in ("well.csv", "well.toml"))
PRESSURES_MPA = (40.2, 40.6, 40.9, 41.3, 41.6)  # the fracture at rest in its layer, then in the shale above; no border is crossed at any of them
LAST_PA = 41.7e6


def column_of_log() -> dict[str, list[float]]:
    """Borders (m above the log's bottom), stresses and toughness of the layers from the bottom, read from the log alone."""
    rows = list(csv.DictReader((line for line in LOG.read_text().splitlines() if not line.startswith("#")), skipinitialspace=True))
    known: dict[str, float] = {}
    toughness = []
    for row in rows[:-1]:  # what a row leaves out is that of the last one above with its rock
        known[row["rock"]] = float(row["toughness_Pa_sqrt_m"] or known[row["rock"]])
        toughness.append(known[row["rock"]])
    depth = [float(row["top_m"]) for row in rows]
    return {"border_m": [depth[-1] - top for top in depth[-2:0:-1]], "stress_Pa": [float(row["horizontal_Pa"]) for row in rows[-2::-1]],
            "toughness_Pa_sqrt_m": toughness[::-1]}


def test_the_scene_is_that_of_the_log(tmp_path: Path) -> None:
    """All of the scene but its variants, which the log knows nothing of, is as the command prints it; `check` takes it at once."""
    done = strata(tmp_path, "log", LOG)
    assert (done.returncode, done.stderr) == (0, "")
    assert SCENE.read_text().partition("\n# --- ")[0] == done.stdout
    (tmp_path / "made.toml").write_text(done.stdout)
    checked = strata(tmp_path, "check", "made.toml")
    assert (checked.returncode, checked.stderr) == (0, "")


def test_a_log_with_mistakes_gives_no_scene(tmp_path: Path) -> None:
    """Three mistakes, three lines with their places, status 2 and nothing on stdout."""
    wrong = LOG.read_text().replace("2412, siltstone, 26e9, 0.24", "2399, siltstone, -26e9, 0.5")
    (tmp_path / "wrong.csv").write_text(wrong)
    done = strata(tmp_path, "log", "wrong.csv")
    assert (done.returncode, done.stdout) == (2, "")
    places = [line.split(": ")[:2] for line in done.stderr.splitlines()]
    assert [(place, what.split(" is ")[0]) for place, what in places] == [
        ("wrong.csv:4:1", "top_m = 2399"), ("wrong.csv:4:18", "youngs_modulus_Pa = -26000000000.0"), ("wrong.csv:4:25", "poisson_ratio = 0.5")]
    assert list(tmp_path.iterdir()) == [tmp_path / "wrong.csv"]


@pytest.mark.smoke
def test_heights_with_one_modulus() -> None:
    """The upper tip within half a metre, a cell, of the log's reference at five pressures, both tips at the end; the reference grows by metres."""
    run = completed(SCENE, "one_modulus", (f"stop.inlet_Pa={LAST_PA}",))
    layers = {**column(run), **column_of_log()}
    found = [run.history["tip_y_m"][run.history["inlet_Pa"] <= 1e6 * pressure][-1] for pressure in PRESSURES_MPA]
    wanted = values("layered_height", "top_m", **layers, pressure_Pa=[1e6 * pressure for pressure in PRESSURES_MPA])
    assert np.abs(np.subtract(found, wanted)).max() <= 0.5
    assert wanted[0] == layers["top_m"] and np.diff(wanted).min() > 0.0 and wanted[-1] - wanted[0] > 7.0
    ends = sorted(tip.y_m for tip in run.summary.tips)
    assert ends == pytest.approx([values("layered_height", name, **layers, pressure_Pa=[LAST_PA]).item() for name in ("bottom_m", "top_m")], abs=0.5)
