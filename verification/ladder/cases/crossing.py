"""A fracture that ends on a soft, weak or frictional interface, or has crossed it, against elements of high order (cut_blocks).

Where the tip stands on faces that are apart the rock behind is cut through; beyond, energy and K are those of the rock ahead. All
values are asked of strata-reference (cut_blocks, crossing_pressure, interface_ahead, sliding_blocks); numbers in the cases' words are
what it answers for the scene as it stands.
"""

from collections.abc import Callable
from operator import attrgetter
from typing import Any

import numpy as np
from scipy.optimize import brentq

from verification.harness.load import LoadError, Run, crack_ends, energy, first_failed_Pa, frames, given, last, net_Pa, rock, start_of, tip, value
from verification.harness.paths import ANALYTIC
from verification.ladder.case import Case, Keys, Level, Quantity, case_of, cell_levels

SCENE = ANALYTIC / "crossing.toml"
LINE_M = 10.0  # the interface, where it is on a line of every grid
FINE = (1.0, 0.5, 0.25)
MOVING = FINE[:2]  # with inertia
E_ABOVE_GPA = (5.0, 10.0, 30.0)  # of the rock beyond; 10 is that below

SETTLING = "half a millionth, of which what has not come to rest yet has either sign"
RINGS = "the rings are of 4 cells or fewer at every size: the tip's own error in them stays the same share"
CHANGES = "what decides changes with the cells between tip and interface: energy, K, then J"
LONGER = "from 4 cells on what is left is the tip's, as if the fracture were longer by 0.02 cells; the error of few cells has gone before"
ONE_CELL = "at 1 m the failure length is one cell, which the run marks"
COLUMNS = "sliding ends at a column of cells, and columns move along the interface as they shrink"
BALANCE = "round-off: what the interface carries is in balance with the load on the top"


def fresh_m(run: Run) -> float:
    """Length of the scene's fracture beyond the interface, m."""
    return crack_ends(run)[1][1] - run.interfaces_m[0]


def law(run: Run, name: str) -> float:
    """A number of the scene's interface."""
    return given(run, f"interface.{run.scene['strata']['interfaces'][0]}.{name}")


def block(run: Run) -> dict[str, Any]:
    """Block and rocks as the references take them."""
    sizes = {"width_m": given(run, "domain.width_m"), "height_m": given(run, "domain.height_m"), "interface_m": run.interfaces_m[0]}
    return sizes | rock(run, 0) | rock(run, 1, "beyond_")


def cut(run: Run, quantity: str, fresh: float | None = None) -> float:
    """A value of cut_blocks for a run's block, springs and net pressure, its tip where it is or so far beyond the interface (m)."""
    where = fresh_m(run) if fresh is None else fresh
    return value("cut_blocks", quantity, fresh_m=where, shear_stiffness_Pa_m=law(run, "shear_stiffness_Pa_m"), pressure_Pa=net_Pa(run), **block(run))


def critical_Pa(run: Run, increment_m: float | None = None) -> float:
    """Net pressure at which K_I of a tip beyond the interface reaches K_Ic, or at which one on it crosses by an increment (m) at once, Pa."""
    toughness = float(run.scene["rock"][run.scene["strata"]["layers"][1]["rock"]]["toughness_Pa_sqrt_m"])
    settings = {"shear_stiffness_Pa_m": law(run, "shear_stiffness_Pa_m"), "toughness_Pa_sqrt_m": toughness, **block(run)}
    if increment_m is None:
        return value("cut_blocks", "critical_pressure_Pa", fresh_m=fresh_m(run), **settings)
    return value("crossing_pressure", "net_pressure_Pa", increment_m=increment_m, **settings)


def started_Pa(*by: str) -> Callable[[Run], float]:
    """Net pressure at which the fracture started, decided by one of these, Pa."""

    def measured(run: Run) -> float:
        event = start_of(run)
        if event.by not in by:
            raise LoadError(f"{run.folder}: {event.by} decided about the start, not {' or '.join(by)}")
        return net_Pa(run, event.inlet_Pa)

    return measured


def ahead_Pa(run: Run, slipped_m: float = 0.0) -> float:
    """Net pressure (Pa) at which the mean shear over the failure length beyond what has slipped (m) is the strength. Compression keeps tension out of
    the criterion."""
    weak = {"ahead_m": law(run, "failure_length_m"), "shear_strength_Pa": law(run, "shear_strength_Pa")}
    return value("interface_ahead", "net_pressure_Pa", slipped_m=float(slipped_m), **weak, **block(run))


def extent_m(run: Run) -> float:
    """How far the interface has let go under the run's net pressure, m: the pressure that this takes rises from 6 m on."""
    widest = 0.45 * given(run, "domain.width_m")
    return float(brentq(lambda slipped_m: ahead_Pa(run, slipped_m) - net_Pa(run), 6.0, widest, xtol=1e-3))


