# Written by scripts/make-python-stubs from the tables of the library.
from typing import Any

from ._quantity import Quantity

def class_name(path: str) -> str: ...
def members(path: str) -> list[str]: ...

class Section:
    def __init__(self, vehicle: Any) -> None: ...
    def __dir__(self) -> list[str]: ...

class VehicleSection(Section):
    @property
    def name(self) -> str | None:
        """name of the vehicle, for reports.
        Range: any text. Default: no name.
        """
    @property
    def mass(self) -> Quantity | None:
        """mass of the vehicle without the masses stated separately (motor.mass, supply.mass, supply.specific_energy, spring.mass, transmission.rod_linear_density); enables lift_to_weight.
        [kg] Range: > 0. Default: unknown.
        """
    @property
    def motors(self) -> Quantity:
        """M, number of motors on the supply, each with its own transmission and wings, in phase.
        Number. Range: whole number >= 1. Default: 1.
        """

class SupplySection(Section):
    @property
    def type(self) -> str | None:
        """source at the motor terminals.
        Range: constant, sine, pwm, battery or battery-sine. Default: required.
        """
    @property
    def voltage(self) -> Quantity | None:
        """v, terminal voltage; pwm: while switched on.
        [V] Range: >= 0. Default: required.
        Only with supply.type = constant or pwm.
        """
    @property
    def amplitude(self) -> Quantity | None:
        """amplitude of the sine.
        [V] Range: >= 0. Default: required.
        Only with supply.type = sine or battery-sine.
        """
    @property
    def offset(self) -> Quantity | None:
        """V_0, constant part of the voltage, added to the sine.
        [V] Range: any. Default: 0 V.
        Only with supply.type = sine or battery-sine.
        """
    @property
    def frequency(self) -> Quantity | None:
        """drive frequency (sine) or switching frequency (pwm).
        [Hz] Range: > 0. Default: required or resonance_ratio.
        Only with supply.type = sine or pwm or battery-sine.
        Instead of supply.resonance_ratio.
        """
    @property
    def resonance_ratio(self) -> Quantity | None:
        """drive frequency over the frequency at which rotor and wings resonate on the springs; 1 drives a direct drive at resonance.
        Number. Range: > 0. Default: required or frequency.
        Only with transmission.type = direct.
        Instead of supply.frequency.
        """
    @property
    def duty(self) -> Quantity | None:
        """D, fraction of a period switched on; required for pwm, else of the speed control.
        Number. Range: 0 to 1. Default: 1.
        Only with supply.type = pwm or battery.
        """
    @property
    def throttle(self) -> str | None:
        """speed control in flight: fixed holds the duty (or a bridge's amplitude), hover sets it so that the mean lift carries the weight.
        Range: fixed or hover. Default: fixed.
        Only with supply.type = battery or battery-sine.
        """
    @property
    def cells(self) -> Quantity | None:
        """cells in series.
        Number. Range: whole number >= 1. Default: 1.
        Only with supply.type = battery or battery-sine.
        """
    @property
    def cell_voltage(self) -> Quantity | None:
        """E, open-circuit voltage of one cell at any charge.
        [V] Range: > 0. Default: required or discharge_curve.
        Only with supply.type = battery or battery-sine.
        Instead of supply.discharge_curve.
        """
    @property
    def discharge_curve(self) -> Any:
        """open-circuit voltage of one cell: rows [state of charge, voltage], monotone cubics, see below.
        Range: name of a CSV file, or rows from charge 0 to 1, voltages not falling. Default: required or cell_voltage.
        Only with supply.type = battery or battery-sine.
        Instead of supply.cell_voltage.
        """
    @property
    def internal_resistance(self) -> Quantity | None:
        """R_i of one cell: terminal voltage E - R_i i, times cells.
        [ohm] Range: >= 0. Default: required.
        Only with supply.type = battery or battery-sine.
        """
    @property
    def capacity(self) -> Quantity | None:
        """charge that a full cell holds.
        [C] Range: > 0. Default: required.
        Only with supply.type = battery or battery-sine.
        """
    @property
    def charge(self) -> Quantity | None:
        """state of charge of a run, and at the start of a flight.
        Number. Range: 0 to 1. Default: 1.
        Only with supply.type = battery or battery-sine.
        """
    @property
    def cutoff_voltage(self) -> Quantity | None:
        """mean terminal voltage of one cell at which a flight ends.
        [V] Range: >= 0. Default: none.
        Only with supply.type = battery or battery-sine.
        """
    @property
    def specific_energy(self) -> Quantity | None:
        """energy of the full battery without load over its mass: that mass, which grows with the capacity, is in addition to vehicle.mass.
        [J/kg] Range: > 0. Default: none: in vehicle.mass.
        Only with supply.type = battery or battery-sine.
        Instead of supply.mass.
        """
    @property
    def mass(self) -> Quantity | None:
        """mass of the battery, in addition to vehicle.mass.
        [kg] Range: >= 0. Default: none: in vehicle.mass.
        Only with vehicle.mass.
        Instead of supply.specific_energy.
        """

