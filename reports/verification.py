"""The page of verification: the accuracy ladder, then the parts that other modules fill.

A module that fills a part has `section(runs: Path, out: Path) -> Section | None`, where Section is

    {"title": str, "intro": str,
     "figures": [{"name": str, "title": str, "caption": str}, ...],      # as reports.sections.put_figure returns them
     "tables": [{"title": str, "header": [str, ...], "rows": [[str, ...], ...], "marked": [int, ...], "note": str}, ...]}

(`marked`, the rows that fall short, and `note` may be left out); see `reports/sections.py`. None: nothing was run.
"""

from __future__ import annotations

import importlib
import math
import traceback
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2

from reports.charts.ladder_chart import draw_convergence, draw_cost
from reports.ladder import Ladder, Row, case_words, convergence_figure, convergence_words, cost_figure, curves_of, load_ladder
from reports.sections import Picture, Section, put_figure
from reports.words import number, plain, scientific, share

# Modules of reports/ that fill parts of the page, in its order; one that is not there is left out.
PARTS: tuple[str, ...] = ("ablation", "path_check", "refinement", "budget", "benchmarks")
NAME = "verification.html"
LADDER = Path("ladder") / "ladder.json"
_COST_CAPTION = (
    "Largest relative error among the quantities of a case (but those that hold to round-off) against the wall time of the run,"
    " a line a case from its coarsest to its finest level, a panel a family. Dashed: 1\u00a0%. Runs were made side by side, so"
    " that times tell sizes rather than speeds."
)


@dataclass(frozen=True)
class Family:
    """A family on the page: what it says, its chart (None where all is round-off), a block of table rows a case.

    exact: the blocks of cases of which everything holds to round-off as it should, which the page folds away;
    reasons: why no order is to be expected, which the tables refer to by their numbers.
    """

    name: str
    title: str
    says: str
    finding: str
    figure: Picture | None
    blocks: list[dict[str, Any]]
    exact: list[dict[str, Any]]
    reasons: list[str]
    comparisons: int
    wrong: int


@dataclass(frozen=True)
class Page:
    """Where the page was written, and the defects met on the way."""

    path: Path
    defects: list[str]
    headline: str


def write_verification(runs: Path, out: Path, ladder_file: Path | None = None, with_index: bool = False) -> Page | None:
    """Write verification.html from ladder.json and whatever the parts find below `runs`; None where there is nothing at all.

    with_index: index.html is about to be written beside it.
    """
    parts, defects = _parts(runs, out)
    shown: dict[str, Any] = {"families": [], "ladder": None, "headline": headline(None)}
    try:
        ladder = load_ladder(ladder_file or runs / LADDER)
        if ladder is not None:
            shown |= {**ladder_context(ladder, out), "headline": headline(ladder)}
    except Exception:  # a torn file must not cost the reader the other parts
        defects.append(traceback.format_exc())
        shown["headline"] = "The accuracy ladder's judgement could not be read."
    if shown["ladder"] is None and not parts and not defects:
        return None
    out.mkdir(parents=True, exist_ok=True)
    words = [defect.strip().splitlines()[-1] for defect in defects]
    content = {**shown, "parts": parts, "defects": words, "index": with_index or (out / "index.html").is_file()}
    loader = jinja2.FileSystemLoader(Path(__file__).parent / "templates")
    environment = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True)
    path = out / NAME
    path.write_text(environment.get_template("verification.html").render(content), encoding="utf-8")
    return Page(path, defects, shown["headline"])


def _parts(runs: Path, out: Path) -> tuple[list[Section], list[str]]:
    """What the other modules have for the page, and the traces of those that broke."""
    sections, defects = [], []
    for name in PARTS:
        try:
            module = importlib.import_module(f"reports.{name}")
        except ModuleNotFoundError as error:
            if error.name != f"reports.{name}":
                defects.append(traceback.format_exc())
            continue
        try:
            found = module.section(runs, out)
        except Exception:  # a defect in one part must not cost the reader all the others
            defects.append(traceback.format_exc())
            continue
        if found is not None:
            sections.append(found)
    return sections, defects


