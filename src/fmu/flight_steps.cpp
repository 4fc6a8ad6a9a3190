#include "fmu/flight_steps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "time/own_steps.hpp"

namespace wingbeat::fmu {
namespace {

/// Numbers of unknowns for which steps are compiled: of one drive and of two.
constexpr int few = 20, many = 28;

}  // namespace

FlightSteps::FlightSteps(std::vector<MeasuredModel*> drives, BodyInTime& body, std::int64_t work)
    : drives_(std::move(drives)), body_(body), work_left_(work) {
  coupled = padded(order_unknowns(), {few, many});
  scale_body();
  now.t = drives_[0]->now.t;
}

void FlightSteps::unknowns(double* y) const {
  write_unknowns(body_.state, y);
  double* next = y + coupled;
  std::fill_n(next, sum_count, 0.0);
  for (const MeasuredModel* drive : drives_) next = std::copy(drive->means.sums.begin(), drive->means.sums.end(), next);
}

void FlightSteps::set(double t, const double* y) {
  now.t = t;
  body_.state = body_of(y);
  for (std::size_t n = 0; n < drives_.size(); ++n) {
    drives_[n]->TimeModel::set(t, of_drive(n, y));
    std::copy_n(y + coupled + std::ptrdiff_t(n) * detail::quadrature_count, detail::quadrature_count,
                drives_[n]->means.sums.begin());
  }
}

detail::AirOnBody FlightSteps::air_at(double t, const double* y, const BodyState& body) const {
  return body_.air_of(body, vehicles(), [&](std::size_t n) { return instant_of(n, t, y); });
}

bool FlightSteps::rates(double t, const double* y, double* dy) const {
  if (--work_left_ < 0) throw WorkSpent();
  const BodyState body = body_of(y);
  const detail::AirOnBody air = air_at(t, y, body);
  std::fill(dy, dy + coupled + sum_count, 0.0);
  for (std::size_t n = 0; n < drives_.size(); ++n) {
    const MeasuredModel& drive = *drives_[n];
    const detail::DriveInstant& d = air.drives[n];
    drive.indices.unknowns(rates_of(drive.vehicle, d.place, d.at, d.motion), of_drive(n, dy));
    const CycleIntegrals<double> flow = integrands<double>(d.motion, d.at.omega, d.mode);
    double* sums = dy + coupled + std::ptrdiff_t(n) * detail::quadrature_count;
    for (const Integral which : detail::quadratures) *sums++ = flow[std::size_t(which)];
  }
  write_body(body_.rates_in(body, air), dy);
  return std::all_of(dy, dy + coupled + sum_count, [](double x) { return std::isfinite(x); });
}

std::array<double, FlightSteps::indicator_count> FlightSteps::indicators(double t, const double* y) const {
  const BodyState body = body_of(y);
  if (body_.vehicle().wing_mass > 0.0) {
    air_at(t, y, body);
  } else {
    body_.set_flows(body);
  }
  return drive_indicators(t, y);
}

void FlightSteps::tolerated(double relative, const double* y, double* errors) const {
  tolerate_unknowns(relative, y, errors);
  // Loose for the sums, which nothing depends on: they follow the unknowns' steps.
  std::fill_n(errors + coupled, sum_count, 1e300);
}

double FlightSteps::next_switch() const {
  double next = infinity;
  for (const MeasuredModel* drive : drives_) next = std::min(next, drive->next_switch());
  return next;
}

void FlightSteps::switch_supply() {
  const double due = next_switch();
  for (MeasuredModel* drive : drives_) {
    if (drive->next_switch() > due) continue;
    drive->now.t = now.t;
    drive->switch_supply();
  }
}

std::unique_ptr<detail::Integrator> integrator_for(TimeIntegrator, const FlightSteps& model, const double& relative) {
  detail::IntegratorProblem p = FlightSteps::problem_of(model, relative, FlightSteps::sum_count);
  if (model.coupled == few) {
    return std::make_unique<detail::OwnIntegrator<few, FlightSteps::sum_count, false>>(std::move(p));
  }
  return std::make_unique<detail::OwnIntegrator<many, FlightSteps::sum_count, false>>(std::move(p));
}

}  // namespace wingbeat::fmu
