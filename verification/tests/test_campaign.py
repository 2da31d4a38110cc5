"""Which runs there are: both mechanics, but for variants that only one can run; choices name what exists."""

import os
import signal
import threading
from pathlib import Path

import pytest

from verification.harness import campaign as campaigns
from verification.harness import choices, store
from verification.harness.campaign import jobs_of, main
from verification.harness.choices import read_points
from verification.harness.paths import EXPERIMENTS
from verification.harness.run import Outcome, expected_s, load_outcome
from verification.harness.scenes import MECHANICS, STUDY_VARIANTS, content_of, mechanics_of, scene_of, scenes_of, variants_of
from verification.tests.cases import wait_for
from verification.tests.fake_run import climb, program, write_run

SCENE = """
fluid.law = "paper"
numerics = {mechanics = "explicit", cell_m = 1.0}
[variants]
plain = {}
flow.fluid.law = "reynolds"
energy.fracture.growth = "energy"
graded.numerics.far_cell_m = 5.0
undamped.numerics.mechanics = "explicit"
"""


@pytest.fixture()
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "exp.toml"
    path.write_text(SCENE)
    return path


def test_what_a_variant_can_run_in(scene: Path) -> None:
    one = {"flow": ("quasistatic",), "energy": ("quasistatic",), "undamped": ("explicit",)}
    assert {variant: mechanics_of(scene, variant) for variant in variants_of(scene)} == {"plain": MECHANICS, "graded": MECHANICS, **one}


def test_keys_are_those_that_a_run_has() -> None:
    """Defaults, a variant's and settings in place; what the solver refuses is an error with its words."""
    content = content_of(scene_of("exp1"), "uniform_soft", ("numerics.cell_m=2", "fracture.increment_m=3"))
    assert content["fluid"]["law"] == "uniform" and content["strata"]["interfaces"] == ["soft"] and content["numerics"]["courant"] == 0.5
    assert (content["numerics"]["cell_m"], content["fracture"]["increment_m"]) == (2.0, 3.0) and "variants" not in content
    with pytest.raises(ValueError, match="there is no variant nobody"):
        content_of(scene_of("exp1"), "nobody")


def test_the_campaign_runs_both_mechanics_but_what_one_cannot(tmp_path: Path) -> None:
    jobs = jobs_of(tmp_path, scenes_of(EXPERIMENTS))
    folders = {str(job.out.relative_to(tmp_path)) for job in jobs}
    assert len(folders) == len(jobs) and {folder.split("/")[0] for folder in folders} == set(MECHANICS)
    assert "quasistatic/exp1_single_interface/reynolds" in folders and "explicit/exp1_single_interface/reynolds" not in folders
    assert "explicit/exp1_single_interface/undamped" in folders and "quasistatic/exp1_single_interface/undamped" not in folders
    assert all(f"numerics.mechanics={job.out.relative_to(tmp_path).parts[0]}" in job.settings for job in jobs)
    some = jobs_of(tmp_path, [scene_of("exp3")], ("numerics.cell_m=2",), ("quasistatic",))
    assert {job.out.parts[-3:-1] for job in some} == {("quasistatic", "exp3_two_interfaces")}
    assert all("numerics.cell_m=2" in job.settings for job in some)


def test_the_list_of_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--list", "--runs", str(tmp_path), "--only", "exp3", "--mechanics", "explicit"]) == 0
    lines = capsys.readouterr().out.split()
    assert "explicit/exp3_two_interfaces/perfect" in lines and not any(line.startswith("quasistatic") for line in lines)


# Stands for the solver: as long as its variant says, then done, failed, or, of the variant `stuck`, never.
SOLVER = """#!/bin/sh
[ "$1" = run ] || exit 1
while [ $# -gt 0 ]; do case "$1" in --out) out=$2;; --variant) variant=$2;; esac; shift; done
echo "$variant" >> "$(dirname "$0")/calls"
case "$variant" in
  friction) echo '{"reason": "the block is a mechanism"}' > "$out/summary.json"; exit 3;;
  stuck) trap 'exit 130' INT; touch "$(dirname "$0")/stuck"; while :; do sleep 0.01; done;;
esac
cp "$(dirname "$0")"/made/exp/run/* "$out"
"""


