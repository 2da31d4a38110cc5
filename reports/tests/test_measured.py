"""The section beside measurements."""

from dataclasses import replace
from pathlib import Path

from reports.measured import topic, wu_fronts
from verification.harness import store
from verification.measured import rubin


def test_the_section_has_points_curves_and_a_row_a_run(tmp_path: Path) -> None:
    """Twelve points a panel, a curve for each run that is drawn, a row a result and one of GEOS; the finding follows the record."""
    kept, section = rubin.kept(), topic(rubin.RECORD)
    assert kept is not None and section is not None and section.figure is not None and topic(tmp_path / "none.json") is None
    data, table = section.figure.data, section.tables[0]
    assert [len(panel.points) for panel in data.panels] == [12, 12, 12] and all(len(panel.curves) == 3 for panel in data.panels)
    assert len(table.rows) == len(kept.results) + 1 and table.rows[-1][0] == "GEOS"
    plain = kept.results[-2]
    worse = replace(plain, errors=plain.errors | {rubin.LENGTH: replace(plain.errors[rubin.LENGTH], late=0.5)})
    store.write(replace(kept, results=(*kept.results[:-2], worse, kept.results[-1])), tmp_path / "rubin.json")
    assert "length 50\u00a0%" in topic(tmp_path / "rubin.json").says[0] and "length 50\u00a0%" not in section.says[0]


def test_wu_s_fronts_go_on_where_the_stress_is_less() -> None:
    """Four fronts in the order of time: as verification/measured/README.md has them."""
    found = wu_fronts()
    assert [round(one.bottom_mm) for one in found] == [-46, -95, -133, -164] and all(one.up_Pa - one.down_Pa > 2.0e6 for one in found)
