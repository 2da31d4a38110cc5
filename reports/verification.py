"""The page of verification: every comparison of the accuracy ladder, as last run or last accepted."""

from pathlib import Path
from typing import Any

from reports.charts.ladder import draw_convergence
from reports.figures import Figure, make, told_of, words_of, write_page
from reports.ladder import family_shown, load_ladder
from reports.words import Shown, counted

NAME = "verification.html"


def write_verification(out: Path, ladder_file: Path, gates: Path) -> Shown:
    """Write verification.html from ladder.json, or from what was last accepted; told: its name, headline and defects."""
    return told_of(NAME, lambda: _write(out, load_ladder(ladder_file, gates)), "The accuracy ladder's judgement could not be read")


def _write(out: Path, ladder: Shown | None) -> Shown:
    """The page and its figures."""
    if ladder is None:
        return Shown(lack="neither a judgement of the accuracy ladder nor gates")
    shown = ladder_context(ladder, out)
    write_page(out, NAME, shown)
    return Shown(words=shown["headline"], defect="\n".join(one.figure.defect for one in shown["families"] if one.figure and one.figure.defect))


def headline(ladder: Shown) -> str:
    """What the ladder found, in a sentence or two."""
    rows = ladder.rows
    wrong = sum(not row.passed for row in rows)
    cases, families = len({(row.family, row.case) for row in rows}), len({row.family for row in rows})
    of_what = f"{len(rows)} comparisons with references ({counted(cases, 'case')} in {counted(families, 'family')})"
    if not rows:
        return "No case of the accuracy ladder has been run."
    if ladder.accepted:
        return f"{of_what}: the errors that were last accepted. ci/verify measures them again."
    if wrong == 0:
        return f"All {of_what} are within their gates."
    return f"Of {of_what}, {wrong} {'is' if wrong == 1 else 'are'} not as {'its gate asks' if wrong == 1 else 'their gates ask'}."


def ladder_context(ladder: Shown, out: Path) -> dict[str, Any]:
    """What the template shows of the ladder; its figures are written below `out`."""
    families = [family_shown(ladder, family) for family in ladder.families]
    for one in families:
        one.figure = one.data and make(Figure(f"ladder_{one.name}", one.data, draw_convergence, "convergence", f"ci/verify --family {one.name}", narrow=False), out)
    return {"ladder": ladder, "mutation": words_of("mutation", tally=ladder.tally) if ladder.tally else "", "families": families, "headline": headline(ladder),
            "wrong_words": [f"{row.family} / {row.case}: {row.quantity} at {row.level} {row.verdict}: {row.why}" for row in ladder.rows if not row.passed],
            "stale_words": [f"A gate of nothing: {words}" for words in ladder.stale], "rows": [(one.title, one.comparisons, f"{one.finding}.") for one in families]}
