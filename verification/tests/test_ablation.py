"""What scenes need, and what their numbers owe to what: each change does what its name says and that alone, effects and totals are what the runs say,
failures are shown, every table is explained.

Mutations that were tried by hand and failed here: pressures not net of the closing stress; the sign of the added closing stress, in the
history and in events; the fold left out; a lost arrest taken for no effect; the verdict turned round; an interface counted from 0; the
lowest layer of a mirrored block as thick as it was, its interfaces not mirrored; shares that are NaN let pass; what costs nothing taken
for what wants a reason; ingredients without need that want none.
"""

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from verification.ablation.__main__ import BUDGETED, EVERYTHING, budget
from verification.ablation.changes import Change, View, factors_of, ingredients_of, mirrored, named, toml
from verification.ablation.table import (
    CHANGES, NEEDED, NOTHING, SPARED, NoBase, Table, Tried, effects_of, left_out, read_all, reasons, table_of, varied, words, write,
)  # fmt: skip
from verification.harness.load import Run, load
from verification.harness.paths import EXPERIMENTS
from verification.harness.quantities import Effect, quantities_of
from verification.harness.refine import REFINE_RUNS
from verification.harness.run import Job, Made, Outcome, make_all
from verification.harness.scenes import content_of, scenes_of, variants_of
from verification.tests.fake_run import climb, write_run

EXP1, EXP5 = (EXPERIMENTS / f"{name}.toml" for name in ("exp1_single_interface", "exp5_parallel_interface"))
SHORT = ("stop.tip_y_m=11.0", "stop.inlet_Pa=2.7e6")

# The only keys that a factor may touch.
KEYS = {
    "mesh": {"numerics.cell_m"}, "mesh and increment": {"numerics.cell_m", "fracture.increment_m"}, "increment": {"fracture.increment_m"},
    "flow step": {"numerics.flow_change", "numerics.flow_error"}, "time step": {"numerics.courant"}, "J ring": {"numerics.ring_cells"},
    "particles": {"numerics.particles_per_cell"}, "loading rate": {"fluid.inlet.rate_Pa_s"},
    "block": {"domain.width_m", "domain.height_m", "fracture.path_m", "strata.layers", "numerics.far_cell_m", "numerics.fine_left_m", "numerics.fine_right_m"},
}  # fmt: skip


def line(share: float | None, cpu_s: float = 0.5, lost: bool = False, status: str = "completed") -> Tried:
    """A line with one effect."""
    effects = {"start_Pa": Effect(None, "does not start")} if lost else {}
    shares = {} if share is None else {"pressure_Pa": share}
    return Tried("flow", "flow", "none", (), status, "", effects | {name: Effect(1.0) for name in shares}, shares, cpu_s)


@pytest.mark.parametrize("scene", scenes_of(EXPERIMENTS), ids=lambda path: path.stem[:4])
def test_every_experiment_has_its_ingredients(scene: Path) -> None:
    """Every ingredient either applies, with settings, or says why it does not."""
    for variant in ("soft", "weak_soft", "perfect"):
        if variant == ("soft" if scene.stem.startswith("exp3") else "weak_soft"):
            continue
        found = ingredients_of(content_of(scene, variant, ()))
        assert len({one.id for one in found}) == len(found)
        for one in found:
            assert bool(one.settings) != bool(one.why_not), one
        acting = [one.id for one in found if one.id.startswith("interface_")]
        both = ["interface_1", "interface_2"]
        assert acting == {"soft": both if scene.stem.startswith("exp4") else both[:1], "weak_soft": both, "perfect": []}[variant]


def test_layers_are_mirrored() -> None:
    """The lowest layer becomes one of twice its thickness, the others stand on both sides of it, interfaces too."""
    strata = {"layers": [{"rock": "a", "thickness_m": 10}, {"rock": "b", "thickness_m": 15}, {"rock": "c"}], "interfaces": ["weak", "soft"]}
    both = mirrored(strata, 80.0)
    assert [(one["rock"], float(one["thickness_m"])) for one in both["strata.layers"]] == [
        ("c", 55.0), ("b", 15.0), ("a", 20.0), ("b", 15.0), ("c", 55.0)]  # fmt: skip
    assert both["strata.interfaces"] == ["soft", "weak", "weak", "soft"]


