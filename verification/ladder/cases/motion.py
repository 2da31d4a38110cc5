"""Rigid motion, uniform stress, springs, own weight, layers that share a load: what a discretisation has to have right."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from verification.harness.load import LoadError, Run, frames
from verification.harness.paths import ANALYTIC
from verification.harness.reference import values
from verification.ladder.case import Array, Case, Level, Quantity, Sample, cell_levels

ROUND_OFF = "round-off: exact at every size"
SINGLE = "round-off of the fields' single precision: exact at every size"

Fields = dict[str, Array]


@dataclass(frozen=True)
class Rock:
    """A rock of a scene, SI."""

    E: float
    nu: float
    rho: float

    @property
    def M(self) -> float:
        """lambda + 2 mu, Pa."""
        return self.E * (1.0 - self.nu) / ((1.0 + self.nu) * (1.0 - 2.0 * self.nu))


def rock_of(run: Run, name: str) -> Rock:
    """A rock by its name."""
    content = run.scene["rock"][name]
    return Rock(*(float(content[key]) for key in ("youngs_modulus_Pa", "poisson_ratio", "density_kg_m3")))


def last_fields(run: Run) -> tuple[float, Fields]:
    """Time (s) and fields of the particles at the last output, with the places X, Y where they started (m)."""
    stored = frames(run, "particles")
    if not stored:
        raise LoadError(f"{run.folder}: no fields of particles")
    time_s, particles = stored[-1]
    fields = {name: values.astype(float) for name, values in particles.items()}
    fields["X"], fields["Y"] = fields["x_m"] - fields["u_x_m"], fields["y_m"] - fields["u_y_m"]
    return time_s, fields


def size_m(run: Run) -> tuple[float, float]:
    """Width and height of the block, m."""
    return float(run.scene["domain"]["width_m"]), float(run.scene["domain"]["height_m"])


def kept(name: str, unit: str, value: Callable[[Run], float], exact: Callable[[Run], float], why: str = "") -> Quantity:
    """A single number with its exact value."""
    return Quantity(name, unit, lambda run: Sample.of(value(run), exact(run)), why)


def field(name: str, unit: str, exact: Callable[[float, Fields], Array], why: str = SINGLE) -> Quantity:
    """A field of the particles at the last output beside its exact one of time, X and Y; the norm by their areas."""

    def sample(run: Run) -> Sample:
        time_s, fields = last_fields(run)
        return Sample(fields[name], exact(time_s, fields) + 0.0 * fields["X"], fields["volume_m2"])

    return Quantity(name, unit, sample, why)


def no_stress(scale: Callable[[Run], float], why: str) -> Quantity:
    """All components of the particles' stress, which should be none, against a stress (Pa)."""

    def sample(run: Run) -> Sample:
        fields = last_fields(run)[1]
        stress = np.concatenate([fields[name] for name in ("s_xx_Pa", "s_yy_Pa", "s_xy_Pa")])
        return Sample(stress, np.zeros(stress.shape), None, scale(run))

    return Quantity("stress", "Pa", sample, why)


def closure(run: Run) -> float:
    """Energy that the ledger leaves unexplained, summed from the history's columns, over what was supplied."""
    last = {name: float(values[-1]) for name, values in run.history.items()}
    stored = last["kinetic_J"] + last["strain_J"] + last["interface_strain_J"]
    spent = sum(last[f"{name}_J"] for name in ("damping", "transfer", "integration", "friction", "fracture"))
    supplied = sum(last[f"{name}_J"] for name in ("fluid_work", "in_situ_work", "edge_work", "body_work", "initial_kinetic"))
    return (stored + spent - supplied) / abs(supplied)


ENERGY = Quantity("energy unexplained", "1", lambda run: Sample.of(closure(run), 0.0, 1.0), ROUND_OFF)


# --- A free block -------------------------------------------------------------------------------------------------------

MOVES = ANALYTIC / "rigid_motion.toml"
KINEMATICS = ("updated", "total")


