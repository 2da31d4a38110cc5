"""Rigid motion, uniform stress, springs, own weight, layers that share a load: what a discretisation has to have right."""

from collections.abc import Callable
from functools import partial

import numpy as np

from verification.harness.load import Run, given, last, rock, values
from verification.harness.paths import ANALYTIC
from verification.ladder.case import Array, Case, Level, Quantity, Sample, cell_levels

ROUND_OFF = "round-off: exact at every size"
SINGLE = "round-off of the fields' single precision: exact at every size"
SIZES = (1.0, 0.5, 0.25)
MECHANICS = ("quasistatic", "explicit")

Fields = dict[str, Array]


def last_fields(run: Run) -> Fields:
    """Fields of the particles at the last output, with the places X, Y where they started (m)."""
    fields = {name: values.astype(float) for name, values in last(run, "particles")[1].items()}
    return fields | {"X": fields["x_m"] - fields["u_x_m"], "Y": fields["y_m"] - fields["u_y_m"]}


def size_m(run: Run) -> tuple[float, float]:
    """Width and height of the block, m."""
    return given(run, "domain.width_m"), given(run, "domain.height_m")


def of_rock(run: Run, key: str, name: str = "stiff") -> float:
    """A number of a rock."""
    return given(run, f"rock.{name}.{key}")


rho_of = partial(of_rock, key="density_kg_m3")  # kg/m^3


def field(name: str, unit: str, exact: Callable[[Run, Fields], Array | float], why: str = SINGLE) -> Quantity:
    """A field of the particles at the last output beside its exact one of X and Y; the norm by their areas."""

    def sample(run: Run) -> Sample:
        fields = last_fields(run)
        return Sample(fields[name], exact(run, fields) + 0.0 * fields["X"], fields["volume_m2"])

    return Quantity(name, unit, sample, why)


def none_of(name: str, unit: str, fields: tuple[str, ...], scale: Callable[[Run], float], why: str) -> Quantity:
    """Fields of the particles, which should be none, against a scale in their unit."""

    def sample(run: Run) -> Sample:
        found = last_fields(run)
        values = np.concatenate([found[field] for field in fields])
        return Sample(values, np.zeros(values.shape), None, scale(run))

    return Quantity(name, unit, sample, why)


no_stress = partial(none_of, "stress", "Pa", ("s_xx_Pa", "s_yy_Pa", "s_xy_Pa"))


def closure(run: Run) -> float:
    """Energy that the ledger leaves unexplained, summed from the history's columns, over what was supplied."""
    last = {name: float(values[-1]) for name, values in run.history.items()}
    stored = last["kinetic_J"] + last["strain_J"] + last["interface_strain_J"]
    spent = sum(last[f"{name}_J"] for name in ("damping", "transfer", "integration", "friction", "fracture"))
    supplied = sum(last[f"{name}_J"] for name in ("fluid_work", "in_situ_work", "edge_work", "body_work", "initial_kinetic"))
    return (stored + spent - supplied) / abs(supplied)


ENERGY = Quantity.of("energy unexplained", "1", closure, lambda _: 0.0, ROUND_OFF, scale=1.0)

# --- a free block
MOVES = ANALYTIC / "rigid_motion.toml"


def mass(run: Run) -> float:
    """Of the block, kg/m."""
    width, height = size_m(run)
    return rho_of(run) * width * height


def summed(of: Callable[[Fields], Array]) -> Callable[[Run], float]:
    """sum m f of the particles at the last output, with arms from the block's middle now (x, y) and at the start (X, Y)."""

    def measured(run: Run) -> float:
        at, (width, height) = last_fields(run), size_m(run)
        arms = {"x": at["x_m"] - 0.5 * width, "y": at["y_m"] - 0.5 * height, "X": at["X"] - 0.5 * width, "Y": at["Y"] - 0.5 * height}
        return rho_of(run) * float(np.sum(at["volume_m2"] * of(at | arms)))

    return measured


