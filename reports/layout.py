"""The geometry of an experiment from its resolved scene: layers, interfaces, fracture, edges, in-situ stress."""

from typing import Any

from reports.runs import NotAvailable, Run
from reports.shown import Shown
from reports.words import number


def layout_of(run: Run) -> Shown:
    """What a run's resolved scene looks like before anything happens; m and Pa, compression positive.

    A layer has its rock's name, its label (and a shorter one on one line), its places on the stacking axis and Young's modulus over the stiffest rock's; an
    interface its place, name and law; heights_m are those of interfaces across the fracture.
    """
    try:
        return _layout(run.scene, run.cell_m)
    except (KeyError, TypeError, IndexError) as error:
        raise NotAvailable(f"{run.experiment}/{run.variant}: scene.toml lacks {error}") from error


def _layout(scene: dict[str, Any], cell_m: float) -> Shown:
    """The layout of a scene's table."""
    domain, strata, in_situ = scene["domain"], scene["strata"], scene.get("in_situ", {})
    along = str(strata.get("along", "y"))
    layers = _layers(scene, float(domain["height_m" if along == "y" else "width_m"]))
    interfaces = [Shown(at_m=below.to_m, name=str(name), law=str(scene.get("interface", {}).get(name, {}).get("law", name)))
                  for below, name in zip(layers[:-1], strata.get("interfaces", []))]
    path = scene.get("fracture", {}).get("path_m", [])
    return Shown(
        width_m=float(domain["width_m"]), height_m=float(domain["height_m"]), along=along, layers=layers, interfaces=interfaces,
        heights_m=tuple(place.at_m for place in interfaces) if along == "y" else (), cell_m=cell_m,
        fracture_x_m=[float(point[0]) for point in path], fracture_y_m=[float(point[1]) for point in path],
        vertical_Pa=float(in_situ.get("vertical_Pa", 0.0)), horizontal_Pa=float(in_situ.get("horizontal_Pa", 0.0)),
    )


def _layers(scene: dict[str, Any], span_m: float) -> list[Shown]:
    """The layers with their places; the last one fills what is left of the span."""
    rocks = scene["rock"]
    stiffest = max(float(rock["youngs_modulus_Pa"]) for rock in rocks.values())
    layers: list[Shown] = []
    at = 0.0
    for entry in scene["strata"]["layers"]:
        rock = rocks[entry["rock"]]
        to = min(span_m, at + float(entry.get("thickness_m", span_m - at)))
        modulus, toughness = float(rock["youngs_modulus_Pa"]), float(rock.get("toughness_Pa_sqrt_m", 0.0))
        label = f"{entry['rock']}\nE {number(modulus / 1e9, 2)} GPa\n$K_{{Ic}}$ {number(toughness / 1e6)} MPa√m"
        line = f"{entry['rock']} {number(modulus / 1e9, 2)} GPa"
        layers.append(Shown(rock=str(entry["rock"]), from_m=at, to_m=to, label=label, line=line, stiffness=modulus / stiffest))
        at = to
    return layers


INTERFACE = "interface "  # begins the keys of what acts at a place, such as "interface 1 coefficient"


def settings_between(run: Run, base: Run) -> list[tuple[str, Any, Any]]:
    """The settings in which a run differs from another, interfaces by what acts there: key, value there, value here."""
    here, there = settings_of(run.scene), settings_of(base.scene)
    return [(key, there.get(key), here.get(key)) for key in sorted(here.keys() | there.keys()) if here.get(key) != there.get(key)]


def settings_of(scene: dict[str, Any]) -> dict[str, Any]:
    """What decides on a run, as dotted keys; for each interface the law that acts there, whatever its name."""
    flat = {key: value for key, value in flat_keys(scene).items() if key.split(".")[0] != "interface"}
    names = flat.pop("strata.interfaces", None) or []
    for place, name in enumerate(names, 1):
        for key, value in scene.get("interface", {}).get(name, {"law": name}).items():
            flat[f"{INTERFACE}{place} {key}"] = value
    return flat


def flat_keys(table: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """A nested table as dotted keys, without what does not decide on a run."""
    ignored = ("title", "variant", "variants", "claim", "output", "resolved_from") if not prefix else ()
    flat: dict[str, Any] = {}
    for key, value in table.items():
        if key in ignored:
            continue
        if isinstance(value, dict):
            flat.update(flat_keys(value, f"{prefix}{key}."))
        else:
            flat[prefix + key] = value
    return flat
