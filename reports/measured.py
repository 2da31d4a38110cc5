"""Beside experiments: what runs of Rubin's fracture gave beside what was measured, and which way Wu's fracture had to go."""

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from reports.charts.records import draw_measured
from reports.figures import Figure, Table, Topic, words_of
from reports.words import NONE, Shown, minus, mpa, plain, share, wall_time
from verification.harness import store
from verification.harness.load import NoReference, reference
from verification.measured import rubin

DRAWN = ("plain", "closing_stress", "tough")  # the finest run of each
SCALES = {rubin.LENGTH: ("mm", 1e3), rubin.WELL: ("MPa", 1e-6), rubin.OPENING: ("µm", 1e6)}
BORDERS_M, STRESS_PA, TOUGHNESS = [-0.025, 0.025], [5.0e6, 7.0e6, 11.2e6], 1.2e6  # Wu et al. 2008, as verification/measured/README.md has them
HELD = 1e9  # a toughness that no tip passes


def topic(path: Path) -> Topic | None:
    """The section of the front page from the kept record; None where there is none."""
    record = store.read(rubin.Record, path)
    if record is None:
        return None
    data = measured_figure(record)
    tables = [table_of(record)]
    says = [f"{data.title}. {words_of('measured_method')}"]
    try:
        fronts = wu_fronts()
        says.append(words_of("wu", fronts=fronts, margin=min(one.up_Pa - one.down_Pa for one in fronts)))
        rows = [[minus(f"{one.bottom_mm:.0f} to {one.top_mm:.0f}"), mpa(one.down_Pa, 1), mpa(one.up_Pa, 1)] for one in fronts]
        tables.append(Table("Wu et al. 2008: pressure at which each tip of a front goes on", ["Front (mm)", "lower tip, into 5 MPa", "upper tip, into 11.2 MPa"], rows))
    except (NoReference, OSError):  # the program is not built: the rest is from records
        pass
    return Topic("measured", "Beside measurements", says, "ci/verify", record.version, Figure("measured", data, draw_measured, "measured", "ci/verify"), tables)


def wu_fronts() -> Sequence[Shown]:
    """Wu's fronts from the second on, lowest and highest points (mm), with the even pressures (Pa) at which a crack of plane strain between them goes on
    downwards and upwards, by strata-reference."""
    found = []
    for y in list(rubin.table("wu2008_fronts_mm").values())[1::2][-2::-1]:
        bottom, top = -float(np.nanmax(y)), -float(np.nanmin(y))
        down, up = (reference("layered_height", border_m=BORDERS_M, stress_Pa=STRESS_PA, toughness_Pa_sqrt_m=tough, bottom_m=1e-3 * bottom, top_m=1e-3 * top)["start_Pa"]
                    for tough in ([TOUGHNESS, HELD, HELD], [HELD, HELD, TOUGHNESS]))
        found.append(Shown(bottom_mm=bottom, top_mm=top, down_Pa=down.value, up_Pa=up.value))
    return found


def measured_figure(record: rubin.Record) -> Shown:
    """A panel a quantity: measured points, and the course of some runs, the finest of each."""
    finest = {one.name: one for one in record.results}
    panels = []
    for name, (unit, factor) in SCALES.items():
        at, values = rubin.measured(name)
        curves = [(plain(which), finest[which].curves["t_s"], [factor * value for value in finest[which].curves[name]]) for which in DRAWN if which in finest]
        lowered = [factor * (value - rubin.reading_without_fluid_Pa()) for value in values] if name == rubin.WELL else []
        panels.append(Shown(heading=name.capitalize(), unit=unit, times=list(at), points=[factor * value for value in values], lowered=lowered, curves=curves))
    return Shown(title=finding(finest), panels=panels, zero_MPa=1e-6 * rubin.reading_without_fluid_Pa(), from_s=rubin.LATE_S, cell_mm=1e3 * finest["plain"].cell_m)


def finding(finest: dict[str, rubin.Result]) -> str:
    """The plain run's errors, and that of the pressure were all gauges off by what one shows."""
    own = {name: share(finest["plain"].errors[name].late) for name in SCALES}
    zero = finest["gauges_from_zero"].errors[rubin.WELL].late
    return (f"Rubin's fracture in PMMA, mean error from {rubin.LATE_S:g} s on: length {own[rubin.LENGTH]}, opening {own[rubin.OPENING]}, "
            f"pressure {own[rubin.WELL]} ({share(zero)} if every gauge is off by what one of them shows without fluid)")


def table_of(record: rubin.Record) -> Table:
    """A row a variant and size: errors from 15 s on, and where the run is as long as the fracture was."""
    header = ["run", "what it does", "cells", *rubin.COLUMNS, "as long sooner by", "time"]
    rows = []
    for one in (*record.results, rubin.geos()):
        cells = [share(error.late) + (f" ({share(error.same_length)})" if math.isfinite(error.same_length) else "") for error in one.errors.values()]
        took = wall_time(one.wall_s) if math.isfinite(one.wall_s) else NONE
        rows.append([plain(one.name), one.says, f"{1e3 * one.cell_m:.2g} mm", *cells, minus(f"{one.early_s[0]:.1f} to {one.early_s[1]:.1f} s"), took])
    return Table(f"Rubin 1983: mean errors from {rubin.LATE_S:g} s on", header, rows, words_of("measured_note"))
