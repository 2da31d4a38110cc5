"""Runs that tests share: made once for the same scene and solver, also when several tests ask at the same time."""

import hashlib
from pathlib import Path

from verification.harness import paths
from verification.harness.choose import claimed
from verification.harness.load import Run, load
from verification.harness.run import Job, Outcome, run

RUNS = paths.RUNS / "tests"


def folder_of(scene: Path, variant: str, settings: tuple[str, ...]) -> Path:
    """A folder for a run, different for different settings."""
    tag = hashlib.sha256("\n".join(settings).encode()).hexdigest()[:8] if settings else "as_is"
    return RUNS / scene.stem / f"{variant or 'base'}_{tag}"


def make(scene: Path, variant: str = "", settings: tuple[str, ...] = ()) -> tuple[Outcome, Path]:
    """Make a run unless it is there; its outcome and folder."""
    folder = folder_of(scene, variant, settings)
    with claimed(folder):
        return run(Job(scene, variant, folder, settings)), folder


def completed(scene: Path, variant: str = "", settings: tuple[str, ...] = ()) -> Run:
    """Make a run that has to complete, and load it."""
    outcome, folder = make(scene, variant, settings)
    assert outcome.ok, f"{scene.stem} {variant}: {outcome.reason}"
    return load(folder)
