"""What is refused, in the sentences of the program."""

from __future__ import annotations


class InputError(ValueError):
    """Invalid input: a vehicle, a value, an option.

    The message names location, key and expected value: "motor.inertia: must be > 0 [kg m2], got -1".

    Attributes
    ----------
    file : str or None
        The file, or None if the input was not a file.
    line, column : int or None
        From 1, or None.
    key : str
        The key or option, or "".
    others : list of InputError
        Further errors, each an InputError.

    Examples
    --------
    >>> try:
    ...     wb.read("friction2022").replace({"motor.inertia": -1})
    ... except wb.InputError as error:
    ...     print(error.key, "|", error)
    motor.inertia | motor.inertia: must be > 0 [kg m2], got -1
    """

    file: str | None = None
    line: int | None = None
    column: int | None = None
    key: str = ""
    others: list[InputError]

    def __init__(self, text: str = "") -> None:
        super().__init__(text)
        self.others = []

    def __str__(self) -> str:
        return "\n".join([super().__str__(), *map(str, self.others)])
