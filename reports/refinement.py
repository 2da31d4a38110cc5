"""The part of the page of verification on mesh refinement of the experiments: what ci/refine found, as tables and charts."""

import json
import statistics
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from reports.charts.parts import draw_refinement
from reports.figures import Figure, Section, Table, words_of
from reports.shown import Shown
from reports.words import NONE, experiment_name, listed, mechanics_name, plain

# Quantities that have a panel each, in this order; of the pressures at heights one in the middle and the last stand between.
_BEFORE, _AFTER = ("start_Pa", "restart_1_Pa", "restart_2_Pa", "plateau_1_Pa"), ("deflection_m", "final_angle_deg", "path_to_next_m")
_STILL = ("still", "settled")  # what refinement does not move any more
_GOOD = ("clean", *_STILL)  # a row that has one of these needs no excuse


def section(runs: Path) -> Section | None:
    """The part of the page, from every refine.json below runs/refine; None where there is none."""
    contents = [json.loads(path.read_text(encoding="utf-8")) for path in sorted((runs / "refine").glob("*/refine.json"))]
    if not contents:
        return None
    figures, tables, counted = [], [], []
    for content in contents:
        for mechanics in dict.fromkeys(study["mechanics"] for study in content["studies"]):
            own = [study for study in content["studies"] if study["mechanics"] == mechanics]
            counted += [row for _, row in judged(own)]
            data = refinement_figure(content["experiment"], own)
            if data.panels:
                figures.append(Figure(f"refine_{content['experiment']}_{mechanics}", data, draw_refinement, "refinement"))
            tables.append(refinement_table(content["experiment"], own, content.get("settings", [])))
    return Section(title="Mesh refinement of the experiments", intro=f"{words_of('refinement_method')} {_intro(counted)}", figures=figures,
                   tables=tables)


def judged(studies: Sequence[dict[str, Any]]) -> list[tuple[str, dict[str, Any]]]:
    """The rows of studies that ask for an order, each with its variant."""
    return [(study["variant"], row) for study in studies for row in study["rows"] if row["estimate"]["kind"] != "beside"]


def _sizes(studies: Sequence[dict[str, Any]]) -> list[float]:
    """The cell sizes of studies, coarse to fine, m."""
    return sorted({level["cell_m"] for study in studies for level in study["levels"]}, reverse=True)


def _lost(studies: Sequence[dict[str, Any]]) -> list[tuple[str, dict[str, Any]]]:
    """The runs of studies that are not complete: which in words, and its level."""
    return [(f"{plain(study['variant'])} at {level['cell_m']:g} m", level)
            for study in studies for level in study["levels"] if level["status"] != "completed"]


def _tally(clean: int, still: int) -> str:
    """How many numbers have a limit and how many stand still: two halves of a sentence."""
    return f"{clean} {'has' if clean == 1 else 'have'} a limit%s {still} stand{'s' * (still == 1)} still"


def _intro(rows: list[dict[str, Any]]) -> str:
    """How many numbers have an order, and how many have none."""
    kinds = [row["estimate"]["kind"] for row in rows]
    orders = [row["estimate"]["order"] for row in rows if row["estimate"]["kind"] == "clean"]
    middle = f" (median order {statistics.median(orders):.2g})" if orders else ""
    words = {"oscillates": "oscillating", "diverges": "not converging", "odd order": "of an order that no scheme has",
             "too few": "known at fewer than three sizes"}
    without = listed([f"{kinds.count(kind)} {word}" for kind, word in words.items() if kind in kinds])
    head = f"Of {len(rows)} numbers {_tally(len(orders), sum(kind in _STILL for kind in kinds)) % f'{middle},'}"
    return f"{head}; the others: {without}." if without else f"{head}."


