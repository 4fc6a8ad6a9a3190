"""The sections of a vehicle, made from the table of parameters; _sections.pyi has their types."""

from __future__ import annotations

from typing import Any

from ._tables import parameters


class Section:
    """A section of a vehicle: its keys are attributes, numbers in SI with their units, None where there is no value.

    Examples
    --------
    >>> motor = wb.read("friction2022").motor
    >>> motor.torque_constant, motor.gear_efficiency
    (0.01 N m/A, 1.0)
    """

    __slots__ = ("_vehicle",)
    _vehicle: Any
    _path = ""
    _names: tuple[str, ...] = ()

    def __init__(self, vehicle: Any) -> None:
        object.__setattr__(self, "_vehicle", vehicle)

    def __setattr__(self, name: str, value: Any) -> None:
        key = f"{self._path}.{name}"
        raise AttributeError(f"vehicles do not change; vehicle.replace({{{key!r}: ...}}) is another one")

    def __dir__(self) -> list[str]:
        return list(self._names)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Section):
            return NotImplemented
        return self._path == other._path and self._values() == other._values()

    def __hash__(self) -> int:
        return hash((self._path, repr(self._values())))

    def __reduce__(self) -> tuple[type[Section], tuple[Any]]:
        return type(self), (self._vehicle,)

    def _values(self) -> list[Any]:
        return [getattr(self, name) for name in self._names]

    def __repr__(self) -> str:
        values = ((name, getattr(self, name)) for name in self._names)
        shown = ", ".join(f"{name}={value!r}" for name, value in values if value is not None)
        return f"{self._path}({shown})"


def class_name(path: str) -> str:
    """WingPlanformSection for wing.planform."""
    return "".join(part.capitalize() for name in path.split(".") for part in name.split("_")) + "Section"


def members(path: str) -> list[str]:
    """The paths of what stands in a section, "" for the vehicle: keys and sections, in the order of the table."""
    start = f"{path}." if path else ""
    found = (key[len(start) :].split(".")[0] for key in parameters if key.startswith(start))
    return [start + name for name in dict.fromkeys(found)]


def _property(path: str, doc: str) -> property:
    return property(lambda self: self._vehicle[path], doc=doc)


def _make(path: str, made: dict[str, type[Section]]) -> None:
    """The class of a section and those within it."""
    properties: dict[str, Any] = {}
    for member in members(path):
        if member not in parameters:  # a key that is a section as well, aerodynamics.coefficients, is the key
            _make(member, made)
        doc = parameters[member].doc if member in parameters else f"The section [{member}]."
        properties[member.rsplit(".", 1)[1]] = _property(member, doc)
    names = tuple(properties)
    made[path] = type(class_name(path), (Section,), {"__slots__": (), "_path": path, "_names": names, **properties})


#: The class of each section by its path.
sections: dict[str, type[Section]] = {}
for _path in members(""):
    _make(_path, sections)
globals().update({made.__name__: made for made in sections.values()})


class Sections:
    """The sections at the top as attributes."""

    __slots__ = ()


for _path in members(""):
    setattr(
        Sections,
        _path,
        property(lambda self, made=sections[_path]: made(self), doc=f"The section [{_path}]."),  # type: ignore[misc]
    )
