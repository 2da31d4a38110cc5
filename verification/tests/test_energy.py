"""The energy ledger of whole runs closes, summed here from its parts."""
from __future__ import annotations

import numpy as np
import pytest

from verification.harness import smoke
from verification.harness.load import Run
from verification.tests.cases import completed

STORED = ("kinetic_J", "strain_J", "interface_strain_J")
DISSIPATED = ("damping_J", "transfer_J", "contact_J", "friction_J")
SUPPLIED = ("fluid_work_J", "in_situ_work_J", "edge_work_J")


def closure(run: Run) -> float:
    """Largest of what the ledger leaves unexplained, as a share of the largest energy stored or supplied so far."""

    def total(names: tuple[str, ...]) -> np.ndarray:
        return np.sum([run.history[name] for name in names], axis=0)

    open_J = np.abs(total(STORED) + total(DISSIPATED) - total(SUPPLIED))
    parts = np.max(np.abs([run.history[name] for name in (*STORED, *SUPPLIED)]), axis=0)
    scale = np.maximum.accumulate(parts)
    return float(np.max(open_J[scale > 0.0] / scale[scale > 0.0]))


@pytest.mark.slow
@pytest.mark.parametrize("experiment, variant", smoke.cases())
def test_the_ledger_closes_over_a_whole_run(experiment: str, variant: str) -> None:
    run = completed(smoke.EXPERIMENTS / f"{experiment}.toml", variant, smoke.SETTINGS)
    assert closure(run) < 0.01
    assert float(np.max(np.abs(run.history["energy_closure"]))) < 0.01
    for name in DISSIPATED:
        assert np.all(np.diff(run.history[name]) >= -1e-9 * max(1.0, run.history[name].max())), f"{name} falls"
    assert run.history["fluid_work_J"].max() > 1.0, "a run in which nothing happens closes too"
