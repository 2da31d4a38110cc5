"""A fracture fed at a constant rate (KGD): length, mouth opening, inlet pressure and volume at and between the two vertices, and with leak-off."""

from collections.abc import Callable
from dataclasses import replace
from operator import attrgetter

import numpy as np

from verification.harness.load import LoadError, Run, given, value
from verification.harness.paths import ANALYTIC
from verification.ladder.case import Array, Case, Quantity, Sample, cell_levels

SCENE, LEAKY = ANALYTIC / "kgd.toml", ANALYTIC / "kgd_leakoff.toml"
FROM = 0.1  # of the run; output times before are left out: the fracture still remembers how it began

TOUGHNESS, VISCOSITY, ANY, LEAKOFF = "kgd_toughness", "kgd_viscosity", "kgd", "kgd_leakoff"


def exact(run: Run, solution: str, name: str, time_s: float) -> float:
    """A value of a solution for a run's rock and fluid at a time, SI."""
    settings = {
        "time_s": round(time_s, 9), "toughness_Pa_sqrt_m": given(run, "rock.stiff.toughness_Pa_sqrt_m"),
        "viscosity_Pa_s": given(run, "fluid.viscosity_Pa_s"), "rate_m2_s": given(run, "fluid.inlet.rate_m2_s"),
    }  # fmt: skip
    if solution == LEAKOFF:
        settings |= {"leakoff_m_sqrt_s": given(run, "rock.stiff.leakoff_m_sqrt_s"), "youngs_modulus_Pa": given(run, "rock.stiff.youngs_modulus_Pa")}
    return value(solution, name, **settings)


def lengths(run: Run) -> Array:
    """The front's place (m) at all rows: at a growth it is where the tip was till then, between two it goes evenly, and after the last
    as fast as before it. The tip itself stands at the end of the cell that the front is in."""
    time_s, tip = run.history["time_s"], run.history["tip_y_m"]
    grown = np.flatnonzero(np.diff(tip) > 0.0) + 1
    t, y = time_s[grown], tip[grown - 1]
    return np.interp(time_s, np.append(t, 2.0 * t[-1] - t[-2]), np.append(y, 2.0 * y[-1] - y[-2]))


def found(run: Run, name: str) -> Array:
    """A quantity of the reference at all rows of a run's history, SI."""
    if name == "inlet_pressure_Pa":
        return run.history["inlet_Pa"] - given(run, "in_situ.horizontal_Pa")
    if name == "efficiency":
        return run.history["fracture_volume_m2"] / (0.5 * given(run, "fluid.inlet.rate_m2_s") * np.maximum(run.history["time_s"], 1e-9))
    return lengths(run) if name == "half_length_m" else run.history[name]


def output_rows(run: Run) -> Array:
    """The rows of the history that belong to output times from a tenth of the run on, one each."""
    time_s, every, end = run.history["time_s"], given(run, "output.fields_every_s"), given(run, "stop.time_s")
    outputs = np.arange(FROM * end, end + 0.5 * every, every)
    rows = [int(np.argmin(np.abs(time_s - t))) for t in outputs]
    if any(abs(time_s[row] / every - round(time_s[row] / every)) > 1e-6 for row in rows):
        raise LoadError(f"{run.folder}: no row of history at each output time; the fracture may have come to the stop")
    return np.array(rows)


def course(solution: str, name: str, rows: slice = slice(None)) -> Callable[[Run], Sample]:
    """A quantity at (some of) these times, each weighted so that its relative error counts."""

    def sample(run: Run) -> Sample:
        asked = output_rows(run)[rows]
        expected = np.array([exact(run, solution, name, float(run.history["time_s"][row])) for row in asked])
        return Sample(found(run, name)[asked], expected, 1.0 / expected**2)

    return sample


STEPS = "the tip moves by whole cells, which at one moment may fit or not"
KEPT = "what compression of the fluid and rough faces keep is a property of the scene"
# Where little is left of the tip's error, what steps, cells along the fracture and the block's edges do is as large, of either sign.
LEFT = "what is left, below 1 %, is the sum of errors of either sign"
SMALL = {"0.125 m": LEFT}
NAMES = {"half length": ("half_length_m", "m"), "mouth opening": ("mouth_opening_m", "m"), "inlet pressure": ("inlet_pressure_Pa", "Pa")}
FLUID = (
    # What the modelled half of the fracture holds at the end against half of what was fed.
    Quantity.of("fracture volume at 100 s", "m^2", attrgetter("summary.fracture_volume_m2"),
                lambda run: 0.5 * given(run, "fluid.inlet.rate_m2_s") * run.summary.time_s, KEPT),
    Quantity.of("missing fluid", "1", lambda run: run.history["fluid_volume_balance"][-1], lambda _: 0.0,
                "round-off: the fluid's volume is conserved", scale=1.0),
)  # fmt: skip


def quantities(solution: str) -> tuple[Quantity, ...]:
    """What is held against a solution: over time and at the end; and the fluid's volume."""
    over_time = (Quantity(f"{words}, 10 to 100 s", unit, course(solution, name), no_order_at=SMALL if solution != TOUGHNESS else {})
                 for words, (name, unit) in NAMES.items())
    at_end = (Quantity(f"{words} at 100 s", unit, course(solution, name, slice(-1, None)), STEPS) for words, (name, unit) in NAMES.items())
    return (*over_time, *at_end, *FLUID)


LEAKS = {words: Quantity(f"{words}, 50 to 500 s", unit, course(LEAKOFF, name), no_order_at=SMALL | {"0.25 m": LEFT})
         for words, (name, unit) in (NAMES | {"efficiency": ("efficiency", "1")}).items()}  # fmt: skip
NO_LEAKS = LEAKS | {"efficiency": replace(LEAKS["efficiency"], no_order=KEPT)}
START = "fracture.path_m=[[120.0, 0.0], [120.0, 1.0]]"  # by 10 s the fracture has forgotten it
GEOS = "GEOS, its stored results against"
CASES = tuple(
    Case(variant, says, SCENE, "quasistatic",
         cell_levels(0.5, 0.25, 0.125, variant=variant, of=(lambda h: (f"fracture.increment_m={h!r}", START),)), quantities(solution), 1)
    for variant, says, solution in (
        ("toughness", f"toughness vertex, toughness number 13.6 ({GEOS} the same closed form, mean from 10 s on: "
         "length 6.4, pressure 3.3, opening 1.1 %)", TOUGHNESS),
        ("viscosity", f"viscosity vertex, no toughness ({GEOS} its own asymptote, mean: length 4.4, pressure 1.9, opening 0.9 %)", VISCOSITY),
        ("transition", "between the vertices, toughness number 1.36", ANY),
    )
) + tuple(
    Case(name, says, LEAKY, "quasistatic",
         cell_levels(0.5, 0.25, 0.125, variant=variant, of=(lambda h: (f"fracture.increment_m={h!r}",),)), (*found_of.values(), FLUID[1]), 1)
    for name, variant, found_of, says in (
        ("leak_off", "", LEAKS, "leak-off of 1e-5 m/sqrt(s), toughness number 1.18: efficiency 0.41 at 500 s"),
        ("little_leak_off", "little", LEAKS, "leak-off of 1e-6 m/sqrt(s): efficiency 0.90"),
        ("thick_oil", "thick", LEAKS, "20 times the viscosity and leak-off of 2e-5 m/sqrt(s), toughness number 0.56: efficiency 0.34 at 500 s"),
        ("no_leak_off", "none", NO_LEAKS, "the same without leak-off"),
    )
)  # fmt: skip