def mass(run: Run) -> float:
    """Of the block, kg/m."""
    width, height = size_m(run)
    return rock_of(run, "stiff").rho * width * height


def momentum(run: Run, name: str) -> float:
    """sum m v of a component at the last output, kg/s."""
    fields = last_fields(run)[1]
    return rock_of(run, "stiff").rho * float(np.sum(fields["volume_m2"] * fields[name]))


def spin(run: Run) -> float:
    """Angular momentum about the middle at the last output, kg m/s."""
    fields = last_fields(run)[1]
    width, height = size_m(run)
    arm_x, arm_y = fields["x_m"] - 0.5 * width, fields["y_m"] - 0.5 * height
    moment = arm_x * fields["v_y_m_s"] - arm_y * fields["v_x_m_s"]
    return rock_of(run, "stiff").rho * float(np.sum(fields["volume_m2"] * moment))


def spin_of_particles(run: Run, rate: float) -> float:
    """The same of particles that turn rigidly at a rate (rad/s): sum m (X^2 + Y^2) from the middle, times it."""
    fields = last_fields(run)[1]
    width, height = size_m(run)
    arms = (fields["X"] - 0.5 * width) ** 2 + (fields["Y"] - 0.5 * height) ** 2
    return rate * rock_of(run, "stiff").rho * float(np.sum(fields["volume_m2"] * arms))


def kinetic_kept(why: str = "") -> Quantity:
    """Kinetic energy at the end against that of the start."""
    ends = (lambda run: float(run.history["kinetic_J"][-1]), lambda run: float(run.history["kinetic_J"][0]))
    return kept("kinetic energy", "J/m", *ends, why)


SPEED = (5.0, -3.0)  # m/s, of the variant "flies"
SPIN = 5e-6  # rad/s, of "turns"
FALL, THROWN = -9.81, (1.0, 2.0)  # m/s^2, m/s, of "falls"


def flight(kinematics: str) -> Case:
    """A block that flies."""

    def scale(run: Run) -> float:
        return rock_of(run, "stiff").E * abs(SPEED[0]) * run.summary.time_s / size_m(run)[0]

    quantities = (
        field("u_x_m", "m", lambda t, at: SPEED[0] * t + 0.0 * at["X"]),
        field("u_y_m", "m", lambda t, at: SPEED[1] * t + 0.0 * at["X"]),
        no_stress(scale, ROUND_OFF),
        kept("momentum along x", "kg/s", lambda run: momentum(run, "v_x_m_s"), lambda run: SPEED[0] * mass(run), SINGLE),
        kept("momentum along y", "kg/s", lambda run: momentum(run, "v_y_m_s"), lambda run: SPEED[1] * mass(run), SINGLE),
        kinetic_kept(ROUND_OFF),
        ENERGY,
    )
    says = "A block that flies by a tenth of a metre keeps its momentum and energy and is not strained."
    levels = cell_levels(1.0, 0.5, 0.25, settings=(f"numerics.kinematics={kinematics}",), variant="flies")
    return Case(f"flight_{kinematics}", says, MOVES, "explicit", levels, quantities)


def turn(kinematics: str) -> Case:
    """A block that turns: a node at a free edge moves as the middle of mass of its points does, not as its own place."""

    def scale(run: Run) -> float:
        return rock_of(run, "stiff").E * SPIN * run.summary.time_s

    quantities = (
        field("u_x_m", "m", lambda t, at: -SPIN * t * (at["Y"] - 4.0), ""),
        field("u_y_m", "m", lambda t, at: SPIN * t * (at["X"] - 4.0), ""),
        no_stress(scale, ""),
        kept("angular momentum", "kg m/s", spin, lambda run: spin_of_particles(run, SPIN)),
        kinetic_kept(),
    )
    says = (
        "A block that turns by 1e-7 keeps its angular momentum and energy and is not strained, but for the nodes at its free "
        "edges, whose lumped masses have their middle inside."
    )
    levels = cell_levels(1.0, 0.5, 0.25, settings=(f"numerics.kinematics={kinematics}",), variant="turns")
    return Case(f"turn_{kinematics}", says, MOVES, "explicit", levels, quantities)


