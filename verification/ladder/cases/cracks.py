"""A pressurised crack at rest: K by the interaction integral, by J and by energy, its opening, volume and energy.

The references are strata-reference block_crack for the block as it is: the crack starts on the symmetric bottom, or is whole.
"""

import math
from collections.abc import Callable
from operator import attrgetter
from typing import Any

import numpy as np

from verification.harness.load import LoadError, Run, energy, given, last, net_Pa, start_of, tip, value, values
from verification.harness.paths import ANALYTIC
from verification.ladder.case import Case, Keys, Level, Quantity, Sample, case_of, cell_levels

SETTLED, AT_REST, INCLINED = (ANALYTIC / f"{name}.toml" for name in ("static_crack", "static_quasistatic", "inclined_crack"))
NET_PA = 0.3e6  # the scenes' pressure above their closing stress
AWAY_FROM_TIPS = 0.9  # of the half length: the opening without the tenth of it at the tip

RINGS = "the rings are 4 cells wide at every size: the error of the tip inside them does not fall with the cell"
SYMMETRY = "round-off: the crack is its own mirror image"
PLACES = "where in their cells the tips lie differs from size to size"
BALANCE = "round-off: the fluid carries just the in-situ stress"


def block(run: Run, half_length_m: float | None = None, pressure: dict[str, Any] | None = None) -> dict[str, Any]:
    """A run's block and its crack, or one of another half length, under a pressure (NET_PA); they are modelled whole where the bottom is no mirror."""
    half = 1.0 if run.scene["domain"]["bottom"] == "symmetry" else 0.5
    sizes = {"width_m": given(run, "domain.width_m"), "half_height_m": half * given(run, "domain.height_m")}
    length = half_length_m or half * math.dist(*run.scene["fracture"]["path_m"])
    return {**sizes, "half_length_m": length, **(pressure or {"pressure_Pa": NET_PA})}


def loaded(run: Run) -> dict[str, Any]:
    """The same of a run whose net pressure is NET_PA; raises LoadError for another."""
    if not math.isclose(net_Pa(run), NET_PA, rel_tol=1e-9):
        raise LoadError(f"{run.folder}: the net pressure is {net_Pa(run)} Pa")
    return block(run)


def endless(run: Run) -> dict[str, Any]:
    """The run's crack in a plane without end."""
    return {key: loaded(run)[key] for key in ("half_length_m", "pressure_Pa")}


def sloped(run: Run) -> dict[str, Any]:
    """The run's block and crack under the pressure that the run has along it, taken as it is."""
    fields = last(run, "fracture")[1]
    x, p = fields["arc_m"], fields["pressure_Pa"] - given(run, "in_situ.horizontal_Pa")
    if p[-1] > 0.5 * p[0]:
        raise LoadError(f"{run.folder}: the pressure hardly falls along the fracture")
    profile = {"profile_x_m": [*(-x[:0:-1]).tolist(), *x.tolist()], "profile_Pa": [*p[:0:-1].tolist(), *p.tolist()]}
    return block(run, pressure={"pressure": "profile", **profile})


def exact(quantity: str, share: float = 1.0, settings: Callable[[Run], dict[str, Any]] = loaded, of: str = "block_crack") -> Callable[[Run], float]:
    """A share of a value of the reference for a run."""
    return lambda run: share * value(of, quantity, **settings(run))


def by_J(run: Run) -> float:
    """The K_I that J stands for, sqrt(J E'); Pa sqrt(m)."""
    return math.sqrt(run.summary.tips[0].J_N_m * value("block_crack", "E_prime_Pa", **block(run)))


def K_I(run: Run) -> Sample:
    """K_I by the interaction integral, at each tip; Pa sqrt(m)."""
    tips, wanted = run.summary.tips, exact("K_I")(run)
    if len(tips) == 1:
        return Sample.of(tips[0].K_I_Pa_sqrt_m, wanted)
    return Sample(np.array([tip.K_I_Pa_sqrt_m for tip in tips]), np.full(len(tips), wanted), reference_error=exact("F")(run) - 1.0)


def K_II(run: Run) -> Sample:
    """K_II of the tips against none, in shares of K_I."""
    found = np.array([tip.K_II_Pa_sqrt_m for tip in run.summary.tips])
    return Sample(found, np.zeros(found.shape), None, exact("K_I")(run))


def profile(share: float) -> Callable[[Run], Sample]:
    """The opening from the mouth to a share of the half length, at the fracture's vertices."""

    def sample(run: Run) -> Sample:
        fields, settings = last(run, "fracture")[1], loaded(run)
        arc, a = fields["arc_m"], settings["half_length_m"]
        asked = arc <= share * a * (1.0 + 1e-5)  # points move with the rock
        return Sample(fields["opening_m"][asked], values("block_crack", "opening_m", **settings, x_m=np.minimum(arc[asked], a).tolist()))

    return sample


