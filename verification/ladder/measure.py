"""Makes the runs of cases, each in RUNS/FAMILY/CASE/LEVEL, puts what they gave beside their references, a row a quantity of a run, and judges rows by
their gates, and the gates by wrong results that they must refuse."""

import math
import threading
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from verification.harness import paths
from verification.harness import run as runner
from verification.harness.command import folder_name
from verification.harness.load import Run
from verification.harness.run import Job, Task, Tell, claimed, load_outcome, say, side_by_side
from verification.ladder import gates as book
from verification.ladder.case import Case, Families, Level, Quantity, Sample
from verification.ladder.gates import CannotAccept, Gate, Gates, Key

RUNS = paths.RUNS / "ladder"
PASS, FAIL, FAILED = "pass", "FAIL", "FAILED"
COST = ("wall_s", "particles", "steps", "peak_memory_MB")


@dataclass(frozen=True)
class Rung:
    """A level of a case of a family, and where its run is."""

    family: str
    case: Case
    level: Level
    folder: Path

    def job(self) -> Job:
        """The run to make; the case's mechanics are set unless the level sets them itself."""
        settings = self.level.settings
        own = () if any(setting.startswith("numerics.mechanics=") for setting in settings) else (f"numerics.mechanics={self.case.mechanics}",)
        return Job(self.case.scene, self.level.variant, self.folder, (*own, *settings))

    def expected_s(self) -> float:
        """How long the run may take, s: as the last time, or 0.1 s at the coarsest level and 8 times more at each (points and steps)."""
        before = load_outcome(self.folder)
        return before.wall_s if before is not None else 0.1 * 8.0 ** self.case.levels.index(self.level)


Made = tuple[Rung, runner.Made]


def rungs_of(chosen: Families, smoke: bool = False, runs: Path = RUNS) -> list[Rung]:
    """All rungs of the chosen cases (of each case its smoke levels alone if asked), coarse to fine."""
    return [
        Rung(family, case, level, runs / family / case.name / folder_name(level.label))
        for family, members in chosen.items() for case in members for level in case.levels[: case.smoke if smoke else None]
    ]  # fmt: skip


def make_one(rung: Rung, stop: threading.Event | None = None) -> Made:
    """Make one run unless it is there; another process that wants the same one waits for it."""
    with claimed(rung.folder):
        return rung, runner.make(rung.job(), stop)


def make_all(rungs: list[Rung], jobs: int = 2, tell: Tell = say) -> list[Made]:
    """Make the runs of all rungs on `jobs` threads, those that take longest first; in the order given."""

    def words(made: Made) -> str:
        outcome = made[1][0]
        return f"FAILED: {outcome.reason}" if not outcome.ok else "done before" if outcome.skipped else f"{outcome.wall_s:.1f} s"

    names = [f"{rung.family}/{rung.case.name} {rung.level.label}" for rung in rungs]
    return side_by_side([Task(name, lambda stop, rung=rung: make_one(rung, stop), words, rung.expected_s()) for name, rung in zip(names, rungs)], jobs, tell)


@dataclass(frozen=True)
class Row:
    """A quantity of a case at a level beside its reference. Of many values, `value` and `reference` are the weighted rms. error and reference_error
    are relative; order is that from the level before. `failure` says why there is nothing measured."""

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
    cost: dict[str, float] | None = None  # what the run took, as its summary has it (COST)
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
    return math.nan if coarse == 0.0 or fine == 0.0 else math.log(abs(coarse / fine)) / math.log(ratio)


def with_coarser(rows: list[Row]) -> list[tuple[Row | None, Row]]:
    """Each row behind that of the same quantity at the level before."""
    of = [(row.family, row.case, row.quantity) for row in rows]
    return [(rows[k - 1] if k and of[k - 1] == of[k] else None, row) for k, row in enumerate(rows)]


