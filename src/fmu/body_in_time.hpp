// The body of an FMU whose vehicle has one: its state, inputs and settings, and how it and the drives meet the air.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "flight/air_on_body.hpp"
#include "fmu/drive_in_time.hpp"
#include "wingbeat/flight/flight_vehicle.hpp"
#include "wingbeat/parts/body.hpp"

namespace wingbeat::fmu {

inline bool has_body(const Design<double>& design) { return design.body.inertia_pitch.has_value(); }

/// In the order of body_input_rows.
struct BodyInputs {
  double wind_x = 0.0, wind_y = 0.0, wind_z = 0.0;  ///< in earth axes [m/s]
  double mean_stroke_angle = 0.0, stroke_plane_difference = 0.0, incidence_difference = 0.0;

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.wind_x, self.wind_y, self.wind_z, self.mean_stroke_angle, self.stroke_plane_difference,
               self.incidence_difference);
  }
};
/// The controls behind the last of them.
inline constexpr FlightControl body_controls[] = {
    FlightControl::mean_stroke_angle, FlightControl::stroke_plane_difference, FlightControl::incidence_difference};
inline constexpr std::size_t first_body_control = 3;

/// In the order of body_setting_rows: the body at the start.
struct BodySettings {
  double gravity = standard_gravity;
  double position_x = 0.0, position_y = 0.0, position_z = 0.0;
  double velocity_x = 0.0, velocity_y = 0.0, velocity_z = 0.0;
  double roll = 0.0, pitch = 0.0, yaw = 0.0;
  double rate_x = 0.0, rate_y = 0.0, rate_z = 0.0;

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.gravity, self.position_x, self.position_y, self.position_z, self.velocity_x, self.velocity_y,
               self.velocity_z, self.roll, self.pitch, self.yaw, self.rate_x, self.rate_y, self.rate_z);
  }
};

/// All of a body's outputs, in the order of body_output_rows.
inline constexpr std::size_t body_output_count = 23;

class BodyInTime {
 public:
  using Drives = std::vector<std::unique_ptr<DriveInTime>>;

  /// Throws ParameterError where the vehicle cannot fly.
  explicit BodyInTime(const Design<double>& design);
  /// The body anew, of a vehicle of the same drives; state and flows stay.
  void build(const Design<double>& design);
  /// Lets drives feel how the body moves.
  void connect(Drives& drives) const;
  /// As the settings have it.
  void start();

  bool has(FlightControl control) const { return vehicle_.has(control); }
  const FlightVehicle& vehicle() const { return vehicle_; }

  /// To the flows, of the state given; what the wings' mass does to them comes from air_of() alone.
  void set_flows(const BodyState& body) const;
  /// What acts at a state: instant_of(n) evaluates the drive n, whose vehicle is among `drives`.
  template <class InstantOf>
  detail::AirOnBody air_of(const BodyState& body,
                           const std::array<const Vehicle<double>*, detail::max_flight_drives>& drives,
                           const InstantOf& instant_of) const {
    set_flows(body);
    return detail::air_on_body(vehicle_, drives, flows_, body, settings.gravity, true, instant_of);
  }
  /// What acts with the drives as they are now.
  detail::AirOnBody air_now(const Drives& drives) const;
  BodyState rates_in(const BodyState& body, const detail::AirOnBody& air) const {
    return detail::body_rates_in(vehicle_, body, air, settings.gravity);
  }
  /// All outputs at the state.
  std::array<double, body_output_count> outputs(const detail::AirOnBody& air) const;

  std::vector<double> numbers() const;
  void set_numbers(const double* y);

  BodyState state;
  BodyInputs inputs;
  BodySettings settings;

 private:
  FlightVehicle vehicle_;  ///< drives in the order of the FMU: left before right
  detail::DriveFlows flows_;
};

}  // namespace wingbeat::fmu
