"""The problems of the chart: K_I of a pressurised crack in the study's block, near a bonded and near a soft interface, against analytic references; what becomes of
growing fractures: Experiment 1 behind a soft interface, the path of Experiment 6, fractures fed at a rate."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from verification.harness.load import LoadError, Run, relative_error, settings_of, value
from verification.harness.paths import ANALYTIC, EXPERIMENTS
from verification.ladder.case import Array, Level, Sample
from verification.ladder.cases import cracks, interfaces, kgd, paths
from verification.ladder.cases.paths import INTERFACE_M, exact_path, farthest, grown, path_settings
from verification.precision.problem import (
    FAR, MOVING, RESTING, STILL, Answer, Base, Method, Problem, Setting, Wanted, checked, endless, methods, with_inertia, without_inertia,
)  # fmt: skip

# All have the tip on a grid line, 5 m up, and divide the block of 80 m.
FINE_M = (2.5, 1.25, 1.0, 0.625, 0.5, 0.25, 0.125)
EXPLICIT_M = (2.5, 1.25, 1.0, 0.5)

# The block's slowest mode is near 41 rad/s: twice that settles soonest, to 1e-7 of it within 0.5 s.
SETTLING_1_S, SETTLED_S = 80.0, 0.5
SHAKEN_1_S = 20.0  # the experiments' own damping, which leaves 1 % of the slowest mode by then

UNKNOWNS = (4, 8, 12, 16, 24)


def asked(settings: Mapping[str, object], key: str, counts: tuple[int, ...]) -> tuple[Level, ...]:
    """Levels of a solution of strata-reference by a number of unknowns under a key."""
    return tuple(Level(f"{key} {count}", 1.0 / count, settings_of({**settings, key: count})) for count in counts)


def collocation(name: str, key: str, settings: Mapping[str, object], counts: tuple[int, ...]) -> Method:
    """A solution of strata-reference by so many unknowns of one kind."""
    return Method(f"be_{name}", f"{'dislocations' if key == 'nodes' else 'collocation'} ({name})", None, main=True, source=name,
                  levels=asked(settings, key, counts))  # fmt: skip


BLOCK_SETTINGS = {"width_m": 80.0, "half_height_m": 80.0, "half_length_m": 5.0, "pressure_Pa": cracks.NET_PA}


def in_block(setting: Setting, _: float) -> tuple[str, tuple[str, ...]]:
    """The study's block; a run with inertia goes on until it has settled."""
    if setting.mechanics == "quasistatic":
        return "", ()
    return "", (f"stop.time_s={SETTLED_S!r}", f"output.fields_every_s={SETTLED_S!r}")


BLOCK_CURVES = [
    *without_inertia(FINE_M, (2.5, 1.25, 1.0, 0.5)),
    Method("ex_shaken", "explicit, updated, damped as the experiments", Setting("explicit", kinematics="updated", transfer="flip",
          damping_1_s=SHAKEN_1_S), (2.5, 1.25, 1.0), True),
    *with_inertia(EXPLICIT_M, (2.5, 1.25, 1.0), (1.0,), SETTLING_1_S),
]  # fmt: skip

BLOCK = Problem(
    "block", "A crack of 5 m under 0.3 MPa net pressure in the study's block of 80 m, at rest",
    (Wanted("block_K_I", "K_I in the block", "Pa sqrt(m)", "relative to K_I of the same block (strata-reference block_crack)",
            # The ladder's sample of K_I, with the reference's own error; K_I by so many terms beside that by as many as settle it.
            lambda run: replace(cracks.K_I(run), reference_error=relative_error("block_crack", **BLOCK_SETTINGS)),
            lambda answer: Sample.of(answer["K_I"], value("block_crack", "K_I", **BLOCK_SETTINGS), None, relative_error("block_crack", **BLOCK_SETTINGS))),),
    (*methods(cracks.AT_REST, in_block, BLOCK_CURVES), collocation("block_crack", "terms", BLOCK_SETTINGS, UNKNOWNS)), about_s=1.2,
)  # fmt: skip

