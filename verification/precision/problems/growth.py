"""What becomes of growing fractures: Experiment 1 behind a soft interface, the path of Experiment 6, fractures fed at a rate."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from verification.harness.crack_paths import INTERFACE_M, exact_path, farthest, grown, path_settings
from verification.harness.load import LoadError, Run, settings_of, value
from verification.harness.paths import ANALYTIC, EXPERIMENTS
from verification.ladder.case import Array, Level, Sample
from verification.ladder.cases import kgd, paths
from verification.precision.problem import (
    FAR, MOVING, RESTING, STILL, Answer, Base, Method, Problem, Setting, Wanted, endless, methods, with_inertia, without_inertia,
)  # fmt: skip

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


def increments(*sizes_m: float) -> tuple[Level, ...]:
    """Levels of paths of boundary elements by their increments."""
    return tuple(Level(f"increments {size:g} m", size, settings_of(path_settings(6, size, "forward", paths.GROWTH_M))) for size in sizes_m)


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
        Method("be_crack_path", "boundary elements (crack_path)", None, main=True, source="crack_path", levels=increments(3.0, 1.5, 0.75, 0.375)),
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


PROBLEMS = (CROSSING, PATH, kgd_problem("toughness", kgd.TOUGHNESS, "toughness number 13.6"), kgd_problem("viscosity", kgd.VISCOSITY, "no toughness"))