def volume_at(run: Run, tip_y_m: float) -> float:
    """Volume of the modelled half of a growing fracture when its tip is at a height, m^2; IndexError where it never was."""
    return float(run.history["fracture_volume_m2"][np.abs(run.history["tip_y_m"] - tip_y_m) < 1e-6][0])


def volume_of(run: Run, half_length_m: float) -> float:
    """The same by the reference."""
    return 0.5 * value("block_crack", "volume_m2", **block(run, half_length_m))


def K_by_energy(volume: Callable[[Run, float], float]) -> Callable[[Run], float]:
    """K_I that the energy released between 4 m and 6 m stands for: G = (p/2) dV/da at a constant pressure; Pa sqrt(m)."""
    return lambda run: math.sqrt(exact("E_prime_Pa")(run) * 0.5 * NET_PA * (volume(run, 6.0) - volume(run, 4.0)) / 2.0)


def start_Pa(run: Run) -> float:
    """Net pressure at which the fracture starts, Pa; it must then have gone on to 10 m."""
    if run.summary.tips[0].y_m < 10.0:
        raise LoadError(f"{run.folder}: growth under a constant pressure stopped")
    return net_Pa(run, start_of(run).inlet_Pa)


def nothing(name: str, unit: str, measured: Callable[[Run], float], scale: str) -> Quantity:
    """What is to be nothing where the fluid just carries the in-situ stress, in shares of that under NET_PA."""
    return Quantity(name, unit, lambda run: Sample.of(measured(run), 0.0, exact(scale, settings=block)(run)), BALANCE)


K, MOUTH, VOLUME = tip("K_I_Pa_sqrt_m"), attrgetter("summary.mouth_opening_m"), attrgetter("summary.fracture_volume_m2")
K_UNIT = "Pa sqrt(m)"
AT_TIP = (
    Quantity("K_I", K_UNIT, K_I, RINGS),
    Quantity.of("K by J", K_UNIT, by_J, exact("K_I"), RINGS),
    Quantity("K_II / K_I", K_UNIT, K_II, SYMMETRY),
    Quantity.of("spread of J over the rings", "1", tip("J_spread"), lambda _: 0.0, RINGS, scale=1.0),
)
BOTH_TIPS = (Quantity("K_I of both tips", K_UNIT, K_I, PLACES), Quantity("K_II / K_I of both tips", K_UNIT, K_II, PLACES))
CRACK = (
    *AT_TIP,
    Quantity.of("mouth opening", "m", MOUTH, exact("mouth_opening_m")),
    Quantity.of("fracture volume", "m^2", VOLUME, exact("volume_m2", 0.5)),
    Quantity.of("stored energy", "J/m", energy("strain_J"), exact("volume_m2", 0.25 * NET_PA)),  # p V/2 of the modelled half
    # Order 1: in the last two cells the opening is off by a sixth whatever their size, and the crack as a whole is that of one
    # longer by some 0.03 cells, which is felt everywhere.
    Quantity("opening, whole crack", "m", profile(1.0)),
    Quantity("opening, 10 % at the tip left out", "m", profile(AWAY_FROM_TIPS)),
)
SLOPED = (
    Quantity.of("K_I", K_UNIT, K, exact("K_I", settings=sloped), RINGS, reference_error=1e-6),
    # The face terms of J have the slope of the pressure in them.
    Quantity.of("K by J", K_UNIT, by_J, exact("K_I", settings=sloped), RINGS, reference_error=1e-6),
    Quantity.of("fracture volume", "m^2", VOLUME, exact("volume_m2", 0.5, sloped), reference_error=1e-6),
)
RELEASED = (
    Quantity.of("K by energy, 4 to 6 m", K_UNIT, K_by_energy(volume_at), K_by_energy(volume_of)),
    Quantity.of("G of the last step, 5 to 6 m", "N/m", lambda run: run.history["G_N_m"][-1],
                lambda run: 0.5 * NET_PA * (volume_of(run, 6.0) - volume_of(run, 5.0))),
)
ENDLESS = (
    Quantity.of("K_I", K_UNIT, K, exact("K_I", 1.0, endless, "pressurised_crack"), RINGS),
    Quantity.of("mouth opening", "m", MOUTH, exact("mouth_opening_m", 1.0, endless, "pressurised_crack")),
    Quantity.of("fracture volume", "m^2", VOLUME, exact("volume_m2", 0.5, endless, "pressurised_crack")),
)
START = (Quantity.of("critical net pressure", "Pa", start_Pa, exact("critical_net_pressure_Pa", settings=block), RINGS),)
CLOSED = (nothing("J", "N/m", lambda run: max(abs(tip.J_N_m) for tip in run.summary.tips), "J_N_m"), nothing("mouth opening", "m", MOUTH, "mouth_opening_m"))


def levels(cells_m: tuple[float, ...], variant: str = "", *of: Keys) -> tuple[Level, ...]:
    """Levels of cells (m) of a variant, with what further keys ask for at each."""
    return cell_levels(*cells_m, variant=variant, of=of)


def graded(h: float, times: float = 8.0) -> tuple[str, ...]:
    """Cells far away so many times as large."""
    return (f"numerics.far_cell_m={times * h!r}",)


