"""Manufactured motions in a square on rollers: the order of each shape function, transfer and kinematics.

A standing wave of small strain with inertia and without, and stretching of five per cent along both axes with points that
move (det F from 0.90 to 1.10). Errors are norms over all points, of both displacements, both velocities and all stresses.

What is not of order 2, and why: stress at the points of linear functions is of order 1 (strain is constant in a cell), and so is
uGIMP's, which is linear while points stay in their places. PIC is of order 1: each step smooths velocities by the order of the
cells' square, and there are as many steps as cells.
"""

import math

from verification.harness.load import Run, rock
from verification.harness.paths import ROOT
from verification.ladder.case import DISPLACEMENT, STRESS, VELOCITY, Array, Case, End, Exact, at_points, cell_levels, field_quantity

SCENE = ROOT / "verification" / "convergence" / "manufactured.toml"

# The motions of the scene, as strata-reference names what they are made of.
Motion = dict[str, float | str]
STANDING: Motion = {"side_m": 2.0, "A_m": 1e-6, "B_m": 0.5e-6}
MOVING: Motion = STANDING | {"time": "sine", "angular_frequency_1_s": 3500.0}
STRETCHED: Motion = {"side_m": 1.0, "amplitude_m": 0.016, "halves": 1, "law": "hencky"}
STRETCHING: Motion = STRETCHED | {"angular_frequency_1_s": 4000.0, "phase_rad": math.pi}


def exact_by(name: str, motion: Motion, prefix: str) -> Exact:
    """The fields of a motion of strata-reference, stresses by their prefix there ("sigma", "tau")."""

    def exact(run: Run, end: End, fields: tuple[str, ...], time_s: float) -> list[Array]:
        settings = rock(run, density=True) | {"time_s": time_s} | motion
        names = tuple(f"{prefix}{field[1:]}" if field.startswith("s_") else field for field in fields)
        return at_points(name, names, {"x_m": end.X, "y_m": end.Y}, settings)

    return exact


AT_REST = exact_by("manufactured_standing", STANDING, "sigma")
WAVE = exact_by("manufactured_standing", MOVING, "sigma")
# The volumes of points stay what they were, so their stress is Kirchhoff's.
STRETCH = exact_by("manufactured_finite", STRETCHING, "tau")

FIELDS = {"displacement": ("m", DISPLACEMENT), "velocity": ("m/s", VELOCITY), "stress": ("Pa", STRESS)}
CELLS = (0.125, 0.0625, 0.03125, 0.015625)
PIC_CELLS = (0.03125, 0.015625, 0.0078125)  # on coarser ones PIC damps away up to half of the velocity


def case(name: str, says: str, exact: Exact, settings: tuple[str, ...], reasons: dict[str, str], cells: tuple[float, ...] = CELLS) -> Case:
    """A case of the scene at cell sizes, m; reasons: of quantities without an order, why."""
    variant = {AT_REST: "", WAVE: "wave", STRETCH: "finite"}[exact]
    quantities = tuple(
        field_quantity(item, unit, fields, exact, no_order=reasons.get(item, ""))
        for item, (unit, fields) in FIELDS.items()
        if variant or item != "velocity"
    )
    levels = cell_levels(*cells, settings=settings, variant=variant)
    return Case(name, says, SCENE, "explicit" if variant else "quasistatic", levels, quantities, min(2, len(cells) - 2))


def set_to(shape: str, transfer: str, kinematics: str) -> tuple[str, ...]:
    """The keys of a way to solve it."""
    return f"numerics.shape={shape}", f"numerics.transfer={transfer}", f"numerics.kinematics={kinematics}"


def standing(shape: str, transfer: str, kinematics: str) -> Case:
    """The standing wave by a shape function, a transfer and a kind of kinematics."""
    says = f"a standing wave with {shape}, {transfer}, {kinematics}"
    cells = PIC_CELLS if transfer == "pic" else CELLS
    return case(f"wave_{shape}_{transfer}_{kinematics}", says, WAVE, set_to(shape, transfer, kinematics), {}, cells)


NOISE = (
    "the error falls to half a per cent and stays: points that have crossed cells leave forces of the grid's own scale, "
    "which neither steps eight times shorter nor 16 points a cell remove; it limits the stress at the finest cells, too"
)
CROSSING = "points cross the kinks of hat functions: it does not converge (Steffen, Kirby & Berzins 2008)"


def stretching(shape: str, transfer: str, reasons: dict[str, str]) -> Case:
    """The stretching by a shape function and a transfer, with points that move."""
    says = f"stretching by up to five per cent along both axes with {shape}, {transfer}"
    return case(f"finite_{shape}_{transfer}", says, STRETCH, set_to(shape, transfer, "updated"), reasons)


CASES = (
    *(case(f"static_{shape}", f"the wave's shape at rest, with {shape}", AT_REST, (f"numerics.shape={shape}",), {}) for shape in ("bspline2", "linear")),
    *(standing(shape, transfer, "total") for shape in ("bspline2", "linear") for transfer in ("flip", "xpic2", "pic")),
    *(standing(shape, transfer, "updated") for shape in ("bspline2", "gimp", "linear") for transfer in ("flip", "xpic2")),
    standing("gimp", "pic", "updated"),
    *(stretching(shape, transfer, {"velocity": NOISE}) for shape in ("bspline2", "gimp") for transfer in ("flip", "xpic2")),
    stretching("linear", "flip", dict.fromkeys(FIELDS, CROSSING)),
)
