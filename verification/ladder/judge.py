"""Judges rows by their gates, and the gates by wrong results that they must refuse."""

from dataclasses import dataclass, replace

from verification.ladder import gates as book
from verification.ladder.gates import CannotAccept, Gate, Gates
from verification.ladder.measure import FAIL, FAILED, Row, order_of

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
        passed = self.rows - self.wrong - self.failed
        notes = f"; {self.loose} can be tightened" if self.loose else ""
        return f"{self.rows} comparisons: {passed} pass{bad}; {self.gates} gates, {self.mutants} mutants, {said}{notes}"


def judged(rows: list[Row], gates: dict[str, Gates]) -> list[Row]:
    """Rows with their gates and what is wrong with each; `gates` by family."""
    coarser = _coarser(rows)
    return [judge(row, coarser.get(index), gates.get(row.family, {}).get(row.key)) for index, row in enumerate(rows)]


def _coarser(rows: list[Row]) -> dict[int, Row]:
    """For each row by its place, that of the same quantity at the level before."""
    return {
        index: before
        for index, (before, row) in enumerate(zip(rows, rows[1:]), 1)
        if (before.family, before.case, before.quantity) == (row.family, row.case, row.quantity)
    }


def judge(row: Row, coarser: Row | None, gate: Gate | None) -> Row:
    """A row judged by its gate; the gate must refuse what `mutants_of` lists."""
    if row.failure:
        return replace(row, gate=gate)
    if gate is None:
        return replace(row, problems=(f"no gate (measured error {row.error:.3g}); see --accept",))
    round_off = book.is_round_off(row.no_order)
    problems = [book.too_wide(gate, round_off), "" if passes(gate.error, row.error) else f"error {abs(row.error):.3g} above {gate.error:g}"]
    if coarser is not None and not row.no_order:
        problems.append(unreadable(row, coarser) or _order_problem(row, gate))
    wrong = mutants_of(row, coarser, gate)
    survivors = [name for name, mutant in wrong.items() if not refuses(gate, row, coarser, name, mutant)]
    problems += [f"the gate lets {name} pass" for name in survivors]
    note = "" if round_off else book.loose(gate, row.error, row.order)
    return replace(row, gate=gate, problems=tuple(filter(None, problems)), note=note, refused=len(wrong) - len(survivors))


def unreadable(row: Row, coarser: Row) -> str:
    """Why no order can be read from the level before to a row, or nothing."""
    if coarser.failure:
        return "no order: the level before failed"
    if coarser.values == row.values == 1 and coarser.error * row.error < 0.0:
        return "the error changes its sign from the level before: no order can be read, say so in no_order"
    return ""


def _order_problem(row: Row, gate: Gate) -> str:
    """What is wrong with the order of a row, or nothing."""
    if gate.order is None:
        return f"no gate of order (measured {row.order:.2f}); see --accept"
    return "" if keeps(gate.order, row.order) else f"order {row.order:.2f} below {gate.order:g}"


def passes(allowed: float, error: float) -> bool:
    """Whether an error is within what is allowed; NaN never is."""
    return abs(error) <= allowed


def keeps(least: float, order: float | None) -> bool:
    """Whether an order is at least what is asked; NaN and none never are."""
    return order is not None and order >= least


def mutants_of(row: Row, coarser: Row | None, gate: Gate) -> dict[str, float]:
    """Errors that plainly wrong results would have had: the sample's own, and half an order lost from the level before.

    The half is lost from the order measured, or from the accepted one where that is lower.
    """
    wrong = dict(row.mutants)
    if coarser is not None and not coarser.failure and not row.no_order:
        wrong[HALF_AN_ORDER] = row.error * (coarser.size / row.size) ** (0.5 + book.risen(gate, row.order))
    return wrong


def refuses(gate: Gate, row: Row, coarser: Row | None, name: str, error: float) -> bool:
    """Whether a gate refuses an error in place of the measured one: by its size, or where an order was lost by the order."""
    if not passes(gate.error, error):
        return True
    if name != HALF_AN_ORDER or coarser is None or gate.order is None:
        return False
    return not keeps(gate.order, order_of(coarser.error, error, coarser.size / row.size))


def tally(rows: list[Row]) -> Tally:
    """What became of judged rows."""
    coarser = _coarser(rows)
    tried = [len(mutants_of(row, coarser.get(k), row.gate)) for k, row in enumerate(rows) if row.gate and not row.failure]
    ordered = sum(1 for row in rows if row.gate and row.gate.order is not None and not row.failure)
    return Tally(
        rows=len(rows),
        wrong=sum(row.verdict == FAIL for row in rows),
        failed=sum(row.verdict == FAILED for row in rows),
        gates=sum(1 for row in rows if row.gate and not row.failure) + ordered,
        mutants=sum(tried),
        refused=sum(row.refused for row in rows),
        loose=sum(bool(row.note) for row in rows),
    )


def accepted(rows: list[Row], before: dict[str, Gates]) -> tuple[dict[str, Gates], list[str]]:
    """Gates by family with those of the rows anew, and a line for each that cannot be: those keep the gate they had."""
    now, refused, coarser = {family: dict(own) for family, own in before.items()}, [], _coarser(rows)
    for index, row in enumerate(rows):
        own = now.setdefault(row.family, {})
        try:
            own[row.key] = _gate(row, coarser.get(index))
        except CannotAccept as error:
            refused.append(f"{row.name}: {error}")
    return now, refused


def _gate(row: Row, coarser: Row | None) -> Gate:
    """The gate that a row asks for; raises CannotAccept."""
    if row.failure:
        raise CannotAccept(f"failed: {row.failure}")
    if coarser is None or row.no_order:
        return book.gate_of(row.no_order, row.error, None, row.mutants)
    if unreadable(row, coarser):
        raise CannotAccept(unreadable(row, coarser))
    return book.gate_of(row.no_order, row.error, row.order, row.mutants)
