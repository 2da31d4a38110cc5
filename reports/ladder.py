"""The accuracy ladder as plain data, from ladder.json or what was last accepted: what its charts draw, the words of its tables, and the page of verification."""

import json
import math
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from reports.charts.precision import draw_convergence
from reports.figures import Figure, Table, Topic, make, told_of, words_of, write_page
from reports.words import NONE, Shown, counted, mechanics_name, number, order_words, plain, relative, sentence, share, thousands
from verification.harness.front_table import LINES

ROUND_OFF = "round-off"  # as in verification/ladder/gates.py: how the reason of what holds to rounding begins
ROUND_OFF_MOST = 1e-6  # the widest gate of what holds to rounding, as there
SAME_AS_ROUNDING = 1e-13  # errors below it are not drawn
UNIT = re.compile(r"\d (m|s)\b")  # of a level's size, in its label
SIZE = re.compile(r"(?:dt )?([\d.]+) [ms](?:,.*)?")


def load_ladder(path: Path, gates: Path) -> Shown | None:
    """Read ladder.json: rows, families with what they and their cases say, the tally of gates and mutants; without it what was last accepted, and None
    where there is nothing. Raises ValueError where it is not as the ladder leaves it."""
    if not path.is_file():
        return accepted(gates)
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        kept = ("tally", "stale", "part", "machine", "families")
        return Shown(accepted=False, **{key: content[key] for key in kept}, rows=[_row(item) for item in content["rows"]])
    except (KeyError, TypeError) as error:
        raise ValueError(f"{path}: {error}") from error


def accepted(folder: Path) -> Shown | None:
    """What the gates were made of: errors and orders by case, quantity and level, without values and costs; None without gates."""
    rows: list[dict[str, Any]] = []
    unknown = {"mechanics": "", "unit": "", "values": 2, "scale": None, "value": None, "reference": None, "reference_error": 0.0, "cost": None,
               "failure": "", "problems": [], "verdict": "pass"}  # fmt: skip
    for path in sorted(folder.glob("*.json")):
        book = json.loads(path.read_text(encoding="utf-8"))
        for case, quantities in book["cases"].items():
            for quantity, levels in quantities.items():
                for k, (level, gate) in enumerate(levels.items()):
                    found = SIZE.fullmatch(level)
                    why = ROUND_OFF if gate["error"] <= ROUND_OFF_MOST else "" if gate.get("order") is not None else "not judged"
                    rows.append({**unknown, "family": book["family"], "case": case, "quantity": quantity, "level": level, "gate": gate, "no_order": why,
                                 "size": float(found[1]) if found else 0.5**k, "error": gate["measured"], "order": gate.get("measured_order")})  # fmt: skip
    cases = dict.fromkeys((row["family"], row["case"]) for row in rows)
    families = [{"name": name, "says": "", "cases": [{"name": case, "says": ""} for family, case in cases if family == name]}
                for name in dict.fromkeys(name for name, _ in cases)]
    return Shown(accepted=True, tally=None, stale=[], part=False, machine="", families=families, rows=list(map(_row, rows))) if rows else None


def topic(ladder: Shown | None) -> Topic | None:
    """The section of the front page: the comparisons that README.md names as well, errors from coarse to fine."""
    if ladder is None:
        return None
    error = {(row.case, row.quantity, row.level): abs(row.error) for row in ladder.rows}
    rows = [[line.says, line.against.replace("`", ""), ", ".join(f"{share(error[line.case, line.quantity, level])} ({level})" for level in line.levels)]
            for line in LINES if all((line.case, line.quantity, level) in error for level in line.levels)]
    return Topic("accuracy", "How accurate the numbers are", [words_of("accuracy")], "ci/verify", "", page="verification.html",
                 shown=Table("", ["What", "Against", "Error"], rows) if rows else None)


def _row(item: dict[str, Any]) -> Shown:
    """A comparison: a quantity of a case at a level; errors are relative, NaN where nothing was measured."""

    def float_of(value: Any) -> float:
        """A JSON number, NaN for null."""
        return math.nan if value is None else float(value)

    cost, gate, no_order = item["cost"] or {}, item["gate"] or {}, item["no_order"]
    kept = ("family", "case", "mechanics", "quantity", "unit", "level", "no_order", "verdict", "size", "values", "scale", "order")
    return Shown(
        **{name: item[name] for name in kept}, **{name: float_of(item[name]) for name in ("value", "reference", "error", "reference_error")},
        wall_s=float_of(cost.get("wall_s")), particles=int(cost.get("particles", 0)), steps=int(cost.get("steps", 0)),
        memory_MB=float_of(cost.get("peak_memory_MB")), gate=float_of(gate.get("error")), order_gate=gate.get("order"),
        why="; ".join(filter(None, (item["failure"], *item["problems"]))), note=item.get("note", ""), passed=item["verdict"] == "pass",
        round_off=no_order.startswith(ROUND_OFF),
    )