class MotorSection(Section):
    @property
    def gear_ratio(self) -> Quantity | None:
        """n, motor turns per output turn; with it the constants below hold at the motor shaft.
        Number. Range: > 0. Default: none: constants at the output shaft.
        """
    @property
    def gear_inertia(self) -> Quantity | None:
        """J_G, inertia of the gearbox at the output shaft.
        [kg m2] Range: >= 0. Default: 0 kg m2.
        Only with motor.gear_ratio.
        """
    @property
    def gear_damping(self) -> Quantity | None:
        """b_G, viscous damping of the gearbox at the output shaft.
        [N m s/rad] Range: >= 0. Default: 0 N m s/rad.
        Only with motor.gear_ratio.
        """
    @property
    def gear_efficiency(self) -> Quantity:
        """eta, torque behind the gearbox over torque before it while the motor drives; 1/eta while the load drives.
        Number. Range: > 0, <= 1. Default: 1.
        """
    @property
    def armature_resistance(self) -> Quantity | None:
        """R_a, armature resistance.
        [ohm] Range: > 0. Default: required unless piezo.force_per_volt.
        """
    @property
    def armature_inductance(self) -> Quantity | None:
        """L_a, armature inductance; 0, or a lag of the current below 1e-9 rad, makes it algebraic.
        [H] Range: >= 0. Default: required unless piezo.force_per_volt.
        """
    @property
    def torque_constant(self) -> Quantity | None:
        """K at the output shaft; K_b at the motor shaft with gear_ratio.
        [N m/A] Range: > 0. Default: required unless piezo.force_per_volt.
        """
    @property
    def inertia(self) -> Quantity | None:
        """J, rotor and gearbox at the output shaft; J_m of the rotor with gear_ratio.
        [kg m2] Range: > 0. Default: required unless piezo.force_per_volt.
        """
    @property
    def viscous_damping(self) -> Quantity | None:
        """b, motor and gearbox at the output shaft; b_m of the motor with gear_ratio.
        [N m s/rad] Range: >= 0. Default: required unless piezo.force_per_volt.
        """
    @property
    def friction_torque(self) -> Quantity:
        """constant friction torque of the motor itself, before its gearbox, at the motor shaft with gear_ratio; in addition to every friction law, and it heats the motor.
        [N m] Range: >= 0. Default: 0 N m.
        """
    @property
    def core_torque(self) -> Quantity:
        """c_h, hysteresis of a brushless motor's core: a constant torque against its speed, at the motor shaft with gear_ratio; counts as the motor's own friction.
        [N m] Range: >= 0. Default: 0 N m.
        """
    @property
    def core_damping(self) -> Quantity:
        """c_e, eddy currents of a brushless motor's core: a torque that grows with the speed, at the motor shaft with gear_ratio; counts as viscous damping.
        [N m s/rad] Range: >= 0. Default: 0 N m s/rad.
        """
    @property
    def mass(self) -> Quantity | None:
        """mass of one motor with its gearbox, in addition to vehicle.mass.
        [kg] Range: >= 0. Default: none: in vehicle.mass.
        Only with vehicle.mass.
        """
    @property
    def thermal_resistance_winding(self) -> Quantity | None:
        """R_th1, thermal resistance from winding to case; with it the constants depend on temperature.
        [K/W] Range: >= 0. Default: none: constants the same at any load.
        """
    @property
    def thermal_resistance_case(self) -> Quantity | None:
        """R_th2, thermal resistance from case to air.
        [K/W] Range: >= 0. Default: required.
        Only with motor.thermal_resistance_winding.
        """
    @property
    def ambient_temperature(self) -> Quantity | None:
        """T_amb, of the air about the motor.
        [K] Range: 173.15 to 1000 K (-100 to 727 degC). Default: 298.15 K.
        Only with motor.thermal_resistance_winding.
        """
    @property
    def reference_temperature(self) -> Quantity | None:
        """T_0 at which armature_resistance and torque_constant are stated.
        [K] Range: 173.15 to 1000 K (-100 to 727 degC). Default: 298.15 K.
        Only with motor.thermal_resistance_winding.
        """
    @property
    def copper_temperature_coefficient(self) -> Quantity | None:
        """a_Cu: R_a grows as 1 + a_Cu (T_winding - T_0).
        [1/K] Range: >= 0. Default: 0.0039 1/K.
        Only with motor.thermal_resistance_winding.
        """
    @property
    def magnet_temperature_coefficient(self) -> Quantity | None:
        """a_B: K falls as 1 + a_B (T_case - T_0), about -0.001 1/K of NdFeB.
        [1/K] Range: <= 0. Default: 0 1/K.
        Only with motor.thermal_resistance_winding.
        """
    @property
    def winding_temperature_max(self) -> Quantity | None:
        """largest winding temperature, from the data sheet: above it a result is outside the domain; 125 degC unless given.
        [K] Range: 173.15 to 1000 K (-100 to 727 degC). Default: 398.15 K.
        Only with motor.thermal_resistance_winding.
        """
    @property
    def thermal_time_constant_winding(self) -> Quantity | None:
        """tau_w, of the winding over the case, for `wingbeat endurance`.
        [s] Range: > 0. Default: none.
        Only with motor.thermal_resistance_winding.
        """
    @property
    def thermal_time_constant_case(self) -> Quantity | None:
        """tau_c, of the case over the air, for `wingbeat endurance`.
        [s] Range: > 0. Default: none.
        Only with motor.thermal_resistance_winding.
        """

