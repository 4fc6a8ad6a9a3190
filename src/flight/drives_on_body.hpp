// Drives and the body that they fly, as one system in time: what the loop through the events (time/event_loop.hpp) asks
// of it, whoever watches the drives. FlightModel and the FMU's FlightSteps are such systems.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <optional>
#include <vector>

#include "flight/air_on_body.hpp"
#include "time/integrator.hpp"
#include "time/time_model.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/parts/body.hpp"

namespace wingbeat::detail {

/// The unknowns are those of the drives, one after the other, and the body's, then what System integrates beside them.
/// System has `Drive& drive(n)` and `drive_count()`, set_flows_now(), by which the drives feel the body as it is, and
/// what else the loop asks: unknowns, set, rates, indicators, tolerated. Drive: a TimeModel or what is derived from it.
template <class System, class Drive>
class DrivesOnBody {
 public:
  static constexpr std::size_t max_drives = max_flight_drives;
  static constexpr std::size_t per_drive = Drive::indicator_count;
  static constexpr std::size_t indicator_count = max_drives * per_drive;

  bool ended() const {
    bool any = false;
    each([&](const Drive& drive, std::size_t) { any = any || drive.ended(); });
    return any;
  }

  void begin_piece() {
    system().set_flows_now();
    each([&](Drive& drive, std::size_t) {
      drive.now.t = system().now.t;
      drive.begin_piece();
    });
  }

  std::array<int, indicator_count> directions() const {
    std::array<int, indicator_count> directions{};
    each([&](const Drive& drive, std::size_t n) {
      const auto own = drive.directions();
      std::copy(own.begin(), own.end(), directions.begin() + std::ptrdiff_t(n * per_drive));
    });
    return directions;
  }

  void handle(std::size_t indicator) {
    system().set_flows_now();
    system().drive(indicator / per_drive).handle(indicator % per_drive);
  }

  static constexpr bool ends_piece(std::size_t) { return true; }

  std::optional<TransientEvent::Kind> event_at(std::size_t indicator) const {
    return system().drive(indicator / per_drive).event_at(indicator % per_drive);
  }

  bool branch_lost() {
    system().set_flows_now();
    bool lost = false;
    each([&](Drive& drive, std::size_t) { lost = drive.branch_lost() || lost; });
    return lost;
  }

  double longest_step() const {
    double longest = std::numeric_limits<double>::infinity();
    each([&](const Drive& drive, std::size_t) { longest = std::min(longest, drive.longest_step()); });
    return longest;
  }

  /// Typical size of each unknown.
  std::vector<double> typical() const {
    std::vector<double> sizes(std::size_t(coupled), 1.0);
    each([&](const Drive& drive, std::size_t n) {
      const auto own = drive.typical();
      std::copy_n(own.begin(), drive.indices.count, sizes.begin() + std::ptrdiff_t(first_[n]));
    });
    return sizes;
  }

  double cycle_time() const { return system().drive(0).time_scale; }  ///< of the first drive, about [s]

  /// What a system in time is to an integrator with `beside` integrals; `model` and `relative` stay where they are.
  static IntegratorProblem problem_of(const System& model, const double& relative, int beside) {
    IntegratorProblem p;
    p.coupled = model.coupled;
    p.size = model.coupled + beside;
    p.roots = int(indicator_count);
    p.rates = [&](double t, const double* y, double* dy) { return model.rates(t, y, dy); };
    p.root_functions = [&](double t, const double* y, double* values) {
      const auto indicators = model.indicators(t, y);
      std::copy(indicators.begin(), indicators.end(), values);
    };
    p.tolerated = [&](const double* y, double* errors) { model.tolerated(relative, y, errors); };
    p.longest_step = model.longest_step();
    p.typical = model.typical();
    return p;
  }

  int coupled = 0;  ///< number of unknowns without what is integrated beside them

 protected:
  /// Number of unknowns of drives and body.
  std::size_t order_unknowns() {
    std::size_t count = 0;
    each([&](const Drive& drive, std::size_t n) {
      first_[n] = count;
      count += drive.indices.count;
    });
    body_at_ = count;
    return count + body_state_count;
  }

  /// The next larger of the numbers of unknowns for which steps are compiled; those without a meaning stay at 0.
  static int padded(std::size_t count, std::initializer_list<int> compiled) {
    for (const int size : compiled) {
      if (int(count) <= size) return size;
    }
    throw ParameterError("vehicle", "has more states than a flight knows");
  }

