"""What leaving an ingredient out does to what is followed of a scene, as shares, and what follows for the scene.

A pressure counts by its net part, P less the stress that closes the fracture: a background can be added to both at will. A height counts
by the base's own, a path by its length. An ingredient whose run has no value where the base has one changes what happens.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from verification.ablation.ingredients import MODELLED, RESOLVED, Ingredient
from verification.harness import quantities as harness
from verification.harness.load import Run
from verification.harness.observables import path_length
from verification.harness.quantities import NO_ARREST, Effect, Quantity

# A scene is to be right to this share.
WANTED = 0.01

# CPU times of the same run differ by this share from one to the next; what saves less than that costs nothing.
NO_SAVING = 0.05

# Verdicts on an ingredient.
NEEDED, SPARED, CHANGES, NOTHING = "needed", "not needed", "needed: without it something else happens", "says nothing"


@dataclass(frozen=True)
class Tried:
    """An ingredient left out: how that run ended, its effects (in units, and as shares), and its CPU time, s."""

    id: str
    label: str
    group: str
    done: str
    settings: tuple[str, ...]
    status: str  # "completed", "failed", "refused"; "" where it does not apply
    reason: str
    effects: dict[str, Effect]
    shares: dict[str, float]
    cpu_s: float

    @property
    def applies(self) -> bool:
        """Whether the scene has it at all."""
        return bool(self.status)

    @property
    def largest(self) -> float | None:
        """The largest share, None where nothing could be compared."""
        return max(self.shares.values(), default=None)

    @property
    def lost(self) -> list[str]:
        """What of the base its run does not have."""
        return [name for name, effect in self.effects.items() if effect.value is None]

    @property
    def verdict(self) -> str:
        """What 1 % asks of the scene."""
        if self.status != "completed":
            return NOTHING
        if self.lost:
            return CHANGES
        return NOTHING if self.largest is None else NEEDED if self.largest >= WANTED else SPARED


def scale_of(quantity: Quantity, base: Run) -> float:
    """What a quantity's effect is a share of, in its unit; raises ValueError where it is nothing."""
    value = quantity.measure(base).low
    closing = float(base.scene.get("in_situ", {}).get("horizontal_Pa", 0.0)) if quantity.unit == "Pa" else 0.0
    scale = abs(value - closing)
    if not scale > 0.0:
        raise ValueError(f"{quantity.name} of {base.name} is {value}: nothing to be a share of")
    return scale


def effects_of(quantities: Sequence[Quantity], with_path: bool, base: Run, run: Run) -> tuple[dict[str, Effect], dict[str, float]]:
    """Effects of a run, as it is read, against the base, and the same as shares where they are known.

    An arrest of the base that is none in the run is lost: what is at the place is no pause.
    """
    found = harness.effects_of(quantities, with_path, base, run)
    found = {name: Effect(None, NO_ARREST) if NO_ARREST in effect.note else effect for name, effect in found.items()}
    scales = {one.name: (lambda one=one: scale_of(one, base)) for one in quantities} | {"path_m": lambda: path_length(base.path)}
    return found, {name: abs(effect.value) / scales[name]() for name, effect in found.items() if effect.value is not None}


def tried(ingredient: Ingredient, status: str, reason: str, found: tuple[dict[str, Effect], dict[str, float]], cpu_s: float) -> Tried:
    """An ingredient with what came of leaving it out; raises ValueError for a share that is no number."""
    if any(not math.isfinite(share) for share in found[1].values()):
        raise ValueError(f"{ingredient.id}: shares {found[1]} are not finite")
    own = (ingredient.id, ingredient.label, ingredient.group, ingredient.done, ingredient.settings)
    return Tried(*own, status, reason or ingredient.why_not, *found, cpu_s)


def _of_scene(lines: Sequence[Tried], own: bool) -> list[Tried]:
    """What a scene has (own), or goes without."""
    return [line for line in lines if (line.group in (MODELLED, RESOLVED)) == own]


def not_needed(lines: Sequence[Tried], base_s: float) -> list[Tried]:
    """What the scene models or resolves at a cost (its own run takes base_s) although 1 % does not ask for it: each wants a reason."""
    return [line for line in _of_scene(lines, True) if line.verdict == SPARED and line.cpu_s < (1.0 - NO_SAVING) * base_s]


def free(lines: Sequence[Tried], base_s: float) -> list[Tried]:
    """What 1 % does not ask for but costs nothing, or saves time as symmetry does: no reason is wanted."""
    return [line for line in _of_scene(lines, True) if line.verdict == SPARED and not line.cpu_s < (1.0 - NO_SAVING) * base_s]


def needs(lines: Sequence[Tried]) -> list[Tried]:
    """What the scene needs for 1 %."""
    return [line for line in _of_scene(lines, True) if line.verdict in (NEEDED, CHANGES)]


def missing(lines: Sequence[Tried]) -> list[Tried]:
    """What the scene goes without although that moves it by 1 % or more."""
    return [line for line in _of_scene(lines, False) if line.verdict in (NEEDED, CHANGES)]
