"""The crossing map: verdicts on made-up runs, criteria against hand numbers, two corners run, and the kept tables.

Mutations that were tried by hand and failed here: each threshold of a verdict doubled, halved or left out, slip counted after the crossing, at the first output
or on the shorter side, slip of one sign alone; in the criteria flipped signs, twice and 0.4 times the closed form, the easier half of the interface.
"""

import math
from pathlib import Path

import h5py
import numpy as np
import pytest

from verification.crossing_map import criteria
from verification.crossing_map.__main__ import main
from verification.crossing_map.verdict import CROSSES, GIVES_WAY, MAPS, STOPS, Verdict, bears, read_table, verdict_of
from verification.harness import sweep
from verification.harness.load import load
from verification.tests.fake_run import climb, write_run


FAILED_RUNS = {"inclined": [(0.8, 60.0), (0.9, 60.0), (1.0, 60.0)]}


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
    """Every run of a map has its line, and none failed, but for those that README.md names."""
    one = MAPS[name]
    kept = read_table(one)
    rows = [sweep.axes_of(job) for job in sweep.jobs_of(one.scene(tmp_path), tmp_path)]
    assert list(kept) == [(one.x.value(row), one.y.value(row)) for row in rows]
    failed = [at for at, found in kept.items() if found.verdict not in (CROSSES, STOPS, GIVES_WAY)]
    assert failed == FAILED_RUNS.get(name, [])


def test_the_border_is_where_slip_comes_two_metres_far() -> None:
    """The kept border between giving way and crossing lies within a step of the axis (1.27 times) of the closed form; twice and half do not."""
    kept = read_table(MAPS["friction"])
    step = (10.0 / 0.1) ** (1.0 / 19.0)
    for friction in (0.1, 0.2, 0.4, 0.6, 0.8, 1.0):
        given = max(x for (x, y), one in kept.items() if y == friction and one.verdict != CROSSES)
        assert all(one.verdict != CROSSES for (x, y), one in kept.items() if y == friction and x < given)
        expected = criteria.mean_slip(friction, 1.45 / math.sqrt(9.5 * math.pi), 10.0, 2.0)
        assert given / step < expected < given * step * step
