"""What `cmake --install` makes: a tree that may be moved, with manuals, completion, and a library that another project finds."""

import json
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest

from verification.harness import paths
from verification.harness.paths import EXPERIMENTS, ROOT, solver
from verification.harness.run import claimed
from verification.tests.cases import first_scene, on_terminal, summary_of

TREE = paths.RUNS / "moved tree"
README = TREE / "share/doc/strata/README.md"


@pytest.fixture(scope="module")
def tree() -> Path:
    """The installed tree, moved to another place; made once for all processes."""
    build = solver().parent
    if not (build / "cmake_install.cmake").is_file():
        pytest.skip(f"{solver()} does not lie where it was built")
    with claimed(TREE):
        if not TREE.exists():
            installed = paths.RUNS / "installed"
            subprocess.run(["cmake", "--install", build, "--prefix", installed], check=True, capture_output=True)
            installed.rename(TREE)
    return TREE


def block(document: Path, language: str) -> str:
    """The first block of code of a language in a document."""
    found = re.search(rf"^```{language}\n(.*?)^```", document.read_text(), re.MULTILINE | re.DOTALL)
    assert found
    return found[1]


def run(command: list[str | Path], folder: Path) -> str:
    """What a program says that has to succeed."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr + done.stdout
    return done.stdout


def test_a_moved_tree_is_whole(tree: Path, tmp_path: Path) -> None:
    """The README's scene runs, the experiments and the gallery are read, a reference answers; no file knows a folder of this machine."""
    (tmp_path / "mine.toml").write_text(first_scene(README))
    run([tree / "bin/strata", "run", "mine.toml", "--out", "X", "--quiet"], tmp_path)
    assert summary_of(tmp_path / "X")["status"] == "completed"
    scenes = sorted((tree / "share/strata").glob("*/*.toml"))
    assert {scene.name for scene in scenes} == {scene.name for folder in (EXPERIMENTS, EXPERIMENTS / "gallery") for scene in folder.glob("*.toml")}
    assert len(scenes) > 6 and all(run([tree / "bin/strata", "resolve", scene], tmp_path) for scene in scenes)
    assert '"K_I' in run([tree / "bin/strata-reference", "pressurised_crack"], tmp_path)
    places = [str(place).encode() for place in (ROOT, solver().parent, paths.RUNS)]
    assert not [file for file in tree.rglob("*") if file.is_file() and any(place in file.read_bytes() for place in places)]


def test_manuals_say_what_the_help_says(tree: Path, tmp_path: Path) -> None:
    """Every option and command, and the exit status, as man shows them."""
    for name, sections in (("strata", {"COMMANDS", "EXIT STATUS", "FILES"}), ("strata-reference", {"EXIT STATUS"})):
        page = run(["zcat", tree / f"share/man/man1/{name}.1.gz"], tmp_path).replace("\\-", "-").replace("\\fB", "").replace("\\fR", "")
        told = run([tree / "bin" / name, "--help-all" if name == "strata" else "--help"], tmp_path)
        options, commands = set(re.findall(r"(?<= |,)--[a-z-]+", told)), re.findall(r"^([a-z]+)$", told, re.MULTILINE)
        assert len(options) > 1 and not [word for word in options if word not in page]
        assert re.findall(r"^\.SS ([a-z]+)$", page, re.MULTILINE) == commands and {*re.findall(r'^\.SH "?([A-Z ]+)', page, re.MULTILINE)} >= sections


@pytest.fixture()
def shell(tree: Path, tmp_path: Path) -> Path:
    """A folder with a scene, a log and a run, and the commands that set up completion there."""
    (tmp_path / "mine.toml").write_text(first_scene(README) + "[interface.bedding]\nlaw = 'soft'\n")
    (tmp_path / "well.csv").touch()
    (tmp_path / "done").mkdir()
    (tmp_path / "rc").write_text(f"PATH={shlex.quote(str(tree / 'bin'))}:$PATH\nPS1='$ '\n. {shlex.quote(str(tree / 'share/bash-completion/completions/strata'))}\n")
    return tmp_path


def offered(folder: Path, line: str) -> set[str]:
    """What completion offers at the end of a line."""
    code = f". ./rc; COMP_LINE={shlex.quote(line)}; COMP_POINT=${{#COMP_LINE}}; _strata {line.split()[0]}; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    return {word for word in run(["bash", "--norc", "-c", code], folder).split("\n") if word}


