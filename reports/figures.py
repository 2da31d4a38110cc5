"""What pages are made of, whichever page it is: figures as declarations, tables and parts as plain data; and what writes them."""

import re
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, NotRequired, TypedDict

import jinja2

from reports.charts.style import save
from reports.runs import NotAvailable, Run
from reports.shown import Shown
from reports.words import listed, mechanics_name, metres, mpa, plain, share

FILTERS = {"listed": listed, "mechanics": mechanics_name, "metres": metres, "mpa": mpa, "plain": plain, "share": share}
OUT, TEMPLATES = (Path(__file__).resolve().parent / name for name in ("out", "templates"))


@dataclass(frozen=True)
class Figure:
    """A figure: files out/figures/NAME.svg and .png, what is drawn (with the finding as its title) or prepares that, what draws it,
    and the part of templates/words.md that is its caption."""

    name: str
    data: Shown | Callable[[], Shown]
    draw: Callable[[Shown], Any]
    caption: str
    label: str = ""
    experiment: int = 0  # 0: of no single experiment
    part: str = ""  # where on the page of the experiments: "method", "experiment", "energy", "choice" or "variants"
    runs: Sequence[Run] = ()  # those drawn, whose marks the caption tells


class Table(TypedDict):
    """A table in words. `marked`: numbers of the rows (from 0) that fall short; `note` stands below the table."""

    title: str
    header: list[str]
    rows: list[list[str]]
    marked: NotRequired[list[int]]
    note: NotRequired[str]


class Section(TypedDict):
    """A part of a page: what was found (a sentence or two, from the data) in `intro`, then figures, then tables."""

    title: str
    intro: str
    figures: list[Figure]
    tables: list[Table]


@lru_cache(maxsize=None)
def _texts() -> dict[str, jinja2.Template]:
    """The parts of templates/words.md by their names."""
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined)
    environment.filters |= FILTERS
    _, *parts = re.split(r"^## (\w+)\n", (TEMPLATES / "words.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    return {name: environment.from_string(text) for name, text in zip(parts[::2], parts[1::2])}


def words_of(name: str, **given: Any) -> str:
    """A part of templates/words.md on one line, with what is given put in."""
    return re.sub(r"[ \n]+", " ", _texts()[name].render(given)).strip(" ")


def suspect_words(runs: Sequence[Run]) -> str:
    """A sentence that names the runs of a figure that mark themselves as suspect, with why; nothing where none does."""
    words = [f"Experiment {run.number} {plain(run.variant)}, {mechanics_name(run.mechanics)}: {'; '.join(run.marks)}" for run in runs if run.marks]
    return f" Suspect runs: {'. '.join(words)}." if words else ""


def make(figure: Figure, out: Path) -> Shown:
    """Write a figure's files below a page's folder; whatever is missing or wrong is told on the page and stops nothing."""
    made = Shown(name=figure.name, label=figure.label, experiment=figure.experiment, part=figure.part, title="", caption="", lack="", defect="")
    try:
        data = figure.data() if callable(figure.data) else figure.data
        save(figure.draw(data), out / "figures", figure.name)
        made.title, made.caption = data.title, words_of(figure.caption, data=data) + suspect_words(figure.runs)
    except NotAvailable as missing:
        made.lack = str(missing)
    except Exception as error:  # a defect in one figure must not cost the reader all the others
        made.lack, made.defect = f"could not be drawn: {type(error).__name__}: {error}", traceback.format_exc()
    return made


def write_page(out: Path, name: str, content: dict[str, Any]) -> Path:
    """Write a page from the template of its name (index.html: page.html)."""
    loader = jinja2.FileSystemLoader(TEMPLATES)
    environment = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True)
    environment.filters |= FILTERS
    out.mkdir(parents=True, exist_ok=True)
    (out / name).write_text(environment.get_template("page.html" if name == "index.html" else name).render(content), encoding="utf-8")
    return out / name


def told_of(name: str, write: Callable[[], Shown], sorry: str) -> Shown:
    """What is told of a page: its name, its `words`, and `lack` or `defect` where it, or a part of it, could not be written."""
    try:
        return Shown(**{"name": name, "words": "", "lack": "", "defect": "", **vars(write())})
    except Exception as error:  # a torn file must not cost the reader the other pages
        return Shown(name=name, words="", lack=f"{sorry}: {type(error).__name__}: {error}", defect=traceback.format_exc())