# --- near an interface: 2.5 m from it, so that a uniform grid with inertia has cells that see it
DISTANCE_M = 2.5
NEAR_M = (1.25, 0.625, 0.3125, 0.15625)
NEAR_EXPLICIT_M = (1.25, 0.625)
WIDE_M, NARROW_M, SMALL_M = 1600.0, 160.0, 40.0  # blocks for graded grids, for uniform ones, and for rock beyond them
FAR_CELL_M = 100.0
NEAR_SETTLING_1_S, NEAR_SETTLED_S = 35.0, 1.0  # of the block of 160 m, as in the ladder
SOFT = interfaces.stiffness_settings(1.0)  # D a/E' = 1


def near(layers: tuple[str, str], laws: tuple[str, ...] = ()):  # type: ignore[no-untyped-def]
    """What makes a block with an interface at mid-height: of 1600 m where cells grow far away, of 160 m where they do not."""

    def base(setting: Setting, cell_m: float) -> tuple[str, tuple[str, ...]]:
        """Block, layers and crack."""
        wide = setting.graded > 0.0 and setting.mechanics == "quasistatic"
        width = SMALL_M if setting.beyond_m > 0.0 else WIDE_M if wide else NARROW_M
        middle = 0.5 * width
        keys = [f"domain.width_m={width!r}", f"domain.height_m={width!r}",
                f'strata.layers=[{{rock="{layers[0]}",thickness_m={middle!r}}},{{rock="{layers[1]}"}}]',
                interfaces.path_setting(DISTANCE_M, False, middle), *laws]  # fmt: skip
        if setting.mechanics == "explicit":
            keys += [f"stop.time_s={NEAR_SETTLED_S!r}", f"output.fields_every_s={NEAR_SETTLED_S!r}"]
        if setting.graded == 0.0:  # the scene's grid is graded
            keys.append(f"numerics.far_cell_m={cell_m!r}")
        elif setting.mechanics == "quasistatic":
            keys.append(f"numerics.far_cell_m={FAR_CELL_M!r}")
        return "", tuple(keys)

    return base


def near_curves() -> list[Method]:
    """The curves near an interface; single choices are tried in the block."""
    still = [*without_inertia(NEAR_M, NEAR_EXPLICIT_M), *endless(NEAR_M, WIDE_M)]
    return [*still, *with_inertia(NEAR_EXPLICIT_M, (1.25,), (), NEAR_SETTLING_1_S)]


def near_tip(reference: interfaces.Reference, name: str, title: str, says: str, exact: dict[str, float]) -> Wanted:
    """K_I at the tip that is nearer to the interface; `exact`: what strata-reference is asked with."""
    solution = "bonded_normal" if name.startswith("bonded") else "spring_interface"
    sample = interfaces.both_tips(reference)[0].sample

    def answer(given: Answer) -> Sample:
        """K_I of the near tip by so many nodes or elements beside that by as many nodes as settle it."""
        own = relative_error(solution, **exact)
        return Sample.of(given.get("K_I_near", given.get("K_I", float("nan"))), value(solution, "K_I_near", **exact), None, own)

    return Wanted(name, title, "Pa sqrt(m)", says, sample, answer)


ROCKS = {"youngs_modulus_Pa": 10e9, "beyond_youngs_modulus_Pa": 5e9}
CRACK = {"half_length_m": 5.0, "distance_m": DISTANCE_M, "pressure_Pa": 0.3e6}
STIFFNESS = interfaces.E_PRIME_PA / interfaces.HALF_LENGTH_M
SPRINGS = {"youngs_modulus_Pa": 10e9, "normal_stiffness_Pa_m": STIFFNESS, "shear_stiffness_Pa_m": STIFFNESS}

