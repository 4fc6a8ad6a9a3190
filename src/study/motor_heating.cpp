#include "wingbeat/study/motor_heating.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

// g++ 12 takes Eigen's resizing for a use of freed memory.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif
#include <ceres/ceres.h>

#include "study/heating_model.hpp"
#include "study/least_squares.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/solve/singular_values.hpp"

namespace wingbeat {
namespace {

using detail::format;
using namespace detail::heat;

/// Standard error of a logarithm up to which a constant counts as determined: 95 % within a factor of 1.6.
constexpr double determined_to = 0.25;
constexpr std::size_t least_rows = 8, max_rows = 50000;

enum class Seen { winding, casing, resistance, current, voltage };

/// One column that is fitted.
struct Observed {
  Seen seen;
  const char* name;
  const char* unit;
  const std::vector<double>* values;
  double deviation = 1.0;
  std::size_t count = 0;
  double correlation = 0.0;  ///< of neighbouring residuals
};

class HeatFit {
 public:
  explicit HeatFit(const HeatingCurve& curve) : curve_(curve), model_(curve) {
    observe(Seen::winding, "winding_temperature", "K", curve.winding_temperature);
    observe(Seen::casing, "case_temperature", "K", curve.case_temperature);
    observe(Seen::resistance, "resistance", "ohm", curve.resistance);
    if (curve.motor == HeatedMotor::stalled) {
      if (model_.by_voltage()) observe(Seen::current, "current", "A", curve.current);
      else observe(Seen::voltage, "voltage", "V", curve.voltage);
    }
    for (const Observed& o : observed_) {
      shows_resistance_ = shows_resistance_ || (o.seen != Seen::winding && o.seen != Seen::casing);
    }
  }

  const std::vector<Observed>& observed() const { return observed_; }
  bool shows_resistance() const { return shows_resistance_; }

  void fit();

  double value(Unknown k) const { return std::exp(x_[k]); }
  /// Standard error of a logarithm, or of a combination of them.
  double error(const std::vector<std::pair<Unknown, double>>& combination) const {
    double variance = 0.0;
    for (const auto& [a, fa] : combination) {
      for (const auto& [b, fb] : combination) variance += fa * fb * covariance_(a, b);
    }
    return std::sqrt(std::max(variance, 0.0));
  }
  double quantile() const { return boost::math::quantile(boost::math::students_t(std::max(freedom_, 0.5)), 0.975); }
  double widened() const { return widened_; }

  template <class T>
  void residuals(const T* x, T* out) const {
    std::size_t row = 0;
    model_.run(x, [&](std::size_t n, const Rises<T>& r) {
      for (const Observed& o : observed_) {
        const double seen = (*o.values)[n];
        if (is_known(seen)) out[row++] = (predicted(o.seen, x, n, r) - seen) / o.deviation;
      }
    });
  }

 private:
  void observe(Seen seen, const char* name, const char* unit, const std::vector<double>& values) {
    const std::size_t count = std::size_t(std::count_if(values.begin(), values.end(), is_known));
    if (count == 0) return;
    const double spread = scatter_of(values);
    const double scale = spread > 0.0 ? spread : std::max(std::abs(mean_of(values)), 1e-12);
    observed_.push_back({seen, name, unit, &values, scale, count, 0.0});
    rows_ += count;
  }

  template <class T>
  T predicted(Seen seen, const T* x, std::size_t n, const Rises<T>& r) const {
    const T T_w = model_.winding_temperature(r);
    switch (seen) {
      case Seen::winding: return T_w;
      case Seen::casing: return r.casing + curve_.ambient_temperature;
      case Seen::resistance: return model_.resistance(x, T_w);
      case Seen::current: return T(model_.imposed_voltage(n)) / model_.resistance(x, T_w);
      case Seen::voltage: return T(model_.imposed_current(n)) * model_.resistance(x, T_w);
    }
    return T_w;
  }

  struct Residuals {
    const HeatFit& fit;
    template <class T>
    bool operator()(T const* const* x, T* r) const {
      fit.residuals(x[0], r);
      return true;
    }
  };

  /// Ends at the least squares from a start; gives the cost.
  double solve(std::array<double, unknowns>& x, int iterations, double tolerance) const;
  void guess();
  void take_deviations();
  void take_covariance();
  void put_in_order();

