"""What commands and lists of cases share: options, each told once; rows of words as aligned text; cases gathered from the modules of a package and chosen
by the beginnings of their names."""

import argparse
import importlib
import inspect
import math
import pkgutil
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

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


@contextmanager
def ends_for_bad_input(parser: argparse.ArgumentParser) -> Iterator[None]:
    """Ends the command with status 2 and the words of a ValueError."""
    try:
        yield
    except ValueError as error:
        parser.error(str(error))


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


T = TypeVar("T")


def listed(package: ModuleType, attribute: str) -> dict[str, Any]:
    """What every module of a package has under a name (CASES, say), by the modules' names in their order."""
    names = sorted(module.name for module in pkgutil.iter_modules(package.__path__))
    return {name: getattr(importlib.import_module(f"{package.__name__}.{name}"), attribute) for name in names}


def beginnings(asked: str) -> tuple[str, ...]:
    """The names in an option's comma-separated list."""
    return tuple(name for name in asked.split(",") if name)


def choose(known: Mapping[str, T], wanted: Iterable[str], what: str = "family") -> dict[str, T]:
    """Those whose names begin as is asked (all where nothing is); raises ValueError for a beginning that none has."""
    starts = tuple(wanted)
    strangers = [start for start in starts if not any(name.startswith(start) for name in known)]
    if strangers:
        raise ValueError(f"no {what} {', '.join(strangers)}; there are {', '.join(known)}")
    return {name: item for name, item in known.items() if not starts or name.startswith(starts)}


def twice(names: Iterable[str]) -> list[str]:
    """Names that stand more than once."""
    every = list(names)
    return sorted({name for name in every if every.count(name) > 1})


def refuse(wrong: Mapping[str, object]) -> None:
    """Raises ValueError with the first of some words that are so."""
    for words, is_so in wrong.items():
        if is_so:
            raise ValueError(words)


def folder_name(label: str) -> str:
    """A label as the name of a folder: letters, digits, points and signs stay, anything else becomes a line."""
    return "".join(letter if letter.isalnum() or letter in ".+-=" else "_" for letter in label)
