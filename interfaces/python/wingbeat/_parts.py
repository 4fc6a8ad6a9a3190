"""Parts of a vehicle by themselves: curves of the motor, of the force coefficients and of the transmission."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arguments import array, mapping, optional_number, refused, wrong_type
from ._operations import operation
from ._tables import parameters
from ._vehicle import Vehicle

if TYPE_CHECKING:
    import xarray

#: What the rest of a vehicle is made of around a part that is given alone.
_KEYS = (
    "supply.voltage",
    *(f"motor.{name}" for name in ("armature_resistance", "armature_inductance", "torque_constant", "inertia")),
    "motor.viscous_damping",
    *(f"transmission.{name}" for name in ("crank_radius", "rod_length", "hinge_offset", "formulation")),
    *(f"wing.{name}" for name in ("count", "inertia", "planform.shape", "planform.length", "planform.root_chord")),
    *(f"aerodynamics.{name}" for name in ("air_density", "pitch_coefficient", "coefficients")),
)
_CHOICES = {"supply.type": "constant", "transmission.type": "slider-crank", "friction.type": "none"}


def _vehicle_with(section: str, part: Vehicle | Mapping[str, Any]) -> Vehicle:
    """A vehicle that has the part."""
    if isinstance(part, Vehicle):
        return part
    around = {key: parameters[key].example for key in _KEYS} | _CHOICES
    kept: dict[str, Any] = {key: value for key, value in around.items() if not key.startswith(f"{section}.")}
    keys = mapping(section, part, f"a wingbeat.Vehicle, or a dict of the keys of [{section}]")
    return Vehicle({**kept, section: dict(keys)})


def _column(dimension: str | tuple[()], values: Any, unit: str, long_name: str) -> Any:
    return (dimension, values, {"units": unit, "long_name": long_name})


@operation
def motor_curves(
    motor: Vehicle | Mapping[str, Any], *, voltage: float | str | None = None, speed: Any = None
) -> xarray.Dataset:
    """Curves of a motor at constant speed and terminal voltage, over the speed of its output shaft [rad/s].

    Parameters
    ----------
    motor : Vehicle or dict
        A Vehicle; or a dict with the keys of a section [motor], with all constants that a vehicle file needs.
    voltage : float or str, optional
        Voltage at the terminals [V]; default: that of the vehicle's supply. Needed with a dict.
    speed : array_like, shape (n,), optional
        Speeds of the output shaft [rad/s], >= 0, SI numbers or texts with a unit; default: from rest to no load.

    Returns
    -------
    xarray.Dataset
        A data set over `speed`: current [A], torque [N m], electrical and mechanical power [W], and efficiency, their
        ratio, NaN if the load drives the motor; as scalars `no_load_speed` [rad/s], `no_load_current` [A],
        `stall_current` [A] and `stall_torque` [N m].

    Raises
    ------
    InputError
        For invalid keys and values.
    TypeError
        For a dict without a voltage.

    Notes
    -----
    For several motors on one supply currents, torques and powers are sums. Friction of the mechanism is not included;
    the motor is at ambient temperature.

    Examples
    --------
    >>> curves = wb.motor_curves(wb.read("friction2022"), voltage="3 V")
    >>> f"{float(curves.stall_current):.4f} A"
    '0.3333 A'
    """
    import xarray

    vehicle = _vehicle_with("motor", motor)
    if voltage is None and not isinstance(motor, Vehicle):
        raise TypeError("a motor without a vehicle needs a voltage")
    speeds = [] if speed is None else array("speed", speed, "rad/s").ravel().tolist()
    if speed is not None and not speeds:
        raise refused("speed", "expected speeds, got none")
    v, free, idle, stalled, torque, columns = _core.motor_curves(
        vehicle._design, optional_number("voltage", voltage, "V"), speeds
    )
    current, shaft_torque, electrical, mechanical, omega = columns
    efficiency = np.divide(
        mechanical, electrical, out=np.full_like(electrical, np.nan), where=(electrical > 0) & (mechanical >= 0)
    )
    return xarray.Dataset(
        {
            "current": _column("speed", current, "A", "current"),
            "torque": _column("speed", shaft_torque, "N m", "torque on the output shaft"),
            "power_electrical": _column("speed", electrical, "W", "electrical power"),
            "power_mechanical": _column("speed", mechanical, "W", "mechanical power"),
            "efficiency": _column("speed", efficiency, "1", "efficiency"),
            "no_load_speed": _column((), free, "rad/s", "no-load speed"),
            "no_load_current": _column((), idle, "A", "no-load current"),
            "stall_current": _column((), stalled, "A", "stall current"),
            "stall_torque": _column((), torque, "N m", "stall torque"),
        },
        {"speed": _column("speed", omega, "rad/s", "speed of the output shaft")},
        {"voltage": v},
    )


@operation
def coefficient_curves(
    aerodynamics: Vehicle | Mapping[str, Any] | str, *, angle_of_attack: Any = None
) -> xarray.Dataset:
    """The force coefficients of a vehicle's wings over the angle of attack [rad].

    Parameters
    ----------
    aerodynamics : Vehicle, str or dict
        A Vehicle; or the value of the key aerodynamics.coefficients: the name of a set ("translational-2022",
        "normal-force-robofly") or a dict with a set of your own.
    angle_of_attack : array_like, shape (n,), optional
        Angles of attack [rad], SI numbers or texts with a unit; default: 0 to 90 deg.

    Returns
    -------
    xarray.Dataset
        A data set over `angle_of_attack`: lift C_L, drag C_D and the coefficient of the force normal to the chord C_N
        [1]; for wings on hinges also the centre of pressure behind the leading edge over the chord [1].

    Raises
    ------
    InputError
        For an unknown set, and for values that cannot be used.
    TypeError
        For an argument that is neither a vehicle nor a set.

    Examples
    --------
    >>> curves = wb.coefficient_curves("translational-2022", angle_of_attack=["45 deg"])
    >>> f"{float(curves.lift[0]):.3f}"
    '1.805'
    """
    import xarray

    if isinstance(aerodynamics, Vehicle):
        vehicle = aerodynamics
    elif not isinstance(aerodynamics, (str, Mapping)):
        expected = "a wingbeat.Vehicle, or the name or the dict of a set of coefficients"
        raise wrong_type("aerodynamics", expected, aerodynamics)
    else:
        own = {name.split(".")[1]: parameters[name].example for name in _KEYS if name.startswith("aerodynamics.")}
        vehicle = _vehicle_with("aerodynamics", {**own, "coefficients": aerodynamics})
    given = np.radians(np.linspace(0, 90, 181)) if angle_of_attack is None else angle_of_attack
    alpha = array("angle_of_attack", given, "rad")
    lift, drag, normal, pressure = _core.coefficient_curves(vehicle._design, alpha.ravel().tolist())
    made = {
        "lift": _column("angle_of_attack", lift, "1", "lift coefficient"),
        "drag": _column("angle_of_attack", drag, "1", "drag coefficient"),
        "normal_force": _column("angle_of_attack", normal, "1", "coefficient of the force normal to the chord"),
    }
    if not np.all(np.isnan(pressure)):
        made["centre_of_pressure"] = _column(
            "angle_of_attack", pressure, "1", "centre of pressure behind the leading edge over the chord"
        )
    return xarray.Dataset(made, {"angle_of_attack": _column("angle_of_attack", alpha.ravel(), "rad", "angle of attack")})


@operation
def kinematics(transmission: Vehicle | Mapping[str, Any], *, crank_angle: Any = None) -> xarray.Dataset:
    """The stroke of a transmission over the crank angle [rad].

    Parameters
    ----------
    transmission : Vehicle or dict
        A Vehicle; or a dict with the keys of its section [transmission].
    crank_angle : array_like, shape (n,), optional
        Crank angles [rad], SI numbers or texts with a unit; default: one turn.

    Returns
    -------
    xarray.Dataset
        A data set over `crank_angle`: the stroke angle [rad], its first and second derivative by the crank angle [1],
        and the levers of the internal force (of a slider-crank the rod force) on the crank and on all wings [m]; the
        stroke amplitude [rad] as a scalar, and the crank angles [rad] at which the stroke turns over the dimension
        `reversal`.

    Raises
    ------
    InputError
        For invalid keys and values, and for a direct drive.

    Examples
    --------
    >>> stroke = wb.kinematics(wb.read("friction2022"))
    >>> f"{np.degrees(float(stroke.stroke_amplitude)):.2f} deg"
    '39.81 deg'
    """
    import xarray

    vehicle = _vehicle_with("transmission", transmission)
    theta = np.linspace(0, 2 * np.pi, 361) if crank_angle is None else array("crank_angle", crank_angle, "rad").ravel()
    amplitude, reversals, columns = _core.kinematics(vehicle._design, theta.tolist())
    stroke, slope, curve, crank_lever, wing_lever = columns
    return xarray.Dataset(
        {
            "stroke_angle": _column("crank_angle", stroke, "rad", "stroke angle"),
            "stroke_slope": _column("crank_angle", slope, "1", "stroke angle by crank angle"),
            "stroke_curve": _column("crank_angle", curve, "1", "stroke angle twice by crank angle"),
            "crank_lever": _column("crank_angle", crank_lever, "m", "lever of the internal force on the crank"),
            "wing_lever": _column("crank_angle", wing_lever, "m", "lever of the internal force on all wings"),
            "stroke_amplitude": _column((), amplitude, "rad", "stroke amplitude"),
            "reversal_angle": _column("reversal", np.array(reversals), "rad", "crank angle at which the stroke turns"),
        },
        {"crank_angle": _column("crank_angle", theta, "rad", "crank angle")},
    )
