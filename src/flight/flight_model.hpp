// A vehicle that flies, in time: its drives, which a TimeModel each knows, and its body, whose motion the strips of the
// wings feel; model.md section 18.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "time/integrator.hpp"
#include "time/time_model.hpp"
#include "wingbeat/flight/flight_vehicle.hpp"
#include "wingbeat/flight/simulation.hpp"
#include "wingbeat/parts/body.hpp"

namespace wingbeat::detail {

/// The unknowns are those of the drives, one after the other, and the body's, then the integrals of FlightTotals.
class FlightModel {
 public:
  static constexpr std::size_t max_drives = 2;
  static constexpr std::size_t per_drive = TimeModel::indicator_count;
  static constexpr std::size_t indicator_count = max_drives * per_drive;
  static constexpr std::size_t max_unknowns = max_drives * wingbeat::max_unknowns + body_state_count;

  struct Now {
    double t = 0.0;
    BodyState body;
    bool stuck = false;        ///< never: a flight goes on while a drive stands
    double impact_loss = 0.0;  ///< of all drives so far [J]
  };

  /// The wind at a time and a place of earth axes, in earth axes [m/s].
  using Wind = std::function<Triple(double t, const Triple& position)>;

  explicit FlightModel(const FlightVehicle& vehicle);
  FlightModel(const FlightModel& other);
  FlightModel& operator=(const FlightModel& other);

  /// From rest, or with the drives as `from` has them.
  void start(const BodyState& body, const std::vector<Coordinates<double>>& from = {});
  void set_controls(const FlightControls& controls);
  const FlightControls& controls() const { return controls_; }

  // What the loop through the events asks (time/event_loop.hpp).
  bool ended() const;
  void begin_piece();
  void unknowns(double* y) const;
  void set(double t, const double* y);
  bool rates(double t, const double* y, double* dy) const;
  std::array<double, indicator_count> indicators(double t, const double* y) const;
  std::array<int, indicator_count> directions() const;
  void handle(std::size_t indicator);
  static constexpr bool ends_piece(std::size_t) { return true; }
  std::optional<TransientEvent::Kind> event_at(std::size_t indicator) const;
  bool branch_lost();
  void tolerated(double relative, const double* y, double* errors) const;
  double longest_step() const;
  static constexpr double next_switch() { return std::numeric_limits<double>::infinity(); }
  void switch_supply() {}

  /// Energy of drives and body, over the height of the origin [J].
  double stored_energy() const;
  /// What acts on the body now, wings and plates.
  BodyLoads loads_now() const;
  /// Typical size of each unknown.
  std::vector<double> typical() const;
  double cycle_time() const;  ///< of the first drive, about [s]

  FlightVehicle vehicle;
  std::vector<TimeModel> drives;
  int coupled = 0;      ///< number of unknowns without integrals
  bool frozen = false;  ///< the body does not move from where it is, though it has a velocity
  double gravity = standard_gravity;
  Wind wind;
  Now now;
  FlightTotals totals;

 private:
  struct Instant {
    FullState<double> at;
    PitchMotion<double> motion;
    Mode<double> mode;
    Coordinates<double> place;
  };
  void own_flows();
  void set_flows(double t, const BodyState& body) const;
  Instant instant_of(std::size_t n, double t, const double* y) const;
  /// Loads of wings and plates; with wings that have mass also the accelerations of the body, set in `accelerations`.
  BodyLoads loads(double t, const double* y, const BodyState& body, std::vector<Instant>& instants,
                  std::optional<BodyState>& accelerations) const;
  const double* body_unknowns(const double* y) const { return y + first_[drives.size()]; }
  BodyState body_of(const double* y) const;
  void sum_impacts();

  std::vector<std::shared_ptr<OnsetFlow>> flows_;
  std::array<std::size_t, max_drives + 1> first_{};  ///< where the unknowns of each drive begin, then the body's
  FlightControls controls_;
  std::array<double, max_drives> scaled_to_{};  ///< voltage that the sizes of a drive are for [V]
  double speed_scale_ = 1.0, rate_scale_ = 1.0;
};

/// That of explicit steps.
std::unique_ptr<Integrator> integrator_for(TimeIntegrator which, const FlightModel& model, const double& relative);

}  // namespace wingbeat::detail
