"""What pages are made of, whichever page it is: figures as declarations, and what writes them with their data, captions and commands."""

import json
import re
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import jinja2

from reports import words
from reports.charts.style import ONE_COLUMN, TWO_COLUMNS, save
from reports.runs import NotAvailable, Run
from reports.words import Shown, mechanics_name
from verification.harness.store import plain

FILTERS = {"mechanics": mechanics_name, **{name: getattr(words, name) for name in ("listed", "metres", "mpa", "plain", "share", "wall_time")}}
OUT, TEMPLATES = (Path(__file__).resolve().parent / name for name in ("out", "templates"))
DIGITS = 7  # of numbers in a figure's data


@dataclass(frozen=True)
class Figure:
    """A figure: what is drawn (with the finding as its title) or prepares that, what draws it at a width in mm, the part of templates/words.md that is
    its caption, and the command that makes what it shows. Its files are out/figures/NAME.svg, .pdf and .json, and NAME_one_column.svg and .pdf."""

    name: str
    data: Shown | Callable[[], Shown]
    draw: Callable[[Shown, float], Any]
    caption: str
    command: str
    label: str = ""
    runs: Sequence[Run] = ()  # those drawn, whose marks the caption tells
    narrow: bool = True  # whether it is drawn one column wide as well


@dataclass(frozen=True)
class Table:
    """A table in words behind a click."""

    title: str
    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    note: str = ""


@dataclass(frozen=True)
class Topic:
    """A short section of the front page, from records that are kept: what was found, a figure, tables behind a click, and which version and command
    the records are of; `page` is the page that has all of it."""

    name: str
    title: str
    says: Sequence[str]
    command: str
    version: str
    figure: Figure | None = None
    tables: Sequence[Table] = ()
    shown: Table | None = None  # that stands in the open
    page: str = ""


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


def suspect_words(runs: Sequence[Run]) -> list[str]:
    """The runs of a figure that mark themselves as suspect, each with why."""
    return [f"Experiment {run.number} {words.plain(run.variant)}, {mechanics_name(run.mechanics)}: {'; '.join(run.marks)}" for run in runs if run.marks]


def make(figure: Figure, out: Path) -> Shown:
    """Write a figure's files below a page's folder; whatever is missing or wrong is told on the page and stops nothing."""
    made = Shown(name=figure.name, label=figure.label, command=figure.command, narrow=figure.narrow, title="", caption="", suspect=[], lack="", defect="")
    try:
        data = figure.data() if callable(figure.data) else figure.data
        for width_mm, ending in ((TWO_COLUMNS, ""), (ONE_COLUMN, "_one_column"))[: 1 + figure.narrow]:
            save(figure.draw(data, width_mm), *(out / "figures" / f"{figure.name}{ending}.{kind}" for kind in ("svg", "pdf")))
        (out / "figures" / f"{figure.name}.json").write_text(json.dumps(plain(data, DIGITS), default=str), encoding="utf-8")
        made.title, made.caption, made.suspect = data.title, words_of(figure.caption, data=data), suspect_words(figure.runs)
    except NotAvailable as missing:
        made.lack = str(missing)
    except Exception as error:  # a defect in one figure must not cost the reader all the others
        made.lack, made.defect = f"could not be drawn: {type(error).__name__}: {error}", traceback.format_exc()
    return made


def write_page(out: Path, name: str, content: dict[str, Any]) -> Path:
    """Write a page from the template of its name."""
    loader = jinja2.FileSystemLoader(TEMPLATES)
    environment = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True)
    environment.filters |= FILTERS
    out.mkdir(parents=True, exist_ok=True)
    (out / name).write_text(environment.get_template(name).render(content | {"index": (out / "index.html").is_file()}), encoding="utf-8")
    return out / name


def told_of(name: str, write: Callable[[], Shown], sorry: str) -> Shown:
    """What is told of a page: its name, its `words`, and `lack` or `defect` where it, or a part of it, could not be written."""
    try:
        return Shown(**{"name": name, "words": "", "lack": "", "defect": "", **vars(write())})
    except Exception as error:  # a torn file must not cost the reader the other pages
        return Shown(name=name, words="", lack=f"{sorry}: {type(error).__name__}: {error}", defect=traceback.format_exc())