def failed_m(run: Run) -> float:
    """How far the interface has let go in the run, m: to the end of the last column, a quarter of a cell beyond its last point."""
    fields = last(run, "interfaces")[1]
    off = np.abs(fields["0/x_m"].astype(float) - crack_ends(run)[0][0])
    return float(np.max(off[fields["0/failed_s"] >= 0.0], initial=0.0)) + 0.25 * given(run, "numerics.cell_m")


def slid(name: str, unit: str, quantity: str, measured: Callable[[Run], float], why: str = "", own_error: float = 1e-4) -> Quantity:
    """A number of a run with friction beside sliding_blocks, which says itself how far it is off."""

    def exact(run: Run) -> float:
        rough = {"friction": law(run, "coefficient"), "compression_Pa": given(run, "in_situ.vertical_Pa")}
        return value("sliding_blocks", quantity, fresh_m=fresh_m(run), pressure_Pa=net_Pa(run), **rough, **block(run))

    return Quantity.of(name, unit, measured, exact, why, reference_error=own_error)


def mouth(**further: Any) -> Quantity:
    """Opening at the inlet."""
    return Quantity.of("mouth opening", "m", attrgetter("summary.mouth_opening_m"), lambda run: cut(run, "mouth_opening_m"), **further)


def at_rest(why: str = "") -> tuple[Quantity, ...]:
    """Energy and opening of a tip on the interface."""
    return Quantity.of("stored energy", "J/m", energy("stored_J"), lambda run: cut(run, "stored_J_m"), why), mouth(why=why)


def longer(distance_m: float, cells_m: tuple[float, ...]) -> dict[str, str]:
    """Why no order is to be expected where there are more than four cells in a distance (m)."""
    return {f"{h:g} m": LONGER for h in cells_m if distance_m > 4.0 * h}


def past(tip_m: float, cells_m: tuple[float, ...] = FINE) -> tuple[Quantity, ...]:
    """Energy and opening of a tip beyond the interface (m): of the energy what comes to that of a tip on it, 0.4 to 3 % of all."""
    why = longer(tip_m, cells_m)
    added = Quantity.of(
        "energy above that on the interface", "J/m", lambda run: run.summary.energy["stored_J"] - cut(run, "stored_J_m", 0.0),
        lambda run: cut(run, "stored_J_m") - cut(run, "stored_J_m", 0.0), no_order_at=why,
    )  # fmt: skip
    return added, mouth(no_order_at=why)


def crosses_by(increment_m: float, cells_m: tuple[float, ...]) -> tuple[Quantity, ...]:
    """The pressure of a finite increment (m)."""
    return (Quantity.of("net pressure of crossing", "Pa", started_Pa("energy"), lambda run: critical_Pa(run, run.increment_m),
                        no_order_at=longer(increment_m, cells_m)),)  # fmt: skip


def first(**further: Any) -> Quantity:
    """The pressure of the first failure."""
    return Quantity.of("net pressure of the first failure", "Pa", first_failed_Pa, ahead_Pa, **further)


K = tip("K_I_Pa_sqrt_m")
OF_TIP = (Quantity.of("K_I", "Pa sqrt(m)", K, lambda run: cut(run, "K_I"), RINGS),)  # none nearer than two cells
STARTS = (Quantity.of("net pressure of the start", "Pa", started_Pa("K", "J"), critical_Pa, CHANGES),)
SLIDES = (
    slid("work of friction", "J/m", "friction_work_J_m", energy("friction_J"), COLUMNS, 3e-3),
    slid("K_I", "Pa sqrt(m)", "K_I", K, RINGS),
    slid("stored energy", "J/m", "stored_J_m", energy("stored_J")),
)
CARRIES = (Quantity.of("mean normal traction", "Pa",  # when the run begins: that on the block's top
                       lambda run: np.mean(frames(run, "interfaces")[0][1]["0/reaction_n_Pa"].astype(float)),
                       lambda run: given(run, "in_situ.vertical_Pa"), BALANCE),)  # fmt: skip


def fracture_setting(top_m: float) -> str:
    """The fracture from the bottom up to a height, as a scene key."""
    return f"fracture.path_m=[[40.0, 0.0], [40.0, {top_m!r}]]"


def levels(variant: str, cells_m: tuple[float, ...], *keys: str, far: float = 4.0, of: Keys = lambda _: ()) -> tuple[Level, ...]:
    """Levels of cells (m), those far away so many times as large, with what further settings ask for at each."""
    return cell_levels(*cells_m, variant=variant, of=(lambda h: (f"numerics.far_cell_m={far * h!r}", *keys), of))


def mid_cell(h: float) -> tuple[str, ...]:
    """The interface between two lines of the grid, the tip on it."""
    place = LINE_M + 0.5 * h
    return f'strata.layers=[{{rock="stiff",thickness_m={place!r}}},{{rock="above"}}]', fracture_setting(place)


