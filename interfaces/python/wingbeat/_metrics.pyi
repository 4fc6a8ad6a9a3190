# Written by scripts/make-python-stubs from the tables of the library.
from typing import Any

from ._quantity import Quantity
from ._tables import Metric

def number(metric: Metric, value: float) -> Quantity | None: ...

class WithMetrics:
    _metrics: Any
    @property
    def metrics(self) -> dict[str, Quantity | None]:
        """All metrics by name."""
    @property
    def voltage(self) -> Quantity | None:
        """Supply voltage [V]."""
    @property
    def frequency(self) -> Quantity | None:
        """Flapping frequency [Hz]."""
    @property
    def current_mean(self) -> Quantity | None:
        """Mean current [A]."""
    @property
    def current_peak(self) -> Quantity | None:
        """Peak current [A]."""
    @property
    def current_rms(self) -> Quantity | None:
        """Root mean square of the current [A]."""
    @property
    def power_electrical(self) -> Quantity | None:
        """Mean electrical input power [W]."""
    @property
    def power_motor(self) -> Quantity | None:
        """Mean motor output power [W]."""
    @property
    def power_motor_reference(self) -> Quantity | None:
        """Bench estimate of the motor output power [W]."""
    @property
    def power_friction(self) -> Quantity | None:
        """Mean friction loss of the transmission [W]."""
    @property
    def power_aerodynamic(self) -> Quantity | None:
        """Mean aerodynamic power [W]."""
    @property
    def power_reactive(self) -> Quantity | None:
        """Mean absolute reactive power [W]."""
    @property
    def power_copper(self) -> Quantity | None:
        """Mean copper loss of the motor [W]."""
    @property
    def power_viscous(self) -> Quantity | None:
        """Mean viscous loss of the motor [W]."""
    @property
    def power_motor_friction(self) -> Quantity | None:
        """Mean loss in the motor's own constant friction [W]."""
    @property
    def power_gear(self) -> Quantity | None:
        """Mean loss of the gearbox under load [W]."""
    @property
    def power_electronics(self) -> Quantity | None:
        """Mean loss of the electronics, of a piezo with its dielectric's [W]."""
    @property
    def power_loss(self) -> Quantity | None:
        """Mean total loss [W]."""
    @property
    def power_residual(self) -> Quantity | None:
        """Mean power the transmission formulation fails to conserve [W]."""
    @property
    def lift_mean(self) -> Quantity | None:
        """Mean lift [N]."""
    @property
    def lift_peak(self) -> Quantity | None:
        """Peak lift [N]."""
    @property
    def rod_force_peak(self) -> Quantity | None:
        """Peak magnitude of the rod force [N]."""
    @property
    def rod_force_mean(self) -> Quantity | None:
        """Mean magnitude of the rod force [N]."""
    @property
    def stroke_amplitude(self) -> Quantity | None:
        """Stroke amplitude, half peak to peak [rad]."""
    @property
    def flapping_velocity_peak(self) -> Quantity | None:
        """Peak flapping velocity [rad/s]."""
    @property
    def angle_of_attack_min(self) -> Quantity | None:
        """Smallest angle of attack [degree]."""
    @property
    def crank_speed_min(self) -> Quantity | None:
        """Smallest crank speed [rad/s]."""
    @property
    def crank_speed_max(self) -> Quantity | None:
        """Largest crank speed [rad/s]."""
    @property
    def efficiency_system(self) -> Quantity | None:
        """System efficiency [1]."""
    @property
    def efficiency_motor(self) -> Quantity | None:
        """Motor efficiency [1]."""
    @property
    def efficiency_mechanism(self) -> Quantity | None:
        """Mechanism efficiency [1]."""
    @property
    def floquet_multiplier_max(self) -> Quantity | None:
        """Largest modulus of the orbit's Floquet multipliers [1]."""
    @property
    def lift_to_weight(self) -> Quantity | None:
        """Mean lift over weight [1]."""
    @property
    def winding_temperature(self) -> Quantity | None:
        """Winding temperature of the motor [degC]."""
    @property
    def case_temperature(self) -> Quantity | None:
        """Case temperature of the motor [degC]."""
    @property
    def winding_temperature_margin(self) -> Quantity | None:
        """Largest winding temperature allowed, less the winding temperature [K]."""
    @property
    def added_mass_inertia_ratio(self) -> Quantity | None:
        """Inertia of the air that moves with the wings over the wings' own [1]."""
    @property
    def power_hinge(self) -> Quantity | None:
        """Mean loss in the damping and at the stops of the pitch hinges [W]."""
    @property
    def pitch_amplitude(self) -> Quantity | None:
        """Pitch amplitude, half peak to peak [degree]."""
    @property
    def pitch_phase(self) -> Quantity | None:
        """Lead of the pitching over the pitch that opposes the flapping velocity [degree]."""
    @property
    def angle_of_attack_max(self) -> Quantity | None:
        """Largest angle of attack of wings that pitch on a hinge [degree]."""
    @property
    def lift_added_mass_share(self) -> Quantity | None:
        """Part of the mean lift that comes from the added mass of wings on pitch hinges [1]."""
    @property
    def reynolds_number(self) -> Quantity | None:
        """Reynolds number of the mean chord at the mean speed of the wing tips [1]."""
    @property
    def stroke_angle_max(self) -> Quantity | None:
        """Largest stroke angle of a direct drive whose wings clap [rad]."""
    @property
    def induced_velocity(self) -> Quantity | None:
        """Induced velocity that the mean lift leads to, times the share that counts [m/s]."""
    @property
    def hover(self) -> Quantity | None:
        """Flight time until lift falls below the weight [s]."""
    @property
    def endurance(self) -> Quantity | None:
        """Flight time until the battery's end [s]."""
