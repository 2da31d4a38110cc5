"""The part of the page on what each experiment needs."""

from reports.ablation import ablation_figure, section_of, verdict_words
from verification.ablation import store
from verification.ablation.effects import not_needed


def test_the_page_has_a_table_a_scene() -> None:
    """The chart has a column for each whole table; reasons stand beside what is not needed."""
    kept = store.read_all()
    section = section_of(kept, {})
    assert section is not None and len(section["tables"]) == len(kept)
    figure = ablation_figure(kept)
    assert len(figure.columns) == sum(one.extent != "interfaces" for one in kept)
    assert section_of([], {}) is None


def test_what_is_kept_without_need_has_its_reason_beside_it() -> None:
    """The verdict of such a line ends in the reason, an experiment's own before that of all."""
    table, line = next(
        (one, line) for one in store.read_all() for line in not_needed(one.lines, one.cpu_s) if not line.id[-1].isdigit()
    )  # of a numbered one the reason is that of all numbers
    assert verdict_words(line, table, {"all": {line.id: "of all"}}).endswith("of all")
    assert verdict_words(line, table, {"all": {line.id: "of all"}, table.experiment: {line.id: "its own"}}).endswith("its own")
