"""Closed fractures under shear that are fed at a rate: their faces slide as far as no friction holds them, open by the fluid's net pressure alone, or say why not."""

from math import cos, pi, radians, sin, sqrt
from pathlib import Path

import pytest

from verification.tests.cases import rows_of, run_in

E_PRIME, HALF, RATE = 10e9 / 0.96, 5.65685, 1e-4  # Pa, half length (m), m2/s


def path_at(degrees: float, x: float = 16.2, y: float = 16.1) -> str:
    c, s = HALF * cos(radians(degrees)), HALF * sin(radians(degrees))
    return f"fracture.path_m=[[{x - c:.6f}, {y - s:.6f}], [{x + c:.6f}, {y + s:.6f}]]"


def stresses_on(degrees: float, vertical: float = 12e6, horizontal: float = 8e6) -> tuple[float, float]:
    """Normal stress and the shear that drives K_II (Pa) on a plane at an angle to the horizontal."""
    c, s = cos(radians(degrees)), sin(radians(degrees))
    return vertical * c * c + horizontal * s * s, (horizontal - vertical) * c * s


SCENE = """\
domain = {width_m = 32, height_m = 32, beyond_m = 800, bottom = "traction"}
in_situ = {vertical_Pa = 12e6, horizontal_Pa = 8e6}
rock.r = {youngs_modulus_Pa = 10e9, poisson_ratio = 0.2, toughness_Pa_sqrt_m = 1.45e6}
strata.layers = [{rock = "r"}]
fracture = {path_m = [[12, 12], [20, 20]], growth = "none"}
fluid = {law = "reynolds", viscosity_Pa_s = 1e-3, inlet = {rate_m2_s = 1e-4}}
numerics = {mechanics = "quasistatic", cell_m = 1}
stop = {time_s = 100}
"""


@pytest.mark.parametrize("degrees, settings, off", [
    (45, ("fracture.path_m=[[12, 12], [20, 20]]",), 0.05),  # along the grid's diagonal, as points of cells lie
    (45, ("fracture.path_m=[[12, 12], [20, 20]]", "in_situ={vertical_Pa=8e6, horizontal_Pa=12e6}"), 0.05),
    (10, (), 0.04), (80, (), 0.04), (60, ("fracture.friction=0.6",), 0.04), (45, ("numerics.cell_m=0.5",), 0.02),
])  # fmt: skip
def test_a_fracture_that_slides_is_opened_by_the_fluid_as_one_that_does_not(tmp_path: Path, degrees: float, settings: tuple[str, ...], off: float) -> None:
    """Griffith: the whole shear slides, K_II = tau sqrt(pi a), since the fluid takes all that presses the faces; and p = Q t E'/(2 pi a^2)
    opens them, K_I = p sqrt(pi a), whatever the slip. It had no solution at t = 0: the balance was asked for digits that contact loses in slip.

    Mutations that fail: RockResponse::cancels of the tangential jump alone, or none (no solution at 45 degrees).
    """
    done = run_in(tmp_path, SCENE, path_at(degrees), *settings)
    assert done.returncode == 0, done.stderr
    rows = rows_of(tmp_path / "X")
    turned = any("vertical_Pa=8e6" in s for s in settings)
    normal, tau = stresses_on(degrees, *((8e6, 12e6) if turned else (12e6, 8e6)))
    for row in (rows[0], rows[-1]):
        assert float(row["K_II_Pa_sqrt_m"]) == pytest.approx(tau * sqrt(pi * HALF), rel=0.02)
    net = RATE * 100.0 * E_PRIME / (2.0 * pi * HALF**2)
    assert float(rows[-1]["inlet_Pa"]) - normal == pytest.approx(net, rel=off)
    assert float(rows[-1]["K_I_Pa_sqrt_m"]) == pytest.approx(net * sqrt(pi * HALF), rel=off)
    fed = float(rows[-1]["fracture_volume_m2"]) - float(rows[0]["fracture_volume_m2"])
    assert fed == pytest.approx(RATE * 100.0, rel=2e-3)  # and what the fluid is compressed by
    assert abs(float(rows[-1]["fluid_volume_balance"])) < 1e-8


def slip_area(b: float, tau: float, friction: float) -> float:
    """int delta ds (m^2) of a long closed crack that the fluid lets slide over 2 b, and friction (Pa) holds beyond: Dugdale's strip with
    tau within b, tau - friction to c, where K_II is 0; by reciprocity with the slip (4/E') sqrt(c^2 - s^2) of an even shear of 1 Pa."""
    angle = 0.5 * pi * (1.0 - tau / friction)
    c = b / sin(angle)
    within = angle + sin(angle) * cos(angle)  # 2/c^2 int sqrt(c^2 - s^2) ds, 0 to b
    return 4.0 / E_PRIME * c * c * (tau * within - (friction - tau) * (0.5 * pi - within))


