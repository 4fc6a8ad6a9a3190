#include "wingbeat/study/motor_identification.hpp"

// g++ 12 takes Eigen's resizing for a use of freed memory.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif
#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "study/least_squares.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/core/text.hpp"

namespace wingbeat {
namespace {

using detail::format;

/// Unknowns of the fit: ln R, ln K, constant friction and damping over their scales; at the sheet's shaft.
enum Unknown { resistance, constant, friction, damping, unknowns };

enum class Kind {
  resistance,
  torque_constant,
  speed_constant,
  no_load_speed,
  no_load_current,
  stall_torque,
  stall_current,
  friction_torque,
  viscous_damping,
  point_speed,
  point_current,
  point_torque,
  point_efficiency
};

struct Datum {
  std::string name;
  Kind kind;
  double value;
  double deviation;  ///< relative
  double voltage;
  double load = 0.0;  ///< of a point: its torque, or its current where that is given instead
  bool by_torque = true;
};

struct Scales {
  double friction, damping;
  double torque_factor;  ///< output torque over the sum of what the motor gives
};

/// What a motor shows where the sheet states a datum.
template <class T>
T predicted(const Datum& d, const T* x, const Scales& scales) {
  using std::exp;
  const T R = exp(x[resistance]), K = exp(x[constant]);
  const T T_c = x[friction] * scales.friction, b = x[damping] * scales.damping;
  const double v = d.voltage, eta = scales.torque_factor;
  const auto speed_at = [&](const T& torque) { return T((K * v / R - torque / eta - T_c) / (K * K / R + b)); };
  switch (d.kind) {
    case Kind::resistance: return R;
    case Kind::torque_constant: return K;
    case Kind::speed_constant: return T(1.0 / K);
    case Kind::no_load_speed: return speed_at(T(0.0));
    case Kind::no_load_current: return T((T_c + b * speed_at(T(0.0))) / K);
    case Kind::stall_current: return T(v / R);
    case Kind::stall_torque: return T(eta * (K * v / R - T_c));
    case Kind::friction_torque: return T_c;
    case Kind::viscous_damping: return b;
    default: break;
  }
  T torque(d.load), speed, current;
  if (d.by_torque) {
    speed = speed_at(torque);
    current = (torque / eta + T_c + b * speed) / K;
  } else {
    current = T(d.load);
    speed = (v - R * current) / K;
    torque = eta * (K * current - T_c - b * speed);
  }
  if (d.kind == Kind::point_speed) return speed;
  if (d.kind == Kind::point_current) return current;
  if (d.kind == Kind::point_torque) return torque;
  return T(torque * speed / (v * current));
}

struct Residuals {
  const std::vector<Datum>& data;
  const Scales& scales;
  template <class T>
  bool operator()(T const* const* x, T* r) const {
    for (std::size_t n = 0; n < data.size(); ++n) {
      r[n] = (predicted(data[n], x[0], scales) - data[n].value) / (data[n].value * data[n].deviation);
    }
    return true;
  }
};

void check_range(const char* key, const char* unit, const std::optional<double>& x, bool zero_allowed = false) {
  if (x) require(zero_allowed ? *x >= 0.0 : *x > 0.0, key, zero_allowed ? "must be >= 0" : "must be > 0", unit, *x);
}

void validate(const MotorDatasheet& s) {
  check_range("voltage", "V", s.voltage);
  check_range("no_load_speed", "rad/s", s.no_load_speed);
  check_range("no_load_current", "A", s.no_load_current);
  check_range("stall_torque", "N m", s.stall_torque);
  check_range("stall_current", "A", s.stall_current);
  check_range("resistance", "ohm", s.resistance);
  check_range("torque_constant", "N m/A", s.torque_constant);
  check_range("speed_constant", "rad/s/V", s.speed_constant);
  check_range("friction_torque", "N m", s.friction_torque);
  check_range("viscous_damping", "N m s/rad", s.viscous_damping);
  check_range("inductance", "H", s.inductance, true);
  check_range("rotor_inertia", "kg m2", s.rotor_inertia);
  check_range("mechanical_time_constant", "s", s.mechanical_time_constant);
  check_range("rotor_diameter", "m", s.rotor_diameter);
  check_range("rotor_length", "m", s.rotor_length);
  require(s.gear_ratio > 0.0, "gear_ratio", "must be > 0", "1", s.gear_ratio);
  if (s.gear_efficiency) {
    require(*s.gear_efficiency > 0.0 && *s.gear_efficiency <= 1.0, "gear_efficiency", "must be > 0 and <= 1", "1",
            *s.gear_efficiency);
  }
  require(s.deviation > 0.0 && s.deviation < 1.0, "deviation", "must lie between 0 and 1", "1", s.deviation);
  const bool needs_voltage = s.no_load_speed || s.no_load_current || s.stall_torque || s.stall_current ||
                             std::any_of(s.points.begin(), s.points.end(), [](const auto& p) { return !p.voltage; });
  if (needs_voltage && !s.voltage) {
    throw ParameterError("voltage", "missing: no-load, stall and performance values hold at one voltage");
  }
  if (s.assume_steel_cylinder && !(s.rotor_diameter && s.rotor_length)) {
    throw ParameterError("fallback.inertia", "a solid steel cylinder needs rotor_diameter and rotor_length");
  }
  for (const MotorPoint& p : s.points) {
    if (!p.torque && !p.current) throw ParameterError("point", "needs a torque or a current");
    if (p.torque.has_value() + p.speed.has_value() + p.current.has_value() + p.efficiency.has_value() < 2) {
      throw ParameterError("point", "says nothing: give two or more of torque, speed, current, efficiency");
    }
  }
}

double deviation_in(const MotorDatasheet& s, const std::string& name) {
  const auto own = s.deviations.find(name);
  return own == s.deviations.end() ? s.deviation : own->second;
}

std::vector<Datum> data_of(const MotorDatasheet& s) {
  std::vector<Datum> data;
  const auto deviation_of = [&](const std::string& name) { return deviation_in(s, name); };
  const auto add = [&](const char* name, Kind kind, const std::optional<double>& value) {
    if (value) data.push_back({name, kind, *value, deviation_of(name), s.voltage.value_or(0.0)});
  };
  add("resistance", Kind::resistance, s.resistance);
  add("torque_constant", Kind::torque_constant, s.torque_constant);
  add("speed_constant", Kind::speed_constant, s.speed_constant);
  add("no_load_speed", Kind::no_load_speed, s.no_load_speed);
  add("no_load_current", Kind::no_load_current, s.no_load_current);
  add("stall_torque", Kind::stall_torque, s.stall_torque);
  add("stall_current", Kind::stall_current, s.stall_current);
  add("friction_torque", Kind::friction_torque, s.friction_torque);
  add("viscous_damping", Kind::viscous_damping, s.viscous_damping);
  int number = 0;
  for (const MotorPoint& p : s.points) {
    ++number;
    const double v = p.voltage.value_or(s.voltage.value_or(0.0));
    const bool by_torque = p.torque.has_value();
    const double load = by_torque ? *p.torque : *p.current;
    const auto of_point = [&](const char* what, Kind kind, const std::optional<double>& value) {
      if (!value) return;
      data.push_back({format("point %d %s", number, what), kind, *value, deviation_of("point"), v, load, by_torque});
    };
    of_point("speed", Kind::point_speed, p.speed);
    if (by_torque) of_point("current", Kind::point_current, p.current);
    of_point("efficiency", Kind::point_efficiency, p.efficiency);
  }
  return data;
}

std::string spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

struct Estimate {
  std::string source;
  double value;
  double deviation;  ///< relative
};

/// Apart by more than contradiction_factor and three standard deviations, which are given for the logarithm.
bool is_gross(double ratio, double deviation) {
  return !(ratio > 0.0) || std::abs(std::log(ratio)) > std::log(contradiction_factor) + 3.0 * deviation;
}

void find_contradictions(const std::string& constant_name, const std::vector<Estimate>& estimates,
                         std::vector<Contradiction>& out) {
  for (std::size_t a = 0; a < estimates.size(); ++a) {
    for (std::size_t b = a + 1; b < estimates.size(); ++b) {
      const double ratio = estimates[b].value / estimates[a].value, size = std::abs(ratio - 1.0);
      if (size > 5e-4) {
        out.push_back({constant_name, estimates[a].source, estimates[b].source, estimates[a].value, estimates[b].value,
                       size, is_gross(ratio, std::hypot(estimates[a].deviation, estimates[b].deviation))});
      }
    }
  }
}

/// Where the sheet contradicts itself grossly: takes back the constants concerned and says why.
void refuse_contradictions(const std::vector<Datum>& data, MotorIdentification& result) {
  const auto take_back = [](IdentifiedConstant& c) { c = {std::nullopt, 0.0, "contradicted"}; };
  const auto advice = [](const std::string& constants, const std::string& reason) {
    return constants + ": " + reason +
           "; correct the sheet, leave one of them out, or state in [deviation] how uncertain it is";
  };
  std::string electrical, inertia;
  for (const Contradiction& c : result.contradictions) {
    if (!c.gross) continue;
    const double factor = std::max(c.first_value / c.second_value, c.second_value / c.first_value);
    const std::string reason =
        format("%s and %s contradict each other about the %s by a factor of %.3g (%.4g and %.4g)", c.first.c_str(),
               c.second.c_str(), c.constant.c_str(), factor, c.first_value, c.second_value);
    std::string& which = c.constant == "rotor inertia" ? inertia : electrical;
    if (which.empty()) which = reason;
  }
  for (const Datum& d : data) {
    const auto check = std::find_if(result.checks.begin(), result.checks.end(),
                                    [&](const DatasheetCheck& c) { return c.name == d.name; });
    if (!electrical.empty() || check == result.checks.end()) continue;
    if (!is_gross(check->identified / check->published, d.deviation)) continue;
    electrical = format("%s (%.4g) and the rest of the sheet (%.4g) contradict each other", spaced(d.name).c_str(),
                        check->published, check->identified);
  }
  if (!electrical.empty()) {
    for (IdentifiedConstant* c :
         {&result.armature_resistance, &result.torque_constant, &result.viscous_damping, &result.friction_torque}) {
      take_back(*c);
    }
    result.missing.push_back(advice("armature resistance, torque constant and losses", electrical));
  }
  if (!inertia.empty()) {
    take_back(result.inertia);
    result.missing.push_back(advice("rotor inertia", inertia));
  }
}

}  // namespace

Motor<double> MotorIdentification::motor() const {
  if (!complete()) throw std::logic_error("the motor is not completely identified");
  return {*armature_resistance.value, *armature_inductance.value, *torque_constant.value, *inertia.value,
          *viscous_damping.value,     *friction_torque.value};
}

MotorIdentification identify_motor(const MotorDatasheet& s, std::optional<double> frequency) {
  validate(s);
  MotorIdentification result;
  const std::vector<Datum> data = data_of(s);
  const bool at_output = s.shaft == Shaft::output;
  const double n = s.gear_ratio;
  const double to_output = at_output ? 1.0 : n;  // of a torque or a constant

  // First guesses from whatever is there.
  const double v = s.voltage.value_or(1.0);
  double R = s.resistance.value_or(s.stall_current ? v / *s.stall_current : 0.0);
  double K = s.torque_constant.value_or(s.speed_constant ? 1.0 / *s.speed_constant : 0.0);
  if (!(K > 0.0) && s.stall_torque && s.stall_current) K = *s.stall_torque / *s.stall_current;
  if (!(K > 0.0) && s.no_load_speed) K = 0.95 * v / *s.no_load_speed;
  for (const MotorPoint& p : s.points) {
    if (!(K > 0.0) && p.torque && p.current && *p.current > 0.0) K = *p.torque / *p.current;
    if (!(R > 0.0) && K > 0.0 && p.speed && p.current && *p.current > 0.0) {
      R = std::max((p.voltage.value_or(v) - K * *p.speed) / *p.current, 0.0);
    }
  }
  if (!(R > 0.0) && K > 0.0 && s.stall_torque) R = K * v / *s.stall_torque;
  if (!(K > 0.0) && R > 0.0 && s.stall_torque) K = *s.stall_torque * R / v;
  const bool guess_R = !(R > 0.0), guess_K = !(K > 0.0);
  if (guess_R) R = 1.0;
  if (guess_K) K = 1e-2;

  const double speed = s.no_load_speed.value_or(v / K);
  double loss = s.no_load_current ? K * *s.no_load_current : s.friction_torque.value_or(0.0);
  if (!(loss > 0.0)) loss = s.viscous_damping ? *s.viscous_damping * speed : 0.02 * K * v / R;
  const Scales scales{loss, loss / speed, at_output ? s.gear_efficiency.value_or(1.0) : 1.0};

  const auto sensitivities = [&](const double* x) {
    Eigen::MatrixXd jacobian(Eigen::Index(data.size()), int(unknowns));
    for (std::size_t row = 0; row < data.size(); ++row) {
      ceres::Jet<double, unknowns> jets[unknowns];
      for (int k = 0; k < unknowns; ++k) jets[k] = {x[k], k};
      const auto p = predicted(data[row], jets, scales);
      for (int k = 0; k < unknowns; ++k) {
        jacobian(Eigen::Index(row), k) = p.v[k] / (data[row].value * data[row].deviation);
      }
    }
    return jacobian;
  };

  // Which unknowns the data determine: a column that the others and the data cannot replace.
  double x[unknowns] = {std::log(R), std::log(K), s.friction_torque ? 0.5 : 0.0, s.friction_torque ? 0.5 : 1.0};
  if (s.friction_torque) x[friction] = *s.friction_torque / scales.friction;
  if (s.viscous_damping) x[damping] = *s.viscous_damping / scales.damping;
  std::vector<int> free = {resistance, constant};
  const auto rank_of = [&](const std::vector<int>& columns) {
    if (data.empty()) return Eigen::Index(0);
    const Eigen::MatrixXd all = sensitivities(x);
    Eigen::MatrixXd chosen(all.rows(), Eigen::Index(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c) chosen.col(Eigen::Index(c)) = all.col(columns[c]);
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(chosen);
    qr.setThreshold(1e-4);
    return qr.rank();
  };
  // What friction could explain must not be taken for missing resistance: the electrical constants come first.
  const bool electrical = rank_of({resistance, constant}) == 2;
  const bool has_R = electrical || (rank_of({constant}) < rank_of({resistance, constant}) && s.resistance);
  bool both = electrical && rank_of({resistance, constant, friction, damping}) == 4;
  const bool one = electrical && rank_of({resistance, constant, damping}) == 3;
  const bool only_constant = electrical && !one && rank_of({resistance, constant, friction}) == 3;
  if (both) {
    free.push_back(friction);
    free.push_back(damping);
  } else if (only_constant || (one && s.friction_torque)) {
    free.push_back(friction);
    x[damping] = 0.0;
  } else if (one) {
    free.push_back(damping);
    x[friction] = 0.0;
  } else {
    // Losses unknown: the fallback or none for the fit of the rest.
    const double b_sheet = typical_motor_damping * (at_output ? n * n : 1.0);
    x[friction] = 0.0;
    x[damping] = s.assume_typical_damping ? b_sheet / scales.damping : 0.0;
  }

  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(unknowns, unknowns);
  const auto error = [&](int k) { return std::sqrt(std::max(covariance(k, k), 0.0)); };
  const auto fit = [&] {
    auto* cost = new ceres::DynamicAutoDiffCostFunction<Residuals, 4>(new Residuals{data, scales});
    cost->AddParameterBlock(unknowns);
    cost->SetNumResiduals(int(data.size()));
    ceres::Problem problem;
    problem.AddResidualBlock(cost, nullptr, x);
    for (const int k : {friction, damping}) problem.SetParameterLowerBound(x, k, 0.0);
    std::vector<int> fixed;
    for (int k = 0; k < unknowns; ++k) {
      if (std::find(free.begin(), free.end(), k) == free.end()) fixed.push_back(k);
    }
    if (!fixed.empty()) problem.SetManifold(x, new ceres::SubsetManifold(unknowns, fixed));
    const ceres::Solver::Options options = least_squares(500, 1e-16, 1e-12);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    const Eigen::MatrixXd all = sensitivities(x);
    Eigen::MatrixXd J(all.rows(), Eigen::Index(free.size()));
    for (std::size_t c = 0; c < free.size(); ++c) J.col(Eigen::Index(c)) = all.col(free[c]);
    const Eigen::MatrixXd inverse = (J.transpose() * J).completeOrthogonalDecomposition().pseudoInverse();
    covariance.setZero();
    for (std::size_t a = 0; a < free.size(); ++a) {
      for (std::size_t b = 0; b < free.size(); ++b) {
        covariance(free[a], free[b]) = inverse(Eigen::Index(a), Eigen::Index(b));
      }
    }
    // Values that scatter more widely than their deviations say are less exact than these say.
    double chi_square = 0.0;
    for (const Datum& d : data) {
      chi_square += square((predicted(d, x, scales) - d.value) / (d.value * d.deviation));
    }
    const double freedom = double(data.size()) - double(free.size());
    result.birge_ratio = freedom > 0.0 ? std::max(1.0, std::sqrt(chi_square / freedom)) : 1.0;
    covariance *= square(result.birge_ratio);
  };
  if (electrical) fit();
  // A constant friction that nothing states must stand out of its own error.
  if (both && !s.friction_torque && x[friction] < 2.0 * error(friction)) {
    both = false;
    free = {resistance, constant, damping};
    x[friction] = 0.0;
    x[damping] = std::max(x[damping], 1.0);
    fit();
  }
  R = std::exp(x[resistance]);
  K = std::exp(x[constant]);
  if (electrical) {
    result.armature_resistance = {R, R * error(resistance), "fitted"};
    result.torque_constant = {to_output * K, to_output * K * error(constant), "fitted"};
    for (const Datum& d : data) {
      const double p = predicted(d, x, scales);
      result.checks.push_back({d.name, d.value, p, p / d.value - 1.0});
    }
  } else {
    if (has_R) result.armature_resistance = {*s.resistance, s.deviation * *s.resistance, "the sheet's"};
    if (!has_R) {
      result.missing.push_back(
          "armature resistance: give resistance, stall_current with voltage, or points of the "
          "performance curve");
    }
    const bool K_known = s.torque_constant || s.speed_constant;
    if (K_known) result.torque_constant = {to_output * K, to_output * s.deviation * K, "the sheet's"};
    if (!K_known) {
      result.missing.push_back(
          "torque constant: give torque_constant, speed_constant, stall_torque with "
          "stall_current, or no_load_speed with resistance");
    }
    if (has_R && K_known)
      result.missing.push_back("torque constant and resistance: the sheet's values cannot be fitted");
  }

  // Losses.
  const double squared = to_output * to_output;
  const bool losses_known = both || one || only_constant;
  if (losses_known) {
    result.friction_torque = {to_output * x[friction] * scales.friction, to_output * error(friction) * scales.friction,
                              "fitted"};
    result.viscous_damping = {squared * x[damping] * scales.damping, squared * error(damping) * scales.damping,
                              "fitted"};
    if (both && x[damping] * scales.damping * speed < 1e-6 * loss) {
      result.viscous_damping.value = 0.0;
      result.remarks.push_back("the losses are all constant friction: the sheet's values leave no viscous part");
    }
    if (!both && one && !s.friction_torque) {
      result.remarks.push_back(
          "the sheet cannot tell constant from viscous friction: all of the loss is taken as viscous "
          "damping");
    }
    if (only_constant || (!both && s.friction_torque)) {
      result.remarks.push_back(
          "nothing on the sheet shows a viscous loss: all of the loss is taken as constant friction");
    }
  } else if (s.assume_typical_damping) {
    result.friction_torque = {0.0, 0.0, "assumed"};
    result.viscous_damping = {n * n * typical_motor_damping, 0.0, "fallback"};
    result.remarks.push_back(
        format("fallback: viscous damping %.3g N m s/rad at the motor shaft, a typical value; the "
               "sheet shows no loss",
               typical_motor_damping));
  } else {
    result.missing.push_back(
        "viscous damping: give no_load_current, friction_torque, viscous_damping or points of the "
        "performance curve, or ask for the fallback viscous_damping = \"typical\"");
  }
  if (losses_known && s.assume_typical_damping) {
    result.remarks.push_back("the fallback for viscous damping is not used: the sheet shows the losses");
  }

  // Inertia, at the motor shaft first.
  std::vector<Estimate> inertias;
  if (s.rotor_inertia) inertias.push_back({"rotor inertia", *s.rotor_inertia, deviation_in(s, "rotor_inertia")});
  if (s.mechanical_time_constant && electrical) {
    const double K_motor = at_output ? K / n : K;
    inertias.push_back({"mechanical time constant", *s.mechanical_time_constant * K_motor * K_motor / R,
                        deviation_in(s, "mechanical_time_constant")});
  }
  if (!inertias.empty()) {
    double sum = 0.0, weight = 0.0;
    for (const Estimate& e : inertias) {
      sum += std::log(e.value) / square(e.deviation);
      weight += 1.0 / square(e.deviation);
    }
    const double J = std::exp(sum / weight);
    double chi_square = 0.0;
    for (const Estimate& e : inertias) chi_square += square(std::log(e.value / J) / e.deviation);
    const double birge = std::max(1.0, std::sqrt(chi_square / std::max(double(inertias.size()) - 1.0, 1.0)));
    result.inertia = {n * n * J, n * n * J * birge / std::sqrt(weight),
                      inertias.size() > 1 ? "fitted" : inertias[0].source};
  } else if (s.assume_steel_cylinder) {
    const double r = 0.5 * *s.rotor_diameter;
    const double J = 0.5 * steel_density * pi * r * r * *s.rotor_length * r * r;
    result.inertia = {n * n * J, 0.0, "fallback"};
    result.remarks.push_back(
        format("fallback: rotor inertia %.3g kg m2 of a solid steel cylinder of the rotor's size "
               "(a coreless rotor has less)",
               J));
  } else {
    result.missing.push_back(
        "rotor inertia: give rotor_inertia or mechanical_time_constant, or rotor_diameter and "
        "rotor_length with the fallback inertia = \"solid-steel-cylinder\"");
  }
  if (!inertias.empty() && s.assume_steel_cylinder) {
    result.remarks.push_back("the fallback for the inertia is not used: the sheet determines it");
  }
  find_contradictions("rotor inertia", inertias, result.contradictions);

  // Inductance.
  if (s.inductance) {
    result.armature_inductance = {*s.inductance, 0.0, "the sheet's"};
  } else {
    result.armature_inductance = {0.0, 0.0, "assumed"};
    std::string remark = "no inductance given: assumed 0";
    if (frequency && electrical) {
      // First-order lag of the current's ripple, at twice the flapping frequency.
      const double one_percent = R * std::sqrt(1.0 / (0.99 * 0.99) - 1.0) / (2.0 * two_pi * *frequency);
      remark += format("; at %.4g Hz the ripple of the current, at twice that, would be 1 %% smaller with %.3g H",
                       *frequency, one_percent);
    } else {
      remark += "; give the flapping frequency to learn from which inductance on it matters";
    }
    result.remarks.push_back(remark);
  }
  if (s.gear_efficiency && at_output) {
    result.remarks.push_back(
        format("the gear efficiency of %.4g served to read the sheet's torques at the output; the "
               "[motor] section holds no gear efficiency, so that a vehicle with this motor has an "
               "ideal gearbox: its losses under load are not in any result",
               *s.gear_efficiency));
  } else if (s.gear_efficiency) {
    result.remarks.push_back(
        format("the gear efficiency of %.4g is NOT USED: the sheet's values stand for the motor shaft, "
               "and the [motor] section holds no gear efficiency, so that a vehicle with this motor "
               "has an ideal gearbox: its losses under load are not in any result",
               *s.gear_efficiency));
  }

  // Independent ways to the same constant.
  std::vector<Estimate> resistances, constants;
  const auto add = [&](std::vector<Estimate>& to, const char* source, double value,
                       std::initializer_list<const char*> rests_on) {
    double variance = 0.0;
    for (const char* name : rests_on) variance += square(deviation_in(s, name));
    to.push_back({source, value, std::sqrt(variance)});
  };
  if (s.resistance) add(resistances, "resistance", *s.resistance, {"resistance"});
  if (s.stall_current) add(resistances, "stall current", v / *s.stall_current, {"stall_current"});
  if (s.torque_constant) add(constants, "torque constant", *s.torque_constant, {"torque_constant"});
  if (s.speed_constant) add(constants, "speed constant", 1.0 / *s.speed_constant, {"speed_constant"});
  const double eta = scales.torque_factor;
  if (s.stall_torque && s.stall_current) {
    const double T_c = x[friction] * scales.friction;
    add(constants, "stall torque and current", (*s.stall_torque / eta + T_c) / *s.stall_current,
        {"stall_torque", "stall_current"});
  }
  if (s.no_load_speed && !resistances.empty()) {
    const double i_0 = s.no_load_current.value_or(0.0);
    add(constants, "no-load speed", (v - resistances[0].value * i_0) / *s.no_load_speed, {"no_load_speed"});
  }
  if (!constants.empty() && s.stall_torque && !s.stall_current) {
    add(resistances, "stall torque", constants[0].value * v * eta / *s.stall_torque, {"stall_torque"});
    resistances.back().deviation = std::hypot(resistances.back().deviation, constants[0].deviation);
  }
  find_contradictions("armature resistance", resistances, result.contradictions);
  find_contradictions("torque constant", constants, result.contradictions);
  if (s.no_load_current && s.friction_torque && !constants.empty()) {
    find_contradictions(
        "friction torque",
        {{"friction torque", *s.friction_torque, deviation_in(s, "friction_torque")},
         {"no-load current", constants[0].value * *s.no_load_current, deviation_in(s, "no_load_current")}},
        result.contradictions);
  }
  std::stable_sort(result.contradictions.begin(), result.contradictions.end(),
                   [](const auto& a, const auto& b) { return a.size > b.size; });
  for (Datum const& d : data) {
    if (d.kind == Kind::point_torque) continue;
    const auto check = std::find_if(result.checks.begin(), result.checks.end(),
                                    [&](const DatasheetCheck& c) { return c.name == d.name; });
    if (check != result.checks.end() && std::abs(check->deviation) > 3.0 * d.deviation) {
      result.remarks.push_back(
          format("%s does not fit the rest of the sheet: %.4g published, %.4g from the identified "
                 "motor",
                 spaced(d.name).c_str(), d.value, check->identified));
    }
  }
  if (result.birge_ratio > 1.05) {
    result.remarks.push_back(
        format("the sheet's values scatter %.3g times as widely as their deviations say: the standard "
               "errors are that much larger (Birge ratio)",
               result.birge_ratio));
  }
  refuse_contradictions(data, result);
  return result;
}

}  // namespace wingbeat
