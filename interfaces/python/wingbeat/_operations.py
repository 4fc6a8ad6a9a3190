"""What a Vehicle offers as methods: the modules that compute enter their functions here, so that the vehicle, which all
of them import, imports none of them."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from typing import Any, TypeVar

_Function = TypeVar("_Function", bound=Callable[..., Any])
_TITLES = ("Parameters", "Returns", "Raises", "Notes", "Examples")

#: By the name of the function or class.
operations: dict[str, Callable[..., Any]] = {}
_methods: dict[str, Callable[..., Any]] = {}


def operation(function: _Function) -> _Function:
    """Enters a function, or a class that is made of a vehicle, which is its first argument."""
    operations[function.__name__] = function
    method = _methods.get(function.__name__)
    if method is not None and method.__doc__ and function.__doc__:
        method.__doc__ = _completed(method, function)
    return function


def method_of(name: str) -> Callable[[_Function], _Function]:
    """For a method that is the function of that name. Its docstring has an introduction and examples of its own; the
    rest of it is that of the function, entered with the function."""

    def entered(method: _Function) -> _Function:
        _methods[name] = method
        return method

    return entered


def sections_of(doc: str) -> dict[str, str]:
    """The sections of a docstring by their titles, what stands before them as ""."""
    pieces = re.split(rf"^({'|'.join(_TITLES)})\n-+\n", inspect.cleandoc(doc), flags=re.M)
    return {"": pieces[0].strip()} | {title: body.strip("\n") for title, body in zip(pieces[1::2], pieces[2::2])}


def _completed(method: Callable[..., Any], function: Callable[..., Any]) -> str:
    """The docstring of a method: its own sections, and those of the function, of its own parameters."""
    found = sections_of(function.__doc__ or "")
    own = set(inspect.signature(method).parameters)
    rows = re.split(r"\n(?=\S)", found.get("Parameters", ""))
    found["Parameters"] = "\n".join(row for row in rows if own.intersection(row.partition(" : ")[0].split(", ")))
    if inspect.isclass(function):
        found["Returns"] = function.__name__
    found |= sections_of(method.__doc__ or "")
    parts = [found[""]] + [f"{title}\n{'-' * len(title)}\n{found[title]}" for title in _TITLES if found.get(title)]
    return "\n\n".join(parts) + "\n"
