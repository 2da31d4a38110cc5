"""Rock near incompressibility, and rocks whose stiffnesses are far apart."""
from __future__ import annotations

import numpy as np

from verification.harness.load import Run, frames
from verification.harness.reference import value, values
from verification.stability.cracks import (
    AT_REST,
    CRACK,
    MIDDLE_M,
    NET_PA,
    SETTLING,
    farthest_off,
    griffith_K,
    half_length,
    layers_setting,
    path_setting,
    sneddon_opening,
    upper_tip,
)
from verification.stability.family import MARKED, Checked, Family, Parameter, Point, close

SECTION = "Rock: Poisson's ratio to 0.4999, stiffness contrast to 1e4"
ABOUT = (
    "Elements of low order lock as Poisson's ratio comes near 0.5: the rock seems too stiff. Rocks whose stiffnesses are"
    " a factor of 1e4 apart ask"
    " for equations with as much more range."
)

# --- Poisson's ratio
POISSON = (0.2, 0.4, 0.45, 0.49, 0.495, 0.499, 0.4999)


def worse(*checks: Checked) -> Checked:
    """Of several checks the one that is farthest off its own tolerance: one that fails before one that holds, then the larger error."""
    return max(checks, key=lambda checked: (not checked.holds, abs(checked.error)))


def K_and_opening(run: Run) -> Checked:
    """K_I = p sqrt(pi a) and the opening 4 p a/E' (Sneddon)."""
    K = farthest_off([tip.K_I_Pa_sqrt_m for tip in run.summary.tips], griffith_K(run))
    return worse(close(K, griffith_K(run), 0.01, "K_I"), close(run.summary.mouth_opening_m, sneddon_opening(run), 0.02, "opening"))


def poisson(name: str, keys: tuple[str, ...], how: str, ratios: tuple[float, ...] = POISSON, locking: float = 0.495) -> Family:
    """A crack in rock of a Poisson's ratio; beyond `locking` the run says itself that it is too stiff."""
    points = tuple(
        Point(f"{ratio:g}", 0.5 - ratio, CRACK, (*keys, f"rock.stiff.poisson_ratio={ratio}"), smoke=ratio in (0.2, 0.4999), beyond=ratio > locking)
        for ratio in ratios
    )
    return Family(
        name=f"poisson{name}", title=f"Poisson's ratio to {ratios[-1]:g}, {how}",
        says="K_I and the opening are those of the closed form, or the run says that its functions lock.",
        parameter=Parameter("0.5 less Poisson's ratio", log=True), points=points, check=K_and_opening, beyond=(MARKED,), section=SECTION, about=ABOUT,
    )  # fmt: skip


# --- contrast
CONTRASTS = (1.0, 10.0, 100.0, 1e3, 1e4)


def bonded_K(run: Run) -> Checked:
    """K_I at both tips against the integral equation of Cook and Erdogan: the worse."""
    rocks = [run.scene["rock"][layer["rock"]] for layer in run.scene["strata"]["layers"]]
    path = run.scene["fracture"]["path_m"]
    settings: dict[str, float] = {"half_length_m": half_length(run), "distance_m": MIDDLE_M - float(path[-1][1]), "pressure_Pa": NET_PA}
    for prefix, rock in zip(("", "beyond_"), rocks):
        settings |= {f"{prefix}{key}": float(rock[key]) for key in ("youngs_modulus_Pa", "poisson_ratio")}
    near, far = (value("bonded_normal", name, **settings) for name in ("K_I_near", "K_I_far"))
    lower = min(run.summary.tips, key=lambda tip: tip.y_m)
    return worse(close(upper_tip(run).K_I_Pa_sqrt_m, near, 0.01, "K_I, near tip"), close(lower.K_I_Pa_sqrt_m, far, 0.01, "K_I, far tip"))


