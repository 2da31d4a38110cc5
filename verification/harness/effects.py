"""What one change of a scene moves in what is followed of it: a run against the scene's own."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from verification.harness.load import Run
from verification.harness.quantities import HEIGHTS_M, NO_ARREST, Quantity, lack_words, path_gap, quantities_of

# The height at which the pressure is compared where the base gets there, m; else the highest below that it reaches.
HEIGHT_M = 40.0

NOT_FOLLOWED = ("final_height_m", "final_Pa", "final_angle_deg", "deflection_m", "plateau")


@dataclass(frozen=True)
class Effect:
    """What a change moves a quantity by (None where it says nothing, with the reason), in the quantity's unit."""

    value: float | None
    note: str = ""


def followed(content: dict[str, Any], base: Run) -> list[Quantity]:
    """What is compared: start, arrests that the base has, and the pressure at a height that it reaches."""
    top = min(float(base.history["tip_y_m"].max()), HEIGHT_M)
    reached = [height for height in HEIGHTS_M if height <= top]
    own = [(one, one.measure(base)) for one in quantities_of(content, reached[-1:]) if not one.name.startswith(NOT_FOLLOWED)]
    return [one for one, measured in own if measured.exact and NO_ARREST not in measured.flags]


def effects_of(quantities: Sequence[Quantity], with_path: bool, base: Run, run: Run, short: str = "") -> dict[str, Effect]:
    """What a run moves each quantity by against the base, by its name, and how far its path is off (`short`: a note on that)."""
    effects: dict[str, Effect] = {}
    for quantity in quantities:
        measured = quantity.measure(run)
        if measured.exact:
            effects[quantity.name] = Effect(measured.low - quantity.measure(base).low, ", ".join(measured.flags))
        else:
            effects[quantity.name] = Effect(None, lack_words(measured, run, quantity.unit))
    if with_path:
        gap = path_gap(run, base)
        effects["path_m"] = Effect(None, "does not grow") if gap is None else Effect(gap[1], short)
    return effects
