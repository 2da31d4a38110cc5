"""Every command says how it is used, and refuses what it cannot do with status 2 and a word on what there is."""

from collections.abc import Callable
from pathlib import Path

import pytest

from verification.ablation.__main__ import ablate, budget
from verification.benchmarks.__main__ import main as bench
from verification.crossing_map.__main__ import main as crossing
from verification.faults.__main__ import main as kill
from verification.harness import campaign, claims, front_table, refine, smoke, sweep
from verification.ladder.__main__ import main as verify
from verification.measured.__main__ import main as beside
from verification.precision.__main__ import main as chart
from verification.stability.__main__ import main as atlas

COMMANDS: dict[str, Callable[[list[str]], int]] = {
    "ablate": ablate, "accept": smoke.main, "atlas": atlas, "beside": beside, "bench": bench, "budget": budget, "chart": chart, "claims": claims.main,
    "crossing_map": crossing, "front_table": front_table.main, "kill": kill, "refine": refine.main, "reproduce": campaign.main, "sweep": sweep.main, "verify": verify,
}  # fmt: skip


def ended(name: str, *arguments: str) -> int:
    """The exit status of a command."""
    try:
        return COMMANDS[name](list(arguments))
    except SystemExit as how:
        return int(how.code or 0)


@pytest.mark.parametrize("name", COMMANDS)
def test_it_says_how_it_is_used(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert ended(name, "--help") == 0
    said = capsys.readouterr().out
    assert said.startswith("usage: ") and len(said.splitlines()) > 5
    assert ended(name, "--no-such-option") == 2


@pytest.mark.parametrize(("name", "arguments", "said"), [
    ("ablate", ["exp9"], "no experiment begins with exp9"), ("ablate", ["exp1", "--ingredients", "flaw"], "no flaw to change; there are"),
    ("ablate", ["exp1", "--variants", "soft", "--set", "numerics.cell_m=3.0"], "does not divide the block"),
    ("budget", ["exp1", "--factors", "mash"], "no mash to change; there are"), ("budget", ["exp1", "--variants", "week"], "has no variant week"),
    ("refine", ["exp"], "several experiments"), ("refine", ["exp9"], "no experiment begins"), ("refine", ["no.toml"], "there is no file"),
    ("refine", ["exp1", "--cells", "1,x"], "--cells 1,x"), ("refine", ["exp1", "--cells", "1,-2"], "sizes are positive"),
    ("refine", ["exp1", "--variants", "week"], "has no variant week"), ("refine", ["exp1", "--variants", "undamped"], "runs in quasistatic"),
    ("reproduce", ["--only", "exp9"], "no experiment begins with exp9; there are"),
    ("verify", ["--family", "craks"], "no family craks; there are"), ("verify", ["--case", "nobody"], "no case nobody"), ("verify", ["--jobs", "0"], "--jobs 0"),
    ("atlas", ["--family", "nobody"], "no family nobody; there are"), ("atlas", ["--smoke", "--accept", "--family", "rings"], "without --smoke"),
    ("chart", ["--only", "blok"], "no problem blok; there are block"), ("chart", ["--methods", "qx"], "no method qx; there are"),
    ("crossing_map", ["--family", "nobody"], "no map nobody; there are"), ("crossing_map", ["--size", "1"], "--size 1 is below 2"),
    ("sweep", ["no.toml"], "no.toml"), ("sweep", [str(Path(__file__).with_name("sweep.toml")), "--observe", "json:dumpz"], "--observe json:dumpz"),
    ("bench", ["--only", "("], "ci/bench: "), ("bench", ["--quick", "--record"], "--quick goes with neither"),
])  # fmt: skip
def test_what_it_cannot_do_is_refused_by_name(name: str, arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert ended(name, *arguments) == 2
    assert said in capsys.readouterr().err