class ElectronicsSection(Section):
    @property
    def efficiency(self) -> Quantity | None:
        """eta_esc of a brushless motor's electronics: power into the motor over power from the supply; given, no current flows back into the supply.
        Number. Range: > 0, <= 1. Default: none: no electronics.
        """
    @property
    def current_max(self) -> Quantity | None:
        """i_max to which they limit the current of one motor.
        [A] Range: > 0. Default: none.
        Only with electronics.efficiency.
        """
    @property
    def regeneration(self) -> bool:
        """current may flow back: where the back-EMF exceeds the voltage the motor brakes.
        Range: true or false. Default: false.
        Only with electronics.efficiency.
        """

class PiezoSection(Section):
    @property
    def force_per_volt(self) -> Quantity | None:
        """kappa of a piezo bimorph that replaces the motor: force at its tip per volt.
        [N/V] Range: > 0. Default: none: a motor.
        """
    @property
    def voltage_factor(self) -> Quantity | None:
        """kappa_1: the force grows as kappa (1 + kappa_1 abs(V)) V.
        [1/V] Range: >= 0. Default: 0 1/V.
        Only with piezo.force_per_volt.
        """
    @property
    def stiffness(self) -> Quantity | None:
        """k_a of the bimorph at its tip.
        [N/m] Range: > 0. Default: required.
        Only with piezo.force_per_volt.
        """
    @property
    def damping(self) -> Quantity | None:
        """c_a of the bimorph at its tip.
        [N s/m] Range: >= 0. Default: 0 N s/m.
        Only with piezo.force_per_volt.
        """
    @property
    def mass(self) -> Quantity | None:
        """m_a, mass that moves with the tip.
        [kg] Range: > 0. Default: required.
        Only with piezo.force_per_volt.
        """
    @property
    def capacitance(self) -> Quantity | None:
        """C of the bimorph.
        [F] Range: >= 0. Default: 0 F.
        Only with piezo.force_per_volt.
        """
    @property
    def loss_tangent(self) -> Quantity | None:
        """tan d of its dielectric.
        Number. Range: >= 0. Default: 0.
        Only with piezo.force_per_volt.
        """
    @property
    def recovered_share(self) -> Quantity | None:
        """share of the energy returned by the capacitance in a cycle that the electronics recover.
        Number. Range: 0 to 1. Default: 1.
        Only with piezo.force_per_volt.
        """
    @property
    def transmission_ratio(self) -> Quantity | None:
        """T_1: stroke angle over tip displacement, beta = T_1 x + T_3 x^3.
        [rad/m] Range: > 0. Default: required.
        Only with piezo.force_per_volt.
        """
    @property
    def transmission_cubic(self) -> Quantity | None:
        """T_3 of the transmission.
        [rad/m3] Range: >= 0. Default: 0 rad/m3.
        Only with piezo.force_per_volt.
        """
    @property
    def series_stiffness(self) -> Quantity | None:
        """k_s between the tip and the transmission.
        [N/m] Range: > 0. Default: none: rigid.
        Only with piezo.force_per_volt.
        """

class TransmissionSection(Section):
    @property
    def type(self) -> str | None:
        """kind of mechanism between motor and wings; direct: the motor shaft is the wing hinge.
        Range: slider-crank, four-bar, tabulated or direct. Default: required.
        """
    @property
    def crank_radius(self) -> Quantity | None:
        """r_c, crank radius.
        [m] Range: > 0, < every other link. Default: required.
        Only with transmission.type = slider-crank or four-bar.
        """
    @property
    def rod_length(self) -> Quantity | None:
        """l, rod length.
        [m] Range: > crank_radius. Default: required.
        Only with transmission.type = slider-crank.
        """
    @property
    def hinge_offset(self) -> Quantity | None:
        """H, horizontal distance from slider to wing hinge.
        [m] Range: > 0. Default: required or stroke_amplitude.
        Only with transmission.type = slider-crank.
        Instead of transmission.stroke_amplitude.
        """
    @property
    def stroke_amplitude(self) -> Quantity | None:
        """half the peak-to-peak stroke angle; fixes H = r_c / tan(stroke_amplitude); not with mid_stroke_height.
        [rad] Range: > 0, < pi/2. Default: required or hinge_offset.
        Only with transmission.type = slider-crank.
        Instead of transmission.hinge_offset.
        """
    @property
    def mid_stroke_height(self) -> Quantity | None:
        """y_0, slider height over the crank axis at stroke angle zero.
        [m] Range: any. Default: rod_length.
        Only with transmission.type = slider-crank.
        """
    @property
    def rod_linear_density(self) -> Quantity | None:
        """mass of the rod or coupler over its length: that length times this, in addition to vehicle.mass.
        [kg/m] Range: >= 0. Default: none: in vehicle.mass.
        Only with vehicle.mass.
        """
    @property
    def coupler_length(self) -> Quantity | None:
        """l, from crank pin to rocker pin.
        [m] Range: > 0. Default: required.
        Only with transmission.type = four-bar.
        """
    @property
    def rocker_length(self) -> Quantity | None:
        """p, from rocker axis to rocker pin.
        [m] Range: > 0. Default: required.
        Only with transmission.type = four-bar.
        """
    @property
    def ground_length(self) -> Quantity | None:
        """d, from crank axis to rocker axis.
        [m] Range: > 0. Default: required.
        Only with transmission.type = four-bar.
        """
    @property
    def stroke_ratio(self) -> Quantity | None:
        """n_s, turning angle of the wings over that of the rocker: sector gear or string.
        Number. Range: > 0. Default: 1.
        Only with transmission.type = four-bar.
        """
    @property
    def ground_angle(self) -> Quantity | None:
        """phi_mid, angle of the rocker from the direction crank axis to rocker axis at stroke angle zero.
        [rad] Range: any. Default: middle of the rocker's swing.
        Only with transmission.type = four-bar.
        """
    @property
    def file(self) -> str | None:
        """stroke law: columns crank_angle and stroke_angle, see below.
        Range: name of a CSV file. Default: required or stroke_table.
        Only with transmission.type = tabulated.
        Instead of transmission.stroke_table.
        """
    @property
    def stroke_table(self) -> Any:
        """stroke law in place: rows [crank angle, stroke angle], periodic spline of degree five.
        Range: four or more rows within a turn, crank angles growing. Default: required or file.
        Only with transmission.type = tabulated.
        Instead of transmission.file.
        """
    @property
    def stroke_scale(self) -> Quantity | None:
        """multiplies the stroke angles of the table.
        Number. Range: > 0. Default: 1.
        Only with transmission.type = tabulated.
        """
    @property
    def reference_radius(self) -> Quantity | None:
        """r_ref, radius at which the moment of the wings acts: load-proportional friction acts on that moment over r_ref.
        [m] Range: > 0. Default: required.
        Only with transmission.type = tabulated.
        """
    @property
    def formulation(self) -> str | None:
        """how the rod force turns the wings: the paper's eq (1), or conserving power exactly.
        Range: rod-force or virtual-work. Default: required.
        Only with transmission.type = slider-crank.
        """