  double* of_drive(std::size_t n, double* y) const { return y + first_[n]; }
  const double* of_drive(std::size_t n, const double* y) const { return y + first_[n]; }
  double* of_body(double* y) const { return y + body_at_; }

  BodyState body_of(const double* y) const {
    BodyState body;
    const double* next = y + body_at_;
    BodyState::each(body, [&](double& x) { x = *next++; });
    return body;
  }

  /// The coupled unknowns as they are.
  void write_unknowns(const BodyState& body, double* y) const {
    std::fill(y, y + coupled, 0.0);
    each([&](const Drive& drive, std::size_t n) { drive.TimeModel::unknowns(of_drive(n, y)); });
    write_body(body, y);
  }
  void write_body(const BodyState& body, double* y) const {
    double* next = of_body(y);
    BodyState::each(body, [&](const double& x) { *next++ = x; });
  }

  DriveInstant instant_of(std::size_t n, double t, const double* y) const {
    const Drive& drive = system().drive(n);
    DriveInstant instant;
    instant.place = drive.indices.coordinates(of_drive(n, y));
    instant.at = drive.instant(t, instant.place);
    instant.mode = on_force_branch(drive.vehicle, instant.at, drive.mode(), &instant.motion);
    return instant;
  }

  std::array<const Vehicle<double>*, max_drives> vehicles() const {
    std::array<const Vehicle<double>*, max_drives> all{};
    each([&](const Drive& drive, std::size_t n) { all[n] = &drive.vehicle; });
    return all;
  }

  /// Of the drives, which feel the air as it is at `y`.
  std::array<double, indicator_count> drive_indicators(double t, const double* y) const {
    std::array<double, indicator_count> values;
    values.fill(1.0);
    each([&](const Drive& drive, std::size_t n) {
      const auto own = drive.indicators(t, of_drive(n, y));
      std::copy(own.begin(), own.end(), values.begin() + std::ptrdiff_t(n * per_drive));
    });
    return values;
  }

  /// Admissible errors of the coupled unknowns: those of the body go by the speed of the wing tips, by which the loads
  /// go.
  void tolerate_unknowns(double relative, const double* y, double* errors) const {
    std::fill_n(errors, coupled, relative);
    each([&](const Drive& drive, std::size_t n) { drive.tolerated(relative, of_drive(n, y), of_drive(n, errors)); });
    double* next = of_body(errors);
    for (int k = 0; k < 3; ++k) *next++ = relative * tip_speed_;
    for (int k = 0; k < 3; ++k) *next++ = relative * tip_speed_ / reach();
    for (int k = 0; k < 4; ++k) *next++ = relative;
    for (int k = 0; k < 3; ++k) *next++ = relative * tip_speed_ * cycle_time();
  }

  /// Sizes by which errors of the body are assessed, of the drives as they are scaled now.
  void scale_body() {
    tip_speed_ = 0.0;
    each([&](const Drive& drive, std::size_t) {
      const double slope = drive.direct ? 1.0 : typical_stroke_slope(drive.vehicle.transmission);
      tip_speed_ = std::max(tip_speed_, drive.speed_scale * slope * radius_of(drive));
    });
  }
  double tip_speed() const { return tip_speed_; }                                ///< typical, of the fastest wing [m/s]
  double reach() const { return std::max(1e-6, radius_of(system().drive(0))); }  ///< of a wing [m]

 private:
  friend System;
  DrivesOnBody() = default;

  static double radius_of(const Drive& drive) { return drive.vehicle.wings.wake.strips.at.back().radius; }
  System& system() { return static_cast<System&>(*this); }
  const System& system() const { return static_cast<const System&>(*this); }
  template <class Use>
  void each(const Use& use) {
    for (std::size_t n = 0; n < system().drive_count(); ++n) use(system().drive(n), n);
  }
  template <class Use>
  void each(const Use& use) const {
    for (std::size_t n = 0; n < system().drive_count(); ++n) use(system().drive(n), n);
  }

  std::array<std::size_t, max_drives> first_{};  ///< where the unknowns of each drive begin
  std::size_t body_at_ = 0;
  double tip_speed_ = 1.0;
};

}  // namespace wingbeat::detail
