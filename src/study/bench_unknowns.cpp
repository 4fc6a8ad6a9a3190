#include "study/bench_unknowns.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "wingbeat/core/text.hpp"
#include "wingbeat/vehicle/drive.hpp"

namespace wingbeat {
namespace {

using detail::format;
using Kind = BenchUnknown::Kind;

std::string short_name(const std::string& file) { return file.substr(file.find_last_of('/') + 1); }

FreeParameter unknown(std::string key, const char* unit, double lower, double upper, double start,
                      const BenchUnknown& which) {
  FreeParameter p{{std::move(key), unit}, lower, upper, start};
  p.of_bench = which;
  return p;
}

}  // namespace

std::optional<BenchUnknown> balance_unknown(const std::string& key) {
  for (const BalanceNumber& n : balance_numbers) {
    if (key != std::string("balance.") + n.key) continue;
    BenchUnknown unknown{Kind::balance};
    unknown.of_balance = &n;
    return unknown;
  }
  return std::nullopt;
}

BenchFit with_bench_unknowns(BenchFit fit) {
  for (std::size_t l = 0; l < fit.logs.size(); ++l) {
    const BenchLog& log = fit.logs[l];
    std::set<int> bursts;
    for (const BenchRow& row : log.rows) bursts.insert(row.burst);
    if (log.in_time && !log.phase_known) {
      for (const int burst : bursts) {
        const std::string which = bursts.size() > 1 ? format(", burst %d", burst) : "";
        fit.parameters.push_back(unknown("phase of " + short_name(log.file) + which, "rad", -two_pi, 2.0 * two_pi, pi,
                                         {Kind::phase, l, burst}));
      }
    }
    for (const WaveformQuantity q : log.unknown_zeros) {
      // The zero lies within the values or as far outside as they reach.
      double least = HUGE_VAL, largest = -HUGE_VAL, sum = 0.0;
      int count = 0;
      for (std::size_t c = 0; c < log.columns.size(); ++c) {
        if (!log.columns[c].waveform || log.columns[c].quantity != q) continue;
        for (const BenchRow& row : log.rows) {
          if (std::isnan(row.values[c])) continue;
          least = std::min(least, row.values[c]);
          largest = std::max(largest, row.values[c]);
          sum += row.values[c];
          ++count;
        }
      }
      const double range = largest > least ? largest - least : std::max(std::abs(largest), 1.0);
      const double middle = count > 0 ? sum / count : 0.0;
      fit.parameters.push_back(unknown(format("zero of %s in %s", name_of(q), short_name(log.file).c_str()), unit_of(q),
                                       std::min(middle, 0.0) - range, std::max(middle, 0.0) + range, middle,
                                       {Kind::zero, l, 0, q}));
    }
  }
  return fit;
}

double unknown_scale(const FreeParameter& p) {
  return p.of_bench->kind == Kind::phase ? 1.0 : (p.upper - p.lower) / 6.0;
}

void check_bench(const BenchFit& fit) {
  for (const BenchLog& log : fit.logs) {
    for (const MeasuredQuantity& q : log.columns) {
      if (!q.waveform) continue;
      if (q.quantity == WaveformQuantity::balance_force && !fit.balance) {
        throw ParameterError("balance", "missing: " + short_name(log.file) +
                                            " has readings of a balance; state its mass, stiffness and damping");
      }
      if (q.quantity == WaveformQuantity::pitch_angle && !fit.design.pitch.stiffness) {
        throw ParameterError("pitch", "missing in the vehicle file: " + short_name(log.file) + " has pitch_angle");
      }
      if (q.quantity == WaveformQuantity::rod_force && !drive_of(fit.design).has_rod) {
        throw ParameterError("log.measured", "rod_force: the vehicle has no rod");
      }
    }
  }
  for (const auto& [quantity, deviation] : fit.deviations) {
    if (deviation.kind != Deviation::Kind::scatter) continue;
    for (const BenchLog& log : fit.logs) {
      for (std::size_t c = 0; c < log.columns.size(); ++c) {
        if (log.columns[c] != quantity) continue;
        for (const BenchRow& row : log.rows) {
          if (std::isnan(row.values[c]) || (c < row.deviations.size() && row.deviations[c] > 0.0)) continue;
          throw ParameterError("deviation." + name_of(quantity),
                               short_name(log.file) + " does not show the scatter of all its values: state it");
        }
      }
    }
  }
  if (!fit.balance) {
    for (const FreeParameter& p : fit.parameters) {
      if (p.of_bench && p.of_bench->kind == Kind::balance) {
        throw ParameterError(p.parameter.key, "no log has readings of a balance");
      }
    }
    return;
  }
  for (const BalanceNumber& n : balance_numbers) {
    const double x = (*fit.balance).*n.number;
    require(n.may_be_zero ? x >= 0.0 : x > 0.0, (std::string("balance.") + n.key).c_str(),
            n.may_be_zero ? "must be >= 0" : "must be > 0", n.unit, x);
  }
}

}  // namespace wingbeat
