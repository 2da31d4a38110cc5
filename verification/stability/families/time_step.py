"""The explicit time step against the largest one that the points' own mass and stiffness allow, by shape, transfer and points a cell."""

import math
from functools import partial

from verification.harness.load import Run
from verification.stability.family import FAILED, SCENES, Checked, Edge, Family, Parameter, Point, at_most, at_values
from verification.stability.theory.step_limit import Block, courant_limit

SCENE = SCENES / "time_step.toml"
POISSON, CELLS = 0.2, 6  # of the scene

SHAPES = {"linear": "linear", "gimp": "uGIMP", "bspline2": "quadratic B-spline"}
WAYS = {"total": "nodes keep velocities", "flip": "FLIP", "pic": "PIC", "xpic2": "XPIC(2)"}
ACROSS = (2, 3, 4)  # points across a cell
SHARES = (0.5, 0.8, 0.95, 1.05, 1.2, 1.5)  # of the predicted limit: values below are rounded, so that scenes stay the same

MOST_ENERGY = 10.0  # kinetic energy at the end over what was put in: a mode at 0.95 of its limit swings up to 1/(1 - 0.95^2) times that

MOVE_S = 0.05  # in which points are moved: some 100 steps
TOUCH = 0.02  # cells: so far uGIMP points are moved over the edge that they touch where they start, lest they touch it half of the time

# Rough limits to lay points around; the edge itself comes from theory/step_limit.py and from bisection.
ROUGH = {("linear", "total"): 1.0, ("linear", "flip"): 0.76, ("linear", "pic"): 0.8, ("linear", "xpic2"): 0.78,
         ("bspline2", "total"): 1.2, ("bspline2", "flip"): 0.89, ("bspline2", "pic"): 0.91, ("bspline2", "xpic2"): 0.905,
         ("gimp", "flip"): 0.55, ("gimp", "pic"): 0.56, ("gimp", "xpic2"): 0.555}  # fmt: skip
ROUGH_MOVED = {("bspline2", 0.1): 0.80, ("bspline2", 0.2): 0.72, ("bspline2", 0.24): 0.685, ("linear", 0.1): 0.73, ("linear", 0.2): 0.68,
               ("linear", 0.24): 0.647}  # fmt: skip
ROUGH_HELD = {("linear", "total"): 1.035, ("linear", "flip"): 0.794, ("linear", "pic"): 0.835, ("linear", "xpic2"): 0.818,
              ("bspline2", "total"): 1.7, ("bspline2", "flip"): 1.32, ("bspline2", "pic"): 1.39, ("bspline2", "xpic2"): 1.36}  # fmt: skip


def energy_kept(run: Run) -> Checked:
    """Kinetic energy at the end over what was put in."""
    energy = run.summary.energy
    ratio = energy["kinetic_J"] / (energy["initial_kinetic_J"] + abs(energy["body_work_J"]))
    return at_most(ratio, MOST_ENERGY, f"kinetic energy {ratio:.2g} times what was put in")


def way_keys(way: str) -> tuple[str, str]:
    """The keys of a transfer, or of nodes that keep their velocities."""
    kinematics, transfer = ("total", "flip") if way == "total" else ("updated", way)
    return f"numerics.kinematics={kinematics}", f"numerics.transfer={transfer}"


def moved_by(shift: float) -> str:
    """The push that moves all points by a share of a cell, from rest to rest, in MOVE_S: v = (1 - cos(2 pi t/T)) shift/T."""
    size = f"t < {MOVE_S} ? {2.0 * math.pi * shift / MOVE_S**2:.8g}*sin({2.0 * math.pi / MOVE_S:.10g}*t) : 0"
    return f'body.acceleration_m_s2=["{size}", "{size}"]'


def family(shape: str, way: str, across: int, held: bool = False, shift: float = 0.0) -> Family:
    """The walk of a combination across its limit; shift: where all points have been moved to before, cells."""
    moved = TOUCH if shape == "gimp" and not held and shift == 0.0 else shift
    keys: tuple[str, ...] = (f"numerics.shape={shape}", *way_keys(way), f"numerics.particles_per_cell={across**2}")
    keys += (moved_by(moved), "stop.time_s=0.25", "output.fields_every_s=0.25") if moved > 0.0 else ()
    rough = ROUGH_MOVED[shape, shift] if shift > 0.0 else (ROUGH_HELD if held else ROUGH)[shape, way]
    variant, block = "held" if held else "", Block(shape, across, CELLS, held, (moved, moved))

    def point(share: float) -> Point:
        courant, below = round(share * rough, 4), (0.8,) if across == 2 and way in ("total", "flip") else ()
        return Point(f"{share:g}", courant, SCENE, (*keys, f"numerics.courant={courant}"), variant, smoke=share in (*below, 1.2))

    edges = "held edges" if held else f"moved by {shift:g} of a cell" if shift > 0.0 else "free edges"
    return Family(
        f"step_{shape}_{way}_{across**2}" + ("_held" if held else f"_moved_{100.0 * shift:.0f}" if shift > 0.0 else ""),
        f"Time step: {SHAPES[shape]}, {WAYS[way]}, {across**2} points a cell, {edges}",
        "Noise in a small block must not grow; beyond the limit of the fastest mode the run must end with its reason.", Parameter("c_P dt/h"),
        tuple(point(share) for share in SHARES if share * rough <= 2.0), energy_kept, beyond=(FAILED,),
        edge=Edge(
            "Largest eigenvalue of M^-1 K, or of the step's map, of the same block, put together in Python (verification/stability/theory/step_limit.py).",
            partial(courant_limit, block, way, POISSON),
            at_values(SCENE, lambda courant: (*keys, f"numerics.courant={courant:.5g}"), "courant {:.5g}", variant),
            (0.8 * rough, min(1.5 * rough, 2.0)), by_check=True,  # within a few per cent below it a swing to many times the energy may be marked
        ),
        section="Time step of the explicit update", check_name="kinetic energy at the end over ten times what was put in",
    )  # fmt: skip


COMBINATIONS = [(shape, way) for shape in SHAPES for way in WAYS if (shape, way) != ("gimp", "total")]  # that one is refused

FAMILIES = (
    *(family(shape, way, across) for shape, way in COMBINATIONS for across in ACROSS),
    *(family(shape, way, 2, held=True) for shape, way in COMBINATIONS if shape != "gimp"),
    *(family(shape, "flip", 2, shift=shift) for shape, shift in ROUGH_MOVED),
)
