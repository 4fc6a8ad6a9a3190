"""Studies of the program: from its files, or from dicts, with what `--json` prints as the result."""

from __future__ import annotations

import functools
import os
import pathlib
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from . import _core
from ._arguments import (
    callback, flag, mapping, optional_number, path, refused, text, threads_of, wrong_type,
)
from ._bench import logs_in, naming_rows
from ._operations import operation
from ._progress import shown
from ._study import without_place
from ._tables import metric_rows
from ._vehicle import Vehicle, keys_of, plain, vehicle_of

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray


class StudyResult(Mapping[str, Any]):
    """The result of a study: a mapping with the keys of `--json` of the corresponding command, in SI units.

    The keys are attributes as well, `result.status` for `result["status"]`. `print(result)` gives the program's report,
    which Python and notebooks also show.

    Examples
    --------
    >>> flight = wb.read("friction2022-battery").endurance()
    >>> flight["status"], flight.status, len(flight) > 5
    ('flapping', 'flapping', True)
    """

    def __init__(self, found: dict[str, Any]) -> None:
        self._values: dict[str, Any] = found["values"]
        self._text: str = found["text"]

    def __getitem__(self, key: str) -> Any:
        return self._values[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("_") and name in self._values:
            return self._values[name]
        raise AttributeError(f"{type(self).__name__!r} object has no attribute or key {name!r}")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._values})

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return self._text.rstrip("\n")


class Flight(StudyResult):
    """A flight to the end of the battery.

    Examples
    --------
    >>> flight = wb.read("friction2022-battery").endurance()
    >>> flight.trajectory.time.units
    's'
    """

    def __init__(self, found: dict[str, Any]) -> None:
        super().__init__(found)
        self._rows = found

    @property
    def trajectory(self) -> xarray.Dataset:
        """State of charge and the metrics of steady flapping over time [s], with units and long names."""
        import xarray

        def column(values: npt.NDArray[np.float64], unit: str, long_name: str) -> Any:
            return ("time", values, {"units": unit, "long_name": long_name})

        made = {
            row.name: column(values, row.unit, row.long_name)
            for row, values in zip(metric_rows, self._rows["metrics"])
            if not np.all(np.isnan(values))
        }
        made["charge"] = column(self._rows["charge"], "1", "state of charge")
        made["time"] = column(self._rows["time"], "s", "time since the start")
        return xarray.Dataset(made).set_coords("time")


class Identification(StudyResult):
    """A motor identified from its data sheet.

    Examples
    --------
    >>> print(wb.identify_motor("0816K003SR").motor.splitlines()[0])
    # Faulhaber 0816K003SR with a 20:1 gearbox
    """

    #: The section [motor] of a vehicle file, with what it rests on as comments; None where the sheet does not determine
    #: the motor.
    motor: str | None

    def __init__(self, found: dict[str, Any]) -> None:
        super().__init__(found)
        self.motor = found["motor"]


class Found(StudyResult):
    """A fit or an optimum.

    Examples
    --------
    >>> found = wb.fit("flapper", profiles=False)
    >>> found["converged"], found.vehicle.friction.type
    (True, 'load-proportional')
    """

    #: The vehicle that was found; None where none was.
    vehicle: Vehicle | None

    def __init__(self, found: dict[str, Any]) -> None:
        super().__init__(found)
        self.vehicle = None if found["design"] is None else Vehicle._of(found["design"])


Study = str | os.PathLike[str] | Mapping[str, Any]


