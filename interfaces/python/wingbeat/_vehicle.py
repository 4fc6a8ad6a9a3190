"""A vehicle: the values of its keys."""

from __future__ import annotations

import math
import os
import pathlib
import re
import tomllib
from collections.abc import Iterator, Mapping
from typing import IO, Any

import numpy as np

from . import _core
from ._arguments import array, mapping, number, path, real, refused, text, wrong_type
from ._methods import VehicleMethods
from ._quantity import Quantity
from ._sections import Sections, sections
from ._tables import parameters


def plain(value: Any, key: str = "value") -> Any:
    """A value of that key as the compiled half takes it: a number, True, False, a text, a list or a dict."""
    if type(value) is float:  # most of long arrays
        return value
    if isinstance(value, Quantity) and value.unit != "1" and math.isfinite(value):
        return f"{float(value)!r} {value.unit}"  # so that its unit is checked, or converted
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    if isinstance(value, str):
        return text(key, value)
    if isinstance(value, Mapping):
        return {text("key", k): plain(v, key) for k, v in mapping(key, value).items()}
    if isinstance(value, int) and abs(value) < 2**53:
        return int(value)
    as_real = real(value)
    if as_real is not None:
        return as_real
    if isinstance(value, np.ma.MaskedArray):
        value = array(key, value)
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(each, key) for each in value]
    raise wrong_type(key, "a number, a text with a unit, a table or rows", value)


def keys_of(values: Mapping[str, Any]) -> dict[str, Any]:
    """The plain value of each key; sections may be given as tables, {"motor": {"inertia": ...}}."""
    made: dict[str, Any] = {}

    def assign(key: str, value: Any) -> None:
        if not re.fullmatch("[A-Za-z0-9_.-]+", key):
            raise refused(ascii(key), "unknown key")
        if key in made:
            raise refused(key, "is given twice")
        made[key] = plain(value, key)

    for key, value in mapping("values", values).items():
        if isinstance(value, Mapping) and "." not in key:
            for name, inner in mapping(key, value).items():
                assign(f"{key}.{name}", inner)
        else:
            assign(key, value)
    return made