class FrictionSection(Section):
    @property
    def type(self) -> str | None:
        """law of the transmission's friction torque T_f on the crank or shaft.
        Range: none, load-proportional, viscous, quadratic or constant. Default: required.
        """
    @property
    def radius(self) -> Quantity | None:
        """mu r_e, effective friction radius: T_f = mu r_e abs(F).
        [m] Range: >= 0. Default: required.
        Only with friction.type = load-proportional.
        """
    @property
    def reference_radius(self) -> Quantity | None:
        """r_ref, radius at which the moment of the wings acts: load-proportional friction acts on that moment over r_ref.
        [m] Range: > 0. Default: none.
        Only with transmission.type = direct.
        """
    @property
    def damping(self) -> Quantity | None:
        """b_f: T_f = b_f omega.
        [N m s/rad] Range: >= 0. Default: required.
        Only with friction.type = viscous.
        """
    @property
    def coefficient(self) -> Quantity | None:
        """c_f: T_f = c_f omega abs(omega).
        [N m s2/rad2] Range: >= 0. Default: required.
        Only with friction.type = quadratic.
        """
    @property
    def torque(self) -> Quantity | None:
        """T_c: T_f = T_c sign(omega).
        [N m] Range: >= 0. Default: required.
        Only with friction.type = constant.
        """

class SpringSection(Section):
    @property
    def stiffness(self) -> Quantity | None:
        """k, stiffness of one hinge spring, at rest at stroke angle zero or at rest_angle.
        [N m/rad] Range: >= 0. Default: required or resonance.
        Instead of spring.resonance or spring.resonance_ratio.
        """
    @property
    def resonance(self) -> Quantity | None:
        """f_s, resonance of one wing on its spring, k = J_w (2 pi f_s)^2; direct drive: of rotor and wings on all springs, N_w k = (J + N_w J_w) (2 pi f_s)^2.
        [Hz] Range: >= 0. Default: required or stiffness.
        Instead of spring.stiffness or spring.resonance_ratio.
        """
    @property
    def resonance_ratio(self) -> Quantity | None:
        """frequency at which rotor and wings resonate on the springs, over the drive frequency; 1 tunes the springs to the supply.
        Number. Range: > 0. Default: required or stiffness.
        Only with transmission.type = direct.
        Instead of spring.stiffness or spring.resonance.
        """
    @property
    def rest_angle(self) -> Quantity | None:
        """beta_0, stroke angle at which the hinge springs are at rest, positive forward: the middle of the stroke without a mean voltage.
        [rad] Range: > -pi/2, < pi/2. Default: 0 rad.
        Only with transmission.type = direct.
        """
    @property
    def mass(self) -> Quantity | None:
        """mass of one hinge spring, in addition to vehicle.mass; one for each wing.
        [kg] Range: >= 0. Default: none: in vehicle.mass.
        Only with vehicle.mass.
        """

class WingTorsionSection(Section):
    @property
    def stiffness(self) -> Quantity | None:
        """k_tau, torsion of one wing along its span: twist of the tip against the root, linear between; given, twist is a degree of freedom, in addition to the pitch hinge or instead of it.
        [N m/rad] Range: > 0. Default: none: no twist.
        """
    @property
    def damping(self) -> Quantity | None:
        """c_tau of one wing.
        [N m s/rad] Range: >= 0. Default: 0 N m s/rad.
        Only with wing.torsion.stiffness.
        """

