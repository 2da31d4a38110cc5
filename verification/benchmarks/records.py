"""What was measured, kept as a line of JSON a record in a file a machine."""

import json
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from verification.benchmarks.figure import Figure
from verification.benchmarks.machine import Build, Load, Machine
from verification.harness.store import built, plain

RECORDS = Path(__file__).parent / "records"
FORMAT = 1
DIGITS = 5  # of stored numbers


class OtherMachine(Exception):
    """A record of another machine: its figures say nothing about this one."""


class BadRecord(Exception):
    """A file of records that cannot be read; the message says where."""


@dataclass(frozen=True)
class Record:
    """Figures with where, when and of what they were taken."""

    machine: Machine
    build: Build
    load: Load
    date: str
    figures: tuple[Figure, ...]
    part: bool = False  # only some of the figures were asked for, or in fewer repetitions
    marks: tuple[dict[str, Any], ...] = ()  # what the figures reach, for other readers

    def figure(self, name: str) -> Figure | None:
        """A figure by its name."""
        return next((figure for figure in self.figures if figure.name == name), None)


def file_of(machine: Machine, folder: Path = RECORDS) -> Path:
    """The file that a machine's records are in."""
    return folder / f"{machine.key}.jsonl"


def as_json(record: Record) -> str:
    """A record as one line; with each figure what is made of its repetitions, for other readers."""
    content = plain(record, DIGITS)
    for kept, figure in zip(content["figures"], record.figures):
        kept |= plain({name: getattr(figure, name) for name in ("median", "spread", "calibrated", "share_of_peak")}, DIGITS)
    return json.dumps({"format": FORMAT, **content}, allow_nan=False)


def from_json(line: str, where: str = "record") -> Record:
    """A record from its line."""
    own = {item.name for item in fields(Figure)}
    try:
        content = json.loads(line)
        if content.pop("format") != FORMAT:
            raise BadRecord(f"{where}: format {json.loads(line)['format']}, not {FORMAT}")
        content["figures"] = [{key: value for key, value in figure.items() if key in own} for figure in content["figures"]]
        return built(Record, content)
    except (ValueError, KeyError, TypeError) as error:
        raise BadRecord(f"{where}: {type(error).__name__}: {error}") from error


def load_records(path: Path) -> list[Record]:
    """All records of a file, the oldest first; none where there is no file."""
    lines = path.read_text(encoding="utf-8").splitlines() if path.is_file() else []
    return [from_json(line, f"{path}:{number}") for number, line in enumerate(lines, 1) if line.strip()]


def last_record(machine: Machine, folder: Path = RECORDS) -> Record | None:
    """The last record of a machine; raises OtherMachine where its file holds one of another."""
    found = load_records(file_of(machine, folder))
    if not found:
        return None
    check_machine(machine, found[-1].machine)
    return found[-1]


def check_machine(here: Machine, there: Machine) -> None:
    """Raises OtherMachine where two are not the same."""
    if here != there:
        raise OtherMachine(f"the record is of {there.cpu}, {there.cores} cores, {there.caches}; "
                           f"this machine is {here.cpu}, {here.cores} cores, {here.caches}")  # fmt: skip


def broken(record: Record) -> list[str]:
    """Names of what is no figure; experiments that do not come to their end in time are a finding and not broken."""
    return [figure.name for figure in record.figures if figure.wrong() and not (figure.problem and figure.name.startswith("experiments/"))]


def why_not_recorded(record: Record) -> list[str]:
    """What speaks against keeping a record: a busy machine, a part only, figures that are none."""
    reasons = [record.load.noisy, "only a part of the figures was taken" if record.part else "",
               f"these are no figures: {', '.join(broken(record)[:5])}" if broken(record) else ""]  # fmt: skip
    return [reason for reason in reasons if reason]


def append(record: Record, folder: Path = RECORDS) -> Path:
    """Add a record to its machine's file; returns the file."""
    path = file_of(record.machine, folder)
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", encoding="utf-8") as stream:
        stream.write(as_json(record) + "\n")
    return path