def fall(kinematics: str) -> Case:
    """A block that falls freely."""

    def work(run: Run) -> float:
        t = run.summary.time_s
        return mass(run) * FALL * (THROWN[1] * t + 0.5 * FALL * t * t)

    def scale(run: Run) -> float:
        return rock_of(run, "stiff").rho * abs(FALL) * size_m(run)[1]

    quantities = (
        field("u_x_m", "m", lambda t, at: THROWN[0] * t + 0.0 * at["X"]),
        field("u_y_m", "m", lambda t, at: THROWN[1] * t + 0.5 * FALL * t * t + 0.0 * at["X"]),
        no_stress(scale, ROUND_OFF),
        kept("work of the body force", "J/m", lambda run: float(run.history["body_work_J"][-1]), work, ROUND_OFF),
        ENERGY,
    )
    says = "A block that is thrown and falls: u = v t + g t^2/2 exactly, no stress."
    levels = cell_levels(1.0, 0.5, 0.25, settings=(f"numerics.kinematics={kinematics}",), variant="falls")
    return Case(f"fall_{kinematics}", says, MOVES, "explicit", levels, quantities)


# --- Uniform stress -----------------------------------------------------------------------------------------------------

PATCH = ANALYTIC / "patch.toml"


def uniform(component: str, key: str, why: str = SINGLE) -> Quantity:
    """A normal stress against the edges' traction."""

    def sample(run: Run) -> Sample:
        fields = last_fields(run)[1]
        return Sample(fields[component], np.full(fields["X"].shape, -float(run.scene["in_situ"][key])), fields["volume_m2"])

    return Quantity(component, "Pa", sample, why)


def no_shear(run: Run) -> Sample:
    """Shear stress against the larger of the edges' tractions."""
    fields = last_fields(run)[1]
    scale = max(abs(float(run.scene["in_situ"][key])) for key in ("vertical_Pa", "horizontal_Pa"))
    return Sample(fields["s_xy_Pa"], np.zeros(fields["X"].shape), fields["volume_m2"], scale)


def at_rest(run: Run) -> Sample:
    """Displacement since the loaded state against that of a block loaded anew."""
    fields = last_fields(run)[1]
    scale = float(run.scene["in_situ"]["vertical_Pa"]) * size_m(run)[1] / rock_of(run, "stiff").E
    u = np.concatenate([fields["u_x_m"], fields["u_y_m"]])
    return Sample(u, np.zeros(u.shape), None, scale)


def stresses(why: str = SINGLE) -> tuple[Quantity, ...]:
    """Stress and displacement of a block under uniform stress."""
    normal = (uniform("s_xx_Pa", "horizontal_Pa", why), uniform("s_yy_Pa", "vertical_Pa", why))
    return (*normal, Quantity("s_xy_Pa", "Pa", no_shear, ROUND_OFF), Quantity("displacement", "m", at_rest, ROUND_OFF))


def patch(name: str, mechanics: str, settings: tuple[str, ...], variant: str = "", why: str = SINGLE) -> Case:
    """A block under uniform stress."""
    time = ("stop.time_s=0.01",) if mechanics == "explicit" else ()
    levels = cell_levels(1.0, 0.5, 0.25, settings=(*settings, *time), variant=variant)
    says = "A block under tractions on its edges is stressed as they are, to round-off, and stays at rest."
    return Case(f"patch_{name}_{mechanics}", says, PATCH, mechanics, levels, stresses(why))


