"""What can be changed about a scene, each thing alone: the ingredients that are left out of it, and the factors of its error budget that are varied."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from verification.harness.load import Run
from verification.harness.quantities import turns

# Rock beyond the block's edges that stands for rock without end, m: 20 blocks (verification/ladder/cases/cracks.py).
BEYOND_M = 1600.0

# Radii of the widest J ring, in cells, beside the default of 4.
RINGS = (3.0, 5.0)

# Beyond the fine cells a straight fracture's larger block is graded up to so many cells, which leaves results as they are.
FAR_CELLS = 4.0

# Groups of factors: the method's, choices of the scene's, and what is shown beside both and not summed.
NUMERICAL, MODEL, BESIDE = "numerical", "model", "beside"


@dataclass(frozen=True)
class View:
    """How a run is read as if it were one of the scene itself: pressures so much higher (Pa), heights folded at a line (m)."""

    add_Pa: float = 0.0
    fold_m: float = 0.0

    def of(self, run: Run, base: Run) -> Run:
        """The run as it is read beside the scene's own; the same object where nothing changes."""
        if self.add_Pa == 0.0 and self.fold_m == 0.0:
            return run
        history: dict[str, np.ndarray] = dict(run.history)
        history["inlet_Pa"] = history["inlet_Pa"] + self.add_Pa
        history["tip_y_m"] = self._height(history["tip_y_m"])
        events = tuple(replace(event, inlet_Pa=event.inlet_Pa + self.add_Pa, tip_y_m=float(self._height(event.tip_y_m)))
                       for event in run.summary.events)  # fmt: skip
        summary = replace(run.summary, events=events, inlet_Pa=run.summary.inlet_Pa + self.add_Pa)
        # Layers and path of a mirrored block are those of its upper half.
        return replace(run, scene=base.scene if self.fold_m else run.scene, history=history, summary=summary)

    def _height(self, y: Any) -> Any:
        """A height above the line of folding, whichever side of it, m."""
        return np.abs(y - self.fold_m) if self.fold_m else y


@dataclass(frozen=True)
class Change:
    """Something about a scene, what is done about it, and the settings KEY=VALUE that do this alone.

    id: as in a folder's name. label: of several changes of one factor the same. view: how its run is read beside the scene's own. why_not: why it does
    not apply. group: of factors, see above.
    """

    id: str
    label: str
    done: str = ""
    settings: tuple[str, ...] = ()
    view: View = View()
    why_not: str = ""
    group: str = ""


def part(id_: str, label: str, why_not: str, done: str, *settings: str, view: View = View(), group: str = "") -> Change:
    """A change that is made by settings, or why it does not apply."""
    return Change(id_, label, why_not=why_not, group=group) if why_not else Change(id_, label, done, settings, view, group=group)


def toml(value: Any) -> str:
    """A value as TOML on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    return json.dumps(value) if isinstance(value, (str, bool)) else repr(value)


def named(found: Sequence[Change], names: Sequence[str]) -> list[Change]:
    """Those whose ids are these, or these and a value ("mesh" of mesh_half), in their order; all without names. Raises ValueError for a name that is none."""
    every = {one: {one.id, one.id.rpartition("_")[0] if one.group else one.id} for one in found}
    known = set().union(*every.values())
    if wrong := [name for name in names if name not in known]:
        raise ValueError(f"no {', '.join(wrong)} to change; there are {', '.join(sorted(known))}")
    return [one for one, own in every.items() if not names or own & set(names)]


# --- ingredients
def ingredients_of(content: dict[str, Any]) -> list[Change]:
    """All ingredients of an explicit scene, its keys with a variant's in place."""
    numerics, fracture = content["numerics"], content["fracture"]
    damped, flows = float(numerics["damping_1_s"]) > 0.0, content["fluid"]["law"] != "uniform"
    endless = float(content["domain"].get("beyond_m", 0.0)) > 0.0
    return [
        part("inertia", "inertia", "", "quasi-static", "numerics.mechanics=quasistatic"),
        part("damping", "damping", "" if damped else "the scene has none", "none", "numerics.damping_1_s=0.0"),
        part("flow", "flow", "" if flows else "the scene has none", "the inlet's pressure everywhere", "fluid.law=uniform"),
        *_interfaces(content),
        _layering(content),
        part("edges", "edges of the block", "the rock goes on beyond them" if endless else "", f"rock goes on for {BEYOND_M:g} m",
             f"domain.beyond_m={BEYOND_M!r}"),
        _prestress(content),
        part("face_contact", "contact of the fracture's faces", "", "its faces pass through each other", "fracture.faces=free"),
        _soft_contact(content),
        part("direction", "direction of growth", "" if turns(content) else "the path is straight", "straight ahead", "fracture.direction=straight"),
        _symmetry(content),
    ]  # fmt: skip


