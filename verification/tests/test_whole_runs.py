"""Of whole runs: the energy ledger closes, summed here from its parts; the result depends neither on the number of threads nor on when it is made."""

from pathlib import Path

import h5py
import numpy as np
import pytest

from verification.faults.same import differences
from verification.harness import smoke
from verification.harness.load import Run
from verification.harness.paths import ANALYTIC, EXPERIMENTS
from verification.harness.run import Job, run
from verification.tests.cases import completed, strata

STORED = ("kinetic_J", "strain_J", "interface_strain_J")
DISSIPATED = ("damping_J", "transfer_J", "integration_J", "friction_J", "failure_J", "fracture_J", "excess_J")
SUPPLIED = ("fluid_work_J", "in_situ_work_J", "edge_work_J", "body_work_J", "initial_kinetic_J")


def total(run: Run, names: tuple[str, ...]) -> np.ndarray:
    """Sum of columns of the history, J/m."""
    return np.sum([run.history[name] for name in names], axis=0)


@pytest.mark.slow
@pytest.mark.parametrize("mechanics, experiment, variant", smoke.cases())
def test_the_ledger_closes_over_a_whole_run(mechanics: str, experiment: str, variant: str) -> None:
    run = completed(smoke.EXPERIMENTS / f"{experiment}.toml", variant, smoke.settings_of(mechanics))
    assert run.history["fluid_work_J"].max() > 1.0, "a run in which nothing happens closes too"
    unknown = {name for name in run.history if name.endswith("_J")} - {*STORED, *DISSIPATED, *SUPPLIED}
    assert not unknown, f"where do {unknown} belong?"
    # Net: most of the fluid's work goes against the in-situ stress, and the sum of both is what the rock got.
    net, unexplained = float(np.max(np.abs(total(run, SUPPLIED)))), total(run, STORED) + total(run, DISSIPATED) - total(run, SUPPLIED)
    assert np.max(np.abs(unexplained)) < 0.01 * net
    for name in ("damping_J", "friction_J"):  # beyond what sticking points give back, nothing spent returns
        fall = float(np.max(np.maximum.accumulate(run.history[name]) - run.history[name]))
        assert fall <= 1e-4 * net, f"{name} falls by {fall} J of {net} J supplied"


# Long enough to start, grow and meet the interface at 2 m cells, with the ramp begun just below the start of growth.
SHORT = ("numerics.cell_m=2.0", "fracture.increment_m=2.0", "stop.time_s=0.6", "stop.tip_y_m=15", "fluid.inlet={start_Pa=2.3e6, rate_Pa_s=0.7e6}")
QUASISTATIC = ("numerics.cell_m=2", "fracture.increment_m=2", "numerics.mechanics=quasistatic", "fluid.law=uniform", "stop.tip_y_m=20")


@pytest.mark.parametrize("scene, variant, settings", [
    ("exp1_single_interface", "weak", SHORT), ("exp4_soft_between", "friction", SHORT), ("exp5_parallel_interface", "soft", SHORT),
    ("exp1_single_interface", "soft", QUASISTATIC),
])  # fmt: skip
def test_same_digits_on_one_and_two_threads_and_again(tmp_path: Path, scene: str, variant: str, settings: tuple[str, ...]) -> None:
    folders = []
    for name, threads in (("one", 1), ("two", 2), ("again", 2)):
        outcome = run(Job(EXPERIMENTS / f"{scene}.toml", variant, tmp_path / name, settings, threads))
        assert outcome.ok, outcome.reason
        folders.append(tmp_path / name)
    for other in folders[1:]:
        assert differences(folders[0], other) == []
    assert len((folders[0] / "history.csv").read_text().splitlines()) > 3


def test_a_run_of_unknown_length_writes_ever_rarer_fields(tmp_path: Path) -> None:
    """Nothing but a height ends it: every 0.02 s up to 0.2 s, then each time a tenth later than the one before; the last is the run's end."""
    assert strata(tmp_path, "run", ANALYTIC / "three_layers.toml", "--out", tmp_path / "X", "--quiet").returncode == 0
    with h5py.File(tmp_path / "X/result.h5") as file:
        times = file["times"][:-1]
    assert times[-1] > 1.0 and np.diff(times) == pytest.approx(np.maximum(0.02, 0.1 * times[:-1]))
