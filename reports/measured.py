"""The part of the page of verification on experiments: what runs gave beside what was measured, and what each thing that a run may lack is worth."""

import math
from pathlib import Path

from reports.charts.measured import draw_measured
from reports.figures import Figure, Section, Table, words_of
from reports.shown import Shown
from reports.words import NONE, minus, plain, share, wall_time
from verification.harness import store
from verification.measured import rubin

DRAWN = ("plain", "closing_stress", "tough")  # the finest run of each
SCALES = {rubin.LENGTH: ("mm", 1e3), rubin.WELL: ("MPa", 1e-6), rubin.OPENING: ("µm", 1e6)}


def section(runs: Path) -> Section | None:
    """The part of the page from the record beside the folder of runs; None where there is none."""
    return section_of(store.read(rubin.Record, runs.parent / rubin.RECORD.relative_to(rubin.HERE.parents[1])))


def section_of(record: rubin.Record | None) -> Section | None:
    """The part of the page from a record."""
    if record is None:
        return None
    data = measured_figure(record)
    return Section(title="Beside an experiment", intro=f"{data.title}. {words_of('measured_method')}",
                   figures=[Figure("measured", data, draw_measured, "measured")], tables=[table_of(record)])


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
            f"pressure {own[rubin.WELL]}, {share(zero)} if every gauge has the zero of the one that shows it")


def table_of(record: rubin.Record) -> Table:
    """A row a variant and size: errors from 15 s on, and where the run is as long as the fracture was."""
    header = ["run", "what it does", "cells", *rubin.COLUMNS, "as long sooner by", "time"]
    rows = []
    for one in (*record.results, rubin.geos()):
        cells = [share(error.late) + (f" ({share(error.same_length)})" if math.isfinite(error.same_length) else "") for error in one.errors.values()]
        took = wall_time(one.wall_s) if math.isfinite(one.wall_s) else NONE
        rows.append([plain(one.name), one.says, f"{1e3 * one.cell_m:.2g} mm", *cells, minus(f"{one.early_s[0]:.1f} to {one.early_s[1]:.1f} s"), took])
    return Table(title=f"Mean errors from {rubin.LATE_S:g} s on", header=header, rows=rows, note=words_of("measured_note", version=record.version))
