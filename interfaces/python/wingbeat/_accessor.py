"""Data sets of the program with the names of this package: `dataset.wingbeat`, and those that this package returns."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray

from ._tables import metrics, statuses
from ._vehicle import Vehicle


@xarray.register_dataset_accessor("wingbeat")  # type: ignore[no-untyped-call]
class DataSet:
    """Metrics by name (`dataset.wingbeat.lift_mean`), the status by name, and the vehicle of a data set."""

    def __init__(self, dataset: xarray.Dataset) -> None:
        self._dataset = dataset

    @property
    def status(self) -> xarray.DataArray:
        """"flapping", "stalled", ... of each design."""
        codes = self._dataset["status"]
        return codes.copy(data=np.array(statuses)[codes.values])

    @property
    def vehicle(self) -> Vehicle:
        """The vehicle that keys were varied of."""
        return Vehicle.from_toml(self._dataset.attrs["vehicle"], "vehicle of the data set")

    def __getattr__(self, name: str) -> xarray.DataArray:
        if name.startswith("_") or name not in metrics or metrics[name].key not in self._dataset:
            raise AttributeError(f"the data set has no metric {name!r}")
        return self._dataset[metrics[name].key]

    def __dir__(self) -> list[str]:
        own = (name for name, metric in metrics.items() if metric.key in self._dataset)
        return sorted({*object.__dir__(self), *own})


class SweepData(xarray.Dataset):  # type: ignore[no-untyped-call]
    """The data set of a sweep, with metrics by name, and the status by name, as attributes.

    `data["status"]` is the variable of the file, a number; `data.status == "flapping"` compares names.
    """

    __slots__ = ()

    @property
    def status(self) -> xarray.DataArray:
        """"flapping", "stalled", ... of each design."""
        return DataSet(self).status

    def __getattr__(self, name: str) -> Any:
        if name in metrics and metrics[name].key in self.variables:
            return self[metrics[name].key]
        return super().__getattr__(name)

    @classmethod
    def of(cls, dataset: xarray.Dataset) -> SweepData:
        """A copy with its variables, coordinates and attributes."""
        data = cls(dataset.data_vars, dataset.coords, dataset.attrs)
        data.encoding = dataset.encoding
        return data
