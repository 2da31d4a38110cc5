"""The part of the page on what each experiment needs."""

from reports.ablation import ablation_figure, section_of, verdict_words
from verification.ablation.table import read_all


def test_the_page_has_a_table_a_scene_and_reasons() -> None:
    """The chart has a column for each whole table; an experiment's own reason stands before that of all beside what is not needed."""
    kept = read_all()
    section = section_of(kept, {})
    assert section is not None and len(section["tables"]) == len(kept) and section_of([], {}) is None
    assert len(ablation_figure(kept).columns) == sum(one.extent != "interfaces" for one in kept)
    table, line = next((one, line) for one in kept for line in one.spared(True) if not line.id[-1].isdigit())
    assert verdict_words(line, table, {"all": {line.id: "of all"}}).endswith("of all")
    assert verdict_words(line, table, {"all": {line.id: "of all"}, table.experiment: {line.id: "its own"}}).endswith("its own")
