"""Optima: by metrics, by functions of the user's own, and fronts of several objectives."""

from __future__ import annotations

import math
import os
import pathlib
import shutil
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from . import _core
from ._arguments import callback, flag, number, real, refused, text, threads_of, wrong_type
from ._operations import operation
from ._progress import shown
from ._result import RunResult
from ._studies import Found, Study, file_of, values_of, vehicle_and_study, vehicle_first
from ._tables import metric_called, metric_index, metric_rows, parameters
from ._vehicle import Vehicle

if TYPE_CHECKING:
    import xarray


class Front(Found):
    """The nondominated designs; `vehicle` is that at the knee, None if there is none.

    Examples
    --------
    >>> fronts = {
    ...     "search": {"population": 40, "generations": 5},
    ...     "objective": [
    ...         {"maximise": "lift_mean_n", "reference": 0},
    ...         {"minimise": "power_electrical_w", "reference": "4 W"},
    ...     ],
    ...     "parameter": [{"key": "supply.voltage", "lower": 2, "upper": 8}],
    ... }
    >>> front = wb.optimise(wb.read("friction2022"), fronts)
    >>> len(front.all_vehicles) == front.designs.sizes["design"]
    True
    """

    #: The vehicles of the front, by the first objective, best first; as `designs`.
    all_vehicles: tuple[Vehicle, ...]
    #: Vehicles picked from it by name: "end-lift_mean_n" for the best by each objective, "knee", "even-1" and so on.
    vehicles: dict[str, Vehicle]

    def __init__(self, found: dict[str, Any]) -> None:
        super().__init__({**found, "design": None})
        self.all_vehicles = tuple(Vehicle._of(design) for design in found["vehicles"])
        self.vehicles = {name: self.all_vehicles[place] for name, place in found["picks"]}
        self.vehicle = self.vehicles.get("knee")
        self._columns = {name: found[name] for name in ("metrics", "keys", "parameters")}

    @property
    def designs(self) -> xarray.Dataset:
        """Metrics by name and parameters by key of each design of the front, over the dimension `design`."""
        import xarray

        made: dict[str, Any] = {
            row.name: ("design", column, {"units": row.unit, "long_name": row.long_name})
            for row, column in zip(metric_rows, self._columns["metrics"])
            if not np.all(np.isnan(column))
        }
        for key, column in zip(self._columns["keys"], self._columns["parameters"]):
            made[key] = ("design", column, {"units": parameters[key].unit, "long_name": parameters[key].meaning})
        return xarray.Dataset(made)


class OwnOptimum(Found):
    """An optimum by your own functions: `value`, `parameters`, and `outcome`, which states how the searches ended.

    Examples
    --------
    >>> study = {
    ...     "objective": {"minimise": lambda result: (result.frequency - 22) ** 2, "starts": 1},
    ...     "parameter": [{"key": "supply.voltage", "lower": 2, "upper": 5}],
    ... }
    >>> found = wb.optimise(wb.read("friction2022"), study)
    >>> f"{found.result.frequency:.2f} Hz"
    '22.00 Hz'
    """

    #: What the vehicle that was found does; None where none was.
    result: RunResult | None


