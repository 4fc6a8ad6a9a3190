#include "time/crank_start_up.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wingbeat/cycle/integrals_audit.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {
namespace {

constexpr int averaged_cycles_pwm = 8;
constexpr double settled_without_metrics = 1e-4;
constexpr double largest_rate = 0.99999;  // of contraction: what is left of a change is no more than 1e5 times it
constexpr std::size_t max_turns = 8;      // after which a motion is looked at for repeating

/// True where a metric is what is left of far larger parts.
bool cancels(const Metrics<double>& m) {
  return !(m[Metric::lift_peak] <= 10.0 * std::abs(m[Metric::lift_mean]) &&
           m[Metric::power_reactive] <= 5.0 * std::abs(m[Metric::power_motor]) &&
           m[Metric::power_electrical] <= 5.0 * std::abs(m[Metric::power_loss]) &&
           m[Metric::current_rms] <= 5.0 * std::abs(m[Metric::current_mean]));
}

}  // namespace

/// A forward crossing of theta = 2 pi n. True if the integrator must start afresh.
bool CrankStartUp::cycle_done() {
  const double before = crossings_.empty() ? 0.0 : crossings_.back().time + crossings_.back().skipped;
  crossings_.push_back({now_.t, now_.moving, now_.t - before, 0.0});
  cycle_begins();
  event(Kind::revolution);
  model_.next_cycle += two_pi;
  Coordinates<double> at_zero = now_.moving;
  at_zero.angle = 0.0;
  if (options_.arrived && options_.arrived(at_zero)) {
    flap();
    return true;
  }
  const bool restart = model_.supply.type == SupplyType::constant ? cycle_done_constant() : cycle_done_averaging();
  if (!done_ && int(crossings_.size()) >= options_.max_cycles) {
    give_up({.kind = Evidence::cycles_differ, .change = change_, .cycles = options_.max_cycles});
  }
  return restart;
}

bool CrankStartUp::cycle_done_constant() {
  ++cycles_compared_;
  ++cycles_since_jump_;
  if (crossings_.size() < 2) return false;
  if (turns_ == 1 && cycles_compared_ >= 40 && cycles_compared_ % 16 == 0) {
    for (std::size_t turns = 2; turns <= max_turns && turns_ == 1; ++turns) {
      if (!repeats_after(turns)) continue;
      turns_ = turns;
      change_ = infinity;
      rate_ = last_rate_ = 1.0;
      rate_seen_ = false;
      cycles_compared_ = 0;
      return false;
    }
  }
  if (turns_ > 1 && cycles_compared_ % int(turns_) != 0) return false;
  const Crossing& before = crossings_[crossings_.size() - 1 - turns_];
  const double noise = 30.0 * relative_tolerance_;
  const double previous = change_;
  change_ = state_change(before);
  changes_.push_back(change_);
  if (never_repeats()) {
    give_up({.kind = Evidence::cycles_differ, .change = change_, .cycles = int(crossings_.size())});
    return true;
  }
  if (cycles_compared_ >= 3 && previous > noise && !model_.measuring) {
    last_rate_ = rate_;
    rate_ = std::min(change_ / previous, 10.0);
    if (!rate_seen_) last_rate_ = rate_;
    rate_seen_ = true;
  }
  // The slower of the last two contractions, since complex multipliers make the changes uneven.
  double rate = std::max(rate_, last_rate_);
  stagnant_ = !model_.measuring && change_ < 100.0 * noise && change_ > 0.5 * previous ? stagnant_ + 1 : 0;
  if ((change_ < noise && cycles_compared_ >= 3 && !model_.measuring && (!rate_seen_ || rate >= 0.3)) ||
      stagnant_ >= 2) {
    // Slow approach or the integrator's own errors? More accuracy tells; at rounding it must be the latter.
    stagnant_ = 0;
    if (relative_tolerance_ <= tightest_ && change_ < 0.1 * options_.tolerance) rate_ = last_rate_ = rate = 0.5;
    relative_tolerance_ = std::max(tightest_, relative_tolerance_ / 30.0);
  }
  const double to_come = rate < 1.0 ? change_ * rate / (1.0 - rate) : infinity;

  if (model_.measuring) {
    cycle_measured(rate);
    return true;
  }
  if (rate < 1.0 && rate > 0.3 && to_come < 1e-2) {
    // Weakly damped: what a cycle's errors leave behind adds up over 1 / (1 - rate) cycles.
    relative_tolerance_ = std::min(relative_tolerance_, std::max(tightest_, loosest_ * (1.0 - rate)));
  }
  if (!options_.metrics && rate < 0.3 && to_come < settled_without_metrics) {
    flap();
    return true;
  }
  if (to_come < 0.1 * options_.tolerance || (rate < 1.0 && change_ < noise)) {
    relative_tolerance_ = std::max(tightest_, std::min(relative_tolerance_, 1e-3 * options_.tolerance));
    measure_next();
    return true;
  }
  return jump_ahead(rate);
}

