"""Where things are in the project."""

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EXPERIMENTS = ROOT / "experiments"
ANALYTIC = ROOT / "verification" / "analytic"

# Where runs go: $STRATA_RUNS, or runs/ in the project. Tests have a folder of their own.
RUNS = Path(os.environ.get("STRATA_RUNS", ROOT / "runs"))


def solver() -> Path:
    """The solver to run: $STRATA, or that of the release build."""
    return Path(os.environ.get("STRATA", ROOT / "build" / "release" / "strata"))


def reference_program() -> Path:
    """The program with the reference values: $STRATA_REFERENCE, or that of the release build."""
    return Path(os.environ.get("STRATA_REFERENCE", ROOT / "build" / "release" / "strata-reference"))


def need_solver() -> None:
    """Raises ValueError where there is no solver to run."""
    if not solver().is_file():
        raise ValueError(f"there is no solver at {solver()}: build it first (ci/reproduce and ci/test do)")
