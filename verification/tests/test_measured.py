"""strata held against experiments: bounds that are asked for, errors as recorded, and what can be said of measurements without the solver.

Mutations that were tried by hand and failed here: the run's clock off by 2 s, the rate of one wing for both, the gauges' zero with its sign turned, the
length read after each step.
"""

from dataclasses import replace

import numpy as np
import pytest

from verification.harness.load import value
from verification.harness.paths import RUNS
from verification.harness.run import make
from verification.harness.scenes import read_scene
from verification.measured import rubin
from verification.measured.__main__ import COARSE_M, FINE_M, differences, job

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
    assert differences(replace(old, results=own), old) == []
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
            assert (not differences(replace(old, results=(wrong,)), old)) == (times == 1.0)
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
