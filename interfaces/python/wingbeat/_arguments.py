"""What callers may give: of the wrong type it is a TypeError, of the wrong value an InputError, each with its name."""

from __future__ import annotations

import math
import operator
import os
from collections.abc import Iterable, Iterator, Mapping
from decimal import Decimal
from numbers import Real
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from . import _core
from ._errors import InputError
from ._quantity import Quantity

if TYPE_CHECKING:
    import numpy.typing as npt

#: More threads than any machine has.
_MAX_THREADS = 4096


class Table(Protocol):
    """What a DataFrame of pandas has, among others."""

    @property
    def columns(self) -> Any: ...
    def __getitem__(self, key: Any, /) -> Any: ...
    def __iter__(self) -> Iterator[Any]: ...


#: An array for each key.
Columns = Mapping[str, Any] | Table

#: What a voltage can be found for, and its unit.
HELD = {"frequency": "Hz", "lift": "N", "lift_to_weight": "1", "power": "W"}


def wrong_type(name: str, expected: str, value: object) -> TypeError:
    """A TypeError for an argument."""
    return TypeError(f"{name}: expected {expected}, got {type(value).__name__}")


def refused(name: str, message: str) -> InputError:
    """An InputError about an argument or a key."""
    error = InputError(f"{name}: {message}")
    error.key = name
    return error


