"""The explicit time step against the largest one that the points' own mass and stiffness allow, by shape, transfer and points a cell."""
from __future__ import annotations

import math

from verification.harness.load import Run
from verification.harness.paths import ROOT
from verification.stability.family import FAILED, STABLE, Checked, Edge, Family, Parameter, Point, at_most
from verification.stability.theory.step_limit import Block, courant_limit

SCENE = ROOT / "verification" / "stability" / "scenes" / "time_step.toml"
POISSON, CELLS = 0.2, 6  # of the scene

SHAPES = {"linear": "linear", "gimp": "uGIMP", "bspline2": "quadratic B-spline"}
WAYS = {"total": "nodes keep velocities", "flip": "FLIP", "pic": "PIC", "xpic2": "XPIC(2)"}
ACROSS = (2, 3, 4)  # points across a cell
SHARES = (0.5, 0.8, 0.95, 1.05, 1.2, 1.5)  # of the predicted limit: values below are rounded, so that scenes stay the same

MOST_ENERGY = 10.0  # kinetic energy at the end over what was put in: a mode at 0.95 of its limit swings up to 1/(1 - 0.95^2) times that

MOVE_S = 0.05  # in which points are moved: some 100 steps
LONGER = ("stop.time_s=0.25", "output.fields_every_s=0.25")
TOUCH = 0.02  # cells: so far uGIMP points are moved over the edge that they touch where they start, lest they touch it half of the time

# Rough limits to lay points around; the edge itself comes from theory/step_limit.py and from bisection.
ROUGH = {("linear", "total"): 1.0, ("linear", "flip"): 0.76, ("linear", "pic"): 0.8, ("linear", "xpic2"): 0.78,
         ("bspline2", "total"): 1.2, ("bspline2", "flip"): 0.89, ("bspline2", "pic"): 0.91, ("bspline2", "xpic2"): 0.905}  # fmt: skip
ROUGH |= {("gimp", way): size for way, size in (("flip", 0.55), ("pic", 0.56), ("xpic2", 0.555))}
ROUGH_MOVED = {("bspline2", 0.1): 0.80, ("bspline2", 0.2): 0.72, ("bspline2", 0.24): 0.685, ("linear", 0.1): 0.73, ("linear", 0.2): 0.68,
               ("linear", 0.24): 0.647}  # fmt: skip
ROUGH_HELD = {("linear", "total"): 1.035, ("linear", "flip"): 0.794, ("linear", "pic"): 0.835, ("linear", "xpic2"): 0.818,
              ("bspline2", "total"): 1.7, ("bspline2", "flip"): 1.32, ("bspline2", "pic"): 1.39, ("bspline2", "xpic2"): 1.36}  # fmt: skip

ABOUT = (
    "A block of 6 x 6 cells starts with velocities that have no pattern, so that all of its modes are in it. Where the step is longer than the"
    " limit of the fastest mode, that mode grows by a factor every step. Predicted: the largest eigenvalue of M^-1 K, or of the step's map where"
    " points carry the velocities, of the same block, put together in Python from the published shape functions. Beyond it the solver ends the"
    " run once the kinetic energy is ten times all that was put in, with the last good state."
)


def energy_kept(run: Run) -> Checked:
    """Kinetic energy at the end over what was put in."""
    energy = run.summary.energy
    ratio = energy["kinetic_J"] / (energy["initial_kinetic_J"] + abs(energy["body_work_J"]))
    return at_most(ratio, MOST_ENERGY, f"kinetic energy {ratio:.2g} times what was put in")


def settings_of(shape: str, way: str, across: int) -> tuple[str, ...]:
    """The keys of a shape, a transfer (or total) and points a cell."""
    kinematics = "total" if way == "total" else "updated"
    transfer = "flip" if way == "total" else way
    return (f"numerics.shape={shape}", f"numerics.kinematics={kinematics}", f"numerics.transfer={transfer}",
            f"numerics.particles_per_cell={across**2}")  # fmt: skip


def moved_by(shift: float) -> str:
    """The push that moves all points by a share of a cell, from rest to rest, in MOVE_S: v = (1 - cos(2 pi t/T)) shift/T."""
    size = f"t < {MOVE_S} ? {2.0 * math.pi * shift / MOVE_S**2:.8g}*sin({2.0 * math.pi / MOVE_S:.10g}*t) : 0"
    return f'body.acceleration_m_s2=["{size}", "{size}"]'


def limit(shape: str, way: str, across: int, held: bool, shift: float) -> float:
    """The predicted limit."""
    reach = TOUCH if shape == "gimp" and not held and shift == 0.0 else shift
    return courant_limit(Block(shape, across, CELLS, held, (reach, reach)), way, POISSON)


def family(shape: str, way: str, across: int, held: bool = False, shift: float = 0.0) -> Family:
    """The walk of a combination across its limit; shift: where all points have been moved to before, cells."""
    keys, variant = settings_of(shape, way, across), "held" if held else ""
    rough = (ROUGH_HELD if held else ROUGH)[shape, way]
    if shape == "gimp" and not held:
        keys = (*keys, moved_by(TOUCH), *LONGER)
    if shift > 0.0:
        rough = ROUGH_MOVED[shape, shift]
        keys = (*keys, moved_by(shift), *LONGER)

    def at(courant: float) -> Point:
        return Point(f"courant {courant:.5g}", courant, SCENE, (*keys, f"numerics.courant={courant:.5g}"), variant)

    smoke = across == 2 and way in ("total", "flip")
    points = tuple(
        Point(f"{share:g}", round(share * rough, 4), SCENE, (*keys, f"numerics.courant={round(share * rough, 4)}"), variant,
              smoke=share in ((0.8, 1.2) if smoke else (1.2,)))
        for share in SHARES if share * rough <= 2.0
    )  # fmt: skip
    edges = "held edges" if held else f"moved by {shift:g} of a cell" if shift > 0.0 else "free edges"
    return Family(
        name=f"step_{shape}_{way}_{across**2}" + ("_held" if held else f"_moved_{100.0 * shift:.0f}" if shift > 0.0 else ""),
        title=f"Time step: {SHAPES[shape]}, {WAYS[way]}, {across**2} points a cell, {edges}",
        says="Noise in a small block must not grow; beyond the limit of the fastest mode the run must end with its reason.",
        parameter=Parameter("c_P dt/h"),
        points=points,
        check=energy_kept,
        check_name="kinetic energy at the end over ten times what was put in",
        beyond=(FAILED,),
        edge=Edge(
            source="Largest eigenvalue of M^-1 K, or of the step's map, of the same block, put together in Python (verification/stability/theory/step_limit.py).",
            predicted=lambda: limit(shape, way, across, held, shift),
            at=at, bracket=(0.8 * rough, min(1.5 * rough, 2.0)), by_check=True,  # within a few per cent below it a swing to many times the energy may be marked
        ),
        section="Time step of the explicit update",
        about=ABOUT,
    )  # fmt: skip


COMBINATIONS = [(shape, way) for shape in SHAPES for way in WAYS if (shape, way) != ("gimp", "total")]  # that one is refused

FAMILIES = (
    *(family(shape, way, across, False) for shape, way in COMBINATIONS for across in ACROSS),
    *(family(shape, way, 2, held=True) for shape, way in COMBINATIONS if shape != "gimp"),
    *(family(shape, "flip", 2, shift=shift) for shape, shift in ROUGH_MOVED),
)