class WingPlanformSection(Section):
    @property
    def shape(self) -> str | None:
        """how the wing's outline is given.
        Range: semi-ellipse, rectangle, tabulated or moments. Default: required.
        """
    @property
    def length(self) -> Quantity | None:
        """R, wing root to tip.
        [m] Range: > 0. Default: required.
        Only with wing.planform.shape = semi-ellipse or rectangle.
        """
    @property
    def root_chord(self) -> Quantity | None:
        """c_0, chord at the root.
        [m] Range: > 0. Default: required or chord_ratio.
        Only with wing.planform.shape = semi-ellipse or rectangle.
        Instead of wing.planform.chord_ratio.
        """
    @property
    def chord_ratio(self) -> Quantity | None:
        """c_0 / R, chord at the root over the length: it follows when the length changes.
        Number. Range: > 0. Default: required or root_chord.
        Only with wing.planform.shape = semi-ellipse or rectangle.
        Instead of wing.planform.root_chord.
        """
    @property
    def hub_offset(self) -> Quantity | None:
        """distance from the hinge to the wing root.
        [m] Range: >= 0. Default: 0 m.
        Only with wing.planform.shape = semi-ellipse or rectangle or tabulated.
        """
    @property
    def shoulder_distance(self) -> Quantity | None:
        """distance between the hinges of two wings that share a body: the farther apart, the farther beyond 90 deg they may swing before they meet.
        [m] Range: >= 0. Default: 0 m.
        Only with wing.planform.shape = semi-ellipse or rectangle or tabulated.
        """
    @property
    def file(self) -> str | None:
        """chord table: columns distance (from the root) and chord, see below.
        Range: name of a CSV file. Default: required or chords.
        Only with wing.planform.shape = tabulated.
        Instead of wing.planform.chords.
        """
    @property
    def chords(self) -> Any:
        """chord table in place: rows [distance from the root, chord], linear between.
        Range: two or more rows, distances growing, chords >= 0. Default: required or file.
        Only with wing.planform.shape = tabulated.
        Instead of wing.planform.file.
        """
    @property
    def s2(self) -> Quantity | None:
        """S_2 = N_w integral c r^2 dr of all wings.
        [m4] Range: >= 0. Default: required.
        Only with wing.planform.shape = moments.
        """
    @property
    def s3(self) -> Quantity | None:
        """S_3 = N_w integral c r^3 dr of all wings.
        [m5] Range: >= 0. Default: required.
        Only with wing.planform.shape = moments.
        """
    @property
    def s22(self) -> Quantity | None:
        """S_22 = N_w integral c^2 r^2 dr of all wings, for added mass.
        [m5] Range: >= 0. Default: none.
        Only with wing.planform.shape = moments.
        """
    @property
    def scale(self) -> Quantity:
        """s, multiplies length, chords and hub_offset of the outline; s2, s3 and s22 with s^4, s^5 and s^5.
        Number. Range: > 0. Default: 1.
        """
    @property
    def scale_inertia(self) -> bool:
        """inertia, pitch_inertia and mass_product grow with s^5; false: they are those of the scaled wing.
        Range: true or false. Default: true.
        """

class WingSection(Section):
    @property
    def count(self) -> Quantity:
        """N_w, number of wings that one motor drives.
        Number. Range: whole number >= 1. Default: 2.
        """
    @property
    def inertia(self) -> Quantity | None:
        """J_w, inertia of one wing about its hinge.
        [kg m2] Range: > 0. Default: required or resonance.
        Instead of wing.resonance or wing.areal_density.
        """
    @property
    def resonance(self) -> Quantity | None:
        """frequency at which rotor and wings resonate on springs of a given stiffness: the inertia follows, J + N_w J_w = N_w k / (2 pi f)^2.
        [Hz] Range: > 0. Default: required or inertia.
        Only with transmission.type = direct.
        Instead of wing.inertia or wing.areal_density.
        """
    @property
    def areal_density(self) -> Quantity | None:
        """sigma of the membrane, glue spread over it: the inertia follows from the planform's outline, J_w = integral (sigma c + lambda) r^2 dr and that of the ribs.
        [kg/m2] Range: > 0. Default: required or inertia.
        Instead of wing.inertia or wing.resonance.
        """
    @property
    def spar_density(self) -> Quantity | None:
        """lambda, mass of the leading-edge spar over its length, from root to tip.
        [kg/m] Range: >= 0. Default: 0 kg/m.
        Only with wing.areal_density.
        """
    @property
    def rib_density(self) -> Quantity | None:
        """lambda_r, mass of a rib over its length, along the chord from edge to edge.
        [kg/m] Range: >= 0. Default: 0 kg/m.
        Only with wing.areal_density.
        """
    @property
    def rib_count(self) -> Quantity | None:
        """n_r, ribs of one wing, which divide its length into n_r + 1 equal bays.
        Number. Range: whole number, 0 to 1000. Default: 0.
        Only with wing.areal_density.
        """
    @property
    def pitch_inertia(self) -> Quantity | None:
        """I_psi = integral x^2 dm of one wing about its pitch axis, where it pitches or twists; given with mass_product, or both follow from areal_density.
        [kg m2] Range: > 0. Default: from areal_density.
        """
    @property
    def mass_product(self) -> Quantity | None:
        """P = integral r x dm of one wing, r from the flapping hinge, x behind the pitch axis.
        [kg m2] Range: any. Default: from areal_density.
        """
    @property
    def torsion(self) -> WingTorsionSection:
        """The section [wing.torsion]."""
    @property
    def planform(self) -> WingPlanformSection:
        """The section [wing.planform]."""

