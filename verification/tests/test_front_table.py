"""The README's table of accuracy says what the ladder's gates allow, and is made as its module says."""

import json
import re
from typing import Any

import pytest

from verification.harness.front_table import END, LINES, README, START, Line, table, with_table
from verification.harness.paths import ROOT


def gates() -> dict[tuple[str, str, str], float]:
    """The largest error that passes, by case, quantity and level, of all families."""
    files = sorted((ROOT / "verification" / "ladder" / "gates").glob("*.json"))
    return {
        (case, quantity, level): gate["error"]
        for path in files
        for case, quantities in json.loads(path.read_text(encoding="utf-8"))["cases"].items()
        for quantity, levels in quantities.items()
        for level, gate in levels.items()
    }


def rows(share: float = 0.5) -> list[dict[str, Any]]:
    """Rows of a ladder with errors of a share of their gates."""
    return [
        {"case": case, "quantity": quantity, "level": level, "error": -share * error, "cost": {"wall_s": 1.0}}
        for (case, quantity, level), error in gates().items()
    ]


def errors(text: str, line: Line) -> dict[str, float]:
    """The errors that a table gives in a line, by level."""
    found = next(one for one in text.splitlines() if one.startswith(f"| {line.says} |"))
    return {level: float(number) / 100.0 for number, level in re.findall(r"(?<![-.\d])([\d.]+) % \(([^)]+)\)", found)}


@pytest.mark.parametrize("line", LINES, ids=[line.case for line in LINES])
def test_the_readme_is_within_the_gates(line: Line) -> None:
    """Each error stands there, is one that its gate lets pass and no nothing."""
    told = errors(README.read_text(encoding="utf-8"), line)
    assert list(told) == list(line.levels)
    for level, error in told.items():
        assert 0.0 < error <= gates()[line.case, line.quantity, level]


def test_a_table_from_the_ladder() -> None:
    """Errors lose their sign and are those of the rows; a row that is missing is an error."""
    made = table(rows())
    for line in LINES:
        told = errors(made, line)
        assert list(told) == list(line.levels)
        for level, error in told.items():
            assert error == pytest.approx(0.5 * gates()[line.case, line.quantity, level], rel=0.05)
    with pytest.raises(ValueError, match="no K_I of graded at 1 m"):
        table([row for row in rows() if row["case"] != "graded"])


def test_only_the_table_changes() -> None:
    """What stands around the table stays; without its marks there is nothing to write to."""
    assert with_table(f"a\n{START}old\n{END}\nb\n", "new\n") == f"a\n{START}new\n{END}\nb\n"
    with pytest.raises(ValueError, match="no table"):
        with_table("a\n", "new\n")
