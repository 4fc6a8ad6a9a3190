"""Very many vehicles, as arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arguments import (
    HELD, Columns, array, callback, flag, held_by, mapping, names, number, one_of, refused, text, threads_of, wrong_type,
)
from ._operations import operation
from ._progress import shown
from ._study import study_of_columns, without_place
from ._tables import metric_called, metric_rows, parameters, statuses
from ._tables import metrics as metric_table
from ._vehicle import Vehicle, vehicle_of

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray


class Ensemble:
    """Results of all designs, as arrays in the order of the designs.

    Metrics are attributes: `result.lift_mean`, NaN if a design does not have the metric.

    Examples
    --------
    >>> vehicle = wb.read("friction2022")
    >>> found = wb.solve_columns({"supply.voltage": [0, 3, 4]}, vehicle=vehicle)
    >>> found
    <3 designs: 2 flapping, 1 stalled>
    >>> found.flapping
    array([False,  True,  True])
    """

    #: The status of each design as files have it, a number, 0 for flapping.
    status_code: npt.NDArray[np.int8]
    #: Limits of the model that are exceeded, bit by bit as in data sets; 0: inside, or not flapping.
    domain_code: npt.NDArray[np.int16]
    #: Estimated relative error of the metrics.
    error_estimate: npt.NDArray[np.float64]
    #: 1: by the scalar solver, 0: by the batched one.
    recomputed: npt.NDArray[np.int8]

    def __init__(self, found: dict[str, Any], inputs: tuple[Any, ...]) -> None:
        self._inputs = inputs
        self.status_code = found["status"]
        self.domain_code = found["domain"]
        self.error_estimate = found["error_estimate"]
        self.recomputed = found["recomputed"]
        self._columns = dict(zip(found["kept"], found["metrics"]))

    def __len__(self) -> int:
        return len(self.status_code)

    @property
    def status(self) -> npt.NDArray[np.str_]:
        """The status of each design by name."""
        return np.array(statuses)[self.status_code]

    @property
    def flapping(self) -> npt.NDArray[np.bool_]:
        """True for each design that flaps (at the requested frequency, lift or power)."""
        return np.equal(self.status_code, 0)

    def __getattr__(self, name: str) -> npt.NDArray[np.float64]:
        if name.startswith("_") or name not in metric_table:
            raise AttributeError(f"Ensemble has no attribute {name!r}")
        index = metric_called(name)
        if index not in self._columns:
            raise AttributeError(f"the designs have no {name}, or it was not asked for")
        column: npt.NDArray[np.float64] = self._columns[index]
        return column

    def __dir__(self) -> list[str]:
        return sorted({*object.__dir__(self), *(metric_rows[k].name for k in self._columns)})

    def gradient(
        self,
        metrics: str | list[str] | tuple[str, ...],
        keys: str | list[str] | tuple[str, ...],
        *,
        threads: int = 0,
        progress: bool | Callable[[int, int], object] | None = None,
    ) -> npt.NDArray[np.float64]:
        """Exact derivatives of metrics by numeric keys of the vehicle, of every design, on all cores.

        The voltage is held, or the frequency or lift that the designs were solved for. NaN for designs that do not flap
        and for metrics without derivatives (floquet_multiplier_max). The keys need not be columns.

        Parameters
        ----------
        metrics : str or list of str
            The name of a metric, or a list of names.
        keys : str or list of str
            A key, or a list of keys.
        threads : int, default 0
            Number of threads at most; 0: one for each core.
        progress : bool or function, optional
            True shows a bar, a function is called with the designs done and their total.

        Returns
        -------
        numpy.ndarray, shape (designs, metrics, keys)
            Derivatives [unit of the metric per unit of the key]; a single metric or key, not in a list, has no
            dimension.

        Raises
        ------
        InputError
            For an unknown key or metric, and for a key without a value in a design that flaps.

        Examples
        --------
        >>> vehicle = wb.read("friction2022")
        >>> found = wb.solve_columns({"supply.voltage": [3, 4]}, vehicle=vehicle)
        >>> np.round(found.gradient("frequency", ["supply.voltage", "friction.radius"]), 2)
        array([[    5.67, -1374.37],
               [    5.39, -1975.68]])
        """
        named = [text("metrics", metrics)] if isinstance(metrics, str) else names("metrics", metrics)
        by = [text("keys", keys)] if isinstance(keys, str) else names("keys", keys)
        indices = [metric_called(name) for name in named]
        rows = np.flatnonzero(self.flapping)
        study, vehicle, columns, count, condition = self._inputs
        with shown(callback(progress), len(rows)) as tell:
            found = _core.gradient_of_columns(
                study, vehicle._design, columns, count, condition, threads_of(threads), tell, rows.tolist(), indices, by
            )
        every = np.full((len(self), len(named), len(by)), np.nan)
        every[rows] = found
        if isinstance(keys, str):
            every = every[:, :, 0]
        return every[:, 0] if isinstance(metrics, str) else every

    def to_xarray(self) -> xarray.Dataset:
        """All results over the dimension `design`, with units and long names.

        Returns
        -------
        xarray.Dataset
            The metrics by name, with the status of each design as a coordinate of texts.

        Raises
        ------
        ImportError
            If xarray is not installed.

        Examples
        --------
        >>> data = wb.solve({"supply.voltage": [0, 3]}, vehicle=wb.read("friction2022")).to_xarray()
        >>> data.lift_mean.attrs["units"], data.status.values.tolist()
        ('N', ['stalled', 'flapping'])
        """
        import xarray

        made: dict[str, Any] = {
            metric_rows[k].name: (
                "design",
                column,
                {"units": metric_rows[k].unit, "long_name": metric_rows[k].long_name},
            )
            for k, column in self._columns.items()
        }
        made["error_estimate"] = ("design", self.error_estimate, {"units": "1"})
        return xarray.Dataset(made, {"status": ("design", self.status, {"long_name": "status"})})

    def __repr__(self) -> str:
        counts = np.bincount(self.status_code, minlength=len(statuses))
        return f"<{len(self)} designs: " + ", ".join(f"{n} {s}" for n, s in zip(counts, statuses) if n) + ">"


def is_columns(value: Any) -> bool:
    """Whether that is a dict or DataFrame."""
    return isinstance(value, Mapping) or (hasattr(value, "columns") and hasattr(value, "__getitem__"))


def _unit(key: str) -> str:
    """That of a column of numbers; "" for what is no column of numbers."""
    return HELD[key] if key in HELD else parameters[key].unit if key in parameters else ""


def _is_column(values: Any) -> bool:
    """Whether there is a value for each design. Rows of a table are no column."""
    if isinstance(values, (str, bytes, Mapping)):
        return False
    if isinstance(values, (list, tuple)):
        return not any(isinstance(value, (list, tuple, np.ndarray)) for value in values)
    return np.ndim(values) == 1


@operation
def solve_columns(
    columns: Columns,
    *,
    vehicle: Vehicle | None = None,
    frequency: float | str | None = None,
    lift: float | str | None = None,
    lift_to_weight: float | None = None,
    power: float | str | None = None,
    allow_extrapolation: bool = False,
    condition: str = "air",
    tolerance: float = 1e-6,
    metrics: Iterable[str] | None = None,
    threads: int = 0,
    progress: bool | Callable[[int, int], object] | None = None,
) -> Ensemble:
    """The steady flapping of very many vehicles, on all cores.

    Parameters
    ----------
    columns : dict or DataFrame
        An array of SI numbers, or of texts with units, for each numeric key that varies; single values hold for all
        designs. The keys "frequency", "lift", "lift_to_weight" and "power" are held by the voltage, like the options of
        these names.
    vehicle : Vehicle, optional
        The vehicle with all keys that are not columns; not needed if the columns state a whole vehicle.
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
    condition : str, default 'air'
        "air", "vacuum" or "wingless".
    tolerance : float, default 1e-06
        Requested relative accuracy of every metric, 1e-12 to 1e-2.
    metrics : list of str, optional
        Names of the metrics to compute, fewer take less time; default: all but hover and endurance.
    threads : int, default 0
        Number of threads at most; 0: one for each core.
    progress : bool or function, optional
        True shows a bar (tqdm if it is installed), a function is called with the designs done and their total.

    Returns
    -------
    Ensemble
        In the order of the rows; arrays of shape (n,) for n designs.

    Raises
    ------
    InputError
        For a key that is unknown or does not apply to the vehicle.
    ValueError
        If no key has an array, or arrays differ in length.

    Notes
    -----
    A design out of its physical range has the status "invalid". Other Python threads run during the call; Ctrl-C ends
    it.

    Examples
    --------
    >>> vehicle = wb.read("friction2022")
    >>> voltage = np.linspace(2, 5, 4)
    >>> found = wb.solve_columns({"supply.voltage": voltage, "friction.radius": "2 mm"}, vehicle=vehicle)
    >>> np.round(found.frequency, 1)
    array([16.5, 22.7, 28.5, 34.2])
    """
    if not is_columns(columns):
        raise wrong_type("columns", "a dict or DataFrame of columns", columns)
    given = mapping("columns", {key: columns[key] for key in columns})
    if vehicle is not None:
        vehicle_of(vehicle)
    asked = {"frequency": frequency, "lift": lift, "lift_to_weight": lift_to_weight, "power": power}
    for name, value in asked.items():
        if value is not None and given.get(name) is not None:
            raise refused(name, "is given in the columns and beside them")
    varied = {
        key: array(key, values, _unit(key)) for key, values in given.items() if _unit(key) and _is_column(values)
    }
    for key, column in varied.items():
        if len(column) == 0:
            raise refused(key, "expected a value for each design, got none")
    held = {key: values for key, values in given.items() if key not in varied}
    one_of(**{name: given.get(name, value) for name, value in asked.items()})
    hold = held_by(**{name: held.pop(name, value) for name, value in asked.items()})
    tolerance, anywhere = number("tolerance", tolerance, "1"), flag("allow_extrapolation", allow_extrapolation)
    condition, threads = text("condition", condition), threads_of(threads)
    if vehicle is None:
        first_row = {key: values[0] for key, values in varied.items() if key not in HELD}
        vehicle = Vehicle({**held, **first_row})
    elif held:
        vehicle = vehicle.replace(held)
    if not varied:
        raise ValueError("no key has an array of values; wingbeat.solve takes a single vehicle")
    lengths = {key: len(values) for key, values in varied.items()}
    count = next(iter(lengths.values()))
    for key, length in lengths.items():
        if length != count:
            first = next(iter(lengths))
            raise ValueError(f"{key} has {length} values, {first} has {count}")
    # The checks of a study are made at values that the vehicle allows: a row may be invalid.
    row = {}
    for key, values in varied.items():
        own = vehicle[key] if key in parameters else None
        row[key] = float(values[0]) if own is None else float(own)
    study = study_of_columns(row, tolerance=tolerance, metrics=metrics, hold=hold, anywhere=anywhere)
    with without_place("columns"), shown(callback(progress), count) as tell:
        inputs = [column.copy() for column in varied.values()], count, condition
        found = _core.solve_columns(study, vehicle._design, *inputs, threads, tell)
    return Ensemble(found, (study, vehicle, *inputs))
