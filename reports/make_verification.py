#!/usr/bin/python3
"""Writes the page of verification: reports/make_verification.py --runs runs --out reports/out."""

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from reports.figures import OUT  # noqa: E402  (after the path to the project is known)
from reports.verification import write_verification  # noqa: E402
from verification.harness.paths import RUNS  # noqa: E402


def main(arguments: list[str] | None = None) -> int:
    """Write the page; 1 where there is nothing to show, or a part met a defect and --strict is given."""
    parser = argparse.ArgumentParser(description="Make verification.html from what ci/verify, ci/refine and ci/budget left.")
    parser.add_argument("--runs", type=Path, default=RUNS, help="folder of runs")
    parser.add_argument("--out", type=Path, default=OUT, help="folder for the page")
    parser.add_argument("--ladder", type=Path, help="the ladder's judgement (default: RUNS/ladder/ladder.json)")
    parser.add_argument("--strict", action="store_true", help="exit 1 if a part of the page met a defect")
    options = parser.parse_args(arguments)
    page = write_verification(options.runs, options.out, options.ladder)
    if page is None:
        print(f"nothing to show below {options.runs}", file=sys.stderr)
        return 1
    for defect in page.defects:
        print(defect, file=sys.stderr)
    print(f"{page.path}: {page.headline}")
    return 1 if options.strict and page.defects else 0


if __name__ == "__main__":
    sys.exit(main())
