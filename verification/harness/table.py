"""Rows of words as aligned text."""

import math
from collections.abc import Collection, Sequence


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
