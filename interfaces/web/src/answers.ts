// Written by scripts/describe-results from the descriptions in interfaces/web/core.

export type Key = {
  key: string;
  /** null of texts */
  unit: string | null;
  /** in words */
  range: string;
  /** SI */
  lower: number | null;
  /** SI */
  upper: number | null;
  /** the lower limit is left out */
  above_lower: boolean;
  /** the upper limit is left out */
  below_upper: boolean;
  /** whole numbers only */
  whole: boolean;
  default: string;
  meaning: string;
  /** the choice that the key belongs to */
  only_with: string | null;
  /** keys that may be stated in its place */
  alternatives: string[];
  example: string | null;
  /** an example of a number with the unit */
  quantity: string | null;
  /** else a text or a choice */
  number: boolean;
};

export type Quantity = {
  key: string;
  unit: string;
  meaning: string;
};

export type Report = {
  /** null if undecided */
  status: 'flapping' | 'stalled' | 'locked' | 'jammed' | null;
  /** a sentence with the evidence */
  status_detail: string;
  /** inside, or the limits that are exceeded */
  domain: string | null;
  /** the same in a sentence with numbers; null inside the domain */
  domain_detail: string | null;
  /** sentences */
  warnings: string[];
  /** supply voltage [V] */
  voltage_v: number | null;
  /** flapping frequency [Hz] */
  frequency_hz: number | null;
  /** mean current [A] */
  current_mean_a: number | null;
  /** peak current [A] */
  current_peak_a: number | null;
  /** root mean square of the current [A] */
  current_rms_a: number | null;
  /** mean electrical input power [W] */
  power_electrical_w: number | null;
  /** mean motor output power [W] */
  power_motor_w: number | null;
  /** bench estimate of the motor output power [W] */
  power_motor_reference_w: number | null;
  /** mean friction loss of the transmission [W] */
  power_friction_w: number | null;
  /** mean aerodynamic power [W] */
  power_aerodynamic_w: number | null;
  /** mean absolute reactive power [W] */
  power_reactive_w: number | null;
  /** mean copper loss of the motor [W] */
  power_copper_w: number | null;
  /** mean viscous loss of the motor [W] */
  power_viscous_w: number | null;
  /** mean loss in the motor's own constant friction [W] */
  power_motor_friction_w: number | null;
  /** mean loss of the gearbox under load [W] */
  power_gear_w: number | null;
  /** mean loss of the electronics, of a piezo with its dielectric's [W] */
  power_electronics_w: number | null;
  /** mean total loss [W] */
  power_loss_w: number | null;
  /** mean power the transmission formulation fails to conserve [W] */
  power_residual_w: number | null;
  /** mean lift [N] */
  lift_mean_n: number | null;
  /** peak lift [N] */
  lift_peak_n: number | null;
  /** peak magnitude of the rod force [N] */
  rod_force_peak_n: number | null;
  /** mean magnitude of the rod force [N] */
  rod_force_mean_n: number | null;
  /** stroke amplitude, half peak to peak [rad] */
  stroke_amplitude_rad: number | null;
  /** peak flapping velocity [rad/s] */
  flapping_velocity_peak_rad_per_s: number | null;
  /** smallest angle of attack [degree] */
  angle_of_attack_min_deg: number | null;
  /** smallest crank speed [rad/s] */
  crank_speed_min_rad_per_s: number | null;
  /** largest crank speed [rad/s] */
  crank_speed_max_rad_per_s: number | null;
  /** system efficiency [1] */
  efficiency_system: number | null;
  /** motor efficiency [1] */
  efficiency_motor: number | null;
  /** mechanism efficiency [1] */
  efficiency_mechanism: number | null;
  /** largest modulus of the orbit's Floquet multipliers [1] */
  floquet_multiplier_max: number | null;
  /** mean lift over weight [1] */
  lift_to_weight: number | null;
  /** winding temperature of the motor [degC] */
  winding_temperature_degc: number | null;
  /** case temperature of the motor [degC] */
  case_temperature_degc: number | null;
  /** largest winding temperature allowed, less the winding temperature [K] */
  winding_temperature_margin_k: number | null;
  /** inertia of the air that moves with the wings over the wings' own [1] */
  added_mass_inertia_ratio: number | null;
  /** mean loss in the damping and at the stops of the pitch hinges [W] */
  power_hinge_w: number | null;
  /** pitch amplitude, half peak to peak [degree] */
  pitch_amplitude_deg: number | null;
  /** lead of the pitching over the pitch that opposes the flapping velocity [degree] */
  pitch_phase_deg: number | null;
  /** largest angle of attack of wings that pitch on a hinge [degree] */
  angle_of_attack_max_deg: number | null;
  /** part of the mean lift that comes from the added mass of wings on pitch hinges [1] */
  lift_added_mass_share: number | null;
  /** Reynolds number of the mean chord at the mean speed of the wing tips [1] */
  reynolds_number: number | null;
  /** largest stroke angle of a direct drive whose wings clap [rad] */
  stroke_angle_max_rad: number | null;
  /** induced velocity that the mean lift leads to, times the share that counts [m/s] */
  induced_velocity_m_per_s: number | null;
  /** flight time until lift falls below the weight [s]; of a vehicle on a battery; null unless asked for: run --endurance, a study that names it */
  hover_s: number | null;
  /** flight time until the battery's end [s]; of a vehicle on a battery; null unless asked for: run --endurance, a study that names it */
  endurance_s: number | null;
  /** of a pwm supply or a battery */
  supply_duty?: number;
  /** C_alpha that was found for an angle of attack [s] */
  pitch_coefficient_s?: number | null;
  /** of a run simulated from rest */
  start_up?: {
    /** false where time, cycles or steps ran out first */
    settled: boolean;
    /** until each cycle's frequency is within 1 % of the last one's, or until the crank rests or jams [s] */
    time_to_steady_s: number | null;
    /** highest current of the start-up [A] */
    inrush_current_a: number | null;
    /** time of the highest current [s] */
    inrush_current_time_s: number | null;
    /** time simulated [s] */
    simulated_time_s: number | null;
    /** cycles simulated */
    cycles: number;
    /** cycles behind the metrics */
    averaged_cycles: number;
    /** largest deviation of their durations from the mean one */
    cycle_scatter: number | null;
    /** ripple of the current of a pwm supply, peak to peak [A] */
    current_ripple_a: number | null;
    /** number of events by kind */
    events: {
      /** revolutions of the crank; of a direct drive, periods of the supply */
      revolution: number;
      /** changes of the rod force's sign */
      force_sign_change: number;
      /** times that the crank comes to rest */
      standstill: number;
      /** times that it breaks away from rest */
      breakaway: number;
      /** times that it jams */
      jam: number;
    };
  };
};