def headline(ladder: Ladder | None) -> str:
    """What the ladder found, in a sentence or two."""
    if ladder is None:
        return "The accuracy ladder has not been run: ci/verify does."
    rows = ladder.rows
    wrong = sum(not row.passed for row in rows)
    cases, families = len({(row.family, row.case) for row in rows}), len({row.family for row in rows})
    of_what = f"{len(rows)} comparisons with references ({_counted(cases, 'case')} in {_counted(families, 'family')})"
    if not rows:
        return "No case of the accuracy ladder has been run."
    if wrong == 0:
        return f"All {of_what} are within their gates."
    return f"Of {of_what}, {wrong} {'is' if wrong == 1 else 'are'} not as {'its gate asks' if wrong == 1 else 'their gates ask'}."


def _counted(count: int, word: str) -> str:
    """A count with its word."""
    return f"{count} {word if count == 1 else word[:-1] + 'ies' if word.endswith('y') else word + 's'}"


def ladder_context(ladder: Ladder, out: Path) -> dict[str, Any]:
    """What the template shows of the ladder; its figures are written below `out`."""
    cost, picture = cost_figure(ladder), None
    if cost is not None:
        picture = put_figure(draw_cost(cost), out, "ladder_cost", cost.title, _COST_CAPTION)
    return {
        "ladder": ladder,
        "mutation": _mutation_words(ladder),
        "cost": picture,
        "families": [_family(ladder, name, out) for name in ladder.families],
        "wrong": [
            {"name": f"{row.family} / {row.case}: {row.quantity} at {row.level}", "why": row.why, "verdict": row.verdict}
            for row in ladder.rows if not row.passed
        ],
    }


def _mutation_words(ladder: Ladder) -> str:
    """How the gates themselves were tried."""
    tally = ladder.tally
    left = int(tally["mutants"]) - int(tally["refused"])
    ending = "all were refused" if left == 0 else f"{left} passed, which makes their comparisons fail"
    return (
        f"Each of the {tally['gates']} gates was tried with results that are plainly wrong (zero, twice the value, its sign"
        f" flipped, half an order of convergence lost), {tally['mutants']} in all: {ending}."
    )


def _family(ladder: Ladder, name: str, out: Path) -> Family:
    """A family's figure and tables."""
    rows = [row for row in ladder.rows if row.family == name]
    data, picture = convergence_figure(ladder, name), None
    if data is not None:
        picture = put_figure(draw_convergence(data), out, f"ladder_{name}", data.title, _convergence_caption(data.left_out))
    curves = curves_of(rows)
    reasons = list(dict.fromkeys(row.no_order for row in rows if row.no_order))
    blocks: dict[bool, list[dict[str, Any]]] = {True: [], False: []}
    for case in dict.fromkeys(row.case for row in rows):
        own = [row for row in rows if row.case == case]
        blocks[all(row.round_off and row.passed for row in own)].append(_block(ladder, own, reasons))
    return Family(
        name=name,
        title=plain(name)[:1].upper() + plain(name)[1:],
        says=sentence(ladder.families[name]),
        finding=convergence_words(curves) if curves else "Everything holds to round-off" if rows else "Nothing was run",
        figure=picture,
        blocks=blocks[False],
        exact=blocks[True],
        reasons=reasons,
        comparisons=len(rows),
        wrong=sum(not row.passed for row in rows),
    )


def _convergence_caption(left_out: int) -> str:
    """Caption of a family's chart."""
    lack = ""
    if left_out:
        which = "quantity that holds" if left_out == 1 else "quantities that hold"
        lack = f" {left_out} {which} to round-off, or could not be measured, {'is' if left_out == 1 else 'are'} left out."
    return (
        "Relative error against size, logarithmic, a panel a case; finer to the left. Beside each curve its observed order"
        " between the finest two levels, the curve dashed and without one where no order is to be expected (the table says why)."
        f" Short dashes: what the gate allows. Triangles: orders 1 and 2.{lack}"
    )