  const HeatingCurve& curve_;
  Heating model_;
  std::vector<Observed> observed_;
  bool shows_resistance_ = false;
  std::size_t rows_ = 0;
  std::array<double, unknowns> x_{};
  Eigen::MatrixXd covariance_ = Eigen::MatrixXd::Zero(unknowns, unknowns);
  double freedom_ = 0.0, widened_ = 1.0;
};

double HeatFit::solve(std::array<double, unknowns>& x, int iterations, double tolerance) const {
  auto* cost = new ceres::DynamicAutoDiffCostFunction<Residuals, unknowns>(new Residuals{*this});
  cost->AddParameterBlock(unknowns);
  cost->SetNumResiduals(int(rows_));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, x.data());
  // What the curve does not determine must not run away.
  const double longest = curve_.time.back();
  const auto bound = [&](Unknown k, double low, double high) {
    x[k] = std::clamp(x[k], std::log(low), std::log(high));
    problem.SetParameterLowerBound(x.data(), k, std::log(low));
    problem.SetParameterUpperBound(x.data(), k, std::log(high));
  };
  bound(ln_R1, 1e-4, 1e5);
  bound(ln_R2, 1e-4, 1e5);
  bound(ln_tau_w, 1e-5 * longest, 1e3 * longest);
  bound(ln_tau_c, 1e-5 * longest, 1e3 * longest);
  if (!shows_resistance_) problem.SetManifold(x.data(), new ceres::SubsetManifold(unknowns, {ln_R_start}));
  const ceres::Solver::Options options = least_squares(iterations, tolerance, 1e3 * tolerance);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return std::isfinite(summary.final_cost) ? summary.final_cost : HUGE_VAL;
}

/// The best of fits from several pairs of time constants: with two lumps there may be more than one least square.
void HeatFit::guess() {
  const double longest = curve_.time.back();
  double R = curve_.cold_resistance.value_or(1.0) * model_.start_over_cold();
  for (const Observed& o : observed_) {
    for (std::size_t n = 0; n < curve_.time.size() && o.seen != Seen::winding && o.seen != Seen::casing; ++n) {
      const double seen = (*o.values)[n];
      if (!is_known(seen) || !(seen > 0.0)) continue;
      R = o.seen == Seen::resistance ? seen
          : o.seen == Seen::current  ? model_.imposed_voltage(n) / seen
                                     : seen / model_.imposed_current(n);
      break;
    }
  }
  const double power =
      model_.by_voltage() ? square(model_.imposed_voltage(0)) / R : square(model_.imposed_current(0)) * R;
  double rise = 20.0;
  const auto highest = [&](const std::vector<double>& values) {
    for (const double x : values) {
      if (is_known(x)) rise = std::max(rise, x - curve_.ambient_temperature);
    }
  };
  highest(curve_.winding_temperature);
  highest(curve_.case_temperature);
  double best = HUGE_VAL;
  for (const double slow : {0.3, 1.0, 3.0}) {
    for (const double ratio : {0.01, 0.05, 0.25}) {
      std::array<double, unknowns> x{};
      x[ln_R1] = std::log(0.4 * rise / power);
      x[ln_R2] = std::log(0.6 * rise / power);
      x[ln_tau_c] = std::log(slow * longest);
      x[ln_tau_w] = x[ln_tau_c] + std::log(ratio);
      x[ln_R_start] = std::log(R);
      const double cost = solve(x, 25, 1e-5);
      if (cost < best) {
        best = cost;
        x_ = x;
      }
    }
  }
}

/// Of every column, from its own residuals; and how much neighbouring ones resemble each other.
void HeatFit::take_deviations() {
  std::vector<double> r(rows_);
  residuals(x_.data(), r.data());
  const double parameters = shows_resistance_ ? 5.0 : 4.0, share = 1.0 - parameters / double(rows_);
  for (std::size_t c = 0; c < observed_.size(); ++c) {
    double squares = 0.0, products = 0.0, before = std::nan("");
    std::size_t row = 0;
    for (std::size_t n = 0; n < curve_.time.size(); ++n) {
      for (std::size_t k = 0; k < observed_.size(); ++k) {
        if (!is_known((*observed_[k].values)[n])) continue;
        const double here = r[row++];
        if (k != c) continue;
        squares += here * here;
        if (is_known(before)) products += here * before;
        before = here;
      }
    }
    Observed& o = observed_[c];
    o.correlation = squares > 0.0 ? products / squares : 0.0;
    const double size = std::max(std::abs(mean_of(*o.values)), 1e-12);
    const double left = std::sqrt(squares / (double(o.count) * std::max(share, 1e-3)));
    o.deviation = std::max(o.deviation * left, 1e-9 * size);
  }
}

void HeatFit::take_covariance() {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(Eigen::Index(rows_), Eigen::Index(unknowns));
  using Jet = ceres::Jet<double, unknowns>;
  std::array<Jet, unknowns> x;
  for (int k = 0; k < unknowns; ++k) x[std::size_t(k)] = Jet(x_[std::size_t(k)], k);
  std::vector<Jet> r(rows_);
  residuals(x.data(), r.data());
  for (std::size_t row = 0; row < rows_; ++row) jacobian.row(Eigen::Index(row)) = r[row].v.transpose();
  const Eigen::Index free = shows_resistance_ ? unknowns : unknowns - 1;
  const Eigen::MatrixXd used = jacobian.leftCols(free);
  const solver::SingularValues svd = solver::singular_values(used);
  const Eigen::VectorXd& s = svd.sizes;
  // A direction that the data do not see at all is one of a very large error.
  const Eigen::VectorXd inverse = s.unaryExpr([](double size) { return 1.0 / std::max(size * size, 1e-12); });
  covariance_.setZero();
  covariance_.topLeftCorner(free, free) = svd.V * inverse.asDiagonal() * svd.V.transpose();
  freedom_ = double(rows_) - double(free);
  // Of residuals that follow each other as a first-order process does, fewer are independent.
  double correlation = 0.0;
  for (const Observed& o : observed_) {
    const double noise = 2.0 / std::sqrt(double(o.count));
    if (o.correlation > noise) correlation = std::max(correlation, std::min(o.correlation, 0.98));
  }
  widened_ = std::sqrt((1.0 + correlation) / (1.0 - correlation));
  covariance_ *= square(widened_);
}

/// Temperatures of the winding alone do not say which of the two lumps is the winding: it is taken as the faster one.
void HeatFit::put_in_order() {
  const bool casing =
      std::any_of(observed_.begin(), observed_.end(), [](const Observed& o) { return o.seen == Seen::casing; });
  const bool warm = model_.start_temperature() != curve_.ambient_temperature;
  if (casing || warm || curve_.motor == HeatedMotor::idling || x_[ln_tau_w] <= x_[ln_tau_c]) return;
  std::swap(x_[ln_R1], x_[ln_R2]);
  std::swap(x_[ln_tau_w], x_[ln_tau_c]);
}

void HeatFit::fit() {
  guess();
  for (int round = 0; round < 4; ++round) {
    take_deviations();
    solve(x_, 200, round < 2 ? 1e-7 : 1e-13);
  }
  put_in_order();
  take_deviations();
  take_covariance();
}

}  // namespace