def test_fine_cells_are_mirrored() -> None:
    """Where fine cells end above the symmetry line they end as far below it; a scene without such an end gets none."""
    for name, ends in (("exp6_stress_reversal", ("numerics.fine_top_m=112.0", "numerics.fine_bottom_m=48.0")), ("exp5_parallel_interface", ())):
        content = content_of(EXPERIMENTS / f"{name}.toml", "perfect", ())
        both = next(one for one in ingredients_of(content) if one.id == "symmetry")
        assert tuple(key for key in both.settings if ".fine_" in key) == ends


def run_of(folder: Path, steps: list[tuple[float, float, float]], closing_Pa: float = 2.0e6) -> Run:
    """A run made up from its growth steps (inlet pressure, x, y), under a closing stress."""
    run = load(write_run(folder, steps, end_Pa=steps[-1][0] + 1e4))
    return replace(run, scene={**run.scene, "in_situ": {"horizontal_Pa": closing_Pa}})


def test_a_mirrored_net_run_is_read_as_one_of_the_scene(tmp_path: Path) -> None:
    """Heights count from the fold on either side, pressures get the closing stress back."""
    base = run_of(tmp_path / "base", [(2.4e6, 40.0, 6.0), (2.5e6, 40.0, 7.0)])
    run = run_of(tmp_path / "run", [(0.4e6, 40.0, 86.0), (0.5e6, 40.0, 73.0)])
    seen = View(add_Pa=2.0e6, fold_m=80.0).of(run, base)
    assert list(seen.history["tip_y_m"][1:]) == [6.0, 7.0, 7.0]
    assert list(seen.history["inlet_Pa"][1:]) == pytest.approx([2.4e6, 2.5e6, 2.51e6])
    assert [(event.tip_y_m, event.inlet_Pa) for event in seen.summary.events][0] == (6.0, 2.4e6)
    assert seen.summary.inlet_Pa == pytest.approx(2.51e6) and seen.scene == base.scene
    assert View().of(run, base) is run


def test_effects_are_shares_of_the_net_pressure(tmp_path: Path) -> None:
    """A start at 2.4 MPa is 0.4 MPa above the closing stress: 4 kPa more are 1 %, 8 less 2 %; the same is no effect."""
    base = run_of(tmp_path / "base", [(2.4e6, 40.0, 6.0)])
    start = [one for one in quantities_of(base.scene, ()) if one.name == "start_Pa"]

    def effect(start_Pa: float) -> tuple[float, float]:
        effects, shares = effects_of(start, False, base, run_of(tmp_path / f"{start_Pa}", [(start_Pa, 40.0, 6.0)]))
        value = effects["start_Pa"].value
        assert value is not None
        return value, shares["start_Pa"]

    assert effect(2.404e6) == pytest.approx((4e3, 0.01))
    assert effect(2.392e6) == pytest.approx((-8e3, 0.02))
    assert effect(2.4e6) == (0.0, 0.0)


def test_an_arrest_that_is_not_there_is_lost(tmp_path: Path) -> None:
    """A run that passes the interface without a pause has no restart pressure to compare: something else happens."""
    held = run_of(tmp_path / "held", climb(plateaus={10.0: 0.2e6}))
    free_of_it = run_of(tmp_path / "free", climb())
    restart = [one for one in quantities_of(held.scene, ()) if one.name == "restart_1_Pa"]
    effects, shares = effects_of(restart, False, held, free_of_it)
    assert effects["restart_1_Pa"].value is None and shares == {}
    assert effects_of(restart, False, held, held)[1] == {"restart_1_Pa": 0.0}


def test_verdicts() -> None:
    """1 % is needed, less is not, a lost arrest changes what happens, a failed run says nothing."""
    assert line(0.0101).verdict == NEEDED and line(0.0099).verdict == SPARED
    assert line(0.0001, lost=True).verdict == CHANGES
    assert line(0.5, status="failed").verdict == NOTHING and line(None).verdict == NOTHING
    lines = (line(0.5), line(0.001, cpu_s=0.5), line(0.001, cpu_s=1.2))
    table = Table("exp1", "soft", EVERYTHING, "0", 1.0, (), {}, lines)
    assert (table.needs(), table.spared(True), table.spared(False)) == ([lines[0]], [lines[1]], [lines[2]])
    edges = replace(lines[1], id="edges")
    assert replace(table, lines=(*lines, edges)).unexplained({}) == ["flow", "edges"]
    assert replace(table, lines=(*lines, edges)).unexplained({"all": {"flow": "cheap"}, "exp2": {"edges": "not this one"}}) == ["edges"]
    assert replace(table, lines=(*lines, edges)).unexplained({"all": {"flow": "cheap"}, "exp1": {"edges": "the study has them"}}) == []


