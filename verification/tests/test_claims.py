"""Verdicts: each claim of the experiments can be reproduced and can fail; what is missing is not judged. Observables of made-up runs whose answers are known, and
of mutations of them that must be told apart; run folders are read as the contract has them, and what is missing is named."""

import json
import math
import shutil
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from verification.harness.claims import (
    NOT_EVALUATED, NOT_REPRODUCED, ONLY_UNDER_A_VARIANT, REPRODUCED, Choice, Runs, case_of, claims_of, evaluate, evaluate_all, evaluate_each,
    read_claims, record_finer, write_claims,
)  # fmt: skip
from verification.harness.load import LoadError, Run, frames, load
from verification.harness.observables import failed_length_m, measure
from verification.harness.paths import EXPERIMENTS
from verification.tests.fake_run import Step, changed, climb, write_run

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


APPROX = {"rel": 1e-6, "abs": 1e-9}


def bent(degrees: float) -> list[Step]:
    """A path of 30 m that leaves the vertical by an angle (clockwise positive) at 5 m."""
    angle = math.radians(degrees)
    return [(2.4 * MPA + s, 40.0 + s * math.sin(angle), 5.0 + s * math.cos(angle)) for s in range(1, 31)]


FAILS, HOLDS = [(2.0 * MPA, 0.0), (2.4 * MPA, 1.0), (2.5 * MPA, 4.0)], [(2.0 * MPA, 0.0)]
HIGHER = '[{rock = "stiff", thickness_m = 15.0}, {rock = "stiff", thickness_m = 65.0}]'
RUNS: dict[str, tuple[list[Step], dict[str, Any]]] = {
    "plain": (climb(), {}), "late": (climb(2.40 * MPA), {}), "never": ([], {"end_Pa": 4.0 * MPA}), "to_4_MPa": (climb(to_m=10.0), {"end_Pa": 4.0 * MPA}),
    "low": (climb(to_m=7.0), {}), "stuck": (climb(to_m=12.0), {}), "half": (climb(to_m=14.0), {}), "half_late": (climb(2.40 * MPA, to_m=14.0), {}),
    "higher": (climb(to_m=14.0), {"layers": HIGHER}), "straight": (climb(to_m=35.0), {}), "right": (bent(30.0), {}), "left": (bent(-30.0), {}),
    "fails": (climb(), {"friction_J": 65.0, "failed_m": FAILS}), "holds": (climb(), {"failed_m": HOLDS}), "brief": (climb(), {"end_Pa": 2.7 * MPA}),
    **{f"{rise:g}_at_{height:g}": (climb(plateaus={height: rise * MPA}), {})
       for height, rise in ((9.0, 0.2), (10.0, 0.2), (11.0, 0.2), (14.0, 0.2), (8.0, 0.2), (15.0, 0.2), (10.0, 0.02), (10.0, 0.195), (10.0, 0.095), (15.0, 0.07))},
    **{f"arrest_{height:g}": (climb(plateaus={height: 0.1 * MPA}), {"end_Pa": 2.8 * MPA}) for height in (7.0, 20.0)},
}  # fmt: skip


def made_up(folder: Path, name: str) -> Run:
    steps, options = RUNS[name]
    return load(write_run(folder / "exp" / name, steps, **options))


AT, TO_30, ABOVE = {"interface": 1}, {"from_m": 6, "to_m": 30}, {"height_m": {"interface": 1, "plus_m": 2}}
NEAR_PA = 2.36 * MPA + 3 * 5.0e3  # the tip is at 9 m, the first step within 1.5 increments of the interface


