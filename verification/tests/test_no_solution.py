"""States that are no solution of their equations end a run with exit status 3, the reason, and the last good state; runs that leave the range of their
equations say so, those within it do not, on the README's first scene."""

import math
import resource
import subprocess
from pathlib import Path
from typing import Any

import pytest

from verification.faults.same import torn
from verification.harness.paths import ANALYTIC
from verification.tests.cases import SCENES, first_scene, rows_of, run_in, strata, summary_in, summary_of

# A small fracture fed at a rate; that of the scene is 1e-4 m^2/s, its viscosity 1e-5 Pa s, its least opening 2e-5 m.
KGD = ANALYTIC / "kgd.toml"
FED = ("numerics.cell_m=1", "fracture.increment_m=1", "domain.width_m=60", "fracture.path_m=[[30, 0], [30, 2]]", "stop.time_s=1")

ROUGH, BLOCK = SCENES / "rough.toml", SCENES / "pushed.toml"


def check_failed(folder: Path, done: subprocess.CompletedProcess[str], *words: str) -> list[dict[str, str]]:
    """Exit 3 with these words, told alike on the terminal and in the summary; finite rows; a checkpoint that meets the same end. The rows."""
    assert done.returncode == 3, done.stderr
    summary, rows = summary_of(folder / "X"), rows_of(folder / "X")
    assert summary["status"] == "failed" and done.stderr.strip() == summary["reason"]
    assert all(word in summary["reason"] for word in (*words, ". The last good state, of step ")), summary["reason"]
    assert all(map(math.isfinite, (*(summary[name] for name in ("time_s", "inlet_Pa", "mouth_opening_m")), *summary["energy"].values())))
    assert rows and all(math.isfinite(float(row[name])) for row in rows for name in ("inlet_Pa", "strain_J", "body_work_J"))
    assert torn(folder / "X") == []
    (folder / "X" / "summary.json").unlink()
    again = strata(folder, "resume", "X", "--quiet")
    assert again.returncode == 3 and again.stderr.strip() == summary["reason"]
    return rows


@pytest.mark.parametrize("changes, words", [
    (("fluid.inlet={rate_m2_s=1e12}",), ("at t = 0 s, in any step: ",)),  # by iterations or by values: digits decide
    (("fluid.minimum_opening_m=0", "fluid.viscosity_Pa_s=1e-300"), ("at t = 0 s, in any step: ", "values that are not finite")),
    (("fluid.minimum_opening_m=1e100", "fluid.inlet={rate_m2_s=1e300}"), ("at t = 0 s, in any step: ", "fluid.minimum_opening_m = 1e+100 is above all openings")),
])  # fmt: skip
def test_flow_and_rock_that_do_not_come_together_end_the_run(tmp_path: Path, changes: tuple[str, ...], words: tuple[str, ...]) -> None:
    """A rate with which no step converges, an infinite flow by openings or by the floor (beside a smaller rate such a floor is refused)."""
    check_failed(tmp_path, run_in(tmp_path, KGD, *FED, *changes), *words, "fluid.inlet")


def test_no_fluid_is_lost_in_round_off(tmp_path: Path) -> None:
    """Cells of a whole fracture that conduct without limit: what has come in is there, although flows between cells cannot be told from round-off."""
    summary = summary_in(tmp_path, KGD, *FED, "fluid.inlet={rate_m2_s=1e-3}", "fluid.minimum_opening_m=1", "fracture.growth=none")
    assert summary["fracture_volume_m2"] == pytest.approx(0.5e-3, rel=1e-5)  # half of it in the modelled half
    assert [mark["monitor"] for mark in summary["suspect"]] == ["implausible_inputs"]  # the floor of 1 m


def test_contact_that_is_far_from_its_laws_ends_the_run(tmp_path: Path) -> None:
    check_failed(tmp_path, run_in(tmp_path, ROUGH), "contact, friction and springs were not solved: after 200 sweeps")
    done = run_in(tmp_path, ROUGH, variant="usual")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("variant", ["updated", "total", "quasistatic"])
def test_what_is_no_longer_finite_ends_the_run_with_its_last_good_state(tmp_path: Path, variant: str) -> None:
    rows = check_failed(tmp_path, run_in(tmp_path, BLOCK, variant=variant), "-nan at X = ")
    assert len(rows) > 5 and float(rows[-1]["time_s"]) < 0.0201
    assert all(float(row["strain_J"]) > 0.0 for row in rows[2:-1])  # the push ends at 0


def test_energies_that_are_no_longer_finite_end_the_run(tmp_path: Path) -> None:
    """No row with them is written."""
    rows = check_failed(tmp_path, run_in(tmp_path, BLOCK, variant="overflow"), "energies of the ledger are no finite numbers: strain, body_work")
    assert 0.016 <= float(rows[-1]["time_s"]) < 0.0185
    assert (tmp_path / "X" / "checkpoint.bin").exists()


