"""What each quantity may be off by: verification/ladder/gates/FAMILY.json, written from measured errors, never by hand.

A gate belongs to a case, a quantity and a level: the largest error, and the smallest order from the level before. It holds
what was measured when it was accepted, so that it can be checked to be no wider than the rules below.
"""

import math
from dataclasses import asdict, dataclass
from decimal import ROUND_DOWN, Context
from pathlib import Path
from typing import Any

from verification.harness import store
from verification.ladder.case import Families

FOLDER = Path(__file__).resolve().parent / "gates"

SHARE = 1.5  # an error may be this many times the measured one
ORDER_LOSS = 0.3  # an order may be this much below the measured one; half an order lost is refused
# A quantity whose `no_order` begins so holds to rounding: another machine rounds otherwise, so its error may be ten times as
# large, up to the next power of ten, but no more than ROUND_OFF_MOST (fields are stored in single precision), and need not be
# less than ROUND_OFF_FLOOR.
ROUND_OFF = "round-off"
ROUND_OFF_FLOOR = 1e-12
ROUND_OFF_MOST = 1e-6
# From these on a gate is no longer tight, which is told but fails nothing: errors fall by improvements, and elsewhere by rounding.
FALLEN = 0.9  # an error below this share of the accepted one
RISEN = 0.5 - ORDER_LOSS  # an order this much above the accepted one: half an order of its own lost would pass


class CannotAccept(Exception):
    """A measured error or order that no gate may be made of; the message says why."""


@dataclass(frozen=True)
class Gate:
    """The largest error (relative, without sign) and smallest order that pass, with the measured ones they come from."""

    error: float
    measured: float
    order: float | None = None
    measured_order: float | None = None


@dataclass(frozen=True)
class Book:
    """A file of gates: those of a family by case, quantity and level."""

    family: str
    cases: dict[str, dict[str, dict[str, Gate]]]


Key = tuple[str, str, str]  # case, quantity, level
Gates = dict[Key, Gate]


def down(value: float, digits: int = 2) -> float:
    """A number >= 0 rounded down to so many significant digits."""
    return float(Context(digits, ROUND_DOWN).create_decimal(repr(value)))


def is_round_off(no_order: str) -> bool:
    """Whether the reason why a quantity has no order says that it holds to rounding."""
    return no_order.startswith(ROUND_OFF)


def gate_of(no_order: str, error: float, order: float | None, mutants: dict[str, float]) -> Gate:
    """The gate that a measured error and order ask for; raises CannotAccept where it would let something plainly wrong pass."""
    if not math.isfinite(error):
        raise CannotAccept(f"the error is {error}")
    size = down(abs(error), 4)
    if is_round_off(no_order):
        decade = 10.0 ** math.ceil(math.log10(10.0 * size)) if size > 0.0 else 0.0
        allowed = min(max(decade, ROUND_OFF_FLOOR), ROUND_OFF_MOST)
        if 3.0 * size > ROUND_OFF_MOST:
            raise CannotAccept(f"an error of {size:.2g} is no round-off")
    else:
        allowed = down(SHARE * size)
        if allowed < ROUND_OFF_FLOOR:
            raise CannotAccept(f"an error of {size:.2g} is round-off: let no_order begin with {ROUND_OFF!r}")
    survivors = [name for name, wrong in mutants.items() if abs(wrong) <= allowed]
    if survivors:
        raise CannotAccept(f"an error of {size:.2g} is so large that {', '.join(survivors)} would pass")
    if order is None:
        return Gate(allowed, size)
    if not math.isfinite(order) or order <= ORDER_LOSS:
        raise CannotAccept(f"an order of {order:.2f} is no convergence: find out why, or say it in no_order")
    return Gate(allowed, size, math.ceil(100.0 * (order - ORDER_LOSS) - 1e-9) / 100.0, math.floor(1000.0 * order) / 1000.0)


def read(family: str, folder: Path | None = None) -> Gates:
    """The gates of a family, none where it has no file; raises ValueError for a file that is not as `write` leaves it."""
    book = store.read(Book, (folder or FOLDER) / f"{family}.json") or Book(family, {})
    return {
        (case, quantity, level): gate
        for case, quantities in book.cases.items() for quantity, levels in quantities.items() for level, gate in levels.items()
    }  # fmt: skip


def write(family: str, gates: Gates, folder: Path | None = None) -> None:
    """Write the gates of a family, in their order."""
    cases: dict[str, Any] = {}
    for (case, quantity, level), gate in gates.items():
        content = {name: value for name, value in asdict(gate).items() if value is not None}
        cases.setdefault(case, {}).setdefault(quantity, {})[level] = content
    store.write(Book(family, cases), (folder or FOLDER) / f"{family}.json")


def keys_of(families: Families, family: str) -> list[Key]:
    """The keys that a family's gates should have, in its order."""
    return [(case.name, quantity.name, level.label) for case in families.get(family, ()) for quantity in case.quantities for level in case.levels]


def stale(families: Families, folder: Path | None = None) -> list[str]:
    """Gates of cases, quantities or levels that there are no more, and files of families that there are none of, a line each."""
    lines = []
    for path in sorted((folder or FOLDER).glob("*.json")):
        if path.stem not in families:
            lines.append(f"{path.name}: there is no family {path.stem}; remove the file")
            continue
        lines += [f"{path.stem}/{' / '.join(key)}" for key in read(path.stem, folder) if key not in keys_of(families, path.stem)]
    return lines


def too_wide(gate: Gate, round_off: bool) -> str:
    """Why a gate is wider than what was measured allows, or nothing."""
    if round_off and gate.error > ROUND_OFF_MOST:
        return f"{gate.error:g} is no gate of round-off"
    if not round_off and gate.error > SHARE * gate.measured * (1.0 + 1e-9):
        return f"{gate.error:g} is more than {SHARE:g} times the measured {gate.measured:g}"
    if (gate.order is None) != (gate.measured_order is None):
        return "an order without a gate, or a gate without an order"
    if gate.order is not None and gate.order < gate.measured_order - ORDER_LOSS - 1e-9:
        return f"order {gate.order:g} is more than {ORDER_LOSS:g} below the measured {gate.measured_order:g}"
    return ""


def loose(gate: Gate, error: float, order: float | None) -> str:
    """In what a result became so much better since its gate was accepted that the gate is no longer tight, or nothing."""
    better = [f"error {abs(error):.3g}, accepted at {gate.measured:g}"] if abs(error) < FALLEN * gate.measured else []
    better += [f"order {order:.2f}, accepted at {gate.measured_order:.2f}"] if risen(gate, order) > RISEN else []
    return f"gate can be tightened ({'; '.join(better)}): --accept" if better else ""


def risen(gate: Gate, order: float | None) -> float:
    """By how much an order is above the accepted one; 0 where it is not, or where there is none."""
    return max(0.0, order - gate.measured_order) if order is not None and gate.measured_order is not None else 0.0


def changes(before: Gates, now: Gates) -> list[str]:
    """A line for each gate that is new, gone or changed."""

    def words(gate: Gate | None) -> str:
        return "none" if gate is None else f"error {gate.error:g}" + (f" order {gate.order:g}" if gate.order is not None else "")

    lines = []
    for key in dict.fromkeys([*before, *now]):
        old, new = before.get(key), now.get(key)
        if words(old) != words(new):
            wider = old and new and (new.error > old.error or (new.order or 0.0) < (old.order or 0.0))
            lines.append(f"{' / '.join(key)}: {words(old)} -> {words(new)}{'  WIDER' if wider else ''}")
    return lines
