"""The part of the page beside an experiment."""

from dataclasses import replace

from reports.measured import section_of
from verification.measured import rubin


def test_the_page_has_points_curves_and_a_row_a_run() -> None:
    """Twelve points a panel, a curve for each run that is drawn, a row a result and one of GEOS; the finding follows the record."""
    kept = rubin.kept()
    assert kept is not None and section_of(None) is None
    section = section_of(kept)
    assert section is not None
    data, (table,) = section["figures"][0].data, section["tables"]
    assert [len(panel.points) for panel in data.panels] == [12, 12, 12] and all(len(panel.curves) == 3 for panel in data.panels)
    assert len(table["rows"]) == len(kept.results) + 1 and table["rows"][-1][0] == "GEOS"
    plain = kept.results[-2]
    worse = replace(plain, errors=plain.errors | {rubin.LENGTH: replace(plain.errors[rubin.LENGTH], late=0.5)})
    other = section_of(replace(kept, results=(*kept.results[:-2], worse, kept.results[-1])))
    assert other is not None and "length 50\u00a0%" in other["intro"] and "length 50\u00a0%" not in section["intro"]