def _interfaces(content: dict[str, Any]) -> list[Change]:
    """Each interface that acts, bonded for good."""
    names = list(content["strata"].get("interfaces", []))
    acting = [k for k, name in enumerate(names) if name != "perfect"]
    if not acting:
        return [part("interface", "interfaces", "all are perfect", "")]
    return [
        part(f"interface_{k + 1}", f"interface {k + 1} ({names[k]})" if len(acting) > 1 else f"interface ({names[k]})", "", "perfect",
             f"strata.interfaces={toml([*names[:k], 'perfect', *names[k + 1 :]])}")
        for k in acting
    ]  # fmt: skip


def _layering(content: dict[str, Any]) -> Change:
    """One rock, that in which the fracture starts."""
    strata = content["strata"]
    layers, start = [dict(layer) for layer in strata["layers"]], content["fracture"]["path_m"][-1][0 if strata.get("along", "y") == "x" else 1]
    tops = np.cumsum([float(layer.get("thickness_m", np.inf)) for layer in layers])
    rock = layers[int(np.searchsorted(tops, float(start), side="right"))]["rock"]
    why_not = "the rock is one" if len({layer["rock"] for layer in layers}) == 1 else ""
    one = toml([{**layer, "rock": rock} for layer in layers])
    return part("layering", "layers of rock", why_not, f"{rock} rock everywhere", f"strata.layers={one}")


def _prestress(content: dict[str, Any]) -> Change:
    """No stress in the rock, and pressures that are net: less the stress that closes the fracture."""
    in_situ, stop = content.get("in_situ", {}), content["stop"]
    closing = float(in_situ.get("horizontal_Pa", 0.0))
    why_not = "there is none" if closing == 0.0 and float(in_situ.get("vertical_Pa", 0.0)) == 0.0 else ""
    settings = ["in_situ.vertical_Pa=0.0", "in_situ.horizontal_Pa=0.0"]
    settings.append(f"fluid.inlet.start_Pa={float(content['fluid']['inlet']['start_Pa']) - closing!r}")
    settings += [f"stop.inlet_Pa={float(stop['inlet_Pa']) - closing!r}"] if "inlet_Pa" in stop else []
    return part("prestress", "in-situ stress", why_not, "none, pressures net of it", *settings, view=View(add_Pa=closing))


def _soft_contact(content: dict[str, Any]) -> Change:
    """Springs in compression too, on every soft interface that is used."""
    used = set(content["strata"].get("interfaces", []))
    soft = [name for name, law in content.get("interface", {}).items()
            if name in used and law["law"] == "soft" and law.get("compression", "contact") == "contact"]  # fmt: skip
    settings = [f"interface.{name}.compression=spring" for name in soft]
    return part("soft_contact", "contact on the soft interface", "" if soft else "no soft interface", "springs there too", *settings)


def _symmetry(content: dict[str, Any]) -> Change:
    """Both halves of the block, mirrored at the symmetry line."""
    domain, strata, numerics, stop = (content[name] for name in ("domain", "strata", "numerics", "stop"))
    height = float(domain["height_m"])
    (x, _), (x_tip, y_tip) = content["fracture"]["path_m"][0], content["fracture"]["path_m"][-1]
    path = [[x_tip, height - y_tip], [x, height], [x_tip, height + y_tip]]
    settings = ["domain.bottom=traction", f"domain.height_m={2.0 * height!r}", f"fracture.path_m={toml(path)}"]
    settings += [f"stop.tip_y_m={height + float(stop['tip_y_m'])!r}"] if "tip_y_m" in stop else []
    if "fine_top_m" in numerics:
        fine = float(numerics["fine_top_m"])
        settings += [f"numerics.fine_top_m={height + fine!r}", f"numerics.fine_bottom_m={height - fine!r}"]
    if strata.get("along", "y") == "y":
        settings += [f"{key}={toml(value)}" for key, value in mirrored(strata, height).items()]
    why_not = "" if domain.get("bottom", "symmetry") == "symmetry" else "the scene has none"
    return part("symmetry", "symmetry", why_not, "both halves of the block", *settings, view=View(fold_m=height))


