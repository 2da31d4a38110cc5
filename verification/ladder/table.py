"""Rows of the ladder as aligned text, and as ladder.json for the page."""
from __future__ import annotations

import json
import math
import platform
from dataclasses import asdict
from pathlib import Path
from typing import Any

from verification.ladder.case import Case
from verification.ladder.catalogue import Families, about
from verification.ladder.judge import Tally
from verification.ladder.measure import Row

HEADER = ("case", "quantity", "level", "value", "reference", "error", "order", "cost", "gate", "verdict")
RIGHT = (3, 4, 5, 6, 7, 8)


def cells(row: Row) -> tuple[str, ...]:
    """A row's cells, in the header's order."""
    order = "-" if row.order is None else f"{row.order:.2f}"
    cost = f"{row.cost.wall_s:.2f} s {_count(row.cost.particles)}p {_count(row.cost.steps)}st" if row.cost else "-"
    gate = "none"
    if row.gate:
        gate = f"{row.gate.error:g}" + (f" / {row.gate.order:g}" if row.gate.order is not None else "")
    many = f" rms of {row.values}" if row.values > 1 else ""
    why = "; ".join(filter(None, (row.failure, *row.problems, row.note)))
    return (
        f"{row.case} ({row.mechanics})", f"{row.quantity} [{row.unit or '1'}]{many}", row.level,
        _number(row.value), _number(row.reference), "-" if math.isnan(row.error) else f"{row.error:+.2e}",
        f"({order})" if row.no_order and row.order is not None else order, cost, gate, f"{row.verdict}{': ' if why else ''}{why}",
    )  # fmt: skip


def _number(value: float) -> str:
    """A number with six digits, or a dash."""
    return f"{value:.6g}" if math.isfinite(value) else "-"


def _count(number: int) -> str:
    """A count with k for thousands and M for millions."""
    for size, letter in ((1e6, "M"), (1e3, "k")):
        if number >= size:
            return f"{number / size:.3g}{letter}"
    return str(number)


def text(rows: list[Row]) -> str:
    """The rows as a table, family by family; orders in brackets are not judged, the reason stands below their family."""
    if not rows:
        return "no rows"
    body = [cells(row) for row in rows]
    widths = [max(len(line[k]) for line in [HEADER, *body]) for k in range(len(HEADER) - 1)]

    def line(one: tuple[str, ...]) -> str:
        padded = (word.rjust(width) if k in RIGHT else word.ljust(width) for k, (word, width) in enumerate(zip(one, widths)))
        return "  ".join([*padded, one[-1]]).rstrip()

    lines = [line(HEADER)]
    for family in dict.fromkeys(row.family for row in rows):
        own = [(row, words) for row, words in zip(rows, body) if row.family == family]
        lines += ["", f"{family}", *(line(words) for _, words in own)]
        lines += reasons([row for row, _ in own])
    return "\n".join(lines)


def reasons(rows: list[Row]) -> list[str]:
    """A line for each reason why no order is to be expected, with the cases and quantities that it is given for."""
    given: dict[str, dict[str, list[str]]] = {}
    for row in rows:
        if row.no_order:
            given.setdefault(row.no_order, {}).setdefault(f"{row.case} {row.quantity}", []).append(row.level)
    whole = {name: sum(f"{row.case} {row.quantity}" == name for row in rows) for names in given.values() for name in names}
    return [
        f"  no order: {reason}: "
        + "; ".join(name if len(levels) == whole[name] else f"{name} at {', '.join(levels)}" for name, levels in names.items())
        for reason, names in given.items()
    ]


def write_json(path: Path, rows: list[Row], families: Families, count: Tally, stale: list[str], part: bool) -> None:
    """Write ladder.json: what the page shows; numbers that are not finite are null."""
    content = {
        "part": part,
        "machine": f"{platform.machine()}, {platform.system()} {platform.release()}",
        "tally": {**asdict(count), "words": count.words()},
        "stale": stale,
        "families": [
            {"name": family, "says": about(family), "cases": [_case(case) for case in members]}
            for family, members in families.items()
        ],
        "rows": [_plain({**asdict(row), "verdict": row.verdict}) for row in rows],
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(content, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def _case(case: Case) -> dict[str, Any]:
    """What a case is, for the page."""
    return {"name": case.name, "says": case.says, "mechanics": case.mechanics, "scene": case.scene.name}


def _plain(value: Any) -> Any:
    """A value that JSON can hold."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, dict):
        return {name: _plain(item) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value
