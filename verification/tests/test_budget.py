"""The error budget: factors vary one thing alone, effects and totals are what the runs say, failures are shown; and a small real one."""

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from verification.harness.budget import Line, Tried, VARIANTS, budget_of, jobs_of, main, table, totals_of
from verification.harness.factors import Alternative, Factor, factors_of, toml
from verification.harness.load import Run, load
from verification.harness.paths import EXPERIMENTS
from verification.harness.quantities import Effect
from verification.harness.run import Outcome
from verification.harness.scenes import content_of, scenes_of, variants_of
from verification.tests.fake_run import climb, write_run

EXP1, EXP5 = (EXPERIMENTS / f"{name}.toml" for name in ("exp1_single_interface", "exp5_parallel_interface"))

# The only keys that a factor may touch.
KEYS = {
    "mesh": {"numerics.cell_m"}, "mesh_increment": {"numerics.cell_m", "fracture.increment_m"}, "increment": {"fracture.increment_m"},
    "step": {"numerics.flow_change", "numerics.flow_error", "numerics.courant"}, "ring": {"numerics.ring_cells"},
    "particles": {"numerics.particles_per_cell"}, "rate": {"fluid.inlet.rate_Pa_s"},
    "block": {"domain.width_m", "domain.height_m", "fracture.path_m", "strata.layers", "numerics.far_cell_m", "numerics.fine_left_m", "numerics.fine_right_m"},
}  # fmt: skip


def factor(scene: Path, variant: str, id_: str, mechanics: str = "quasistatic") -> Factor:
    """One factor of a variant."""
    return next(one for one in factors_of(content_of(scene, variant), mechanics) if one.id == id_)


@pytest.mark.parametrize("scene", scenes_of(EXPERIMENTS), ids=lambda path: path.stem)
@pytest.mark.parametrize("mechanics", ["explicit", "quasistatic"])
def test_every_factor_varies_its_own_keys_and_something_of_them(scene: Path, mechanics: str) -> None:
    for variant in variants_of(scene)[:4]:
        base = (f"numerics.mechanics={mechanics}", "numerics.far_cell_m=1")  # a budget's runs are on uniform grids
        content = content_of(scene, variant, base)
        factors = factors_of(content, mechanics)
        assert len({one.id for one in factors}) == len(factors)
        for one in factors:
            assert one.alternatives and not one.why_not
            for other in one.alternatives:
                assert {setting.partition("=")[0] for setting in other.settings} <= KEYS[one.id]
                assert content_of(scene, variant, (*base, *other.settings)) != content


def test_a_larger_block_keeps_fracture_and_layers_in_its_middle() -> None:
    for other, width in zip(factor(EXP5, "soft", "block").alternatives, (120.0, 160.0)):
        content = content_of(EXP5, "soft", other.settings)
        assert (content["domain"]["width_m"], content["domain"]["height_m"]) == (width, width)
        assert [x for x, _ in content["fracture"]["path_m"]] == [width / 2.0] * 2
        assert content["strata"]["layers"] == [{"rock": "soft", "thickness_m": width / 2.0 + 5.0}, {"rock": "stiff"}]
        assert content["numerics"]["far_cell_m"] == content["numerics"]["cell_m"]  # a path that turns would meet the coarse cells
    straight = content_of(EXP1, "soft", factor(EXP1, "soft", "block").alternatives[1].settings)
    assert straight["strata"]["layers"] == content_of(EXP1, "soft")["strata"]["layers"]
    assert straight["numerics"]["far_cell_m"] == 4.0


def test_factors_that_do_not_apply_say_why() -> None:
    assert factor(EXP1, "uniform", "step").why_not == "no flow"
    assert factor(EXP1, "uniform", "step", "explicit").alternatives[0].settings == ("numerics.courant=0.25",)
    content = content_of(EXP1, "perfect", ("numerics.particles_per_cell=16", "fluid.inlet.rate_Pa_s=0", "stop.time_s=1", "numerics.far_cell_m=1"))
    why = {one.id: one.why_not for one in factors_of(content, "quasistatic") if not one.alternatives}
    assert set(why) == {"particles", "rate"} and all(why.values())
    assert toml([{"rock": "a", "thickness_m": 1.5}, {"rock": "b"}]) == '[{rock = "a", thickness_m = 1.5}, {rock = "b"}]'
    assert toml([[60.0, 0.0], [60.0, 5.0]]) == "[[60.0, 0.0], [60.0, 5.0]]"


def test_the_base_and_half_the_cells_are_the_runs_of_the_refinement_study(tmp_path: Path) -> None:
    jobs = jobs_of(EXP1, "quasistatic", "soft", factors_of(content_of(EXP1, "soft"), "quasistatic"), (), tmp_path / "b", tmp_path / "r")
    below = tmp_path / "r" / EXP1.stem / "quasistatic" / "soft"
    assert jobs["", ""].out == below / "1m" and jobs["mesh", "half"].out == below / "0.5m"
    rest = [job for key, job in jobs.items() if key[0] not in ("", "mesh")]
    assert len({job.out for job in rest}) == len(rest) and all((tmp_path / "b") in job.out.parents for job in rest)
    keys = [[setting.partition("=")[0] for setting in job.settings] for job in jobs.values()]
    assert all(len(set(own)) == len(own) for own in keys)
    assert "numerics.cell_m=1.0" in jobs["increment", "half"].settings and "fracture.increment_m=0.5" in jobs["increment", "half"].settings


def line(id_: str, group: str, *effects: float | None) -> Line:
    """A factor with an alternative for each effect on the start; None stands for a run that was refused."""
    ran = [Tried(f"{id_}{k}", (), "refused" if one is None else "completed", "", {} if one is None else {"start_Pa": Effect(one)})
           for k, one in enumerate(effects)]  # fmt: skip
    return Line(id_, id_, group, tuple(ran))


