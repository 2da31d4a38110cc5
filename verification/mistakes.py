"""Scenes that must be refused, each made of a sound one by a mistake: verification/invalid/*.toml.

A table is a mistake: `expect`, texts that the solver must say; `scene`, sections in place of the base's with the same heading, others behind the one before
(at the end where none is); `without`, headings of the base that are left out; `base`, the scene of verification/invalid/sound that it is made of (by default
"joint"); `variant`, with which a run meets it.
usage: python3 -m verification.mistakes FOLDER     (writes all scenes there, NAME.toml)
"""

import re
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

FOLDER = Path(__file__).resolve().parent / "invalid"

BASES = {"": ""} | {path.stem: path.read_text(encoding="utf-8") for path in FOLDER.glob("sound/*.toml")}


@dataclass(frozen=True)
class Mistake:
    """A scene's text, what is to be said of it, and the variant with which a run meets that."""

    text: str
    expect: tuple[str, ...]
    variant: str = ""


def sections(text: str) -> list[str]:
    """The parts of a scene, each from its heading on."""
    return [part.strip("\n") for part in re.split(r"^(?=\[)", text, flags=re.MULTILINE) if part.strip()]


def changed(base: str, scene: str, without: list[str]) -> str:
    """A scene with other sections."""
    found = {part.split("\n")[0]: [part] for part in sections(base)}
    found = {heading: parts for heading, parts in found.items() if heading not in without}
    last, own = next(reversed(found), ""), set()
    for part in sections(scene):
        heading = part.split("\n")[0]
        if heading in found and heading not in own:
            last, found[heading] = heading, [part]
        else:
            found.setdefault(last, []).append(part)
        own.add(heading)
    return "\n\n".join(part for parts in found.values() for part in parts) + "\n"


def too_many() -> dict[str, Mistake]:
    """Scenes that are long for their mistake's sake: one rock, and one surface, more than there may be."""
    rocks = "[rock]\nstiff = {youngs_modulus_Pa = 10e9}\n" + "".join(f"r{k} = {{youngs_modulus_Pa = 10e9}}\n" for k in range(1, 256))
    layers = "[strata]\nlayers = [" + 31 * '{rock = "stiff", thickness_m = 2}, ' + '{rock = "stiff"}]\ninterfaces = [' + 31 * '"joint", ' + "]\n"
    return {
        "too_many_rocks": Mistake(changed(BASES["joint"], rocks, ["[rock.stiff]"]), ("there are 256 rocks, more than 255", "Remove those that no layer uses")),
        "too_many_surfaces": Mistake(changed(BASES["joint"], layers, []), (
            "strata.interfaces: 32 surfaces, the fracture and all interfaces that are not perfect, are more than 31", "Make some interfaces perfect")),
    }  # fmt: skip


def mistakes() -> dict[str, Mistake]:
    """All mistakes by their names."""
    found = too_many()
    for path in sorted(FOLDER.glob("*.toml")):
        for name, one in tomllib.loads(path.read_text(encoding="utf-8")).items():
            assert name not in found, f"{path}: {name} is there already"
            text = changed(BASES[one.get("base", "joint")], one.get("scene", ""), one.get("without", []))
            found[name] = Mistake(text, tuple(one["expect"]), one.get("variant", ""))
    return found


if __name__ == "__main__":
    for stem, mistake in mistakes().items():
        Path(sys.argv[1], f"{stem}.toml").write_text(mistake.text, encoding="utf-8")
