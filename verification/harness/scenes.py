"""What scene files say before anything runs: variants, their keys with settings in place, and the mechanics each can run in."""

import subprocess
import tomllib
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from verification.harness.paths import EXPERIMENTS, solver

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


def scene_of(name: str) -> Path:
    """The scene of an experiment by the beginning of its name, or a scene file; raises ValueError where that is not one."""
    if name.endswith(".toml"):
        if not Path(name).is_file():
            raise ValueError(f"there is no file {name}")
        return Path(name).resolve()
    found = [path for path in scenes_of(EXPERIMENTS) if path.stem.startswith(name)]
    if len(found) != 1:
        names = ", ".join(path.stem for path in (found or scenes_of(EXPERIMENTS)))
        raise ValueError(f"{'several experiments begin' if found else 'no experiment begins'} with {name}: {names}")
    return found[0]


def variants_of(scene: Path) -> list[str]:
    """The names of a scene's variants, in its order."""
    return list(read_scene(scene).get("variants", {}))


def chosen(scene: Path, names: str) -> list[str]:
    """The variants named (with commas between), else the study's own, else the base scene; raises ValueError for unknown names."""
    known = variants_of(scene)
    wanted = [name for name in names.split(",") if name] or [name for name in known if name in STUDY_VARIANTS] or [""]
    unknown = [name for name in wanted if name and name not in known]
    if unknown:
        raise ValueError(f"{scene.stem} has no variant {', '.join(unknown)}; there are {', '.join(known)}")
    return wanted


@lru_cache(maxsize=None)
def _resolved(program: Path, scene: Path, variant: str, settings: tuple[str, ...], _: tuple[int, ...]) -> dict[str, Any]:
    """What the solver makes of a scene; the last argument is the times of change of both files."""
    words = [str(program), "resolve", str(scene), *(["--variant", variant] if variant else []), *(word for one in settings for word in ("--set", one))]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise ValueError(done.stderr.strip() or f"{program} cannot resolve {scene}")
    return tomllib.loads(done.stdout)


def content_of(scene: Path, variant: str, settings: Sequence[str] = ()) -> dict[str, Any]:
    """The keys of a scene as a run with this variant and settings has them, defaults included. Do not change it: it is shared. Raises ValueError for
    what the solver refuses."""
    times = tuple(path.stat().st_mtime_ns for path in (solver(), scene))
    return _resolved(solver(), scene, variant, tuple(settings), times)


def mechanics_of(scene: Path, variant: str) -> tuple[str, ...]:
    """The mechanics that a variant can run in: the one it names itself or that its keys need, else both."""
    base = read_scene(scene)
    own = base.get("variants", {}).get(variant, {})
    named = own.get("numerics", {}).get("mechanics")
    if any(own.get(table, {}).get(key, base.get(table, {}).get(key)) == value for table, key, value in QUASISTATIC_ONLY):
        named = "quasistatic"
    return (str(named),) if named else MECHANICS
