"""Runs that leave the range of their equations say so, those within it do not, on the README's first scene."""

import math
import textwrap
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from verification.harness.paths import ROOT
from verification.tests.cases import summary_in


@cache
def first_scene() -> str:
    """The README's first scene, in the mechanics that it names second."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    lines = text.split("## A first scene", 1)[1].split("[variants.stronger]", 1)[0].splitlines()
    scene = textwrap.dedent("\n".join(line for line in lines if line.startswith("    ")))
    assert 'mechanics = "quasistatic"' in scene
    return scene.replace('mechanics = "quasistatic"', 'damping_1_s = 20\nmechanics = "explicit"')


def marks(summary: dict[str, Any]) -> set[str]:
    """The monitors that mark a run."""
    return {mark["monitor"] for mark in summary["suspect"]}


QUASISTATIC, TOTAL = "numerics.mechanics=quasistatic", "numerics.kinematics=total"


@pytest.mark.parametrize("mechanics", [(QUASISTATIC,), (TOTAL,), ()])
def test_the_first_scene_is_sound(tmp_path: Path, mechanics: tuple[str, ...]) -> None:
    """With inertia it says that speeds of growth are no result."""
    assert marks(summary_in(tmp_path, first_scene(), *mechanics)) == (set() if mechanics == (QUASISTATIC,) else {"surface_energy_share"})


@pytest.mark.parametrize("mechanics", [(QUASISTATIC,), (TOTAL, "stop.time_s=0.1"), ("stop.time_s=0.1",)])
@pytest.mark.parametrize("start_Pa", [0, 1.3e6, 2.0e6])
def test_a_closed_fracture_at_rest_is_sound(tmp_path: Path, mechanics: tuple[str, ...], start_Pa: float) -> None:
    """A closed fracture, or one that the fluid just holds, has nothing but round-off in its energies and momenta."""
    at_rest = f"fluid.inlet={{start_Pa={start_Pa}, rate_Pa_s=0}}"
    leaning = "fracture.path_m=[[8.3, 6.1], [11.2, 11.4]]"
    for settings in (("domain.sides=traction",), (leaning, "domain.bottom=traction", "domain.sides=traction")):
        summary = summary_in(tmp_path, first_scene(), "stop.time_s=0", at_rest, *settings, *mechanics)
        assert marks(summary) == set(), summary["suspect"]


@pytest.mark.parametrize("settings, expected", [
    ((QUASISTATIC, "rock.shale.youngs_modulus_Pa=10"), {"implausible_inputs", "largest_strain", "largest_rotation", "jump_share"}),
    ((QUASISTATIC, "rock.shale.youngs_modulus_Pa=1e7"), {"largest_strain"}), (("rock.shale.youngs_modulus_Pa=1e7",), {"loading_share"}),
    ((QUASISTATIC, "rock.shale.toughness_Pa_sqrt_m=1.45"), {"implausible_inputs"}),
    ((QUASISTATIC, "in_situ={vertical_Pa=3, horizontal_Pa=2}"), {"implausible_inputs"}), (("rock.shale.density_kg_m3=2.5e6",), {"loading_share"}),
    (("fluid.inlet={start_Pa=3e6, rate_Pa_s=0.35e6}",), {"shock_share"}), (("fluid.inlet={start_Pa=2e6, rate_Pa_s=0.35e9}",), {"loading_share"}),
    (("fluid.inlet={start_Pa=2e6, rate_Pa_s=1.4e6}", "numerics.damping_1_s=2000", TOTAL), {"loading_share"}),
])  # fmt: skip
def test_what_leaves_the_range_is_marked(tmp_path: Path, settings: tuple[str, ...], expected: set[str]) -> None:
    """Units of another kind, loads that are not slow: marked by at least these monitors."""
    summary = summary_in(tmp_path, first_scene(), *settings)
    assert expected <= marks(summary), summary["suspect"]
    for mark in summary["suspect"]:
        assert summary["monitors"][mark["monitor"]] == mark["value"] and len(mark["why"]) > 40


@pytest.mark.parametrize("kinematics", ["total", "updated"])
def test_the_increment_hardly_moves_the_pressure(tmp_path: Path, kinematics: str) -> None:
    """A crack runs as its energy lets it, whatever the increment. It starts as exp(c_R t/a) at J_c, and a longer increment skips more of
    this: a/c_R log(1 m/0.02 m) = 0.0166 s, in which the inlet rises by 0.0058 MPa; twice that is let pass, for what waves bring back from
    the edges. (One increment a look would take 0.33 s more at 0.02 m.)"""
    ends, c_R, a_m, rate_Pa_s = {}, 1176.0, 5.0, 0.35e6
    for increment in (0.02, 0.1, 0.5, 1.0):
        ends[increment] = summary_in(tmp_path, first_scene(), f"fracture.increment_m={increment}", f"numerics.kinematics={kinematics}")["inlet_Pa"]
    skipped = {increment: rate_Pa_s * a_m / c_R * math.log(increment / 0.02) for increment in ends}
    for increment in (0.1, 0.5, 1.0):
        assert 0.0 < ends[0.02] - ends[increment] < 2.0 * skipped[increment]
