"""strata held against experiments: bounds that are asked for, errors as recorded, and what can be said of measurements without the solver.

Mutations that were tried by hand and failed here: the run's clock off by 2 s, the rate of one wing for both, the gauges' zero with its sign turned, the
length read after each step.

The crossing map: verdicts on made-up runs, criteria against hand numbers, two corners run, and the kept tables.

Mutations that were tried by hand and failed here: each threshold of a verdict doubled, halved or left out, slip counted after the crossing, at the first output
or on the shorter side, slip of one sign alone; in the criteria flipped signs, twice and 0.4 times the closed form, the easier half of the interface.
"""

import math
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest

from verification.crossing_map import verdict as criteria
from verification.crossing_map.__main__ import main
from verification.crossing_map.verdict import CROSSES, GIVES_WAY, MAPS, STOPS, Verdict, bears, read_table, verdict_of
from verification.harness import sweep
from verification.harness.load import load, value
from verification.harness.paths import RUNS
from verification.harness.run import make
from verification.harness.scenes import read_scene
from verification.measured import rubin
from verification.measured.__main__ import COARSE_M, FINE_M, differences as off_record, job
from verification.tests.fake_run import climb, write_run

# Asked of the plain run, mean relative errors from 15 s on. Of the pressure none is asked: what it lacks is not known for sure (README.md of measured), so
# its error is held to the recorded one from both sides.
ASKED = {rubin.LENGTH: 0.06, rubin.OPENING: 0.10}


@pytest.mark.smoke
def test_rubin_coarse() -> None:
    """The run at 2 mm, also with its gauges from zero: length and opening within what is asked, all errors as recorded, and the fall
    from gauge to gauge, in which a common zero drops out, within 10 % from 30 s on; a run of zero, twice and the flipped sign is neither."""
    outcome, run = make(job("", COARSE_M, RUNS / "tests"))
    assert outcome.ok and run is not None, outcome.reason
    old = rubin.kept()
    assert old is not None
    own = tuple(rubin.result(one, run) for one in rubin.variants() if not one.scene)
    assert off_record(replace(old, results=own), old) == []
    found = own[0]
    assert [found.errors[name].values for name in rubin.COLUMNS] == [10, 10, 10, 10, 7]
    courses = rubin.courses(run)
    (since, near), (_, far) = ((at[-6:], values[-6:]) for at, values in map(rubin.measured, (rubin.NEAR, rubin.FAR)))
    fall = rubin.read(courses[rubin.NEAR], since) - rubin.read(courses[rubin.FAR], since)
    assert since[0] > 30.0 and np.mean(np.abs(fall / (near - far) - 1.0)) < 0.1
    for name, (at, values) in courses.items():
        for times in (1.0, 0.0, 2.0, -1.0):
            late = rubin.late_error((at, times * values), name)
            wrong = replace(found, errors={name: replace(found.errors[name], late=late)})
            assert (not off_record(replace(old, results=(wrong,)), old)) == (times == 1.0)
            assert (late <= ASKED.get(name, 0.35)) == (times == 1.0), (name, times)


def test_the_record_is_whole() -> None:
    """Every variant at 2 mm, the plain run, also with its gauges from zero, at 1 mm: the two sizes agree to 1.5 %; within what is asked."""
    kept = rubin.kept()
    assert kept is not None
    wanted = [(one.name, COARSE_M) for one in rubin.variants()] + [(one.name, FINE_M) for one in rubin.variants() if not one.scene]
    assert [(one.name, one.cell_m) for one in kept.results] == wanted
    for coarse, fine in zip(kept.results[:2], kept.results[-2:]):
        assert coarse.says == fine.says and all(one.errors[name].late <= bound for one in (coarse, fine) for name, bound in ASKED.items())
        assert all(abs(fine.errors[name].late - coarse.errors[name].late) < 0.015 for name in (rubin.LENGTH, rubin.OPENING, rubin.WELL))


