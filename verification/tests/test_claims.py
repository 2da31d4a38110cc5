"""Verdicts: each claim of the experiments can be reproduced and can fail; what is missing is not judged."""

import json
import shutil
import tomllib
from pathlib import Path
from typing import Any

import pytest

from verification.harness.choices import Choice
from verification.harness.claim_data import NOT_EVALUATED, NOT_REPRODUCED, ONLY_UNDER_A_VARIANT, REPRODUCED, read_claims, write_claims
from verification.harness.claims import Runs, case_of, claims_of, evaluate, evaluate_all, evaluate_each, record_finer
from verification.harness.paths import EXPERIMENTS
from verification.tests.fake_run import changed, climb, write_run

MPA = 1.0e6
SCENES = sorted(EXPERIMENTS.glob("*.toml"))
STUDY = {1: "abcd", 2: "abc", 3: "abc", 4: "abc", 5: "ab", 6: "ab"}

CLAIM: dict[str, Any] = {
    "id": "x", "text": "a plateau", "why": "made up", "observable": "plateau_Pa",
    "case": [{"variant": "weak", "interface": 1, "at_least": 0.05 * MPA, "at_most": 0.30 * MPA}],
}  # fmt: skip


def write(tmp_path: Path, variant: str, plateau_MPa: float, **options: Any) -> None:
    """A run of the experiment 'exp' with a plateau at the interface."""
    write_run(tmp_path / "exp" / variant, climb(plateaus={10.0: plateau_MPa * MPA} if plateau_MPa else {}), **options)


def written(tmp_path: Path, **plateaus_MPa: float) -> None:
    """Runs of some variants."""
    for variant, plateau in plateaus_MPa.items():
        write(tmp_path, variant, plateau)


@pytest.mark.parametrize("plateau, verdict", [(0.2, REPRODUCED), (0.0, NOT_REPRODUCED), (0.4, NOT_REPRODUCED), (-0.2, NOT_REPRODUCED)])
def test_right_zero_twice_and_flipped(tmp_path: Path, plateau: float, verdict: str) -> None:
    write(tmp_path, "weak", plateau)
    result = evaluate(CLAIM, "exp", Runs(tmp_path))
    assert result.verdict == verdict
    assert result.flags == (("J at interface",) if plateau > 0 else ())


@pytest.mark.parametrize("own, other, verdict, flag", [(0.0, 0.2, ONLY_UNDER_A_VARIANT, ()), (0.2, 0.0, REPRODUCED, ("does not hold under: another",))])
def test_a_reading_rescues_what_does_not_hold_and_flags_what_does(tmp_path: Path, own: float, other: float, verdict: str, flag: tuple[str, ...]) -> None:
    write(tmp_path, "weak", own)
    write(tmp_path, "other", other)
    reading = {"name": "another", "case": [{"variant": "other", "interface": 1, "at_least": 0.05 * MPA}]}
    result = evaluate({**CLAIM, "reading": [reading]}, "exp", Runs(tmp_path))
    assert result.verdict == verdict and result.flags[1:] == flag
    assert [one.name for one in result.readings if one.holds] == ["another"] * (other > 0.0)


def test_a_claim_that_rests_on_a_suspect_run_says_so(tmp_path: Path) -> None:
    write(tmp_path, "weak", 0.2)
    changed(tmp_path / "exp" / "weak", suspect=[{"monitor": "momentum", "value": 1.0, "threshold": 1e-8, "why": "it drifted"}])
    result = evaluate(CLAIM, "exp", Runs(tmp_path))
    assert result.verdict == REPRODUCED and result.flags == ("J at interface", "suspect run exp/weak: it drifted")


def test_missing_and_failed_runs_are_not_judged(tmp_path: Path) -> None:
    assert evaluate(CLAIM, "exp", Runs(tmp_path)).verdict == NOT_EVALUATED
    write(tmp_path, "weak", 0.2, status="failed")
    result = evaluate(CLAIM, "exp", Runs(tmp_path))
    assert result.verdict == NOT_EVALUATED and "made to fail" in result.cases[0].note


def test_a_bound_that_leaves_it_open_is_flagged(tmp_path: Path) -> None:
    write_run(tmp_path / "exp" / "weak", climb(to_m=10.0), end_Pa=2.5 * MPA)
    result = evaluate(CLAIM, "exp", Runs(tmp_path))
    assert result.verdict == NOT_REPRODUCED
    assert "undecided: a run ended before it could show this" in result.flags and "bound only" in result.flags


@pytest.mark.parametrize("case", [
    {"observable": "plateau", "at_least": 1}, {"observable": "plateau_Pa"}, {"observable": "plateau_ratio", "at_least": 1},
    {"observable": "plateau_Pa", "against": "perfect", "at_least": 1},
])  # fmt: skip
def test_cases_that_could_not_fail_are_refused(case: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="^here: "):
        case_of({"variant": "weak", **case}, "plateau_Pa", "here")


