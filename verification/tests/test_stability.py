"""The stability atlas: what is recorded of every family is as it is to be, and its smoke points still end as recorded."""

from dataclasses import replace

import pytest

from verification.harness.paths import solver
from verification.stability import runner
from verification.stability.families import families
from verification.stability.family import words
from verification.stability.runner import changes, problems, side, walk

FAMILIES = families()
pytestmark = [pytest.mark.smoke, pytest.mark.skipif(not solver().is_file(), reason="no solver is built")]


@pytest.mark.parametrize("name", FAMILIES)
def test_what_is_recorded_is_as_it_is_to_be(name: str) -> None:
    """No garbage, the edge where theory says, beyond it what is declared; every point is in the record, on both sides of the edge."""
    assert problems(FAMILIES[name], runner.read(name)) == []


@pytest.mark.parametrize("name", FAMILIES)
def test_smoke_points_end_as_recorded(name: str) -> None:
    """Runs of the points on both sides of the edge: outcomes and errors are those of the record."""
    family, record = FAMILIES[name], runner.read(name)
    assert record is not None
    found = replace(walk(family, smoke=True), edge=record.edge)
    assert problems(family, found, smoke=True) == []
    assert changes(record, found) == []


def test_records_and_families_belong_together() -> None:
    """No record is left over, nor what the page says of sections and families; no family consists of points beyond its edge alone; of each section with an
    edge ci/test runs sound points and points beyond it."""
    assert {path.stem for path in runner.RECORDS.glob("*.json")} | set(words()["remark"]) <= set(FAMILIES)
    assert set(words()["section"]) == {family.section for family in FAMILIES.values()}
    sides: dict[str, set[bool | None]] = {}
    for name, family in FAMILIES.items():
        record = runner.read(name)
        assert record is not None and any(point.checked is not None and point.checked.holds for point in record.points), name
        if family.edge is not None:
            sides.setdefault(family.section or name, set()).update(side(family, point, record) for point in family.points if point.smoke)
    assert [name for name, found in sides.items() if not {True, False} <= found] == []
