"""A fracture that ends on a soft, weak or frictional interface, or has crossed it, against elements of high order (cut_blocks).

Where the tip stands on faces that are apart the rock behind is cut through; beyond, energy and K are those of the rock ahead. All
values are asked of strata-reference (cut_blocks, crossing_pressure, interface_ahead, sliding_blocks); numbers in the cases' words are
what it answers for the scene as it stands.
"""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.optimize import brentq

from verification.harness.load import Array, LoadError, Run, frames
from verification.harness.paths import ANALYTIC
from verification.harness.reference import value
from verification.ladder.case import Case, Level, Quantity, Sample
from verification.ladder.cases.interfaces import rock

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


# --- what a run has

def fresh_m(run: Run) -> float:
    """Length of the scene's fracture beyond the interface, m."""
    return float(run.scene["fracture"]["path_m"][-1][1]) - run.interfaces_m[0]


def net_Pa(run: Run, inlet_Pa: float | None = None) -> float:
    """An inlet pressure (at the run's end where none is given) above the closing stress, Pa."""
    return (run.summary.inlet_Pa if inlet_Pa is None else inlet_Pa) - float(run.scene["in_situ"]["horizontal_Pa"])


def interface(run: Run) -> dict[str, Any]:
    """The table of the scene's interface."""
    return run.scene["interface"][run.scene["strata"]["interfaces"][0]]


def block(run: Run) -> dict[str, Any]:
    """Block and rocks as the references take them."""
    domain = run.scene["domain"]
    sizes = {"width_m": float(domain["width_m"]), "height_m": float(domain["height_m"]), "interface_m": run.interfaces_m[0]}
    return sizes | rock(run, 0) | rock(run, 1, "beyond_")


def cut(run: Run, quantity: str, fresh: float | None = None) -> float:
    """A value of cut_blocks for a run's block, springs and net pressure, its tip where it is or so far beyond the interface (m)."""
    springs = float(interface(run)["shear_stiffness_Pa_m"])
    where = fresh_m(run) if fresh is None else fresh
    return value("cut_blocks", quantity, fresh_m=where, shear_stiffness_Pa_m=springs, pressure_Pa=net_Pa(run), **block(run))


def toughness(run: Run) -> float:
    """K_Ic of the rock beyond the interface, Pa sqrt(m)."""
    return float(run.scene["rock"][run.scene["strata"]["layers"][1]["rock"]]["toughness_Pa_sqrt_m"])


def started_Pa(run: Run, by: tuple[str, ...]) -> float:
    """Net pressure at which the fracture started, decided by one of these, Pa."""
    event = next((event for event in run.summary.events if event.kind == "start"), None)
    if event is None:
        raise LoadError(f"{run.folder}: the fracture did not start")
    if event.by not in by:
        raise LoadError(f"{run.folder}: {event.by} decided about the start, not {' or '.join(by)}")
    return net_Pa(run, event.inlet_Pa)


def last_of_interface(run: Run) -> dict[str, Array]:
    """The interface at the last output."""
    _, fields = frames(run, "interfaces")[-1]
    return {name.removeprefix("0/"): item.astype(float) for name, item in fields.items()}


# --- samples

def stored(run: Run) -> Sample:
    """Energy that the block has stored, J per metre of thickness."""
    return Sample.of(run.summary.energy["stored_J"], cut(run, "stored_J_m"))


def added(run: Run) -> Sample:
    """What is stored beyond the energy of the same fracture ending on the interface, J/m: 0.4 to 3 % of all."""
    on = cut(run, "stored_J_m", 0.0)
    return Sample.of(run.summary.energy["stored_J"] - on, cut(run, "stored_J_m") - on)


def mouth(run: Run) -> Sample:
    """Opening at the inlet, m."""
    return Sample.of(run.summary.mouth_opening_m, cut(run, "mouth_opening_m"))


def K_I(run: Run) -> Sample:
    """K_I of the tip beyond the interface, Pa sqrt(m); none nearer than two cells."""
    return Sample.of(run.summary.tips[0].K_I_Pa_sqrt_m, cut(run, "K_I"))


def critical(run: Run) -> Sample:
    """Net pressure at which a tip beyond the interface starts, Pa: K_I reaches K_Ic."""
    springs = float(interface(run)["shear_stiffness_Pa_m"])
    exact = value("cut_blocks", "critical_pressure_Pa", fresh_m=fresh_m(run), shear_stiffness_Pa_m=springs,
                  toughness_Pa_sqrt_m=toughness(run), **block(run))  # fmt: skip
    return Sample.of(started_Pa(run, ("K", "J")), exact)


