"""Records as JSON: dataclasses written whole or not at all, a record a line where asked; what is not finite is null."""

import dataclasses
import json
import math
import types
import typing
from collections.abc import Collection, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

T = TypeVar("T")

WIDTH = 120  # columns of a file's lines


def plain(value: Any, digits: int | None = None) -> Any:
    """A value as JSON holds it: dataclasses and names with values as tables, tuples and arrays as lists, numbers to so many digits, those that are not
    finite as None."""
    if dataclasses.is_dataclass(value):
        return {field.name: plain(getattr(value, field.name), digits) for field in dataclasses.fields(value)}
    if isinstance(value, (float, np.floating)):
        return (float(value) if digits is None else float(f"{value:.{digits}g}")) if math.isfinite(value) else None
    if isinstance(value, (Mapping, types.SimpleNamespace)):
        return {str(key): plain(item, digits) for key, item in (value if isinstance(value, Mapping) else vars(value)).items()}
    return [plain(item, digits) for item in value] if isinstance(value, (list, tuple, np.ndarray)) else value


@lru_cache(maxsize=None)
def _fields(kind: type) -> dict[str, Any]:
    """The types of a dataclass's fields."""
    hints = typing.get_type_hints(kind)
    return {field.name: hints[field.name] for field in dataclasses.fields(kind)}


def built(kind: Any, content: Any) -> Any:
    """The value of a type that `plain` made this of; null is NaN where a number is asked for. Raises KeyError, TypeError or ValueError for content of
    another shape; fields with defaults may be absent."""
    if dataclasses.is_dataclass(kind):
        known = _fields(typing.cast(type, kind))
        return kind(**{name: built(known[name], item) for name, item in content.items()})  # type: ignore[operator]
    origin, inner = typing.get_origin(kind), typing.get_args(kind)
    if origin in (typing.Union, types.UnionType):
        return None if content is None else built(next(item for item in inner if item is not type(None)), content)
    if origin is tuple:
        kinds = inner[:1] * len(content) if inner[1:] == (...,) else inner
        return tuple(built(item, one) for item, one in zip(kinds, content, strict=True))
    if origin is list:
        return [built(inner[0], item) for item in content]
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return {key: built(inner[1], item) for key, item in content.items()}
    if kind is float:
        return math.nan if content is None else float(content)
    return content


def read(kind: type[T], path: Path) -> T | None:
    """The record in a file; None where there is no file. Raises ValueError for one that cannot be understood."""
    if not path.is_file():
        return None
    try:
        return typing.cast(T, built(kind, json.loads(path.read_text(encoding="utf-8"))))
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise ValueError(f"{path}: {type(error).__name__}: {error}") from error


def text_of(content: Any, lines: Collection[str] = (), depth: int = 0) -> str:
    """A table as JSON: what fits into WIDTH columns stands on a line, and whatever its length what stands under `lines`, or, where that is a list, each
    of its items."""
    whole = json.dumps(content, allow_nan=False)
    if not isinstance(content, (dict, list)) or not content or (0 < depth and depth + len(whole) < WIDTH):
        return whole

    def under(name: str, value: Any) -> str:
        if name not in lines:
            return text_of(value, (), depth + 1)
        items = [json.dumps(item, allow_nan=False) for item in value] if isinstance(value, list) else []
        return "[\n  " + ",\n  ".join(items) + "\n ]" if items else json.dumps(value, allow_nan=False)

    table = isinstance(content, dict)
    rows = [f"{json.dumps(name)}: {under(name, value)}" for name, value in content.items()] if table else [text_of(item, (), depth + 1) for item in content]
    space = "\n" + " " * depth
    return f"{space} ".join(["{" if table else "[", f",{space} ".join(rows)]) + space + ("}" if table else "]")


def write(record: Any, path: Path, lines: Collection[str] = (), digits: int | None = None) -> Path:
    """Write a record (or a table) beside its place and move it there, laid out as by text_of."""
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(f"{path.name}.new")
    new.write_text(text_of(plain(record, digits), lines) + "\n", encoding="utf-8")
    new.replace(path)
    return path
