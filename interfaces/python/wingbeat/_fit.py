"""Fits of a vehicle to measurements of a test bench."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, overload

from . import _core
from ._arguments import flag, threads_of
from ._bench import bench_of
from ._operations import operation
from ._studies import Found, Study, file_of, values_of, vehicle_and_study, vehicle_first
from ._vehicle import Vehicle


@overload
def fit(
    vehicle: Vehicle,
    data: Any,
    *,
    parameters: Mapping[str, Any] | Sequence[Mapping[str, Any]] | None = None,
    deviation: float | str | Mapping[str, Any] | None = None,
    condition: str | None = None,
    springs: bool | None = None,
    loss: str | None = None,
    values: Mapping[str, Any] | None = None,
    profiles: bool = True,
    compare_friction: bool = False,
    threads: int = 0,
) -> Found: ...
@overload
def fit(
    bench: Study,
    /,
    *,
    vehicle: Vehicle | None = None,
    values: Mapping[str, Any] | None = None,
    profiles: bool = True,
    compare_friction: bool = False,
    threads: int = 0,
) -> Found: ...
@operation
@vehicle_first("bench")
def fit(
    vehicle: Vehicle | Study,
    data: Any = None,
    *,
    parameters: Mapping[str, Any] | Sequence[Mapping[str, Any]] | None = None,
    deviation: float | str | Mapping[str, Any] | None = None,
    condition: str | None = None,
    springs: bool | None = None,
    loss: str | None = None,
    values: Mapping[str, Any] | None = None,
    profiles: bool = True,
    compare_friction: bool = False,
    threads: int = 0,
) -> Found:
    """A vehicle's parameters from bench measurements, with their uncertainty: `wingbeat fit`.

    Parameters
    ----------
    vehicle : Vehicle, path or dict
        A Vehicle with the start values of the fit; or only a bench, as the path of a bench file (TOML), the name of a
        shipped one, or a dict of its tables, which names its vehicle.
    data : DataFrame, xarray.Dataset, dict, path or list, optional
        With a Vehicle: the measurements, a table with a row for each operating point, in memory or as a CSV file.
        Columns are named with their units as in logs: "voltage_V" or "frequency_Hz" for the set quantity,
        "current_mean_mA", "Lift (g)" and so on for measured ones; a Dataset may have metrics by name with
        `attrs["units"]`. A NaN or NA is left out. Give several logs as a list, each a table or a dict such as `{"data":
        frame, "condition": "vacuum"}` with the keys of `[[log]]` in bench files. A dict of the tables of a bench file
        is also accepted.
    parameters : dict or list of dict, optional
        The fitted keys with their bounds: `{"friction.radius": ("0 mm", "8 mm")}`, SI numbers or texts with a unit; a
        third value is the start value, instead of the vehicle's. A list holds tables `[[parameter]]` of bench files.
        Needed unless `data` are the tables of a bench file.
    deviation : float, str or dict, optional
        Standard deviation of the measured values: a number is relative to each value [1]; "estimated" (the default)
        uses the residuals, which needs at least six more values than parameters in each column. A dict has one for each
        column, `{"default": 0.01, "frequency": "0.1 Hz"}`, where a text with a unit is absolute.
    condition : str, optional
        Where `data` were measured: "air" (the default), "vacuum" or "wingless". A log of a list may state its own.
    springs : bool, optional
        Whether the springs were on; needed with a vehicle that has springs.
    loss : str, optional
        Robust loss against outliers: "none" (the default), "huber", "soft-l1" or "cauchy".
    values : dict, optional
        Values that replace those of the vehicle: SI numbers, or texts with a unit.
    profiles : bool, default True
        Compute intervals from profiles; False uses only the curvature, which is faster.
    compare_friction : bool, default False
        Also fit each friction law.
    threads : int, default 0
        Number of threads at most; 0: one for each core. The result does not depend on it.

    Returns
    -------
    Found
        The keys of `wingbeat fit --json`, and the vehicle with the fitted values.

    Raises
    ------
    InputError
        For invalid measurements, parameters or options.
    TypeError
        For a Vehicle without data, and for data or parameters of another kind.

    Notes
    -----
    Other Python threads run during the call; Ctrl-C ends it.

    Examples
    --------
    >>> air = {"voltage_V": [2, 3, 4], "frequency_Hz": [16.0, 22.0, 27.5], "current_mean_mA": [110, 180, 253]}
    >>> vehicle = wb.read("friction2022")
    >>> found = wb.fit(vehicle, air, parameters={"friction.radius": ("0 mm", "8 mm")}, deviation=0.01)
    >>> found["converged"], f"{1e3 * found.vehicle.friction.radius:.2f} mm"
    (True, '2.48 mm')

    A bench file has all of it, vehicle and logs included:

    >>> found = wb.fit("flapper", profiles=False)
    >>> f"{1e3 * found.vehicle.friction.radius:.2f} mm"
    '2.48 mm'
    """
    base, measured = vehicle_and_study(vehicle, data, "bench")
    asked = {"parameters": parameters, "deviation": deviation, "condition": condition, "springs": springs, "loss": loss}
    if base is not None:
        measured = bench_of(measured, **asked)
    else:
        for name, value in asked.items():
            if value is not None:
                raise TypeError(f"{name}: is for data of a vehicle; a bench has its own")
    options = flag("profiles", profiles), flag("compare_friction", compare_friction), threads_of(threads)
    with file_of(measured, base, "bench") as file:
        return Found(_core.fit(file, values_of(values), *options))
