"""The accuracy ladder at smoke size: every case against its reference, judged by the gates of the full ladder."""

import itertools

import pytest

from verification.ladder import gates
from verification.ladder.case import Case, families
from verification.ladder.__main__ import text
from verification.ladder.measure import judged, make_one, rows_of, rungs_of, tally

pytestmark = pytest.mark.smoke
FAMILIES = families()
CASES = [pytest.param(family, case, id=f"{family}-{case.name}") for family, members in FAMILIES.items() for case in members]


@pytest.mark.parametrize(("family", "case"), CASES)
def test_errors_and_orders_are_as_their_gates_ask(family: str, case: Case) -> None:
    """Smoke levels of a case; the gates must refuse zero, twice, the flipped sign and half an order lost."""
    made = [make_one(rung) for rung in rungs_of({family: (case,)}, smoke=True)]
    rows = judged(rows_of(made), {family: gates.read(family)})
    print(text(rows))
    found = tally(rows)
    assert len(rows) == case.smoke * len(case.quantities)
    assert found.mutants >= len(rows) and found.refused == found.mutants, found.words()
    assert not [f"{row.name}: {row.failure or '; '.join(row.problems)}" for row in rows if row.verdict != "pass"]


@pytest.mark.parametrize("family", FAMILIES)
def test_every_level_has_a_gate_no_wider_than_measured(family: str) -> None:
    """Each quantity at each level of the full ladder has a gate within the rules, with an order where one is due; none is left over."""
    assert gates.stale(FAMILIES) == []
    known, wrong = gates.read(family), []
    for case in FAMILIES[family]:
        for quantity, (index, level) in itertools.product(case.quantities, enumerate(case.levels)):
            key, reason = (case.name, quantity.name, level.label), quantity.reason(level.label)
            gate = known.get(key)
            if gate is None or gates.too_wide(gate, gates.is_round_off(reason)) or (gate.order is not None) != (index > 0 and not reason):
                wrong.append((key, gate))
    assert wrong == []