def test_completion_offers_what_there_is(tree: Path, shell: Path) -> None:
    """Commands and options of the help, variants and files, keys with the scene's names, words of keys, solutions and their inputs."""
    commands = {*re.findall(r"^  ([a-z]+) ", run([tree / "bin/strata", "--help"], shell).partition("Subcommands:")[2], re.MULTILINE)}
    assert offered(shell, "strata ") == commands and "new" in commands
    for command in commands:
        said = run([tree / "bin/strata", command, "--help"], shell)
        assert offered(shell, f"strata {command} --") == {*re.findall(r"^  (?:-h,)?(--[a-z-]+)", said, re.MULTILINE)}
    keys = offered(shell, "strata run mine.toml --set ")
    listed = {key for key in re.findall(r"^\| `([^`]+)`", run([tree / "bin/strata", "keys"], shell), re.MULTILINE) if "[" not in key}
    assert keys == {key.replace("rock.NAME", "rock.shale").replace("interface.NAME", "interface.bedding") + "=" for key in listed}
    known = json.loads(run([tree / "bin/strata-reference"], shell))
    for line, words in {
        "strata run ": {"mine.toml", "done"}, "strata resume ": {"done"}, "strata log ": {"well.csv", "done"}, "strata run mine.toml --out ": {"done"},
        "strata run mine.toml --variant ": {"stronger"}, "strata new ": set(), "strata run mine.toml --threads ": set(),
        "strata run mine.toml --set numerics.mechanics=": {"explicit", "quasistatic"}, "strata run mine.toml --set domain.top=f": {"fixed"},
        "strata run mine.toml --set numerics.cell_m=": set(), "strata-reference kgd_v": {"kgd_viscosity"},
        "strata-reference bonded_normal --set ": {f"{key}=" for key in next(one for one in known if one["name"] == "bonded_normal")["inputs"]},
    }.items():  # fmt: skip
        assert offered(shell, line) == words, line


def test_completion_works_in_a_shell(shell: Path) -> None:
    """Typed on a terminal, with the tab key: a key, no space behind it, its word, and then a variant."""
    shown = on_terminal(["bash", "--noprofile", "--rcfile", "rc", "-i"], shell, [
        ("strata res", "strata res"), ("o\t", "olve "), ("mi\t", "mine.toml "), ("--set numerics.mech\t", "anics="), ("q\t", "uasistatic "), ("--var\t", "iant "), ("s\t", "tronger "),
        ("| grep -c 'sqrt_m = 2000000'\n", "1\r\n"), ("exit\n", "exit")], INPUTRC="/dev/null")  # fmt: skip
    assert "strata resolve mine.toml --set numerics.mechanics=quasistatic --variant stronger" in shown


@pytest.mark.skipif(shutil.which("zsh") is None, reason="zsh is not installed (ci/setup --test)")
def test_completion_works_in_zsh(tree: Path, shell: Path) -> None:
    """The same in zsh, and a folder, behind which its contents may follow; what was completed resolves to both settings."""
    rc = f"PATH={shlex.quote(str(tree / 'bin'))}:$PATH; fpath=({shlex.quote(str(tree / 'share/zsh/vendor-completions'))} $fpath); autoload -Uz compinit; compinit -u -D; PS1='$ '"
    (shell / "rc.zsh").write_text(rc)
    shown = on_terminal(["zsh", "-f", "-i"], shell, [
        (". ./rc.zsh\n", "$ "), ("strata res", "res"), ("o\t", "olve"), ("mi\t", "mine.toml"), ("--set numerics.mech\t", "anics="), ("q\t", "uasistatic"), ("--var\t", "iant"),
        ("s\t", "tronger"), ("| grep -cE 'sqrt_m = 2000000|= \"quasistatic\"'\n", "2\r\n"), ("strata resume d\t", "one/"), ("\x15exit\n", "exit")], TERM="dumb")  # fmt: skip
    assert shown.index("anics=") < shown.index("uasistatic") < shown.index("tronger") < shown.index("2\r\n") < shown.index("one/")


def test_another_project_finds_the_library(tree: Path, tmp_path: Path) -> None:
    """The program of solver/README.md, built against the tree: by linear elasticity the net pressure at the start is proportional to the toughness."""
    for name, language in (("start.cpp", "cpp"), ("CMakeLists.txt", "cmake")):
        (tmp_path / name).write_text(block(ROOT / "solver" / "README.md", language))
    (tmp_path / "mine.toml").write_text(first_scene(README))
    run(["cmake", "-G", "Ninja", "-S", ".", "-B", "build", f"-DCMAKE_PREFIX_PATH={tree}"], tmp_path)
    run(["cmake", "--build", "build"], tmp_path)
    found = [tuple(map(float, line.split())) for line in run(["build/start", "mine.toml"], tmp_path).splitlines()]
    net_Pa = [inlet - 2e6 for _, inlet in found]
    assert [toughness for toughness, _ in found] == [1.0e6, 1.5e6, 2.0e6] and net_Pa[0] > 1e5
    assert net_Pa[1] / net_Pa[0] == pytest.approx(1.5, rel=1e-6) and net_Pa[2] / net_Pa[0] == pytest.approx(2.0, rel=1e-6)
    (tmp_path / "mine.toml").write_text(first_scene(README).replace("width_m = 20", "width_m = -20"))
    refused = subprocess.run(["build/start", "mine.toml"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert refused.returncode == 2 and "width_m = -20 is outside (0, inf)" in refused.stderr
