"""Messages have colours on a terminal and nowhere else; letter by letter they are the same."""

import re
from pathlib import Path

import pytest

from verification.harness.paths import solver
from verification.tests.cases import strata
from verification.tests.terminal import on_terminal
from verification.tests.test_last_words import BLOCK

WRONG = BLOCK.replace("height_m", "heigth_m").replace("10.0e9", "-10.0e9").replace('"quasistatic"', '"quasistatc"')
COLOUR = re.compile(r"\x1b\[(\d+)m(.*?)\x1b\[0m")
PARTS = {"31": "place", "1": "key", "33": "value", "32": "suggestion"}


def shown(folder: Path, *arguments: str, **environment: str) -> str:
    """What a command leaves on a terminal, the bar of a run being gone."""
    return on_terminal([solver(), *arguments], folder, **environment).replace("\r\n", "\n").rpartition("\r\x1b[K")[2]


def test_an_error_has_its_parts_in_colours(tmp_path: Path) -> None:
    """Place, key, value and suggestion of each line; without colours it is what a pipe gets."""
    (tmp_path / "s.toml").write_text(WRONG)
    arguments = ("check", "s.toml", "none.toml")
    text, plain = shown(tmp_path, *arguments), strata(tmp_path, *arguments).stderr
    assert COLOUR.sub(r"\2", text) == plain and "\x1b" not in plain
    assert [{PARTS[number]: part for number, part in COLOUR.findall(line)} for line in text.splitlines()] == [
        {"place": "s.toml:1:1", "key": "domain.height_m"},
        {"place": "s.toml:1:25", "key": "domain.heigth_m", "suggestion": "height_m"},
        {"place": "s.toml:3:12", "key": "rock.shale.youngs_modulus_Pa", "value": "-10000000000.0"},
        {"place": "s.toml:7:13", "key": "numerics.mechanics", "value": '"quasistatc"', "suggestion": "quasistatic"},
        {"place": "none.toml"}]  # fmt: skip


@pytest.mark.parametrize(("variant", "how"), [([], ("32", "completed")), (["--variant", "mechanism"], ("31", "failed"))])
def test_how_a_run_ended_has_a_colour(variant: list[str], how: tuple[str, str], tmp_path: Path) -> None:
    """Green or red, with no letter changed; --quiet shows nothing of a run that completes, on a terminal either."""
    (tmp_path / "s.toml").write_text(BLOCK)
    text = shown(tmp_path, "run", "s.toml", *variant, "--out", "X")
    assert COLOUR.findall(text)[0] == how and re.search(f"^{how[1]} at step ", COLOUR.sub(r"\2", text), re.MULTILINE)
    assert {part for _, part in COLOUR.findall(text)} <= {how[1], "SUSPECT"}
    assert "\x1b" not in shown(tmp_path, "run", "s.toml", *variant, "--out", "Y", "--quiet")


@pytest.mark.parametrize(("environment", "coloured"), [({}, True), ({"NO_COLOR": "1"}, False), ({"NO_COLOR": ""}, True), ({"TERM": "dumb"}, False)])
def test_who_wants_no_colours_has_none(environment: dict[str, str], coloured: bool, tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(WRONG)
    assert bool(COLOUR.search(shown(tmp_path, "check", "s.toml", **environment))) is coloured
