"""Kill runs at random moments and resume them; every one must end as a run that was left alone, to the last digit.

usage: python3 -m verification.faults [--kills 200] [--seed 1] [--checkpoint-every 0.02] [--record]

Exit status: 0 all the same, 1 something differs or is torn.
"""
from __future__ import annotations

import argparse
import json
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

from verification.faults.kill import Tally, campaign
from verification.faults.scenes import KILLED
from verification.harness.paths import solver

RECORD = Path(__file__).parent / "records" / "kills.json"


def as_record(tallies: list[Tally], seed: int, every_s: float) -> dict[str, object]:
    """What is kept of a campaign."""
    version = subprocess.run([str(solver()), "--version"], capture_output=True, text=True, check=True).stdout.strip()
    sums = {key: sum(getattr(tally, key) for tally in tallies) for key in ("kills", "trials", "identical", "from_checkpoint", "from_start")}
    return {"version": version, "seed": seed, "checkpoint_every_s": every_s, **sums, "scenes": [asdict(tally) for tally in tallies]}


def table(tallies: list[Tally]) -> str:
    """The campaign as text."""
    lines = [f"{'scene':24}{'kills':>7}{'checkpoint':>12}{'start':>7}{'no folder':>11}{'ended':>7}{'notes':>7}{'runs':>6}{'identical':>11}"]
    for t in tallies:
        lines.append(
            f"{t.name:24}{t.kills:7}{t.from_checkpoint:12}{t.from_start:7}{t.before_folder:11}{t.after_end:7}{t.changes_finished:7}"
            f"{t.trials:6}{t.identical:11}"
        )
        lines += [f"  {problem}" for problem in t.problems]
    return "\n".join(lines)


def main(arguments: list[str] | None = None) -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--checkpoint-every", type=float, default=0.02, metavar="S")
    parser.add_argument("--record", action="store_true", help=f"keep the figures in {RECORD.name}")
    options = parser.parse_args(arguments)
    shares = [options.kills * (k + 1) // len(KILLED) - options.kills * k // len(KILLED) for k in range(len(KILLED))]
    tallies = []
    for killed, share in zip(KILLED, shares):
        tallies.append(campaign(killed, share, options.checkpoint_every, options.seed))
        print(table(tallies[-1:]), flush=True)
    if options.record:
        RECORD.parent.mkdir(exist_ok=True)
        RECORD.write_text(json.dumps(as_record(tallies, options.seed, options.checkpoint_every), indent=1) + "\n", encoding="utf-8")
    good = all(tally.identical == tally.trials and not tally.problems for tally in tallies)
    print(f"{sum(t.kills for t in tallies)} kills, {sum(t.trials for t in tallies)} runs, {sum(t.identical for t in tallies)} identical")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