def test_every_claim_of_the_study_is_there_once() -> None:
    ids = [claim["id"] for scene in SCENES for claim in claims_of(scene)]
    assert ids == [f"{number}{letter}" for number, letters in STUDY.items() for letter in letters]


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.stem)
def test_claims_name_variants_that_exist(scene: Path) -> None:
    names = {path.stem: set(tomllib.loads(path.read_text())["variants"]) for path in SCENES}
    for claim in claims_of(scene):
        for case in [*claim["case"], *(case for reading in claim.get("reading", []) for case in reading["case"])]:
            case_of(case, claim["observable"], scene.stem)
            assert case["variant"] in names[scene.stem]
            assert case.get("against", "perfect") in names[case.get("against_scene", scene.stem)]


def test_all_claims_without_runs_as_json(tmp_path: Path) -> None:
    results = evaluate_all(EXPERIMENTS, tmp_path)
    write_claims(results, tmp_path / "claims.json")
    content = json.loads((tmp_path / "claims.json").read_text())["claims"]
    assert {claim["verdict"] for claim in content} == {NOT_EVALUATED}
    assert all(case["meaning"] and "value" in case for claim in content for case in claim["cases"])


TWO = '[{rock = "stiff", thickness_m = 10.0}, {rock = "stiff", thickness_m = 10.0}, {rock = "stiff", thickness_m = 60.0}]'


def write_study(tmp_path: Path) -> None:
    """Made-up runs of Experiments 1 and 3 that do what the study says."""
    one, three = tmp_path / "exp1_single_interface", tmp_path / "exp3_two_interfaces"
    failed = [(2.0 * MPA, 0.0), (2.40 * MPA, 6.0)]
    write_run(one / "perfect", climb())
    write_run(one / "friction", climb(2.37 * MPA))
    write_run(one / "weak", climb(plateaus={10.0: 0.2 * MPA}), friction_J=10.0, failed_m=failed)
    write_run(one / "soft", climb(plateaus={10.0: 0.18 * MPA}), friction_J=10.0)
    write_run(three / "perfect", climb(), layers=TWO)
    write_run(three / "weak_soft", climb(to_m=24.0, plateaus={10.0: 0.4 * MPA, 20.0: 0.5 * MPA}), end_Pa=4 * MPA, layers=TWO, friction_J=90.0)
    write_run(three / "soft_weak", climb(to_m=24.0, plateaus={10.0: 0.3 * MPA}), end_Pa=4 * MPA, layers=TWO, friction_J=90.0)


WEAK_SOFT, SOFT_WEAK = "exp3_two_interfaces/weak_soft", "exp3_two_interfaces/soft_weak"


@pytest.mark.parametrize(("runs", "claims", "verdict"), [
    ({}, ["1a", "1b", "1c", "1d", "3a", "3b", "3c"], REPRODUCED),
    ({"exp1_single_interface/friction": climb(2.5 * MPA)}, ["1a"], NOT_REPRODUCED),
    ({"exp1_single_interface/weak": climb()}, ["1b", "1c", "1d"], NOT_REPRODUCED), ({"exp1_single_interface/soft": climb()}, ["1b", "1d"], NOT_REPRODUCED),
    ({"exp1_single_interface/soft": climb(plateaus={10.0: 0.4 * MPA})}, ["1d"], NOT_REPRODUCED),
    ({WEAK_SOFT: climb(), SOFT_WEAK: climb()}, ["3a", "3b", "3c"], NOT_REPRODUCED),  # nothing is held up
    ({WEAK_SOFT: SOFT_WEAK, SOFT_WEAK: WEAK_SOFT}, ["3b"], NOT_REPRODUCED),  # the order is swapped
])  # fmt: skip
def test_claims_are_reproduced_where_runs_do_as_the_study_says(tmp_path: Path, runs: dict[str, Any], claims: list[str], verdict: str) -> None:
    write_study(tmp_path / "study")
    shutil.copytree(tmp_path / "study", tmp_path / "runs")
    for place, instead in runs.items():
        if isinstance(instead, str):
            shutil.copytree(tmp_path / "study" / instead, tmp_path / "runs" / place, dirs_exist_ok=True)
        else:
            write_run(tmp_path / "runs" / place, instead, **({"layers": TWO} if "exp3" in place else {}))
    found = {result.id: result.verdict for result in evaluate_all(EXPERIMENTS, tmp_path / "runs")}
    assert {id: found[id] for id in claims} == dict.fromkeys(claims, verdict)


def test_claims_come_back_from_json_as_they_were(tmp_path: Path) -> None:
    write_study(tmp_path)
    results = evaluate_all(EXPERIMENTS, tmp_path)
    write_claims(results, tmp_path / "claims.json")
    assert read_claims(tmp_path / "claims.json") == results
    (tmp_path / "claims.json").write_text('{"claims": [{"id": "1a"}]}')
    with pytest.raises(ValueError, match="claims.json"):
        read_claims(tmp_path / "claims.json")


