#!/usr/bin/python3
"""Writes the page of results: reports/make_page.py --runs runs --out reports/out."""

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from reports.catalogue import catalogue  # noqa: E402  (after the path to the project is known)
from reports.figures import OUT, defects_of, make  # noqa: E402
from reports.page import write_index  # noqa: E402
from reports.precision import write_precision  # noqa: E402
from reports.runs import add_missing, load_runs  # noqa: E402
from reports.stability import write_stability  # noqa: E402
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
    parser.add_argument("--out", type=Path, default=OUT, help="folder for the page")
    parser.add_argument("--experiments", type=Path, default=ROOT / "experiments", help="scenes whose variants without a run are shown as not run")
    parser.add_argument("--precision", type=Path, default=DATA, help="folder of the work-precision chart's data")
    parser.add_argument("--stability", type=Path, default=RECORDS, help="folder of the stability atlas' records")
    parser.add_argument("--strict", action="store_true", help="exit 1 if a figure could not be drawn for a defect")
    options = parser.parse_args(arguments)
    points = read_points(options.experiments)
    runs = add_missing(load_runs(options.runs), options.experiments, options.runs)
    with ProcessPoolExecutor(max_workers=2) as beside:  # the other pages are drawn at the same time
        atlas_page = beside.submit(write_stability, options.out, options.stability)
        verification = beside.submit(write_verification, options.runs, options.out, with_index=True)
        chart_page = beside.submit(write_precision, options.out, options.precision)
        figures = [make(figure, options.out) for figure in catalogue(runs, points)]
        verified, chart, atlas = verification.result(), chart_page.result(), atlas_page.result()
    page = write_index(options.out, runs, read_claims(options.runs / "claims.json"), figures, points,
                       verified=verified.headline if verified else "", precision=chart, stability=atlas)
    defects = [*(verified.defects if verified else []), *filter(None, [chart.defect, atlas.defect])]
    told = [f"{made.label}: {made.reason}\n{made.defect}" for made in figures if made.reason]
    print(*defects, *told, sep="\n", end="\n" if defects or told else "", file=sys.stderr)
    print(f"{page}: {sum(not made.reason for made in figures)} of {len(figures)} figures, {len(runs)} runs")
    return 1 if options.strict and (defects or defects_of(figures)) else 0


if __name__ == "__main__":
    sys.exit(main())
