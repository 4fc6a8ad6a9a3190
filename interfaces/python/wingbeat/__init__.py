"""Electromechanical model of flapping-wing micro air vehicles.

    import wingbeat as wb
    vehicle = wb.read("friction2022.toml")              # or wb.Vehicle({...}); vehicle.motor.inertia
    result = vehicle.solve(voltage="3 V")               # result.status, result.lift_mean, result.cycle
    result.gradient("lift_mean", ["transmission.crank_radius"])
    vehicle.simulate().time_to_steady
    vehicle.simulation().step_to(0.1)                   # under commanded voltages, for controllers
    vehicle.linearise().discrete.to_scipy()             # for control design
    vehicle.sweep({"supply.voltage": [2, 3, 4]})        # xarray
    wb.solve({"supply.voltage": [2, 3, 4]}, vehicle=vehicle).lift_mean
    vehicle.equations_of_motion().rates(time, state)    # for SciPy
    wb.optimise("optimise-hover.toml").vehicle          # likewise fit, tolerance, endurance, identify_motor
    import wingbeat.plot                                # figures, with matplotlib

Everything is SI and radians unless a unit says otherwise; wherever a quantity is expected, a number is SI and a text has
its unit. A vehicle that does not flap is a result, never an exception; input that cannot be used raises InputError.
"""

from ._core import version as __version__
from ._ensemble import Ensemble, solve_columns
from ._equations import EquationsOfMotion
from ._errors import InputError
from ._linear import ControlModels, LinearModel, linearise
from ._optimise import Front, OwnOptimum, optimise
from ._parts import coefficient_curves, kinematics, motor_curves
from ._quantity import Quantity
from ._result import EnergyBalance, Event, RunResult, StartUp, simulate, solve
from ._sections import Section
from ._simulation import Simulation, SimulationState
from ._studies import Flight, Found, Identification, StudyResult, endurance, fit, identify_motor, tolerance
from ._sweep import open_dataset, sweep
from ._tables import Metric, Parameter, metrics, parameters
from ._vehicle import Vehicle, read

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
    "simulate",
    "solve",
    "solve_columns",
    "sweep",
    "tolerance",
]
