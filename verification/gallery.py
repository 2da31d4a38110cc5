"""The scenes of experiments/gallery: of each one number of its run beside the same from a source of its own, and how far apart they may be."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from verification.harness.load import E_prime, Run, column, crack_ends, frames, given, half_length, net_Pa, pressure_beyond, rock, start_of, upper, value
from verification.harness.paths import EXPERIMENTS
from verification.ladder.cases.junction import along, curve

FOLDER = EXPERIMENTS / "gallery"
Pair = tuple[float, float]  # got and expected, SI

FROM_JUNCTION_M, HALF_TALL_M, AT_S = 5.0, 40.0, 0.025


@dataclass(frozen=True)
class Scene:
    """A scene: its question; the number that is expected, its unit with the factor from SI, and where it comes from; how far apart, as a share, the run
    and its source may be at the scene's own cells; and its further variants."""

    name: str
    question: str
    number: str
    unit: str
    factor: float
    source: str
    within: float
    pair: Callable[[Run], Pair]
    variants: tuple[str, ...] = ()

    def told(self, value: float) -> str:
        """A value in the scene's unit, to three digits."""
        return f"{self.factor * value:.3g} {self.unit}"


def fed(run: Run) -> dict[str, float]:
    """Rock, fluid and rate of a fracture that is fed, as the references take them."""
    return rock(run, 0) | {"toughness_Pa_sqrt_m": given(run, "rock.shale.toughness_Pa_sqrt_m"), "viscosity_Pa_s": given(run, "fluid.viscosity_Pa_s"),
                           "rate_m2_s": given(run, "fluid.inlet.rate_m2_s")}


def layers(run: Run) -> Pair:
    """Growth of the upper tip by the end."""
    start = crack_ends(run)[1][1]
    return upper(run).y_m - start, value("layered_height", "top_m", **column(run), pressure_Pa=run.summary.inlet_Pa) - start


def junction(run: Run) -> Pair:
    """Slip along the crack with friction at a distance before the junction."""
    x, fields, length = along(run)
    at = 0.5 * length - FROM_JUNCTION_M
    return float(np.interp(at, x, fields["0/slip_m"])), 1e-3 * float(np.interp(at, *curve("slip")))


def inclined(run: Run) -> Pair:
    """Pressure of the start above the principal stress across the fracture: K_Ic/sqrt(pi a)."""
    (x0, y0), (x1, y1) = crack_ends(run)
    turn = math.atan2(y1 - y0, x1 - x0)
    c, s = math.cos(turn), math.sin(turn)
    horizontal, vertical, shear = (given(run, f"in_situ.{name}_Pa") for name in ("horizontal", "vertical", "shear"))
    across = horizontal * s * s + vertical * c * c + 2.0 * shear * s * c  # compression; sigma_xy is positive in tension's sense
    return start_of(run).inlet_Pa - across, given(run, "rock.shale.toughness_Pa_sqrt_m") / math.sqrt(math.pi * half_length(run))


def barrier(run: Run) -> Pair:
    """Pressure above the least stress at which the tip leaves a height."""
    own = column(run)
    least = min(own["stress_Pa"])
    return pressure_beyond(run, HALF_TALL_M) - least, value("layered_height", "pressure_to_pass_Pa", **own, height_m=HALF_TALL_M) - least


def shut_in_settings(run: Run) -> dict[str, float]:
    """The rock and the inlet's table as the reference takes them."""
    rows = run.scene["fluid"]["inlet"]["table"]
    own = {key: given(run, f"rock.sand.{key}") for key in ("toughness_Pa_sqrt_m", "leakoff_m_sqrt_s")}
    return rock(run, 0) | own | {"rate_m2_s": rows[0][1], "shut_in_s": rows[1][0]}


def fault_slip(run: Run) -> tuple[float, float]:
    """Half length of the fault, m, and its largest slip alone under the in-situ stress, 4 a (t - mu s)/E' (a crack under shear), m."""
    place = run.scene["strata"]["interfaces"][0]
    a = 0.5 * (place["to_m"] - place["from_m"])
    drop = given(run, "in_situ.shear_Pa") - given(run, "interface.fault.coefficient") * given(run, "in_situ.vertical_Pa")
    return a, 4.0 * a * drop / E_prime(run, 0)


def fault(run: Run) -> Pair:
    """Largest slip at the first output, where the fracture is closed and sticks."""
    slip = frames(run, "interfaces")[0][1]["0/slip_m"]
    return float(slip[np.argmax(np.abs(slip))]), fault_slip(run)[1]


def sudden(run: Run) -> Pair:
    """K_I some time before a wave comes back."""
    h, pressure = run.history, net_Pa(run)
    return float(np.interp(AT_S, h["time_s"], h["K_I_Pa_sqrt_m"])), value("freund_step_pressure", "K_I", pressure_Pa=pressure, time_s=AT_S, **rock(run, density=True))


SCENES = (
    Scene("kgd", "A fracture fed at a constant rate (KGD): how long is it?", "half length at 100 s", "m", 1.0, "strata-reference kgd", 0.03,
          lambda run: (upper(run).y_m, value("kgd", "half_length_m", time_s=run.summary.time_s, **fed(run)))),
    Scene("layers", "Height growth in a log: how high does a pressure drive it?", "growth of the upper tip by 41.1 MPa", "m", 1.0,
          "strata-reference layered_height", 0.034, layers),
    Scene("junction", "T-junction: how far does a crack with friction slide where a fracture ends on it?", "slip 5 m from the junction", "mm", 1e3,
          "Phan, Napier, Gray & Kaplan 2003", 0.04, junction),
    Scene("inclined", "Crossing at an angle: does a bedding plane with friction hold it?", "net pressure of the start", "MPa", 1e-6,
          "closed form, K_Ic/sqrt(pi a)", 0.01, inclined, ("slippery",)),
    Scene("barrier", "A stress barrier: which pressure drives it how far into it?", "net pressure that holds a height of 80 m", "MPa", 1e-6,
          "strata-reference layered_height", 0.005, barrier),
    Scene("shut_in", "Shut-in with leak-off: how fast does the pressure fall?", "net pressure 700 s after shut-in", "kPa", 1e-3,
          "strata-reference shut_in", 0.03,
          lambda run: (net_Pa(run), value("shut_in", "inlet_pressure_Pa", time_s=run.summary.time_s, **shut_in_settings(run)))),
    Scene("fault", "A fracture near a fault: how far does the fault slide?", "largest slip of the fault alone", "mm", 1e3,
          "closed form, 4 a (shear - friction x normal stress)/E'", 0.01, fault),
    Scene("sudden", "A suddenly loaded crack: how does K_I rise?", "K_I at 25 ms", "MPa sqrt(m)", 1e-6, "strata-reference freund_step_pressure", 0.01, sudden),
)  # fmt: skip
