"""The part of the page of verification on error budgets: what ci/budget found, as tables and tornado charts."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from reports.charts.budget_chart import draw_budget
from reports.sections import Picture, Section, Table, put_figure
from reports.words import experiment_name, listed, mechanics_name, plain

METHOD = (
    "Each factor is varied alone from what the scene says. Numerical factors are the method's: cells, flow or time step, J ring, particles a"
    " cell; the others are choices of the model: increment of growth, size of the block, loading rate. A factor counts with the largest of its"
    " effects. The root of the sum of squares is what the factors owe together if they act independently; the plain sum is the bound if all push"
    " one way. A factor whose run failed says nothing and is named below its table; it is not counted as no effect."
)

# A mesh factor that also changes the increment is shown, but in no sum.
_BESIDE = "beside"


@dataclass(frozen=True)
class Bar:
    """The effect of an alternative, None where it says nothing."""

    label: str
    value: float | None


@dataclass(frozen=True)
class BudgetRow:
    """A factor with its bars."""

    label: str
    group: str
    bars: tuple[Bar, ...]


@dataclass(frozen=True)
class BudgetPanel:
    """One quantity of one variant: its unit, and a row a factor."""

    heading: str
    unit: str
    rows: tuple[BudgetRow, ...]


@dataclass(frozen=True)
class BudgetFigure:
    """Panels of an experiment: a row a variant, a column a quantity; the title is the finding."""

    title: str
    variants: tuple[tuple[str, tuple[BudgetPanel, ...]], ...]


def section(runs: Path, out: Path) -> Section | None:
    """The part of the page, from every file below runs/budget; None where there is none."""
    contents = [json.loads(path.read_text(encoding="utf-8")) for path in sorted((runs / "budget").glob("*.json"))]
    if not contents:
        return None
    figures, tables, lost = [], [], 0
    for content in contents:
        complete = [one for one in content["budgets"] if one["status"] == "completed"]
        figure = budget_figure(content["experiment"], complete)
        if figure.variants:
            figures.append(_picture(figure, content["experiment"], out))
        for budget in content["budgets"]:
            tables.append(budget_table(content["experiment"], budget, content.get("settings", [])))
            lost += sum(one["status"] != "completed" for line in budget["lines"] for one in line["tried"])
    failed = f" {lost} of their runs failed or {'was' if lost == 1 else 'were'} refused." if lost else " All their runs are complete."
    return Section(title="Error budgets of the experiments", intro=METHOD + failed, figures=figures, tables=tables)


def _effect(tried: dict[str, Any], quantity: str) -> float | None:
    """An alternative's effect on a quantity, None where it says nothing."""
    found = tried["effects"].get(quantity)
    return None if found is None else found["value"]


def _size(line: dict[str, Any], quantity: str) -> float | None:
    """A factor's largest effect on a quantity."""
    known = [abs(value) for one in line["tried"] if (value := _effect(one, quantity)) is not None]
    return max(known, default=None)


def budget_figure(experiment: str, budgets: list[dict[str, Any]]) -> BudgetFigure:
    """What is drawn of an experiment: quantities that nothing moves are left to the table."""
    variants = []
    for budget in budgets:
        moved = [item for item in budget["quantities"] if any((_size(line, item[0]) or 0.0) > 0.0 for line in budget["lines"])]
        panels = tuple(BudgetPanel(label, "kPa" if unit == "Pa" else unit, _rows(budget["lines"], name, 1e-3 if unit == "Pa" else 1.0))
                       for name, label, unit in moved)  # fmt: skip
        if panels:
            variants.append((f"{plain(budget['variant'])}, {mechanics_name(budget['mechanics'])}", panels))
    return BudgetFigure(_finding(experiment, budgets), tuple(variants))


def _rows(lines: list[dict[str, Any]], quantity: str, factor: float) -> tuple[BudgetRow, ...]:
    """The factors of a quantity, the largest first, those that say nothing last."""
    applied = [line for line in lines if line["tried"]]
    ordered = sorted(applied, key=lambda line: -(_size(line, quantity) if _size(line, quantity) is not None else -1.0))
    return tuple(
        BudgetRow(line["label"], line["group"], tuple(
            Bar(one["label"], None if (value := _effect(one, quantity)) is None else factor * value) for one in line["tried"]))
        for line in ordered
    )


def dominant(budget: dict[str, Any], quantity: str, group: str = "") -> tuple[str, float] | None:
    """The factor (of a group, if one is named) that moves a quantity most, with its effect."""
    sizes = [(line["label"], size) for line in budget["lines"]
             if line["group"] != _BESIDE and group in ("", line["group"]) and (size := _size(line, quantity)) is not None]  # fmt: skip
    return max(sizes, key=lambda item: item[1], default=None)


