"""A page made alone, by a script of its own: what make_stability.py and make_precision.py have in common."""
from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, Protocol, TypeVar

OUT = Path(__file__).resolve().parent / "out"


class Front(Protocol):
    """What writing a page tells: why there is none, and the defect behind that; both empty where there is one."""

    @property
    def lack(self) -> str:
        """Why there is no page."""

    @property
    def defect(self) -> str:
        """The defect behind that."""


Made = TypeVar("Made", bound=Front)


@dataclass(frozen=True)
class Alone(Generic[Made]):
    """A page: what it is made of (by default from `data`, told by `option`), what writes it, its file and what to say of it."""

    about: str
    option: str
    data: Path
    write: Callable[[Path, Path], Made]
    name: str
    words: Callable[[Made], str]


def make(page: Alone[Made], arguments: list[str] | None = None) -> int:
    """Write the page; 1 where there is nothing to make it of, or that cannot be read."""
    parser = argparse.ArgumentParser(description=page.about)
    parser.add_argument(page.option, dest="data", type=Path, default=page.data, help="folder of what it is made of")
    parser.add_argument("--out", type=Path, default=OUT, help="folder for the page")
    options = parser.parse_args(arguments)
    made = page.write(options.out, options.data)
    if made.lack:
        print(made.defect or made.lack, file=sys.stderr)
        return 1
    print(f"{options.out / page.name}: {page.words(made)}")
    return 0