@pytest.mark.parametrize(("name", "parameters", "run", "against", "expected"), [
    ("start_Pa", {}, "late", None, 2.40 * MPA), ("start_shift_Pa", {}, "late", "plain", 0.04 * MPA), ("start_shift_Pa", {}, "plain", "late", -0.04 * MPA),
    ("start_shift_Pa", {}, "never", "plain", (1.64 * MPA, math.inf)),
    *(("plateau_Pa", AT, f"0.2_at_{height}", None, 0.205 * MPA) for height in (9, 10, 11, 14)),
    *(("plateau_Pa", AT, run, None, 0.0) for run in ("0.2_at_8", "0.2_at_15", "0.02_at_10")),  # elsewhere, or less than an arrest
    ("plateau_Pa", AT, "to_4_MPa", None, (1.62 * MPA, math.inf)), ("plateau_Pa", AT, "low", None, None),  # without end; out of reach
    ("plateau_ratio", AT, "0.195_at_10", "0.095_at_10", 2.0), ("plateau_ratio", AT, "plain", "0.195_at_10", 0.0),
    ("pressure_shift_Pa", TO_30, "plain", "plain", 0.0), ("pressure_shift_Pa", TO_30, "0.07_at_15", "plain", 0.07 * MPA),
    ("pressure_shift_Pa", TO_30, "plain", "0.07_at_15", 0.07 * MPA), ("pressure_shift_Pa", {"from_m": 6, "to_m": 15}, "0.07_at_15", "plain", 0.0),
    ("pressure_shift_Pa", TO_30, "stuck", "plain", (3.0 * MPA - (2.36 * MPA + 7 * 5.0e3), math.inf)),
    ("height_ratio", {"height_m": 60}, "stuck", "plain", 0.2), ("height_ratio", {"height_m": 60}, "plain", "plain", 1.0),
    ("height_ratio", {"height_m": 60}, "plain", "stuck", None),
    ("pressure_at_height_difference_Pa", {"height_m": 22}, "stuck", "plain", (3.0 * MPA - 2.44 * MPA, math.inf)),
    ("pressure_at_height_difference_Pa", ABOVE, "half_late", "half", 0.04 * MPA), ("pressure_at_height_difference_Pa", ABOVE, "higher", "half", (-math.inf, math.inf)),  # 17 m
    ("arrests", {"from_m": 8}, "brief", None, 0.0), ("arrests", {"from_m": 8}, "arrest_20", None, 1.0), ("arrests", {"from_m": 8}, "arrest_7", None, 0.0),
    ("lateral_deflection_m", {}, "right", None, 15.0), ("lateral_deflection_m", {}, "left", None, -15.0),
    ("final_angle_deg", {}, "right", None, 60.0), ("final_angle_deg", {}, "left", None, 60.0),
    ("path_change", {}, "right", "right", 0.0), ("path_change", {}, "right", "straight", None),
    ("interface_failure_excess_Pa", AT, "fails", None, 2.5 * MPA - NEAR_PA),
    ("interface_energy_difference_J", {"height_m": 22}, "fails", "holds", 17.0), ("interface_energy_difference_J", {"height_m": 22}, "holds", "fails", -17.0),
    ("final_height_m", {}, "half", None, 14.0), ("final_height_m", {"above_interface": 1}, "half", None, 4.0),
    ("final_height_m", {"above_interface": 1}, "higher", None, -1.0),
])  # fmt: skip
def test_what_is_known_of_made_up_runs(
    tmp_path: Path, name: str, parameters: dict[str, Any], run: str, against: str | None, expected: float | tuple[float, float] | None
) -> None:
    """A number, the bounds that a run leaves which ended first, or none."""
    found = measure(name, parameters, made_up(tmp_path, run), made_up(tmp_path, against) if against else None)
    if isinstance(expected, tuple):
        assert (found.low, found.high) == pytest.approx(expected, **APPROX)
    else:
        assert found.value == (expected if expected is None else pytest.approx(expected, **APPROX)) and (expected is None or found.exact)


@pytest.mark.parametrize(("name", "parameters", "run", "against", "at_least", "at_most", "expected"), [
    ("plateau_Pa", AT, "to_4_MPa", None, 0.05 * MPA, None, True), ("plateau_Pa", AT, "to_4_MPa", None, None, 2.0 * MPA, None),  # it may be longer
    ("plateau_Pa", AT, "to_4_MPa", None, 2.0 * MPA, None, None), ("plateau_Pa", AT, "plain", None, 0.05 * MPA, None, False),
    ("plateau_Pa", AT, "to_4_MPa", None, None, 1.0 * MPA, False), ("plateau_Pa", AT, "low", None, None, 1.0, None),
    ("plateau_ratio", AT, "0.195_at_10", "plain", 0.5, 2.0, False), ("plateau_ratio", AT, "plain", "plain", 0.5, 2.0, None),  # nothing to compare
    ("arrests", {"from_m": 8}, "never", None, None, 0, None), ("interface_failure_excess_Pa", AT, "holds", None, None, 0.1 * MPA, False),
])  # fmt: skip
def test_what_a_bound_says_of_a_range(
    tmp_path: Path, name: str, parameters: dict[str, Any], run: str, against: str | None, at_least: float | None, at_most: float | None, expected: bool | None
) -> None:
    found = measure(name, parameters, made_up(tmp_path, run), made_up(tmp_path, against) if against else None)
    assert found.holds(at_least, at_most) is expected


def test_paths_at_an_angle_to_each_other(tmp_path: Path) -> None:
    """At 60 degrees: at s from the kink s sin 60 apart, and the other one s sin 30 off its first direction."""
    assert measure("path_change", {}, made_up(tmp_path, "right"), made_up(tmp_path, "left")).value == pytest.approx(math.sqrt(3.0), rel=0.02)


