"""Puts what runs gave beside their references: a row for each case, quantity and level, as plain data."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from verification.harness.load import Run, load
from verification.ladder.case import Quantity, Sample
from verification.ladder.gates import Gate, Key
from verification.ladder.runner import Made

PASS, FAIL, FAILED = "pass", "FAIL", "FAILED"


@dataclass(frozen=True)
class Cost:
    """What a run took: wall time (s), particles, steps and largest memory (MB)."""

    wall_s: float
    particles: int
    steps: int
    peak_memory_MB: float


@dataclass(frozen=True)
class Row:
    """A quantity of a case at a level beside its reference. Of many values, `value` and `reference` are the weighted rms.

    error and reference_error are relative; order is that from the level before. `failure` says why there is nothing measured.
    """

    family: str
    case: str
    mechanics: str
    quantity: str
    unit: str
    level: str
    size: float
    no_order: str = ""
    values: int = 0
    value: float = math.nan
    reference: float = math.nan
    reference_error: float = 0.0
    scale: float | None = None  # what errors are relative to where it is not the reference
    error: float = math.nan
    order: float | None = None
    cost: Cost | None = None
    mutants: dict[str, float] = field(default_factory=dict)
    failure: str = ""
    gate: Gate | None = None
    problems: tuple[str, ...] = ()
    note: str = ""  # what is told without failing: a gate that is no longer tight
    refused: int = 0  # mutants that the gate was tried with and refused

    @property
    def key(self) -> Key:
        """The key of its gate."""
        return self.case, self.quantity, self.level

    @property
    def name(self) -> str:
        """Family, case, quantity and level."""
        return f"{self.family}/{self.case} {self.quantity} {self.level}"

    @property
    def verdict(self) -> str:
        """FAILED where nothing was measured, FAIL where it is not as its gate asks, else pass."""
        return FAILED if self.failure else FAIL if self.problems else PASS


def order_of(coarse: float, fine: float, ratio: float) -> float:
    """Observed order from two errors (signs do not count) of levels whose sizes have a ratio > 1: log(e1/e2)/log(ratio)."""
    if coarse == 0.0 or fine == 0.0:
        return math.nan
    return math.log(abs(coarse / fine)) / math.log(ratio)


def rows_of(made: list[Made]) -> list[Row]:
    """The rows of all runs, by case and quantity from coarse to fine, without gates."""
    groups: dict[tuple[str, str], list[Made]] = {}
    for one in made:
        groups.setdefault((one.rung.family, one.rung.case.name), []).append(one)
    rows = []
    for group in groups.values():
        loaded = [_load(one) for one in group]
        for quantity in group[0].rung.case.quantities:
            rows += _ladder([row_of(one, run, quantity) for one, run in zip(group, loaded)])
    return rows


def _load(made: Made) -> Run | str:
    """The run of a rung, or why there is none."""
    if not made.outcome.ok:
        return made.outcome.reason or f"exit status {made.outcome.exit_status}"
    try:
        run = load(made.rung.folder)
    except Exception as error:  # whatever is wrong with a run's folder is told in its rows
        return f"{type(error).__name__}: {error}"
    asked = made.rung.case.mechanics
    return run if run.summary.mechanics == asked else f"the solver ran {run.summary.mechanics} instead of {asked}"


def row_of(made: Made, run: Run | str, quantity: Quantity) -> Row:
    """One quantity of one run; whatever keeps it from being measured is the row's failure."""
    rung = made.rung
    case, level = rung.case, rung.level
    reason = quantity.reason(level.label)
    head = (rung.family, case.name, case.mechanics, quantity.name, quantity.unit, level.label, level.size, reason)
    if isinstance(run, str):
        return Row(*head, failure=run)
    summary = run.summary
    cost = Cost(summary.wall_s, summary.particles, summary.steps, summary.peak_memory_MB)
    try:
        sample = quantity.sample(run)
        error, mutants = sample.error(), sample.mutants()
        value, reference = summarised(sample)
    except Exception as defect:  # a defect in one quantity must not cost all others their judgement
        return Row(*head, cost=cost, failure=f"not measured: {type(defect).__name__}: {defect}")
    if not math.isfinite(error):
        return Row(*head, cost=cost, failure=f"not measured: the error is {error}")
    return Row(
        *head, values=int(np.size(sample.values)), value=value, reference=reference, reference_error=sample.reference_error,
        scale=sample.scale, error=error, cost=cost, mutants=mutants,
    )  # fmt: skip


def summarised(sample: Sample) -> tuple[float, float]:
    """Value and reference of a sample; of many their weighted root mean squares."""
    values, exact = np.asarray(sample.values, float), np.asarray(sample.exact, float)
    if values.shape != exact.shape:
        raise ValueError(f"{values.shape} values beside {exact.shape} exact ones")
    if values.size == 1:
        return float(values.flat[0]), float(exact.flat[0])
    return sample.norm(values), sample.norm(exact)


def _ladder(rows: list[Row]) -> list[Row]:
    """Rows of one quantity, coarse to fine, with the order from each to the next where an order is to be expected."""
    found = rows[:1]
    for coarse, fine in zip(rows, rows[1:]):
        both = not (coarse.failure or fine.failure)
        order = order_of(coarse.error, fine.error, coarse.size / fine.size) if both else None
        found.append(replace(fine, order=order))
    return found
