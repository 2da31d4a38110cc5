"""What commands share: options, each told once, and rows of words as aligned text."""

import argparse
import inspect
import math
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Any

from verification.harness.scenes import MECHANICS

OPTIONS: dict[str, dict[str, Any]] = {
    "family": {"default": "", "help": "families by the beginnings of their names, comma-separated (default: all)"},
    "case": {"default": "", "help": "cases by the beginnings of their names, comma-separated (default: all)"},
    "smoke": {"action": "store_true", "help": "only what ci/test runs too"},
    "accept": {"action": "store_true", "help": "write what was found as the record, tell what changed"},
    "list": {"action": "store_true", "help": "say what there is, run nothing"},
    "jobs": {"type": int, "default": 2, "help": "threads for runs side by side"},
    "set": {"dest": "settings", "action": "append", "default": [], "metavar": "KEY=VALUE", "help": "a scene key, in all runs"},
    "variants": {"default": "", "help": "names of variants, comma-separated (default: those of the study)"},
    "mechanics": {"default": "both", "choices": (*MECHANICS, "both")},
    "limit": {"type": float, "default": 30.0, "help": "minutes above which --yes is asked for"},
    "yes": {"action": "store_true", "help": "run whatever it costs"},
    "runs": {"type": Path, "help": "folder of the runs"},
    "out": {"type": Path, "help": "where to write"},
}


def command(name: str, about: str | None, *options: str, **defaults: Any) -> argparse.ArgumentParser:
    """The parser of a command with some of the shared options, and with defaults of its own (runs=RUNS)."""
    parser = argparse.ArgumentParser(name, description=inspect.cleandoc(about or ""), formatter_class=argparse.RawDescriptionHelpFormatter)
    for option in options:
        parser.add_argument(f"--{option}", **OPTIONS[option])
    parser.set_defaults(**defaults)
    return parser


def number(value: float, digits: int = 6) -> str:
    """A number with so many digits, or a dash."""
    return f"{value:.{digits}g}" if math.isfinite(value) else "-"


def count(size: float) -> str:
    """A count with k for thousands and M for millions."""
    for unit, letter in ((1e6, "M"), (1e3, "k")):
        if size >= unit:
            return f"{size / unit:.3g}{letter}"
    return str(size)


def aligned(rows: Sequence[Sequence[str]], right: Collection[int] = (), gap: str = "  ") -> list[str]:
    """A line a row, columns as wide as their widest word; those in `right` flush right, the last one as it is."""
    widths = [max(map(len, column)) for column in zip(*rows)]

    def line(row: Sequence[str]) -> str:
        padded = [word.rjust(width) if k in right else word.ljust(width) for k, (word, width) in enumerate(zip(row, widths))]
        return gap.join(padded).rstrip()

    return [line(row) for row in rows]