BONDED_K = near_tip(
    interfaces.bonded, "bonded_K_I", "K_I near a bonded interface",
    "relative to K_I at the near tip in the infinite plane (strata-reference bonded_normal); the edges of a block of 160 m add 1 %",
    ROCKS | CRACK,
)  # fmt: skip
SOFT_K = near_tip(
    interfaces.springs, "soft_K_I", "K_I near a soft interface",
    "relative to K_I at the near tip in the infinite plane (strata-reference spring_interface); the edges of a block of 160 m add 1 %",
    SPRINGS | CRACK,
)  # fmt: skip


def elements_near() -> dict[str, object]:
    """The crack before the bonded interface x = 0 as straight boundary elements take it; its last point is the near tip."""
    a, d = CRACK["half_length_m"], CRACK["distance_m"]
    return ROCKS | {
        "x_m": [-(d + 2.0 * a), -d], "y_m": [0.0, 0.0], "interface_x_m": 0.0, "mirror": "none", "s_xx_Pa": 0.0, "s_yy_Pa": 0.0,
        "pressure_Pa": CRACK["pressure_Pa"],
    }  # fmt: skip


BONDED = Problem(
    "bonded", "A crack of 10 m in stiff rock, normal to soft rock bonded to it 2.5 m ahead", (BONDED_K,),
    (
        *methods(interfaces.BONDED, near(("stiff", "soft")), near_curves()), collocation("bonded_normal", "nodes", ROCKS | CRACK, UNKNOWNS),
        Method("be_curved_crack", "boundary elements (curved_crack)", None, main=True, source="curved_crack",
               levels=asked(elements_near(), "refine", (1, 2, 4))),
    ),
)  # fmt: skip
SPRUNG = Problem(
    "soft", "A crack of 10 m, normal to a soft interface (D a/E' = 1) 2.5 m ahead", (SOFT_K,),
    (
        *methods(interfaces.SPRINGS, near(("stiff", "stiff"), SOFT), near_curves()),
        collocation("spring_interface", "nodes", SPRINGS | CRACK, UNKNOWNS),
    ), about_s=4.0,
)  # fmt: skip
CRACKS = (BLOCK, BONDED, SPRUNG)

SHIPPED = ("ex_total_graded", "1 m"), ("ex_total", "1 m")  # what the scenes of Experiments 1 and 6 ask for

# --- Experiment 1, soft interface under an even pressure
CLOSING_PA = 2.0e6
PASSED_M = 12.0  # the interface is at 10 m, where the tip is held until a fresh crack of an increment, 1 m, can go on
CROSSING_M = (1.0, 0.5, 0.25, 0.125)  # increments are whole cells, the first tip and the interface on grid lines
CROSSING_DAMPING_1_S = 20.0  # the experiment's


def crossing(setting: Setting, cell_m: float) -> tuple[str, tuple[str, ...]]:
    """The experiment under an even pressure, until the fracture is through the interface; its scene's grid is graded."""
    uniform = () if setting.graded > 0.0 else (f"numerics.far_cell_m={cell_m!r}",)
    return "uniform_soft", (f"stop.tip_y_m={PASSED_M!r}", *uniform)


def restart(run: Run) -> Sample:
    """Net pressure at which the tip goes on from the interface against that of a fresh crack of an increment, Pa."""
    found = [event.inlet_Pa for event in run.summary.events if event.kind == "restart"]
    if not found:
        raise LoadError("the tip does not go on from the interface")
    return Sample.of(found[0] - CLOSING_PA, value("crossing_pressure", "net_pressure_Pa"))


CROSSING = Problem(
    "crossing", "Experiment 1 with a soft interface under an even pressure, from the start of the ramp until the tip is past the interface",
    (
        Wanted("crossing_restart", "restart behind the interface, Exp. 1 soft", "Pa",
               "relative to the net pressure at which a fresh crack of one increment, 1 m, releases enough behind the cut block"
               " (strata-reference crossing_pressure)", restart),
    ),
    methods(EXPERIMENTS / "exp1_single_interface.toml", crossing, [
        *without_inertia(CROSSING_M, (1.0, 0.5)),
        *with_inertia((1.0, 0.5), (1.0,), (), CROSSING_DAMPING_1_S),
        Method("ex_undamped", "explicit, updated, undamped", replace(MOVING, damping_1_s=0.0), (1.0,), True),
    ]), experiments=(1, 2, 3, 4), shipped=SHIPPED[0], limit_s=300.0, about_s=16.0,
)  # fmt: skip

