"""The accuracy ladder's ladder.json as plain data, and what its charts draw."""

from __future__ import annotations

import json
import math
import re
import statistics
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from reports.words import listed, mechanics_name, number, plain, share

ROUND_OFF = "round-off"  # as in verification/ladder/gates.py: how the reason of what holds to rounding begins
SAME_AS_ROUNDING = 1e-13  # errors below it are not drawn
ONE_PERCENT = 0.01
UNIT = re.compile(r"\d (m|s)\b")  # of a level's size, in its label


@dataclass(frozen=True)
class Row:
    """A comparison: a quantity of a case at a level; errors are relative, NaN where nothing was measured."""

    family: str
    case: str
    mechanics: str
    quantity: str
    unit: str
    level: str
    size: float
    no_order: str
    values: int
    value: float
    reference: float
    reference_error: float
    scale: float | None
    error: float
    order: float | None
    wall_s: float
    particles: int
    steps: int
    memory_MB: float
    gate: float
    order_gate: float | None
    verdict: str
    why: str
    note: str

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

    rows: tuple[Row, ...]
    families: dict[str, str]
    cases: dict[tuple[str, str], str]
    tally: dict[str, Any]
    stale: tuple[str, ...]
    part: bool
    machine: str


@dataclass(frozen=True)
class Curve:
    """A quantity's errors (without sign) and gates at each size and wall time (s), coarse to fine; `order` of the finest pair."""

    family: str
    case: str
    mechanics: str
    quantity: str
    sizes: tuple[float, ...]
    errors: tuple[float, ...]
    gates: tuple[float, ...]
    walls_s: tuple[float, ...]
    passed: tuple[bool, ...]
    order: float | None
    judged: bool  # whether the order is asked for


@dataclass(frozen=True)
class Panel:
    """The curves of one case or family; unit: of the sizes, "m" or "s", or nothing where their labels do not say."""

    heading: str
    curves: tuple[Curve, ...]
    unit: str = ""


@dataclass(frozen=True)
class ConvergenceFigure:
    """Error against size for each case of a family; `quantities` in the order of their colours."""

    title: str
    panels: tuple[Panel, ...]
    quantities: tuple[str, ...]
    left_out: int


@dataclass(frozen=True)
class CostFigure:
    """Largest error of every case against wall time, a panel a family; `mechanics` in the order of their colours."""

    title: str
    panels: tuple[Panel, ...]
    mechanics: tuple[str, ...]


def load_ladder(path: Path) -> Ladder | None:
    """Read ladder.json; None where there is none, ValueError where it is not as the ladder leaves it."""
    if not path.is_file():
        return None
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        return Ladder(
            rows=tuple(_row(item) for item in content["rows"]),
            families={item["name"]: item["says"] for item in content["families"]},
            cases={(item["name"], case["name"]): case["says"] for item in content["families"] for case in item["cases"]},
            tally=content["tally"],
            stale=tuple(content["stale"]),
            part=bool(content["part"]),
            machine=content["machine"],
        )
    except (KeyError, TypeError) as error:
        raise ValueError(f"{path}: {error}") from error


def _row(item: dict[str, Any]) -> Row:
    """A row from its JSON object."""
    cost, gate = item["cost"] or {}, item["gate"] or {}
    words = ("family", "case", "mechanics", "quantity", "unit", "level", "no_order", "verdict")
    names = (*words, "size", "values", "scale", "order")
    return Row(
        **{name: item[name] for name in names},
        value=_float(item["value"]), reference=_float(item["reference"]), error=_float(item["error"]),
        reference_error=_float(item["reference_error"]), wall_s=_float(cost.get("wall_s")),
        particles=int(cost.get("particles", 0)), steps=int(cost.get("steps", 0)),
        memory_MB=_float(cost.get("peak_memory_MB")), gate=_float(gate.get("error")), order_gate=gate.get("order"),
        why="; ".join(filter(None, (item["failure"], *item["problems"]))), note=item.get("note", ""),
    )  # fmt: skip


def _float(value: Any) -> float:
    """A JSON number, NaN for null."""
    return math.nan if value is None else float(value)


def curves_of(rows: Sequence[Row]) -> list[Curve]:
    """A curve for each quantity with an error that is neither round-off nor missing, in the rows' order."""
    groups: dict[tuple[str, str, str], list[Row]] = {}
    for row in rows:
        if not row.round_off and math.isfinite(row.error) and abs(row.error) > SAME_AS_ROUNDING:
            groups.setdefault((row.family, row.case, row.quantity), []).append(row)
    return [_curve(group) for group in groups.values()]


def _curve(group: list[Row]) -> Curve:
    """The curve of one quantity's rows, coarse to fine."""
    last = group[-1]
    return Curve(
        last.family, last.case, last.mechanics, last.quantity,
        sizes=tuple(row.size for row in group), errors=tuple(abs(row.error) for row in group),
        gates=tuple(row.gate for row in group), walls_s=tuple(row.wall_s for row in group),
        passed=tuple(row.passed for row in group), order=last.order if len(group) > 1 else None, judged=not last.no_order,
    )  # fmt: skip


