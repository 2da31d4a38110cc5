"""Where a fracture crosses an interface, stops at it or makes it give way: the runs of all maps, and their tables.

usage: python3 -m verification.crossing_map [--family NAME[,NAME...]] [--size N] [--jobs N] [--runs DIR] [--out DIR] [--list]

--family names maps by the beginnings of their names (default: all), --size asks for N values in each range instead of the map's own. Each map is a
sweep (ci/sweep), whose table goes to verification/crossing_map/records (DIR). `python3 -m reports.crossing_map` draws them. Exit status: 0, 3 where a
run failed, 2 for bad input.
"""

import shutil
import sys

from verification.crossing_map.verdict import MAPS, RECORDS
from verification.harness import sweep
from verification.harness.command import beginnings, choose, command, ends_for_bad_input
from verification.harness.paths import RUNS

LONGEST_S = 300.0  # a hundred times what a run takes


def main(arguments: list[str] | None = None) -> int:
    """Make the maps."""
    parser = command("python3 -m verification.crossing_map", __doc__, "family", "jobs", "list", "runs", "out", runs=RUNS, out=RECORDS)
    parser.add_argument("--size", type=int, default=0, help="values in each range, at least 2 (default: the map's own)")
    options = parser.parse_args(arguments)
    with ends_for_bad_input(parser):
        maps = choose(MAPS, beginnings(options.family), "map")
        if options.size and options.size < 2:
            raise ValueError(f"--size {options.size} is below 2: an axis has two ends")
    if options.list:
        print(*(f"{one.name}: {one.x.label} x {one.y.label}" for one in maps.values()), sep="\n")
        return 0
    statuses = []
    for one in maps.values():
        runs = options.runs.resolve() / "crossing_map"
        out = runs / one.name
        wanted = [str(one.scene(runs, options.size)), f"--out={out}", f"--jobs={options.jobs}", "--lean", f"--longest={LONGEST_S}"]
        statuses.append(sweep.main([*wanted, "--observe=verification.crossing_map.verdict:seen"]))
        if statuses[-1] != 2:
            options.out.mkdir(parents=True, exist_ok=True)
            print(shutil.copy(out / "sweep.csv", options.out / f"{one.name}.csv"))
    return max(statuses, key=(0, 3, 2).index)


if __name__ == "__main__":
    sys.exit(main())