def kinetic_kept(why: str = "") -> Quantity:
    """Kinetic energy at the end against that of the start."""
    return Quantity.of("kinetic energy", "J/m", lambda run: run.history["kinetic_J"][-1], lambda run: float(run.history["kinetic_J"][0]), why)


SPEED = (5.0, -3.0)  # m/s, of the variant "flies"
SPIN = 5e-6  # rad/s, of "turns"
FALL, THROWN = -9.81, (1.0, 2.0)  # m/s^2, m/s, of "falls"


def free(name: str, says: str, variant: str, *quantities: Quantity) -> tuple[Case, ...]:
    """A variant of the free block under both kinematics."""
    return tuple(
        Case(f"{name}_{kinematics}", says, MOVES, "explicit",
             cell_levels(*SIZES, settings=(f"numerics.kinematics={kinematics}",), variant=variant), quantities)
        for kinematics in ("updated", "total")
    )  # fmt: skip


def fallen_m(run: Run) -> float:
    """u_y of the block that falls, m."""
    t = run.summary.time_s
    return THROWN[1] * t + 0.5 * FALL * t * t


FREE = (
    *free(
        "flight", "A block that flies by a tenth of a metre keeps its momentum and energy and is not strained.", "flies",
        field("u_x_m", "m", lambda run, _: SPEED[0] * run.summary.time_s),
        field("u_y_m", "m", lambda run, _: SPEED[1] * run.summary.time_s),
        no_stress(lambda run: of_rock(run, "youngs_modulus_Pa") * abs(SPEED[0]) * run.summary.time_s / size_m(run)[0], ROUND_OFF),
        Quantity.of("momentum along x", "kg/s", summed(lambda at: at["v_x_m_s"]), lambda run: SPEED[0] * mass(run), SINGLE),
        Quantity.of("momentum along y", "kg/s", summed(lambda at: at["v_y_m_s"]), lambda run: SPEED[1] * mass(run), SINGLE),
        kinetic_kept(ROUND_OFF), ENERGY,
    ),
    *free(
        "turn", "A block that turns by 1e-7 keeps its angular momentum and energy and is not strained, but for the nodes at its free "
        "edges, whose lumped masses have their middle inside.", "turns",  # a node there moves as the middle of mass of its points does
        field("u_x_m", "m", lambda run, at: -SPIN * run.summary.time_s * (at["Y"] - 4.0), ""),
        field("u_y_m", "m", lambda run, at: SPIN * run.summary.time_s * (at["X"] - 4.0), ""),
        no_stress(lambda run: of_rock(run, "youngs_modulus_Pa") * SPIN * run.summary.time_s, ""),
        Quantity.of("angular momentum", "kg m/s", summed(lambda at: at["x"] * at["v_y_m_s"] - at["y"] * at["v_x_m_s"]),
                    summed(lambda at: SPIN * (at["X"] ** 2 + at["Y"] ** 2))),
        kinetic_kept(),
    ),
    *free(
        "fall", "A block that is thrown and falls: u = v t + g t^2/2 exactly, no stress.", "falls",
        field("u_x_m", "m", lambda run, _: THROWN[0] * run.summary.time_s),
        field("u_y_m", "m", lambda run, _: fallen_m(run)),
        no_stress(lambda run: rho_of(run) * abs(FALL) * size_m(run)[1], ROUND_OFF),
        Quantity.of("work of the body force", "J/m", lambda run: run.history["body_work_J"][-1], lambda run: mass(run) * FALL * fallen_m(run), ROUND_OFF),
        ENERGY,
    ),
)  # fmt: skip

# --- uniform stress
PATCH = ANALYTIC / "patch.toml"


def no_shear(run: Run) -> Sample:
    """Shear stress against the larger of the edges' tractions."""
    fields = last_fields(run)
    scale = max(abs(given(run, f"in_situ.{key}")) for key in ("vertical_Pa", "horizontal_Pa"))
    return Sample(fields["s_xy_Pa"], np.zeros(fields["X"].shape), fields["volume_m2"], scale)