class PitchSection(Section):
    @property
    def stiffness(self) -> Quantity | None:
        """k_psi of the hinge about which one wing pitches; given, pitch is a degree of freedom.
        [N m/rad] Range: >= 0. Default: none: the pitch law.
        """
    @property
    def damping(self) -> Quantity | None:
        """c_psi of one hinge.
        [N m s/rad] Range: >= 0. Default: 0 N m s/rad.
        Only with pitch.stiffness.
        """
    @property
    def stop(self) -> Quantity | None:
        """psi_max, pitch angle to either side at which stops hold the wing.
        [rad] Range: > 0, < pi. Default: none.
        Only with pitch.stiffness.
        Instead of pitch.stop_low or pitch.stop_high.
        """
    @property
    def stop_low(self) -> Quantity | None:
        """lower stop, if the stops differ: smallest psi; the trailing edge is behind a wing that swings forward then.
        [rad] Range: < 0, > -pi. Default: none.
        Only with pitch.stiffness.
        Instead of pitch.stop.
        """
    @property
    def stop_high(self) -> Quantity | None:
        """upper stop, if the stops differ: largest psi.
        [rad] Range: > 0, < pi. Default: none.
        Only with pitch.stiffness.
        Instead of pitch.stop.
        """
    @property
    def friction(self) -> Quantity | None:
        """T_psi, constant friction of one hinge's joint.
        [N m] Range: >= 0. Default: 0 N m.
        Only with pitch.stiffness.
        """
    @property
    def rotational_lift(self) -> bool:
        """the force that the circulation of a pitching wing adds, C_rot = pi (0.75 - x_0).
        Range: true or false. Default: true, with normal-force-robofly and robobee false.
        Only with pitch.stiffness.
        """
    @property
    def damping_coefficient(self) -> Quantity | None:
        """C_rd, drag coefficient of a wing that turns about its leading edge.
        Number. Range: >= 0. Default: 0, with normal-force-robofly and robobee 5.
        Only with pitch.stiffness.
        """
    @property
    def axis(self) -> Quantity | None:
        """x_0, position of the pitch axis behind the leading edge over the chord: C_rot = pi (0.75 - x_0).
        Number. Range: 0 to 0.75. Default: 0.
        Only with pitch.stiffness.
        """
    @property
    def leading_edge_suction(self) -> Quantity | None:
        """s_L, share of the added mass's force along the chord that counts as lift: with 1 added mass has no mean lift.
        Number. Range: 0 to 1. Default: 0.
        Only with pitch.stiffness.
        """

class AerodynamicsClapAndFlingSection(Section):
    @property
    def amplitude(self) -> Quantity | None:
        """A: where wings meet at the reversal with the largest stroke angle, all aerodynamic forces are multiplied by 1 + A exp(-s / (lambda c)) as they part, where s is the path of the 70 % station since then and c the mean chord.
        Number. Range: >= 0. Default: none.
        """
    @property
    def decay(self) -> Quantity | None:
        """lambda, length of its decay over the mean chord.
        Number. Range: > 0. Default: 1.
        Only with aerodynamics.clap_and_fling.amplitude.
        """
    @property
    def gap(self) -> Quantity | None:
        """g, distance over the mean chord of the 70 % stations of the two wings at the reversal, up to which they interact.
        Number. Range: >= 0. Default: 1.
        Only with aerodynamics.clap_and_fling.amplitude.
        """
    @property
    def meeting_angle(self) -> Quantity | None:
        """stroke angle at which the two wings touch.
        [rad] Range: > 0. Default: that of two wings on one body, about 90 deg.
        Only with aerodynamics.clap_and_fling.amplitude.
        """

