#!/usr/bin/python3
"""Writes the front page with those behind it, or one of these alone: make_page.py --runs runs --out reports/out [--page NAME]."""

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from reports.animation import animations  # noqa: E402  (after the path to the project is known)
from reports.curves import catalogue  # noqa: E402
from reports.figures import OUT, make  # noqa: E402
from reports.ladder import write_verification  # noqa: E402
from reports.page import topic_shown, topics, write_index  # noqa: E402
from reports.runs import add_missing, load_runs  # noqa: E402
from reports.stability import write_stability  # noqa: E402
from verification.harness.claims import read_claims, read_points  # noqa: E402
from verification.harness.paths import RUNS  # noqa: E402
from verification.precision.problem import DATA  # noqa: E402
from verification.stability.runner import RECORDS  # noqa: E402


def main(arguments: list[str] | None = None) -> int:
    """Write the pages; 1 where a page asked for alone has nothing to show, or where --strict is given and something met a defect."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--page", default="index", choices=("index", "verification", "stability"))
    parser.add_argument("--runs", type=Path, default=RUNS, help="folder of runs/<mechanics>/<scene>/<variant>/")
    parser.add_argument("--out", type=Path, default=OUT, help="folder for the page")
    parser.add_argument("--experiments", type=Path, default=ROOT / "experiments", help="scenes whose variants without a run are shown as not run")
    parser.add_argument("--precision", type=Path, default=DATA, help="folder of the work-precision chart's data")
    parser.add_argument("--stability", type=Path, default=RECORDS, help="folder of the stability atlas' records")
    parser.add_argument("--records", type=Path, default=ROOT / "verification", help="folder of the ladder's gates and the records of the other sections")
    parser.add_argument("--ladder", type=Path, help="the ladder's judgement (default: RUNS/ladder/ladder.json)")
    parser.add_argument("--strict", action="store_true", help="exit 1 if something could not be drawn for a defect")
    options = parser.parse_args(arguments)
    out, alone = options.out, options.page != "index"
    ladder = options.ladder or options.runs / "ladder" / "ladder.json"
    makers = {"verification": partial(write_verification, out, ladder, options.records / "ladder" / "gates"),
              "stability": partial(write_stability, out, options.stability)}
    if alone:
        made = makers[options.page]()
        pages, told = [made], f"{out / made.name}: {made.words}"
    else:
        points, runs = read_points(options.experiments), add_missing(load_runs(options.runs), options.experiments, options.runs)
        out.mkdir(parents=True, exist_ok=True)
        (out / "index.html").touch()  # the others link to it
        with ProcessPoolExecutor(max_workers=2) as pool:  # the other pages are drawn at the same time
            waiting = {name: pool.submit(maker) for name, maker in makers.items()}
            moving = pool.submit(animations, runs, out / "animations")
            figures = [make(figure, out) for figure in catalogue(runs, options.runs, options.experiments)]
            sections = [topic_shown(topic, out) for topic in topics(ladder, options.precision, options.records)]
            beside, films = {name: one.result() for name, one in waiting.items()}, moving.result()
        claims = read_claims(options.runs / "claims.json")
        page = write_index(out, runs, claims, figures, points, sections, films, **beside)
        pages = [*beside.values(), *figures, *sections, *(one.made for one in sections if getattr(one, "made", None))]
        told = f"{page}: {sum(not one.lack for one in figures)} of {len(figures)} figures, {len(runs)} runs"
    for one in pages:
        if one.lack or one.defect:
            print(*filter(None, [f"{one.name}: {one.lack}" if one.lack else "", one.defect]), sep="\n", file=sys.stderr)
    if alone and made.lack:
        return 1
    print(told)
    return 1 if options.strict and any(one.defect for one in pages) else 0


if __name__ == "__main__":
    sys.exit(main())
