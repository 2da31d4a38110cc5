"""Rows of the ladder as aligned text, and as ladder.json for the page."""

import math
import platform
from dataclasses import asdict
from pathlib import Path

from verification.harness import store
from verification.harness.command import aligned, count, number
from verification.ladder.catalogue import Families, about
from verification.ladder.judge import Tally
from verification.ladder.measure import Row

HEADER = ("case", "quantity", "level", "value", "reference", "error", "order", "cost", "gate", "verdict")
RIGHT = (3, 4, 5, 6, 7, 8)


def cells(row: Row) -> tuple[str, ...]:
    """A row's cells, in the header's order."""
    order = "-" if row.order is None else f"{row.order:.2f}"
    cost = f"{row.cost.wall_s:.2f} s {count(row.cost.particles)}p {count(row.cost.steps)}st" if row.cost else "-"
    gate = "none"
    if row.gate:
        gate = f"{row.gate.error:g}" + (f" / {row.gate.order:g}" if row.gate.order is not None else "")
    many = f" rms of {row.values}" if row.values > 1 else ""
    why = "; ".join(filter(None, (row.failure, *row.problems, row.note)))
    return (
        f"{row.case} ({row.mechanics})", f"{row.quantity} [{row.unit or '1'}]{many}", row.level,
        number(row.value), number(row.reference), "-" if math.isnan(row.error) else f"{row.error:+.2e}",
        f"({order})" if row.no_order and row.order is not None else order, cost, gate, f"{row.verdict}{': ' if why else ''}{why}",
    )  # fmt: skip


def text(rows: list[Row]) -> str:
    """The rows as a table, family by family; orders in brackets are not judged, the reason stands below their family."""
    if not rows:
        return "no rows"
    header, *lines = aligned([HEADER, *map(cells, rows)], RIGHT)
    found = [header]
    for family in dict.fromkeys(row.family for row in rows):
        own = [(row, line) for row, line in zip(rows, lines) if row.family == family]
        found += ["", family, *(line for _, line in own), *reasons([row for row, _ in own])]
    return "\n".join(found)


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


def write_json(path: Path, rows: list[Row], families: Families, tally: Tally, stale: list[str], part: bool) -> None:
    """Write ladder.json: what the page shows; numbers that are not finite are null."""
    said = [
        {"name": family, "says": about(family), "cases": [
            {"name": case.name, "says": case.says, "mechanics": case.mechanics, "scene": case.scene.name} for case in members
        ]}
        for family, members in families.items()
    ]  # fmt: skip
    machine = f"{platform.machine()}, {platform.system()} {platform.release()}"
    content = {"part": part, "machine": machine, "tally": {**asdict(tally), "words": tally.words()}, "stale": stale, "families": said}
    store.write({**content, "rows": [{**asdict(row), "verdict": row.verdict} for row in rows]}, path)
