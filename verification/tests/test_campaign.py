"""Which runs there are: both mechanics, but for variants that only one can run; choices name what exists."""
from __future__ import annotations

from pathlib import Path

import pytest

from verification.harness import choices
from verification.harness.campaign import Campaign, main
from verification.harness.choices import BadChoice, read_points
from verification.harness.paths import EXPERIMENTS
from verification.harness.scenes import MECHANICS, mechanics_of, resolved, scenes_of, variants_of

SCENE = """
[fluid]
law = "paper"
[numerics]
mechanics = "explicit"
cell_m = 1.0
[variants.plain]
[variants.flow]
fluid.law = "reynolds"
[variants.energy]
fracture.crossing = "energy"
[variants.graded]
numerics.far_cell_m = 5.0
[variants.undamped]
numerics.mechanics = "explicit"
"""


@pytest.fixture()
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "exp.toml"
    path.write_text(SCENE)
    return path


@pytest.mark.parametrize(
    "variant, expected",
    [("plain", MECHANICS), ("flow", ("quasistatic",)), ("energy", ("quasistatic",)), ("graded", MECHANICS), ("undamped", ("explicit",))],
)
def test_what_a_variant_can_run_in(scene: Path, variant: str, expected: tuple[str, ...]) -> None:
    assert mechanics_of(scene, variant) == expected


def test_a_variant_replaces_keys_and_keeps_the_rest(scene: Path) -> None:
    assert resolved(scene, "flow")["fluid"] == {"law": "reynolds"}
    assert resolved(scene, "graded")["numerics"] == {"mechanics": "explicit", "cell_m": 1.0, "far_cell_m": 5.0}
    assert "variants" not in resolved(scene, "plain")


def test_the_campaign_runs_both_mechanics_but_what_one_cannot(tmp_path: Path) -> None:
    jobs = Campaign(tmp_path).jobs()
    folders = {str(job.out.relative_to(tmp_path)) for job in jobs}
    assert len(folders) == len(jobs)
    assert {folder.split("/")[0] for folder in folders} == set(MECHANICS)
    assert "quasistatic/exp1_single_interface/reynolds" in folders and "explicit/exp1_single_interface/reynolds" not in folders
    assert "explicit/exp1_single_interface/undamped" in folders and "quasistatic/exp1_single_interface/undamped" not in folders
    assert all(f"numerics.mechanics={job.out.relative_to(tmp_path).parts[0]}" in job.settings for job in jobs)


def test_one_mechanics_and_some_experiments(tmp_path: Path) -> None:
    jobs = Campaign(tmp_path, ("exp3",), ("numerics.cell_m=2",), ("quasistatic",)).jobs()
    assert {job.out.parts[-3:-1] for job in jobs} == {("quasistatic", "exp3_two_interfaces")}
    assert all("numerics.cell_m=2" in job.settings for job in jobs)


def test_the_list_of_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list", "--runs", str(tmp_path), "--only", "exp3", "--mechanics", "explicit"]) == 0
    lines = capsys.readouterr().out.split()
    assert "explicit/exp3_two_interfaces/perfect" in lines and not any(line.startswith("quasistatic") for line in lines)


def test_every_variant_beside_the_study_s_types_belongs_to_a_choice() -> None:
    points = read_points(EXPERIMENTS)
    shown = {(stem, name) for point in points for one in point.choices for stem, pairs in one.runs.items() for name in pairs.values()}
    types = {"perfect", "friction", "weak", "soft", "weak_soft", "soft_weak"}
    declared = {(scene.stem, name) for scene in scenes_of(EXPERIMENTS) for name in variants_of(scene) if name not in types}
    assert declared - shown == set()


@pytest.mark.parametrize("name, variant", [("exp", "nobody"), ("exp9", "plain")])
def test_a_choice_of_something_that_is_not_there_is_refused(scene: Path, name: str, variant: str) -> None:
    path = scene.parent / choices.FILE
    path.parent.mkdir()
    text = "[[point]]\nid = 'a'\nopen = 'b'\ndefault = 'c'\n[[point.choice]]\nid = 'd'\nname = 'e'\n"
    path.write_text(text + f"runs.{name} = {{plain = '{variant}'}}\n")
    with pytest.raises(BadChoice, match="there is no experiment exp9" if name == "exp9" else "nobody"):
        read_points(scene.parent)
