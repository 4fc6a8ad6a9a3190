"""What a Vehicle does in flight: functions of the package as methods."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from ._operations import method_of, operations

if TYPE_CHECKING:
    from ._flight import FlightSimulation
    from ._studies import StudyResult
    from ._trim import FlightStability, Trim


class FlightMethods:
    """Methods that are functions of the package, of vehicles with a body."""

    __slots__ = ()

    @method_of("FlightSimulation")
    def flight_simulation(
        self, *, tolerance: float = 1e-7, gravity: float | str = 9.80665, frozen: bool = False
    ) -> FlightSimulation:
        """A flight, stepped in time: `wingbeat.FlightSimulation`.

        Examples
        --------
        >>> flight = wb.read("flight-friction2022").flight_simulation()
        >>> flight.step_to("10 ms"), flight.time
        (True, 0.01)
        """
        return operations["FlightSimulation"](  # type: ignore[no-any-return]
            self, tolerance=tolerance, gravity=gravity, frozen=frozen
        )

    @method_of("trim")
    def trim(
        self, *, speed: float | str = 0.0, climb: float | str = 0.0, turn_rate: float | str = 0.0
    ) -> Trim:
        """Controls and attitude of its steady flight: `wingbeat.trim`.

        Examples
        --------
        >>> wb.read("flight-friction2022").trim(speed="0.5 m/s").status
        'trimmed'
        """
        return operations["trim"](  # type: ignore[no-any-return]
            self, speed=speed, climb=climb, turn_rate=turn_rate
        )

    @method_of("flight_stability")
    def flight_stability(
        self,
        *,
        speed: float | str = 0.0,
        climb: float | str = 0.0,
        turn_rate: float | str = 0.0,
        sensitivity: bool = False,
    ) -> FlightStability:
        """Modes of its steady flight, and the linear model: `wingbeat.flight_stability`.

        Examples
        --------
        >>> found = wb.read("flight-friction2022").flight_stability()
        >>> bool(found.averaged[0].real > 0)
        True
        """
        return operations["flight_stability"](  # type: ignore[no-any-return]
            self, speed=speed, climb=climb, turn_rate=turn_rate, sensitivity=sensitivity
        )

    @method_of("flight_tolerance")
    def flight_tolerance(
        self,
        study: Mapping[str, Any],
        *,
        speed: float | str = 0.0,
        values: Mapping[str, Any] | None = None,
        threads: int = 0,
        progress: bool | Callable[[int, int], object] | None = None,
    ) -> StudyResult:
        """Effect of uncertain parameters on its steady flight: `wingbeat.flight_tolerance`.

        Examples
        --------
        >>> spread = {"key": "vehicle.mass", "distribution": "normal", "relative_deviation": 0.02}
        >>> found = wb.read("flight-friction2022").flight_tolerance({"samples": {"count": 16}, "parameter": [spread]})
        >>> found["flight"]["voltage_v"]["deviation"] > 0
        True
        """
        return operations["flight_tolerance"](  # type: ignore[no-any-return]
            self, study, speed=speed, values=values, threads=threads, progress=progress
        )

    @method_of("export_mjcf")
    def export_mjcf(self, file: str | os.PathLike[str], *, timestep: float | str = 1e-4, force: bool = False) -> None:
        """Its body as a model of MuJoCo: `wingbeat.export_mjcf`.

        Examples
        --------
        >>> import tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     wb.read("flight-friction2022").export_mjcf(folder + "/flyer.xml")
        """
        operations["export_mjcf"](self, file, timestep=timestep, force=force)