def _block(ladder: Ladder, rows: list[Row], reasons: list[str]) -> dict[str, Any]:
    """A case's part of the table: its quantities, each with its levels."""
    first = rows[0]
    quantities = []
    for quantity in dict.fromkeys(row.quantity for row in rows):
        own = [row for row in rows if row.quantity == quantity]
        quantities.append(
            {
                "name": quantity, "unit": own[0].unit, "count": _count_words(own), "reasons": _reasons(own, reasons),
                "scale": _scale_words(own), "levels": [line(row) for row in own],
                "height": len(own) + sum(bool(row.why or row.note) for row in own),
            }  # fmt: skip
        )
    return {
        "name": case_words(first.case, first.mechanics),
        "says": sentence(ladder.cases[first.family, first.case]),
        "comparisons": len(rows),
        "quantities": quantities,
    }


def sentence(words: str) -> str:
    """Words with a capital and a full stop."""
    return f"{words[:1].upper()}{words[1:].rstrip('.')}." if words else ""


def _count_words(rows: list[Row]) -> str:
    """How many values there are at each level, where there is more than one."""
    counts = list(dict.fromkeys(row.values for row in rows if row.values > 0))
    if not counts or max(counts) == 1:
        return ""
    return f"rms of {' / '.join(map(str, counts))} values"


def _scale_words(rows: list[Row]) -> str:
    """What errors are relative to where it is not the reference itself."""
    scales = list(dict.fromkeys(number(row.scale, 3) for row in rows if row.scale is not None))
    return f"errors relative to {' / '.join(scales)} {rows[0].unit}".rstrip() if scales else ""


def _reasons(rows: list[Row], reasons: list[str]) -> list[tuple[int, str]]:
    """The numbers of the reasons why no order is expected, with the levels where that is not so of all."""
    told = []
    for index, reason in enumerate(reasons, 1):
        levels = [row.level for row in rows if row.no_order == reason]
        if levels:
            told.append((index, "" if len(levels) == len(rows) else f" at {', '.join(levels)}"))
    return told


def line(row: Row) -> dict[str, Any]:
    """A level's cells."""
    order = "–" if row.order is None else f"{round(row.order, 2) + 0.0:.2f}".replace("-", "−")
    gate = "none" if math.isnan(row.gate) else relative(row.gate)
    return {
        "level": row.level,
        "value": _value(row.value), "reference": _value(row.reference),
        "own": relative(row.reference_error) if row.reference_error > 0.0 else "",
        "own_matters": row.reference_error > abs(row.error) / 3.0,
        "error": relative(row.error, signed=row.values == 1),
        "order": f"({order})" if row.no_order and row.order is not None else order,
        "gate": gate, "order_gate": "" if row.order_gate is None else f"≥ {row.order_gate:g}",
        "wall": "–" if math.isnan(row.wall_s) else f"{row.wall_s:.1f}" if row.wall_s >= 0.1 else f"{row.wall_s:.2g}",
        "particles": _thousands(row.particles), "steps": _thousands(row.steps),
        "memory": "–" if math.isnan(row.memory_MB) else f"{row.memory_MB:.0f}",
        "verdict": row.verdict, "passed": row.passed, "why": row.why, "note": row.note,
    }  # fmt: skip


def relative(error: float, signed: bool = False) -> str:
    """A relative error: in per cent, or below 1e-6 as a power of ten."""
    if math.isnan(error):
        return "–"
    sign = "+" if signed and error > 0.0 else ""
    if error == 0.0:
        return "0"
    if abs(error) >= 1e-6:
        return sign + share(error)
    return sign + scientific(error, 2)


def _value(value: float) -> str:
    """A value with six digits."""
    return "–" if math.isnan(value) else number(value, 6)


def _thousands(count: int) -> str:
    """A count with thin spaces between thousands."""
    return f"{count:,}".replace(",", "\u202f")