def mirrored(strata: dict[str, Any], height_m: float) -> dict[str, Any]:
    """Layers stacked upwards on both sides of a symmetry line: the lowest one below and above it, twice as thick; lists as in a scene."""
    layers = [dict(layer) for layer in strata["layers"]]
    names = list(strata.get("interfaces") or ["perfect"] * (len(layers) - 1))
    layers[-1].setdefault("thickness_m", height_m - sum(float(layer["thickness_m"]) for layer in layers[:-1]))
    middle = {**layers[0], "thickness_m": 2.0 * float(layers[0]["thickness_m"])}
    both = [*reversed(layers[1:]), middle, *layers[1:]]
    return {"strata.layers": both, "strata.interfaces": [*reversed(names), *names]}


# --- factors
def factors_of(content: dict[str, Any], mechanics: str) -> list[Change]:
    """All factors of a scene (its keys as used) in a mechanics, each by other values of it."""
    numerics, inlet = content["numerics"], content["fluid"]["inlet"]
    cell, points = float(numerics["cell_m"]), int(numerics["particles_per_cell"])
    increment, rate = float(content["fracture"]["increment_m"]), float(inlet.get("rate_Pa_s", 0.0))
    half_cell, half_step = f"numerics.cell_m={cell / 2.0!r}", f"fracture.increment_m={increment / 2.0!r}"
    counts = [n for n in (4, 9, 16) if n > points]
    return [
        Change("mesh_half", "mesh", f"cells of {cell / 2.0:g} m", (half_cell,), group=NUMERICAL),
        # The direction of growth of a path that turns looks at both.
        *([Change("mesh_increment_half", "mesh and increment", f"cells {cell / 2.0:g} m, increment {increment / 2.0:g} m", (half_cell, half_step),
                  group=BESIDE)] if turns(content) else []),
        _step(content, mechanics),
        *(Change(f"ring_{r:g}", "J ring", f"{r:g} cells", (f"numerics.ring_cells={r!r}",), group=NUMERICAL) for r in RINGS),
        *(Change(f"particles_{n}", "particles", f"{n} a cell", (f"numerics.particles_per_cell={n}",), group=NUMERICAL) for n in counts),
        *([] if counts else [Change("particles_", "particles", why_not="as many as there may be", group=NUMERICAL)]),
        *_half_and_double("increment", "increment", increment, "m", "fracture.increment_m"),
        *(_larger(content, mechanics, k) for k in (1.5, 2.0)),
        *(_half_and_double("rate", "loading rate", rate, "MPa/s", "fluid.inlet.rate_Pa_s", 1e6) if rate > 0.0
          else [Change("rate_", "loading rate", why_not="the inlet's pressure does not rise", group=MODEL)]),
    ]  # fmt: skip


def _half_and_double(id_: str, label: str, own: float, unit: str, key: str, size: float = 1.0) -> list[Change]:
    """Half and twice a number, in words in a unit of so many SI ones."""
    return [Change(f"{id_}_{name}", label, f"{own * k / size:g} {unit}", (f"{key}={own * k!r}",), group=MODEL) for name, k in (("half", 0.5), ("double", 2.0))]


def _step(content: dict[str, Any], mechanics: str) -> Change:
    """Half the time step, or half of what a step of the flow may change."""
    numerics = content["numerics"]
    if mechanics == "explicit":
        half = float(numerics["courant"]) / 2.0
        return Change("step_half", "time step", f"Courant number {half:g}", (f"numerics.courant={half!r}",), group=NUMERICAL)
    change, error = float(numerics["flow_change"]) / 2.0, float(numerics["flow_error"]) / 8.0  # which goes by the third power of the step
    keys = (f"numerics.flow_change={change!r}", f"numerics.flow_error={error!r}")
    why_not = "" if content["fluid"]["law"] != "uniform" else "no flow"
    return part("step_half", "flow step", why_not, f"flow change {change:g}, flow error {error:g}", *keys, group=NUMERICAL)


def _larger(content: dict[str, Any], mechanics: str, factor: float) -> Change:
    """A block wider on both sides and higher at the top; the fracture and the layers beside it stay in its middle. Where the path is straight and
    there is no inertia the cells beyond are graded; a path that turns would meet them, and its grid is uniform."""
    domain, strata, numerics = content["domain"], content["strata"], content["numerics"]
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
    cell = float(numerics["cell_m"])
    settings += [f"numerics.{key}={float(numerics[key]) + shift!r}" for key in ("fine_left_m", "fine_right_m") if key in numerics]
    if turns(content):
        settings.append(f"numerics.far_cell_m={cell!r}")
    elif mechanics == "quasistatic":
        settings.append(f"numerics.far_cell_m={FAR_CELLS * cell!r}")
    return Change(f"block_{factor:g}", "block", f"{width:g} m x {height:g} m", tuple(settings), group=MODEL)
