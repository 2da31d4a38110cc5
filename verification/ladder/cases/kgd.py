"""A fracture fed at a constant rate (KGD): length, mouth opening, inlet pressure and volume at and between the two vertices."""
from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from verification.harness.load import LoadError, Run
from verification.harness.paths import ANALYTIC
from verification.harness.reference import reference
from verification.ladder.case import Array, Case, Level, Quantity, Sample

SCENE = ANALYTIC / "kgd.toml"
FROM_S = 10.0  # output times before are left out: the fracture still remembers how it began

TOUGHNESS, VISCOSITY, ANY = "kgd_toughness", "kgd_viscosity", "kgd"


@lru_cache(maxsize=None)
def _exact(solution: str, **asked: float) -> dict[str, float]:
    """The values of a solution, SI."""
    return {name: item.value for name, item in reference(solution, **asked).items()}


def exact(run: Run, solution: str, time_s: float) -> dict[str, float]:
    """The values of a solution for a run's rock and fluid at a time, SI."""
    fluid, rock = run.scene["fluid"], run.scene["rock"]["stiff"]
    return _exact(
        solution, time_s=round(time_s, 9), toughness_Pa_sqrt_m=float(rock["toughness_Pa_sqrt_m"]),
        viscosity_Pa_s=float(fluid["viscosity_Pa_s"]), rate_m2_s=float(fluid["inlet"]["rate_m2_s"]),
    )  # fmt: skip


def found(run: Run, name: str) -> Array:
    """A quantity of the reference at all rows of a run's history, SI."""
    if name == "inlet_pressure_Pa":
        return run.history["inlet_Pa"] - float(run.scene["in_situ"]["horizontal_Pa"])
    return run.history[{"half_length_m": "tip_y_m", "mouth_opening_m": "mouth_opening_m"}[name]]


def output_rows(run: Run) -> Array:
    """The rows of the history that belong to output times from 10 s on, one each."""
    time_s, every = run.history["time_s"], float(run.scene["output"]["fields_every_s"])
    outputs = np.arange(FROM_S, float(run.scene["stop"]["time_s"]) + 0.5 * every, every)
    rows = [int(np.argmin(np.abs(time_s - t))) for t in outputs]
    if any(abs(time_s[row] / every - round(time_s[row] / every)) > 1e-6 for row in rows):
        raise LoadError(f"{run.folder}: no row of history at each output time; the fracture may have come to the stop")
    return np.array(rows)


def course(solution: str, name: str) -> Callable[[Run], Sample]:
    """A quantity at the output times from 10 s on, each weighted so that its relative error counts."""

    def sample(run: Run) -> Sample:
        rows = output_rows(run)
        expected = np.array([exact(run, solution, float(run.history["time_s"][row]))[name] for row in rows])
        return Sample(found(run, name)[rows], expected, 1.0 / expected**2)

    return sample


def at_end(solution: str, name: str) -> Callable[[Run], Sample]:
    """A quantity at the end of the run."""

    def sample(run: Run) -> Sample:
        row = output_rows(run)[-1]
        return Sample.of(float(found(run, name)[row]), exact(run, solution, float(run.history["time_s"][row]))[name])

    return sample


def volume(run: Run) -> Sample:
    """What the modelled half of the fracture holds at the end against half of what was fed, m^2."""
    fed = 0.5 * float(run.scene["fluid"]["inlet"]["rate_m2_s"]) * run.summary.time_s
    return Sample.of(run.summary.fracture_volume_m2, fed)


def balance(run: Run) -> Sample:
    """The share of the fluid that is missing at the end."""
    return Sample.of(float(run.history["fluid_volume_balance"][-1]), 0.0, scale=1.0)


STEPS = "the tip moves by whole cells, which at one moment may fit or not"
KEPT = "what compression of the fluid and rough faces keep is a property of the scene"
# A new cell at the tip is closed, and the fluid there is below the closing stress: it fills by the floor of the opening alone. A
# fracture in coarse cells waits for it, one in fine cells is let ahead of it.
OVERTAKEN = {
    (variant, "half length"): {"0.125 m": "the length goes from too short to too long: the floor lets fluid into a closed cell"}
    for variant in ("viscosity", "transition")
}
NAMES = {
    "half length": ("half_length_m", "m"),
    "mouth opening": ("mouth_opening_m", "m"),
    "inlet pressure": ("inlet_pressure_Pa", "Pa"),
}


def quantities(variant: str, solution: str) -> tuple[Quantity, ...]:
    """What is held against a solution: over time and at the end; and the fluid's volume."""
    return (
        *(
            Quantity(f"{words}, 10 to 100 s", unit, course(solution, name), no_order_at=OVERTAKEN.get((variant, words), {}))
            for words, (name, unit) in NAMES.items()
        ),
        *(Quantity(f"{words} at 100 s", unit, at_end(solution, name), STEPS) for words, (name, unit) in NAMES.items()),
        Quantity("fracture volume at 100 s", "m^2", volume, KEPT),
        Quantity("missing fluid", "1", balance, "round-off: the fluid's volume is conserved"),
    )


START_M = 1.0  # by 10 s the fracture has forgotten it
CELLS_M = (0.5, 0.25, 0.125)


def levels(variant: str) -> tuple[Level, ...]:
    """Three sizes of cells, a cell a step of growth."""
    start = f"fracture.path_m=[[120.0, 0.0], [120.0, {START_M!r}]]"
    return tuple(Level(f"{h:g} m", h, (f"numerics.cell_m={h!r}", f"fracture.increment_m={h!r}", start), variant) for h in CELLS_M)


CASES = tuple(
    Case(variant, says, SCENE, "quasistatic", levels(variant), quantities(variant, solution), 1)
    for variant, says, solution in (
        (
            "toughness",
            "toughness vertex, toughness number 13.6 (GEOS, its stored results against the same closed form, mean from 10 s on: "
            "length 6.4, pressure 3.3, opening 1.1 %)",
            TOUGHNESS,
        ),
        (
            "viscosity",
            "viscosity vertex, no toughness (GEOS, its stored results against its own asymptote, mean: length 4.4, pressure 1.9, "
            "opening 0.9 %)",
            VISCOSITY,
        ),
        ("transition", "between the vertices, toughness number 1.36", ANY),
    )
)
