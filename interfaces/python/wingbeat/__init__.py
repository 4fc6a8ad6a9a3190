"""Electromechanical model of flapping-wing micro air vehicles.

    import wingbeat as wb
    vehicle = wb.read("friction2022")                   # shipped; or a file, or wb.Vehicle({...})
    result = vehicle.solve(voltage="3 V")               # result.status, result.lift_mean, result.cycle
    result.gradient("lift_mean", ["transmission.crank_radius"])
    vehicle.simulate().time_to_steady
    vehicle.simulation().step_to(0.1)                   # under commanded voltages, for controllers
    vehicle.linearise().discrete.to_scipy()             # for control design
    vehicle.sweep({"supply.voltage": [2, 3, 4]})        # xarray
    wb.solve({"supply.voltage": [2, 3, 4]}, vehicle=vehicle).lift_mean
    vehicle.equations_of_motion().rates(time, state)    # for SciPy
    wb.fit(vehicle, data, parameters={"friction.radius": (0, "8 mm")}).vehicle
    wb.optimise("optimise-hover").vehicle               # likewise tolerance, endurance, identify_motor
    wb.plot.cycle(result)                               # figures, with matplotlib

Units: wherever a quantity is expected, a number is SI (an angle in radians), and a text has its unit: 0.005 or "5 mm".
What comes back is SI. A vehicle that does not flap is a result, never an exception; input that cannot be used raises
InputError.
"""

import importlib
from typing import TYPE_CHECKING, Any

from ._core import version as __version__
from ._ensemble import Ensemble, solve_columns
from ._equations import EquationsOfMotion
from ._errors import InputError
from ._fit import fit
from ._linear import ControlModels, LinearModel, linearise
from ._optimise import Front, OwnOptimum, optimise
from ._parts import coefficient_curves, kinematics, motor_curves
from ._quantity import Quantity
from ._result import EnergyBalance, Event, RunResult, StartUp, simulate
from ._sections import Section
from ._simulation import Simulation, SimulationState
from ._solve import solve
from ._studies import Flight, Found, Identification, StudyResult, endurance, identify_motor, tolerance
from ._sweep import open_dataset, sweep
from ._tables import Metric, Parameter, metrics, parameters
from ._vehicle import Vehicle, read, shipped

__all__ = [
    "ControlModels",
    "EnergyBalance",
    "Ensemble",
    "EquationsOfMotion",
    "Event",
    "Flight",
    "Found",
    "Front",
    "Identification",
    "InputError",
    "LinearModel",
    "Metric",
    "OwnOptimum",
    "Parameter",
    "Quantity",
    "RunResult",
    "Section",
    "Simulation",
    "SimulationState",
    "StartUp",
    "StudyResult",
    "Vehicle",
    "__version__",
    "coefficient_curves",
    "endurance",
    "fit",
    "identify_motor",
    "kinematics",
    "linearise",
    "metrics",
    "motor_curves",
    "open_dataset",
    "optimise",
    "parameters",
    "read",
    "shipped",
    "simulate",
    "solve",
    "solve_columns",
    "sweep",
    "tolerance",
]

if TYPE_CHECKING:
    from . import plot as plot
    from ._accessor import SweepData as SweepData
else:

    def __getattr__(name: str) -> Any:
        """SweepData, which needs xarray, and `wingbeat.plot`, which needs matplotlib, where they are first asked for."""
        if name == "SweepData":
            from ._accessor import SweepData

            return SweepData
        if name == "plot":
            return importlib.import_module(".plot", __name__)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