@overload
def optimise(
    vehicle: Vehicle,
    study: Mapping[str, Any],
    *,
    values: Mapping[str, Any] | None = None,
    allow_extrapolation: bool = False,
    threads: int = 0,
    progress: bool | Callable[[int, int], object] | None = None,
) -> Found: ...
@overload
def optimise(
    study: Study,
    /,
    *,
    vehicle: Vehicle | None = None,
    values: Mapping[str, Any] | None = None,
    allow_extrapolation: bool = False,
    threads: int = 0,
    progress: bool | Callable[[int, int], object] | None = None,
) -> Found: ...
@operation
@vehicle_first("study")
def optimise(
    vehicle: Vehicle | Study,
    study: Mapping[str, Any] | None = None,
    *,
    values: Mapping[str, Any] | None = None,
    allow_extrapolation: bool = False,
    threads: int = 0,
    progress: bool | Callable[[int, int], object] | None = None,
) -> Found:
    """The best design within bounds and constraints, or the front of several objectives: `wingbeat optimise`.

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
        Designs outside the model's domain count.
    threads : int, default 0
        Number of threads at most; 0: one for each core.
    progress : bool or function, optional
        For a front: True shows a bar (tqdm if it is installed), a function is called with the designs done and their
        total.

    Returns
    -------
    Found
        With several objectives a Front, with functions an OwnOptimum.

    Raises
    ------
    InputError
        For an invalid study.
    TypeError
        For a Vehicle without a study, and for a Vehicle together with a study file, which names its vehicle.
    Exception
        The exception of your function.

    Notes
    -----
    In a dict, what `minimise`, `maximise` or the `metric` of a constraint names may be a function of the result of a
    design, which flaps: `{"objective": {"minimise": f}, "constraint": [{"metric": g, "at_most": 2}]}`. It returns a
    number [SI], or a number and its derivatives, a dict by names of metrics and keys of parameters:

        def cost(result):                                    # cost of a second of hovering, and what it follows from
            return 3 * result.power_electrical + 2 * result.current_peak, {"power_electrical": 3, "current_peak": 2}

    If all functions return derivatives, the search uses exact gradients; otherwise it is derivative-free (COBYLA) and
    needs more designs. Such a search starts from the vehicle and from the best of `screen` designs (default 32 for each
    parameter), `starts` times (default 4), on one thread. Return None or NaN to exclude a design.

    Ctrl-C ends it.

    Examples
    --------
    >>> study = {
    ...     "objective": {"maximise": "efficiency_system"},
    ...     "parameter": [{"key": "transmission.crank_radius", "lower": 0.004, "upper": 0.007}],
    ... }
    >>> found = wb.optimise(wb.read("friction2022"), study)
    >>> 0.004 <= found.vehicle.transmission.crank_radius <= 0.007
    True
    """
    base, tables = vehicle_and_study(vehicle, study)
    overrides, extrapolate = values_of(values), flag("allow_extrapolation", allow_extrapolation)
    threads, tells = threads_of(threads), callback(progress)
    if isinstance(tables, Mapping):
        own = _OwnProblem(tables)
        if own.functions:
            with file_of(own.study, base) as file:
                return own.solved(file, overrides, extrapolate)
    with file_of(tables, base) as file, shown(tells, 0) as tell:
        found = _core.optimise(file, overrides, extrapolate, threads, _module_folders(), tell)
        return Front(found) if "picks" in found else Found(found)


def _module_folders() -> list[str]:
    """Where the library's part with pagmo may be: beside this package, in its build folder, beside the program."""
    here = pathlib.Path(_core.__file__ or "").resolve().parent
    program = shutil.which("wingbeat")
    folders = [here, here.parent.parent]
    if program:
        folders.append(pathlib.Path(program).resolve().parent)
    return [os.fspath(folder) for folder in folders]


class _OwnProblem:
    """A study with functions: what of it is a study of the program, and the functions."""

    def __init__(self, study: Mapping[str, Any]) -> None:
        objective = study.get("objective")
        constraints = study.get("constraint", [])
        terms = [c for c in constraints if _is_function(c)] if isinstance(constraints, (list, tuple)) else []
        wanted = dict(objective) if isinstance(objective, Mapping) else {}
        self.goal = next((goal for goal in ("minimise", "maximise") if goal in wanted), "minimise")
        self.functions = bool(terms) or callable(wanted.get(self.goal))
        self.study: Mapping[str, Any] = study
        if not self.functions:
            return
        self.objective = wanted.get(self.goal)
        if callable(self.objective):
            wanted[self.goal] = "frequency_hz"  # in its place, not used
        elif isinstance(self.objective, str):
            self.objective = _metric_term(self.objective)
        parameters_given = study.get("parameter", [])
        count = len(parameters_given) if isinstance(parameters_given, (list, tuple)) else 0
        self.study = {
            **study,
            "objective": {"starts": 4, "screen": 32 * max(1, count), **wanted},
            "constraint": [c for c in constraints if not _is_function(c)],
        }
        self.constraints: list[tuple[Callable[[RunResult], Any], float, float]] = []
        for term in terms:
            unknown = set(term) - {"metric", "at_least", "at_most"}
            if unknown or not ({"at_least", "at_most"} & set(term)):
                shown_term = ", ".join(map(str, term))
                raise refused("constraint", f"a function has at_least, at_most or both, got {shown_term}")
            for key, sign in (("at_least", -1.0), ("at_most", 1.0)):
                if key in term:
                    limit = real(term[key])
                    if limit is None:
                        raise wrong_type(f"constraint.{key}", "a number, of what a function gives", term[key])
                    if not math.isfinite(limit):
                        raise refused(f"constraint.{key}", f"must be finite, got {limit}")
                    self.constraints.append((term["metric"], sign / (abs(limit) or 1.0), limit))

    def solved(self, file: bytes, overrides: list[str], allow_extrapolation: bool) -> OwnOptimum:
        """The search, and what it found."""
        settings = self.study.get("study", {})
        tolerance = settings.get("tolerance", 1e-8)
        options: dict[str, Any] = {
            "condition": settings.get("condition", "air"),
            "method": "orbit",
            "tolerance": number("tolerance", tolerance, "1"),
            "frequency": None,
            "lift": None,
            "lift_to_weight": None,
            "power": None,
            "allow_extrapolation": allow_extrapolation,
            "points": 0,
            "endurance": False,
        }
        keys = [parameter["key"] for parameter in self.study.get("parameter", [])]
        sign = -1.0 if self.goal == "maximise" else 1.0

        def evaluate(design: _core.Design, found: dict[str, Any]) -> list[Any]:
            result = RunResult(found, Vehicle._of(design), options)
            terms = [_term(self.objective, result, sign, 0.0, keys)]
            terms += [_term(function, result, factor, limit, keys) for function, factor, limit in self.constraints]
            return terms

        found = _core.optimise_own(file, overrides, allow_extrapolation, evaluate, len(self.constraints))
        return _own_optimum(found, sign, options)


