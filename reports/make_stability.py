#!/usr/bin/python3
"""Writes the page of the stability atlas alone: reports/make_stability.py --out reports/out."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from reports.figures import write_alone  # noqa: E402  (after the path to the project is known)
from reports.stability import write_stability  # noqa: E402
from verification.stability.store import RECORDS  # noqa: E402

if __name__ == "__main__":
    sys.exit(write_alone("Make stability.html and its figures from what ci/atlas recorded.", "--records", RECORDS, write_stability))
