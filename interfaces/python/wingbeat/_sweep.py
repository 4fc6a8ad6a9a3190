"""Sweeps: all combinations of values of keys, as the data set that the program writes."""

from __future__ import annotations

import os
import tempfile
import threading
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._progress import shown
from ._result import quantity
from ._study import study_of, without_place
from ._vehicle import Vehicle

if TYPE_CHECKING:
    from ._accessor import SweepData


#: netCDF serves one thread at a time.
_writing = threading.Lock()


def sweep(
    vehicle: Vehicle,
    axes: Mapping[str, Any],
    *,
    output: str | os.PathLike[str] | None = None,
    frequency: float | str | None = None,
    tolerance: float = 1e-6,
    metrics: Iterable[str] | None = None,
    title: str = "",
    threads: int = 0,
    force: bool = False,
    progress: bool | Callable[[int, int], object] | None = None,
) -> SweepData:
    """The steady flapping of all combinations of values of keys, a dimension for each key.

    Parameters
    ----------
    axes : keys of the vehicle, "frequency", "condition" or "springs", each with its values: SI numbers, texts with
        units, names; the last varies fastest
    output : a file (.nc) that keeps the data set, as `wingbeat sweep -o` writes it: interrupted, the same call goes on
        from what is there. Without it nothing is left on the disk.
    frequency : [Hz], held by all designs: the voltage is found for each
    tolerance : wanted relative accuracy of every metric, 1e-12 to 1e-2
    metrics : those wanted; default: all that the vehicle has but hover and endurance
    threads : at most so many; 0: one for each core
    force : replaces a file that is not of this sweep
    progress : True shows a bar (tqdm where it is installed), a function is called with designs done and designs

    Returns the data set of docs/sweep.md: what the program writes, loaded. Its variables have the names of data sets,
    `data["lift_mean_n"]`, and `data["status"]` is a number; as attributes they are as here: `data.lift_mean`,
    `data.status == "flapping"`. Other Python threads run meanwhile; Ctrl-C ends it within a chunk. Raises
    InputError.
    """
    study = study_of(
        axes, title=title, tolerance=tolerance, metrics=metrics, frequency=quantity("frequency", frequency, "Hz")
    )
    total = int(np.prod([len(values) for values in axes.values()]))
    with _writing, without_place("sweep"), shown(progress, total) as tell:
        if output is not None:
            _core.sweep(study, vehicle._design, os.fspath(output), threads, force, tell)
            return open_dataset(output)
        with tempfile.TemporaryDirectory(prefix="wingbeat-") as folder:
            file = os.path.join(folder, "sweep.nc")
            _core.sweep(study, vehicle._design, file, threads, False, tell)
            return open_dataset(file)


def open_dataset(file: str | os.PathLike[str]) -> SweepData:
    """A data set that the program or `sweep` has written, loaded; attributes as those of what `sweep` returns."""
    import xarray

    from ._accessor import SweepData

    with xarray.open_dataset(file, decode_timedelta=False) as data:
        return SweepData.of(data.load())