# --- the path of Experiment 6
PATH_M = (1.0, 0.5, 0.25)
INCREMENT_CELLS = 3.0  # fewer and the solver turns by a share of maximum hoop stress only
CONVERGED_M = 0.125  # increment of the finest path of boundary elements
SMALL_BLOCK = (
    "domain.width_m=48", "domain.height_m=36", 'strata.layers=[{rock="stiff",thickness_m=29},{rock="soft"}]',
    "fracture.path_m=[[24.0, 0.0], [24.0, 5.0]]",
)  # fmt: skip
KEPT_OFF_M = 0.5  # from the interface, to which paths are compared


def turning(setting: Setting, cell_m: float) -> tuple[str, tuple[str, ...]]:
    """A block that stands for the infinite plane where the grid is graded, the study's own elsewhere."""
    increment = (f"fracture.increment_m={INCREMENT_CELLS * cell_m!r}",)
    uniform = (*increment, f"numerics.far_cell_m={cell_m!r}")
    if setting.mechanics == "explicit":
        return "block_explicit", increment if setting.graded > 0.0 else uniform
    if setting.beyond_m > 0.0:
        return "", (*uniform, *SMALL_BLOCK)
    if setting.graded == 0.0:
        return "block", uniform
    return "", (*increment, "numerics.far_cell_m=8.0")


def off(exact: Callable[[Run], Array], own_error: float = 0.0) -> Callable[[Run], Sample]:
    """Largest distance from a path, up to half a metre from the interface, against the growth followed, 20 m."""

    def sample(run: Run) -> Sample:
        tips = grown(run)
        inside = tips[tips[:, 0] < INTERFACE_M - KEPT_OFF_M]
        return Sample.of(farthest(inside, exact(run)), 0.0, paths.GROWTH_M, own_error)

    return sample


def elements_off(answer: Answer) -> Sample:
    """The same of a path of boundary elements, from the converged one."""
    tips = np.column_stack([answer["x_m"], answer["y_m"]])
    inside = tips[tips[:, 0] < INTERFACE_M - KEPT_OFF_M]
    return Sample.of(farthest(inside, converged()), 0.0, paths.GROWTH_M, settled_to())


def converged(_: Run | None = None) -> Array:
    """The path of boundary elements with the smallest increment."""
    return exact_path(6, CONVERGED_M, "forward", paths.GROWTH_M)


def settled_to() -> float:
    """How far the converged path still is from its limit (first order: as far as halving the increment moved it), share of 20 m."""
    return farthest(exact_path(6, 2.0 * CONVERGED_M, "forward", paths.GROWTH_M), converged()) / paths.GROWTH_M


PATH = Problem(
    "path", "Experiment 6 with a perfect interface and the inlet's pressure everywhere: the path over 20 m of growth",
    (
        Wanted("path_same", "path of Exp. 6, same increments", "m",
               "largest distance from the boundary elements' path in the run's own increments, over 20 m of growth", off(paths.same_6)),
        Wanted("path_converged", "path of Exp. 6, all errors", "m",
               "largest distance from the boundary elements' path in increments of 0.125 m, over 20 m of growth: increments of 3 cells are"
               " part of the error", lambda run: off(converged, settled_to())(run), elements_off),
    ),
    (
        Method("be_crack_path", "boundary elements (crack_path)", None, main=True, source="crack_path",
               levels=tuple(Level(f"increments {size:g} m", size, settings_of(path_settings(6, size, "forward", paths.GROWTH_M)))
                            for size in (3.0, 1.5, 0.75, 0.375))),
        *methods(ANALYTIC / "path_exp6.toml", turning, [
            Method("qs_graded", "quasi-static, graded", replace(STILL, graded=FAR), PATH_M, True),
            Method("qs_graded_linear", "quasi-static, graded, linear", replace(STILL, graded=FAR, shape="linear"), PATH_M, True),
            *endless(PATH_M, 800.0)[:1],
            Method("qs_uniform", "quasi-static, uniform, block of 80 m", STILL, (1.0, 0.5), True),
            *with_inertia((1.0, 0.5), (1.0,), (), 20.0),
        ]),
    ), experiments=(5, 6), shipped=SHIPPED[1], about_s=20.0,
)  # fmt: skip