def _is_function(constraint: Any) -> bool:
    return isinstance(constraint, Mapping) and callable(constraint.get("metric"))


def _metric_term(name: str) -> Callable[[RunResult], Any]:
    row = metric_rows[metric_called(name)]
    return lambda result: (result.metrics[row.name], {row.name: 1.0})


def _term(function: Any, result: RunResult, factor: float, limit: float, keys: list[str]) -> tuple[Any, ...]:
    """factor (f - limit) with its derivatives, as the compiled half takes it."""
    value = function(result)
    slopes: Mapping[str, float] | None = None
    if isinstance(value, tuple):
        if len(value) != 2 or not isinstance(value[1], Mapping):
            raise TypeError("objective: expected a number, or a number and a dict of its derivatives, from a function")
        value, slopes = value
    as_real = math.nan if value is None else real(value)
    if as_real is None:
        raise wrong_type("objective", "a number, or a number and a dict of its derivatives, from a function", value)
    term = factor * (as_real - limit)
    if slopes is None:
        return (term,)
    by_metric: dict[int, float] = {}
    by_parameter = [0.0] * len(keys)
    for name, slope in slopes.items():
        along = real(slope)
        if along is None:
            raise wrong_type(f"objective: the derivative by {name}", "a number", slope)
        if name in keys:
            by_parameter[keys.index(name)] = factor * along
        elif name in metric_index or name not in parameters:
            by_metric[metric_called(text("derivative", name))] = factor * along
    return term, by_metric, by_parameter


def _own_optimum(found: dict[str, Any], sign: float, options: dict[str, Any]) -> OwnOptimum:
    starts, same, elsewhere, failed = found["starts"]
    there = found["design"] is not None
    values: dict[str, Any] = {
        "outcome": found["outcome"],
        "value": sign * found["objective"] if there else None,
        "parameters": dict(zip(found["keys"], found["parameters"])) if there else None,
        "starts": {"all": starts, "same": same, "elsewhere": elsewhere, "failed": failed},
        "evaluations": found["evaluations"],
        "exact_gradients": found["gradients"],
        "searches": [
            {
                "start": start,
                "end": end or None,
                "began": sign * began if began == began else None,
                "ended": sign * ended if ended == ended else None,
                "evaluations": evaluations,
            }
            for start, end, began, ended, evaluations in found["searches"]
        ],
    }
    lines = [f"{found['outcome'].replace('_', ' ')}: {starts} starts, {same} ended in the best optimum, {found['evaluations']} designs"]
    if there:
        lines = [f"best value: {values['value']:.6g}", *lines]
        for key, value in values["parameters"].items():
            unit = parameters[key].unit
            lines.append(f"  {key:<34}{value:>14.6g} {'' if unit == '1' else unit}".rstrip())
    made = OwnOptimum({"values": values, "text": "\n".join(lines) + "\n", "design": found["design"]})
    made.result = None
    if made.vehicle is not None:
        made.result = RunResult(_core.run(made.vehicle._design, **options), made.vehicle, options)
    return made
