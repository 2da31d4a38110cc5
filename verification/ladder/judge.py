"""Judges rows by their gates, and the gates by wrong results that they must refuse."""

from dataclasses import dataclass, replace

from verification.ladder import gates as book
from verification.ladder.gates import CannotAccept, Gate, Gates
from verification.ladder.measure import FAIL, FAILED, Row, order_of, with_coarser

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
