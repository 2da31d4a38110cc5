"""What an error budget varies: for each factor, the other settings of a scene that differ from it in this alone."""

import json
from dataclasses import dataclass
from typing import Any

from verification.harness.quantities import turns

# Radii of the widest J ring, in cells, beside the default of 4.
RINGS = (3.0, 5.0)

# Beyond the fine cells a straight fracture's larger block is graded up to so many cells, which leaves results as they are.
FAR_CELLS = 4.0


@dataclass(frozen=True)
class Alternative:
    """Another value of a factor: what stands in a folder's name, in words, and as settings KEY=VALUE."""

    id: str
    label: str
    settings: tuple[str, ...]


@dataclass(frozen=True)
class Factor:
    """A factor; group 'numerical' (the method's), 'model' (a choice of the scene's) or 'beside' (shown, not summed)."""

    id: str
    label: str
    group: str
    alternatives: tuple[Alternative, ...]
    why_not: str = ""


def toml(value: Any) -> str:
    """A value as TOML on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    return json.dumps(value) if isinstance(value, (str, bool)) else repr(value)


def is_graded(content: dict[str, Any]) -> bool:
    """Whether a scene's cells grow far away."""
    numerics = content["numerics"]
    return float(numerics.get("far_cell_m", 0.0)) > float(numerics["cell_m"])


def factors_of(content: dict[str, Any], mechanics: str) -> list[Factor]:
    """All factors of a scene (its keys as used) in a mechanics; each alternative differs from it in that factor alone."""
    numerics, inlet = content["numerics"], content["fluid"]["inlet"]
    cell, points = float(numerics["cell_m"]), int(numerics["particles_per_cell"])
    increment, rate = float(content["fracture"]["increment_m"]), float(inlet.get("rate_Pa_s", 0.0))
    half_cell, half_step = f"numerics.cell_m={cell / 2.0!r}", f"fracture.increment_m={increment / 2.0!r}"
    both = Alternative("half", f"cells {cell / 2.0:g} m, increment {increment / 2.0:g} m", (half_cell, half_step))
    return [
        Factor("mesh", "mesh", "numerical", (Alternative("half", f"cells of {cell / 2.0:g} m", (half_cell,)),)),
        # The direction of growth of a path that turns looks at both.
        *([Factor("mesh_increment", "mesh and increment", "beside", (both,))] if turns(content) else []),
        _step(content, mechanics),
        Factor("ring", "J ring", "numerical", tuple(Alternative(f"{r:g}", f"{r:g} cells", (f"numerics.ring_cells={r!r}",)) for r in RINGS)),
        _factor("particles", "particles", "numerical", "as many as there may be",
                *(Alternative(str(n), f"{n} a cell", (f"numerics.particles_per_cell={n}",)) for n in (4, 9, 16) if n > points)),
        _factor("increment", "increment", "model", "", *_half_and_double(increment, "m", "fracture.increment_m")),
        Factor("block", "block", "model", tuple(_larger(content, mechanics, k) for k in (1.5, 2.0))),
        _factor("rate", "loading rate", "model", "the inlet's pressure does not rise",
                *(_half_and_double(rate, "MPa/s", "fluid.inlet.rate_Pa_s", 1e6) if rate > 0.0 else [])),
    ]  # fmt: skip


def _factor(id_: str, label: str, group: str, why_not: str, *alternatives: Alternative) -> Factor:
    """A factor with its alternatives, or why it has none."""
    return Factor(id_, label, group, alternatives, "" if alternatives else why_not)


def _half_and_double(own: float, unit: str, key: str, size: float = 1.0) -> list[Alternative]:
    """Half and twice a number, in words in a unit of so many SI ones."""
    return [Alternative(name, f"{own * k / size:g} {unit}", (f"{key}={own * k!r}",)) for name, k in (("half", 0.5), ("double", 2.0))]


def _step(content: dict[str, Any], mechanics: str) -> Factor:
    """Half the time step, or half of what a step of the flow may change."""
    numerics = content["numerics"]
    if mechanics == "explicit":
        half = float(numerics["courant"]) / 2.0
        return Factor("step", "time step", "numerical", (Alternative("half", f"Courant number {half:g}", (f"numerics.courant={half!r}",)),))
    change, error = float(numerics["flow_change"]) / 2.0, float(numerics["flow_error"]) / 8.0  # which goes by the third power of the step
    words, keys = f"flow change {change:g}, flow error {error:g}", (f"numerics.flow_change={change!r}", f"numerics.flow_error={error!r}")
    flows = content["fluid"]["law"] != "uniform"
    return _factor("step", "flow step", "numerical", "no flow", *([Alternative("half", words, keys)] if flows else []))


def _larger(content: dict[str, Any], mechanics: str, factor: float) -> Alternative:
    """A block wider on both sides and higher at the top; the fracture and the layers beside it stay in its middle. Where the path is straight and
    there is no inertia the cells beyond are graded; a path that turns would meet them, and its grid is uniform."""
    domain, strata = content["domain"], content["strata"]
    width, height = (factor * float(domain[key]) for key in ("width_m", "height_m"))
    shift = (width - float(domain["width_m"])) / 2.0
    path = [[float(x) + shift, float(y)] for x, y in content["fracture"]["path_m"]]
    settings = [f"domain.width_m={width!r}", f"domain.height_m={height!r}", f"fracture.path_m={toml(path)}"]
    layers = [dict(layer) for layer in strata["layers"]]
    if strata["along"] == "x" and "thickness_m" in layers[0]:
        layers[0]["thickness_m"] = float(layers[0]["thickness_m"]) + shift
    layers[-1].pop("thickness_m", None)  # takes what remains
    if layers != list(strata["layers"]):
        settings.append(f"strata.layers={toml(layers)}")
    numerics = content["numerics"]
    cell = float(numerics["cell_m"])
    settings += [f"numerics.{key}={float(numerics[key]) + shift!r}" for key in ("fine_left_m", "fine_right_m") if key in numerics]
    if turns(content):
        settings.append(f"numerics.far_cell_m={cell!r}")
    elif mechanics == "quasistatic":
        settings.append(f"numerics.far_cell_m={FAR_CELLS * cell!r}")
    return Alternative(f"{factor:g}", f"{width:g} m x {height:g} m", tuple(settings))