# --- fractures fed at a rate
KGD_M = (1.0, 0.5, 0.25, 0.125)


def fed(variant: str, share: float = 1.0) -> Base:
    """A share of a cell a step of growth."""

    def base(setting: Setting, cell_m: float) -> tuple[str, tuple[str, ...]]:
        """Variant, increment and first length; the scene's own cells far away where the grid is graded."""
        keys = [f"fracture.increment_m={share * cell_m!r}", "fracture.path_m=[[120.0, 0.0], [120.0, 1.0]]"]
        if setting.mechanics == "quasistatic":
            keys.append(f"numerics.far_cell_m={10.0 if setting.graded > 0.0 else cell_m!r}")
        return variant, tuple(keys)

    return base


def kgd_curves() -> list[Method]:
    """Flow that conserves volume is quasi-static only: the explicit curve is there to say so."""
    graded = replace(STILL, graded=FAR)
    return [
        *(curve for curve in without_inertia(KGD_M, (1.0,)) if curve.name in ("qs_graded", "qs_graded_linear", "qs_uniform")),
        Method("qs_graded_coarse_flow", "quasi-static, graded, coarse steps of flow",
              replace(graded, further=("numerics.flow_error=0.01", "numerics.flow_change=0.3")), KGD_M, True),
        Method("qs_graded_fine_flow", "quasi-static, graded, fine steps of flow",
              replace(graded, further=("numerics.flow_error=1e-4", "numerics.flow_change=0.075")), KGD_M[:2], True),
        Method("ex_updated", "explicit, updated", MOVING, (1.0,)),
        Method("ex_total", "explicit, total", RESTING, (1.0,)),
    ]  # fmt: skip


def kgd_methods(variant: str) -> tuple[Method, ...]:
    """The curves above in steps of a cell, and increments of parts of one: a fracture that has just grown is ahead of its fluid by half
    an increment in the mean, which is most of the error of length."""
    graded = replace(STILL, graded=FAR)
    half = Method("qs_graded_half", "quasi-static, graded, increments of 1/2 cell", graded, KGD_M, True)
    quarter = Method("qs_graded_quarter", "quasi-static, graded, increments of 1/4 cell", graded, KGD_M[:3], True)
    return (
        *methods(kgd.SCENE, fed(variant), kgd_curves()),
        *methods(kgd.SCENE, fed(variant, 0.5), [half]),
        *methods(kgd.SCENE, fed(variant, 0.25), [quarter]),
    )


def kgd_problem(variant: str, solution: str, words: str) -> Problem:
    """The length of a fracture fed at a rate, near one of its vertices."""
    course = Wanted(
        f"kgd_{variant}", f"KGD length, {variant}", "m",
        f"root mean square of the relative errors of length at 10, 20 .. 100 s against strata-reference {solution}",
        kgd.course(solution, "half_length_m"),
    )  # fmt: skip
    return Problem(f"kgd_{variant}", f"A fracture fed at 1e-4 m^2/s for 100 s, {words}", (course,), kgd_methods(variant), about_s=45.0)


GROWTH = (CROSSING, PATH, kgd_problem("toughness", kgd.TOUGHNESS, "toughness number 13.6"), kgd_problem("viscosity", kgd.VISCOSITY, "no toughness"))

# In the order of the chart's panels.
PROBLEMS: tuple[Problem, ...] = checked((*CRACKS, *GROWTH))
