"""The mechanics without inertia: mechanisms, damped motion settling on it, runs that go on. Its accuracy is the ladder's."""

import signal
import subprocess
import time
from pathlib import Path

import h5py
import numpy as np
import pytest

from verification.faults.same import differences
from verification.harness.load import Run
from verification.harness.paths import ANALYTIC, EXPERIMENTS, solver
from verification.harness.run import Job, command_of, run
from verification.tests.cases import completed, make

SCENE = ANALYTIC / "static_quasistatic.toml"
SETTLING = ANALYTIC / "settling.toml"


def test_a_part_that_nothing_holds_is_reported_and_nothing_else() -> None:
    """Loaded sides and a failed frictionless interface: exit 3 with the reason, at every cell size alike."""
    for cell_m in (1.0, 2.0):
        outcome, _ = make(SCENE, "free", (f"numerics.cell_m={cell_m}", "fracture.increment_m=2"))
        assert outcome.exit_status == 3 and "mechanism" in outcome.reason
    held = make(SCENE, "free", ("numerics.cell_m=2", "fracture.increment_m=2", "domain.sides=fixed"))[0]
    assert held.ok, held.reason


def displacement(run: Run) -> np.ndarray:
    """Displacements of the particles at the last output in the order of their ids, m."""
    with h5py.File(run.folder / "result.h5") as store:
        last = store["particles"][max(store["particles"])]
        order = np.argsort(last["id"][()])
        return np.column_stack([last["u_x_m"][()], last["u_y_m"][()]])[order]


SETTLED = ["alone", "friction", "weak", "contact", "spring", "through_contact", "through_spring"]

GRADED = ("numerics.cell_m=0.5", "numerics.far_cell_m=2")


@pytest.mark.parametrize(("variant", "kinematics", "both"), [
    *((variant, kinematics, ()) for kinematics in ("total", "updated") for variant in SETTLED),
    *((variant, "total", GRADED) for variant in ("alone", "spring")), *((variant, "updated", GRADED) for variant in SETTLED),
])  # fmt: skip
def test_damped_motion_settles_on_the_quasi_static_solution(variant: str, kinematics: str, both: tuple[str, ...]) -> None:
    """Displacement, in shares of the largest, and K_I of damped motion at rest and of the equilibrium; settings of both."""
    moved = completed(SETTLING, variant, (f"numerics.kinematics={kinematics}", *both))
    still = completed(SETTLING, variant, ("numerics.mechanics=quasistatic", "stop.time_s=0", *both))
    u, expected = displacement(moved), displacement(still)
    of_largest, of_K = (1e-6, 1e-3) if kinematics == "total" else (3e-3, 3e-3)
    assert np.abs(u - expected).max() <= of_largest * np.abs(expected).max() and np.abs(expected).max() > 1e-5
    assert moved.summary.tips[0].K_I_Pa_sqrt_m == pytest.approx(still.summary.tips[0].K_I_Pa_sqrt_m, rel=of_K)


def test_what_moving_points_add_falls_with_the_load() -> None:
    """A tenth of the net pressure: the difference of `updated`, in shares, falls to below a third."""
    shares = []
    for start_Pa in (2.3e6, 2.03e6):
        load_it = f"fluid.inlet={{start_Pa={start_Pa}, rate_Pa_s=0}}"
        moved = displacement(completed(SETTLING, "alone", (load_it,)))
        still = displacement(completed(SETTLING, "alone", (load_it, "numerics.mechanics=quasistatic", "stop.time_s=0")))
        shares.append(float(np.abs(moved - still).max() / np.abs(still).max()))
    assert shares[1] < shares[0] / 3.0


# Grows from the start, fails columns of the interface and goes on by energy beyond it: a few seconds.
LONG = ("numerics.mechanics=quasistatic", "fluid.law=uniform", "stop.tip_y_m=20")


@pytest.mark.parametrize("name, variant, further", [
    ("exp1_single_interface", "weak", LONG),
    ("exp6_stress_reversal", "friction", ("numerics.mechanics=quasistatic",)),
])  # fmt: skip
def test_an_interrupted_run_goes_on_to_the_same_digits(tmp_path: Path, name: str, variant: str, further: tuple[str, ...]) -> None:
    """Mutation that fails with friction: the state is kept as it is after the run itself has started anew from it."""
    scene = EXPERIMENTS / f"{name}.toml"
    begun = time.monotonic()
    assert run(Job(scene, variant, tmp_path / "whole", further)).ok
    took = time.monotonic() - begun
    for share in (0.4, 0.6, 0.75):
        folder = tmp_path / f"cut_{share}"
        with subprocess.Popen(command_of(Job(scene, variant, folder, further), solver())) as process:
            time.sleep(share * took)
            process.send_signal(signal.SIGTERM)
        assert process.returncode in (0, 130)
        subprocess.run([str(solver()), "resume", str(folder), "--quiet"], check=True)
        assert differences(folder, tmp_path / "whole") == []


@pytest.mark.slow
def test_a_thousand_random_scenes_end_in_equilibrium_or_a_mechanism() -> None:
    """Balance, contact and friction to 1e-8 of the load in each; checked in C++, see solver/tests/test_random_scenes.cpp."""
    program = solver().parent / "strata_tests"
    assert program.exists(), f"{program} is not built"
    done = subprocess.run([program, "[thousand]"], capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 0, done.stdout
