#!/usr/bin/python3
"""Writes the page of the stability atlas alone: reports/make_stability.py --out reports/out."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from reports.stability_page import NAME, write_stability  # noqa: E402  (after the path to the project is known)
from verification.stability.store import RECORDS  # noqa: E402


def main(arguments: list[str] | None = None) -> int:
    """Write the page; 1 where there are no records, or they cannot be read."""
    parser = argparse.ArgumentParser(description="Make stability.html and its figures from what ci/atlas recorded.")
    parser.add_argument("--records", type=Path, default=RECORDS, help="folder of the records")
    parser.add_argument("--out", type=Path, default=ROOT / "reports" / "out", help="folder for the page")
    options = parser.parse_args(arguments)
    made = write_stability(options.out, options.records)
    if made.lack:
        print(made.defect or made.lack, file=sys.stderr)
        return 1
    print(f"{options.out / NAME}: {made.words}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