def flag(name: str, value: Any) -> bool:
    """True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise wrong_type(name, "True or False", value)
    return bool(value)


def whole(name: str, value: Any, least: int, greatest: int) -> int:
    """A whole number."""
    if isinstance(value, (bool, np.bool_)):
        raise wrong_type(name, "a whole number", value)
    try:
        number = operator.index(value)
    except TypeError:
        raise wrong_type(name, "a whole number", value) from None
    if not least <= number <= greatest:
        raise refused(name, f"must be a whole number from {least} to {greatest}, got {number}")
    return number


def threads_of(value: Any) -> int:
    """A number of threads; 0: one for each core."""
    return whole("threads", value, 0, _MAX_THREADS)


def text(name: str, value: Any) -> str:
    """A text that can be written down."""
    if not isinstance(value, str):
        raise wrong_type(name, "a text", value)
    try:
        value.encode()
    except UnicodeEncodeError:
        raise refused(name, f"is not a text in Unicode: {value!a}") from None
    return value


def path(name: str, value: Any) -> bytes:
    """The path of a file, as the system has it."""
    try:
        return os.fsencode(value)
    except TypeError:
        raise wrong_type(name, "a path", value) from None
    except UnicodeEncodeError:
        raise refused(name, f"is no path: {value!a}") from None


def mapping(name: str, value: Any, expected: str = "a dict") -> Mapping[str, Any]:
    """A dict or the like, with texts as keys."""
    if not isinstance(value, Mapping):
        raise wrong_type(name, expected, value)
    for key in value:
        if not isinstance(key, str):
            raise wrong_type(f"{name}: a key", "a text", key)
    return value


def names(name: str, value: Any) -> list[str]:
    """Several texts."""
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Iterable):
        raise wrong_type(name, "a list of names", value)
    return [text(name, each) for each in value]


def callback(value: Any) -> Any:
    """What `progress` may be."""
    if value is None or isinstance(value, (bool, np.bool_)) or callable(value):
        return value
    raise wrong_type("progress", "True, False or a function of designs done and designs", value)


def is_masked(value: Any) -> bool:
    """Whether that is an array of NumPy with masked values."""
    return isinstance(value, np.ma.MaskedArray) and bool(np.any(value.mask))


def real(value: Any) -> float | None:
    """A real number as a float, None where it is none; of NumPy those without dimensions count."""
    if isinstance(value, (bool, np.bool_)):
        return None
    if isinstance(value, (Real, Decimal)):
        try:
            return float(value)
        except OverflowError:
            return math.inf
    if getattr(value, "ndim", None) == 0 and hasattr(value, "item") and not is_masked(value):
        inner = value.item()
        return None if getattr(inner, "ndim", None) == 0 else real(inner)
    return None


def number(name: str, value: Any, unit: str) -> float:
    """The SI number of a quantity: a number, or a text with a unit. A Quantity of another unit is read as its text."""
    if isinstance(value, Quantity) and value.unit not in ("1", unit):
        value = f"{float(value)!r} {value.unit}"
    if isinstance(value, str):
        found = _core.quantity(name, text(name, value), unit)
    else:
        as_real = real(value)
        if as_real is None:
            other = "" if unit == "1" else f"a number [{unit}] or "
            raise wrong_type(name, f"{other}{_core.quantity_example(unit)}", value)
        found = as_real
    if not math.isfinite(found):
        raise refused(name, f"must be finite, got {value if isinstance(value, str) else found}")
    return found


def optional_number(name: str, value: Any, unit: str) -> float | None:
    """A number in an SI unit, or None."""
    return None if value is None else number(name, value, unit)


def numbers_of(**given: tuple[Any, str]) -> tuple[float, ...]:
    """The SI numbers of options, each its value and its unit, in their order."""
    return tuple(number(name, value, unit) for name, (value, unit) in given.items())


def one_of(**asked: Any) -> None:
    """Refuses all but the first of options that exclude each other; None: not asked for."""
    given = [name for name, value in asked.items() if value is not None]
    if len(given) > 1:
        raise refused(given[1], f"cannot be asked for beside {given[0]}; give one of {', '.join(asked)}")


def held_by(**asked: Any) -> dict[str, float]:
    """What designs are held at by their voltage: the one of HELD that is asked for, if any [SI]."""
    one_of(**asked)
    return {name: number(name, value, HELD[name]) for name, value in asked.items() if value is not None}


def array(name: str, values: Any, unit: str = "") -> npt.NDArray[np.float64]:
    """Real numbers as an array of any shape; where there is a unit, texts are read with theirs, also a single one."""
    if unit and isinstance(values, str):
        return np.array(number(name, values, unit))
    if isinstance(values, (str, bytes, Mapping)):
        raise wrong_type(name, "an array of numbers", values)
    if is_masked(values):
        first = int(np.flatnonzero(np.broadcast_to(values.mask, np.shape(values)))[0])
        raise refused(name, f"value {first} is masked; fill masked values, or leave them out")
    texts = isinstance(values, (list, tuple)) and any(isinstance(value, (str, Quantity)) for value in values)
    other = _other_unit(values, unit)
    if other:
        at_1, at_0 = (_core.quantity(name, f"{value} {other}", unit) for value in (1, 0))
        return at_0 + (at_1 - at_0) * array(name, np.asarray(values))
    try:
        found = np.array(values, dtype=object) if texts else np.asarray(values)
    except ValueError:
        raise refused(name, "rows of different lengths are no array") from None
    kind = found.dtype.kind
    if kind in "OU" and unit:
        each = [number(name, value, unit) for value in found.ravel()]
        return np.array(each, dtype=np.float64).reshape(found.shape)
    if kind == "O":
        each = []
        for value in found.ravel():
            as_real = real(value)
            if as_real is None:
                raise wrong_type(name, "an array of real numbers", value)
            each.append(as_real)
        return np.array(each, dtype=np.float64).reshape(found.shape)
    if kind not in "iuf" and found.size:
        raise TypeError(f"{name}: expected an array of real numbers, got {found.dtype.name}")
    return np.ascontiguousarray(found, dtype=np.float64).reshape(found.shape)


def _other_unit(values: Any, unit: str) -> str:
    """The unit that an array of xarray or pandas states, where it is not that one; "" where it states none."""
    attributes = getattr(values, "attrs", None)
    stated = attributes.get("units", "") if unit and isinstance(attributes, Mapping) else ""
    return stated if isinstance(stated, str) and stated not in ("", "1", unit) else ""


def axis_values(name: str, values: Any, unit: str) -> list[Any]:
    """The values along an axis: numbers and texts with that unit, names where it is ""."""
    numeric = bool(unit)
    if isinstance(values, (str, bytes, Mapping)) or not isinstance(values, Iterable):
        raise wrong_type(name, "an array of values", values)
    given = values if hasattr(values, "ndim") else list(values)
    texts = isinstance(given, list) and any(isinstance(value, str) for value in given)
    if getattr(given, "ndim", 1) == 1 and (not numeric or texts or getattr(given, "dtype", None) == object):
        return [number(name, value, unit) if unit and isinstance(value, Quantity) else value for value in given]
    found = array(name, given, unit)
    if found.ndim != 1:
        raise refused(name, f"expected values along one axis, got an array of {found.ndim} dimensions")
    along: list[float] = found.tolist()
    return along
