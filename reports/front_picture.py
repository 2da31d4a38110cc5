"""The README's picture, from runs: experiments/heights.svg.

usage: python3 -m reports.front_picture [--runs runs] [--out experiments]     (after ci/reproduce)
"""
from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from reports.charts.front_chart import Curve, Panel, draw_front
from reports.charts.style import save
from verification.harness.load import load
from verification.harness.paths import EXPERIMENTS, RUNS

# Experiment, its title, whether its claims are about the path, and the interface types of the study.
EXPERIMENTS_SHOWN = (
    ("exp1_single_interface", "1: one interface", False, ("perfect", "friction", "weak", "soft")),
    ("exp2_soft_above", "2: soft rock above it", False, ("perfect", "friction", "weak", "soft")),
    ("exp3_two_interfaces", "3: two interfaces", False, ("perfect", "weak_soft", "soft_weak")),
    ("exp4_soft_between", "4: soft rock between two", False, ("perfect", "friction", "weak", "soft")),
    ("exp5_parallel_interface", "5: stiff rock beside the fracture", True, ("perfect", "friction", "weak", "soft")),
    ("exp6_stress_reversal", "6: horizontal compression largest", True, ("perfect", "friction", "weak", "soft")),
)
MECHANICS = ("quasistatic", "explicit")


def curve_of(folder: Path, variant: str, is_path: bool, beside: bool) -> Curve:
    """Pressure or x, and height, of a run; raises LoadError where it is not there."""
    history = load(folder).history
    x = history["tip_x_m"] if is_path else history["inlet_Pa"] / 1e6
    return Curve(variant, tuple(map(float, x)), tuple(map(float, history["height_m"])), beside)


def panel_of(runs: Path, experiment: str, title: str, is_path: bool, variants: tuple[str, ...]) -> Panel:
    """An experiment's panel."""
    curves = [
        curve_of(runs / mechanics / experiment / variant, variant, is_path, mechanics == "explicit")
        for mechanics in MECHANICS for variant in variants
    ]  # fmt: skip
    strata = load(runs / MECHANICS[0] / experiment / variants[0]).scene["strata"]
    tops, at = [], 0.0
    for layer in strata["layers"][:-1]:
        at += float(layer["thickness_m"])
        tops.append(at)
    claims = json.loads((runs / "claims.json").read_text(encoding="utf-8"))["claims"]
    said = {(claim["id"], claim["mechanics"]): claim["verdict"] for claim in claims if claim["experiment"] == experiment}
    ids = sorted({name for name, _ in said})
    verdicts = tuple((name, *(said.get((name, mechanics), "") for mechanics in MECHANICS)) for name in ids)
    return Panel(title, is_path, tuple(curves), tuple(tops), verdicts)


def main(arguments: list[str] | None = None) -> int:
    """Draw the picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=Path, default=RUNS)
    parser.add_argument("--out", type=Path, default=EXPERIMENTS, help="folder of heights.svg")
    options = parser.parse_args(arguments)
    save(draw_front(tuple(panel_of(options.runs, *shown) for shown in EXPERIMENTS_SHOWN)), options.out, "heights")
    print(options.out / "heights.svg")
    return 0


if __name__ == "__main__":
    sys.exit(main())
