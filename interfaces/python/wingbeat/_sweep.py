"""Sweeps: all combinations of values of keys, as the data set that the program writes."""

from __future__ import annotations

import errno
import math
import os
import tempfile
import threading
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from . import _core
from ._arguments import (
    HELD, axis_values, callback, flag, held_by, mapping, number, path, refused, text, threads_of,
)
from ._errors import InputError
from ._operations import operation
from ._progress import shown
from ._study import study_of, without_place
from ._tables import parameters
from ._vehicle import Vehicle, vehicle_of

if TYPE_CHECKING:
    from ._accessor import SweepData


#: netCDF serves one thread at a time.
_writing = threading.Lock()


@operation
def sweep(
    vehicle: Vehicle,
    axes: Mapping[str, Any],
    *,
    output: str | os.PathLike[str] | None = None,
    frequency: float | str | None = None,
    lift: float | str | None = None,
    lift_to_weight: float | None = None,
    power: float | str | None = None,
    allow_extrapolation: bool = False,
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
    vehicle : Vehicle
        The vehicle whose keys are varied.
    axes : dict
        Keys of the vehicle, "frequency", "lift", "lift_to_weight", "power", "condition" or "springs", each with its
        values: SI numbers, texts with units, or names. The last one varies fastest.
    output : path, optional
        A file (.nc) that keeps the data set, as `wingbeat sweep -o` writes it. After an interruption the same call
        continues from this file. Without `output` no file remains.
    frequency : float or str, optional
        Flapping frequency of all designs [Hz]; the voltage of each is found.
    lift : float or str, optional
        Mean lift of all designs [N]; the lowest voltage for it is found.
    lift_to_weight : float, optional
        Lift over weight of all designs [1], likewise; 1: hover.
    power : float or str, optional
        Mean electrical power of all designs [W], likewise.
    allow_extrapolation : bool, default False
        A search for a lift may leave the model's domain.
    tolerance : float, default 1e-06
        Requested relative accuracy of every metric, 1e-12 to 1e-2.
    metrics : list of str, optional
        Names of the metrics to compute; default: all that the vehicle has but hover and endurance.
    title : str, default ''
        Title of the data set.
    threads : int, default 0
        Number of threads at most; 0: one for each core.
    force : bool, default False
        Replace a file of another sweep.
    progress : bool or function, optional
        True shows a bar (tqdm if it is installed), a function is called with the designs done and their total.

    Returns
    -------
    SweepData
        The data set that `wingbeat sweep` writes, loaded: an xarray.Dataset with a dimension for each key. Metrics are
        `data.lift_mean`, the variable `lift_mean_n` of the file; the status of each design is a text,
        `data.status == "flapping"`.

    Raises
    ------
    InputError
        For axes and options that are invalid, and for a file of another sweep.

    Notes
    -----
    Other Python threads run during the call; Ctrl-C ends it.

    Examples
    --------
    >>> vehicle = wb.read("friction2022")
    >>> data = wb.sweep(vehicle, {"supply.voltage": [3, 4], "transmission.crank_radius": ["5 mm", "6 mm"]})
    >>> data.lift_mean.dims
    ('supply_voltage', 'transmission_crank_radius')
    >>> bool((data.status == "flapping").all())
    True
    """
    design, threads, replaces = vehicle_of(vehicle)._design, threads_of(threads), flag("force", force)
    values = {key: axis_values(key, along, _unit(key)) for key, along in mapping("axes", axes).items()}
    hold = held_by(frequency=frequency, lift=lift, lift_to_weight=lift_to_weight, power=power)
    for name in hold:
        if name in values:
            raise refused(name, "is an axis, and held beside it")
    study = study_of(
        values,
        title=text("title", title),
        tolerance=number("tolerance", tolerance, "1"),
        metrics=metrics,
        hold=hold,
        anywhere=flag("allow_extrapolation", allow_extrapolation),
    )
    total = math.prod(len(along) for along in values.values())
    kept = None if output is None else path("output", output)
    with _writing, without_place("sweep"), shown(callback(progress), total) as tell:
        if kept is not None:
            _core.sweep(study, design, kept, threads, replaces, tell)
            return open_dataset(os.fsdecode(kept))
        with tempfile.TemporaryDirectory(prefix="wingbeat-") as folder:
            file = os.path.join(folder, "sweep.nc")
            _core.sweep(study, design, os.fsencode(file), threads, False, tell)
            return open_dataset(file)


def _unit(key: str) -> str:
    return HELD.get(key) or (parameters[key].unit if key in parameters else "")


def open_dataset(file: str | os.PathLike[str]) -> SweepData:
    """Loads a data set written by the program or by `sweep`, with the attributes of the result of `sweep`.

    Parameters
    ----------
    file : path
        The path of the file (.nc).

    Returns
    -------
    SweepData
        The data set, with metrics and the status by name as from `sweep`.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    InputError
        For a file that is not a NetCDF file.

    Examples
    --------
    >>> import os, tempfile
    >>> vehicle = wb.read("friction2022")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = os.path.join(folder, "sweep.nc")
    ...     data = vehicle.sweep({"supply.voltage": [3, 4]}, output=file)
    ...     bool((wb.open_dataset(file).lift_mean == data.lift_mean).all())
    True
    """
    import xarray

    from ._accessor import SweepData

    name = os.fsdecode(path("file", file))
    if not os.path.exists(name):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), name)
    try:
        opened = xarray.open_dataset(name, engine="netcdf4", decode_timedelta=False)
    except OSError as error:
        raise InputError(f"{name}: is not a NetCDF file: {error.strerror or error}") from None
    with opened as data:
        return SweepData._of(data.load())