def test_variants_are_what_they_say() -> None:
    """The stress that closes the fracture is the reading of gauge 57; E/(1 - nu^2) of plane stress is E; the oil's rule (README.md of measured)."""
    scene = read_scene(rubin.SCENE)
    pmma, changed = scene["rock"]["pmma"], scene["variants"]
    assert abs(changed["closing_stress"]["in_situ"]["horizontal_Pa"] - rubin.reading_without_fluid_Pa()) < 500.0
    plane = changed["plane_stress"]["rock"]["pmma"]
    assert plane["youngs_modulus_Pa"] / (1.0 - plane["poisson_ratio"] ** 2) == pytest.approx(pmma["youngs_modulus_Pa"], rel=1e-4)
    thicker = 10.0 ** (763.1 / 293.15 - 763.1 / 298.15)
    assert changed["cold_oil"]["fluid"]["viscosity_Pa_s"] == pytest.approx(thicker * scene["fluid"]["viscosity_Pa_s"], rel=1e-3)


def test_late_readings_are_above_what_the_block_holds() -> None:
    """Without the solver: the even pressure at which K is K_Ic, by boundary elements, lies below the last readings of gauge 57 by 1 to 1.3 times its
    reading without fluid; the rest, 0.07 to 0.08 MPa, is what flow beyond the gauge takes."""
    pmma = {key: number for key, number in read_scene(rubin.SCENE)["rock"]["pmma"].items() if key != "density_kg_m3"}
    lengths, readings = (rubin.measured(name)[1][-3:] for name in (rubin.LENGTH, rubin.FAR))
    even = [value("block_crack", "critical_net_pressure_Pa", half_length_m=float(a), width_m=0.096, half_height_m=0.1525, **pmma) for a in lengths]
    excess = (readings - even) / rubin.reading_without_fluid_Pa()
    assert np.all((excess > 1.0) & (excess < 1.3)), excess


def test_wu_the_side_of_less_stress_goes_on() -> None:
    """Wu et al. 2008: 5 MPa below -25 mm, 11.2 MPa above 25 mm, 7 MPa between. As a crack of plane strain from the lowest to the highest point of a
    front (from the second on) the lower tip goes on at 2 MPa less than the upper one; the fronts went down by 117 mm, up by less than 5 mm."""
    columns = list(rubin.table("wu2008_fronts_mm").values())[1::2]
    bottoms, tops = (np.array([-1e-3 * extreme(y) for y in columns[::-1]]) for extreme in (np.nanmax, np.nanmin))
    assert len(tops) == 5 and tops[0] < 0.025 < tops[1]
    tough, held = 1.2e6, 1e9
    for bottom, top in zip(bottoms[1:], tops[1:]):
        lower, upper = (value("layered_height", "start_Pa", border_m=[-0.025, 0.025], stress_Pa=[5.0e6, 7.0e6, 11.2e6], toughness_Pa_sqrt_m=toughness,
                              bottom_m=float(bottom), top_m=float(top)) for toughness in ([tough, held, held], [held, held, tough]))  # fmt: skip
        assert upper - lower > 2.0e6
    assert bottoms[1] - bottoms[-1] > 0.11 and tops[-1] - tops[1] < 0.005


def made(folder: Path, rise_Pa: float, slid_m: float, at_Pa: float = 2.42e6, to_m: float = 14.0, slip_m: float = 1e-4, end_Pa: float = 3e6) -> Verdict:
    """The verdict on a run that comes to 10 m at 2.38 MPa and goes on so much later, of whose interface a length slides at a pressure."""
    outputs = [(2.3e6, 0.0), (at_Pa, slid_m), (2.95e6, slid_m)]
    write_run(folder, end_Pa=end_Pa, steps=climb(to_m=to_m, plateaus={10.0: rise_Pa - 10e3}), failed_m=outputs, mechanics="quasistatic")
    with h5py.File(folder / "result.h5", "a") as store:
        for place in store["interfaces"].values():
            place["0/slip_m"] = -slip_m * place["0/split"][()]
            place["0/opening_m"] = np.zeros(len(place["0/split"]))
    return verdict_of(load(folder))