export type Balance = {
  /** input [W] */
  electrical: number;
  /** heat of the winding [W] */
  copper: number;
  /** viscous loss of the motor [W] */
  viscous: number;
  /** loss by the motor's own friction [W] */
  motor_friction: number;
  /** loss of the electronics, of a piezo with its dielectric's [W] */
  electronics: number;
  /** loss of the gearbox [W] */
  gear: number;
  /** loss by friction of the mechanism [W] */
  friction: number;
  /** loss in the hinges of the wings [W] */
  hinge: number;
  /** to the air [W] */
  aerodynamic: number;
  /** what the formulation fails to conserve [W] */
  residual: number;
  /** the input minus all of these [W] */
  imbalance: number;
};

export type Evidence = {
  /** crank angle of what shows the status [rad] */
  angle_rad: number | null;
  /** of the motor there [N m] */
  torque_nm: number | null;
  /** that friction can hold there [N m] */
  friction_torque_nm: number | null;
  /** the one less the other [N m] */
  torque_margin_nm: number | null;
  /** intervals of the crank angle in which friction locks it [rad] */
  locks_rad: [number, number][];
};

export type Tables = {
  /** of vehicle files */
  keys: Key[];
  metrics: Quantity[];
  waveforms: Quantity[];
};

export type Solved = {
  /** as wingbeat run --json */
  report: Report;
  /** mean powers of a cycle */
  balance: Balance;
  evidence: Evidence;
  /** false: it flaps, but the frequency or lift asked for is out of reach */
  reached: boolean;
  /** [V] */
  supply_voltage: number | null;
};

export type StartUp = {
  status: string;
  /** a sentence with the evidence */
  detail: string;
  /** time simulated [s] */
  end_time: number;
  evidence: Evidence;
};

export type Mechanism = {
  type: 'slider-crank' | 'four-bar' | 'tabulated' | 'direct';
  /** a crank turns */
  rotates: boolean;
  springs: boolean;
  /** wings pitch on hinges */
  pitch_hinge: boolean;
  wing_count: number;
  joints: {
    /** its places are the columns NAME_x and NAME_y */
    name: string;
    /** to the ground */
    fixed: boolean;
  }[];
  /** in the order in which they are drawn */
  links: {
    role: 'ground' | 'wing' | 'lever' | 'rocker' | 'rod' | 'crank';
    /** a joint */
    from: string;
    /** a joint */
    to: string;
  }[];
};

export type Gradients = {
  status: string;
  /** a sentence with the evidence */
  detail: string;
  /** of all metrics by each key, SI per SI; null where there are none */
  gradients: Record<string, (number | null)[]>;
};

export type Motor = {
  model: string;
  /** why it cannot be tried */
  refused: string | null;
  /** of its keys, SI */
  values: Record<string, number>;
};

export type Problem = {
  /** a sentence */
  message: string;
  key?: string;
  /** 0: of the input as a whole */
  line?: number;
  column?: number;
};

export type FlightBegun = {
  /** trimmed at hover */
  flies: boolean;
  /** of the trim */
  status: 'trimmed' | 'beyond_controls' | 'untrimmable' | 'does_not_flap';
  /** a sentence */
  detail: string;
  controller: 'none' | 'lqr' | 'pid';
  /** of the wings at hover [Hz] */
  frequency_hz: number | null;
  /** mean electrical power at hover [W] */
  power_w: number | null;
  /** [Hz] */
  control_rate_hz: number | null;
  /** that the controller is designed for [s] */
  delay_s: number | null;
  /** [s] */
  row_period_s: number | null;
  /** at the start, over the ground [m] */
  height_m: number;
  /** the voltage is the amplitude of a wave */
  amplitude: boolean;
  controls: {
    name: string;
    unit: string;
    /** at hover */
    trimmed: number;
    /** end of its range */
    low: number;
    high: number;
  }[];
  /** a sentence for each axis without control */
  uncontrolled: string[];
  wings: {
    /** +1 right, -1 left */
    side: number;
    /** -1: it flaps against the stroke angle */
    sense: number;
    /** in body axes: forward, right, down [m] */
    shoulder: number[];
  }[];
  /** of a wing: distance from the stroke axis and chord [m] */
  outline: [number, number][];
};

export type FlightPiece = {
  /** at its end [s] */
  time_s: number;
  /** false: the flight has ended */
  flies: boolean;
  /** of a flight that has ended */
  outcome: 'completed' | 'crashed' | 'jammed' | 'battery_empty' | 'no_trim';
  /** a sentence where it has ended */
  detail: string;
  /** of a battery */
  charge: number | null;
};