def test_a_share_that_is_no_number_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """NaN compares as smaller than 1 %: it must not pass for no effect."""
    base = run_of(tmp_path / "base", [(2.4e6, 40.0, 6.0)])
    monkeypatch.setattr("verification.harness.quantities.effects_of", lambda *given: {"start_Pa": Effect(float("nan"))})
    with pytest.raises(ValueError, match="not finite"):
        effects_of([one for one in quantities_of(base.scene, ()) if one.name == "start_Pa"], False, base, base)


def test_changes_are_named() -> None:
    """A name of a factor takes all of its values."""
    assert [one.id for one in named(factors_of(content_of(EXP5, "soft"), "quasistatic"), ["mesh", "rate"])] == ["mesh_half", "rate_half", "rate_double"]


def test_a_short_run_is_taken_apart(tmp_path: Path) -> None:
    """Both halves of the block give the scene's own result, no flow and no stress other ones, and the rock is one."""
    content = content_of(EXP1, "perfect", SHORT)
    changes = named(ingredients_of(content), ("flow", "symmetry", "prestress", "layering"))
    table = table_of(content, EVERYTHING, changes, *left_out(EXP1, "perfect", SHORT, changes, tmp_path), lambda jobs: make_all(jobs, 1))
    lines = {one.id: one for one in table.lines}
    assert {one.status for one in table.lines if one.applies} == {"completed"} and min(one.cpu_s for one in table.lines if one.applies) > 0.0
    assert lines["symmetry"].largest is not None and lines["symmetry"].largest < 1e-3 and not lines["symmetry"].lost
    assert lines["flow"].verdict == NEEDED and lines["prestress"].verdict == NEEDED
    assert not lines["layering"].applies
    assert write(table, tmp_path / "kept") and read_all(tmp_path / "kept") == [table]


def test_a_scene_that_fails_has_no_table(tmp_path: Path) -> None:
    """Without a run of its own there is nothing to compare with."""
    with pytest.raises(NoBase, match="failed: a mechanism"):
        table_of({}, EVERYTHING, [], Job(EXP1, "soft", tmp_path, ()), [], lambda jobs: [made_up(tmp_path / "run", 3, 2.4e6, 0.2e6, "a mechanism")])


def test_kept_tables_are_whole_and_explained() -> None:
    """Each experiment has its tables, and for whatever it has at a cost without needing it, or lacks, the reason."""
    kept = read_all()
    assert {one.experiment for one in kept} == {scene.stem for scene in scenes_of(EXPERIMENTS)}
    why = reasons()
    for one in kept:
        assert one.unexplained(why) == [], f"{one.experiment} {one.variant}"
        assert not [line.id for line in one.lines if line.applies and line.status == "refused"]


def test_every_reason_is_of_an_ingredient() -> None:
    """No reason is left over from an ingredient or an experiment that is gone."""
    ids = {one.id for scene in scenes_of(EXPERIMENTS) for one in ingredients_of(content_of(scene, "perfect", ()))} | {"interface"}
    for experiment, lines in reasons().items():
        assert experiment == "all" or (EXPERIMENTS / f"{experiment}.toml").is_file()
        assert set(lines) <= ids


# --- factors
@pytest.mark.parametrize("scene", scenes_of(EXPERIMENTS), ids=lambda path: path.stem)
@pytest.mark.parametrize("mechanics", ["explicit", "quasistatic"])
def test_every_factor_varies_its_own_keys_and_something_of_them(scene: Path, mechanics: str) -> None:
    for variant in variants_of(scene)[:4]:
        base = (f"numerics.mechanics={mechanics}", "numerics.far_cell_m=1")  # a budget's runs are on uniform grids
        content = content_of(scene, variant, base)
        factors = factors_of(content, mechanics)
        assert len({one.id for one in factors}) == len(factors)
        for one in factors:
            assert one.settings and not one.why_not
            assert {setting.partition("=")[0] for setting in one.settings} <= KEYS[one.label]
            assert content_of(scene, variant, (*base, *one.settings)) != content


