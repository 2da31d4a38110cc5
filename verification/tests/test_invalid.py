"""Scenes that must be refused: with status 2, all that their head expects on stderr, and nothing written."""

import re
from pathlib import Path

import pytest

from verification.tests.cases import strata

FOLDER = Path(__file__).resolve().parents[1] / "invalid"
SCENES = sorted(FOLDER.glob("*.toml"))


def head_lines(scene: Path, word: str) -> list[str]:
    """The texts behind `# word: ` at the head of a scene."""
    prefix = f"# {word}: "
    return [line[len(prefix):] for line in scene.read_text().splitlines() if line.startswith(prefix)]


def test_folder_is_not_empty() -> None:
    """At least as many mistakes are covered as there were when this was written."""
    assert len(SCENES) >= 160


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.stem)
def test_check_says_what_is_wrong(scene: Path, tmp_path: Path) -> None:
    """`check` ends with 2 and says, for every expected text, a line with the file's name that holds it."""
    expected = head_lines(scene, "expect")
    assert expected, "a scene in verification/invalid begins with # expect:"
    done = strata(tmp_path, "check", str(scene))
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    for text in expected:
        assert text in done.stderr
    for line in done.stderr.splitlines():
        assert re.match(re.escape(str(scene)) + r":\d+:\d+: \S", line), f"no place in: {line}"


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.stem)
def test_run_writes_nothing(scene: Path, tmp_path: Path) -> None:
    """`run` ends with 2 and leaves no folder behind; a mistake that only a variant makes is met with that variant."""
    variant = head_lines(scene, "variant")
    chosen = ["--variant", variant[0]] if variant else []
    done = strata(tmp_path, "run", str(scene), *chosen, "--out", "X")
    assert done.returncode == 2, done.stderr
    for text in head_lines(scene, "expect"):
        assert text in done.stderr or text.startswith("[variant")
    assert list(tmp_path.iterdir()) == []


GOOD = """\
[domain]
width_m = 8
height_m = 8
[rock.stiff]
youngs_modulus_Pa = 10e9
[strata]
layers = [{rock = "stiff"}]
[numerics]
cell_m = 1
[stop]
time_s = 1
[variants.fine]
numerics.cell_m = 0.5
[variants.coarse]
numerics.cell_m = 2
"""


def test_good_scene_is_accepted(tmp_path: Path) -> None:
    """What differs from the scenes above is not refused for another reason: a good scene passes in silence."""
    (tmp_path / "good.toml").write_text(GOOD)
    done = strata(tmp_path, "check", "good.toml")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_errors_of_all_files(tmp_path: Path) -> None:
    """`check` goes on to the next file after a bad one, and after one that is not there."""
    (tmp_path / "good.toml").write_text(GOOD)
    (tmp_path / "one.toml").write_text(GOOD.replace("width_m = 8", "width_m = -8"))
    (tmp_path / "two.toml").write_text(GOOD.replace("height_m", "heigth_m"))
    done = strata(tmp_path, "check", "one.toml", "good.toml", "none.toml", "two.toml")
    assert done.returncode == 2
    assert "one.toml:2:1: domain.width_m = -8 is outside (0, inf)" in done.stderr
    assert "none.toml: there is no such file" in done.stderr
    assert "two.toml:3:1: unknown key domain.heigth_m. Did you mean height_m?" in done.stderr


def test_variants_prints_names_alone(tmp_path: Path) -> None:
    """`variants` prints the names in the order of the file, one a line."""
    (tmp_path / "good.toml").write_text(GOOD)
    done = strata(tmp_path, "variants", "good.toml")
    assert (done.returncode, done.stdout) == (0, "fine\ncoarse\n")
    done = strata(tmp_path, "variants", "none.toml")
    assert (done.returncode, done.stdout) == (2, "")


def test_resolve_prints_what_a_run_writes(tmp_path: Path) -> None:
    """`resolve` prints the scene.toml of the run with the same variant and settings, and nothing else; no folder appears."""
    (tmp_path / "good.toml").write_text(GOOD)
    chosen = ["good.toml", "--variant", "fine", "--set", "stop.time_s=1e-4", "--set", "numerics.damping_1_s=3"]
    done = strata(tmp_path, "resolve", *chosen)
    assert (done.returncode, done.stderr) == (0, "")
    assert [path.name for path in tmp_path.iterdir()] == ["good.toml"]
    assert "cell_m = 0.5\n" in done.stdout and "damping_1_s = 3.0\n" in done.stdout and "time_s = 0.0001\n" in done.stdout
    assert strata(tmp_path, "run", *chosen, "--out", "X", "--quiet").returncode == 0
    assert (tmp_path / "X" / "scene.toml").read_text() == done.stdout


