"""The section on what each experiment needs."""

from pathlib import Path

from reports.ablation import ablation_figure, topic
from verification.ablation.table import RECORDS, read_all


def test_the_section_has_a_column_a_scene_and_what_each_needs(tmp_path: Path) -> None:
    """The chart has a column for each whole table, the table a row for each; without records there is no section."""
    kept, found = read_all(RECORDS), topic(RECORDS)
    assert found is not None and topic(tmp_path) is None and len(found.tables[0].rows) == len(kept) > 6
    assert len(ablation_figure(kept).columns) == sum(one.extent != "interfaces" for one in kept)
    needed = [one for one in kept if one.needs()]
    assert needed and needed[0].needs()[0].label in str(found.tables[0].rows[kept.index(needed[0])][1])
