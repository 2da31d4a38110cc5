"""The result of a run depends neither on the number of threads nor on when it is made."""

from pathlib import Path

import h5py
import numpy as np
import pytest

from verification.harness.load import arrays_of
from verification.harness.paths import EXPERIMENTS
from verification.harness.run import Job, run

# Long enough to start, grow and meet the interface at 2 m cells, with the ramp begun just below the start of growth.
SHORT = ("numerics.cell_m=2.0", "fracture.increment_m=2.0", "stop.time_s=0.6", "stop.tip_y_m=15", "fluid.inlet={start_Pa=2.3e6, rate_Pa_s=0.7e6}")


def arrays(path: Path) -> dict[str, np.ndarray]:
    """All data sets of a result.h5."""
    with h5py.File(path, "r") as store:
        return arrays_of(store)


@pytest.mark.parametrize(
    "scene, variant", [("exp1_single_interface", "weak"), ("exp4_soft_between", "friction"), ("exp5_parallel_interface", "soft")]
)
def test_same_digits_on_one_and_two_threads_and_again(tmp_path: Path, scene: str, variant: str) -> None:
    folders = []
    for name, threads in (("one", 1), ("two", 2), ("again", 2)):
        outcome = run(Job(EXPERIMENTS / f"{scene}.toml", variant, tmp_path / name, SHORT, threads))
        assert outcome.ok, outcome.reason
        folders.append(tmp_path / name)
    histories = [(folder / "history.csv").read_bytes() for folder in folders]
    assert histories[0] == histories[1] == histories[2]
    assert len(histories[0].splitlines()) > 3
    first, *others = (arrays(folder / "result.h5") for folder in folders)
    for other in others:
        assert first.keys() == other.keys()
        different = [name for name in first if not np.array_equal(first[name], other[name], equal_nan=first[name].dtype.kind == "f")]
        assert not different