def grouped(rows: Iterable[Shown], key: Callable[[Shown], Any]) -> dict[Any, list[Shown]]:
    """Rows that have the same key, in the order in which keys come."""
    groups: dict[Any, list[Shown]] = {}
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return groups


def curves_of(rows: Sequence[Shown]) -> list[Shown]:
    """A curve for each quantity with an error that is neither round-off nor missing, in the rows' order.

    Errors (without sign) and gates at each size, coarse to fine; `order` of the finest pair; `judged`: whether it is asked for.
    """
    drawn = [row for row in rows if not row.round_off and math.isfinite(row.error) and abs(row.error) > SAME_AS_ROUNDING]
    return [Shown(case=case, mechanics=group[-1].mechanics, quantity=quantity, sizes=tuple(row.size for row in group),
                  errors=tuple(abs(row.error) for row in group), gates=tuple(row.gate for row in group), passed=tuple(row.passed for row in group),
                  order=group[-1].order if len(group) > 1 else None, judged=not group[-1].no_order)
            for (_, case, quantity), group in grouped(drawn, lambda row: (row.family, row.case, row.quantity)).items()]


def convergence_figure(rows: Sequence[Shown]) -> Shown | None:
    """Error against size, a panel a case of a family's rows, `quantities` in the order of their colours; None where all is round-off or missing.

    A panel's unit is that of its sizes: "m" or "s", or nothing where the labels of its levels do not say.
    """
    curves = curves_of(rows)
    if not curves:
        return None
    panels = []
    for (case, mechanics), own in grouped(curves, lambda curve: (curve.case, curve.mechanics)).items():
        units = {found[1] for row in rows if row.case == case and (found := UNIT.search(row.level))}
        panels.append(Shown(heading=case_words(case, mechanics), curves=own, unit=units.pop() if len(units) == 1 else ""))
    return Shown(title=convergence_words(curves), panels=panels, quantities=tuple(dict.fromkeys(curve.quantity for curve in curves)),
                 left_out=len({(row.case, row.quantity) for row in rows}) - len(curves))


def case_words(case: str, mechanics: str) -> str:
    """A case's name in words with its mechanics, unless the name has it."""
    return plain(case) if not mechanics or mechanics in case.split("_") else f"{plain(case)}, {mechanics_name(mechanics)}"


def convergence_words(curves: Sequence[Shown]) -> str:
    """What became of the errors of some quantities from the coarsest to the finest level, in a sentence."""
    orders = [curve.order for curve in curves if curve.judged and curve.order is not None]
    spread = " to ".join(dict.fromkeys((order_words(min(orders)), order_words(max(orders))))) if orders else ""
    return words_of("convergence_finding", curves=sorted(curves[::-1], key=lambda curve: curve.errors[-1]), orders=len(orders), spread=spread)


# --- tables
def family_shown(ladder: Shown, family: dict[str, Any]) -> Shown:
    """A family: what it says, its chart's data (None where all is round-off), and its cases, each with its quantities, each with its levels.

    exact: the cases of which everything holds to round-off as it should, which the page folds away; reasons: why no order is to be expected,
    which the tables refer to by their numbers.
    """
    name, says = family["name"], {case["name"]: case["says"] for case in family["cases"]}
    rows = [row for row in ladder.rows if row.family == name]
    curves, reasons = curves_of(rows), list(dict.fromkeys(row.no_order for row in rows if row.no_order))
    cases = [Shown(name=case_words(case, own[0].mechanics), says=sentence(says[case]), comparisons=len(own),
                   exact=all(row.round_off and row.passed for row in own),
                   quantities=[_quantity(levels, reasons) for levels in grouped(own, lambda row: row.quantity).values()])
             for case, own in grouped(rows, lambda row: row.case).items()]
    return Shown(
        name=name, title=name.upper() if name == "kgd" else plain(name).capitalize(), says=sentence(family["says"]), data=convergence_figure(rows),
        finding=convergence_words(curves) if curves else "Everything holds to round-off" if rows else "Nothing was run",
        blocks=[case for case in cases if not case.exact], exact=[case for case in cases if case.exact], reasons=reasons, comparisons=len(rows),
        wrong=sum(not row.passed for row in rows),
    )