def contrast(held_by: str, cells: float = 8.0) -> Family:
    """A crack at so many cells of 0.25 m from a rock that is softer or stiffer by a factor."""
    layers = layers_setting((held_by, MIDDLE_M), ("soft" if held_by == "stiff" else "stiff", None))
    top = MIDDLE_M - 0.25 * cells
    place = (path_setting((MIDDLE_M, top - 10.0), (MIDDLE_M, top)), "numerics.cell_m=0.25", "numerics.far_cell_m=1")
    points = tuple(
        Point(f"{ratio:g}", ratio, CRACK, (*AT_REST, *layers, *place, f"rock.soft.youngs_modulus_Pa={10.0e9 / ratio!r}"), smoke=ratio in (10.0, 1e4),
              beyond=ratio > 30.0)
        for ratio in CONTRASTS
    )
    return Family(
        name=f"contrast_in_{held_by}", title=f"Stiffness contrast to 1e4: a crack in the {held_by} rock, {cells:g} cells from the other",
        says="K_I of both tips is that of the integral equation.", parameter=Parameter("stiff over soft modulus", log=True), points=points,
        check=bonded_K, section=SECTION, beyond=(MARKED,),
        remark="Beside a rock that is 100 times as stiff and more the near K_I of a crack in the soft one is 1.3 to 1.8 %"
               " too small at 0.25 m cells:"
               " quadratic splines round the kink of strain off at the interface. It halves with the cell.",
    )  # fmt: skip


def shared_load(run: Run) -> Checked:
    """Horizontal stress of each layer in the middle of the stack against their shares by stiffness (strata-reference loaded_layers)."""
    layers = run.scene["strata"]["layers"]
    rocks = [run.scene["rock"][layer["rock"]] for layer in layers]
    thickness = [float(layers[0]["thickness_m"])]
    thickness.append(float(run.scene["domain"]["height_m"]) - thickness[0])
    in_situ = run.scene["in_situ"]
    exact = values("loaded_layers", "stress_xx_Pa", thickness_m=thickness, youngs_modulus_Pa=[float(rock["youngs_modulus_Pa"]) for rock in rocks],
                   poisson_ratio=[float(rock["poisson_ratio"]) for rock in rocks], horizontal_Pa=float(in_situ["horizontal_Pa"]),
                   vertical_Pa=float(in_situ["vertical_Pa"]))  # fmt: skip
    _, particles = frames(run, "particles")[-1]
    middle = np.abs(particles["x_m"] - 0.5 * float(run.scene["domain"]["width_m"])) < 1.0
    checks = []
    for k, stress in enumerate(exact):
        inside = middle & (np.abs(particles["y_m"] - (sum(thickness[:k]) + 0.5 * thickness[k])) < 1.0)
        checks.append(close(float(np.mean(particles["s_xx_Pa"][inside])), float(stress), 0.02, f"stress in layer {k}",
                            scale=float(np.max(np.abs(exact)))))
    return worse(*checks)


def stack() -> Family:
    """Bonded layers under edge tractions."""
    scene = CRACK.parents[2] / "analytic" / "loaded_layers.toml"
    points = tuple(
        Point(f"{ratio:g}", ratio, scene, (f"rock.soft.youngs_modulus_Pa={10.0e9 / ratio!r}", "numerics.cell_m=0.5"), smoke=ratio in (10.0, 1e4),
              beyond=ratio > 30.0)
        for ratio in CONTRASTS
    )
    return Family(
        name="contrast_layers", title="Stiffness contrast to 1e4: two layers under one load",
        says="Each layer bears its share by stiffness, or the run says that its rocks differ too much.",
        parameter=Parameter("stiff over soft modulus", log=True), points=points, check=shared_load, beyond=(MARKED,), section=SECTION,
    )  # fmt: skip


FAMILIES = (
    poisson("", AT_REST, "without inertia"),
    poisson("_linear", (*AT_REST, "numerics.shape=linear", "numerics.cell_m=0.25"), "without inertia, hat functions of 0.25 m", locking=0.45),
    poisson("_settled", SETTLING, "brought to rest by damping", (0.2, 0.4, 0.45, 0.49)),
    contrast("stiff"), contrast("soft"), stack(),
)  # fmt: skip
