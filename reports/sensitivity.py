"""Which of the study's claims survive which choice: claims against open points, as a table of plain cells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from reports.words import mechanics_name
from verification.harness.choices import Point
from verification.harness.claim_data import ClaimResult, Reading


@dataclass(frozen=True)
class Cell:
    """What became of a claim under a choice: kind 'yes', 'part', 'no', 'open' or 'none', and the same in words."""

    kind: str
    words: str


@dataclass(frozen=True)
class Line:
    """One claim in one mechanics: the default, then a cell for each choice."""

    id: str
    text: str
    mechanics: str
    first: bool  # of the claim's lines
    lines: int  # of the claim
    cells: tuple[Cell, ...]


@dataclass(frozen=True)
class Column:
    """A choice: its name and the id of its point; starts is whether it is the first of its point."""

    name: str
    point: str
    starts: bool


@dataclass(frozen=True)
class Sensitivity:
    """The table, its points with how many columns each has, and what it shows in a sentence."""

    points: tuple[tuple[str, str, int], ...]  # id, words, columns
    columns: tuple[Column, ...]
    lines: tuple[Line, ...]
    finding: str


SYMBOLS: dict[str, str] = {"yes": "✓", "part": "(✓)", "no": "✗", "open": "?", "none": ""}


def sensitivity(claims: Sequence[ClaimResult], points: Sequence[Point]) -> Sensitivity:
    """Every claim in every mechanics under the default and under each choice that any claim was evaluated under."""
    used = {reading.choice for claim in claims for reading in claim.readings if reading.choice}
    shown = [(point, [choice for choice in point.choices if choice.id in used]) for point in points]
    shown = [(point, choices) for point, choices in shown if choices]
    columns = tuple(
        Column(choice.name, point.id, index == 0) for point, choices in shown for index, choice in enumerate(choices)
    )
    ids = [choice.id for _, choices in shown for choice in choices]
    lines: list[Line] = []
    for id_ in sorted({claim.id for claim in claims}):
        own = [claim for claim in claims if claim.id == id_]
        for index, claim in enumerate(own):
            cells = (_default(claim), *(_cell(claim, choice) for choice in ids))
            lines.append(Line(claim.id, claim.text, mechanics_name(claim.mechanics), index == 0, len(own), cells))
    heads = tuple((point.id, point.open, len(choices)) for point, choices in shown)
    return Sensitivity(heads, columns, tuple(lines), _finding(lines))


def _default(claim: ClaimResult) -> Cell:
    """A claim under the default choices."""
    if claim.holds is None:
        lacks = [case.note for case in claim.cases if not case.evaluated]
        return Cell("open", "; ".join(lacks) or "a run ended before it could show this")
    return Cell("yes", "reproduced") if claim.holds else Cell("no", "not reproduced")


def _cell(claim: ClaimResult, choice: str) -> Cell:
    """A claim under a choice."""
    reading = next((one for one in claim.readings if one.choice == choice), None)
    if reading is None:
        return Cell("none", "not applicable")
    if reading.holds is None:
        lacks = [case.note for case in reading.cases if not case.evaluated]
        return Cell("open", "; ".join(dict.fromkeys(lacks)) or "a run ended before it could show this")
    if not reading.holds:
        return Cell("no", "not reproduced: " + "; ".join(_failing(reading)))
    return Cell("yes", "reproduced") if reading.complete else Cell("part", f"holds for {_variants(reading)}, not run for others")


def _variants(reading: Reading) -> str:
    """The variants that a reading rests on."""
    return ", ".join(dict.fromkeys(case.case.variant.replace("_", " ") for case in reading.cases))


def _failing(reading: Reading) -> list[str]:
    """The cases of a reading that do not hold."""
    return [f"{case.case.variant.replace('_', ' ')}, {case.case.observable.rsplit('_', 1)[0].replace('_', ' ')}"
            for case in reading.cases if case.holds is False]


def _finding(lines: Sequence[Line]) -> str:
    """Which claims no choice overturns, and which depend on one; a choice that was run for some of the cases decides none."""
    firm: list[str] = []
    turned: list[str] = []
    never: list[str] = []
    for id_ in dict.fromkeys(line.id for line in lines):
        known = {cell.kind for line in lines if line.id == id_ for cell in line.cells} & {"yes", "no"}
        if len(known) == 2:
            turned.append(id_)
        elif known == {"yes"}:
            firm.append(id_)
        elif known == {"no"}:
            never.append(id_)
    parts = [
        f"reproduced under every choice and mechanics that was run: {', '.join(firm) or 'none'}",
        f"reproduced under some and not under others: {', '.join(turned) or 'none'}",
        f"under none: {', '.join(never) or 'none'}",
    ]
    return "; ".join(parts).capitalize() + "."
