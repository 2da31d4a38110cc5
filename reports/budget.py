"""The part of the page of verification on error budgets: what ci/budget found, as tables and tornado charts."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from reports.charts.parts import draw_budget
from reports.figures import Figure, Section, Table, words_of
from reports.shown import Shown
from reports.words import NONE, amount, base_words, experiment_name, listed, mechanics_name, minus, plain, small_unit

_BESIDE = "beside"  # the group of a mesh factor that also changes the increment, which is shown, but in no sum


def section(runs: Path) -> Section | None:
    """The part of the page, from every file below runs/budget; None where there is none."""
    contents = [json.loads(path.read_text(encoding="utf-8")) for path in sorted((runs / "budget").glob("*.json"))]
    if not contents:
        return None
    figures, tables, lost = [], [], 0
    for content in contents:
        data = budget_figure(content["experiment"], [one for one in content["budgets"] if one["status"] == "completed"])
        if data.variants:
            figures.append(Figure(f"budget_{content['experiment']}", data, draw_budget, "budget"))
        for budget in content["budgets"]:
            tables.append(budget_table(content["experiment"], budget, content.get("settings", [])))
            lost += sum(one["status"] != "completed" for line in budget["lines"] for one in line["tried"])
    return Section(title="Error budgets of the experiments", intro=words_of("budget_method", lost=lost), figures=figures, tables=tables)


def _effect(tried: dict[str, Any], quantity: str) -> float | None:
    """An alternative's effect on a quantity, None where it says nothing."""
    return (tried["effects"].get(quantity) or {"value": None})["value"]


def _size(line: dict[str, Any], quantity: str) -> float | None:
    """A factor's largest effect on a quantity."""
    return max((abs(value) for one in line["tried"] if (value := _effect(one, quantity)) is not None), default=None)


def budget_figure(experiment: str, budgets: list[dict[str, Any]]) -> Shown:
    """What is drawn of an experiment, a row a variant, a column a quantity; those that nothing moves are left to the table."""
    variants = []
    for budget in budgets:
        moved = [item for item in budget["quantities"] if any((_size(line, item[0]) or 0.0) > 0.0 for line in budget["lines"])]
        panels = [Shown(heading=label, unit=small_unit(unit), rows=_rows(budget["lines"], name, 1e-3 if unit == "Pa" else 1.0))
                  for name, label, unit in moved]
        if panels:
            variants.append((f"{plain(budget['variant'])}, {mechanics_name(budget['mechanics'])}", panels))
    return Shown(title=_finding(experiment, budgets), variants=variants)


def _rows(lines: list[dict[str, Any]], quantity: str, factor: float) -> list[Shown]:
    """The factors of a quantity, the largest first, those that say nothing last; a bar an alternative."""

    def bar(one: dict[str, Any]) -> Shown:
        """The effect of an alternative."""
        value = _effect(one, quantity)
        return Shown(label=one["label"], value=None if value is None else factor * value)

    sizes = [(-1.0 if (size := _size(line, quantity)) is None else size, line) for line in lines if line["tried"]]
    ordered = sorted(sizes, key=lambda pair: -pair[0])
    return [Shown(label=line["label"], group=line["group"], bars=list(map(bar, line["tried"]))) for _, line in ordered]


def dominant(budget: dict[str, Any], quantity: str, group: str = "") -> tuple[str, float] | None:
    """The factor (of a group, if one is named) that moves a quantity most, with its effect."""
    sizes = [(line["label"], size) for line in budget["lines"]
             if line["group"] != _BESIDE and group in ("", line["group"]) and (size := _size(line, quantity)) is not None]
    return max(sizes, key=lambda item: item[1], default=None)


def _finding(experiment: str, budgets: list[dict[str, Any]]) -> str:
    """Which factors dominate the pressures of an experiment."""
    tops: dict[str, list[str]] = {}
    numerical = []
    for budget in budgets:
        for name, label, _ in (item for item in budget["quantities"] if item[2] == "Pa"):
            top, inner = dominant(budget, name), dominant(budget, name, "numerical")
            if top is not None:
                tops.setdefault(top[0], []).append(label)
            if inner is not None:
                numerical.append((inner[1], inner[0], f"{label}, {plain(budget['variant'])}"))
    parts = [f"{factor} moves the {listed(list(dict.fromkeys(labels)))} most" for factor, labels in tops.items()]
    largest = max(numerical, default=None)
    told = f"; the largest numerical effect is that of the {largest[1]}, {largest[0] / 1e3:.3g} kPa ({largest[2]})" if largest else ""
    way = max((top for budget in budgets if (top := dominant(budget, "path_m")) is not None), key=lambda item: item[1], default=None)
    aside = f"; the {way[0]} moves the path most, by up to {way[1]:.2g} m" if way else ""
    return f"{experiment_name(experiment)}: {', '.join(parts) if parts else 'no complete run'}{told}{aside}"


def budget_table(experiment: str, budget: dict[str, Any], settings: Sequence[str]) -> Table:
    """One variant's budget."""
    title = f"{experiment_name(experiment)}, {plain(budget['variant'])}, {mechanics_name(budget['mechanics'])}"
    if budget["status"] != "completed":
        return Table(title=title, header=["base run"], rows=[[f"{budget['status']}: {budget['reason']}"]], marked=[0])
    quantities = budget["quantities"]
    header = ["factor", "varied to", *(f"{label} ({small_unit(unit)})" for _, label, unit in quantities), "run"]
    rows = [["as the scene says", "", *(base_words(budget["base"].get(name), unit) for name, _, unit in quantities), ""]]
    marked, lost = [], []
    for line in budget["lines"]:
        for one in line["tried"]:
            if one["status"] != "completed":
                marked.append(len(rows))
                lost.append(f"{line['label']}, {one['label']}: {one['reason'].rstrip('.')}.")
            cells = [_effect_words(one["effects"].get(name), unit, budget["base"].get(name)) for name, _, unit in quantities]
            rows.append([line["label"], one["label"], *cells, one["status"]])
        if line["why_not"]:
            rows.append([line["label"], line["why_not"], *(NONE for _ in quantities), ""])
    for group, words in (("numerical", "numerical factors"), ("all", "all factors")):
        for key, kind in (("rss", "root of squares"), ("sum", "plain sum")):
            rows.append([words, kind, *(amount(budget["totals"][name][group][key], unit, "") for name, _, unit in quantities), ""])
    common = [f"All with {listed(settings)}."] if settings else []
    return Table(title=title, header=header, rows=rows, marked=marked, note=" ".join([*common, *lost]))


def _effect_words(effect: dict[str, Any] | None, unit: str, base: float | None) -> str:
    """An effect with its share of the base, or why there is none."""
    if effect is None or effect["value"] is None:
        return (effect or {}).get("note") or NONE
    share = minus(f" ({100.0 * effect['value'] / base:+.2f}\u00a0%)") if base else ""
    return f"{amount(effect['value'], unit)}{share}" + (f", {effect['note']}" if effect["note"] else "")
