"""What a scene models, each as the settings that leave it out alone, and how its run is then read."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from verification.harness.factors import toml
from verification.harness.load import Run

# Rock beyond the block's edges that stands for rock without end, m: 20 blocks (verification/ladder/cases/cracks.py).
BEYOND_M = 1600.0


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
    """Something that a scene has: what is done about it, and the settings that do it.

    view: how its run is read beside the scene's own. why_not: why it does not apply.
    """

    id: str
    label: str
    done: str = ""
    settings: tuple[str, ...] = ()
    view: View = View()
    why_not: str = ""


def ingredients_of(content: dict[str, Any]) -> list[Ingredient]:
    """All ingredients of an explicit scene, its keys with a variant's in place."""
    numerics, fracture = content["numerics"], content["fracture"]
    damped, flows = float(numerics["damping_1_s"]) > 0.0, content["fluid"]["law"] != "uniform"
    straight, endless = fracture.get("direction", "straight") == "straight", float(content["domain"].get("beyond_m", 0.0)) > 0.0
    return [
        _part("inertia", "inertia", "", "quasi-static", "numerics.mechanics=quasistatic"),
        _part("damping", "damping", "" if damped else "the scene has none", "none", "numerics.damping_1_s=0.0"),
        _part("flow", "flow", "" if flows else "the scene has none", "the inlet's pressure everywhere", "fluid.law=uniform"),
        *_interfaces(content),
        _layering(content),
        _part("edges", "edges of the block", "the rock goes on beyond them" if endless else "", f"rock goes on for {BEYOND_M:g} m",
              f"domain.beyond_m={BEYOND_M!r}"),
        _prestress(content),
        _part("face_contact", "contact of the fracture's faces", "", "its faces pass through each other", "fracture.faces=free"),
        _soft_contact(content),
        _part("direction", "direction of growth", "the path is straight" if straight else "", "straight ahead", "fracture.direction=straight"),
        _symmetry(content),
    ]  # fmt: skip


def _part(id_: str, label: str, why_not: str, done: str, *settings: str, view: View = View()) -> Ingredient:
    """An ingredient that is left out by settings, or why it does not apply."""
    return Ingredient(id_, label, why_not=why_not) if why_not else Ingredient(id_, label, done, settings, view)


def _interfaces(content: dict[str, Any]) -> list[Ingredient]:
    """Each interface that acts, bonded for good."""
    names = list(content["strata"].get("interfaces", []))
    acting = [k for k, name in enumerate(names) if name != "perfect"]
    if not acting:
        return [_part("interface", "interfaces", "all are perfect", "")]
    return [
        _part(f"interface_{k + 1}", f"interface {k + 1} ({names[k]})" if len(acting) > 1 else f"interface ({names[k]})", "", "perfect",
              f"strata.interfaces={toml([*names[:k], 'perfect', *names[k + 1 :]])}")
        for k in acting
    ]  # fmt: skip


def _layering(content: dict[str, Any]) -> Ingredient:
    """One rock, that in which the fracture starts."""
    strata = content["strata"]
    layers, start = [dict(layer) for layer in strata["layers"]], content["fracture"]["path_m"][-1][0 if strata.get("along", "y") == "x" else 1]
    tops = np.cumsum([float(layer.get("thickness_m", np.inf)) for layer in layers])
    rock = layers[int(np.searchsorted(tops, float(start), side="right"))]["rock"]
    why_not = "the rock is one" if len({layer["rock"] for layer in layers}) == 1 else ""
    one = toml([{**layer, "rock": rock} for layer in layers])
    return _part("layering", "layers of rock", why_not, f"{rock} rock everywhere", f"strata.layers={one}")


def _prestress(content: dict[str, Any]) -> Ingredient:
    """No stress in the rock, and pressures that are net: less the stress that closes the fracture."""
    in_situ, stop = content.get("in_situ", {}), content["stop"]
    closing = float(in_situ.get("horizontal_Pa", 0.0))
    why_not = "there is none" if closing == 0.0 and float(in_situ.get("vertical_Pa", 0.0)) == 0.0 else ""
    settings = ["in_situ.vertical_Pa=0.0", "in_situ.horizontal_Pa=0.0"]
    settings.append(f"fluid.inlet.start_Pa={float(content['fluid']['inlet']['start_Pa']) - closing!r}")
    settings += [f"stop.inlet_Pa={float(stop['inlet_Pa']) - closing!r}"] if "inlet_Pa" in stop else []
    return _part("prestress", "in-situ stress", why_not, "none, pressures net of it", *settings, view=View(add_Pa=closing))


def _soft_contact(content: dict[str, Any]) -> Ingredient:
    """Springs in compression too, on every soft interface that is used."""
    used = set(content["strata"].get("interfaces", []))
    soft = [name for name, law in content.get("interface", {}).items()
            if name in used and law["law"] == "soft" and law.get("compression", "contact") == "contact"]  # fmt: skip
    settings = [f"interface.{name}.compression=spring" for name in soft]
    return _part("soft_contact", "contact on the soft interface", "" if soft else "no soft interface", "springs there too", *settings)


def _symmetry(content: dict[str, Any]) -> Ingredient:
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
    return _part("symmetry", "symmetry", why_not, "both halves of the block", *settings, view=View(fold_m=height))


def mirrored(strata: dict[str, Any], height_m: float) -> dict[str, Any]:
    """Layers stacked upwards on both sides of a symmetry line: the lowest one below and above it, twice as thick; lists as in a scene."""
    layers = [dict(layer) for layer in strata["layers"]]
    names = list(strata.get("interfaces") or ["perfect"] * (len(layers) - 1))
    layers[-1].setdefault("thickness_m", height_m - sum(float(layer["thickness_m"]) for layer in layers[:-1]))
    middle = {**layers[0], "thickness_m": 2.0 * float(layers[0]["thickness_m"])}
    both = [*reversed(layers[1:]), middle, *layers[1:]]
    return {"strata.layers": both, "strata.interfaces": [*reversed(names), *names]}


def named(found: Sequence[Ingredient], names: Sequence[str]) -> list[Ingredient]:
    """Those of some ids, in their order; all without names. Raises ValueError for a name that is none."""
    known = {one.id for one in found}
    wrong = [name for name in names if name not in known]
    if wrong:
        raise ValueError(f"no ingredient {', '.join(wrong)}; there are {', '.join(sorted(known))}")
    return [one for one in found if not names or one.id in names]