def crosses(run: Run) -> Sample:
    """Net pressure at which a tip on the interface crosses it by the increment at once, Pa."""
    springs = float(interface(run)["shear_stiffness_Pa_m"])
    exact = value("crossing_pressure", "net_pressure_Pa", increment_m=run.increment_m, shear_stiffness_Pa_m=springs,
                  toughness_Pa_sqrt_m=toughness(run), **block(run))  # fmt: skip
    return Sample.of(started_Pa(run, ("energy",)), exact)


def ahead(run: Run, slipped_m: float) -> float:
    """Net pressure (Pa) at which the mean shear over the failure length beyond what has slipped (m) is the strength."""
    law = interface(run)
    given = {"ahead_m": float(law["failure_length_m"]), "shear_strength_Pa": float(law["shear_strength_Pa"])}
    return value("interface_ahead", "net_pressure_Pa", slipped_m=float(slipped_m), **given, **block(run))


def first_failure(run: Run) -> Sample:
    """Net pressure at which the first place of the weak interface let go, Pa; compression keeps tension out of the criterion."""
    failed_s = last_of_interface(run)["failed_s"]
    if not np.any(failed_s >= 0.0):
        raise LoadError(f"{run.folder}: the interface did not let go")
    inlet = run.scene["fluid"]["inlet"]
    pressure = float(inlet["start_Pa"]) + float(inlet["rate_Pa_s"]) * float(np.min(failed_s[failed_s >= 0.0]))
    return Sample.of(net_Pa(run, pressure), ahead(run, 0.0))


def extent_m(run: Run) -> float:
    """How far the interface has let go under the run's net pressure, m: the pressure that this takes rises from 6 m on."""
    widest = 0.45 * float(run.scene["domain"]["width_m"])
    return float(brentq(lambda slipped_m: ahead(run, slipped_m) - net_Pa(run), 6.0, widest, xtol=1e-3))


def extent(run: Run) -> Sample:
    """How far the interface has let go, m: to the end of the last column, a quarter of a cell beyond its last point."""
    fields = last_of_interface(run)
    off = np.abs(fields["x_m"] - float(run.scene["fracture"]["path_m"][0][0]))
    farthest = float(np.max(off[fields["failed_s"] >= 0.0], initial=0.0))
    return Sample.of(farthest + 0.25 * float(run.scene["numerics"]["cell_m"]), extent_m(run))


def slid(quantity: str, measured: Callable[[Run], float]) -> Callable[[Run], Sample]:
    """A number of a run with friction beside sliding_blocks, which says itself how far it is off."""

    def sample(run: Run) -> Sample:
        given = {"friction": float(interface(run)["coefficient"]), "compression_Pa": float(run.scene["in_situ"]["vertical_Pa"])}
        exact = value("sliding_blocks", quantity, fresh_m=fresh_m(run), pressure_Pa=net_Pa(run), **given, **block(run))
        return Sample.of(measured(run), exact, reference_error=3e-3 if quantity == "friction_work_J_m" else 1e-4)

    return sample


def carried(run: Run) -> Sample:
    """Mean normal traction of the interface when the run begins, Pa: that on the block's top."""
    _, fields = frames(run, "interfaces")[0]
    return Sample.of(float(np.mean(fields["0/reaction_n_Pa"].astype(float))), float(run.scene["in_situ"]["vertical_Pa"]))


# --- cases

def fracture_setting(top_m: float) -> str:
    """The fracture from the bottom up to a height, as a scene key."""
    return f"fracture.path_m=[[40.0, 0.0], [40.0, {top_m!r}]]"


def levels(
    variant: str, cells_m: tuple[float, ...], *keys: str, far: float = 4.0, of: Callable[[float], tuple[str, ...]] = lambda _: ()
) -> tuple[Level, ...]:
    """Levels of cells (m), those far away so many times as large, with what further settings ask for at each."""
    return tuple(
        Level(f"{h:g} m", h, (f"numerics.cell_m={h!r}", f"numerics.far_cell_m={far * h!r}", *keys, *of(h)), variant) for h in cells_m
    )


def mid_cell(h: float) -> tuple[str, ...]:
    """The interface between two lines of the grid, the tip on it."""
    place = LINE_M + 0.5 * h
    return f'strata.layers=[{{rock="stiff",thickness_m={place!r}}},{{rock="above"}}]', fracture_setting(place)


def rock_above(E_GPa: float) -> str:
    """The modulus of the rock beyond, as a scene key."""
    return f"rock.above.youngs_modulus_Pa={E_GPa * 1e9!r}"


def at_rest(why: str = "") -> tuple[Quantity, ...]:
    """Energy and opening of a tip on the interface."""
    return Quantity("stored energy", "J/m", stored, why), Quantity("mouth opening", "m", mouth, why)


def past(tip_m: float, cells_m: tuple[float, ...] = FINE) -> tuple[Quantity, ...]:
    """The same of a tip beyond it (m)."""
    why = {f"{h:g} m": LONGER for h in cells_m if tip_m > 4.0 * h}
    return (
        Quantity("energy above that on the interface", "J/m", added, no_order_at=why),
        Quantity("mouth opening", "m", mouth, no_order_at=why),
    )


