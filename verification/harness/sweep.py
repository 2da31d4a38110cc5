"""Runs a scene over variants and cell sizes and tabulates one number of each.

usage: python3 -m verification.harness.sweep SCENE --variants a,b --cells 2,1 --observable start_Pa --out DIR [--jobs 2]
"""
from __future__ import annotations

import argparse
import itertools
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from verification.harness.load import LoadError, Run, load
from verification.harness.observables import OBSERVABLES, measure
from verification.harness.run import Job, Outcome, run
from verification.harness.scenes import variants_of


@dataclass(frozen=True)
class Point:
    """One run of a sweep: variant, cell size (m), its outcome, and its data where it has any."""

    variant: str
    cell_m: float
    outcome: Outcome
    run: Run | None


def sweep(
    scene: Path, variants: list[str], cells_m: list[float], out: Path, settings: tuple[str, ...] = (), jobs: int = 2
) -> list[Point]:
    """Run all combinations of variants and cell sizes (m), `jobs` at a time, each on one thread."""

    def one(pair: tuple[str, float]) -> Point:
        variant, cell_m = pair
        folder = out / f"{scene.stem}_{cell_m:g}m" / (variant or "base")
        outcome = run(Job(scene, variant, folder, (f"numerics.cell_m={cell_m!r}", *settings)))
        try:
            return Point(variant, cell_m, outcome, load(folder))
        except LoadError:
            return Point(variant, cell_m, outcome, None)

    with ThreadPoolExecutor(max_workers=jobs) as pool:
        return list(pool.map(one, itertools.product(variants, cells_m)))


def main(arguments: list[str] | None = None) -> int:
    """Sweep from the command line and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=Path)
    parser.add_argument("--variants", default="", help="names, comma-separated (default: all)")
    parser.add_argument("--cells", default="1", help="cell sizes in m, comma-separated")
    parser.add_argument("--observable", default="final_height_m", help="one of: " + ", ".join(sorted(OBSERVABLES)))
    parser.add_argument("--set", dest="settings", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--out", type=Path, default=Path("runs/sweep"))
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args(arguments)
    variants = options.variants.split(",") if options.variants else variants_of(options.scene)
    cells = [float(cell) for cell in options.cells.split(",")]
    points = sweep(options.scene, variants, cells, options.out, tuple(options.settings), options.jobs)
    print(f"{'variant':24} {'cell_m':>8} {options.observable:>24}  status")
    for point in points:
        number = measure(options.observable, {}, point.run, None).value if point.run else None
        shown = "-" if number is None else f"{number:.6g}"
        print(f"{point.variant:24} {point.cell_m:8g} {shown:>24}  {point.outcome.status} {point.outcome.reason}".rstrip())
    return 0 if all(point.outcome.ok for point in points) else 3


if __name__ == "__main__":
    sys.exit(main())