@pytest.fixture()
def campaign(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder for a campaign of a scene of four variants with a program in the solver's place."""
    (tmp_path / "experiments").mkdir()
    text = (EXPERIMENTS / "exp1_single_interface.toml").read_text().partition("[variants.")[0]
    (tmp_path / "experiments" / "exp.toml").write_text(text + "".join(f"[variants.{name}]\n" for name in ("perfect", "friction", "weak")))
    write_run(tmp_path / "solver" / "made" / "exp" / "run", climb())
    monkeypatch.setenv("STRATA", str(program(tmp_path / "solver" / "strata", SOLVER)))
    page = tmp_path / "page.py"
    page.write_text("import sys\nfrom pathlib import Path\nPath(sys.argv[-1]).mkdir(exist_ok=True)\n(Path(sys.argv[-1]) / 'index.html').touch()\n")
    monkeypatch.setattr(campaigns, "PAGE", page)
    return tmp_path


def calls(campaign: Path) -> list[str]:
    """The variants that were run."""
    return (campaign / "solver" / "calls").read_text().split()


def make(campaign: Path) -> int:
    """The campaign with inertia, from the command line."""
    folders = [word for name in ("experiments", "runs", "out") for word in (f"--{name}", str(campaign / name))]
    return main([*folders, "--mechanics", "explicit", "--jobs", "2"])


def test_a_run_that_fails_is_told_and_the_others_go_on(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Exit status 3 with the reason, all others made, the page written; a second call makes nothing and says the same."""
    assert make(campaign) == 3
    said = capsys.readouterr().out
    assert "3 runs to make, 0 done before" in said and "[3/3]" in said and "explicit/exp/weak: starts at 2.360 MPa, tip at 70.0 m at 3.000 MPa" in said
    assert said.count("failed: explicit/exp/friction: the block is a mechanism") == 1
    assert (campaign / "out" / "index.html").is_file() and (campaign / "runs" / "claims.json").is_file()
    assert sorted(calls(campaign)) == ["friction", "perfect", "weak"]
    assert make(campaign) == 3
    said = capsys.readouterr().out
    assert "0 runs to make, 3 done before" in said and "failed: explicit/exp/friction" in said and len(calls(campaign)) == 3


def test_a_folder_that_is_no_run_s_fails_that_run_alone(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = campaign / "runs" / "explicit" / "exp" / "weak"
    folder.mkdir(parents=True)
    (folder / "thesis.tex").write_text("years of work")
    assert make(campaign) == 3
    said = capsys.readouterr().out
    assert "failed: explicit/exp/weak" in said and "holds files but no run" in said and "[3/3]" in said
    assert (folder / "thesis.tex").exists()


def test_an_interrupt_ends_the_campaign_and_a_second_call_goes_on(campaign: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """By a signal to the process, as of a terminal or of `kill`: status 130, no process left, what is done is not run again."""
    scene = campaign / "experiments" / "exp.toml"
    scene.write_text(scene.read_text().replace("variants.friction", "variants.stuck"))
    threading.Thread(target=lambda: (wait_for(campaign / "solver" / "stuck"), os.kill(os.getpid(), signal.SIGTERM))).start()
    with pytest.raises(SystemExit) as how:
        make(campaign)
    assert how.value.code == 130 and "interrupted" in capfd.readouterr().out
    assert load_outcome(campaign / "runs" / "explicit" / "exp" / "stuck").exit_status == 130  # type: ignore[union-attr]
    assert not (campaign / "out" / "index.html").exists()
    ended = {name: load_outcome(campaign / "runs" / "explicit" / "exp" / name) for name in ("perfect", "weak")}
    left, before = {name for name, outcome in ended.items() if outcome is None or not outcome.ok}, len(calls(campaign))
    scene.write_text(scene.read_text().replace("variants.stuck", "variants.other"))
    assert make(campaign) == 0
    assert sorted(calls(campaign)[before:]) == sorted({*left, "other"})


def test_what_takes_longest_is_known_before_anything_was_run(tmp_path: Path) -> None:
    """By the scene's cells and mechanics; by the last time where there is one."""
    coarse, fine = (jobs_of(tmp_path, [scene_of("exp1")], (f"numerics.cell_m={cell}",), ("explicit",))[0] for cell in (2, 1))
    assert expected_s(fine) > 3.0 * expected_s(coarse) > 0.0
    fine.out.mkdir(parents=True)
    store.write(Outcome("exp1", "", "completed", 0, "", 12.5, "key"), fine.out / "outcome.json")
    assert expected_s(fine) == 12.5


def test_every_variant_beside_the_study_s_types_belongs_to_a_choice() -> None:
    every = [one for point in read_points(EXPERIMENTS) for one in point.choices]
    shown = {(stem, name) for one in every for stem, pairs in one.runs.items() for name in pairs.values()}
    assert {(scene.stem, name) for scene in scenes_of(EXPERIMENTS) for name in variants_of(scene) if name not in STUDY_VARIANTS} <= shown


@pytest.mark.parametrize("name, variant", [("exp", "nobody"), ("exp9", "plain")])
def test_a_choice_of_something_that_is_not_there_is_refused(scene: Path, name: str, variant: str) -> None:
    path = scene.parent / choices.FILE
    path.parent.mkdir()
    text = "[[point]]\nid = 'a'\nopen = 'b'\ndefault = 'c'\n[[point.choice]]\nid = 'd'\nname = 'e'\n"
    path.write_text(text + f"runs.{name} = {{plain = '{variant}'}}\n")
    with pytest.raises(ValueError, match="there is no experiment exp9" if name == "exp9" else "nobody"):
        read_points(scene.parent)
