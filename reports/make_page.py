#!/usr/bin/python3
"""Writes the page of results: reports/make_page.py --runs runs --out reports/out."""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from reports.figures import catalogue, make  # noqa: E402  (after the path to the project is known)
from reports.page import write_page  # noqa: E402
from reports.precision_page import write_precision  # noqa: E402
from reports.runs import add_missing, declared_runs, load_runs  # noqa: E402
from reports.stability_page import write_stability  # noqa: E402
from reports.verification import write_verification  # noqa: E402
from verification.harness.choices import read_points  # noqa: E402
from verification.harness.claim_data import read_claims  # noqa: E402
from verification.harness.paths import RUNS  # noqa: E402
from verification.precision.store import DATA  # noqa: E402
from verification.stability.store import RECORDS  # noqa: E402


def main(arguments: list[str] | None = None) -> int:
    """Read the runs, make every figure, write the page; 1 where --strict is given and a figure met a defect."""
    parser = argparse.ArgumentParser(description="Make figures and index.html from run folders.")
    parser.add_argument("--runs", type=Path, default=RUNS, help="folder of runs/<mechanics>/<scene>/<variant>/")
    parser.add_argument("--out", type=Path, default=ROOT / "reports" / "out", help="folder for the page")
    parser.add_argument("--experiments", type=Path, default=ROOT / "experiments",
                        help="scenes whose variants without a run are shown as not run")
    parser.add_argument("--precision", type=Path, default=DATA, help="folder of the work-precision chart's data")
    parser.add_argument("--stability", type=Path, default=RECORDS, help="folder of the stability atlas' records")
    parser.add_argument("--strict", action="store_true", help="exit 1 if a figure could not be drawn for a defect")
    options = parser.parse_args(arguments)
    points = read_points(options.experiments)
    runs = add_missing(load_runs(options.runs), declared_runs(options.experiments), options.runs)
    with ProcessPoolExecutor(max_workers=2) as beside:  # the other pages are drawn at the same time
        atlas_page = beside.submit(write_stability, options.out, options.stability)
        verification = beside.submit(write_verification, options.runs, options.out, with_index=True)
        chart_page = beside.submit(write_precision, options.out, options.precision)
        figures = [make(spec, options.out / "figures") for spec in catalogue(runs, points)]
        verified, chart, atlas = verification.result(), chart_page.result(), atlas_page.result()
    said = verified.headline if verified else ""
    page = write_page(options.out, runs, read_claims(options.runs / "claims.json"), figures, points, said, chart, atlas)
    for defect in [*(verified.defects if verified else []), *filter(None, [chart.defect, atlas.defect])]:
        print(defect, file=sys.stderr)
    for made in figures:
        if made.reason:
            print(f"{made.label}: {made.reason}\n{made.defect}", file=sys.stderr)
    print(f"{page}: {sum(made.ok for made in figures)} of {len(figures)} figures, {len(runs)} runs")
    broken = any(made.defect for made in figures) or bool(verified and verified.defects) or bool(chart.defect or atlas.defect)
    return 1 if options.strict and broken else 0


if __name__ == "__main__":
    sys.exit(main())