@pytest.mark.parametrize("increment", [1.0, 2.0])
def test_friction_holds_the_faces_that_the_fluid_has_not_come_to(tmp_path: Path, increment: float) -> None:
    """At the start the fluid is in an increment on either side of the inlet: only there, and a little beyond, the faces slide, and no K_II
    is at the tips. They slid everywhere, as if they were full of fluid, and stuck then: K_II was 7.3 MPa sqrt(m).

    Mutation that fails: the fluid's pressure in dry cells while the start is found.
    """
    settings = (path_at(60), 'fracture.growth="J"', "fracture.friction=0.6", f"fracture.increment_m={increment}", "numerics.cell_m=0.25", "stop.time_s=1e-3")
    assert run_in(tmp_path, SCENE, *settings).returncode == 0
    start = rows_of(tmp_path / "X")[0]
    normal, tau = stresses_on(60)
    assert abs(float(start["K_II_Pa_sqrt_m"])) < 0.02 * abs(tau) * sqrt(pi * HALF)
    cell = 2.0 * HALF / 50.0  # of the fluid: whole ones are wet, and the next one is at its closing stress
    wet = cell * (increment // cell + 1)
    slid = 2.0 * float(start["in_situ_work_J"]) / abs(tau)  # what the in-situ stress lets go counts half
    assert slip_area(wet, abs(tau), 0.6 * normal) < slid < slip_area(wet + cell, abs(tau), 0.6 * normal)


@pytest.mark.parametrize("growth", ["J", "energy"])
def test_a_dry_fracture_that_would_slide_open_says_what_to_do(tmp_path: Path, growth: str) -> None:
    """Without friction K_II of the dry fracture is five times the toughness: it would grow without fluid, and waited for that.

    Mutations that fail: K_I for K_II, tips that the fluid has come to (a fracture of two increments is full and grows).
    """
    done = run_in(tmp_path, SCENE, path_at(60), f'fracture.growth="{growth}"')
    assert done.returncode == 3
    assert "before the fluid comes to it" in done.stderr and "fracture.friction (well above 0.19" in done.stderr
    short = ("fracture.path_m=[[16, 16], [16.9, 17.56]]", "stop.time_s=1", f'fracture.growth="{growth}"')
    assert run_in(tmp_path, SCENE, *short).returncode == 0
    assert run_in(tmp_path, SCENE, path_at(60), f'fracture.growth="{growth}"', "fracture.friction=0.4", "stop.time_s=1").returncode == 0


@pytest.mark.parametrize("settings", [
    ("fracture.path_m=[[12.3, 10.1], [16.2, 16.1], [21.2, 19.1]]",),
    ("fracture.path_m=[[12.3, 10.1], [16.2, 16.1], [21.2, 19.1]]", "fracture.friction=0.4"),
    ('in_situ={vertical_Pa=11.6e6, horizontal_Pa="7.7e6 + 15e3*(32 - Y)", weight=true}',),
])  # fmt: skip
def test_kinks_and_stress_that_grows_with_depth(tmp_path: Path, settings: tuple[str, ...]) -> None:
    """What is fed is there, in 1 m and 0.5 m cells, and these agree about the fluid's pressure to 0.1 MPa, a fifth of the net one."""
    pressure = []
    for cell in (1.0, 0.5):
        done = run_in(tmp_path, SCENE, *settings, f"numerics.cell_m={cell}")
        assert done.returncode == 0, done.stderr
        rows = rows_of(tmp_path / "X")
        fed = float(rows[-1]["fracture_volume_m2"]) - float(rows[0]["fracture_volume_m2"])
        assert fed == pytest.approx(RATE * 100.0, rel=2e-3)
        pressure.append(float(rows[-1]["inlet_Pa"]))
    assert pressure[0] == pytest.approx(pressure[1], rel=0.01)


@pytest.mark.parametrize("cell, until", [(1.0, 15.0), (0.5, 11.0)])
def test_the_ledger_closes_where_the_fluid_frees_what_friction_held(tmp_path: Path, cell: float, until: float) -> None:
    """As the front comes into a cell its faces let go, and neighbours that stuck far below their bound slide. The ledger was open by 0.017 (1 m)
    and 0.030 (0.5 m): each place's friction was taken to its own nearest bound, and 4 % more than the in-situ stress gave.

    Faces that held the whole shear hold none when they are free: the work of friction is half of the shear times their slip, of which the
    work of the in-situ stress tells, and a few per cent more where faces beyond slide at their bound.
    Mutations that fail: the mean place by place within its bounds, the least or the largest that these allow, friction's first or last value,
    none, twice, of the other sign.
    """
    settings = (path_at(60), 'fracture.growth="J"', "fracture.friction=0.6", f"numerics.cell_m={cell}", f"stop.time_s={until}")
    assert run_in(tmp_path, SCENE, *settings).returncode == 0
    rows = rows_of(tmp_path / "X")
    assert max(abs(float(row["energy_closure"])) for row in rows) < 1e-4
    normal, _ = stresses_on(60)
    start, end = rows[0], rows[-1]
    work = float(end["in_situ_work_J"]) - float(start["in_situ_work_J"]) + normal * (float(end["fracture_volume_m2"]) - float(start["fracture_volume_m2"]))
    friction = float(end["friction_J"]) - float(start["friction_J"])
    assert 0.5 < friction / work < 0.54
