"""A vehicle as a model of MuJoCo (MJCF): its body, to which another program applies what the wings do."""

from __future__ import annotations

import math
import os
import pathlib
from typing import Any
from xml.sax.saxutils import quoteattr

from . import _core
from ._arguments import flag, number, path, refused
from ._operations import operation
from ._vehicle import Vehicle, vehicle_of

#: Thickness of a wing or plate that is drawn [m].
_THICKNESS = 2e-4


def _text(*numbers: float) -> str:
    return " ".join(f"{x + 0.0:.9g}" for x in numbers)


def _turned(vector: Any) -> tuple[float, float, float]:
    """A vector of body axes (x forward, y right, z down) in axes of MuJoCo (x forward, y left, z up)."""
    return vector[0], -vector[1], -vector[2]


def _wing(index: int, wing: dict[str, Any]) -> list[str]:
    """A wing as a box along its span at stroke angle 0, and the site of its shoulder."""
    x, y, z = _turned(wing["shoulder"])
    side = "right" if wing["side"] > 0 else "left"
    # Turned about z by the mean angle forwards; the span of the right wing points to -y.
    forwards = wing["mean_angle"] * wing["side"]
    length, reach = wing["length"], -0.5 * wing["side"] * wing["length"]
    tilt, ahead = wing["tilt"], 0.5 * wing["length"] * math.sin(wing["mean_angle"])
    aside = reach * math.cos(wing["mean_angle"])
    place = (x + ahead * math.cos(tilt), y + aside, z + ahead * math.sin(tilt))
    size = (0.5 * wing["chord"], 0.5 * length, 0.5 * _THICKNESS)
    name = f"{side}-{index}"
    return [
        f'      <site name="shoulder-{name}" pos="{_text(x, y, z)}" size="0.001"/>',
        f'      <geom name="wing-{name}" class="visual" type="box" pos="{_text(*place)}" size="{_text(*size)}"'
        f' euler="{_text(0.0, -tilt, forwards)}"/>',
    ]


def _plate(index: int, plate: tuple[Any, Any, float]) -> str:
    place, normal, area = plate
    half = 0.5 * area**0.5
    centre = _text(*_turned(place))
    size = [0.5 * _THICKNESS if abs(n) > 0.5 else half for n in normal]
    return f'      <geom name="plate-{index}" class="visual" type="box" pos="{centre}" size="{_text(*size)}"/>'


def mjcf_of(vehicle: Vehicle, timestep: float = 1e-4) -> str:
    """The model as a text."""
    found = _core.flight_vehicle(vehicle._design)
    roll, pitch, yaw, product = found["inertia"]
    # The element xz of the matrix is -(integral of x z dm), and z changes its sign between the axes.
    inertia = _text(roll, pitch, yaw, 0.0, product, 0.0)
    radius = (0.4 * 2.5 * min(roll, pitch, yaw) / found["mass"]) ** 0.5
    lines = [
        f"<mujoco model={quoteattr(found['name'] or 'vehicle')}>",
        '  <compiler angle="radian" coordinate="local" inertiafromgeom="false"/>',
        f'  <option timestep="{_text(timestep)}" gravity="0 0 -9.80665" integrator="Euler" density="0" viscosity="0"/>',
        "  <default>",
        '    <default class="visual">',
        '      <geom contype="0" conaffinity="0" mass="0" group="1" rgba="0.3 0.5 0.7 0.6"/>',
        "    </default>",
        "  </default>",
        "  <worldbody>",
        '    <light pos="0 0 3" dir="0 0 -1"/>',
        '    <body name="body" pos="0 0 0">',
        '      <freejoint name="body"/>',
        f'      <inertial pos="0 0 0" mass="{_text(found["mass"])}" fullinertia="{inertia}"/>',
        f'      <geom name="body" class="visual" type="sphere" size="{_text(radius)}"/>',
        '      <site name="centre-of-mass" pos="0 0 0" size="0.001"/>',
    ]
    for index, wing in enumerate(found["wings"]):
        lines += _wing(index, wing)
    lines += [_plate(index, plate) for index, plate in enumerate(found["plates"])]
    lines += ["    </body>", "  </worldbody>", "</mujoco>"]
    return "\n".join(lines) + "\n"


@operation
def export_mjcf(
    vehicle: Vehicle, file: str | os.PathLike[str], *, timestep: float | str = 1e-4, force: bool = False
) -> None:
    """Writes the body of a vehicle as a model of MuJoCo, in MJCF.

    Parameters
    ----------
    vehicle : Vehicle
        A vehicle with a body.
    file : str or path
        The file to write, *.xml.
    timestep : float or str, default 0.0001
        Step of MuJoCo's integrator [s].
    force : bool, default False
        Replace an existing file.

    Raises
    ------
    InputError
        For a vehicle without a body, and for an existing file.

    Notes
    -----
    One free body with the mass and the moments of inertia of the whole vehicle. Wings, tail and fin are drawn, without
    mass and without contact; `interfaces/mujoco` computes their loads in each step. Axes of MuJoCo: x forward, y to the
    left, z up.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     wb.export_mjcf(wb.read("flight-friction2022"), folder + "/flyer.xml")
    """
    step = number("timestep", timestep, "s")
    if step <= 0.0:
        raise refused("timestep", f"must be > 0 s, got {timestep}")
    text = mjcf_of(vehicle_of(vehicle), step)
    to = pathlib.Path(os.fsdecode(path("file", file)))
    if to.exists() and not flag("force", force):
        raise refused("file", f"{to} exists; force=True replaces it")
    to.write_text(text, encoding="utf-8")