/// Takes the metrics of a cycle as those of steady flapping where it began close enough to the orbit and a cycle of
/// looser steps gives the same. Otherwise the next cycle is measured: with tighter steps, and, where cycles converge
/// slowly, from where the known contraction leads.
void CrankStartUp::cycle_measured(double rate) {
  const double tolerance = options_.tolerance;
  const double gain = 1.0 / (1.0 - std::min(std::max(rate, contraction_), largest_rate));
  // The cycle began as far from the orbit as change / (1 - rate).
  const double off = change_ * gain;
  const bool tightest = relative_tolerance_ <= tightest_;
  const std::optional<Metrics<double>> before = std::exchange(last_metrics_, std::nullopt);
  take_cycles(int(turns_));
  ++measured_cycles_;
  cycles_at_tightest_ += tightest;
  const bool closed = off < 0.1 * tolerance;
  // Where errors neither cancel nor add up over cycles, steps of a thousandth are known to be enough.
  const bool enough = gain < 1.5 && relative_tolerance_ <= 1e-3 * tolerance && !cancels(*result_.metrics);
  const bool agree = enough || ((tightest || relative_tolerance_ < 0.2 * measured_with_) && before &&
                                metrics_apart(*before, *result_.metrics) < 0.3 * tolerance);
  const bool rounding = change_ < tolerance && cycles_at_tightest_ > (change_ < 30.0 * tightest_ ? 4 : 40);
  const EnergyAudit audit = energy_audit(*result_.metrics);
  // Slow contraction leaves a cycle that does not quite return: what the vehicle stores meanwhile is no error of it.
  const double stored = (model_.stored_energy() - stored_mark_) / (now_.t - measured_from_);
  const bool balances = closes(audit, tolerance, stored + load_power(), blocked_input(model_.vehicle));
  if ((closed && agree) || rounding) {
    // Where cycles were skipped, blocks of them may have shown what fades sooner than the speed does, of which the
    // motor alone takes little away.
    result_.closure = jumped_ ? std::max(off, change_ / free_return(model_.vehicle, crossings_.back().cycle)) : off;
    if (balances) return flap();
    if (tightest && cycles_at_tightest_ > 4) return give_up_open_balance(audit);
  }
  last_metrics_ = std::exchange(result_.metrics, std::nullopt);
  measured_with_ = relative_tolerance_;
  if (change_ > 100.0 * tolerance || cycles_at_tightest_ > 40) {
    // Not what was known of the contraction: back to plain cycles.
    model_.measuring = false;
    change_ = infinity;
    rate_ = last_rate_ = 1.0;
    rate_seen_ = false;
    cycles_compared_ = 1;
    cycles_at_tightest_ = 0;
    contraction_ = 0.0;
    last_metrics_.reset();
    return;
  }
  if (cycles_since_jump_ == 2 && change_ > 0.5 * change_before_jump_) contraction_ = 0.0;
  relative_tolerance_ =
      std::max(tightest_, closed || !balances ? relative_tolerance_ / 10.0
                                              : std::min(relative_tolerance_, 3e-3 * tolerance / gain));
  if (!closed && contraction_ > 0.0 && cycles_since_jump_ >= 2) {
    const double share = contraction_ / (1.0 - contraction_);
    Scaled by = scaled(now_.moving);
    const Scaled last = scaled(crossings_[crossings_.size() - 2].state);
    for (std::size_t k = 0; k < by.size(); ++k) by[k] = share * (by[k] - last[k]);
    move_state(by);
    cycles_since_jump_ = 0;
    change_before_jump_ = change_;
  }
  measure_next();
}