def factors(scene: Path, variant: str, id_: str, mechanics: str = "quasistatic") -> list[Change]:
    return named(factors_of(content_of(scene, variant), mechanics), [id_])


def test_a_larger_block_keeps_fracture_and_layers_in_its_middle() -> None:
    for other, width in zip(factors(EXP5, "soft", "block"), (120.0, 160.0)):
        content = content_of(EXP5, "soft", other.settings)
        assert (content["domain"]["width_m"], content["domain"]["height_m"]) == (width, width)
        assert [x for x, _ in content["fracture"]["path_m"]] == [width / 2.0] * 2
        assert content["strata"]["layers"] == [{"rock": "soft", "thickness_m": width / 2.0 + 5.0}, {"rock": "stiff"}]
        assert content["numerics"]["far_cell_m"] == content["numerics"]["cell_m"]  # a path that turns would meet the coarse cells
    straight = content_of(EXP1, "soft", factors(EXP1, "soft", "block")[1].settings)
    assert straight["strata"]["layers"] == content_of(EXP1, "soft")["strata"]["layers"]
    assert straight["numerics"]["far_cell_m"] == 4.0


def test_factors_that_do_not_apply_say_why() -> None:
    assert factors(EXP1, "uniform", "step")[0].why_not == "no flow"
    assert factors(EXP1, "uniform", "step", "explicit")[0].settings == ("numerics.courant=0.25",)
    content = content_of(EXP1, "perfect", ("numerics.particles_per_cell=16", "fluid.inlet.rate_Pa_s=0", "stop.time_s=1", "numerics.far_cell_m=1"))
    why = {one.label: one.why_not for one in factors_of(content, "quasistatic") if not one.settings}
    assert set(why) == {"particles", "loading rate"} and all(why.values())
    assert toml([{"rock": "a", "thickness_m": 1.5}, {"rock": "b"}]) == '[{rock = "a", thickness_m = 1.5}, {rock = "b"}]'
    assert toml([[60.0, 0.0], [60.0, 5.0]]) == "[[60.0, 0.0], [60.0, 5.0]]"


def test_the_base_and_half_the_cells_are_the_runs_of_the_refinement_study(tmp_path: Path) -> None:
    content = content_of(EXP1, "soft")
    changes = factors_of(content, "quasistatic")
    base, jobs = varied(EXP1, "quasistatic", "soft", (), content, changes, tmp_path)
    of, below = {one.id: job for one, job in zip(changes, jobs, strict=True)}, REFINE_RUNS / EXP1.stem / "quasistatic" / "soft"
    assert base.out == below / "1m" and of["mesh_half"].out == below / "0.5m"
    rest = [job for name, job in of.items() if name != "mesh_half"]
    assert len({job.out for job in rest}) == len(rest) and all(tmp_path in job.out.parents for job in rest)
    keys = [[setting.partition("=")[0] for setting in job.settings] for job in (base, *jobs)]
    assert all(len(set(own)) == len(own) for own in keys)
    assert "numerics.cell_m=1.0" in of["increment_half"].settings and "fracture.increment_m=0.5" in of["increment_half"].settings


def test_totals_by_hand() -> None:
    """3 and -4 of the method: root of squares 5, sum 7; with 12 of the model 13 and 19. What failed is named, not counted as 0."""

    def ran(label: str, group: str, *effects: float | None) -> list[Tried]:
        return [replace(line(None), id=f"{label}_{k}", label=label, done=f"{label}{k}", group=group, effects={} if one is None else {"start_Pa": Effect(one)})
                for k, one in enumerate(effects)]  # fmt: skip

    lines = [*ran("mesh", "numerical", -3.0), *ran("ring", "numerical", 1.0, -4.0), *ran("block", "model", 12.0, None),
             *ran("rate", "model", None), *ran("mesh_increment", "beside", 100.0)]  # fmt: skip
    found = Table("exp1", "soft", "quasistatic", "0", 0.0, (("start_Pa", "start", "Pa"),), {}, tuple(lines))
    assert found.total("start_Pa", ["numerical"]) == (5.0, 7.0, [])
    assert found.total("start_Pa", ["numerical", "model"]) == (13.0, 19.0, ["block (block1)", "rate (rate0)"])