OTHER = Choice("c", "unit: another", "another", {"exp": {"weak": "other", "soft": "soft"}})
TWICE: dict[str, Any] = {**CLAIM, "case": [*CLAIM["case"], {"variant": "soft", "interface": 1, "at_least": 0.05 * MPA}]}


@pytest.fixture()
def scenes(tmp_path: Path) -> Path:
    """A folder with a scene 'exp' of four variants, one of which only quasi-static runs can do."""
    folder = tmp_path / "scenes"
    folder.mkdir()
    (folder / "exp.toml").write_text('[variants.weak]\n[variants.soft]\n[variants.other]\n[variants.flow]\nfluid.law = "reynolds"\n')
    return folder


def test_a_choice_puts_its_variants_in_place_of_those_named(tmp_path: Path, scenes: Path) -> None:
    written(tmp_path, weak=0.2, soft=0.2, other=0.0)
    result = evaluate(TWICE, "exp", Runs(tmp_path), [OTHER], scenes)
    (reading,) = result.readings
    assert [case.variant for case in reading.cases] == ["other", "soft"]
    assert (reading.choice, reading.name, reading.holds, reading.complete) == ("c", "unit: another", False, True)
    assert result.verdict == REPRODUCED and "does not hold under: unit: another" in result.flags
    write(tmp_path, "other", 0.2)
    assert evaluate(TWICE, "exp", Runs(tmp_path), [OTHER], scenes).readings[0].holds is True


def test_a_choice_without_runs_for_all_cases_cannot_rescue_a_claim(tmp_path: Path, scenes: Path) -> None:
    written(tmp_path, weak=0.0, soft=0.2, other=0.2)
    assert evaluate(TWICE, "exp", Runs(tmp_path), [OTHER], scenes).verdict == ONLY_UNDER_A_VARIANT
    part = Choice("c", "unit: another", "another", {"exp": {"weak": "other"}})
    result = evaluate(TWICE, "exp", Runs(tmp_path), [part], scenes)
    assert (result.verdict, result.readings[0].holds, result.readings[0].complete) == (NOT_REPRODUCED, True, False)


@pytest.mark.parametrize(("other", "mechanics", "readings"), [("weak", "explicit", 0), ("flow", "explicit", 0), ("flow", "quasistatic", 1)])
def test_a_choice_that_changes_nothing_or_cannot_be_run_is_no_reading(tmp_path: Path, scenes: Path, other: str, mechanics: str, readings: int) -> None:
    choice = Choice("c", "unit: another", "another", {"exp": {"weak": other}})
    assert len(evaluate(CLAIM, "exp", Runs(tmp_path, mechanics), [choice], scenes).readings) == readings


def test_a_reading_written_for_a_choice_stands_for_it(tmp_path: Path, scenes: Path) -> None:
    written(tmp_path, weak=0.0, other=0.2)
    own = {"choice": "c", "case": [{"variant": "other", "interface": 1, "at_least": 0.3 * MPA}]}
    (reading,) = evaluate({**CLAIM, "reading": [own]}, "exp", Runs(tmp_path), [OTHER], scenes).readings
    assert reading.holds is False and reading.name == "unit: another"
    with pytest.raises(ValueError, match="no choice d"):
        evaluate({**CLAIM, "reading": [{**own, "choice": "d"}]}, "exp", Runs(tmp_path), [OTHER], scenes)


def test_cells_of_half_the_size_have_verdicts_of_their_own_run_or_recorded(tmp_path: Path) -> None:
    folder, runs = tmp_path / "scenes", tmp_path / "runs"
    folder.mkdir()
    case = "{variant = 'weak', interface = 1, at_least = 5e4}"
    (folder / "exp.toml").write_text(f"[variants.weak]\n[[claim]]\nid = 'x'\ntext = 't'\nwhy = 'w'\nobservable = 'plateau_Pa'\ncase = [{case}]\n")
    write(runs / "quasistatic", "weak", 0.0, mechanics="quasistatic")
    write(runs / "set" / "0.5m" / "quasistatic", "weak", 0.2, mechanics="quasistatic")
    at_1_m, at_half = evaluate_each(folder, runs)
    write(runs / "explicit", "weak", 0.2)
    both = [(result.mechanics, result.flags) for result in evaluate_each(folder, runs)[:2]]
    assert both == [("explicit", ("J at interface",)), ("quasistatic", ())]
    shutil.rmtree(runs / "explicit")
    assert (at_1_m.verdict, at_half.verdict, at_half.mechanics) == (NOT_REPRODUCED, REPRODUCED, "quasistatic 0.5 m")
    record_finer(folder, runs)
    shutil.rmtree(runs / "set")
    _, recorded = evaluate_each(folder, runs)
    assert (recorded.verdict, recorded.cases) == (at_half.verdict, at_half.cases)
    assert recorded.flags[0].startswith("recorded by strata")