class Vehicle(VehicleMethods, Sections):
    """A vehicle, by the keys of vehicle files: `Vehicle({"motor": {"inertia": "1.5e-7 kg m2", ...}, ...})`.

    Values are SI numbers or texts with a unit ("5 mm"); sections may be nested tables or dotted keys. Keys are
    attributes, `vehicle.motor.inertia`, and items, `vehicle["motor.inertia"]`; `wingbeat.parameters` describes them. A
    vehicle never changes: `replace` makes another one. Equal vehicles have equal values; they can be pickled, and be
    keys of a dict. `to_toml` writes a vehicle file that reads back exactly.

    Parameters
    ----------
    values : dict
        The keys with their values, nested by section or with dots.

    Raises
    ------
    InputError
        For invalid keys and values, with all errors.
    TypeError
        If `values` is not a dict.

    Examples
    --------
    >>> vehicle = wb.read("friction2022")
    >>> vehicle.motor.inertia, vehicle["transmission.crank_radius"]
    (1.5e-07 kg m2, 0.005 m)
    >>> other = wb.Vehicle(vehicle.to_dict() | {"vehicle": {"name": "copy", "mass": "3.34 g"}})
    >>> other.name, other == vehicle
    ('copy', False)
    """

    __slots__ = ("_design", "_toml")
    _design: _core.Design
    _toml: str | None

    def __init__(self, values: Mapping[str, Any]) -> None:
        if not isinstance(values, Mapping):
            raise TypeError(f"values: expected a dict of keys, got {type(values).__name__}; wingbeat.read reads files")
        self._take(_core.with_values(keys_of(values), None))

    def _take(self, design: _core.Design) -> None:
        object.__setattr__(self, "_design", design)
        object.__setattr__(self, "_toml", None)

    @classmethod
    def _of(cls, design: _core.Design) -> Vehicle:
        made = cls.__new__(cls)
        made._take(design)
        return made

    @classmethod
    def from_toml(cls, toml: str, name: str = "vehicle") -> Vehicle:
        """The vehicle in the text of a vehicle file, which contains all tables.

        Parameters
        ----------
        toml : str
            The text of the file.
        name : str, default 'vehicle'
            The name of the text in messages.

        Returns
        -------
        Vehicle
            Its values are SI, with their units.

        Raises
        ------
        InputError
            With line and column of all errors.

        Examples
        --------
        >>> with open("data/designs/friction2022.toml") as file:
        ...     vehicle = wb.Vehicle.from_toml(file.read())
        >>> vehicle.wing.count
        2.0
        """
        return cls._of(_core.parse(text("toml", toml), text("name", name)))

    def to_toml(self) -> str:
        """The complete vehicle file, which reads back as an equal vehicle.

        Returns
        -------
        str
            The text, in TOML, with a unit beside each number.

        Examples
        --------
        >>> vehicle = wb.read("friction2022")
        >>> wb.Vehicle.from_toml(vehicle.to_toml()) == vehicle
        True
        """
        if self._toml is None:
            object.__setattr__(self, "_toml", self._design.to_toml())
        assert self._toml is not None
        return self._toml

    def to_dict(self) -> dict[str, Any]:
        """The sections as nested dicts for `Vehicle`, with numbers as texts with units.

        Returns
        -------
        dict
            A dict for each section.

        Examples
        --------
        >>> wb.read("friction2022").to_dict()["supply"]
        {'type': 'constant', 'voltage': '3 V'}
        """
        return tomllib.loads(self.to_toml())

    def replace(self, values: Mapping[str, Any]) -> Vehicle:
        """The vehicle with other values of these keys; alternatives (hinge_offset, stroke_amplitude) replace each other.

        Parameters
        ----------
        values : dict
            The keys with their values, nested by section or with dots: SI numbers, or texts with a unit.

        Returns
        -------
        Vehicle
            A new vehicle; this one does not change.

        Raises
        ------
        InputError
            For invalid keys and values, with all errors.

        Examples
        --------
        >>> vehicle = wb.read("friction2022")
        >>> vehicle.replace({"transmission.crank_radius": "6 mm"}).transmission.crank_radius
        0.006 m
        """
        return Vehicle._of(_core.with_values(keys_of(values), self._design))

    __replace__ = replace

    def __getitem__(self, key: str) -> Any:
        parameter = parameters.get(key)
        if parameter is None:
            if key in sections:
                return sections[key](self)
            raise KeyError(f"there is no key {key!r}")
        value = self._design.value(key)
        if value is None and parameter.always:
            value = _core.quantity(key, parameter.default, parameter.unit)
        if isinstance(value, float):
            return Quantity(value, parameter.unit, parameter.meaning)
        return value if value is not None else self._table(key)

    def _table(self, key: str) -> Any:
        """The rows of a table, or None."""
        if parameters[key].unit:
            return None
        found: Any = self.to_dict()
        for part in key.split("."):
            found = found.get(part) if isinstance(found, dict) else None
        return found

    def keys(self) -> list[str]:
        """The keys that `to_toml` writes; alternatives to them also have values.

        Returns
        -------
        list of str
            With their sections: "motor.inertia".

        Examples
        --------
        >>> "supply.voltage" in wb.read("friction2022").keys()
        True
        """
        made: list[str] = []

        def enter(table: Mapping[str, Any], start: str) -> None:
            for name, value in table.items():
                if isinstance(value, Mapping):
                    enter(value, f"{start}{name}.")
                else:
                    made.append(start + name)

        enter(self.to_dict(), "")
        return made

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError("vehicles do not change; vehicle.replace({...}) is another one")

    @property
    def name(self) -> str:
        """The name, or ""."""
        return str(self._design.value("vehicle.name") or "")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Vehicle):
            return NotImplemented
        return self.to_toml() == other.to_toml()

    def __hash__(self) -> int:
        return hash(self.to_toml())

    def __copy__(self) -> Vehicle:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Vehicle:
        return self

    def __reduce__(self) -> tuple[Any, tuple[str]]:
        return _restored, (self.to_toml(),)

    def __repr__(self) -> str:
        return f"<wingbeat.Vehicle {self.name!r}>"

    def drawing(self, stroke_amplitude: float | str = 1.0) -> str:
        """Its mechanism as SVG; "" if gnuplot is not installed.

        Parameters
        ----------
        stroke_amplitude : float or str, default 1.0
            Stroke amplitude of a direct drive [rad]; a crank has its own.

        Returns
        -------
        str
            The SVG.

        Raises
        ------
        InputError
            For an angle that is not finite.

        Examples
        --------
        >>> drawing = wb.read("friction2022").drawing()
        >>> drawing.startswith("<svg") or drawing == ""
        True
        """
        svg = _core.mechanism_svg(self._design, number("stroke_amplitude", stroke_amplitude, "rad"))
        return svg[max(0, svg.find("<svg")) :]

    def _repr_html_(self) -> str:
        from html import escape

        def shown_value(key: str) -> str:
            value = self[key]
            if isinstance(value, Quantity):
                return f"{value:.6g} {'' if value.unit == '1' else value.unit}"
            shown = str(value)
            return shown if len(shown) < 80 else f"{shown[:76]} ..."

        rows = "".join(
            f"<tr><td style='text-align:left'><code>{escape(key)}</code></td>"
            f"<td style='text-align:left'>{escape(shown_value(key))}</td></tr>"
            for key in self.keys()
            if key != "vehicle.name"
        )
        drawing = self.drawing()
        shown = f"<div style='max-width: 28em'>{drawing}</div>" if drawing else ""
        return f"<p><b>{escape(self.name or 'vehicle')}</b></p>{shown}<table>{rows}</table>"


