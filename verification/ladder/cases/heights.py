"""A crack through layers of one stiffness and unlike stress and toughness: the heights that a rising pressure reaches, K under a stress that changes with depth.

The reference of heights is strata-reference layered_height; K of a linear stress and of a shear stress in a plane without end are closed forms.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from verification.harness.load import Run, column, energy, given, half_length, last, lower, pressure_beyond, tip, upper, values
from verification.harness.paths import ANALYTIC
from verification.ladder.case import Quantity, Sample, case_of, cell_levels

SCENE = ANALYTIC / "stress_by_layer.toml"
HALF_TALL_M = (11.0, 12.0, 20.0, 50.0)  # upper halves of the heights held; the first leaves two cells of 0.5 m beyond the border
UNLIKE_M = (62.0, 65.0, 70.0, 75.0, 77.0, 92.0, 95.0)  # of six layers: the start, two borders and places between
STEPS = "heights are whole increments"
RINGS = "the rings are 4 cells wide at every size: the error of the tip inside them does not fall with the cell"


def passing(name: str, *heights_m: float) -> Quantity:
    """Net pressures at which the upper tip passes heights, above the least closing stress."""

    def sample(run: Run) -> Sample:
        settings = column(run)
        found = np.array([pressure_beyond(run, y) for y in heights_m])
        wanted = values("layered_height", "pressure_to_pass_Pa", **settings, height_m=list(heights_m))
        return Sample(found - min(settings["stress_Pa"]), wanted - min(settings["stress_Pa"]))

    return Quantity(name, "Pa", sample, RINGS)


def end_of(which: Callable[[Run], Any], quantity: str) -> Callable[[Run], Sample]:
    """A tip at the end, in shares of an increment of growth."""
    return lambda run: Sample.of(which(run).y_m, float(values("layered_height", quantity, **column(run), pressure_Pa=[run.summary.inlet_Pa])[0]),
                                 given(run, "fracture.increment_m"))


def K_linear(sign: float) -> Callable[[Run], float]:
    """K_I of the upper (1) or lower (-1) tip under p + g y: (p + sign g a/2) sqrt(pi a), by Griffith's integral."""

    def exact(run: Run) -> float:
        a, g = half_length(run), 20e3  # the scene's "40e6 - 20e3*(Y - 55)", with the crack's middle at 55 m
        return (run.summary.inlet_Pa - 40e6 + sign * 0.5 * g * a) * math.sqrt(math.pi * a)

    return exact


def driving_Pa(run: Run) -> float:
    """The shear stress that friction on closed faces leaves, t - mu (s_h - P)."""
    rubs = given(run, "fracture.friction") * max(0.0, given(run, "in_situ.horizontal_Pa") - run.summary.inlet_Pa)
    return max(0.0, given(run, "in_situ.shear_Pa") - rubs)


def K_shear(run: Run) -> float:
    """K_II under sigma_xy = t: -t sqrt(pi a), since positive K_II turns growth clockwise and t turns it the other way."""
    return -driving_Pa(run) * math.sqrt(math.pi * half_length(run))


def rubbed_J(run: Run) -> float:
    """Work of friction, half of its last value times the slip: w = (4 t/E') sqrt(a^2 - x^2)."""
    E, nu = (run.scene["rock"]["tender"][key] for key in ("youngs_modulus_Pa", "poisson_ratio"))
    slip_m2 = 2.0 * math.pi * half_length(run) ** 2 * driving_Pa(run) * (1.0 - nu**2) / E
    return 0.5 * given(run, "fracture.friction") * (given(run, "in_situ.horizontal_Pa") - run.summary.inlet_Pa) * slip_m2


K_UNIT = "Pa sqrt(m)"
case = case_of(SCENE)
CASES = (
    case("barrier", "half of a crack between two barriers of 0.75 MPa, run up by its pressure", cell_levels(1.0, 0.5, variant="barrier"),
         tuple(passing(f"net pressure that holds {2.0 * y:g} m", y) for y in HALF_TALL_M)),
    case("six_layers", "both tips through six layers of unlike stress and toughness", cell_levels(1.0, 0.5),
         (passing("net pressures that pass seven heights", *UNLIKE_M),
          Quantity("upper tip at the end, in increments", "m", end_of(upper, "top_m"), STEPS), Quantity("lower tip at the end, in increments", "m", end_of(lower, "bottom_m"), STEPS)),
         smoke=1),
    case("sloped", "closing stress that falls with height", cell_levels(1.0, 0.5, 0.25, variant="sloped"),
         (Quantity.of("K_I of the upper tip", K_UNIT, tip("K_I_Pa_sqrt_m", upper), K_linear(1.0), RINGS),
          Quantity.of("K_I of the lower tip", K_UNIT, tip("K_I_Pa_sqrt_m", lower), K_linear(-1.0), RINGS))),
    case("sheared", "in-situ shear stress along the crack", cell_levels(1.0, 0.5, 0.25, variant="sheared"),
         (Quantity.of("K_II of the upper tip", K_UNIT, tip("K_II_Pa_sqrt_m", upper), K_shear, RINGS),
          Quantity.of("K_II of the lower tip", K_UNIT, tip("K_II_Pa_sqrt_m", lower), K_shear, RINGS))),
    case("rubbing", "a closed crack that slides against its own friction", cell_levels(1.0, 0.5, 0.25, variant="rubbing"),
         (Quantity.of("K_II", K_UNIT, tip("K_II_Pa_sqrt_m", upper), K_shear, RINGS),
          Quantity.of("work of friction", "J/m", energy("friction_J"), rubbed_J))),
    case("sticking", "the same crack, held by friction", cell_levels(1.0, 0.5, variant="sticking"),
         (Quantity.of("largest slip", "m", lambda run: np.max(np.abs(last(run, "fracture")[1]["slip_m"])), lambda _: 0.0, "contact gives way by its penalty", scale=4.8e-3),)),  # free: 4 t a/E'
)  # fmt: skip