def crosses_by(increment_m: float, cells_m: tuple[float, ...]) -> tuple[Quantity, ...]:
    """The pressure of a finite increment (m)."""
    why = {f"{h:g} m": LONGER for h in cells_m if increment_m > 4.0 * h}
    return (Quantity("net pressure of crossing", "Pa", crosses, no_order_at=why),)


def first(**further: Any) -> Quantity:
    """The pressure of the first failure."""
    return Quantity("net pressure of the first failure", "Pa", first_failure, **further)


OF_TIP = (Quantity("K_I", "Pa sqrt(m)", K_I, RINGS),)
STARTS = (Quantity("net pressure of the start", "Pa", critical, CHANGES),)
SLIDES = (
    Quantity("work of friction", "J/m", slid("friction_work_J_m", lambda run: run.summary.energy["friction_J"]), COLUMNS),
    Quantity("K_I", "Pa sqrt(m)", slid("K_I", lambda run: run.summary.tips[0].K_I_Pa_sqrt_m), RINGS),
    Quantity("stored energy", "J/m", slid("stored_J_m", lambda run: run.summary.energy["stored_J"])),
)


def case(
    name: str, says: str, own: tuple[Level, ...], quantities: tuple[Quantity, ...], mechanics: str = "quasistatic", smoke: int = 1
) -> Case:
    """A case of the scene."""
    return Case(name, says, SCENE, mechanics, own, quantities, smoke)


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
    return case(name, says, own, crosses_by(increment_m, cells_m))


def loaded(ratio: float) -> Case:
    """Rocks of a ratio of moduli under the loaded state."""
    own = levels("loaded", (1.0, 0.5), rock_above(10.0 * ratio), far=1.0)
    return case(f"loaded_{ratio:g}", f"springs between rocks whose moduli are 1 to {ratio:g}, loaded: what they carry",
                own, (Quantity("mean normal traction", "Pa", carried, BALANCE),), smoke=2)  # fmt: skip


CASES = (
    case("on", "tip on the soft interface: 38302 J/m, 7.6626 mm at 1 MPa", levels("rest", FINE), at_rest(), smoke=2),
    case("on_mid_cell", "the same, the interface at mid-cell", levels("rest", FINE, of=mid_cell), at_rest(), smoke=2),
    case("on_settling", "the same brought to rest by damping", levels("settling", MOVING), at_rest(SETTLING), "explicit"),
    *(one for tip_m in (1.0, 2.0) for E_GPa in E_ABOVE_GPA for one in beyond(tip_m, E_GPa)),
    case("beyond_2_settling", "tip 2 m beyond the soft interface, brought to rest by damping",
         levels("settling", MOVING, fracture_setting(12.0)), past(2.0, MOVING) + OF_TIP, "explicit"),
    crossing(0.5, (0.5, 0.25, 0.125)), crossing(1.0, FINE), crossing(2.0, FINE),
    crossing(1.0, FINE, 5.0), crossing(1.0, FINE, 30.0),
    case("lets_go", "tip on a weak interface: first failure at 0.3314 MPa, and how far by 0.36 MPa (23.67 m)",
         levels("lets_go", (0.5, 0.25), far=1.0), (first(), Quantity("extent of failure", "m", extent))),
    case("lets_go_graded", "the same first failure, cells growing away from the fracture",
         levels("lets_go", (*FINE, 0.125)), (first(no_order_at={"0.5 m": ONE_CELL}),), smoke=2),
    case("slides", "tip 5 m beyond an interface with friction 0.1, pressure to 1 MPa: 134.8 J/m of friction",
         levels("slides", FINE, far=1.0), SLIDES, smoke=2),
    case("slides_more", "the same with friction 0.05, which holds far less",
         levels("slides", FINE, "interface.rough.coefficient=0.05", far=1.0), SLIDES),
    *(loaded(ratio) for ratio in (2.0, 5.0, 10.0)),
    case("crosses_1_explicit", "tip on the soft interface, with inertia: when it crosses by 1 m at once",
         levels("grows", MOVING), crosses_by(1.0, MOVING), "explicit"),
    case("start_2_explicit", "tip 2 m beyond the soft interface, with inertia: when it starts",
         levels("grows", FINE[:1], fracture_setting(12.0)), STARTS, "explicit"),
    case("lets_go_explicit", "tip on a weak interface, with inertia: first failure",
         levels("lets_go", MOVING), (first(no_order_at={"0.5 m": ONE_CELL}),), "explicit"),
    case("slides_explicit", "tip 5 m beyond an interface with friction 0.1, with inertia: waves take some of the work of friction",
         levels("slides", MOVING, far=1.0), SLIDES[:2], "explicit"),
)  # fmt: skip