def made_up(folder: Path, status: int, start_Pa: float, plateau_Pa: float, reason: str = "", **over: float) -> Made:
    """A made-up run with a plateau at the interface, or one that was refused, and how it ended."""
    outcome = Outcome("exp1", "soft", "completed" if status == 0 else "failed", status, reason, 1.0, "k")
    steps = climb(start_Pa=start_Pa, plateaus={10.0: plateau_Pa}, **over)
    return outcome, None if status == 2 else load(write_run(folder, steps, end_Pa=3.2e6, mechanics="quasistatic"))


def test_effects_are_differences_from_the_base_and_failures_are_failures(tmp_path: Path) -> None:
    content = content_of(EXP1, "soft")
    changes = [one for one in factors_of(content, "quasistatic") if one.id in ("mesh_half", "rate_half", "rate_double")]
    base, jobs = varied(EXP1, "quasistatic", "soft", (), content, changes, tmp_path)
    ran = [made_up(tmp_path / "base", 0, 2.40e6, 0.20e6), made_up(tmp_path / "mesh", 0, 2.37e6, 0.30e6), made_up(tmp_path, 2, 0.0, 0.0, "unknown key"),
           made_up(tmp_path / "rate", 3, 2.44e6, 0.04e6, "a mechanism", to_m=20.0)]  # fmt: skip

    found = table_of(content, "quasistatic", changes, base, jobs, lambda asked: [ran.pop(0) for _ in asked])
    assert [name for name, _, _ in found.quantities] == ["start_Pa", "arrest_1_m", "restart_1_Pa", "pressure_at_40_Pa"]
    mesh, half, double = found.lines
    assert mesh.effects["start_Pa"].value == pytest.approx(-0.03e6) and mesh.effects["restart_1_Pa"].value == pytest.approx(0.07e6)
    assert (half.status, half.effects) == ("refused", {}) and double.status == "failed"
    assert double.effects["pressure_at_40_Pa"].value is None and "does not reach 40 m" in double.effects["pressure_at_40_Pa"].note
    assert double.effects["arrest_1_m"].note == "no arrest" and found.total("start_Pa", ["numerical", "model"])[0] == pytest.approx(0.05e6)
    silent = replace(found, lines=(replace(double, status="completed"),))
    assert "does not reach 40 m, at least 3.2e+06 Pa" in words(silent)
    assert all(part in words(found) for part in ("refused: unknown key", "failed: a mechanism", "-30.00 -1.25%", "all factors, plain sum"))


def test_every_experiment_has_its_budget_of_variants_that_exist() -> None:
    assert set(BUDGETED) == {scene.stem for scene in scenes_of(EXPERIMENTS)}
    assert all(set(BUDGETED[scene.stem]) <= set(variants_of(scene)) for scene in scenes_of(EXPERIMENTS))


def test_a_small_budget_from_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Experiment 1 with cells and increments of 2 m up to 13 m: factors in one table; a second call makes no run again."""
    settings = [word for one in ("numerics.cell_m=2.0", "fracture.increment_m=2.0", "stop.tip_y_m=13") for word in ("--set", one)]
    arguments = ["exp1", "--variants", "soft", "--out", str(tmp_path), *settings]
    assert budget(arguments) == 0
    found = json.loads((tmp_path / "quasistatic" / f"{EXP1.stem}.soft.json").read_text())
    assert {"start_Pa", "restart_1_Pa", "pressure_at_10_Pa"} <= set(found["base"])
    effects = {one["id"]: one["effects"]["start_Pa"]["value"] for one in found["lines"]}
    assert len(effects) == 12 and all(map(math.isfinite, effects.values())) and {one["status"] for one in found["lines"]} == {"completed"}
    # The first growth knows nothing of the increment, and a slower ramp starts it at a lower pressure, a faster one at a higher.
    assert effects["increment_half"] == effects["increment_double"] == 0.0
    assert effects["rate_half"] < 0.0 < effects["rate_double"]
    assert abs(effects["mesh_half"]) > 1e4
    capsys.readouterr()
    assert budget(arguments) == 0
    assert capsys.readouterr().out.count("done before") == 13
