"""The README's table of accuracy says what the ladder's gates allow, and is made as its module says."""

import re

import pytest

from verification.harness.front_table import END, LINES, README, START, Line, measured_row, table, with_table
from verification.ladder import gates
from verification.measured import rubin


# The largest error that passes, by case, quantity and level, of all families; and rows of a ladder with half of it.
ERRORS = {key: gate.error for path in sorted(gates.FOLDER.glob("*.json")) for key, gate in gates.read(path.stem).items()}
ROWS = [{"case": case, "quantity": quantity, "level": level, "error": -0.5 * error, "cost": {"wall_s": 1.0}}
        for (case, quantity, level), error in ERRORS.items()]  # fmt: skip


def errors(text: str, line: Line) -> dict[str, float]:
    """The errors that a table gives in a line, by level."""
    found = next(one for one in text.splitlines() if one.startswith(f"| {line.says} |"))
    return {level: float(number) / 100.0 for number, level in re.findall(r"(?<![-.\d])([\d.]+) % \(([^)]+)\)", found)}


@pytest.mark.parametrize("line", LINES, ids=[line.case for line in LINES])
def test_the_readme_is_within_the_gates(line: Line) -> None:
    """Each error stands there, is one that its gate lets pass and no nothing."""
    told = errors(README.read_text(encoding="utf-8"), line)
    assert list(told) == list(line.levels)
    assert all(0.0 < error <= ERRORS[line.case, line.quantity, level] for level, error in told.items())


def test_a_table_from_the_ladder() -> None:
    """Errors lose their sign and are those of the rows; a row that is missing is an error."""
    made = table(ROWS)
    for line in LINES:
        half = {level: 0.5 * ERRORS[line.case, line.quantity, level] for level in line.levels}
        assert errors(made, line) == pytest.approx(half, rel=0.05)
    with pytest.raises(ValueError, match="no K_I of graded at 1 m"):
        table([row for row in ROWS if row["case"] != "graded"])


def test_the_last_row_is_what_is_kept_beside_the_experiment() -> None:
    """Its errors are the record's of the plain run in 1 mm cells, and of its pressure less the gauges' zero; without a record there is no row."""
    record = rubin.kept()
    assert record is not None
    row = measured_row(record)
    assert row.rpartition("|")[0].rpartition("|")[0] in README.read_text(encoding="utf-8").partition(END)[0]  # but for the seconds
    kept = {(one.name, one.cell_m): one.errors for one in record.results}
    plain = [kept["plain", 0.001][name].late for name in (rubin.LENGTH, rubin.OPENING, rubin.WELL)]
    told = [float(number) / 100.0 for number in re.findall(r"([\d.]+) %", row)]
    assert told == pytest.approx([*plain, kept["gauges_from_zero", 0.001][rubin.WELL].late], rel=0.05)
    with pytest.raises(ValueError, match="no .*rubin.json"):
        measured_row(None)


def test_only_the_table_changes() -> None:
    """What stands around the table stays; without its marks there is nothing to write to."""
    assert with_table(f"a\n{START}old\n{END}\nb\n", "new\n") == f"a\n{START}new\n{END}\nb\n"
    with pytest.raises(ValueError, match="no table"):
        with_table("a\n", "new\n")