def vehicle_of(value: Any, name: str = "vehicle") -> Vehicle:
    """A Vehicle."""
    if not isinstance(value, Vehicle):
        raise wrong_type(name, "a wingbeat.Vehicle", value)
    return value


def _restored(toml: str) -> Vehicle:
    return Vehicle.from_toml(toml)


def read(file: str | os.PathLike[str] | IO[str]) -> Vehicle:
    """Reads a vehicle file (TOML), by its path, by the name of one that comes with the package, or as an open file.

    CSV files that it names are sought in its folder; an open file must contain all tables.

    Parameters
    ----------
    file : path or text file
        The path of the file, with or without ".toml"; the name of a shipped vehicle (`wingbeat.shipped`), unless there
        is a file of that name; or a file open for reading text.

    Returns
    -------
    Vehicle
        Its values are SI, with their units.

    Raises
    ------
    InputError
        With file, line and column of all errors; for a name that is neither a file nor a shipped vehicle.
    TypeError
        For an argument that is neither a path nor an open file.

    Examples
    --------
    >>> wb.read("friction2022").supply.voltage
    3.0 V
    >>> wb.read("data/designs/friction2022.toml") == wb.read("friction2022")
    True
    """
    if isinstance(file, (str, bytes, os.PathLike)):
        return Vehicle._of(_core.read(path("file", file)))
    toml = file.read() if hasattr(file, "read") else None
    if not isinstance(toml, str):
        raise wrong_type("file", "a path or a file open for reading text", file)
    name = getattr(file, "name", None)
    return Vehicle.from_toml(toml, name if isinstance(name, str) else "vehicle")


def shipped(kind: str = "vehicle") -> list[str]:
    """The names of files that come with the package, for `read` and the studies.

    Parameters
    ----------
    kind : str, default 'vehicle'
        "vehicle" (for `read`), "study" (for `optimise` and `tolerance`), "bench" (for `fit`) or "datasheet" (for
        `identify_motor`).

    Returns
    -------
    list of str
        The names, sorted.

    Raises
    ------
    InputError
        For another kind of file.

    Examples
    --------
    >>> "friction2022" in wb.shipped(), wb.shipped("bench")[0]
    (True, 'flapper')
    """
    return _core.shipped_names(text("kind", kind))


#: Installed with the package; a link in a build folder.
_DATA = pathlib.Path(__file__).with_name("data")
if (_DATA / "designs").is_dir():
    _core.set_shipped_data(os.fsencode(_DATA))