class AerodynamicsSection(Section):
    @property
    def air_density(self) -> Quantity:
        """rho, air density.
        [kg/m3] Range: >= 0. Default: required.
        """
    @property
    def pitch_coefficient(self) -> Quantity | None:
        """C_alpha, passive pitching: alpha = pi/2 - C_alpha abs(beta').
        [s] Range: >= 0. Default: required or angle_of_attack unless pitch.stiffness or wing.torsion.stiffness.
        Instead of aerodynamics.angle_of_attack.
        """
    @property
    def angle_of_attack(self) -> Quantity | None:
        """angle of attack at the largest abs(beta'), near mid-stroke: C_alpha is found for it at the operating point.
        [rad] Range: > 0, < pi/2. Default: required or pitch_coefficient unless pitch.stiffness or wing.torsion.stiffness.
        Instead of aerodynamics.pitch_coefficient.
        """
    @property
    def angle_of_attack_min(self) -> Quantity | None:
        """stop of the passive pitching: alpha falls no lower.
        [rad] Range: >= 0, < pi/2. Default: none.
        """
    @property
    def added_mass(self) -> bool:
        """air accelerated with the wings: J_a = pi/4 rho S_22 by strip theory; for wings on a pitch hinge also the air moved by pitching; without mean power.
        Range: true or false. Default: false.
        """
    @property
    def kinematic_viscosity(self) -> Quantity:
        """nu, kinematic viscosity of the air, for the Reynolds number; no force depends on it.
        [m2/s] Range: > 0. Default: 1.5e-5 m2/s.
        """
    @property
    def reynolds_number_min(self) -> Quantity | None:
        """lowest Reynolds number for which the coefficients hold.
        Number. Range: >= 0. Default: of a named set of coefficients 100, else none.
        """
    @property
    def reynolds_number_max(self) -> Quantity | None:
        """highest Reynolds number for which the coefficients hold.
        Number. Range: > 0. Default: of a named set of coefficients 26000, else none.
        """
    @property
    def lifting_span(self) -> Quantity:
        """B, part of the distance from hinge to tip that lifts; beyond it the wings have only the drag C_D(0).
        Number. Range: > 0, <= 1. Default: 1.
        """
    @property
    def induced_velocity(self) -> Quantity | None:
        """applied share, 0 to 1, of the induced velocity of momentum theory. Coefficients measured on flapping wings include a part of the wake, so that 1 counts this part twice.
        Number. Range: 0 to 1. Default: none.
        """
    @property
    def swept_area(self) -> Quantity | None:
        """A_0, area of the actuator disc; else of each wing the sector of twice the stroke amplitude.
        [m2] Range: > 0. Default: that of the stroke.
        Only with aerodynamics.induced_velocity.
        """
    @property
    def centre_of_pressure(self) -> str | None:
        """where the force of translation acts along the chord: a Fourier series over the angle of attack, or a curve from 0.25 to 0.5.
        Range: whitney-2010 or chen-2016. Default: whitney-2010.
        Only with pitch.stiffness.
        """
    @property
    def coefficients(self) -> str | None:
        """lift and drag coefficient against angle of attack, eqs (12, 13); normal-force-robofly: C_L = 1.8 sin(2 alpha), C_D = 1.95 - 1.5 cos(2 alpha), of both the component normal to the chord; robobee: C_L = 1.8 sin(2 alpha), C_D = 1.9 - 1.5 cos(2 alpha); normal-tangential: C_N = 3.4 sin(alpha), C_T = 0.4 cos(2 alpha)^2 below 45 deg, else 0.
        Range: translational-2022, normal-force-robofly (with pitch.stiffness), robobee, normal-tangential, or a table of the keys below. Default: translational-2022.
        """
    @property
    def type(self) -> str | None:
        """tabulated: lift and moments of the air are read from a table over the motion of the wings, in place of coefficients, rotational lift and rotational damping.
        Range: quasi-steady or tabulated. Default: quasi-steady.
        """
    @property
    def file(self) -> str | None:
        """table of loads: columns flapping_velocity, lift, stroke_moment and others, see below.
        Range: name of a CSV file. Default: none.
        Only with aerodynamics.type = tabulated.
        Instead of aerodynamics.load_table.
        """
    @property
    def load_table(self) -> str | None:
        """table of loads in place: rows [stroke angle, flapping velocity, pitch angle, pitch velocity, lift, stroke moment, pitch moment].
        Range: rows of seven values. Default: none.
        Only with aerodynamics.type = tabulated.
        Instead of aerodynamics.file.
        """
    @property
    def table_air_density(self) -> Quantity | None:
        """density of the air for which the table holds; loads are proportional to it.
        [kg/m3] Range: > 0. Default: aerodynamics.air_density.
        Only with aerodynamics.type = tabulated.
        """
    @property
    def table_wings(self) -> Quantity | None:
        """number of wings for the loads of the table.
        Number. Range: > 0. Default: all.
        Only with aerodynamics.type = tabulated.
        """
    @property
    def clap_and_fling(self) -> AerodynamicsClapAndFlingSection:
        """The section [aerodynamics.clap_and_fling]."""

class BenchSection(Section):
    @property
    def torque_constant(self) -> Quantity | None:
        """K_ref of a test bench, eq (17); enables power_motor_reference_w.
        [N m/A] Range: > 0. Default: none.
        """

class BodyTailSection(Section):
    @property
    def area(self) -> Quantity | None:
        """flat plate, horizontal.
        [m2] Range: > 0. Default: none.
        Only with body.inertia_pitch.
        """
    @property
    def behind(self) -> Quantity | None:
        """its centre behind the centre of mass.
        [m] Range: any. Default: 0 m.
        Only with body.tail.area.
        """
    @property
    def below(self) -> Quantity | None:
        """its centre below the centre of mass.
        [m] Range: any. Default: 0 m.
        Only with body.tail.area.
        """
    @property
    def coefficient(self) -> Quantity | None:
        """force normal to the plate over sin(angle of attack).
        Number. Range: > 0. Default: 2.
        Only with body.tail.area.
        """

class BodyFinSection(Section):
    @property
    def area(self) -> Quantity | None:
        """flat plate, upright.
        [m2] Range: > 0. Default: none.
        Only with body.inertia_pitch.
        """
    @property
    def behind(self) -> Quantity | None:
        """its centre behind the centre of mass.
        [m] Range: any. Default: 0 m.
        Only with body.fin.area.
        """
    @property
    def below(self) -> Quantity | None:
        """its centre below the centre of mass.
        [m] Range: any. Default: 0 m.
        Only with body.fin.area.
        """
    @property
    def coefficient(self) -> Quantity | None:
        """force normal to the plate over sin(angle of attack).
        Number. Range: > 0. Default: 2.
        Only with body.fin.area.
        """

