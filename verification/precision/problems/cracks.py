"""K_I of a pressurised crack in the study's block, near a bonded and near a soft interface, against analytic references."""

from collections.abc import Mapping
from dataclasses import replace

from verification.harness.load import Run, relative_error, settings_of, value
from verification.ladder.case import Level, Sample
from verification.ladder.cases import cracks, interfaces
from verification.precision.problem import Answer, Method, Problem, Setting, Wanted, endless, methods, with_inertia, without_inertia

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


def block_K_I(answer: Answer) -> Sample:
    """K_I by so many terms beside that by as many as settle it."""
    return Sample.of(answer["K_I"], value("block_crack", "K_I", **BLOCK_SETTINGS), None, relative_error("block_crack", **BLOCK_SETTINGS))


def exact_block_K_I(run: Run) -> Sample:
    """The ladder's sample of K_I, with the reference's own error."""
    return replace(cracks.K_I(run), reference_error=relative_error("block_crack", **BLOCK_SETTINGS))


BLOCK_CURVES = [
    *without_inertia(FINE_M, (2.5, 1.25, 1.0, 0.5)),
    Method("ex_shaken", "explicit, updated, damped as the experiments", Setting("explicit", kinematics="updated", transfer="flip",
          damping_1_s=SHAKEN_1_S), (2.5, 1.25, 1.0), True),
    *with_inertia(EXPLICIT_M, (2.5, 1.25, 1.0), (1.0,), SETTLING_1_S),
]  # fmt: skip

BLOCK = Problem(
    "block", "A crack of 5 m under 0.3 MPa net pressure in the study's block of 80 m, at rest",
    (Wanted("block_K_I", "K_I in the block", "Pa sqrt(m)", "relative to K_I of the same block (strata-reference block_crack)",
            exact_block_K_I, block_K_I),),
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
PROBLEMS = (BLOCK, BONDED, SPRUNG)
