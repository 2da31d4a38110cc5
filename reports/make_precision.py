#!/usr/bin/python3
"""Writes the page of error against time alone: reports/make_precision.py --out reports/out."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from reports.figures import write_alone  # noqa: E402  (after the path to the project is known)
from reports.precision import write_precision  # noqa: E402
from verification.precision.store import DATA  # noqa: E402

if __name__ == "__main__":
    sys.exit(write_alone("Make precision.html and its figures from what ci/chart measured.", "--precision", DATA, write_precision))