def refinement_figure(experiment: str, studies: list[dict[str, Any]]) -> Shown:
    """What is drawn of the studies of an experiment in one mechanics: a panel a quantity with its unit, a line for each variant."""
    known = {row["name"] for study in studies for row in study["rows"] if sum(value is not None for value in row["values"]) > 1}
    heights = sorted((name for name in known if name.startswith("pressure_at")), key=lambda name: float(name.split("_")[2]))
    some = dict.fromkeys([*heights[len(heights) // 2 : len(heights) // 2 + 1], *heights[-1:]])
    panels = []
    for name in [*(one for one in _BEFORE if one in known), *some, *(one for one in _AFTER if one in known)]:
        rows = [(study, row) for study in studies for row in study["rows"] if row["name"] == name]
        lines = [line for study, row in rows if (line := _line(study, row)) is not None]
        unit = {"Pa": "MPa", "degrees": "°"}.get(rows[0][1]["unit"], rows[0][1]["unit"])
        panels.append(Shown(heading=rows[0][1]["label"], unit=unit, lines=lines))
    return Shown(title=_finding(experiment, studies), variants=[study["variant"] for study in studies], panels=panels,
                 sizes=[f"{size:g}\u00a0m" for size in _sizes(studies)])


def _line(study: dict[str, Any], row: dict[str, Any]) -> Shown | None:
    """A quantity of a variant against (h/h of the coarsest)^order, limit and uncertainty at 0 where that is clean; None of fewer than two values."""
    sizes = [level["cell_m"] for level in study["levels"]]
    known = [(size, value) for size, value in zip(sizes, row["values"]) if value is not None]
    if len(known) < 2:
        return None
    said, factor = row["estimate"], 1e-6 if row["unit"] == "Pa" else 1.0
    order = said["order"] if said["kind"] == "clean" else None
    limit = None
    if order is not None and said["extrapolate"] is not None:
        limit = (factor * said["extrapolate"], factor * said["uncertainty"])
    return Shown(variant=study["variant"], x=tuple((size / max(sizes)) ** (order or 1.0) for size, _ in known),
                 y=tuple(factor * value for _, value in known), limit=limit, order=order)


def _finding(experiment: str, studies: list[dict[str, Any]]) -> str:
    """How many numbers have a limit, and the pressure without one that the mesh still moves most."""
    rows = judged(studies)
    kinds = [row["estimate"]["kind"] for _, row in rows]
    where = f"{experiment_name(experiment)}, {mechanics_name(studies[0]['mechanics'])}"
    head = f"{where}: of {len(rows)} numbers {_tally(kinds.count('clean'), sum(kind in _STILL for kind in kinds)) % ' and'}"
    failed = [which for which, _ in _lost(studies)]
    lost = f"; no complete run of {listed(failed)}" if failed else ""
    open_ = [(row["estimate"]["spread"], variant, row) for variant, row in rows
             if row["unit"] == "Pa" and row["estimate"]["kind"] not in _GOOD and row["estimate"]["spread"] is not None]
    if not open_:
        return head + lost
    spread, variant, row = max(open_, key=lambda item: item[0])
    return f"{head}{lost}; without a limit the mesh moves the {row['label']} ({plain(variant)}) most, by {spread / 1e3:.3g} kPa"


def refinement_table(experiment: str, studies: list[dict[str, Any]], settings: list[str]) -> Table:
    """Every number of an experiment in one mechanics at every size."""
    sizes = _sizes(studies)
    rows, marked = [], []
    for study in studies:
        at = {level["cell_m"]: k for k, level in enumerate(study["levels"])}
        for row in study["rows"]:
            if row["estimate"]["kind"] not in (*_GOOD, "beside"):
                marked.append(len(rows))
            values = [row["values"][at[size]] if size in at else None for size in sizes]
            orders = [f"{item['order']:.2f}" if item["order"] is not None else {"still": "same"}.get(item["kind"], item["kind"])
                      for item in row["estimate"]["triples"]]  # of three sizes, or what they do instead
            rows.append([plain(study["variant"]), f"{row['label']} ({'MPa' if row['unit'] == 'Pa' else row['unit']})",
                         *(_value(value, row["unit"]) for value in values), ", ".join(orders) or NONE, _limit_words(row), "; ".join(row["notes"])])
    increments = listed(sorted({f"{study['increment_m']:g} m" for study in studies}))
    title = f"{experiment_name(experiment)}, {mechanics_name(studies[0]['mechanics'])}, increment {increments}"
    header = ["variant", "number", *(f"{size:g} m" for size in sizes), "orders, coarse to fine", "limit, or why there is none", "notes"]
    told = dict.fromkeys(note for study in studies for note in study.get("notes", ()))
    note = [*([f"All with {listed(settings)}."] if settings else []), *(f"{note[0].upper()}{note[1:]}." for note in told),
            *(f"{which} {level['status']}: {level['reason'].rstrip('.')}." for which, level in _lost(studies))]
    return Table(title=title, header=header, rows=rows, marked=marked, note=" ".join(note))


def _value(value: float | None, unit: str) -> str:
    """A value of the table."""
    return NONE if value is None else f"{value / 1e6:.4f}" if unit == "Pa" else f"{value:.4g}"


def _limit_words(row: dict[str, Any]) -> str:
    """The limit with its uncertainty, or the statement."""
    said, (factor, unit) = row["estimate"], (1e-6, "MPa") if row["unit"] == "Pa" else (1.0, row["unit"])
    if said["kind"] != "clean":
        return str(said["says"])
    uncertainty = f"{factor * said['uncertainty']:.2g} {unit}"
    if said["extrapolate"] is None:
        return f"finest within {uncertainty} of the limit"
    doubt = f" ({said['says'].split('; ', 1)[1]})" if "; " in said["says"] else ""
    return f"{_value(said['extrapolate'], row['unit'])} ± {uncertainty}{doubt}"