def test_resolve_says_all_that_is_wrong(tmp_path: Path) -> None:
    """`resolve` of bad input ends with 2 and all errors, and prints no scene."""
    (tmp_path / "bad.toml").write_text(GOOD.replace("width_m = 8", "width_m = -8").replace("height_m", "heigth_m"))
    done = strata(tmp_path, "resolve", "bad.toml", "--set", "numerics.shape=gmp")
    assert (done.returncode, done.stdout) == (2, "")
    assert "width_m = -8 is outside (0, inf)" in done.stderr and "Did you mean height_m?" in done.stderr
    assert '--set numerics.shape=gmp: numerics.shape = "gmp" is not allowed' in done.stderr


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["--variant", "fin"], "good.toml: there is no variant fin. It has fine, coarse. Did you mean fine?"),
        (["--set", "numerics.courant=3"], "--set numerics.courant=3: numerics.courant = 3 is outside (0, 2]"),
        (["--set", "numerics.shape=gmp"], '--set numerics.shape=gmp: numerics.shape = "gmp" is not allowed'),
        (["--set", "numerics.cel_m=2"], "--set numerics.cel_m=2: unknown key numerics.cel_m. Did you mean cell_m?"),
        (["--set", "numerics.cell_m"], "--set numerics.cell_m: this is not key.path=value"),
        (["--set", "rock.stiff.youngs_modulus_Pa=10,0e9"], "Write 10.0e9: the decimal sign is a point."),
        (["--set", "rock.stiff.youngs_modulus_Pa=10 GPa"], "Write 10e9: the unit, Pa, stands in the key."),
        (["--set", "strata.interfaces=[weak]"], "[weak] is neither TOML nor a bare word"),
        (["--set", "numerics.cell_m=3"], "--set numerics.cell_m=3: numerics.cell_m = 3.0 does not divide the block"),
        (["--threads", "-1"], "threads"),
        (["--thread", "1"], "--thread"),
    ],
)
def test_bad_arguments(arguments: list[str], expected: str, tmp_path: Path) -> None:
    """A bad argument of `run` is bad input: status 2, the argument is named, nothing is written."""
    (tmp_path / "good.toml").write_text(GOOD)
    done = strata(tmp_path, "run", "good.toml", *arguments, "--out", "X")
    assert done.returncode == 2
    assert expected in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["good.toml"]


def test_resume_without_a_run(tmp_path: Path) -> None:
    """`resume` of a folder that holds no run is bad input."""
    done = strata(tmp_path, "resume", "nowhere")
    assert done.returncode == 2
    assert "nowhere: this is not the folder of a run" in done.stderr


def test_keys_are_listed(tmp_path: Path) -> None:
    """`keys` prints a Markdown table with every key's default."""
    done = strata(tmp_path, "keys")
    assert done.returncode == 0
    assert "| `rock.NAME.poisson_ratio` |  | 0.2 | [0, 0.5) |" in done.stdout


ENDLESS = "q" * 100_000


@pytest.mark.parametrize(
    ("text", "arguments"),
    [
        (f"{ENDLESS} = 1\n" + GOOD, []),
        (GOOD.replace("10e9", ENDLESS), []),
        (GOOD.replace("10e9", "1" * 100_000), []),
        (GOOD.replace('"stiff"', f'"{ENDLESS}"'), []),
        (GOOD.replace("rock.stiff", f"rock.{ENDLESS}"), []),
        (GOOD.replace("width_m = 8", '"' + "a b " * 25_000 + '" = 8'), []),
        (GOOD + "a" + ".a" * 100_000 + " = 1\n", []),
        (GOOD + "[a" + ".a" * 100_000 + "]\n", []),
        (GOOD + "x = " + "[" * 100_000 + "\n", []),
        (GOOD, ["--variant", ENDLESS]),
        (GOOD, ["--set", ENDLESS]),
        (GOOD, ["--set", f"{ENDLESS}=1"]),
        (GOOD, ["--set", f"numerics.cell_m={ENDLESS}"]),
        (GOOD, ["--out", ENDLESS]),
        (GOOD, ["--threads", ENDLESS]),
        (GOOD, [ENDLESS]),
    ],
    ids=range(16),
)
def test_no_message_is_endless(text: str, arguments: list[str], tmp_path: Path) -> None:
    """Whatever is endless is refused with status 2 and lines of less than 2100 characters that a person can read."""
    (tmp_path / "s.toml").write_text(text)
    done = strata(tmp_path, "run", "s.toml", "--out", "X", *arguments) if "--out" not in arguments else strata(tmp_path, "run", "s.toml", *arguments)
    assert done.returncode == 2, done.stderr[:3000]
    assert 0 < len(done.stderr) < 10_000
    assert all(len(line) < 2100 for line in done.stderr.splitlines())
    assert "a bug" not in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["s.toml"]


def test_resume_of_an_endless_name(tmp_path: Path) -> None:
    """A name that no system takes is bad input, no bug."""
    done = strata(tmp_path, "resume", ENDLESS)
    assert done.returncode == 2 and "this is not the folder of a run" in done.stderr and len(done.stderr) < 2100
