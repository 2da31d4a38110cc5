"""Lists of cases: gathered from the modules of a package, chosen by the beginnings of their names, each with a folder of its own."""

import fcntl
import importlib
import pkgutil
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

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


@contextmanager
def claimed(folder: Path) -> Iterator[None]:
    """Holds a run's folder for this process; another one that wants it waits."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with (folder.parent / f"{folder.name}.lock").open("w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield
