"""Kill runs at random moments and resume them; every one must end as a run that was left alone, to the last digit.

usage: python3 -m verification.faults [--kills 200] [--seed 1] [--checkpoint-every 0.02] [--record]

Exit status: 0 all the same, 1 something differs or is torn.
"""

import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

from verification.faults.kill import KILLED, Tally, campaign
from verification.harness import store
from verification.harness.command import aligned, command
from verification.harness.paths import solver

RECORD = Path(__file__).parent / "records" / "kills.json"


def as_record(tallies: list[Tally], seed: int, every_s: float) -> dict[str, object]:
    """What is kept of a campaign."""
    version = subprocess.run([str(solver()), "--version"], capture_output=True, text=True, check=True).stdout.strip()
    sums = {key: sum(getattr(tally, key) for tally in tallies) for key in ("kills", "trials", "identical", "from_checkpoint", "from_start")}
    return {"version": version, "seed": seed, "checkpoint_every_s": every_s, **sums, "scenes": [asdict(tally) for tally in tallies]}


def table(tallies: list[Tally]) -> str:
    """The campaign as text."""
    header = ("scene", "kills", "checkpoint", "start", "no folder", "ended", "runs", "identical")
    numbers = [(t.kills, t.from_checkpoint, t.from_start, t.before_folder, t.after_end, t.trials, t.identical) for t in tallies]
    lines = aligned([header, *((t.name, *map(str, row)) for t, row in zip(tallies, numbers))], range(1, len(header)))
    return "\n".join([*lines, *(f"  {problem}" for t in tallies for problem in t.problems)])


def main(arguments: list[str] | None = None) -> int:
    """Command line."""
    parser = command("verification.faults", __doc__)
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
        store.write(as_record(tallies, options.seed, options.checkpoint_every), RECORD)
    good = all(tally.identical == tally.trials and not tally.problems for tally in tallies)
    print(f"{sum(t.kills for t in tallies)} kills, {sum(t.trials for t in tallies)} runs, {sum(t.identical for t in tallies)} identical")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
