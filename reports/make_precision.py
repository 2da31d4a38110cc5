#!/usr/bin/python3
"""Writes the page of error against time alone: reports/make_precision.py --out reports/out."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from reports.precision_page import NAME, write_precision  # noqa: E402  (after the path to the project is known)
from verification.precision.store import DATA  # noqa: E402


def main(arguments: list[str] | None = None) -> int:
    """Write the page; 1 where there are no data, or they cannot be read."""
    parser = argparse.ArgumentParser(description="Make precision.html and its figures from what ci/chart measured.")
    parser.add_argument("--precision", type=Path, default=DATA, help="folder of the data")
    parser.add_argument("--out", type=Path, default=ROOT / "reports" / "out", help="folder for the page")
    options = parser.parse_args(arguments)
    made = write_precision(options.out, options.precision)
    if made.lack:
        print(made.defect or made.lack, file=sys.stderr)
        return 1
    print(f"{options.out / NAME}: {made.figure['title'] if made.figure else ''}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
