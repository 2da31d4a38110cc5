"""Where a fracture crosses an interface, stops at it or makes it give way: the runs of all maps, and their tables.

usage: python3 -m verification.crossing_map [--family NAME[,NAME...]] [--size N] [--jobs N] [--runs DIR] [--out DIR] [--list]

--family names maps by the beginnings of their names (default: all), --size asks for N values along each axis instead of the map's own. Tables go
to verification/crossing_map/records (DIR). What has been run for the same scene and solver is not run again. `python3 -m reports.crossing_map` draws
them. Exit status: 0, 3 where a run failed, 2 for bad input.
"""

import sys
from collections import Counter

from verification.crossing_map.maps import FAILED, MAPS, RECORDS, swept, write_table
from verification.harness.choose import beginnings, choose
from verification.harness.command import command
from verification.harness.paths import RUNS, need_solver


def main(arguments: list[str] | None = None) -> int:
    """Make the maps."""
    parser = command("python3 -m verification.crossing_map", __doc__, "family", "jobs", "list", "runs", "out", runs=RUNS, out=RECORDS)
    parser.add_argument("--size", type=int, default=0, help="values along each axis, at least 2 (default: the map's own)")
    options = parser.parse_args(arguments)
    try:
        need_solver()
        maps = choose(MAPS, beginnings(options.family), "map")
        if options.size and options.size < 2:
            raise ValueError(f"--size {options.size} is below 2: an axis has two ends")
    except ValueError as error:
        parser.error(str(error))
    failed = 0
    for one in maps.values():
        size = (options.size, options.size) if options.size else one.size
        if options.list:
            print(f"{one.name}: {one.x.column} x {one.y.column}, {size[0]} x {size[1]}")
            continue
        verdicts = swept(one, size, options.jobs, options.runs.resolve())
        counts = Counter(found.verdict for found in verdicts.values())
        failed += counts[FAILED]
        print(f"{write_table(one, verdicts, options.out)}: {', '.join(f'{word} {count}' for word, count in sorted(counts.items()))}")
    return 3 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
