"""Waves along a column of rock from a pulse of velocity: plane, through a border of rocks or a soft interface, in a thin bar."""

from typing import Any

import numpy as np

from verification.harness.load import Run, given, rock
from verification.harness.paths import ROOT
from verification.ladder.case import Array, Case, End, Level, at_points, cell_levels, field_quantity

SCENE = ROOT / "verification" / "convergence" / "waves.toml"

NAMES = {"u_y_m": "u_m", "v_y_m_s": "v_m_s", "s_yy_Pa": "stress_Pa"}
PULSES = {"bar": (20.0, 4.0), "": (12.0, 2.0)}  # of the scene: middle and half width, m
VELOCITY_M_S = 0.1

CELLS, COURANT = (0.25, 0.125, 0.0625), (0.5, 0.5, 0.5)


def column(run: Run) -> dict[str, Any]:
    """The run's column as strata-reference takes it."""
    thickness = [float(layer["thickness_m"]) for layer in run.scene["strata"]["layers"][:-1]]
    thickness.append(given(run, "domain.height_m") - sum(thickness))
    rocks = [rock(run, layer, density=True) for layer in range(len(thickness))]
    settings: dict[str, Any] = {key: [one[key] for one in rocks] for key in rocks[0]}
    interfaces = [name for name in run.scene["strata"].get("interfaces", []) if name != "perfect"]
    if interfaces:
        settings["spring_Pa_m"] = given(run, f"interface.{interfaces[0]}.normal_stiffness_Pa_m")
    return settings | {"thickness_m": thickness, "bottom": "held", "top": "free"}


def pulse(run: Run) -> dict[str, float | str]:
    """The pulse that the run begins with, and how the column is held at its sides."""
    middle, half_width = PULSES.get(run.summary.variant, PULSES[""])
    settings: dict[str, float | str] = {"pulse_middle_m": middle, "pulse_half_width_m": half_width, "pulse_velocity_m_s": VELOCITY_M_S}
    if run.summary.variant == "bar":
        return settings | {"lateral": "free", "width_m": given(run, "domain.width_m")}
    return settings | {"lateral": "held"}


def exact(run: Run, end: End, fields: tuple[str, ...], time_s: float) -> list[Array]:
    """The wave at the particles, by its fields along the column."""
    y, back = np.unique(end.Y, return_inverse=True)
    settings = column(run) | pulse(run) | {"time_s": time_s}
    found = at_points("layered_wave", tuple(NAMES[field] for field in fields), {"y_m": y}, settings)
    return [values[back] for values in found]


VELOCITY = field_quantity("velocity", "m/s", ("v_y_m_s",), exact)
ALONG = (field_quantity("displacement", "m", ("u_y_m",), exact), VELOCITY, field_quantity("stress", "Pa", ("s_yy_Pa",), exact))


def case(name: str, says: str, variant: str, *settings: str, courant: tuple[float, ...] = COURANT) -> Case:
    """A case of the scene at all cell sizes, with the time step as c_P dt/cell at each."""

    def level(cell: float, share: float) -> tuple[Level, ...]:
        return cell_levels(cell, settings=(*settings, f"numerics.courant={share!r}"), variant=variant)

    return Case(name, says, SCENE, "explicit", tuple(one for pair in zip(CELLS, courant) for one in level(*pair)), ALONG)


UPDATED = "numerics.kinematics=updated"
GIMP, LINEAR, XPIC2 = "numerics.shape=gimp", "numerics.shape=linear", "numerics.transfer=xpic2"
AT_POINTS = "; strain is constant in a cell, so that at its points, off the middle, it tends to order 1"
# Springs act at a step's end.
AT_STEPS = "; with steps that fall as the cells do, order 2 of the cells tends to order 1 of the steps"
SHORT = (0.5, 0.25, 0.125)

CASES = (
    case("plane_wave", "a pulse crosses the column and is turned at the held and at the free end", ""),
    case("plane_wave_updated", "the plane wave with points that move", "", UPDATED),
    case("plane_wave_gimp", f"the plane wave with uGIMP{AT_POINTS}", "", UPDATED, GIMP),
    case("plane_wave_linear", f"the plane wave with linear functions{AT_POINTS}", "", LINEAR),
    case("plane_wave_xpic2", "the plane wave with XPIC(2)", "", XPIC2),
    case("border", "a pulse is partly turned where stiff rock ends on soft rock", "border"),
    case("spring", f"a pulse is partly turned by a soft interface that acts as a spring{AT_STEPS}", "spring"),
    case("spring_short_steps", "the spring with steps that fall as the cells' square", "spring", courant=SHORT),
    case("spring_updated", "the same with points that move", "spring", UPDATED, courant=SHORT),
    case("bar", "a pulse in a bar with free sides: its speed sqrt(E'/rho), the sides draw in", "bar"),
)
