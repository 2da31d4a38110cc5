"""What a scene models and resolves, each as the settings that leave it out alone, and how its run is then read.

An ingredient of the group `modelled` is switched off, one of `resolved` is made coarser; `left_out` is what the scene itself goes without
and its run has: the table's other side.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from verification.harness.factors import is_graded, toml
from verification.harness.load import Run

MODELLED, RESOLVED, LEFT_OUT = "modelled", "resolved", "left_out"

# Rock beyond the block's edges that stands for rock without end, m: 20 blocks (verification/ladder/cases/cracks.py).
BEYOND_M = 1600.0

# Cells far away, over those near the fracture, of the graded alternative.
GRADED = 4.0


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
class Ingredient:
    """Something that a scene has, or goes without: its group, what is done about it, and the settings that do it.

    view: how its run is read beside the scene's own. why_not: why it does not apply.
    """

    id: str
    label: str
    group: str
    done: str
    settings: tuple[str, ...] = ()
    view: View = View()
    why_not: str = ""


def ingredients_of(content: dict[str, Any]) -> list[Ingredient]:
    """All ingredients of an explicit scene, its keys with a variant's in place."""
    return [
        _inertia(),
        _damping(content),
        _flow(content),
        *_interfaces(content),
        _layering(content),
        _edges(content),
        _prestress(content),
        _face_contact(),
        _soft_contact(content),
        _direction(content),
        _symmetry(content),
        *_resolution(content),
        *_left_out(content),
    ]


def _inertia() -> Ingredient:
    """Without inertia, and growth by the same criterion."""
    settings = ("numerics.mechanics=quasistatic", "fracture.crossing=J")
    return Ingredient("inertia", "inertia", MODELLED, "quasi-static, growth by J as before", settings)


def _damping(content: dict[str, Any]) -> Ingredient:
    """Waves that nothing but the edges lets out."""
    if float(content["numerics"].get("damping_1_s", 0.0)) == 0.0:
        return Ingredient("damping", "damping", MODELLED, "", why_not="the scene has none")
    return Ingredient("damping", "damping", MODELLED, "none", ("numerics.damping_1_s=0.0",))


def _flow(content: dict[str, Any]) -> Ingredient:
    """The inlet's pressure everywhere."""
    if content["fluid"].get("law", "paper") == "uniform":
        return Ingredient("flow", "flow", MODELLED, "", why_not="the scene has none")
    return Ingredient("flow", "flow", MODELLED, "the inlet's pressure everywhere", ("fluid.law=uniform",))


def _interfaces(content: dict[str, Any]) -> list[Ingredient]:
    """Each interface that acts, bonded for good."""
    names = list(content["strata"].get("interfaces", []))
    acting = [k for k, name in enumerate(names) if name != "perfect"]
    if not acting:
        return [Ingredient("interface", "interfaces", MODELLED, "", why_not="all are perfect")]
    found = []
    for k in acting:
        others = [*names[:k], "perfect", *names[k + 1 :]]
        label = f"interface {k + 1} ({names[k]})" if len(acting) > 1 else f"interface ({names[k]})"
        found.append(Ingredient(f"interface_{k + 1}", label, MODELLED, "perfect", (f"strata.interfaces={toml(others)}",)))
    return found


def _place_of_start(content: dict[str, Any]) -> int:
    """The layer in which the fracture starts."""
    strata = content["strata"]
    x, y = content["fracture"]["path_m"][-1]
    at, top = (float(x) if strata.get("along", "y") == "x" else float(y)), 0.0
    for k, layer in enumerate(strata["layers"]):
        top += float(layer.get("thickness_m", np.inf))
        if at < top:
            return k
    raise ValueError("the fracture starts in no layer")


def _layering(content: dict[str, Any]) -> Ingredient:
    """One rock, that in which the fracture starts."""
    layers = [dict(layer) for layer in content["strata"]["layers"]]
    if len({layer["rock"] for layer in layers}) == 1:
        return Ingredient("layering", "layers of rock", MODELLED, "", why_not="the rock is one")
    rock = layers[_place_of_start(content)]["rock"]
    one = [{**layer, "rock": rock} for layer in layers]
    return Ingredient("layering", "layers of rock", MODELLED, f"{rock} rock everywhere", (f"strata.layers={toml(one)}",))