void validate(const HeatingCurve& c) {
  const auto refuse = [](const char* key, const std::string& why) { throw ParameterError(key, why); };
  if (c.time.size() < least_rows) {
    refuse("file", format("has %zu rows; a heating curve needs at least %zu", c.time.size(), least_rows));
  }
  if (c.time.size() > max_rows) {
    refuse("file", format("has %zu rows, more than %zu; average neighbouring ones", c.time.size(), max_rows));
  }
  const bool current = c.held_current || !c.current.empty(), voltage = c.held_voltage || !c.voltage.empty();
  if (!current && !voltage) refuse("current", "missing: give the current or the voltage, constant or as a column");
  if (c.motor == HeatedMotor::idling) {
    if (!current || !voltage) {
      refuse(current ? "voltage" : "current", "missing: of a motor that runs without load both are needed");
    }
  } else if (c.held_current && c.held_voltage) {
    refuse("voltage",
           "cannot be combined with the current: one of them is held, the other follows from the temperature");
  }
  const bool temperature = !c.winding_temperature.empty() || !c.case_temperature.empty() || !c.resistance.empty();
  if (!temperature && (c.motor == HeatedMotor::idling || !current || !voltage)) {
    refuse("file", c.motor == HeatedMotor::idling
                       ? "shows no temperature: it needs a column winding_temperature, case_temperature or resistance"
                       : "shows no temperature: it needs a column winding_temperature, case_temperature or resistance, "
                         "or, of a stalled motor, both current and voltage");
  }
  const auto positive = [&](const char* key, const std::vector<double>& values) {
    for (const double x : values) {
      if (is_known(x) && !(x > 0.0)) refuse(key, format("must be > 0, got %.6g", x));
    }
  };
  positive("current", c.current);
  positive("voltage", c.voltage);
  positive("resistance", c.resistance);
  const bool shown = !c.resistance.empty() || (current && voltage && c.motor == HeatedMotor::stalled);
  if (!shown && !c.cold_resistance) {
    refuse("resistance",
           "missing: the losses follow from the winding's resistance, which the curve does not show; give "
           "datasheet.resistance, or the columns voltage and current");
  }
}