/// True if the state repeats after so many cycles, far better than after one.
bool CrankStartUp::repeats_after(std::size_t cycles) const {
  const std::size_t n = crossings_.size();
  if (n < 4 * cycles) return false;
  for (std::size_t k = n - 2 * cycles; k < n; ++k) {
    const Scaled a = scaled(crossings_[k - cycles].state), b = scaled(crossings_[k].state);
    const Scaled next = scaled(crossings_[k - cycles + 1].state);
    double off = 0.0, within = 0.0;
    for (std::size_t n_state = 0; n_state < a.size(); ++n_state) {
      off += std::abs(a[n_state] - b[n_state]);
      within += std::abs(a[n_state] - next[n_state]);
    }
    if (!(off < 1e-2 * within) || within < 1e-5) return false;
  }
  return true;
}

CrankStartUp::Scaled CrankStartUp::scaled(const Coordinates<double>& c) const {
  Scaled x{c.speed / model_.speed_scale, c.current / model_.current_scale};
  for_further_states(
      [&](std::size_t place, const GroupState<double>& state, double size) { x[place] = c.*state.number / size; });
  return x;
}

/// Largest relative change of the state since a crossing.
double CrankStartUp::state_change(const Crossing& before) const {
  Scaled beside;
  beside.fill(0.1);
  beside[0] = 1e-6, beside[1] = 0.01;
  const Scaled x = scaled(now_.moving), then = scaled(before.state);
  double change = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    change = std::max(change, std::abs(x[k] - then[k]) / (std::abs(x[k]) + beside[k]));
  }
  return change;
}

/// Moves the state, at a crossing, by so many of its typical sizes. Wings that are held, and a current that electronics
/// hold, stay there.
void CrankStartUp::move_state(const Scaled& by) {
  Coordinates<double>& c = now_.moving;
  c.speed += by[0] * model_.speed_scale;
  if (!model_.indices.inductive) {
    c.current = model_.current_now();
  } else if (!now_.blocked && !now_.limited) {
    c.current += by[1] * model_.current_scale;
  }
  for_further_states([&](std::size_t place, const GroupState<double>& state, double size) {
    const bool pitch =
        state.number == &Coordinates<double>::pitch_angle || state.number == &Coordinates<double>::pitch_velocity;
    if (!pitch || !now_.held) c.*state.number += by[place] * size;
  });
  if (model_.indices.pitching && !now_.held) {
    const PitchHinge<double>& hinge = model_.vehicle.pitch.hinge;
    c.pitch_angle = std::clamp(c.pitch_angle, hinge.stop_low, hinge.stop_high);
  }
  crossings_.back().state = c;
}

/// Where cycles converge slowly along one direction, skips ahead. Blocks of cycles of one size show by how much each
/// moves less than the one before, which single cycles of a heavy rotor do not show above the integrator's errors. To
/// the limit (Aitken) once that changes nothing a start-up is looked at for: less than a thousandth. Half of the way,
/// but no more than a fifth of the speed, where a heavy rotor has far to go.
bool CrankStartUp::jump_ahead(double rate) {
  const std::size_t n = crossings_.size();
  if (options_.record || turns_ > 1 || cycles_compared_ < 5 || rate < 0.3) return false;
  const std::size_t cycles = std::size_t(cycles_compared_) - 2;  // the first one after a jump still settles
  for (const std::size_t block : {1, 8, 32, 128}) {
    if (3 * block > cycles) break;
    if (block > 1 ? rate < 0.9 || cycles % block != 0 : rate >= 1.0) continue;
    if (jump_by_blocks(n, block)) return true;
  }
  return false;
}