class BodyControlSection(Section):
    @property
    def mean_stroke_angle(self) -> Quantity | None:
        """largest deflection, to either side, of the mean stroke angle.
        [rad] Range: > 0. Default: none: fixed.
        Only with body.inertia_pitch.
        """
    @property
    def stroke_plane_difference(self) -> Quantity | None:
        """largest tilt of the stroke planes, right nose up, left nose down.
        [rad] Range: > 0. Default: none: fixed.
        Only with body.inertia_pitch.
        """
    @property
    def incidence_difference(self) -> Quantity | None:
        """largest turn of the pitch of the wings, right up, left down.
        [rad] Range: > 0. Default: none: fixed.
        Only with body.inertia_pitch.
        """
    @property
    def voltage_max(self) -> Quantity | None:
        """largest voltage, or amplitude, of a drive.
        [V] Range: > 0. Default: none.
        Only with body.inertia_pitch.
        """

class BodySection(Section):
    @property
    def inertia_pitch(self) -> Quantity | None:
        """I_yy, y to the right; given, with the other two, the vehicle can fly: trim, stability, fly.
        [kg m2] Range: > 0. Default: none: no flight.
        """
    @property
    def inertia_roll(self) -> Quantity | None:
        """I_xx, moment of inertia of the whole vehicle about its centre of mass, x forward.
        [kg m2] Range: > 0. Default: required.
        Only with body.inertia_pitch.
        """
    @property
    def inertia_yaw(self) -> Quantity | None:
        """I_zz, z down.
        [kg m2] Range: > 0. Default: required.
        Only with body.inertia_pitch.
        """
    @property
    def inertia_product(self) -> Quantity | None:
        """I_xz, integral of x z dm.
        [kg m2] Range: any. Default: 0 kg m2.
        Only with body.inertia_pitch.
        """
    @property
    def shoulder_ahead(self) -> Quantity | None:
        """stroke axes ahead of the centre of mass.
        [m] Range: any. Default: 0 m.
        Only with body.inertia_pitch.
        """
    @property
    def shoulder_aside(self) -> Quantity | None:
        """stroke axis of either side from the middle plane.
        [m] Range: >= 0. Default: 0 m.
        Only with body.inertia_pitch.
        """
    @property
    def shoulder_above(self) -> Quantity | None:
        """stroke planes above the centre of mass.
        [m] Range: any. Default: 0 m.
        Only with body.inertia_pitch.
        """
    @property
    def stroke_plane_tilt(self) -> Quantity | None:
        """stroke planes against the body, nose up.
        [rad] Range: any. Default: 0 rad.
        Only with body.inertia_pitch.
        """
    @property
    def mean_stroke_angle(self) -> Quantity | None:
        """of the span at stroke angle 0, forwards.
        [rad] Range: any. Default: 0 rad.
        Only with body.inertia_pitch.
        """
    @property
    def opposed(self) -> bool:
        """of each two wings on one side, one flaps against the other.
        Range: true or false. Default: false.
        Only with body.inertia_pitch.
        """
    @property
    def wing_mass(self) -> Quantity | None:
        """mass of one wing; given, the inertia of the flapping acts on the body.
        [kg] Range: > 0. Default: none: wings without mass to the body.
        Only with body.inertia_pitch.
        """
    @property
    def wing_centre(self) -> Quantity | None:
        """centre of mass of a wing from its stroke axis.
        [m] Range: > 0. Default: required.
        Only with body.wing_mass.
        """
    @property
    def drag_area_forward(self) -> Quantity | None:
        """C_D A of the body that moves along x.
        [m2] Range: >= 0. Default: 0 m2.
        Only with body.inertia_pitch.
        """
    @property
    def drag_area_sideways(self) -> Quantity | None:
        """C_D A along y.
        [m2] Range: >= 0. Default: 0 m2.
        Only with body.inertia_pitch.
        """
    @property
    def drag_area_vertical(self) -> Quantity | None:
        """C_D A along z.
        [m2] Range: >= 0. Default: 0 m2.
        Only with body.inertia_pitch.
        """
    @property
    def drag_below(self) -> Quantity | None:
        """where that drag acts, below the centre of mass.
        [m] Range: any. Default: 0 m.
        Only with body.inertia_pitch.
        """
    @property
    def tail(self) -> BodyTailSection:
        """The section [body.tail]."""
    @property
    def fin(self) -> BodyFinSection:
        """The section [body.fin]."""
    @property
    def control(self) -> BodyControlSection:
        """The section [body.control]."""

class Sections:
    @property
    def vehicle(self) -> VehicleSection:
        """The section [vehicle]."""
    @property
    def supply(self) -> SupplySection:
        """The section [supply]."""
    @property
    def motor(self) -> MotorSection:
        """The section [motor]."""
    @property
    def electronics(self) -> ElectronicsSection:
        """The section [electronics]."""
    @property
    def piezo(self) -> PiezoSection:
        """The section [piezo]."""
    @property
    def transmission(self) -> TransmissionSection:
        """The section [transmission]."""
    @property
    def friction(self) -> FrictionSection:
        """The section [friction]."""
    @property
    def spring(self) -> SpringSection:
        """The section [spring]."""
    @property
    def wing(self) -> WingSection:
        """The section [wing]."""
    @property
    def pitch(self) -> PitchSection:
        """The section [pitch]."""
    @property
    def aerodynamics(self) -> AerodynamicsSection:
        """The section [aerodynamics]."""
    @property
    def bench(self) -> BenchSection:
        """The section [bench]."""
    @property
    def body(self) -> BodySection:
        """The section [body]."""

sections: dict[str, type[Section]]
