"""What a Vehicle offers as methods: the modules that compute enter their functions here, so that the vehicle, which all
of them import, imports none of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

_Function = TypeVar("_Function", bound=Callable[..., Any])

#: By the name of the function or class.
operations: dict[str, Callable[..., Any]] = {}


def operation(function: _Function) -> _Function:
    """Enters a function, or a class that is made of a vehicle."""
    operations[function.__name__] = function
    return function
