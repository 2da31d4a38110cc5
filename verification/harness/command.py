"""The options that the commands share, each told once."""

import argparse
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
    parser = argparse.ArgumentParser(name, description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    for option in options:
        parser.add_argument(f"--{option}", **OPTIONS[option])
    parser.set_defaults(**defaults)
    return parser