def rows_of(made: list[Made]) -> list[Row]:
    """The rows of all runs, by case and quantity from coarse to fine, with their orders and without gates."""
    groups: dict[tuple[str, str], list[tuple[Rung, Run | str]]] = {}
    for rung, own in made:
        groups.setdefault((rung.family, rung.case.name), []).append((rung, measurable(rung, own)))
    rows = [row_of(rung, run, quantity) for group in groups.values() for quantity in group[0][0].case.quantities for rung, run in group]
    return [
        row if before is None or before.failure or row.failure else replace(row, order=order_of(before.error, row.error, before.size / row.size))
        for before, row in with_coarser(rows)
    ]


def measurable(rung: Rung, made: runner.Made) -> Run | str:
    """The run of a rung, or why there is none."""
    (outcome, run), asked = made, rung.case.mechanics
    if not outcome.ok or run is None:
        return outcome.reason or f"exit status {outcome.exit_status}"
    return run if run.summary.mechanics == asked else f"the solver ran {run.summary.mechanics} instead of {asked}"


def row_of(rung: Rung, run: Run | str, quantity: Quantity) -> Row:
    """One quantity of one run; whatever keeps it from being measured is the row's failure."""
    case, level = rung.case, rung.level
    row = Row(rung.family, case.name, case.mechanics, quantity.name, quantity.unit, level.label, level.size, quantity.reason(level.label))
    if isinstance(run, str):
        return replace(row, failure=run)
    row = replace(row, cost={name: getattr(run.summary, name) for name in COST})
    try:
        sample = quantity.sample(run)
        error, mutants = sample.error(), sample.mutants()
        value, reference = summarised(sample)
    except Exception as defect:  # a defect in one quantity must not cost all others their judgement
        return replace(row, failure=f"not measured: {type(defect).__name__}: {defect}")
    if not math.isfinite(error):
        return replace(row, failure=f"not measured: the error is {error}")
    own = {"values": int(np.size(sample.values)), "reference_error": sample.reference_error, "scale": sample.scale}
    return replace(row, **own, value=value, reference=reference, error=error, mutants=mutants)  # type: ignore[arg-type]


def summarised(sample: Sample) -> tuple[float, float]:
    """Value and reference of a sample; of many their weighted root mean squares."""
    values, exact = np.asarray(sample.values, float), np.asarray(sample.exact, float)
    if values.shape != exact.shape:
        raise ValueError(f"{values.shape} values beside {exact.shape} exact ones")
    return (float(values.flat[0]), float(exact.flat[0])) if values.size == 1 else (sample.norm(values), sample.norm(exact))


HALF_AN_ORDER = "half an order lost"


@dataclass(frozen=True)
class Tally:
    """How many rows there are of each verdict, gates, and wrong results that they were tried with and refused."""

    rows: int
    wrong: int
    failed: int
    gates: int
    mutants: int
    refused: int
    loose: int

    def words(self) -> str:
        """The tally as a line."""
        said = "all refused" if self.refused == self.mutants else f"{self.mutants - self.refused} NOT REFUSED"
        bad = "".join(f", {count} {word}" for count, word in ((self.wrong, "not as their gates ask"), (self.failed, "failed")) if count)
        notes = f"; {self.loose} can be tightened" if self.loose else ""
        return f"{self.rows} comparisons: {self.rows - self.wrong - self.failed} pass{bad}; {self.gates} gates, {self.mutants} mutants, {said}{notes}"


def judged(rows: list[Row], gates: dict[str, Gates]) -> list[Row]:
    """Rows with their gates and what is wrong with each; `gates` by family."""
    return [judge(row, coarser, gates.get(row.family, {}).get(row.key)) for coarser, row in with_coarser(rows)]