def rock_above(E_GPa: float) -> str:
    """The modulus of the rock beyond, as a scene key."""
    return f"rock.above.youngs_modulus_Pa={E_GPa * 1e9!r}"


case = case_of(SCENE, smoke_levels=1)


def beyond(tip_m: float, E_GPa: float) -> tuple[Case, ...]:
    """A tip so far beyond the interface in a rock: at rest, its K where there is one, and the pressure at which it starts."""
    keys = (fracture_setting(LINE_M + tip_m), rock_above(E_GPa))
    name, where = f"{tip_m:g}_E_{E_GPa:g}", f"tip {tip_m:g} m beyond the soft interface, in rock of {E_GPa:g} GPa"
    with_K = tuple(h for h in FINE if tip_m >= 2.0 * h)
    return (
        case(f"beyond_{name}", f"{where}: energy and opening", levels("rest", FINE, *keys), past(tip_m)),
        case(f"K_{name}", f"{where}: K where it is two cells away and more", levels("rest", with_K, *keys), OF_TIP),
        case(f"start_{name}", f"{where}: when it starts", levels("grows", FINE, *keys), STARTS),
    )


def crossing(increment_m: float, cells_m: tuple[float, ...], E_GPa: float = 10.0) -> Case:
    """A tip on the interface that crosses it by an increment, in cells of its length and less."""
    name = f"crosses_{increment_m:g}" + ("" if E_GPa == 10.0 else f"_E_{E_GPa:g}")
    says = f"tip on the soft interface below rock of {E_GPa:g} GPa: when it crosses by {increment_m:g} m at once"
    own = levels("grows", cells_m, f"fracture.increment_m={increment_m!r}", rock_above(E_GPa))
    return case(name, says, own, crosses_by(increment_m, cells_m), smoke=2)


CASES = (
    case("on", "tip on the soft interface: 38302 J/m, 7.6626 mm at 1 MPa", levels("rest", FINE), at_rest(), smoke=2),
    case("on_mid_cell", "the same, the interface at mid-cell", levels("rest", FINE, of=mid_cell), at_rest(), smoke=2),
    case("on_settling", "the same brought to rest by damping", levels("settling", MOVING), at_rest(SETTLING), mechanics="explicit"),
    *(one for tip_m in (1.0, 2.0) for E_GPa in E_ABOVE_GPA for one in beyond(tip_m, E_GPa)),
    case("beyond_2_settling", "tip 2 m beyond the soft interface, brought to rest by damping",
         levels("settling", MOVING, fracture_setting(12.0)), past(2.0, MOVING) + OF_TIP, mechanics="explicit"),
    crossing(0.5, (0.5, 0.25, 0.125)), crossing(1.0, FINE), crossing(2.0, FINE),
    crossing(1.0, FINE, 5.0), crossing(1.0, FINE, 30.0),
    case("lets_go", "tip on a weak interface: first failure at 0.3314 MPa, and how far by 0.36 MPa (23.67 m)",
         levels("lets_go", (0.5, 0.25), far=1.0), (first(), Quantity.of("extent of failure", "m", failed_m, extent_m))),
    case("lets_go_graded", "the same first failure, cells growing away from the fracture",
         levels("lets_go", (*FINE, 0.125)), (first(no_order_at={"0.5 m": ONE_CELL}),), smoke=2),
    case("slides", "tip 5 m beyond an interface with friction 0.1, pressure to 1 MPa: 134.8 J/m of friction",
         levels("slides", FINE, far=1.0), SLIDES, smoke=2),
    case("slides_more", "the same with friction 0.05, which holds far less",
         levels("slides", FINE, "interface.rough.coefficient=0.05", far=1.0), SLIDES),
    *(case(f"loaded_{ratio:g}", f"springs between rocks whose moduli are 1 to {ratio:g}, loaded: what they carry",
           levels("loaded", (1.0, 0.5), rock_above(10.0 * ratio), far=1.0), CARRIES, smoke=2) for ratio in (2.0, 5.0, 10.0)),
    case("crosses_1_explicit", "tip on the soft interface, with inertia: when it crosses by 1 m at once",
         levels("grows", MOVING), crosses_by(1.0, MOVING), mechanics="explicit"),
    case("start_2_explicit", "tip 2 m beyond the soft interface, with inertia: when it starts",
         levels("grows", FINE[:1], fracture_setting(12.0)), STARTS, mechanics="explicit"),
    case("lets_go_explicit", "tip on a weak interface, with inertia: first failure",
         levels("lets_go", MOVING), (first(no_order_at={"0.5 m": ONE_CELL}),), mechanics="explicit"),
    case("slides_explicit", "tip 5 m beyond an interface with friction 0.1, with inertia: waves take some of the work of friction",
         levels("slides", MOVING, far=1.0), SLIDES[:2], mechanics="explicit"),
)  # fmt: skip