@pytest.mark.parametrize(("rise_MPa", "slid_m", "at_MPa", "verdict"), [
    (0.010, 0.0, 2.42, CROSSES), (0.050, 0.0, 2.42, CROSSES), (0.051, 0.0, 2.42, STOPS), (0.3, 1.5, 2.42, STOPS), (0.3, 2.0, 2.42, GIVES_WAY),
    (0.3, 8.0, 2.42, GIVES_WAY), (0.3, 8.0, 2.90, STOPS), (0.010, 8.0, 2.90, CROSSES), (0.010, 8.0, 2.35, GIVES_WAY),
])  # fmt: skip
def test_verdicts(tmp_path: Path, rise_MPa: float, slid_m: float, at_MPa: float, verdict: str) -> None:
    """The rise counts from arrival to 2 m beyond, slip only before that, and first."""
    got = made(tmp_path / "map" / "run", rise_MPa * 1e6, slid_m, at_MPa * 1e6)
    assert got.verdict == verdict
    assert got.arrival_Pa == pytest.approx(2.38e6) and got.rise_Pa == pytest.approx(rise_MPa * 1e6)
    assert got.passed and got.slid_m == pytest.approx(slid_m if at_MPa * 1e6 < got.arrival_Pa + got.rise_Pa else 0.0)


def test_verdicts_at_the_ends(tmp_path: Path) -> None:
    """A fracture that never leaves is held to the run's end, however soon that is; what sticks has not slid; one that never comes has no arrival and has stopped."""
    held = made(tmp_path / "a" / "run", 0.0, 0.0, to_m=10.0)
    assert (held.verdict, held.passed, held.rise_Pa) == (STOPS, False, pytest.approx(3.0e6 - 2.38e6))
    short = made(tmp_path / "d" / "run", 0.0, 0.0, to_m=11.0, end_Pa=2.4e6)
    assert (short.verdict, short.passed) == (STOPS, False) and short.rise_Pa < 0.05e6
    assert made(tmp_path / "b" / "run", 0.3e6, 8.0, slip_m=1e-8).verdict == STOPS
    absent = made(tmp_path / "c" / "run", 0.0, 0.0, to_m=8.0)
    assert absent.verdict == STOPS and math.isnan(absent.arrival_Pa)


def test_criteria_by_hand() -> None:
    """Numbers of references E, of Renshaw & Pollard's formula, and the tip's own field as the limit of the Griffith crack's."""
    for friction, ratio in ((0.4, 0.8122), (0.6, 0.8915)):
        assert 1.0 / criteria.first_slip(friction, math.sqrt(2.0 * math.pi), 1.0) == pytest.approx(ratio, abs=5e-5)
    assert [criteria.renshaw_pollard(mu, 1.0, 2.0) for mu in (0.2, 0.4, 0.6, 0.9)] == pytest.approx([5.943, 3.467, 2.642, 2.091], abs=5e-4)
    assert criteria.blanton(1.0, 2.0) == 3.0
    shear, tension = criteria.griffith_means(10.0, 1e-4)  # 0.35355 K/sqrt(2 pi r), of which the mean is twice the end's; less 1 in tension
    assert shear == pytest.approx(0.35355 * 2.0 * math.sqrt(5.0 / 1e-4), rel=1e-3) and tension == pytest.approx(shear - 1.0, rel=1e-3)


def test_gu_weng() -> None:
    """At 90 degrees: where the largest tension is T0 the shear is just what friction bears (the quadratic for k by hand); mirror images are alike,
    the more it leans the more friction it asks for, a little less than Renshaw & Pollard at 90 degrees, and an interface that opens is not crossed."""
    T0, s_h, s_v = 1.0, 2.0, 3.0
    along, across, shear = criteria.tip_field(0.5 * math.pi)
    ks = np.linspace(1e-3, 10.0, 400001)  # the first k at which (T0 - along)(T0 - across) = shear^2
    k = ks[np.argmax((T0 - along * ks + s_v) * (T0 - across * ks + s_h) - (shear * ks) ** 2 < 0.0)]
    assert criteria.gu_weng(T0, s_v, s_h) == pytest.approx(abs(shear) * k / (s_v - along * k), rel=1e-4)
    leaning = [criteria.gu_weng(T0, 6.0, s_h, math.radians(angle)) for angle in (90.0, 75.0, 60.0, 120.0, 45.0)]
    assert leaning[2] == pytest.approx(leaning[3]) and leaning[0] < leaning[1] < leaning[2] < leaning[4]
    assert leaning[0] < 0.35 / (1.06 * 6.0 / (T0 + s_h) - 0.35) < 1.2 * leaning[0]
    assert math.isinf(criteria.gu_weng(T0, 0.1, s_h))