bool CrankStartUp::jump_by_blocks(std::size_t n, std::size_t block) {
  const auto difference = [&](std::size_t back) {
    Scaled d = scaled(crossings_[n - 1 - back * block].state);
    const Scaled before = scaled(crossings_[n - 1 - (back + 1) * block].state);
    for (std::size_t k = 0; k < d.size(); ++k) d[k] -= before[k];
    if (!model_.indices.inductive) d[1] = 0.0;
    return d;
  };
  const auto product = [](const Scaled& a, const Scaled& b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
    return sum;
  };
  const auto ratio = [&](std::size_t back) {
    const Scaled a = difference(back + 1);
    return product(a, difference(back)) / product(a, a);
  };
  const double newer = ratio(0), older = ratio(1);
  if (!(newer > 0.0 && newer < 0.9999)) return false;
  const double gain = newer / (1.0 - newer), per_cycle = std::pow(newer, 1.0 / double(block));
  Scaled moved = difference(0);
  double to_come = std::max(
      std::abs(moved[0]) * model_.speed_scale / std::abs(now_.moving.speed),
      std::abs(moved[1]) * model_.current_scale / (std::abs(now_.moving.current) + 0.01 * model_.current_scale));
  for (std::size_t k = 2; k < moved.size(); ++k) to_come = std::max(to_come, std::abs(moved[k]));
  to_come *= gain;
  const bool to_the_limit = to_come <= 1e-3;
  if (std::abs(newer - older) > (to_the_limit ? 0.05 : 0.2) * (1.0 - newer)) return false;
  double share = 1.0, skipped = 0.0;
  if (!to_the_limit) {
    if (block == 1 || per_cycle < 0.98) return false;
    share = std::min(0.5, 0.2 / to_come);
    skipped = std::log1p(-share) / std::log(per_cycle);
    if (skipped < double(2 * block)) return false;
  }
  for (double& each : moved) each *= share * gain;
  move_state(moved);
  Crossing& here = crossings_.back();
  here.skipped = skipped * here.cycle;
  now_.t += here.skipped;
  end_time_ += here.skipped;
  cycles_compared_ = 1;
  cycles_since_jump_ = 0;
  contraction_ = per_cycle;
  change_ = infinity;
  jumped_ = true;
  if (to_the_limit && !options_.metrics) {
    change_ = to_come;
    flap();
  }
  return true;
}

/// Supplies that vary: cycles share no period with the supply in general, so averages over several cycles are compared.
bool CrankStartUp::cycle_done_averaging() {
  constexpr std::size_t window = averaged_cycles_pwm;
  const std::size_t n = crossings_.size();
  if (model_.measuring) {
    if (++measured_cycles_ < int(window)) return false;
    result_.cycle_scatter = cycle_scatter(window);
    take_cycles(int(window));
    const EnergyAudit audit = energy_audit(*result_.metrics);
    const double stored = (model_.stored_energy() - stored_mark_) / (now_.t - measured_from_);
    if (closes(audit, options_.tolerance, stored + load_power(), blocked_input(model_.vehicle))) {
      flap();
    } else if (relative_tolerance_ > tightest_) {
      relative_tolerance_ = std::max(tightest_, relative_tolerance_ / 10.0);
      model_.measuring = false;
      measure_next();
    } else {
      give_up_open_balance(audit);
    }
    return true;
  }
  if (n < 5) return false;
  const double newer = cycle_time(n - 1) + cycle_time(n - 2), older = cycle_time(n - 3) + cycle_time(n - 4);
  change_ = std::abs(newer / older - 1.0);
  if (change_ > std::max(options_.tolerance, 1e-4) && n < 40) return false;
  measure_next();
  return true;
}

double CrankStartUp::load_power() const {
  return load_work(model_.vehicle) / result_.integrals[std::size_t(Integral::time)];
}

double CrankStartUp::cycle_scatter(std::size_t cycles) const {
  const std::size_t n = crossings_.size();
  double mean = 0.0, scatter = 0.0;
  for (std::size_t k = n - cycles; k < n; ++k) mean += cycle_time(k) / double(cycles);
  for (std::size_t k = n - cycles; k < n; ++k) scatter = std::max(scatter, std::abs(cycle_time(k) / mean - 1.0));
  return scatter;
}

void CrankStartUp::measure_next() {
  if (!model_.measuring) measured_cycles_ = 0;
  ripple_sum_ = 0.0;
  ripple_count_ = 0;
  ripple_bottom_ = absent;
  measured_angle_ = model_.next_cycle - two_pi;
  begin_measuring();
}

void CrankStartUp::take_cycles(int cycles) {
  const std::size_t n = crossings_.size();
  end_rows(measured_from_, measured_angle_);
  if (model_.indices.pitching) {
    // Of a crank that stands for a while, what rounding leaves of the speed is none.
    double& slowest = extremes_[std::size_t(Extreme::crank_speed_min)];
    if (std::abs(slowest) < 1e-9 * model_.speed_scale) slowest = 0.0;
  }
  take_metrics(int(n) > cycles ? crossings_[n - 1 - std::size_t(cycles)].time : 0.0, now_.t, cycles);
  if (ripple_count_ > 0) result_.current_ripple = ripple_sum_ / double(ripple_count_);
}

}  // namespace wingbeat::detail