PATCHES = tuple(
    patch(name, mechanics, settings, variant)
    for mechanics in ("quasistatic", "explicit")
    for name, settings, variant in (
        ("bspline", (), ""),
        ("linear", ("numerics.shape=linear",), ""),
        ("16_points", ("numerics.particles_per_cell=16",), ""),
        ("free", (), "free"),
    )
) + (
    patch("updated", "explicit", ("numerics.kinematics=updated",)),
    patch("gimp", "explicit", ("numerics.kinematics=updated", "numerics.shape=gimp")),
    patch("graded", "quasistatic", ("numerics.far_cell_m=4",)),
    patch("graded", "explicit", ("numerics.kinematics=updated", "numerics.far_cell_m=4")),
    patch("graded_gimp", "explicit", ("numerics.kinematics=updated", "numerics.shape=gimp", "numerics.far_cell_m=4")),
)


# --- Layers that share a load -------------------------------------------------------------------------------------------

LAYERS = ANALYTIC / "loaded_layers.toml"
MIDDLE = 8.0  # m to each side of the middle, 9 heights from the ends


@cache
def shared(p_h: float, p_v: float, rocks: tuple[Rock, ...], heights: tuple[float, ...]) -> list[float]:
    """The layers' stress along x by strata-reference, Pa."""
    listed = {"thickness_m": heights, "youngs_modulus_Pa": [r.E for r in rocks], "poisson_ratio": [r.nu for r in rocks]}
    given = {key: list(each) for key, each in listed.items()}
    return list(values("loaded_layers", "stress_xx_Pa", **given, horizontal_Pa=p_h, vertical_Pa=p_v))


def laminate(run: Run) -> list[float]:
    """The same for a run's layers."""
    stack = run.scene["strata"]["layers"]
    edges = [0.0, *run.interfaces_m, size_m(run)[1]]
    heights = tuple(above - below for below, above in zip(edges, edges[1:]))
    in_situ = run.scene["in_situ"]
    rocks = tuple(rock_of(run, layer["rock"]) for layer in stack)
    return shared(float(in_situ["horizontal_Pa"]), float(in_situ["vertical_Pa"]), rocks, heights)


def middle(run: Run) -> tuple[Fields, Array]:
    """Fields of the particles about the middle of the width, and which layer each is in."""
    fields = last_fields(run)[1]
    near = np.abs(fields["X"] - 0.5 * size_m(run)[0]) < MIDDLE
    chosen = {name: values[near] for name, values in fields.items()}
    return chosen, np.searchsorted(run.interfaces_m, chosen["Y"])


def layer_mean(layer: int) -> Quantity:
    """Mean stress along x of a layer about the middle."""

    def sample(run: Run) -> Sample:
        fields, of = middle(run)
        return Sample.of(float(np.mean(fields["s_xx_Pa"][of == layer])), laminate(run)[layer])

    return Quantity(f"mean s_xx_Pa of layer {layer}", "Pa", sample)


def profile(run: Run) -> Sample:
    """Stress along x of all particles about the middle."""
    fields, of = middle(run)
    return Sample(fields["s_xx_Pa"], np.array(laminate(run))[of], fields["volume_m2"])


def across(run: Run) -> Sample:
    """Stress across the layers about the middle, which is that of the top."""
    fields, _ = middle(run)
    exact = np.full(fields["X"].shape, -float(run.scene["in_situ"]["vertical_Pa"]))
    return Sample(fields["s_yy_Pa"], exact, fields["volume_m2"])


SHARING = Case(
    "loaded_layers",
    "Two bonded layers under edge tractions share them by their stiffness, far from the ends.",
    LAYERS,
    "quasistatic",
    cell_levels(2.0, 1.0, 0.5, 0.25),
    (
        layer_mean(0),
        layer_mean(1),
        Quantity("s_xx_Pa of points", "Pa", profile),
        Quantity("s_yy_Pa of points", "Pa", across),
    ),
)


# --- Own weight and springs ---------------------------------------------------------------------------------------------

WEIGHT = ANALYTIC / "own_weight.toml"
G = 1.0  # m/s^2, of the scene
SETTLED = ("stop.time_s=0.2",)  # what is left of the slowest motion is then 1e-13 of it


