"""Logs of a test bench that are tables in memory, as the files that a fit reads."""

from __future__ import annotations

import csv
import math
import os
import pathlib
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from ._arguments import flag, is_masked, mapping, path, real, refused, text, wrong_type
from ._errors import InputError
from ._tables import metrics, waveforms


def bench_of(data: Any, *, parameters: Any, deviation: Any, condition: Any, springs: Any, loss: Any) -> Any:
    """The tables of a bench file for data and what else `wingbeat.fit` is given; a path of a bench file stays one."""
    if isinstance(data, (str, os.PathLike)) and os.fspath(data).endswith(".toml"):
        return data
    tables: dict[str, Any]
    if isinstance(data, Mapping) and {"log", "parameter"} & set(data):
        for name, value in (("condition", condition), ("springs", springs)):
            if value is not None:
                raise refused(name, "belongs to each log, where a bench is given as a dict of its tables")
        tables = dict(data)
    else:
        tables = {"log": [_log(log, condition, springs) for log in _logs(data)]}
    for name, given, table in (("parameter", "parameters", _parameters(parameters)),
                               ("deviation", "deviation", _deviations(deviation))):
        if table is not None and name in tables:
            raise refused(given, "is given in the bench and beside it")
        if table is not None:
            tables[name] = table
    if "parameter" not in tables:
        raise TypeError("parameters: expected what to fit, such as {'friction.radius': ('0 mm', '8 mm')}, got none")
    tables.setdefault("deviation", {"default": "estimated"})
    if loss is not None:
        tables["fit"] = {**tables.get("fit", {}), "loss": text("loss", loss)}
    return tables


def _logs(data: Any) -> list[Any]:
    return list(data) if isinstance(data, (list, tuple)) else [data]


def _log(log: Any, condition: Any, springs: Any) -> dict[str, Any]:
    """A table `log` of a bench file for a table of measurements, the path of one, or such a table."""
    if isinstance(log, (str, os.PathLike)):
        made: dict[str, Any] = {"file": os.path.abspath(os.fsdecode(path("data", log)))}
    elif isinstance(log, Mapping) and {"data", "file"} & set(log):
        made = dict(log)
        if isinstance(made.get("file"), (str, os.PathLike)):
            made["file"] = os.path.abspath(os.fspath(made["file"]))
    else:
        made = {"data": log}
    made.setdefault("condition", "air" if condition is None else text("condition", condition))
    if springs is not None:
        made.setdefault("springs", flag("springs", springs))
    return made


def _parameters(parameters: Any) -> list[Any] | None:
    """The tables `parameter` of a bench file for bounds by key, or for a list of such tables."""
    if parameters is None:
        return None
    if isinstance(parameters, (list, tuple)) and all(isinstance(one, Mapping) for one in parameters):
        return list(parameters)
    expected = "bounds by key, such as {'friction.radius': ('0 mm', '8 mm')}, or a list of tables"
    made = []
    for key, bounds in mapping("parameters", parameters, expected).items():
        if isinstance(bounds, Mapping):
            made.append({"key": key, **bounds})
        elif isinstance(bounds, (list, tuple)) and len(bounds) in (2, 3):
            made.append({"key": key, **dict(zip(("lower", "upper", "start"), bounds))})
        else:
            raise wrong_type(f"parameters[{key!r}]", "(lower, upper) or (lower, upper, start)", bounds)
    return made


def _deviations(deviation: Any) -> dict[str, Any] | None:
    """The table `deviation` of a bench file: numbers are relative, texts absolute."""
    if deviation is None:
        return None
    if not isinstance(deviation, Mapping):
        return {"default": _deviation("deviation", deviation)}
    found = {name: _deviation(f"deviation[{name!r}]", value) for name, value in mapping("deviation", deviation).items()}
    return {"default": "estimated", **found}


def _deviation(name: str, value: Any) -> Any:
    if isinstance(value, Mapping) or value == "estimated":
        return value
    if isinstance(value, str):
        return {"absolute": value}
    relative = real(value)
    if relative is None:
        raise wrong_type(name, 'a number relative to each value, a text such as "0.1 Hz", or "estimated"', value)
    return {"relative": relative}


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
        data = _frame(data)
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


def _frame(data: Any) -> Any:
    """The variables and coordinates of a Dataset as a DataFrame; quantities of the package with the units that they
    state, as headers of logs have them. Dimensions that only count are left out, and so are statuses."""
    data = data.drop_vars([name for name in data.coords if name not in data.dims and data[name].dtype.kind in "OU"])
    frame = data.to_dataframe().reset_index()
    frame = frame.drop(columns=[name for name in data.dims if name not in data.coords])
    units = {name: data[name].attrs.get("units") for name in data.variables if name in metrics or name in waveforms}
    return frame.rename(columns={name: f"{name} [{unit}]" for name, unit in units.items() if unit and unit != "1"})


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
