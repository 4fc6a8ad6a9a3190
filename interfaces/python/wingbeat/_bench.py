"""Logs of a test bench that are tables in memory, as the files that a fit reads."""

from __future__ import annotations

import csv
import math
import pathlib
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from ._arguments import is_masked, real, refused, text, wrong_type
from ._errors import InputError


def logs_in(folder: pathlib.Path, logs: Any) -> list[dict[str, Any]]:
    """The tables `log` of a bench file; their `data` are written to files in the folder."""
    if isinstance(logs, (str, Mapping)) or not hasattr(logs, "__iter__"):
        raise wrong_type("log", "a list of tables, one for each log", logs)
    made = []
    for place, log in enumerate(logs):
        if not isinstance(log, Mapping):
            raise wrong_type(f"log[{place}]", "a table such as {'data': frame, 'condition': 'air'}", log)
        table = dict(log)
        if "data" in table:
            if "file" in table:
                raise refused(f"log[{place}].data", "is given beside a file")
            file = folder / f"log-{place}.csv"
            _write(file, f"log[{place}].data", table.pop("data"))
            table["file"] = str(file)
        made.append(table)
    return made


def _write(file: pathlib.Path, name: str, data: Any) -> None:
    columns = _columns(name, data)
    lengths = {len(values) for values in columns.values()}
    if len(lengths) > 1:
        raise refused(name, "columns have different lengths")
    with file.open("w", encoding="utf-8", newline="") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*columns.values()))


def _columns(name: str, data: Any) -> dict[str, list[str]]:
    """The columns of a DataFrame, of a Dataset, or of a dict of arrays, each value as text."""
    if hasattr(data, "to_dataframe"):  # an xarray.Dataset
        data = data.to_dataframe().reset_index()
    names = getattr(data, "columns", None)
    if names is None:
        if not isinstance(data, Mapping):
            raise wrong_type(name, "a DataFrame, a Dataset or a dict of columns", data)
        names = data.keys()
    made: dict[str, list[str]] = {}
    for column in names:
        header = text(f"{name}: a column's name", column)
        if header in made:
            raise refused(name, f"has two columns {header!r}")
        values = data[column]
        if isinstance(values, str) or not hasattr(values, "__iter__"):
            raise wrong_type(f"{name}[{header!r}]", "an array", values)
        made[header] = [_cell(f"{name}[{header!r}]", value) for value in values]
    if not made:
        raise refused(name, "has no columns")
    return made


def _cell(name: str, value: Any) -> str:
    """Nothing for what is missing; numbers so that they are read back as they are."""
    if isinstance(value, str):
        return value
    if value is None or is_masked(value) or str(value) in ("<NA>", "NaT"):  # of pandas
        return ""
    number = real(value)
    if number is None:
        raise wrong_type(name, "numbers", value)
    return "" if math.isnan(number) else repr(number)


@contextmanager
def naming_rows(folder: str) -> Iterator[None]:
    """Errors about files that logs_in() has written, by log and row from 0 instead."""
    try:
        yield
    except InputError as error:
        raise _renamed(error, folder) from None


def _renamed(error: InputError, folder: str) -> InputError:
    def log(match: re.Match[str]) -> str:
        place, line = match[1], match[2]
        if line is None:
            return f"log[{place}].data"
        return f"log[{place}].data, " + ("column names" if line == "1" else f"row {int(line) - 2}")

    pattern = re.escape(folder) + r"/log-(\d+)\.csv(?::(\d+)(?::\d+)?)?"
    made = InputError(re.sub(pattern, log, str(error.args[0])))
    made.key = error.key
    if error.file is not None and not error.file.startswith(folder):
        made.file, made.line, made.column = error.file, error.line, error.column
    made.others = [_renamed(other, folder) for other in error.others]
    return made