def vehicle_first(name: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """For a function of a vehicle and a study, called `name`: it takes the study first and `vehicle=` as well."""

    def made(function: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(function)
        def call(*arguments: Any, **options: Any) -> Any:
            if not arguments and name in options:
                arguments = (options.pop(name),)
            if len(arguments) == 1 and "vehicle" in options:
                vehicle = options.pop("vehicle")
                arguments = arguments if vehicle is None else (vehicle_of(vehicle), *arguments)
            return function(*arguments, **options)

        return call

    return made


def vehicle_and_study(vehicle: Any, study: Any, name: str = "study") -> tuple[Vehicle | None, Any]:
    """The vehicle, None where the study names it, and the study."""
    if not isinstance(vehicle, Vehicle):
        if study is not None:
            raise wrong_type("vehicle", "a wingbeat.Vehicle", vehicle)
        return None, vehicle
    if study is None:
        raise TypeError(f"{name}: a vehicle needs a {name} beside it")
    return vehicle, study


def values_of(values: Mapping[str, Any] | None) -> list[str]:
    """Keys of the vehicle with other values, as a study takes them."""
    return [] if values is None else [f"{key}={_core.toml(value)}" for key, value in keys_of(values).items()]


@contextmanager
def file_of(study: Study, vehicle: Vehicle | None, section: str = "study") -> Iterator[bytes]:
    """The study as a file; of a dict, beside its vehicle in a temporary folder. `section` names the vehicle."""
    if not isinstance(study, Mapping):
        if not isinstance(study, (str, bytes, os.PathLike)):
            raise wrong_type(section, f"the path of a {section} file, or a dict of its tables", study)
        if vehicle is not None:
            raise TypeError(f"a {section} file names its vehicle; a vehicle can be given with a dict")
        if section == "bench" and os.fsdecode(study).lower().endswith((".csv", ".txt")):
            raise TypeError("a log needs the vehicle and what to fit: wingbeat.fit(vehicle, log, parameters={...})")
        yield path(section, study)
        return
    tables: dict[str, Any] = {**mapping(section, study)}
    tables[section] = dict(mapping(f"{section}.{section}", study.get(section, {})))
    with tempfile.TemporaryDirectory(prefix="wingbeat-") as folder, naming_rows(folder):
        if vehicle is not None:
            if "vehicle" in tables[section]:
                raise refused(f"{section}.vehicle", f"is given in the {section} and beside it")
            file = pathlib.Path(folder) / "vehicle.toml"
            file.write_text(vehicle_of(vehicle).to_toml(), encoding="utf-8")
            tables[section]["vehicle"] = str(file)
        if section == "bench" and "log" in tables:
            tables["log"] = logs_in(pathlib.Path(folder), tables["log"])
        name = pathlib.Path(folder) / f"{section}.toml"
        # The members of a table in braces are lines without them.
        lines = (_core.toml({key: plain(value, key)})[1:-1] for key, value in tables.items())
        name.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
        with without_place(str(name)):
            yield os.fsencode(name)


@operation
def endurance(vehicle: Vehicle, *, hover: bool = False, allow_extrapolation: bool = False) -> Flight:
    """How long a vehicle hovers and flaps on its battery: `wingbeat endurance`.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle, on a battery.
    hover : bool, default False
        Fly at the throttle that just carries the weight, as with `supply.throttle = "hover"`.
    allow_extrapolation : bool, default False
        Hover outside the model's domain counts.

    Returns
    -------
    Flight
        `flight["hover_s"]` and `flight["endurance_s"]` [s], and `flight.trajectory` over time.

    Raises
    ------
    InputError
        For a vehicle without a battery.

    Examples
    --------
    >>> flight = wb.endurance(wb.read("friction2022-battery"))
    >>> f"{flight['endurance_s']:.0f} s"
    '492 s'
    """
    options = flag("hover", hover), flag("allow_extrapolation", allow_extrapolation)
    return Flight(_core.endurance(vehicle_of(vehicle)._design, *options))


def identify_motor(
    sheet: str | os.PathLike[str],
    *,
    frequency: float | str | None = None,
    assume_steel_cylinder: bool = False,
    assume_typical_damping: bool = False,
    shaft: str = "output",
) -> Identification:
    """A motor's constants from its data sheet (TOML): `wingbeat identify-motor`.

    Parameters
    ----------
    sheet : path
        The path of the data sheet, or the name of a shipped one.
    frequency : float or str, optional
        The planned flapping frequency [Hz], for the remark about the inductance.
    assume_steel_cylinder : bool, default False
        If the sheet does not state the inertia, use that of a steel cylinder of the rotor's size.
    assume_typical_damping : bool, default False
        If the sheet does not determine the viscous loss, use that of a small coreless motor.
    shaft : str, default 'output'
        "output" or "motor": the shaft that the constants of `motor` refer to.

    Returns
    -------
    Identification
        The constants; if the sheet does not determine the motor, the result names the missing data.

    Raises
    ------
    InputError
        For an invalid sheet.

    Examples
    --------
    >>> found = wb.identify_motor("0816K003SR")
    >>> found["name"], found["complete"], "[motor]" in found.motor
    ('Faulhaber 0816K003SR with a 20:1 gearbox', True, True)
    """
    return Identification(
        _core.identify_motor(
            path("sheet", sheet),
            optional_number("frequency", frequency, "Hz"),
            flag("assume_steel_cylinder", assume_steel_cylinder),
            flag("assume_typical_damping", assume_typical_damping),
            text("shaft", shaft),
        )
    )


@overload
def tolerance(
    vehicle: Vehicle,
    study: Mapping[str, Any],
    *,
    values: Mapping[str, Any] | None = None,
    allow_extrapolation: bool = False,
    threads: int = 0,
    progress: bool | Callable[[int, int], object] | None = None,
) -> StudyResult: ...
@overload
def tolerance(
    study: Study,
    /,
    *,
    vehicle: Vehicle | None = None,
    values: Mapping[str, Any] | None = None,
    allow_extrapolation: bool = False,
    threads: int = 0,
    progress: bool | Callable[[int, int], object] | None = None,
) -> StudyResult: ...
@operation
@vehicle_first("study")
def tolerance(
    vehicle: Vehicle | Study,
    study: Mapping[str, Any] | None = None,
    *,
    values: Mapping[str, Any] | None = None,
    allow_extrapolation: bool = False,
    threads: int = 0,
    progress: bool | Callable[[int, int], object] | None = None,
) -> StudyResult:
    """How uncertain parameters affect a vehicle's metrics: `wingbeat tolerance`.

    Parameters
    ----------
    vehicle : Vehicle, path or dict
        A Vehicle; or the study alone, as the path of a study file (TOML), the name of a shipped one, or a dict of its
        tables, which names its vehicle.
    study : dict
        With a Vehicle: the tables of a study file, without a vehicle.
    values : dict, optional
        Values that replace those of the vehicle: SI numbers, or texts with a unit.
    allow_extrapolation : bool, default False
        Samples outside the model's domain count and may hover.
    threads : int, default 0
        Number of threads at most; 0: one for each core.
    progress : bool or function, optional
        True shows a bar (tqdm if it is installed), a function is called with the designs done and their total.

    Returns
    -------
    StudyResult
        The keys of `wingbeat tolerance --json`.

    Raises
    ------
    InputError
        For an invalid study.
    TypeError
        For a Vehicle without a study, and for a Vehicle together with a study file, which names its vehicle.

    Examples
    --------
    >>> spread = {"key": "friction.radius", "distribution": "normal", "relative_deviation": 0.05}
    >>> study = {"samples": {"count": 128}, "parameter": [spread]}
    >>> found = wb.tolerance(wb.read("friction2022"), study)
    >>> found["method"], [parameter["key"] for parameter in found["parameters"]]
    ('sobol', ['friction.radius'])
    """
    base, tables = vehicle_and_study(vehicle, study)
    overrides, extrapolate = values_of(values), flag("allow_extrapolation", allow_extrapolation)
    with file_of(tables, base) as file, shown(callback(progress), 0) as tell:
        return StudyResult(_core.tolerance(file, overrides, extrapolate, threads_of(threads), tell))