def convergence_figure(ladder: Ladder, family: str) -> ConvergenceFigure | None:
    """What the chart of a family shows; None where every error is round-off or missing."""
    rows = [row for row in ladder.rows if row.family == family]
    curves = curves_of(rows)
    if not curves:
        return None
    cases = dict.fromkeys((curve.case, curve.mechanics) for curve in curves)
    panels = tuple(
        Panel(case_words(case, mechanics), tuple(one for one in curves if one.case == case), unit_of(rows, case))
        for case, mechanics in cases
    )
    every = {(row.case, row.quantity) for row in rows}
    return ConvergenceFigure(
        title=convergence_words(curves),
        panels=panels,
        quantities=tuple(dict.fromkeys(curve.quantity for curve in curves)),
        left_out=len(every) - len(curves),
    )


def case_words(case: str, mechanics: str) -> str:
    """A case's name in words with its mechanics, unless the name has it."""
    return plain(case) if mechanics in case.split("_") else f"{plain(case)}, {mechanics_name(mechanics)}"


def unit_of(rows: Sequence[Row], case: str) -> str:
    """The unit that the labels of a case's levels have their size in, or nothing."""
    units = {found[1] for row in rows if row.case == case and (found := UNIT.search(row.level))}
    return units.pop() if len(units) == 1 else ""


def convergence_words(curves: Sequence[Curve]) -> str:
    """What became of the errors of some quantities from the coarsest to the finest level, in a sentence."""
    finest = [curve.errors[-1] for curve in curves]
    orders = [curve.order for curve in curves if curve.judged and curve.order is not None]
    worst = max(curves, key=lambda curve: curve.errors[-1])
    where = f"{share(max(finest))} ({worst.quantity}, {plain(worst.case)})"
    told = f"Errors {f'from {share(min(finest))} to {where}' if len(finest) > 1 else f'of {where}'} at the finest level"
    if not orders:
        return f"{told}; none is judged by its order"
    lowest, highest = min(orders), max(orders)
    spread = " to ".join(dict.fromkeys((order_words(lowest), order_words(highest))))
    which = f"{len(orders)} of {len(curves)} are judged by their order, " if len(orders) < len(curves) else "orders "
    return f"{told}; {which}{spread} between the finest two levels"


def order_words(order: float) -> str:
    """An order with one decimal."""
    return f"{round(order, 1) + 0.0:.1f}".replace("-", "−")


def cost_figure(ladder: Ladder) -> CostFigure | None:
    """What the chart of error against cost shows; None where there is nothing to draw."""
    curves = [case for case in worst_of(curves_of(ladder.rows)) if all(wall > 0.0 for wall in case.walls_s)]
    mechanics = tuple(name for name in ("quasistatic", "explicit") if any(curve.mechanics == name for curve in curves))
    if not curves:
        return None
    families = dict.fromkeys(curve.family for curve in curves)
    panels = tuple(Panel(plain(name), tuple(curve for curve in curves if curve.family == name)) for name in families)
    return CostFigure(cost_words(curves, mechanics), panels, mechanics)


def worst_of(curves: Sequence[Curve]) -> list[Curve]:
    """A curve a case: the largest error among its quantities at each size; it passes where all of them do."""
    groups: dict[tuple[str, str], dict[float, list[tuple[Curve, int]]]] = {}
    for curve in curves:
        for index, size in enumerate(curve.sizes):
            groups.setdefault((curve.family, curve.case), {}).setdefault(size, []).append((curve, index))
    found = []
    for sizes in groups.values():
        first = next(iter(sizes.values()))[0][0]
        order = sorted(sizes, reverse=True)
        found.append(replace(
            first, quantity="", order=None, sizes=tuple(order), gates=(),
            errors=tuple(max(curve.errors[k] for curve, k in sizes[size]) for size in order),
            walls_s=tuple(max(curve.walls_s[k] for curve, k in sizes[size]) for size in order),
            passed=tuple(all(curve.passed[k] for curve, k in sizes[size]) for size in order),
        ))  # fmt: skip
    return found


def cost_words(curves: Sequence[Curve], mechanics: Sequence[str]) -> str:
    """How long it takes each mechanics to come within a percent in all that a case measures, in a sentence."""
    told = []
    for name in mechanics:
        own = [curve for curve in curves if curve.mechanics == name]
        first = [time for curve in own if (time := first_within(curve, ONE_PERCENT)) is not None]
        time = f" in {number(statistics.median(first), 2)}\u00a0s (median)" if first else ""
        told.append(f"{len(first)} of {len(own)} {mechanics_name(name)} cases{time}")
    return f"Within 1\u00a0% in all that they measure: {listed(told)}"


def first_within(curve: Curve, error: float) -> float | None:
    """The least wall time (s) of a level at which a curve is within an error, or None."""
    times = [wall for wall, off in zip(curve.walls_s, curve.errors) if off <= error]
    return min(times) if times else None