def _quantity(own: list[Shown], reasons: list[str]) -> Shown:
    """A quantity's cells: how many values there are at each level where there is more than one; what errors are relative to where it is not the
    reference itself; the numbers of the reasons why no order is expected, with the levels where that is not so of all; and the levels."""
    counts = list(dict.fromkeys(row.values for row in own if row.values > 0))
    scales = list(dict.fromkeys(number(row.scale, 3) for row in own if row.scale is not None))
    without = [(index, [row.level for row in own if row.no_order == reason]) for index, reason in enumerate(reasons, 1)]
    return Shown(
        name=own[0].quantity, unit=own[0].unit, count=f"rms of {' / '.join(map(str, counts))} values" if max(counts, default=1) > 1 else "",
        reasons=[(index, "" if len(levels) == len(own) else f" at {', '.join(levels)}") for index, levels in without if levels],
        scale=f"errors relative to {' / '.join(scales)} {own[0].unit}".rstrip() if scales else "",
        levels=[(row, cells_of(row)) for row in own], height=len(own) + sum(bool(row.why or row.note) for row in own),
    )


def cells_of(row: Shown) -> list[str]:
    """A level in words: level, value, reference, its own error, error, order, gates of error and order, time, points, steps, memory."""
    order = NONE if row.order is None else order_words(row.order, 2)
    return [
        row.level, *(NONE if math.isnan(one) else number(one, 6) for one in (row.value, row.reference)),
        relative(row.reference_error) if row.reference_error > 0.0 else "", relative(row.error, signed=row.values == 1),
        f"({order})" if row.no_order and row.order is not None else order, "none" if math.isnan(row.gate) else relative(row.gate),
        "" if row.order_gate is None else f"≥ {row.order_gate:g}",
        NONE if math.isnan(row.wall_s) else f"{row.wall_s:.1f}" if row.wall_s >= 0.1 else f"{row.wall_s:.2g}", thousands(row.particles),
        thousands(row.steps), NONE if math.isnan(row.memory_MB) else f"{row.memory_MB:.0f}",
    ]


NAME = "verification.html"


def write_verification(out: Path, ladder_file: Path, gates: Path) -> Shown:
    """Write verification.html from ladder.json, or from what was last accepted; told: its name, headline and defects."""
    return told_of(NAME, lambda: _write(out, load_ladder(ladder_file, gates)), "The accuracy ladder's judgement could not be read")


def _write(out: Path, ladder: Shown | None) -> Shown:
    """The page and its figures."""
    if ladder is None:
        return Shown(lack="neither a judgement of the accuracy ladder nor gates")
    shown = ladder_context(ladder, out)
    write_page(out, NAME, shown)
    return Shown(words=shown["headline"], defect="\n".join(one.figure.defect for one in shown["families"] if one.figure and one.figure.defect))


def headline(ladder: Shown) -> str:
    """What the ladder found, in a sentence or two."""
    rows = ladder.rows
    cases, families = counted(len({(row.family, row.case) for row in rows}), "case"), counted(len({row.family for row in rows}), "family")
    return words_of("ladder", rows=len(rows), cases=cases, families=families, accepted=ladder.accepted, wrong=sum(not row.passed for row in rows))


def ladder_context(ladder: Shown, out: Path) -> dict[str, Any]:
    """What the template shows of the ladder; its figures are written below `out`."""
    families = [family_shown(ladder, family) for family in ladder.families]
    for one in families:
        one.figure = one.data and make(Figure(f"ladder_{one.name}", one.data, draw_convergence, "convergence", f"ci/verify --family {one.name}", narrow=False), out)
    return {"ladder": ladder, "mutation": words_of("mutation", tally=ladder.tally) if ladder.tally else "", "families": families, "headline": headline(ladder),
            "wrong_words": [f"{row.family} / {row.case}: {row.quantity} at {row.level} {row.verdict}: {row.why}" for row in ladder.rows if not row.passed],
            "stale_words": [f"A gate of nothing: {words}" for words in ladder.stale], "rows": [(one.title, one.comparisons, f"{one.finding}.") for one in families]}
