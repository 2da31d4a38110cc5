"""States that are no solution of their equations end a run with exit status 3, the reason, and the last good state."""

import csv
import json
import math
import subprocess
from pathlib import Path

import pytest

from verification.faults.same import torn
from verification.harness.paths import ANALYTIC, solver

# A small fracture fed at a rate; that of the scene is 1e-4 m^2/s, its viscosity 1e-5 Pa s, its least opening 2e-5 m.
FED = (
    str(ANALYTIC / "kgd.toml"), "--set", "numerics.cell_m=1", "--set", "fracture.increment_m=1", "--set", "domain.width_m=60",
    "--set", "fracture.path_m=[[30, 0], [30, 2]]", "--set", "stop.time_s=1",
)

# Two blocks on an interface that fails at once, with friction that no rock has, and a fracture through both at 63 degrees.
ROUGH = """\
[domain]
width_m = 12
height_m = 12
sides = "traction"
[in_situ]
vertical_Pa = 1.4e6
horizontal_Pa = 0.4e6
[rock.r]
youngs_modulus_Pa = 10e9
[rock.s]
youngs_modulus_Pa = 6e9
[interface.rough]
law = "weak"
shear_strength_Pa = 1e3
tensile_strength_Pa = 1e3
residual_friction = 1e6
[strata]
layers = [{rock = "r", thickness_m = 6}, {rock = "s"}]
interfaces = ["rough"]
[fracture]
path_m = [[4, 4], [8, 8]]
growth = "none"
[fluid]
law = "uniform"
inlet = {start_Pa = 3e6, rate_Pa_s = 1e6}
[numerics]
mechanics = "explicit"
kinematics = "updated"
cell_m = 1
[stop]
time_s = 1.0
[variants.usual]
interface.rough.residual_friction = 0.6
"""


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """A run into folder/X."""
    whole = [str(solver()), "run", *arguments, "--out", "X", "--quiet", "--threads", "1"]
    return subprocess.run(whole, cwd=folder, capture_output=True, text=True, check=False, timeout=120)


def check_failed(folder: Path, done: subprocess.CompletedProcess[str], *words: str) -> None:
    """Exit 3 with these words, told alike on the terminal and in the summary; finite rows; a checkpoint that meets the same end."""
    assert done.returncode == 3, done.stderr
    summary = json.loads((folder / "X" / "summary.json").read_text())
    assert summary["status"] == "failed" and done.stderr.strip() == summary["reason"]
    for word in (*words, ". The last good state, of step "):
        assert word in summary["reason"]
    assert math.isfinite(summary["inlet_Pa"]) and math.isfinite(summary["mouth_opening_m"])
    rows = list(csv.DictReader((folder / "X" / "history.csv").open()))
    assert rows and all(math.isfinite(float(row["inlet_Pa"])) and math.isfinite(float(row["strain_J"])) for row in rows)
    assert torn(folder / "X") == []
    (folder / "X" / "summary.json").unlink()
    again = subprocess.run([str(solver()), "resume", "X", "--quiet"], cwd=folder, capture_output=True, text=True, check=False, timeout=120)
    assert again.returncode == 3 and again.stderr.strip() == summary["reason"]


@pytest.mark.parametrize(
    "change, words",
    [
        ("fluid.inlet={rate_m2_s=1e12}", ("at t = 0 s, in any step: ",)),  # by iterations or by values: digits decide
        ("fluid.minimum_opening_m=1e100", ("at t = 0 s, in any step: ", "values that are not finite")),
    ],
)
def test_flow_and_rock_that_do_not_come_together_end_the_run(tmp_path: Path, change: str, words: tuple[str, ...]) -> None:
    """A rate with which no step converges, an infinite flow."""
    check_failed(tmp_path, run(tmp_path, *FED, "--set", change), *words, "fluid.inlet")


def test_no_fluid_is_lost_in_round_off(tmp_path: Path) -> None:
    """Cells that conduct without limit: what has come in is there, although flows between cells cannot be told from round-off."""
    done = run(tmp_path, *FED, "--set", "fluid.inlet={rate_m2_s=1e-3}", "--set", "fluid.minimum_opening_m=1")
    assert done.returncode == 0, done.stderr
    summary = json.loads((tmp_path / "X" / "summary.json").read_text())
    assert summary["fracture_volume_m2"] == pytest.approx(0.5e-3, rel=1e-5)  # half of it in the modelled half
    assert [mark["monitor"] for mark in summary["suspect"]] == []


def test_contact_that_is_far_from_its_laws_ends_the_run(tmp_path: Path) -> None:
    (tmp_path / "rough.toml").write_text(ROUGH)
    check_failed(tmp_path, run(tmp_path, "rough.toml"), "contact, friction and springs were not solved: after 200 sweeps")
    done = run(tmp_path, "rough.toml", "--variant", "usual", "--replace")
    assert done.returncode == 0, done.stderr
