"""The parts of the page of verification on refinement and on error budgets say what is in their files, failures included."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest

from reports import budget, refinement
from reports.figures import make
from reports.make_page import main
from verification.harness.richardson import estimate

SIZES = (2.0, 1.0, 0.5, 0.25)


def a_row(name: str, label: str, unit: str, values: list[float | None], notes: tuple[str, ...] = ()) -> dict[str, Any]:
    """A row of refine.json with the estimate that its values have."""
    known = [(size, value) for size, value in zip(SIZES, values) if value is not None]
    said = asdict(estimate([size for size, _ in known], [value for _, value in known], 40.0 if unit == "Pa" else 1e-6, unit))
    return {"name": name, "label": label, "unit": unit, "values": values, "notes": list(notes), "noise": 40.0, "estimate": said}


def a_study(variant: str, rows: list[dict[str, Any]], failed: int | None = None) -> dict[str, Any]:
    """A study of refine.json; `failed` is the number of the size whose run failed."""
    levels = [{"cell_m": size, "status": "failed" if k == failed else "completed", "reason": "it became a mechanism." if k == failed else ""}
              for k, size in enumerate(SIZES)]
    return {"mechanics": "quasistatic", "variant": variant, "increment_m": 1.0, "levels": levels, "notes": ["at 2 m it lies askew"], "rows": rows}


def write_refined(root: Path) -> Path:
    """A refine.json with a number that converges, one that stands still, one that oscillates and one with a size missing."""
    converges = a_row("start_Pa", "start of growth", "Pa", [2.40e6 + 2.0e4 * h for h in SIZES])
    still = a_row("arrest_1_m", "arrest height", "m", [11.0] * 4)
    oscillates = a_row("restart_1_Pa", "restart pressure", "Pa", [2.6e6, 2.5e6, 2.7e6, 2.63e6], ("2 m: no arrest",))
    missing = a_row("pressure_at_40_Pa", "pressure at 40 m", "Pa", [2.7e6, 2.75e6, 2.77e6, None], ("0.25 m: failed",))
    content = {"experiment": "exp1_single_interface", "settings": [], "versions": ["0"],
               "studies": [a_study("perfect", [converges]), a_study("soft", [converges, still, oscillates, missing], 3)]}
    path = root / "refine" / "exp1_single_interface" / "refine.json"
    path.parent.mkdir(parents=True)
    path.write_text(json.dumps(content), encoding="utf-8")
    return root


def effects(**values: float | None) -> dict[str, Any]:
    """Effects of an alternative."""
    return {name: {"value": value, "note": "" if value is not None else "does not reach 40 m"} for name, value in values.items()}


def write_budget(root: Path) -> Path:
    """A budget: the mesh moves the start, the rate the pressure at 40 m; a ring was refused, what stands beside is largest."""

    def tried(label: str, status: str = "completed", **values: float | None) -> dict[str, Any]:
        """An alternative that was run."""
        return {"label": label, "settings": [], "status": status, "reason": "" if status == "completed" else "unknown key.",
                "effects": effects(**values)}

    lines = [
        {"id": "mesh", "label": "mesh", "group": "numerical", "why_not": "", "tried": [tried("cells of 0.5 m", start_Pa=-2.0e4, high_Pa=1.0e3)]},
        {"id": "both", "label": "mesh and increment", "group": "beside", "why_not": "", "tried": [tried("halves", start_Pa=9.0e5, high_Pa=9.0e5)]},
        {"id": "ring", "label": "J ring", "group": "numerical", "why_not": "", "tried": [tried("3 cells", "refused"), tried("5 cells", "refused")]},
        {"id": "rate", "label": "loading rate", "group": "model", "why_not": "",
         "tried": [tried("half", start_Pa=-1.0e3, high_Pa=-9.0e4), tried("double", start_Pa=2.0e3, high_Pa=None)]},
        {"id": "step", "label": "flow step", "group": "numerical", "why_not": "no flow", "tried": []},
    ]
    total = {"rss": 2.0e4, "sum": 2.2e4, "left_out": ["J ring (3 cells, 5 cells)"]}
    quantities = [["start_Pa", "start of growth", "Pa"], ["high_Pa", "pressure at 40 m", "Pa"]]
    one = {"mechanics": "quasistatic", "variant": "soft", "status": "completed", "reason": "", "base": {"start_Pa": 2.4e6, "high_Pa": 2.8e6},
           "quantities": quantities, "lines": lines, "totals": {name: {"numerical": total, "all": total} for name, _, _ in quantities}}
    broken = {"mechanics": "quasistatic", "variant": "weak", "status": "failed", "reason": "it became a mechanism", "base": {},
              "quantities": [], "lines": [], "totals": {}}
    path = root / "budget" / "exp1_single_interface.json"
    path.parent.mkdir(parents=True)
    path.write_text(json.dumps({"experiment": "exp1_single_interface", "settings": [], "version": "0", "budgets": [one, broken]}), encoding="utf-8")
    return root


def test_nothing_run_is_no_part(tmp_path: Path) -> None:
    """Without files there is no part."""
    assert refinement.section(tmp_path) is None and budget.section(tmp_path) is None


def test_refinement_counts_what_converges_and_names_what_does_not(tmp_path: Path) -> None:
    """Intro, title, table and marks follow from the rows."""
    found = refinement.section(write_refined(tmp_path / "runs"))
    assert found is not None
    assert "Of 5 numbers 3 have a limit (median order 1), 1 stands still; the others: 1 oscillating." in found["intro"]
    (picture,), (table,) = [make(figure, tmp_path / "out") for figure in found["figures"]], found["tables"]
    assert (tmp_path / "out" / "figures" / f"{picture.name}.png").stat().st_size > 5000
    assert "of 5 numbers 3 have a limit and 1 stands still; no complete run of soft at 0.25\xa0m".replace("\xa0", " ") in picture.title
    assert "moves the restart pressure (soft) most, by 200 kPa" in picture.title
    assert table["header"][2:6] == ["2 m", "1 m", "0.5 m", "0.25 m"] and table["marked"] == [3]
    start = table["rows"][0]
    assert start[2:6] == ["2.4400", "2.4200", "2.4100", "2.4050"] and start[6] == "1.00, 1.00" and start[7] == "2.4000 ± 0.0062 MPa"
    assert table["rows"][4][5] == "–" and table["rows"][4][8] == "0.25 m: failed"
    assert table["note"] == "At 2 m it lies askew. soft at 0.25 m failed: it became a mechanism."


def test_a_clean_line_ends_at_its_limit(tmp_path: Path) -> None:
    """x is (h/h0)^p for a clean order, h/h0 else."""
    content = json.loads((write_refined(tmp_path) / "refine" / "exp1_single_interface" / "refine.json").read_text())
    panels = {panel.heading: panel for panel in refinement.refinement_figure("exp1", content["studies"]).panels}
    clean, none = panels["start of growth"].lines[0], panels["restart pressure"].lines[0]
    assert clean.x == pytest.approx((1.0, 0.5, 0.25, 0.125)) and clean.limit == pytest.approx((2.4, 0.00625)) and clean.order == pytest.approx(1.0)
    assert none.limit is None and none.order is None and none.x == (1.0, 0.5, 0.25, 0.125)
    assert len(panels["pressure at 40 m"].lines[0].x) == 3


def test_the_budget_names_what_dominates_and_shows_failures(tmp_path: Path) -> None:
    """Factors beside the others dominate nothing; refused runs are marked rows with their reason; the base that failed is told."""
    found = budget.section(write_budget(tmp_path / "runs"))
    assert found is not None
    (picture,), (table, broken) = [make(figure, tmp_path / "out") for figure in found["figures"]], found["tables"]
    assert picture.title.startswith("Experiment 1: mesh moves the start of growth most, loading rate moves the pressure at 40 m most")
    assert "path" not in picture.title
    assert "largest numerical effect is that of the mesh, 20 kPa (start of growth, soft)" in picture.title
    assert (tmp_path / "out" / "figures" / f"{picture.name}.svg").is_file()
    assert "2 of their runs failed or were refused" in found["intro"]
    assert table["rows"][1][:4] == ["mesh", "cells of 0.5 m", "−20.00 (−0.83\xa0%)", "+1.00 (+0.04\xa0%)"]
    assert table["marked"] == [3, 4] and "J ring, 3 cells: unknown key." in table["note"]
    assert table["rows"][6][3] == "does not reach 40 m" and table["rows"][7][1] == "no flow"
    assert broken["rows"] == [["failed: it became a mechanism"]] and broken["marked"] == [0]


def test_what_moves_a_path_most_is_told(tmp_path: Path) -> None:
    """A path has no share in the pressures' finding, but its own."""
    content = json.loads((write_budget(tmp_path) / "budget" / "exp1_single_interface.json").read_text())
    one = content["budgets"][0]
    one["quantities"].append(["path_m", "path, largest distance", "m"])
    one["lines"][0]["tried"][0]["effects"]["path_m"] = {"value": 5.2, "note": ""}
    assert budget.budget_figure("exp1", [one]).title.endswith("; the mesh moves the path most, by up to 5.2 m")


def test_bars_are_ordered_by_size_and_what_says_nothing_is_last(tmp_path: Path) -> None:
    """A tornado: the largest on top; a cross for what was refused."""
    content = json.loads((write_budget(tmp_path) / "budget" / "exp1_single_interface.json").read_text())
    panels = budget.budget_figure("exp1", content["budgets"][:1]).variants[0][1]
    assert [row.label for row in panels[0].rows] == ["mesh and increment", "mesh", "loading rate", "J ring"]
    assert [bar.value for bar in panels[0].rows[3].bars] == [None, None]
    assert [bar.value for bar in panels[0].rows[2].bars] == [-1.0, 2.0]


def test_both_parts_are_on_the_page(tmp_path: Path) -> None:
    """The page is written without a defect and shows both."""
    runs, out = write_budget(write_refined(tmp_path / "runs")), tmp_path / "out"
    assert main(["--page", "verification", "--runs", str(runs), "--out", str(out), "--strict"]) == 0
    page = (out / "verification.html").read_text(encoding="utf-8")
    assert "Mesh refinement of the experiments" in page and "Error budgets of the experiments" in page
