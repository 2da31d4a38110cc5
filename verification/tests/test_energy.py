"""The energy ledger of whole runs closes, summed here from its parts."""

import numpy as np
import pytest

from verification.harness import smoke
from verification.harness.load import Run
from verification.tests.cases import completed

STORED = ("kinetic_J", "strain_J", "interface_strain_J")
DISSIPATED = ("damping_J", "transfer_J", "integration_J", "friction_J", "failure_J", "fracture_J", "excess_J")
SUPPLIED = ("fluid_work_J", "in_situ_work_J", "edge_work_J", "body_work_J", "initial_kinetic_J")


def total(run: Run, names: tuple[str, ...]) -> np.ndarray:
    """Sum of columns of the history, J/m."""
    return np.sum([run.history[name] for name in names], axis=0)


def closure(run: Run) -> float:
    """Largest of what the ledger leaves unexplained at any time, as a share of the net energy supplied in the whole run.

    Net: most of the fluid's work goes against the in-situ stress, and the sum of both is what the rock got.
    """
    unexplained = total(run, STORED) + total(run, DISSIPATED) - total(run, SUPPLIED)
    return float(np.max(np.abs(unexplained)) / np.max(np.abs(total(run, SUPPLIED))))


@pytest.mark.slow
@pytest.mark.parametrize("mechanics, experiment, variant", smoke.cases())
def test_the_ledger_closes_over_a_whole_run(mechanics: str, experiment: str, variant: str) -> None:
    run = completed(smoke.EXPERIMENTS / f"{experiment}.toml", variant, smoke.settings_of(mechanics))
    assert run.history["fluid_work_J"].max() > 1.0, "a run in which nothing happens closes too"
    unknown = {name for name in run.history if name.endswith("_J")} - {*STORED, *DISSIPATED, *SUPPLIED}
    assert not unknown, f"where do {unknown} belong?"
    assert closure(run) < 0.01
    net = float(np.max(np.abs(total(run, SUPPLIED))))
    for name in ("damping_J", "friction_J"):  # beyond what sticking points give back, nothing spent returns
        fall = float(np.max(np.maximum.accumulate(run.history[name]) - run.history[name]))
        assert fall <= 1e-4 * net, f"{name} falls by {fall} J of {net} J supplied"
