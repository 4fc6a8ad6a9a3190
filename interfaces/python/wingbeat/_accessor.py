"""Data sets of the program with the names of this package: `dataset.wingbeat`, and those that this package returns."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
import xarray

from ._tables import metrics, statuses
from ._vehicle import Vehicle

#: Where a design has no status, because it was masked or lies outside the data.
_NO_CODE = -1


def _names_of(codes: Any) -> Any:
    """Statuses by name, "" where there is none, of codes as files have them; names stay as they are."""
    given = np.asarray(codes)
    if given.dtype.kind in "OU":
        names = [name if isinstance(name, str) else "" for name in given.ravel()]
        return np.array(names, dtype=str).reshape(given.shape)
    found = np.nan_to_num(given.astype(float), nan=_NO_CODE).astype(int)
    return np.array([*statuses, ""])[np.where((found >= 0) & (found < len(statuses)), found, len(statuses))]


def _codes_of(names: Any) -> Any:
    """The code of each status, as files have it."""
    known = {name: code for code, name in enumerate(statuses)}
    found = [known.get(name, _NO_CODE) for name in _names_of(names).ravel()]
    return np.array(found, dtype=np.int8).reshape(np.shape(names))


def _is_status(name: Any) -> bool:
    """Whether a variable has statuses: of the designs of a sweep, of an optimum, ..."""
    return isinstance(name, str) and (name == "status" or name.endswith("_status"))


def _statuses_in(dataset: xarray.Dataset) -> list[str]:
    """The variables of statuses: numbers with the meanings that files have, or texts."""
    meanings = " ".join(statuses)
    return [
        str(name) for name, variable in dataset.variables.items()
        if _is_status(name) and (variable.dtype.kind in "OU" or variable.attrs.get("flag_meanings") == meanings)
    ]


def status_of(dataset: xarray.Dataset) -> xarray.DataArray:
    """The status of each design, "flapping", "stalled", ..., in a data set of this package or a file opened by
    xarray."""
    status = dataset["status"]
    return status.copy(data=_names_of(status.values))


@xarray.register_dataset_accessor("wingbeat")  # type: ignore[no-untyped-call]
class DataSet:
    """Metrics by name (`dataset.wingbeat.lift_mean`), the status by name, and the vehicle of a data set."""

    def __init__(self, dataset: xarray.Dataset) -> None:
        self._dataset = dataset

    @property
    def status(self) -> xarray.DataArray:
        """"flapping", "stalled", ... of each design, "" where it was masked."""
        return status_of(self._dataset)

    @property
    def vehicle(self) -> Vehicle:
        """The vehicle whose keys were varied."""
        return Vehicle.from_toml(self._dataset.attrs["vehicle"], "vehicle of the data set")

    def __getattr__(self, name: str) -> xarray.DataArray:
        if name.startswith("_") or name not in metrics or metrics[name].key not in self._dataset:
            raise AttributeError(f"the data set has no metric {name!r}")
        return self._dataset[metrics[name].key]

    def __dir__(self) -> list[str]:
        own = (name for name, metric in metrics.items() if metric.key in self._dataset)
        return sorted({*object.__dir__(self), *own})


class SweepData(xarray.Dataset):  # type: ignore[no-untyped-call]
    """The data set of a sweep, an `xarray.Dataset` with metrics by the names of this package.

    `data.lift_mean`, or `data["lift_mean"]`, is the variable `lift_mean_n` of the file. The status of each design,
    "flapping", "stalled", ..., is a coordinate of the data set, which selections, `where` and arithmetic keep:
    `data.status` and `data["status"]` are the same texts. `interp` and `coarsen`, whose results lie between designs,
    drop it. `to_netcdf` writes it as a number, `status_code`, as files of the program have it.

    Methods and operators of a SweepData return a SweepData. Other functions of xarray (`rolling`, `xarray.merge`) may
    return a plain data set; there `dataset.wingbeat` has the same names.

    Examples
    --------
    >>> data = wb.read("friction2022").sweep({"supply.voltage": [0, 3, 4]})
    >>> data.status.values.tolist()
    ['stalled', 'flapping', 'flapping']
    >>> lifting = data.where(data.lift_mean > 0.01)
    >>> lifting.lift_mean.round(4).values, lifting.status.values.tolist()
    (array([   nan,    nan, 0.0159]), ['stalled', 'flapping', 'flapping'])
    >>> (1e3 * data).sel(supply_voltage=4).status.item()
    'flapping'
    """

    __slots__ = ()

    @property
    def status_code(self) -> xarray.DataArray:
        """The status of each design as a number, as in files, 0 for flapping: the index in the list of statuses."""
        codes: xarray.DataArray = self["status"].copy(data=_codes_of(self["status"].values))
        return codes

    def __getattr__(self, name: str) -> Any:
        if name in metrics and metrics[name].key in self.variables:
            return self[metrics[name].key]
        return super().__getattr__(name)

    def __getitem__(self, key: Any) -> Any:
        if isinstance(key, list):
            key = [self._variable(name) for name in key]
        found = super().__getitem__(self._variable(key))
        if isinstance(found, xarray.DataArray):
            # An array with texts beside its numbers could not be interpolated, nor be taken means of blocks of.
            return found.drop_vars([name for name in found.coords if _is_status(name)])
        return _again(found)

    def _variable(self, name: Any) -> Any:
        """The name of a variable, also by that of a metric."""
        if isinstance(name, str) and name in metrics and name not in self.variables:
            return metrics[name].key if metrics[name].key in self.variables else name
        return name

    def __dir__(self) -> list[str]:
        own = (name for name, metric in metrics.items() if metric.key in self.variables)
        return sorted({*super().__dir__(), *own})

    @classmethod
    def _of(cls, dataset: xarray.Dataset) -> SweepData:
        """The data set of a file of the program: its variables, coordinates and attributes, the status by name."""
        data = cls(dataset.data_vars, dataset.coords, dataset.attrs)
        data.encoding = dataset.encoding
        numbers = ("units", "flag_values", "flag_meanings")
        for name in _statuses_in(data):
            given = data.variables[name]
            kept = {key: value for key, value in given.attrs.items() if key not in numbers}
            data = data.assign_coords({name: (given.dims, _names_of(given.values), kept)})
        return data

    def to_netcdf(self, *arguments: Any, **options: Any) -> Any:
        """As `xarray.Dataset.to_netcdf`; the status is written as a number, as the program does and reads it.

        Parameters
        ----------
        *arguments, **options
            Those of `xarray.Dataset.to_netcdf`; the first is the path.

        Returns
        -------
        object
            The result of `xarray.Dataset.to_netcdf`.

        Examples
        --------
        >>> import os, tempfile
        >>> data = wb.read("friction2022").sweep({"supply.voltage": [3, 4]})
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     data.to_netcdf(os.path.join(folder, "sweep.nc"))
        ...     wb.open_dataset(os.path.join(folder, "sweep.nc")).identical(data)
        True
        """
        plain = xarray.Dataset(self.data_vars, self.coords, self.attrs)
        flags = {"flag_values": np.arange(len(statuses), dtype=np.int8), "flag_meanings": " ".join(statuses)}
        for name in _statuses_in(plain):
            given = plain.variables[name]
            kept: dict[str, Any] = {"units": "1", **given.attrs, **flags}
            plain = plain.reset_coords(name).assign({name: (given.dims, _codes_of(given.values), kept)})
        return plain.to_netcdf(*arguments, **options)


def _again(found: Any) -> Any:
    """A SweepData for a plain data set."""
    if type(found) is not xarray.Dataset:
        return found
    data = SweepData(found.data_vars, found.coords, found.attrs)
    data.encoding = found.encoding
    return data


def _keeping(method: Callable[..., Any]) -> Callable[..., Any]:
    """A method of data sets that returns a SweepData where it has made a plain data set."""

    @functools.wraps(method)
    def call(self: SweepData, *arguments: Any, **options: Any) -> Any:
        return _again(method(self, *arguments, **options))

    return call


def _mapped(method: Callable[..., Any]) -> Callable[..., Any]:
    """A method that makes its data set of arrays, which have no status."""

    @functools.wraps(method)
    def call(self: SweepData, *arguments: Any, **options: Any) -> Any:
        found = _again(method(self, *arguments, **options))
        status = self.variables.get("status")
        if status is None or any(found.sizes.get(dimension) != size for dimension, size in status.sizes.items()):
            return found
        return found.assign_coords(status=status)

    return call


def _between(method: Callable[..., Any]) -> Callable[..., Any]:
    """A method that gives numbers between designs, where there is no status."""

    @functools.wraps(method)
    def call(self: SweepData, *arguments: Any, **options: Any) -> Any:
        return _again(method(self.drop_vars("status", errors="ignore"), *arguments, **options))

    return call


_OPERATORS = {f"__{prefix}{name}__" for prefix in ("", "r", "i") for name in (
    "add", "sub", "mul", "truediv", "floordiv", "mod", "pow", "and", "or", "xor")}
_OPERATORS |= {f"__{name}__" for name in (
    "lt", "le", "gt", "ge", "eq", "ne", "neg", "pos", "abs", "invert", "array_ufunc")}

_OTHERS = {"map": _mapped, "apply": _mapped, "interp": _between, "interp_like": _between, "coarsen": _between}

for _name, _method in inspect.getmembers(xarray.Dataset, inspect.isfunction):
    if _name not in vars(SweepData) and (not _name.startswith("_") or _name in _OPERATORS):
        setattr(SweepData, _name, _OTHERS.get(_name, _keeping)(_method))