def test_totals_by_hand() -> None:
    """3 and -4 of the method: root of squares 5, sum 7; with 12 of the model 13 and 19. What failed is named, not counted as 0."""
    lines = [line("mesh", "numerical", -3.0), line("ring", "numerical", 1.0, -4.0), line("block", "model", 12.0, None),
             line("rate", "model", None), line("mesh_increment", "beside", 100.0)]  # fmt: skip
    totals = totals_of(lines, [("start_Pa", "start", "Pa")])["start_Pa"]
    assert (totals["numerical"].rss, totals["numerical"].sum, totals["numerical"].left_out) == (5.0, 7.0, ())
    assert (totals["all"].rss, totals["all"].sum) == (13.0, 19.0)
    assert totals["all"].left_out == ("block (block1)", "rate (rate0)")
    assert lines[3].size("start_Pa") is None


def made_up(folder: Path, status: int, start_Pa: float, plateau_Pa: float, reason: str = "", **over: float) -> tuple[Outcome, Run | None]:
    """A made-up run with a plateau at the interface, or one that was refused, and how it ended."""
    outcome = Outcome("exp1", "soft", "completed" if status == 0 else "failed", status, reason, 1.0, "k")
    steps = climb(start_Pa=start_Pa, plateaus={10.0: plateau_Pa}, **over)
    return outcome, None if status == 2 else load(write_run(folder, steps, end_Pa=3.2e6, mechanics="quasistatic"))


def test_effects_are_differences_from_the_base_and_failures_are_failures(tmp_path: Path) -> None:
    factors = [Factor("mesh", "mesh", "numerical", (Alternative("half", "half", ()),)),
               Factor("rate", "rate", "model", (Alternative("half", "half", ()), Alternative("double", "double", ())))]  # fmt: skip
    jobs = jobs_of(EXP1, "quasistatic", "soft", factors, (), tmp_path, tmp_path)
    made = {
        ("", ""): made_up(tmp_path / "base", 0, 2.40e6, 0.20e6), ("mesh", "half"): made_up(tmp_path / "mesh", 0, 2.37e6, 0.30e6),
        ("rate", "half"): made_up(tmp_path, 2, 0.0, 0.0, "unknown key"),
        ("rate", "double"): made_up(tmp_path / "rate", 3, 2.44e6, 0.04e6, "a mechanism", to_m=20.0),
    }  # fmt: skip
    found = budget_of(EXP1, "quasistatic", "soft", factors, jobs, made)
    assert [name for name, _, _ in found.quantities] == ["start_Pa", "arrest_1_m", "restart_1_Pa", "pressure_at_40_Pa"]
    mesh, rate = found.lines
    assert mesh.tried[0].effects["start_Pa"].value == pytest.approx(-0.03e6)
    assert mesh.tried[0].effects["restart_1_Pa"].value == pytest.approx(0.07e6)
    assert (rate.tried[0].status, rate.tried[0].effects) == ("refused", {})
    effects = rate.tried[1].effects
    assert effects["pressure_at_40_Pa"].value is None and "does not reach 40 m" in effects["pressure_at_40_Pa"].note
    assert effects["arrest_1_m"].note == "no arrest" and found.totals["start_Pa"]["all"].rss == pytest.approx(0.05e6)
    said = table(found)
    silent = replace(found, lines=(replace(rate, tried=(replace(rate.tried[1], status="completed"),)),))
    assert "does not reach 40 m, at least 3.2e+06 Pa" in table(silent)
    assert "refused: unknown key" in said and "failed: a mechanism" in said and "-30.00 -1.25%" in said
    broken = budget_of(EXP1, "quasistatic", "soft", factors, jobs, {**made, ("", ""): made_up(tmp_path / "mesh", 3, 2.37e6, 0.30e6, "no")})
    assert broken.status == "failed" and "failed: no" in table(broken)


def test_every_experiment_has_its_budget_of_variants_that_exist() -> None:
    assert set(VARIANTS) == {scene.stem for scene in scenes_of(EXPERIMENTS)}
    assert all(set(VARIANTS[scene.stem]) <= set(variants_of(scene)) for scene in scenes_of(EXPERIMENTS))


def test_a_small_budget_from_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Experiment 1 with cells and increments of 2 m up to 13 m: factors in one table; a second call makes no run again."""
    settings = [word for one in ("numerics.cell_m=2.0", "fracture.increment_m=2.0", "stop.tip_y_m=13") for word in ("--set", one)]
    arguments = ["exp1", "--variants", "soft", "--out", str(tmp_path / "b"), "--refined", str(tmp_path / "r"), *settings]
    assert main(arguments) == 0
    found = json.loads((tmp_path / "b" / f"{EXP1.stem}.json").read_text())["budgets"][0]
    assert found["status"] == "completed" and {"start_Pa", "restart_1_Pa", "pressure_at_10_Pa"} <= set(found["base"])
    effects = {(one["id"], k): ran["effects"] for one in found["lines"] for k, ran in enumerate(one["tried"])}
    assert len(effects) == 12 and all(math.isfinite(one["start_Pa"]["value"]) for one in effects.values())
    # The first growth knows nothing of the increment, and a slower ramp starts it at a lower pressure, a faster one at a higher.
    assert effects["increment", 0]["start_Pa"]["value"] == effects["increment", 1]["start_Pa"]["value"] == 0.0
    assert effects["rate", 0]["start_Pa"]["value"] < 0.0 < effects["rate", 1]["start_Pa"]["value"]
    assert abs(effects["mesh", 0]["start_Pa"]["value"]) > 1e4
    capsys.readouterr()
    assert main(arguments) == 0
    assert capsys.readouterr().out.count("done before") == 13