def test_a_failed_length_counts_each_place_by_the_way_to_its_neighbours() -> None:
    """On a graded grid places are unlike: two of 0.5 m and one of 1.25 m, whatever their order."""
    x, split = np.array([0.25, 0.75, 1.25, 2.25, 3.75]), np.array([1, 1, 0, 1, 0])
    for order in (np.arange(5), np.array([3, 0, 4, 2, 1])):
        assert failed_length_m({"0/x_m": x[order], "0/split": split[order]}, 1) == pytest.approx(2.25)
    assert failed_length_m({"0/x_m": x[:1], "0/split": split[:1]}, 1) == 0.0


def test_a_plateau_is_flagged_where_J_decided_it(tmp_path: Path) -> None:
    assert all(measure("plateau_Pa", AT, made_up(tmp_path, f"0.2_at_{height}"), None).flags == ("J at interface",) for height in (9, 10, 11, 14))
    folder = write_run(tmp_path / "exp" / "weak", climb(plateaus={10.0: 0.2 * MPA}), mechanics="quasistatic")
    assert measure("plateau_Pa", AT, load(folder), None).flags == ()
    events = load(folder).summary.raw["events"]
    for by, expected in (("energy", ()), ("J", ("J at interface",))):
        changed(folder, events=[event | {"by": by, "at_interface": True} for event in events])
        assert measure("plateau_Pa", AT, load(folder), None).flags == expected


MARK = {"monitor": "energy_closure", "value": 0.02, "threshold": 0.01, "why": "it stayed open"}


def held_run(tmp_path: Path, to_m: float = 20.0, **options: Any) -> Path:
    return write_run(tmp_path / "exp" / "weak", climb(to_m=to_m, plateaus={10.0: 0.1e6}), **options)


def test_a_whole_folder_is_read(tmp_path: Path) -> None:
    run = load(held_run(tmp_path, failed_m=[(2.0e6, 0.0), (2.4e6, 3.0)]))
    assert [event.kind for event in run.summary.events] == ["start", "arrest", "restart", "arrest", "stop"]
    assert run.interfaces_m == [10.0] and run.summary.suspect == ()
    assert run.path.shape == (17, 2) and run.path[-1].tolist() == [40.0, 20.0]
    assert math.isnan(run.summary.tips[0].K_II_Pa_sqrt_m), "null stands for a number that is not finite"
    times, arrays = zip(*frames(run, "interfaces"))
    assert times == pytest.approx([0.0, 0.4e6 / 0.35e6]) and np.sum(arrays[1]["0/split"]) == 6


@pytest.mark.parametrize("name", ["scene.toml", "summary.json", "history.csv"])
def test_a_missing_file_is_named(tmp_path: Path, name: str) -> None:
    (held_run(tmp_path) / name).unlink()
    with pytest.raises(LoadError, match=name):
        load(tmp_path / "exp" / "weak")


@pytest.mark.parametrize(("change", "why"), [
    *(({key: None}, key) for key in ("events", "inlet_Pa", "tips", "energy")),
    ({"suspect": [{key: value for key, value in MARK.items() if key != "why"}]}, "no key why"),
])  # fmt: skip
def test_a_missing_key_is_named(tmp_path: Path, change: dict[str, Any], why: str) -> None:
    with pytest.raises(LoadError, match=why):
        load(changed(held_run(tmp_path), **change))


def test_a_torn_history_is_named_with_its_line(tmp_path: Path) -> None:
    folder = held_run(tmp_path, 7.0)
    with (folder / "history.csv").open("a") as stream:
        stream.write("1.0,2.0\n")
    with pytest.raises(LoadError, match="history.csv:6"):
        load(folder)


def test_what_a_quasistatic_run_adds_is_optional(tmp_path: Path) -> None:
    folder = held_run(tmp_path, mechanics="quasistatic")
    plain = load(folder).summary
    assert math.isnan(plain.tips[0].G_N_m) and plain.monitors == {}
    raw = plain.raw
    raw["events"][1] |= {"by": "energy", "at_interface": False}
    raw["events"][2] |= {"by": "J", "at_interface": True}
    summary = load(changed(folder, tips=[raw["tips"][0] | {"G_N_m": 205.0}], events=raw["events"], monitors={"mirror": True})).summary
    assert summary.tips[0].G_N_m == 205.0 and summary.monitors["mirror"] is True
    assert [(event.by, event.at_interface) for event in summary.events[1:3]] == [("energy", False), ("J", True)]


def test_marks_of_a_run_are_read(tmp_path: Path) -> None:
    """A mark's value may be null, which stands for no finite number."""
    first, second = load(changed(held_run(tmp_path), suspect=[MARK, MARK | {"monitor": "momentum", "value": None}])).summary.suspect
    assert (first.monitor, first.value, first.threshold, first.why) == tuple(MARK.values())
    assert second.monitor == "momentum" and math.isnan(second.value)
