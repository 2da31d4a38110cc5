"""The README's picture, from runs: experiments/heights.svg.

usage: python3 -m reports.front_picture [--runs runs] [--out experiments]     (after ci/reproduce)
"""

import sys
from pathlib import Path

from reports.charts.experiments import draw_front_picture
from reports.charts.style import save
from reports.runs import layout_of, load_run
from reports.words import Shown
from verification.harness.claims import ClaimResult, read_claims
from verification.harness.command import command
from verification.harness.paths import EXPERIMENTS, RUNS

# Experiment, its title, whether its claims are about the path, and the interface types of the study.
_ONE, _TWO = ("perfect", "friction", "weak", "soft"), ("perfect", "weak_soft", "soft_weak")
SHOWN = (
    ("exp1_single_interface", "1: one interface", False, _ONE), ("exp2_soft_above", "2: soft rock above it", False, _ONE),
    ("exp3_two_interfaces", "3: two interfaces", False, _TWO), ("exp4_soft_between", "4: soft rock between two", False, _ONE),
    ("exp5_parallel_interface", "5: stiff rock beside the fracture", True, _ONE),
    ("exp6_stress_reversal", "6: horizontal compression largest", True, _ONE),
)
MECHANICS = ("quasistatic", "explicit")


def panel_of(runs: Path, claims: list[ClaimResult], experiment: str, title: str, is_path: bool, variants: tuple[str, ...]) -> Shown:
    """An experiment: curves of height (m) against inlet pressure (MPa) or x (m), those with inertia beside; interfaces' places (m); and verdicts (id,
    without and with inertia). Raises KeyError where a run is not there."""
    found = [load_run(runs / mechanics / experiment / variant) for mechanics in MECHANICS for variant in variants]
    curves = [Shown(variant=run.variant, x=run.history["tip_x_m"] if is_path else run.history["inlet_Pa"] / 1e6, height_m=run.history["height_m"],
                    beside=run.mechanics == "explicit") for run in found]
    said = {(claim.id, claim.mechanics): claim.verdict for claim in claims if claim.experiment == experiment}
    verdicts = [(name, *(said.get((name, mechanics), "") for mechanics in MECHANICS)) for name in sorted({name for name, _ in said})]
    return Shown(title=title, is_path=is_path, curves=curves, interfaces_m=[place.at_m for place in layout_of(found[0]).interfaces],
                 verdicts=verdicts)


def main(arguments: list[str] | None = None) -> int:
    """Draw the picture."""
    options = command("reports.front_picture", __doc__, "runs", "out", runs=RUNS, out=EXPERIMENTS).parse_args(arguments)
    claims = read_claims(options.runs / "claims.json")
    save(draw_front_picture([panel_of(options.runs, claims, *shown) for shown in SHOWN]), options.out / "heights.svg")
    print(options.out / "heights.svg")
    return 0


if __name__ == "__main__":
    sys.exit(main())
