#include "wingbeat/study/linear_model.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "wingbeat/cycle/air_equilibrium.hpp"
#include "wingbeat/solve/eigenvalues.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

bool settles(const Complex& multiplier) {
  return std::abs(multiplier) < LinearModel::settled_multiplier ||
         (multiplier.imag() == 0.0 && multiplier.real() < 0.0);
}

CycleMode mode_of(const Complex& multiplier, double period) {
  const Complex s = std::log(multiplier) / period;
  return {multiplier, -1.0 / s.real(), std::abs(s), -s.real() / std::abs(s), settles(multiplier)};
}

/// Which rows of a matrix of full column rank, one for each column, are the most independent.
std::vector<Index> pivot_rows(const Eigen::MatrixXcd& matrix) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXcd> factors(matrix.adjoint());
  std::vector<Index> rows;
  for (Index k = 0; k < matrix.cols(); ++k) rows.push_back(factors.colsPermutation().indices()[k]);
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// Diagonalises A, turns each unsettled mode into continuous time and the others into their steady part.
ContinuousModel continuous_of(const CycleMap& map) {
  // In units of their sizes, so that which states stand for the modes does not depend on units.
  Eigen::VectorXd size(map.states.size());
  for (Index n = 0; n < size.size(); ++n) {
    size[n] = std::max(std::abs(map.states[std::size_t(n)].value), 1e-12);
  }
  const Eigen::MatrixXd scaled = size.cwiseInverse().asDiagonal() * map.a * size.asDiagonal();
  const solver::EigenModes eigen = solver::eigen_modes(scaled);
  const Eigen::MatrixXcd& modes = eigen.vectors;
  const Eigen::VectorXcd& multipliers = eigen.values;
  const Eigen::MatrixXcd drive =
      modes.fullPivLu().solve((size.cwiseInverse().asDiagonal() * map.b).cast<Complex>().eval());
  const Eigen::MatrixXcd seen = (map.c * size.asDiagonal()).cast<Complex>() * modes;

  std::vector<Index> kept;
  ContinuousModel model;
  model.d = map.d;
  for (Index k = 0; k < multipliers.size(); ++k) {
    if (!settles(multipliers[k])) kept.push_back(k);
    else model.d += (seen.col(k) * drive.row(k) / (1.0 - multipliers[k])).real();
  }
  const Index count = Index(kept.size());
  Eigen::MatrixXcd shapes(modes.rows(), count), rates = Eigen::MatrixXcd::Zero(count, count);
  Eigen::MatrixXcd inputs(count, drive.cols()), outputs(seen.rows(), count);
  for (Index n = 0; n < count; ++n) {
    const Index k = kept[std::size_t(n)];
    const Complex rate = std::log(multipliers[k]) / map.period, growth = multipliers[k] - 1.0;
    shapes.col(n) = modes.col(k);
    rates(n, n) = rate;
    inputs.row(n) = drive.row(k) * (std::abs(growth) > 0.0 ? rate / growth : Complex(1.0 / map.period));
    outputs.col(n) = seen.col(k);
  }
  if (count == 0) {
    model.a.resize(0, 0), model.b.resize(0, map.b.cols()), model.c.resize(map.c.rows(), 0);
    return model;
  }
  Eigen::MatrixXcd to_states(count, count);
  Eigen::VectorXd kept_size(count);
  const std::vector<Index> rows = pivot_rows(shapes);
  for (Index n = 0; n < count; ++n) {
    to_states.row(n) = shapes.row(rows[std::size_t(n)]);
    kept_size[n] = size[rows[std::size_t(n)]];
    model.states.push_back(map.states[std::size_t(rows[std::size_t(n)])]);
  }
  const Eigen::MatrixXcd from_states = to_states.fullPivLu().inverse();
  const Eigen::MatrixXd a = (to_states * rates * from_states).real();
  model.a = kept_size.asDiagonal() * a * kept_size.cwiseInverse().asDiagonal();
  model.b = kept_size.asDiagonal() * (to_states * inputs).real();
  model.c = (outputs * from_states).real() * kept_size.cwiseInverse().asDiagonal();
  return model;
}

}  // namespace

LinearModel linear_model_of(const CycleMap& map, int cycles) {
  LinearModel model;
  model.map = map;
  const Eigen::VectorXcd multipliers = solver::eigenvalues_of(map.a);
  for (const Complex& multiplier : multipliers) {
    if (multiplier.imag() >= 0.0) model.modes.push_back(mode_of(multiplier, map.period));
  }
  std::sort(model.modes.begin(), model.modes.end(),
            [](const auto& a, const auto& b) { return std::abs(a.multiplier) > std::abs(b.multiplier); });
  const Index states = map.a.rows();
  const Eigen::MatrixXd closed = Eigen::MatrixXd::Identity(states, states) - map.a;
  // Where the two parts cancel - a load on a symmetrical direct drive leaves its mean lift as it is - nothing is left.
  const Eigen::MatrixXd later = map.c * closed.fullPivLu().solve(map.b);
  model.steady_gain = later + map.d;
  const auto size = later.cwiseAbs() + map.d.cwiseAbs();
  model.steady_gain = (model.steady_gain.cwiseAbs().array() < 1e-12 * size.array()).select(0.0, model.steady_gain);
  model.continuous = continuous_of(map);
  if (cycles == 0) {
    const double slowest = model.modes.front().time_constant / map.period;
    cycles = int(std::clamp(std::isfinite(slowest) ? std::ceil(5.0 * std::abs(slowest)) : 400.0, 10.0, 400.0));
  }
  for (Index input = 0; input < map.b.cols(); ++input) {
    Eigen::MatrixXd response(cycles + 1, map.c.rows());
    Eigen::VectorXd x = Eigen::VectorXd::Zero(states);
    for (Index k = 0; k < response.rows(); ++k) {
      response.row(k) = (map.c * x + map.d.col(input)).transpose();
      x = map.a * x + map.b.col(input);
    }
    model.step_responses.push_back(std::move(response));
  }
  return model;
}

Linearisation linearise(const Design<double>& design, const RunOptions& options, int cycles) {
  Linearisation found;
  found.operating_point = run_design(design, options);
  const std::optional<FrequencySearch>& search = found.operating_point.search;
  if (search && search->outcome != FrequencyOutcome::reached) return found;
  if (found.operating_point.status != FlappingStatus::flapping) return found;
  const Design<double>& operated = found.operating_point.design;
  Vehicle<double> vehicle = resolve(operated, options.condition);
  found.orbit = find_steady_flapping(vehicle, {1e-10, true, reporting_of(operated)}, start_up_in_time());
  if (found.orbit.status == FlappingStatus::flapping) vehicle = in_air(vehicle, air_of(found.orbit.metrics));
  const CycleMap map = cycle_map(found.orbit, vehicle, operated.supply);
  if (!map.states.empty()) found.model = linear_model_of(map, cycles);
  return found;
}

}  // namespace wingbeat