STRESSES = (
    field("s_xx_Pa", "Pa", lambda run, _: -given(run, "in_situ.horizontal_Pa")),
    field("s_yy_Pa", "Pa", lambda run, _: -given(run, "in_situ.vertical_Pa")),
    Quantity("s_xy_Pa", "Pa", no_shear, ROUND_OFF),
    # Since the loaded state, against the displacement of a block loaded anew.
    none_of("displacement", "m", ("u_x_m", "u_y_m"),
            lambda run: given(run, "in_situ.vertical_Pa") * size_m(run)[1] / of_rock(run, "youngs_modulus_Pa"), ROUND_OFF),
)


def patch(name: str, mechanics: str, *settings: str, variant: str = "") -> Case:
    """A block under uniform stress."""
    time = ("stop.time_s=0.01",) if mechanics == "explicit" else ()
    says = "A block under tractions on its edges is stressed as they are, to round-off, and stays at rest."
    levels = cell_levels(*SIZES, settings=(*settings, *time), variant=variant)
    return Case(f"patch_{name}_{mechanics}", says, PATCH, mechanics, levels, STRESSES)


UPDATED, GIMP, GRADED = "numerics.kinematics=updated", "numerics.shape=gimp", "numerics.far_cell_m=4"
PATCHES = tuple(
    patch(name, mechanics, *settings, variant=variant)
    for mechanics in MECHANICS
    for name, settings, variant in (
        ("bspline", (), ""), ("linear", ("numerics.shape=linear",), ""), ("16_points", ("numerics.particles_per_cell=16",), ""), ("free", (), "free"),
    )
) + (
    patch("updated", "explicit", UPDATED), patch("gimp", "explicit", UPDATED, GIMP), patch("graded", "quasistatic", GRADED),
    patch("graded", "explicit", UPDATED, GRADED), patch("graded_gimp", "explicit", UPDATED, GIMP, GRADED),
)  # fmt: skip

# --- layers that share a load
LAYERS = ANALYTIC / "loaded_layers.toml"
MIDDLE = 8.0  # m to each side of the middle, 9 heights from the ends


def laminate(run: Run) -> list[float]:
    """The layers' stress along x by strata-reference, Pa."""
    edges = [0.0, *run.interfaces_m, size_m(run)[1]]
    rocks = [rock(run, layer) for layer in range(len(edges) - 1)]
    stack = {"thickness_m": [above - below for below, above in zip(edges, edges[1:])]} | {key: [one[key] for one in rocks] for key in rocks[0]}
    load = {key: given(run, f"in_situ.{key}") for key in ("horizontal_Pa", "vertical_Pa")}
    return list(values("loaded_layers", "stress_xx_Pa", **stack, **load))


def middle(run: Run) -> tuple[Fields, Array]:
    """Fields of the particles about the middle of the width, and which layer each is in."""
    fields = last_fields(run)
    near = np.abs(fields["X"] - 0.5 * size_m(run)[0]) < MIDDLE
    chosen = {name: values[near] for name, values in fields.items()}
    return chosen, np.searchsorted(run.interfaces_m, chosen["Y"])


def layer_mean(layer: int) -> Quantity:
    """Mean stress along x of a layer about the middle."""
    return Quantity.of(f"mean s_xx_Pa of layer {layer}", "Pa",
                       lambda run: np.mean(middle(run)[0]["s_xx_Pa"][middle(run)[1] == layer]), lambda run: laminate(run)[layer])  # fmt: skip


def of_points(name: str, exact: Callable[[Run, Array], Array]) -> Quantity:
    """A stress of all particles about the middle beside its exact one of a run and their layers."""

    def sample(run: Run) -> Sample:
        fields, of = middle(run)
        return Sample(fields[name], exact(run, of), fields["volume_m2"])

    return Quantity(f"{name} of points", "Pa", sample)