def _finding(experiment: str, budgets: list[dict[str, Any]]) -> str:
    """Which factors dominate the pressures of an experiment."""
    tops: dict[str, list[str]] = {}
    numerical = []
    for budget in budgets:
        for name, label, unit in budget["quantities"]:
            top, inner = dominant(budget, name), dominant(budget, name, "numerical")
            if unit == "Pa" and top is not None:
                tops.setdefault(top[0], []).append(label)
            if unit == "Pa" and inner is not None:
                numerical.append((inner[1], inner[0], f"{label}, {plain(budget['variant'])}"))
    parts = [f"{factor} moves the {listed(list(dict.fromkeys(labels)))} most" for factor, labels in tops.items()]
    largest = max(numerical, default=None)
    told = f"; the largest numerical effect is that of the {largest[1]}, {largest[0] / 1e3:.3g} kPa ({largest[2]})" if largest else ""
    paths = [top for budget in budgets if (top := dominant(budget, "path_m")) is not None]
    way = max(paths, key=lambda item: item[1], default=None)
    aside = f"; the {way[0]} moves the path most, by up to {way[1]:.2g} m" if way else ""
    return f"{experiment_name(experiment)}: {', '.join(parts) if parts else 'no complete run'}{told}{aside}"


def _picture(figure: BudgetFigure, experiment: str, out: Path) -> Picture:
    """Draw an experiment's figure."""
    caption = (
        "What each factor, varied alone, moves: a row a variant, a panel a quantity with its own scale, the factors from largest to smallest."
        " Bars of a factor are its alternatives, as the table has them, the first one above. Blue: numerical factors; ochre: choices of the"
        " model; grey: shown beside, in no sum. A cross stands for an alternative whose run says nothing of the quantity."
    )
    return put_figure(draw_budget(figure), out, f"budget_{experiment}", figure.title, caption)


def budget_table(experiment: str, budget: dict[str, Any], settings: list[str]) -> Table:
    """One variant's budget."""
    title = f"{experiment_name(experiment)}, {plain(budget['variant'])}, {mechanics_name(budget['mechanics'])}"
    if budget["status"] != "completed":
        return Table(title=title, header=["base run"], rows=[[f"{budget['status']}: {budget['reason']}"]], marked=[0])
    quantities = budget["quantities"]
    header = ["factor", "varied to", *(f"{label} ({'kPa' if unit == 'Pa' else unit})" for _, label, unit in quantities), "run"]
    rows = [["as the scene says", "", *(_base(budget["base"].get(name), unit) for name, _, unit in quantities), ""]]
    marked, lost = [], []
    for line in budget["lines"]:
        for one in line["tried"]:
            if one["status"] != "completed":
                marked.append(len(rows))
                lost.append(f"{line['label']}, {one['label']}: {one['reason'].rstrip('.')}.")
            cells = [_effect_words(one["effects"].get(name), unit, budget["base"].get(name)) for name, _, unit in quantities]
            rows.append([line["label"], one["label"], *cells, one["status"]])
        if line["why_not"]:
            rows.append([line["label"], line["why_not"], *("–" for _ in quantities), ""])
    for group, words in (("numerical", "numerical factors"), ("all", "all factors")):
        for key, kind in (("rss", "root of squares"), ("sum", "plain sum")):
            cells = [_amount(budget["totals"][name][group][key], unit, "") for name, _, unit in quantities]
            rows.append([words, kind, *cells, ""])
    common = [f"All with {listed(settings)}."] if settings else []
    return Table(title=title, header=header, rows=rows, marked=marked, note=" ".join([*common, *lost]))


def _base(value: float | None, unit: str) -> str:
    """A value of the base; pressures in MPa, said so."""
    if value is None:
        return "–"
    return f"{value / 1e6:.4f}\u00a0MPa" if unit == "Pa" else f"{value:.4g}\u00a0{unit}"


def _effect_words(effect: dict[str, Any] | None, unit: str, base: float | None) -> str:
    """An effect with its share of the base, or why there is none."""
    if effect is None or effect["value"] is None:
        return effect["note"] if effect and effect["note"] else "–"
    share = f" ({100.0 * effect['value'] / base:+.2f}\u00a0%)".replace("-", "−") if base else ""
    note = f", {effect['note']}" if effect["note"] else ""
    return f"{_amount(effect['value'], unit, '+')}{share}{note}"


def _amount(value: float, unit: str, sign: str) -> str:
    """A difference in kPa or its own unit."""
    return (f"{value / 1e3:{sign}.2f}" if unit == "Pa" else f"{value:{sign}.3f}").replace("-", "−")
