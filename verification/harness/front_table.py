"""The README's table of accuracy: a row a kind of problem, errors from coarse to fine, from what the ladder measured; then the kept errors beside an experiment.

usage: python3 -m verification.harness.front_table LADDER.json [--write]     (LADDER.json as ci/verify leaves it; --write puts it into README.md)
"""

import json
import sys
from pathlib import Path
from typing import Any, NamedTuple

from verification.harness.command import command
from verification.harness.paths import ROOT
from verification.measured import rubin

README = ROOT / "README.md"
START, END = "<!-- ladder -->\n", "<!-- end of ladder -->"


class Line(NamedTuple):
    """A quantity of a case of the ladder, and what of it the table says."""

    case: str
    quantity: str
    levels: tuple[str, ...]
    says: str
    against: str


LINES = (
    Line("graded", "K_I", ("1 m", "0.5 m", "0.25 m"), "K_I of a fracture of 5 m under an even pressure", "boundary elements, `block_crack`"),
    Line("bonded_normal_stiff_1", "K_I, near tip", ("2 cells", "4 cells", "8 cells"), "K_I at a tip 1 m before a bonded border of two rocks", "integral equations, `bonded_normal`"),
    Line("crosses_1", "net pressure of crossing", ("1 m", "0.5 m", "0.25 m"), "net pressure at which a fracture goes on behind a soft interface", "integral equations, `crossing_pressure`; increment of 1 m"),
    Line("transition", "inlet pressure, 10 to 100 s", ("0.5 m", "0.25 m", "0.125 m"), "inlet pressure of a fracture fed at a rate, toughness and viscosity alike", "an independent solution of lubrication and elasticity, `kgd`"),
    Line("freund", "K_I(t), c_P t = 20 to 60 m", ("2 m", "1 m", "0.5 m"), "K_I(t) of a suddenly pressurised fracture, with inertia", "closed form, `freund_step_pressure`"),
)  # fmt: skip


def table(rows: list[dict[str, Any]]) -> str:
    """The table as Markdown; the time is that of the finest run named. Raises ValueError for a row that is not there or was not measured."""
    known = {(row["case"], row["quantity"], row["level"]): row for row in rows if row["error"] is not None}
    lines = ["| what | against | error | seconds |", "|---|---|---|---|"]
    for line in LINES:
        for level in line.levels:
            if (line.case, line.quantity, level) not in known:
                raise ValueError(f"the ladder has no {line.quantity} of {line.case} at {level}: run ci/verify whole")
        measured = [known[line.case, line.quantity, level] for level in line.levels]
        errors = ", ".join(f"{100.0 * abs(row['error']):.2g} % ({row['level']})" for row in measured)
        lines.append(f"| {line.says} | {line.against} | {errors} | {measured[-1]['cost']['wall_s']:.1f} |")
    return "\n".join(lines) + "\n"


def measured_row(record: rubin.Record | None) -> str:
    """The table's last row, mean errors from 15 s on beside Rubin's experiment in the smallest cells; raises ValueError where they are not kept."""
    if record is None:
        raise ValueError(f"there is no {rubin.RECORD}: run python3 -m verification.measured --accept")
    plain, zeroed = (min((one for one in record.results if one.name == name), key=lambda one: one.cell_m) for name in ("plain", "gauges_from_zero"))
    length, opening, pressure = (f"{100.0 * plain.errors[name].late:.2g} %" for name in (rubin.LENGTH, rubin.OPENING, rubin.WELL))
    return (f"| length, opening, pressure of a fracture of oil in PMMA | an experiment, Rubin 1983, nothing fitted (`verification/measured`) | {length}, {opening}, {pressure} "
            f"({100.0 * zeroed.errors[rubin.WELL].late:.2g} % less a zero of the gauges) | {plain.wall_s:.1f} |\n")


def with_table(readme: str, new: str, start: str = START, stop: str = END) -> str:
    """A README with another table between its two marks; raises ValueError where these are not there."""
    before, mark, rest = readme.partition(start)
    _, end, after = rest.partition(stop)
    if not (mark and end):
        raise ValueError(f"README.md has no table between {start.strip()} and {stop}")
    return before + mark + new + end + after


def main(arguments: list[str] | None = None) -> int:
    """Print the table; with --write put it into README.md."""
    parser = command("front_table", __doc__)
    parser.add_argument("ladder", type=Path)
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args(arguments)
    try:
        new = table(json.loads(options.ladder.read_text(encoding="utf-8"))["rows"]) + measured_row(rubin.kept())
    except (OSError, ValueError, KeyError) as error:
        print(error, file=sys.stderr)
        return 1
    print(new, end="")
    if options.write:
        README.write_text(with_table(README.read_text(encoding="utf-8"), new), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