@pytest.mark.smoke
def test_corners(tmp_path: Path) -> None:
    """Little friction under little stress gives way and holds the fracture, much of both lets it pass at once; asked again it is the same table."""
    wanted = ["--family=friction", "--size=2", f"--runs={tmp_path}", f"--out={tmp_path / 'records'}"]
    assert main(wanted) == 0
    found = read_table(MAPS["friction"], tmp_path / "records")
    assert list(found) == [(0.1, 0.05), (10.0, 0.05), (0.1, 1.0), (10.0, 1.0)]
    weak, strong = found[0.1, 0.05], found[10.0, 1.0]
    assert weak.verdict == GIVES_WAY and weak.passed and weak.rise_Pa > 0.5e6 and not weak.suspect
    assert strong == Verdict(CROSSES, strong.arrival_Pa, 0.0, True, 0.0) and 2.2e6 < strong.arrival_Pa < 2.3e6
    table = (tmp_path / "records" / "friction.csv").read_bytes()
    assert main(wanted) == 0 and (tmp_path / "records" / "friction.csv").read_bytes() == table
    assert not list(tmp_path.glob("crossing_map/*/runs/*/result.h5"))


def test_tables(tmp_path: Path) -> None:
    """A table's verdicts by hand, a failed run with its reason; the inclined map knows what slides before anything is done."""
    head = "run,interface.friction.coefficient,in_situ.vertical_Pa,status,reason,verdict,arrival_Pa,rise_Pa,passed,slid_m,suspect\n"
    rows = "a,0.5,1000000.0,completed,,stops,2250000.0,100000.0,False,1.5,one two\nb,0.5,2000000.0,failed,why,,,,,,\n"
    (tmp_path / "friction.csv").write_text(head + rows)
    back = read_table(MAPS["friction"], tmp_path)
    assert back[1.0, 0.5] == Verdict(STOPS, 2.25e6, 1e5, False, 1.5, ("one", "two"))
    assert (back[2.0, 0.5].verdict, back[2.0, 0.5].suspect) == ("failed", ("why",)) and math.isnan(back[2.0, 0.5].rise_Pa)
    assert bears(0.5, 60.0) and not bears(0.3, 60.0) and bears(0.01, 90.0)


@pytest.mark.parametrize("name", list(MAPS))
def test_kept_tables_are_whole(name: str, tmp_path: Path) -> None:
    """Every run of a map has its line, and none failed."""
    one = MAPS[name]
    kept = read_table(one)
    rows = [sweep.axes_of(job) for job in sweep.jobs_of(one.scene(tmp_path), tmp_path)]
    assert list(kept) == [(one.x.value(row), one.y.value(row)) for row in rows]
    assert not [at for at, found in kept.items() if found.verdict not in (CROSSES, STOPS, GIVES_WAY)]


def test_the_border_is_where_slip_comes_two_metres_far() -> None:
    """The kept border between giving way and crossing lies within a step of the axis (1.27 times) of the closed form; twice and half do not."""
    kept = read_table(MAPS["friction"])
    step = (10.0 / 0.1) ** (1.0 / 19.0)
    for friction in (0.1, 0.2, 0.4, 0.6, 0.8, 1.0):
        given = max(x for (x, y), one in kept.items() if y == friction and one.verdict != CROSSES)
        assert all(one.verdict != CROSSES for (x, y), one in kept.items() if y == friction and x < given)
        expected = criteria.mean_slip(friction, 1.45 / math.sqrt(9.5 * math.pi), 10.0, 2.0)
        assert given / step < expected < given * step * step