def mid_cell(block_m: float) -> Keys:
    """The crack between two grid lines, in the middle of a block that is wider by a cell."""

    def keys(h: float) -> tuple[str, ...]:
        x = 0.5 * (block_m + h)
        return f"domain.width_m={2.0 * x!r}", f"fracture.path_m=[[{x!r}, 0.0], [{x!r}, 5.0]]"

    return keys


def turned(degrees: float, block_m: float) -> Keys:
    """The crack in the middle of a block, at an angle from the vertical, clockwise; its ends to 0.1 mm."""
    x, y = 5.0 * math.sin(math.radians(degrees)), 5.0 * math.cos(math.radians(degrees))
    ends = [[round(0.5 * block_m + sign * x, 4), round(0.5 * block_m + sign * y, 4)] for sign in (-1.0, 1.0)]
    return lambda _: (f"domain.width_m={block_m!r}", f"domain.height_m={block_m!r}", f"fracture.path_m={ends}")


at_rest, settled = case_of(AT_REST, "quasistatic", CRACK), case_of(SETTLED, "explicit", CRACK)
turned_by = case_of(INCLINED, "quasistatic", BOTH_TIPS, 1)


def inclined(degrees: float) -> tuple[Case, Case]:
    """A crack at an angle to the grid in both mechanics."""
    name, says = f"inclined_{degrees:g}", f"crack turned by {degrees:g} degrees against the grid: K_I as if it were not, no K_II"
    still = levels(FINE, "", turned(degrees, 400.0), graded, lambda _: ("stop.time_s=0",))
    moving = levels((2.0, 1.6, 1.0), "", turned(degrees, 160.0))
    return turned_by(name, says, still), turned_by(f"{name}_explicit", says, moving, mechanics="explicit")


FINE = (1.0, 0.5, 0.25)
FINEST = (*FINE, 0.125)
CASES = (
    at_rest("line", "crack on a grid line of the study's block", levels(FINE)),
    at_rest("mid_cell", "crack between two grid lines", levels(FINE, "", mid_cell(80.0))),
    at_rest("linear", "crack on a grid line, linear shape functions", levels(FINE, "linear"), smoke=1),
    at_rest("graded", "crack on a grid line, cells growing away from it", levels(FINEST, "", graded)),
    at_rest("wide", "crack in a block 400 m wide, graded: opening of order 1, since the tip's error is felt in all of it",
            levels(FINEST, "wide", lambda h: graded(h, 20.0))),
    at_rest("endless", "crack in a small block whose rock goes on for 1600 m", levels(FINEST, "endless", graded), ENDLESS),
    *(at_rest(f"tip_{share:g}", f"tip {share:g} of a cell past a grid line",
              levels(FINE, "", lambda h, share=share: (f"fracture.path_m=[[40.0, 0.0], [40.0, {5.0 + share * h!r}]]",), graded), AT_TIP)
      for share in (0.25, 0.5, 0.75)),
    at_rest("sloped", "net pressure that falls off towards the tip, as the run has it", levels(FINEST, "sloped", graded), SLOPED),
    at_rest("by_energy", "crack that grows from 4 m to 6 m at a constant pressure: K by what that releases",
            levels(FINEST, "grown", graded), RELEASED),
    at_rest("critical", "pressure at which the crack starts", levels(FINE, "critical", graded), START),
    at_rest("closed", "fluid that just carries the in-situ stress", levels(FINE, "closed", graded), CLOSED),
    at_rest("closed_mid_cell", "the same between two grid lines", levels(FINE, "closed", mid_cell(80.0), graded), CLOSED),
    settled("settled", "damped motion, crack on a grid line", levels(FINE)),
    settled("settled_mid_cell", "damped motion, crack between two grid lines", levels(FINE, "", mid_cell(20.0))),
    settled("settled_linear", "damped motion, linear shape functions", levels(FINE, "linear"), smoke=1),
    settled("settled_gimp", "damped motion, generalised interpolation", levels(FINE, "gimp"), smoke=1),
    settled("settled_graded", "damped motion of points that move, cells growing away from the crack", levels(FINE, "", graded)),
    settled("settled_gimp_graded", "the same, generalised interpolation", levels(FINE, "gimp", graded), smoke=1),
    settled("settled_closed", "fluid that just carries the in-situ stress", levels(FINE, "closed"), CLOSED, 1),
    settled("settled_closed_mid_cell", "the same between two grid lines", levels(FINE, "closed", mid_cell(20.0)), CLOSED, 1),
    *(case for degrees in (10.0, 30.0, 45.0) for case in inclined(degrees)),
    case_of(INCLINED, "quasistatic", CLOSED, 1)("inclined_30_closed", "fluid that just carries the in-situ stress, the crack turned by 30 degrees",
            levels(FINE, "", turned(30.0, 400.0), graded, lambda _: ("stop.time_s=0", "fluid.inlet={start_Pa=2.0e6, rate_Pa_s=0}"))),
)  # fmt: skip