def _edges(content: dict[str, Any]) -> Ingredient:
    """Rock without end beyond the edges."""
    if float(content["domain"].get("beyond_m", 0.0)) > 0.0:
        return Ingredient("edges", "edges of the block", MODELLED, "", why_not="the rock goes on beyond them")
    return Ingredient("edges", "edges of the block", MODELLED, f"rock goes on for {BEYOND_M:g} m", (f"domain.beyond_m={BEYOND_M!r}",))


def _prestress(content: dict[str, Any]) -> Ingredient:
    """No stress in the rock, and pressures that are net: less the stress that closes the fracture."""
    in_situ, inlet, stop = content.get("in_situ", {}), content["fluid"]["inlet"], content["stop"]
    closing = float(in_situ.get("horizontal_Pa", 0.0))
    if closing == 0.0 and float(in_situ.get("vertical_Pa", 0.0)) == 0.0:
        return Ingredient("prestress", "in-situ stress", MODELLED, "", why_not="there is none")
    settings = ["in_situ.vertical_Pa=0.0", "in_situ.horizontal_Pa=0.0", f"fluid.inlet.start_Pa={float(inlet['start_Pa']) - closing!r}"]
    if "inlet_Pa" in stop:
        settings.append(f"stop.inlet_Pa={float(stop['inlet_Pa']) - closing!r}")
    return Ingredient("prestress", "in-situ stress", MODELLED, "none, pressures net of it", tuple(settings), View(add_Pa=closing))


def _face_contact() -> Ingredient:
    """Faces of the fracture that pass through each other."""
    done = "its faces pass through each other"
    return Ingredient("face_contact", "contact of the fracture's faces", MODELLED, done, ("fracture.faces=free",))


def _soft_contact(content: dict[str, Any]) -> Ingredient:
    """Springs in compression too, on every soft interface that is used."""
    label = "contact on the soft interface"
    used = set(content["strata"].get("interfaces", []))
    soft = [name for name, law in content.get("interface", {}).items()
            if name in used and law["law"] == "soft" and law.get("compression", "contact") == "contact"]  # fmt: skip
    if not soft:
        return Ingredient("soft_contact", label, MODELLED, "", why_not="no soft interface")
    return Ingredient("soft_contact", label, MODELLED, "springs there too", tuple(f"interface.{n}.compression=spring" for n in soft))


def _direction(content: dict[str, Any]) -> Ingredient:
    """Straight on, whatever the tip meets."""
    if content["fracture"].get("direction", "straight") == "straight":
        return Ingredient("direction", "direction of growth", MODELLED, "", why_not="the path is straight")
    return Ingredient("direction", "direction of growth", MODELLED, "straight ahead", ("fracture.direction=straight",))


def _symmetry(content: dict[str, Any]) -> Ingredient:
    """Both halves of the block, mirrored at the symmetry line."""
    label, domain, strata = "symmetry", content["domain"], content["strata"]
    if domain.get("bottom", "symmetry") != "symmetry":
        return Ingredient("symmetry", label, MODELLED, "", why_not="the scene has none")
    height = float(domain["height_m"])
    (x, _), (x_tip, y_tip) = content["fracture"]["path_m"][0], content["fracture"]["path_m"][-1]
    path = [[x_tip, height - y_tip], [x, height], [x_tip, height + y_tip]]
    settings = ["domain.bottom=traction", f"domain.height_m={2.0 * height!r}", f"fracture.path_m={toml(path)}"]
    if "tip_y_m" in content["stop"]:
        settings.append(f"stop.tip_y_m={height + float(content['stop']['tip_y_m'])!r}")
    if "fine_top_m" in content["numerics"]:
        fine = float(content["numerics"]["fine_top_m"])
        settings += [f"numerics.fine_top_m={height + fine!r}", f"numerics.fine_bottom_m={height - fine!r}"]
    if strata.get("along", "y") == "y":
        settings += [f"{key}={toml(value)}" for key, value in mirrored(strata, height).items()]
    return Ingredient("symmetry", label, MODELLED, "both halves of the block", tuple(settings), View(fold_m=height))