def sinking(run: Run) -> Sample:
    """Displacement of a bar under its own weight, m."""
    fields = last_fields(run)[1]
    rock, height = rock_of(run, "stiff"), size_m(run)[1]
    exact = -rock.rho * G / rock.M * (height * fields["Y"] - 0.5 * fields["Y"] ** 2)
    return Sample(fields["u_y_m"], exact, fields["volume_m2"])


def weight_above(run: Run) -> Sample:
    """Vertical stress of the bar, Pa."""
    fields = last_fields(run)[1]
    exact = -rock_of(run, "stiff").rho * G * (size_m(run)[1] - fields["Y"])
    return Sample(fields["s_yy_Pa"], exact, fields["volume_m2"])


def own_weight(mechanics: str, shape: str) -> Case:
    """A bar under its own weight."""
    settings = (f"numerics.shape={shape}", *(SETTLED if mechanics == "explicit" else ()))
    return Case(
        f"own_weight_{shape}_{mechanics}",
        "A bar between smooth walls sinks under its own weight by a parabola.",
        WEIGHT,
        mechanics,
        cell_levels(2.0, 1.0, 0.5, 0.25, settings=settings),
        (Quantity("u_y_m", "m", sinking), Quantity("s_yy_Pa", "Pa", weight_above)),
    )


def spring_jump(run: Run) -> Sample:
    """Opening of the spring (negative: it is pressed) at all its points, m."""
    fields = frames(run, "interfaces")[-1][1]
    opening = np.concatenate([fields[name] for name in sorted(fields) if name.endswith("/opening_m")])
    soft, height = rock_of(run, "soft"), size_m(run)[1]
    load = soft.rho * G * (height - run.interfaces_m[0])
    D = float(run.scene["interface"]["spring"]["normal_stiffness_Pa_m"])
    return Sample(opening.astype(float), np.full(opening.shape, -load / D))


def spring(mechanics: str, D: float, *more: str, name: str = "", why: str = ROUND_OFF, mid: bool = True) -> Case:
    """A spring of D Pa/m that carries the upper half of a bar.

    With inertia a jump adds up what the springs' sweeps leave of each step, which shows in stiff ones: at mid-cell from
    1e12 Pa/m (1.5e-5 of the jump), on a grid line from 1e15.
    """
    settings = (f"interface.spring.normal_stiffness_Pa_m={D!r}", *more, *(SETTLED if mechanics == "explicit" else ()))
    return Case(
        f"spring_{name or f'{D:.0e}'}_{mechanics}".replace("+", ""),
        f"A spring of {D:.0e} Pa/m under half a bar gives way by the weight over its stiffness.",
        WEIGHT,
        mechanics,
        (*((mid_cell(settings),) if mid else ()), *cell_levels(1.0, 0.5, 0.25, settings=settings, variant="spring")),
        (Quantity("opening", "m", spring_jump, why),),
        smoke=3,
    )


def mid_cell(settings: tuple[str, ...]) -> Level:
    """A coarse level with the spring at mid-cell."""
    place = 'strata.layers=[{rock = "stiff", thickness_m = 3}, {rock = "soft"}]'
    return Level("2 m, mid-cell", 2.0, ("numerics.cell_m=2.0", place, *settings), "spring")


CASES = (
    *(make(kinematics) for make in (flight, turn, fall) for kinematics in KINEMATICS),
    *PATCHES,
    SHARING,
    *(own_weight(mechanics, shape) for mechanics in ("quasistatic", "explicit") for shape in ("bspline2", "linear")),
    *(spring("quasistatic", D) for D in (1e3, 1e6, 1e9, 1e12, 1e15)),
    spring("explicit", 1e9),
    spring("explicit", 1e12, mid=False),
    spring("explicit", 1e15, why="the sweeps of springs end at a tolerance, which adds up in a jump of 1e-11 m"),
    spring("quasistatic", 1e9, "numerics.far_cell_m=1.5", name="graded", mid=False),
)