def test_a_limit_of_memory_is_bad_input_and_no_bug(tmp_path: Path) -> None:
    limit = 600_000_000  # of addresses; programs and threads take most of it
    arguments = ("run", BLOCK, "--set", "numerics.cell_m=0.01", "--out", "X", "--threads", "1")
    done = strata(tmp_path, *arguments, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
    assert done.returncode == 2, done.stderr
    assert ("out of memory" in done.stderr or "too large for this machine" in done.stderr) and "a bug" not in done.stderr


FIRST = first_scene().replace('mechanics = "quasistatic"', 'damping_1_s = 20\nmechanics = "explicit"')  # in the mechanics that the README names second
assert 'mechanics = "explicit"' in FIRST


def marks(summary: dict[str, Any]) -> set[str]:
    """The monitors that mark a run."""
    return {mark["monitor"] for mark in summary["suspect"]}


QUASISTATIC, TOTAL = "numerics.mechanics=quasistatic", "numerics.kinematics=total"


@pytest.mark.parametrize("mechanics", [(QUASISTATIC,), (TOTAL,), ()])
def test_the_first_scene_is_sound(tmp_path: Path, mechanics: tuple[str, ...]) -> None:
    """With inertia it says that speeds of growth are no result."""
    assert marks(summary_in(tmp_path, FIRST, *mechanics)) == (set() if mechanics == (QUASISTATIC,) else {"surface_energy_share"})


@pytest.mark.parametrize("mechanics", [(QUASISTATIC,), (TOTAL, "stop.time_s=0.1"), ("stop.time_s=0.1",)])
@pytest.mark.parametrize("start_Pa", [0, 1.3e6, 2.0e6])
def test_a_closed_fracture_at_rest_is_sound(tmp_path: Path, mechanics: tuple[str, ...], start_Pa: float) -> None:
    """A closed fracture, or one that the fluid just holds, has nothing but round-off in its energies and momenta."""
    at_rest = f"fluid.inlet={{start_Pa={start_Pa}, rate_Pa_s=0}}"
    leaning = "fracture.path_m=[[8.3, 6.1], [11.2, 11.4]]"
    for settings in (("domain.sides=traction",), (leaning, "domain.bottom=traction", "domain.sides=traction")):
        summary = summary_in(tmp_path, FIRST, "stop.time_s=0", at_rest, *settings, *mechanics)
        assert marks(summary) == set(), summary["suspect"]


@pytest.mark.parametrize("settings, expected", [
    ((QUASISTATIC, "rock.shale.youngs_modulus_Pa=10"), {"implausible_inputs", "largest_strain", "largest_rotation", "jump_share"}),
    ((QUASISTATIC, "rock.shale.youngs_modulus_Pa=1e7"), {"largest_strain"}), (("rock.shale.youngs_modulus_Pa=1e7",), {"loading_share"}),
    ((QUASISTATIC, "rock.shale.toughness_Pa_sqrt_m=1.45"), {"implausible_inputs"}),
    ((QUASISTATIC, "in_situ={vertical_Pa=3, horizontal_Pa=2}"), {"implausible_inputs"}), (("rock.shale.density_kg_m3=2.5e6",), {"loading_share"}),
    (("fluid.inlet={start_Pa=3e6, rate_Pa_s=0.35e6}",), {"shock_share"}), (("fluid.inlet={start_Pa=2e6, rate_Pa_s=0.35e9}",), {"loading_share"}),
    (("fluid.inlet={start_Pa=2e6, rate_Pa_s=1.4e6}", "numerics.damping_1_s=2000", TOTAL), {"loading_share"}),
])  # fmt: skip
def test_what_leaves_the_range_is_marked(tmp_path: Path, settings: tuple[str, ...], expected: set[str]) -> None:
    """Units of another kind, loads that are not slow: marked by at least these monitors."""
    summary = summary_in(tmp_path, FIRST, *settings)
    assert expected <= marks(summary), summary["suspect"]
    for mark in summary["suspect"]:
        assert summary["monitors"][mark["monitor"]] == mark["value"] and len(mark["why"]) > 40


@pytest.mark.parametrize("kinematics", ["total", "updated"])
def test_the_increment_hardly_moves_the_pressure(tmp_path: Path, kinematics: str) -> None:
    """A crack runs as its energy lets it, whatever the increment. It starts as exp(c_R t/a) at J_c, and a longer increment skips more of
    this: a/c_R log(1 m/0.02 m) = 0.0166 s, in which the inlet rises by 0.0058 MPa; twice that is let pass, for what waves bring back from
    the edges. (One increment a look would take 0.33 s more at 0.02 m.)"""
    ends, c_R, a_m, rate_Pa_s = {}, 1176.0, 5.0, 0.35e6
    for increment in (0.02, 0.1, 0.5, 1.0):
        ends[increment] = summary_in(tmp_path, FIRST, f"fracture.increment_m={increment}", f"numerics.kinematics={kinematics}")["inlet_Pa"]
    skipped = {increment: rate_Pa_s * a_m / c_R * math.log(increment / 0.02) for increment in ends}
    for increment in (0.1, 0.5, 1.0):
        assert 0.0 < ends[0.02] - ends[increment] < 2.0 * skipped[increment]
