"""The accuracy ladder's ladder.json as plain data, and what its charts draw."""

import json
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from reports.shown import Shown
from reports.words import mechanics_name, order_words, plain, share

ROUND_OFF = "round-off"  # as in verification/ladder/gates.py: how the reason of what holds to rounding begins
SAME_AS_ROUNDING = 1e-13  # errors below it are not drawn
UNIT = re.compile(r"\d (m|s)\b")  # of a level's size, in its label


class Row(Shown):
    """A comparison: a quantity of a case at a level, as ladder.json has it; errors are relative, NaN where nothing was measured."""

    @property
    def passed(self) -> bool:
        """Whether it is as its gate asks."""
        return self.verdict == "pass"

    @property
    def round_off(self) -> bool:
        """Whether the quantity holds to rounding at any size."""
        return self.no_order.startswith(ROUND_OFF)


@dataclass(frozen=True)
class Ladder:
    """All of ladder.json: rows, what each family and case says, and the tally of gates and mutants."""

    rows: list[Row]
    families: dict[str, str]
    cases: dict[tuple[str, str], str]
    tally: dict[str, Any]
    stale: tuple[str, ...]
    part: bool
    machine: str


def load_ladder(path: Path) -> Ladder | None:
    """Read ladder.json; None where there is none, ValueError where it is not as the ladder leaves it."""
    if not path.is_file():
        return None
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        return Ladder(
            rows=[_row(item) for item in content["rows"]], families={item["name"]: item["says"] for item in content["families"]},
            cases={(item["name"], case["name"]): case["says"] for item in content["families"] for case in item["cases"]},
            tally=content["tally"], stale=tuple(content["stale"]), part=bool(content["part"]), machine=content["machine"],
        )
    except (KeyError, TypeError) as error:
        raise ValueError(f"{path}: {error}") from error


def _row(item: dict[str, Any]) -> Row:
    """A row from its JSON object."""

    def float_of(value: Any) -> float:
        """A JSON number, NaN for null."""
        return math.nan if value is None else float(value)

    cost, gate = item["cost"] or {}, item["gate"] or {}
    kept = ("family", "case", "mechanics", "quantity", "unit", "level", "no_order", "verdict", "size", "values", "scale", "order")
    return Row(
        **{name: item[name] for name in kept}, **{name: float_of(item[name]) for name in ("value", "reference", "error", "reference_error")},
        wall_s=float_of(cost.get("wall_s")), particles=int(cost.get("particles", 0)), steps=int(cost.get("steps", 0)),
        memory_MB=float_of(cost.get("peak_memory_MB")), gate=float_of(gate.get("error")), order_gate=gate.get("order"),
        why="; ".join(filter(None, (item["failure"], *item["problems"]))), note=item.get("note", ""),
    )


def curves_of(rows: Sequence[Row]) -> list[Shown]:
    """A curve for each quantity with an error that is neither round-off nor missing, in the rows' order.

    Errors (without sign) and gates at each size, coarse to fine; `order` of the finest pair; `judged`: whether it is asked for.
    """
    groups: dict[tuple[str, str, str], list[Row]] = {}
    for row in rows:
        if not row.round_off and math.isfinite(row.error) and abs(row.error) > SAME_AS_ROUNDING:
            groups.setdefault((row.family, row.case, row.quantity), []).append(row)
    return [_curve(group) for group in groups.values()]


def _curve(group: list[Row]) -> Shown:
    """The curve of one quantity's rows."""
    last = group[-1]
    return Shown(
        family=last.family, case=last.case, mechanics=last.mechanics, quantity=last.quantity, sizes=tuple(row.size for row in group),
        errors=tuple(abs(row.error) for row in group), gates=tuple(row.gate for row in group),
        passed=tuple(row.passed for row in group), order=last.order if len(group) > 1 else None, judged=not last.no_order,
    )


def convergence_figure(ladder: Ladder, family: str) -> Shown | None:
    """Error against size for each case of a family, `quantities` in the order of their colours; None where every error is round-off or missing.

    A panel's unit is that of its sizes: "m" or "s", or nothing where the labels of its levels do not say.
    """
    rows = [row for row in ladder.rows if row.family == family]
    curves = curves_of(rows)
    if not curves:
        return None
    panels = []
    for case, mechanics in dict.fromkeys((curve.case, curve.mechanics) for curve in curves):
        units = {found[1] for row in rows if row.case == case and (found := UNIT.search(row.level))}
        own = tuple(one for one in curves if one.case == case)
        panels.append(Shown(heading=case_words(case, mechanics), curves=own, unit=units.pop() if len(units) == 1 else ""))
    quantities = tuple(dict.fromkeys(curve.quantity for curve in curves))
    left_out = len({(row.case, row.quantity) for row in rows}) - len(curves)
    return Shown(title=convergence_words(curves), panels=panels, quantities=quantities, left_out=left_out)


def case_words(case: str, mechanics: str) -> str:
    """A case's name in words with its mechanics, unless the name has it."""
    return plain(case) if mechanics in case.split("_") else f"{plain(case)}, {mechanics_name(mechanics)}"


def convergence_words(curves: Sequence[Shown]) -> str:
    """What became of the errors of some quantities from the coarsest to the finest level, in a sentence."""
    finest = [curve.errors[-1] for curve in curves]
    orders = [curve.order for curve in curves if curve.judged and curve.order is not None]
    worst = max(curves, key=lambda curve: curve.errors[-1])
    where = f"{share(max(finest))} ({worst.quantity}, {plain(worst.case)})"
    told = f"Errors {f'from {share(min(finest))} to {where}' if len(finest) > 1 else f'of {where}'} at the finest level"
    if not orders:
        return f"{told}; none is judged by its order"
    spread = " to ".join(dict.fromkeys((order_words(min(orders)), order_words(max(orders)))))
    which = f"{len(orders)} of {len(curves)} are judged by their order, " if len(orders) < len(curves) else "orders "
    return f"{told}; {which}{spread} between the finest two levels"