namespace {

/// Why a constant is not determined, as far as the curve shows it.
std::string reason_for(HeatConstant c, const HeatingCurve& curve, const HeatFit& fit) {
  const double longest = curve.time.back();
  const bool slow = c == HeatConstant::resistance_case || c == HeatConstant::time_constant_case;
  const double tau_c = fit.value(ln_tau_c), tau_w = fit.value(ln_tau_w);
  const bool winding = std::any_of(fit.observed().begin(), fit.observed().end(),
                                   [](const Observed& o) { return o.seen != Seen::casing; });
  if (slow && tau_c > 0.7 * longest) {
    return format(
        "the curve of %.4g s is too short for the case, which is still warming at its end; record until its "
        "temperature settles, five of its time constants or so",
        longest);
  }
  if (!slow && !winding) {
    return "the case alone does not show the winding's rise; record its temperature, its resistance, or voltage and "
           "current of the stalled motor";
  }
  double apart = longest;
  for (std::size_t n = 1; n < curve.time.size(); ++n) apart = std::min(apart, curve.time[n] - curve.time[n - 1]);
  if (!slow && tau_w < 2.0 * apart) {
    return format("the rows, %.4g s apart, are too far apart for the winding; record the first seconds more densely",
                  apart);
  }
  if (tau_w > 0.3 * tau_c) {
    return "the curve does not tell the winding from the case; record the temperature of the case as well";
  }
  return "the scatter of the curve hides it; record longer, at a higher power, or the other temperature as well";
}

}  // namespace

bool HeatIdentification::complete() const {
  return std::all_of(constants.begin(), constants.end(), [](const auto& c) { return c.has_value(); });
}

std::string_view key_of(HeatConstant c) {
  switch (c) {
    case HeatConstant::resistance_winding: return "thermal_resistance_winding";
    case HeatConstant::resistance_case: return "thermal_resistance_case";
    case HeatConstant::time_constant_winding: return "thermal_time_constant_winding";
    case HeatConstant::time_constant_case: return "thermal_time_constant_case";
  }
  return "";
}

std::string_view unit_of(HeatConstant c) {
  return c == HeatConstant::resistance_winding || c == HeatConstant::resistance_case ? "K/W" : "s";
}

std::vector<MotorTemperatures<double>> heating_of(const HeatingCurve& curve,
                                                  const std::array<double, heat_constant_count>& constants,
                                                  double start_resistance) {
  const Heating model(curve);
  std::array<double, unknowns> x{};
  for (std::size_t k = 0; k < constants.size(); ++k) x[k] = std::log(constants[k]);
  x[ln_R_start] = std::log(start_resistance);
  std::vector<MotorTemperatures<double>> temperatures;
  model.run(x.data(), [&](std::size_t, const Rises<double>& r) {
    temperatures.push_back({model.winding_temperature(r), r.casing + curve.ambient_temperature});
  });
  return temperatures;
}

HeatIdentification identify_heat(const HeatingCurve& curve) {
  validate(curve);
  HeatFit fit(curve);
  fit.fit();
  HeatIdentification result;
  const double t = fit.quantile();
  const auto determined = [&](double value, double error) -> std::optional<HeatValue> {
    if (!(error <= determined_to)) return std::nullopt;
    return HeatValue{value, value * std::exp(-t * error), value * std::exp(t * error)};
  };
  for (int k = 0; k < heat_constant_count; ++k) {
    const Unknown u = Unknown(k);
    std::optional<HeatValue>& constant = result.constants[std::size_t(k)];
    constant = determined(fit.value(u), fit.error({{u, 1.0}}));
    if (constant) continue;
    const HeatConstant which = HeatConstant(k);
    result.missing.push_back(std::string(key_of(which)) + ": " + reason_for(which, curve, fit));
  }
  if (!result[HeatConstant::resistance_winding] || !result[HeatConstant::resistance_case]) {
    const double R1 = fit.value(ln_R1), R2 = fit.value(ln_R2), sum = R1 + R2;
    result.resistance_sum = determined(sum, fit.error({{ln_R1, R1 / sum}, {ln_R2, R2 / sum}}));
  }
  if (!result[HeatConstant::resistance_case] || !result[HeatConstant::time_constant_case]) {
    result.case_heat_capacity =
        determined(fit.value(ln_tau_c) / fit.value(ln_R2), fit.error({{ln_tau_c, 1.0}, {ln_R2, -1.0}}));
  }
  if (fit.shows_resistance())
    result.start_resistance = determined(fit.value(ln_R_start), fit.error({{ln_R_start, 1.0}}));
  for (const Observed& o : fit.observed()) result.columns.push_back({o.name, o.unit, o.count, o.deviation});
  if (fit.widened() > 1.05) {
    result.remarks.push_back(
        format("neighbouring rows lie on the same side of the fitted curve: two lumps do not describe it to within its "
               "scatter, and the intervals are %.3g times as wide",
               fit.widened()));
  }
  if (curve.cold_resistance && result.start_resistance) {
    const Heating model(curve);
    const double of_sheet = *curve.cold_resistance * model.start_over_cold();
    if (std::abs(result.start_resistance->value / of_sheet - 1.0) > 0.1) {
      result.remarks.push_back(
          format("the winding has %.4g ohm at the start of the curve, where the sheet's resistance "
                 "leads to %.4g ohm",
                 result.start_resistance->value, of_sheet));
    }
  }
  return result;
}

}  // namespace wingbeat
