"""Numbers that know their unit."""

from __future__ import annotations


class Quantity(float):
    """A float with `unit` (UDUNITS) and `long_name`. Arithmetic gives a plain float.

    Parameters
    ----------
    value : float
        The number, in this unit.
    unit : str, default '1'
        Its unit as UDUNITS spells it, "1" for a plain number.
    long_name : str, default ''
        The name of the quantity, for labels.

    Raises
    ------
    ValueError
        For a value that is not a number.

    Examples
    --------
    >>> length = wb.Quantity(0.005, "m", "crank radius")
    >>> length, 2 * length, length.unit
    (0.005 m, 0.01, 'm')
    """

    __slots__ = ("unit", "long_name")
    unit: str
    long_name: str

    def __new__(cls, value: float, unit: str = "1", long_name: str = "") -> Quantity:
        made = super().__new__(cls, value)
        made.unit = unit
        made.long_name = long_name
        return made

    def __repr__(self) -> str:
        return super().__repr__() if self.unit == "1" else f"{super().__repr__()} {self.unit}"

    def __str__(self) -> str:
        return super().__repr__()

    def __reduce__(self) -> tuple[type[Quantity], tuple[float, str, str]]:
        return Quantity, (float(self), self.unit, self.long_name)
