"""What scene files say before anything runs: variants, their resolved keys, and the mechanics each can run in."""
from __future__ import annotations

import tomllib
from functools import lru_cache
from pathlib import Path
from typing import Any

# The two models of the rock, in the order in which they are run and shown.
MECHANICS: tuple[str, ...] = ("explicit", "quasistatic")

# The interface types of the study itself, as variants; two unlike interfaces are named from below.
STUDY_VARIANTS: tuple[str, ...] = ("perfect", "friction", "weak", "soft", "weak_soft", "soft_weak")

# Keys with values, as (table, key, value), that only quasi-static runs have.
QUASISTATIC_ONLY = (("fluid", "law", "reynolds"), ("fracture", "growth", "energy"), ("fracture", "order", "larger_margin"))


@lru_cache(maxsize=None)
def _read(path: Path, _: int) -> dict[str, Any]:
    """A scene file's content; the second argument is its time of change."""
    return tomllib.loads(path.read_text(encoding="utf-8"))


def read_scene(path: Path) -> dict[str, Any]:
    """A scene file's content. Do not change it: it is shared."""
    return _read(path, path.stat().st_mtime_ns)


def scenes_of(folder: Path) -> list[Path]:
    """The scene files of a folder."""
    return sorted(folder.glob("*.toml"))


def variants_of(scene: Path) -> list[str]:
    """The names of a scene's variants, in its order."""
    return list(read_scene(scene).get("variants", {}))


def merged(base: dict[str, Any], over: dict[str, Any]) -> dict[str, Any]:
    """A table with the keys of another in place of its own, table by table."""
    both = dict(base)
    for key, value in over.items():
        inner = base.get(key)
        both[key] = merged(inner, value) if isinstance(value, dict) and isinstance(inner, dict) else value
    return both


def resolved(scene: Path, variant: str) -> dict[str, Any]:
    """A scene with the keys of one of its variants in place, without variants and claims."""
    content = read_scene(scene)
    base = {key: value for key, value in content.items() if key not in ("variants", "claim")}
    return merged(base, content.get("variants", {}).get(variant, {}))


def mechanics_of(scene: Path, variant: str) -> tuple[str, ...]:
    """The mechanics that a variant can run in: the one it names itself or that its keys need, else both."""
    named = read_scene(scene).get("variants", {}).get(variant, {}).get("numerics", {}).get("mechanics")
    content = resolved(scene, variant)
    if any(content.get(table, {}).get(key) == value for table, key, value in QUASISTATIC_ONLY):
        named = "quasistatic"
    return (str(named),) if named else MECHANICS