SHARING = Case(
    "loaded_layers", "Two bonded layers under edge tractions share them by their stiffness, far from the ends.", LAYERS, "quasistatic",
    cell_levels(2.0, *SIZES),
    (layer_mean(0), layer_mean(1), of_points("s_xx_Pa", lambda run, of: np.array(laminate(run))[of]),
     of_points("s_yy_Pa", lambda run, of: np.full(of.shape, -given(run, "in_situ.vertical_Pa")))),  # across the layers it is that of the top
)  # fmt: skip

# --- own weight and springs
WEIGHT = ANALYTIC / "own_weight.toml"
G = 1.0  # m/s^2, of the scene
SETTLED = ("stop.time_s=0.2",)  # what is left of the slowest motion is then 1e-13 of it


def sinking(run: Run, at: Fields) -> Array:
    """Displacement of a bar under its own weight, m."""
    (E, nu), height = rock(run).values(), size_m(run)[1]
    M = E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))  # lambda + 2 mu
    return -rho_of(run) * G / M * (height * at["Y"] - 0.5 * at["Y"] ** 2)


SINKING = (field("u_y_m", "m", sinking, ""), field("s_yy_Pa", "Pa", lambda run, at: -rho_of(run) * G * (size_m(run)[1] - at["Y"]), ""))


def own_weight(mechanics: str, shape: str) -> Case:
    """A bar under its own weight."""
    settings = (f"numerics.shape={shape}", *(SETTLED if mechanics == "explicit" else ()))
    return Case(f"own_weight_{shape}_{mechanics}", "A bar between smooth walls sinks under its own weight by a parabola.", WEIGHT, mechanics,
                cell_levels(2.0, *SIZES, settings=settings), SINKING)  # fmt: skip


def spring_jump(run: Run) -> Sample:
    """Opening of the spring (negative: it is pressed) at all its points, m."""
    fields = last(run, "interfaces")[1]
    opening = np.concatenate([fields[name] for name in sorted(fields) if name.endswith("/opening_m")])
    load = of_rock(run, "density_kg_m3", "soft") * G * (size_m(run)[1] - run.interfaces_m[0])
    return Sample(opening.astype(float), np.full(opening.shape, -load / given(run, "interface.spring.normal_stiffness_Pa_m")))


def spring(mechanics: str, D: float, *more: str, name: str = "", why: str = ROUND_OFF, mid: bool = True) -> Case:
    """A spring of D Pa/m that carries the upper half of a bar. With inertia a jump adds up what the springs' sweeps leave of each step, which shows
    in stiff ones: at mid-cell from 1e12 Pa/m (1.5e-5 of the jump), on a grid line from 1e15."""
    settings = (f"interface.spring.normal_stiffness_Pa_m={D!r}", *more, *(SETTLED if mechanics == "explicit" else ()))
    place = 'strata.layers=[{rock = "stiff", thickness_m = 3}, {rock = "soft"}]'
    mid_cell = Level("2 m, mid-cell", 2.0, ("numerics.cell_m=2.0", place, *settings), "spring")
    return Case(
        f"spring_{name or f'{D:.0e}'}_{mechanics}".replace("+", ""),
        f"A spring of {D:.0e} Pa/m under half a bar gives way by the weight over its stiffness.", WEIGHT, mechanics,
        (*((mid_cell,) if mid else ()), *cell_levels(*SIZES, settings=settings, variant="spring")), (Quantity("opening", "m", spring_jump, why),), smoke=3,
    )  # fmt: skip


CASES = (
    *FREE,
    *PATCHES,
    SHARING,
    *(own_weight(mechanics, shape) for mechanics in MECHANICS for shape in ("bspline2", "linear")),
    *(spring("quasistatic", D) for D in (1e3, 1e6, 1e9, 1e12, 1e15)),
    spring("explicit", 1e9),
    spring("explicit", 1e12, mid=False),
    spring("explicit", 1e15, why="the sweeps of springs end at a tolerance, which adds up in a jump of 1e-11 m"),
    spring("quasistatic", 1e9, "numerics.far_cell_m=1.5", name="graded", mid=False),
)  # fmt: skip