def mirrored(strata: dict[str, Any], height_m: float) -> dict[str, Any]:
    """Layers stacked upwards on both sides of a symmetry line: the lowest one below and above it, twice as thick; lists as in a scene."""
    layers = [dict(layer) for layer in strata["layers"]]
    names = list(strata.get("interfaces") or ["perfect"] * (len(layers) - 1))
    layers[-1].setdefault("thickness_m", height_m - sum(float(layer["thickness_m"]) for layer in layers[:-1]))
    middle = {**layers[0], "thickness_m": 2.0 * float(layers[0]["thickness_m"])}
    both = [*reversed(layers[1:]), middle, *layers[1:]]
    return {"strata.layers": both, "strata.interfaces": [*reversed(names), *names]}


def _resolution(content: dict[str, Any]) -> list[Ingredient]:
    """What is resolved, coarser."""
    numerics = content["numerics"]
    cell, courant = float(numerics["cell_m"]), float(numerics.get("courant", 0.5))
    return [
        Ingredient("cells", f"cells of {cell:g} m", RESOLVED, f"{2.0 * cell:g} m", (f"numerics.cell_m={2.0 * cell!r}",)),
        *([] if is_graded(content) else [_far_cells(content, cell)]),
        Ingredient("step", f"Courant number {courant:g}", RESOLVED, f"{2.0 * courant:g}", (f"numerics.courant={2.0 * courant!r}",)),
        Ingredient("looks", "looks at the tips every 4 steps", RESOLVED, "every 8", ("numerics.tip_steps=8",)),
        Ingredient("ring", "J rings of up to 4 cells", RESOLVED, "3 cells", ("numerics.ring_cells=3.0",)),
        Ingredient("shape", "quadratic shape functions", RESOLVED, "linear", ("numerics.shape=linear",)),
    ]


def _far_cells(content: dict[str, Any], cell: float) -> Ingredient:
    """Fine cells far away, of a uniform grid."""
    label = "fine cells far away"
    ends = any(key in content["numerics"] for key in ("fine_left_m", "fine_right_m", "fine_bottom_m", "fine_top_m"))
    if content["fracture"].get("direction", "straight") != "straight" and not ends:
        return Ingredient("far_cells", label, RESOLVED, "", why_not="the path may turn into coarse cells")
    return Ingredient("far_cells", label, RESOLVED, f"{GRADED * cell:g} m there", (f"numerics.far_cell_m={GRADED * cell!r}",))


def _left_out(content: dict[str, Any]) -> list[Ingredient]:
    """What the scene goes without: finer cells, such ones far away, more points, points that move."""
    numerics = content["numerics"]
    cell, points = float(numerics["cell_m"]), int(numerics.get("particles_per_cell", 4))
    found = [Ingredient("finer", f"cells of {cell / 2.0:g} m", LEFT_OUT, "modelled", (f"numerics.cell_m={cell / 2.0!r}",))]
    if is_graded(content):
        found.append(Ingredient("far_cells", "fine cells far away", LEFT_OUT, "modelled", (f"numerics.far_cell_m={cell!r}",)))
    if points < 16:
        found.append(Ingredient("points", "16 points a cell", LEFT_OUT, "modelled", ("numerics.particles_per_cell=16",)))
    if numerics.get("kinematics", "updated") == "total":
        found.append(Ingredient("moving", "points that move", LEFT_OUT, "modelled", ("numerics.kinematics=updated",)))
    return found


def named(found: Sequence[Ingredient], names: Sequence[str]) -> list[Ingredient]:
    """Those of some ids, in their order; all without names. Raises ValueError for a name that is none."""
    known = {one.id for one in found}
    wrong = [name for name in names if name not in known]
    if wrong:
        raise ValueError(f"no ingredient {', '.join(wrong)}; there are {', '.join(sorted(known))}")
    return [one for one in found if not names or one.id in names]