def judge(row: Row, coarser: Row | None, gate: Gate | None) -> Row:
    """A row judged by its gate; the gate must refuse what `mutants_of` lists."""
    if row.failure:
        return replace(row, gate=gate)
    if gate is None:
        return replace(row, problems=(f"no gate (measured error {row.error:.3g}); see --accept",))
    round_off = book.is_round_off(row.no_order)
    problems = [book.too_wide(gate, round_off), "" if abs(row.error) <= gate.error else f"error {abs(row.error):.3g} above {gate.error:g}"]
    if coarser is not None and not row.no_order:
        problems.append(unreadable(row, coarser) or lost_order(row, gate))
    wrong = mutants_of(row, coarser, gate)
    survivors = [name for name, mutant in wrong.items() if not refuses(gate, row, coarser, name, mutant)]
    problems += [f"the gate lets {name} pass" for name in survivors]
    note = "" if round_off else book.loose(gate, row.error, row.order)
    return replace(row, gate=gate, problems=tuple(filter(None, problems)), note=note, refused=len(wrong) - len(survivors))


def lost_order(row: Row, gate: Gate) -> str:
    """What is wrong with the order of a row, or nothing."""
    if gate.order is None:
        return f"no gate of order (measured {row.order:.2f}); see --accept"
    return "" if keeps(gate.order, row.order) else f"order {row.order:.2f} below {gate.order:g}"


def unreadable(row: Row, coarser: Row) -> str:
    """Why no order can be read from the level before to a row, or nothing."""
    if coarser.failure:
        return "no order: the level before failed"
    changes = coarser.values == row.values == 1 and coarser.error * row.error < 0.0
    return "the error changes its sign from the level before: no order can be read, say so in no_order" if changes else ""


def keeps(least: float, order: float | None) -> bool:
    """Whether an order is at least what is asked; NaN and none never are."""
    return order is not None and order >= least


def mutants_of(row: Row, coarser: Row | None, gate: Gate) -> dict[str, float]:
    """Errors that plainly wrong results would have had: the sample's own, and half an order lost from the level before. The half is lost from the
    order measured, or from the accepted one where that is lower."""
    wrong = dict(row.mutants)
    if coarser is not None and not coarser.failure and not row.no_order:
        wrong[HALF_AN_ORDER] = row.error * (coarser.size / row.size) ** (0.5 + book.risen(gate, row.order))
    return wrong


def refuses(gate: Gate, row: Row, coarser: Row | None, name: str, error: float) -> bool:
    """Whether a gate refuses an error in place of the measured one: by its size, or where an order was lost by the order."""
    if not abs(error) <= gate.error:
        return True
    if name != HALF_AN_ORDER or coarser is None or gate.order is None:
        return False
    return not keeps(gate.order, order_of(coarser.error, error, coarser.size / row.size))


def tally(rows: list[Row]) -> Tally:
    """What became of judged rows."""
    tried = [(coarser, row, row.gate) for coarser, row in with_coarser(rows) if row.gate and not row.failure]
    return Tally(
        rows=len(rows),
        wrong=sum(row.verdict == FAIL for row in rows),
        failed=sum(row.verdict == FAILED for row in rows),
        gates=sum(1 + (gate.order is not None) for _, _, gate in tried),
        mutants=sum(len(mutants_of(row, coarser, gate)) for coarser, row, gate in tried),
        refused=sum(row.refused for row in rows),
        loose=sum(bool(row.note) for row in rows),
    )


def accepted(rows: list[Row], before: dict[str, Gates]) -> tuple[dict[str, Gates], list[str]]:
    """Gates by family with those of the rows anew, and a line for each that cannot be: those keep the gate they had."""
    now, refused = {family: dict(own) for family, own in before.items()}, []
    for coarser, row in with_coarser(rows):
        ordered = coarser is not None and not row.no_order
        try:
            if row.failure:
                raise CannotAccept(f"failed: {row.failure}")
            if coarser is not None and ordered and unreadable(row, coarser):
                raise CannotAccept(unreadable(row, coarser))
            now.setdefault(row.family, {})[row.key] = book.gate_of(row.no_order, row.error, row.order if ordered else None, row.mutants)
        except CannotAccept as error:
            refused.append(f"{row.name}: {error}")
    return now, refused
