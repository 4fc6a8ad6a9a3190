"""Linear models of a vehicle for control design."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arguments import flag, number, one_of, optional_number, text, whole
from ._operations import operation
from ._studies import StudyResult
from ._vehicle import Vehicle, vehicle_of

if TYPE_CHECKING:
    import numpy.typing as npt


def _names(signals: list[dict[str, Any]]) -> list[str]:
    return [str(signal["name"]) for signal in signals]


def _matrix(rows: list[list[float | None]], columns: int) -> npt.NDArray[np.float64]:
    return np.array(rows, dtype=np.float64).reshape(len(rows), columns)


class LinearModel:
    """Matrices A, B, C, D with the names of states, inputs and outputs, all of them deviations in SI units.

    `dt` [s] is the time step, None of a model in continuous time.

    Examples
    --------
    >>> model = wb.read("friction2022").linearise(maps=False).discrete
    >>> model.states, model.A.shape, f"{model.dt:.5f} s"
    (['crank_speed', 'current'], (2, 2), '0.04555 s')
    """

    def __init__(self, model: dict[str, Any], inputs: list[str], outputs: list[str], dt: float | None) -> None:
        self.states: list[str] = _names(model["states"])
        self.inputs = inputs
        self.outputs = outputs
        self.dt = dt
        self.A = _matrix(model["A"], len(self.states))
        self.B = _matrix(model["B"], len(inputs))
        self.C = _matrix(model["C"], len(self.states))
        self.D = _matrix(model["D"], len(inputs))

    def to_scipy(self) -> Any:
        """The model as scipy.signal.StateSpace, with `dt` if it is discrete.

        Returns
        -------
        scipy.signal.StateSpace
            Of deviations in SI units, with the time step [s] if the model is discrete.

        Raises
        ------
        ImportError
            If SciPy is not installed.

        Examples
        --------
        >>> system = wb.read("friction2022").linearise(maps=False).discrete.to_scipy()
        >>> system.A.shape, f"{system.dt:.5f} s"
        ((2, 2), '0.04555 s')
        """
        signal = importlib.import_module("scipy.signal")
        matrices = (self.A, self.B, self.C, self.D)
        return signal.StateSpace(*matrices) if self.dt is None else signal.StateSpace(*matrices, dt=self.dt)

    def to_control(self) -> Any:
        """The model as control.StateSpace of the package `control`, with names.

        Returns
        -------
        control.StateSpace
            Of deviations in SI units, with the time step [s] if the model is discrete.

        Raises
        ------
        ImportError
            If `control` is not installed.

        Examples
        --------
        >>> model = wb.read("friction2022").linearise(maps=False).discrete
        >>> model.to_control().input_labels  # doctest: +SKIP
        ['voltage', 'load_torque']
        """
        try:
            control = importlib.import_module("control")
        except ImportError as error:
            raise ImportError("the package `control` (python-control) is not installed") from error
        return control.ss(
            self.A,
            self.B,
            self.C,
            self.D,
            *([] if self.dt is None else [self.dt]),
            states=self.states,
            inputs=self.inputs,
            outputs=self.outputs,
        )

    def __repr__(self) -> str:
        time = "continuous time" if self.dt is None else f"dt = {self.dt:.6g} s"
        return f"<{type(self).__name__}: {', '.join(self.states)}; {time}>"


class ControlModels(StudyResult):
    """Linear models about steady flapping, static maps and body derivatives: the keys of `wingbeat linearise --json`.

    Examples
    --------
    >>> models = wb.read("friction2022").linearise(maps=False)
    >>> models.discrete.inputs
    ['voltage', 'load_torque']
    """

    def _model(self) -> dict[str, Any]:
        model = self["model"]
        if model is None:
            raise ValueError(f"no linear model: {self['status_detail']}")
        return dict(model)

    @property
    def discrete(self) -> LinearModel:
        """From one cycle to the next.

        Raises
        ------
        ValueError
            If the vehicle does not flap.
        """
        model = self._model()
        return LinearModel(model, _names(model["inputs"]), _names(model["outputs"]), float(model["period_s"]))

    @property
    def continuous(self) -> LinearModel:
        """The model in continuous time, without modes that settle within a cycle.

        Raises
        ------
        ValueError
            If the vehicle does not flap.
        """
        model = self._model()
        return LinearModel(model["continuous"], _names(model["inputs"]), _names(model["outputs"]), None)


@operation
def linearise(
    vehicle: Vehicle,
    *,
    condition: str = "air",
    frequency: float | str | None = None,
    lift: float | str | None = None,
    allow_extrapolation: bool = False,
    cycles: int = 0,
    hinge_offset: float | str = 0.0,
    maps: bool = True,
) -> ControlModels:
    """Linear models and static maps for control design: `wingbeat linearise`.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    condition : str, default 'air'
        "air", "vacuum" or "wingless".
    frequency : float or str, optional
        Flapping frequency of the operating point [Hz]; its voltage is found.
    lift : float or str, optional
        Mean lift of the operating point [N], instead of a frequency; its voltage is found.
    allow_extrapolation : bool, default False
        The search for a frequency or a lift may leave the model's domain.
    cycles : int, default 0
        Number of cycles of the step responses; 0: about five time constants.
    hinge_offset : float or str, default 0.0
        Distance from the body's middle plane to the axis of a wing's stroke [m].
    maps : bool, default True
        Compute the static maps, which take most of the time.

    Returns
    -------
    ControlModels
        The keys of `wingbeat linearise --json`; `discrete` and `continuous` are the linear models.

    Raises
    ------
    InputError
        For invalid options.

    Examples
    --------
    >>> models = wb.linearise(wb.read("friction2022"), frequency="22 Hz", maps=False)
    >>> f"{models['model']['period_s']:.5f} s"
    '0.04545 s'
    """
    one_of(frequency=frequency, lift=lift)
    found = _core.linearise(
        vehicle_of(vehicle)._design,
        text("condition", condition),
        optional_number("frequency", frequency, "Hz"),
        optional_number("lift", lift, "N"),
        flag("allow_extrapolation", allow_extrapolation),
        whole("cycles", cycles, 0, 100_000),
        number("hinge_offset", hinge_offset, "m"),
        flag("maps", maps),
    )
    return ControlModels(found)
