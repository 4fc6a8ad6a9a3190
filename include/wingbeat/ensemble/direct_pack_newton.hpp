// Newton's method on SIMD lanes: the part of DirectPackOrbit that makes a trajectory satisfy the equations at the Radau
// points, and half a period end at the negative of its start.
#pragma once

#include "wingbeat/ensemble/direct_pack_orbit.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// Equal segments of half a period.
template <class L, int N>
void DirectPackOrbit<L, N>::set_mesh(int segments) {
  segments_ = std::size_t(segments);
  length_ = pi / double(segments);
  for (std::size_t s = 0; s < segments_; ++s) {
    for (std::size_t j = 0; j < stages; ++j) {
      const double phase = (double(s) + rule_.phase[j + 1]) * length_;
      phase_sine_[s * stages + j] = std::sin(phase);
      phase_cosine_[s * stages + j] = std::cos(phase);
    }
  }
  length_in_time_ = L(length_) * per_drive_;
}

/// Puts the trajectory onto twice as many segments.
template <class L, int N>
void DirectPackOrbit<L, N>::halve() {
  const std::size_t before = segments_;
  set_mesh(2 * int(before));
  const auto onto_halves = [&](std::array<L, max_nodes>& values, const L& start) {
    // From the end, so that what is read is not yet written over.
    for (std::size_t s = before; s-- > 0;) {
      std::array<L, points> from;
      from[0] = s > 0 ? values[s * stages - 1] : start;
      for (std::size_t m = 1; m < points; ++m) from[m] = values[s * stages + m - 1];
      for (std::size_t j = 0; j < 2 * stages; ++j) {
        L sum(0.0);
        for (std::size_t m = 0; m < points; ++m) sum = sum + L(rule_.halved[j][m]) * from[m];
        values[2 * s * stages + j] = sum;
      }
    }
  };
  onto_halves(beta_, start_[0]);
  onto_halves(omega_, start_[1]);
  if constexpr (N == 3) onto_halves(current_, start_[2]);
}

/// Everything that acts at one instant, upward from a reversal.
template <class L, int N>
template <bool has_added_mass>
Motion<L> DirectPackOrbit<L, N>::motion_of(const L& beta, const L& omega, const L& i, const L& v) const {
  const L N_k_beta = vehicle_.wing_count * vehicle_.spring.stiffness * beta;
  const Mode<L> upward;
  const MotionState<L> instant{{direct_kinematics<L>(), N_k_beta}, omega, i, v};
  return motion_on<has_added_mass>(vehicle_, instant, terms_at<has_added_mass>(vehicle_, instant, upward), upward);
}

template <class L, int N>
template <bool has_added_mass>
void DirectPackOrbit<L, N>::accelerate(std::size_t node, Acceleration& out) const {
  const L v = voltage(node), beta = beta_[node], omega = omega_[node];
  const auto acceleration_under = [&](const L& speed) {
    if constexpr (N == 3) {
      return motion_of<has_added_mass>(beta, speed, current_[node], v).crank_acceleration;
    } else {
      return motion_of<has_added_mass>(beta, speed, algebraic_current(vehicle_, v, speed), v).crank_acceleration;
    }
  };
  out.value = acceleration_under(omega);
  const L by = L(1e-6) * speed_;
  out.by_speed = (acceleration_under(L(omega + by)) - out.value) * (L(1e6) * per_speed_);
  const AeroLoads<L> aero = aero_loads<has_added_mass>(vehicle_.wings, omega, L(1.0), L(1.0));
  out.per_inertia =
      inverse_of(L(vehicle_.motor.inertia + vehicle_.wing_count * vehicle_.wing_inertia + aero.added_inertia));
}

/// What the segments of a mesh have in common. With T the time that a segment takes and A the collocation matrix, the
/// currents at its stages are E (i_start + T/L_a A (v - K omega)) with E = (1 + T R/L_a A)^-1.
template <class L, int N>
void DirectPackOrbit<L, N>::prepare_segments() {
  const L K = vehicle_.motor.torque_constant;
  const L stiffness = vehicle_.wing_count * vehicle_.spring.stiffness;
  for (std::size_t j = 0; j < stages; ++j) {
    for (std::size_t m = 0; m < stages; ++m) {
      torque_by_speed_[j][m] = -(stiffness * (length_in_time_ * L(rule_.a[j][m])));
    }
  }
  if constexpr (N == 3) {
    const L per_L = length_in_time_ * per_inductance_, decay = per_L * circuit_resistance(vehicle_);
    // E by Gauss and Jordan; the pivots of 1 + z A stay away from zero for all z >= 0.
    Square left, inverse;
    for (std::size_t j = 0; j < stages; ++j) {
      for (std::size_t m = 0; m < stages; ++m) {
        inverse[j][m] = L(j == m ? 1.0 : 0.0);
        left[j][m] = L(j == m ? 1.0 : 0.0) + decay * L(rule_.a[j][m]);
      }
    }
    for (std::size_t k = 0; k < stages; ++k) {
      const L per_pivot = inverse_of(left[k][k]);
      for (std::size_t m = 0; m < stages; ++m) {
        left[k][m] = left[k][m] * per_pivot;
        inverse[k][m] = inverse[k][m] * per_pivot;
      }
      for (std::size_t j = 0; j < stages; ++j) {
        if (j == k) continue;
        const L factor = left[j][k];
        for (std::size_t m = 0; m < stages; ++m) {
          left[j][m] = left[j][m] - factor * left[k][m];
          inverse[j][m] = inverse[j][m] - factor * inverse[k][m];
        }
      }
    }
    current_by_residual_ = inverse;
    for (std::size_t j = 0; j < stages; ++j) {
      L sum(0.0);
      for (std::size_t m = 0; m < stages; ++m) {
        sum = sum + inverse[j][m];
        L by_speed(0.0);
        for (std::size_t l = 0; l < stages; ++l) by_speed = by_speed + inverse[j][l] * L(rule_.a[l][m]);
        current_by_speed_[j][m] = -(per_L * K * by_speed);
        torque_by_speed_[j][m] = torque_by_speed_[j][m] + K * current_by_speed_[j][m];
      }
      current_by_start_[j] = sum;
    }
  }
}

/// The linearised equations of a segment: the velocity's changes by residuals, start and phase, and the map from start
/// to end, `end` in rows of its columns. `start` is the state there.
template <class L, int N>
void DirectPackOrbit<L, N>::linearise(std::size_t segment, const std::array<L, std::size_t(N)>& start,
                                      std::array<Row, std::size_t(N)>& end) {
  const std::size_t base = segment * stages;
  const L K = vehicle_.motor.torque_constant;
  const L stiffness = vehicle_.wing_count * vehicle_.spring.stiffness, T = length_in_time_;
  Linearised& to = linearised_[segment];
  const auto integral = [&](std::size_t j, const Vector& integrand) {
    L sum(0.0);
    for (std::size_t l = 0; l < stages; ++l) sum = sum + L(rule_.a[j][l]) * integrand[l];
    return sum;
  };
  Vector value, by_speed, per_inertia, speed, voltage_left, voltage_by_phase;
  for (std::size_t l = 0; l < stages; ++l) {
    Acceleration a;
    if (added_mass_) accelerate<true>(base + l, a);
    else accelerate<false>(base + l, a);
    value[l] = a.value;
    by_speed[l] = a.by_speed;
    per_inertia[l] = a.per_inertia;
    speed[l] = omega_[base + l];
    voltage_by_phase[l] = voltage_slope(base + l);
    if constexpr (N == 3) {
      voltage_left[l] = voltage(base + l) - circuit_resistance(vehicle_) * current_[base + l] - K * speed[l];
    }
    acceleration_[base + l] = a.value;
  }
  // Residuals, and what they and the phase make of the currents.
  std::array<Vector, columns>& q = to.omega;
  Vector torque_by_residual, torque_by_phase;
  for (std::size_t j = 0; j < stages; ++j) {
    to.beta[j] = T * integral(j, speed) + (start[0] - beta_[base + j]);
    q[0][j] = T * integral(j, value) + (start[1] - omega_[base + j]);
    torque_by_residual[j] = -(stiffness * to.beta[j]);
    if constexpr (N == 2) torque_by_phase[j] = K * per_resistance_ * voltage_by_phase[j];
  }
  if constexpr (N == 3) {
    const L per_L = T * per_inductance_;
    Vector residual, charging;
    for (std::size_t j = 0; j < stages; ++j) {
      residual[j] = per_L * integral(j, voltage_left) + (start[2] - current_[base + j]);
      charging[j] = per_L * integral(j, voltage_by_phase);
    }
    for (std::size_t j = 0; j < stages; ++j) {
      L by_residual(0.0), by_phase(0.0);
      for (std::size_t l = 0; l < stages; ++l) {
        by_residual = by_residual + current_by_residual_[j][l] * residual[l];
        by_phase = by_phase + current_by_residual_[j][l] * charging[l];
      }
      to.current[j] = by_residual;
      to.current_by_phase[j] = by_phase;
      torque_by_residual[j] = torque_by_residual[j] + K * by_residual;
      torque_by_phase[j] = K * by_phase;
    }
  }
  // (1 - T A D) omega = right-hand sides, D being the acceleration's derivative by the velocities at the stages.
  Square matrix, D;
  for (std::size_t l = 0; l < stages; ++l) {
    for (std::size_t m = 0; m < stages; ++m) D[l][m] = per_inertia[l] * torque_by_speed_[l][m];
    D[l][l] = D[l][l] + by_speed[l];
  }
  for (std::size_t j = 0; j < stages; ++j) {
    for (std::size_t m = 0; m < stages; ++m) {
      L sum(0.0);
      for (std::size_t l = 0; l < stages; ++l) sum = sum + L(rule_.a[j][l]) * D[l][m];
      matrix[j][m] = L(j == m ? 1.0 : 0.0) - T * sum;
    }
  }
  Vector of_residual, of_phase_change, of_current;
  for (std::size_t l = 0; l < stages; ++l) {
    of_residual[l] = per_inertia[l] * torque_by_residual[l];
    of_phase_change[l] = per_inertia[l] * torque_by_phase[l];
    if constexpr (N == 3) of_current[l] = per_inertia[l] * (K * current_by_start_[l]);
  }
  for (std::size_t j = 0; j < stages; ++j) {
    q[0][j] = q[0][j] + T * integral(j, of_residual);
    q[1][j] = -(T * stiffness * integral(j, per_inertia));
    q[2][j] = L(1.0);
    if constexpr (N == 3) q[3][j] = T * integral(j, of_current);
    q[of_phase][j] = T * integral(j, of_phase_change);
  }
  for (std::size_t k = 0; k < stages; ++k) {
    const L per_pivot = inverse_of(matrix[k][k]);
    for (std::size_t m = k + 1; m < stages; ++m) matrix[k][m] = matrix[k][m] * per_pivot;
    for (Vector& column : q) column[k] = column[k] * per_pivot;
    for (std::size_t j = k + 1; j < stages; ++j) {
      const L factor = matrix[j][k];
      for (std::size_t m = k + 1; m < stages; ++m) matrix[j][m] = matrix[j][m] - factor * matrix[k][m];
      for (Vector& column : q) column[j] = column[j] - factor * column[k];
    }
  }
  for (std::size_t k = stages; k-- > 0;) {
    for (std::size_t m = k + 1; m < stages; ++m) {
      for (Vector& column : q) column[k] = column[k] - matrix[k][m] * column[m];
    }
  }
  // The map from start to end, after what leads to the start.
  constexpr std::size_t last = stages - 1;
  std::array<Row, std::size_t(N)> segment_map;
  for (std::size_t c = 0; c < columns; ++c) {
    segment_map[0][c] = T * integral(last, q[c]);
    segment_map[1][c] = q[c][last];
    if constexpr (N == 3) {
      L sum(0.0);
      for (std::size_t m = 0; m < stages; ++m) sum = sum + current_by_speed_[last][m] * q[c][m];
      segment_map[2][c] = sum;
    }
  }
  segment_map[0][0] = segment_map[0][0] + to.beta[last];
  segment_map[0][1] = segment_map[0][1] + L(1.0);
  if constexpr (N == 3) {
    segment_map[2][0] = segment_map[2][0] + to.current[last];
    segment_map[2][3] = segment_map[2][3] + current_by_start_[last];
    segment_map[2][of_phase] = segment_map[2][of_phase] + to.current_by_phase[last];
  }
  const std::array<Row, std::size_t(N)> before = end;
  for (std::size_t row = 0; row < std::size_t(N); ++row) {
    for (std::size_t c = 0; c < columns; ++c) {
      L sum = c == 0 || c == of_phase ? segment_map[row][c] : L(0.0);
      for (std::size_t n = 0; n < std::size_t(N); ++n) sum = sum + segment_map[row][n + 1] * before[n][c];
      end[row][c] = sum;
    }
  }
}

/// What start and phase move by for half a period to end at the negative of its start, the velocity staying zero there:
/// a column each, the first 1 for the residuals.
template <class L, int N>
void DirectPackOrbit<L, N>::close(const std::array<Row, std::size_t(N)>& end, std::array<L, columns>& move) const {
  constexpr std::size_t unknowns = N;
  const std::size_t last = nodes() - 1;
  // Unknowns: angle, current, phase; equations: of angle, current, velocity.
  std::array<std::array<L, unknowns + 1>, unknowns> m;
  const auto fill = [&](std::size_t row, const Row& coefficients, const L& off) {
    m[row][0] = coefficients[1];
    if constexpr (N == 3) m[row][1] = coefficients[3];
    m[row][unknowns - 1] = coefficients[of_phase];
    m[row][unknowns] = -(coefficients[0] + off);
  };
  fill(0, end[0], L(beta_[last] + start_[0]));
  m[0][0] = m[0][0] + L(1.0);
  fill(unknowns - 1, end[1], omega_[last]);
  if constexpr (N == 3) {
    fill(1, end[2], L(current_[last] + start_[2]));
    m[1][1] = m[1][1] + L(1.0);
  }
  for (std::size_t k = 0; k < unknowns; ++k) {
    const L per_pivot = inverse_of(m[k][k]);
    for (std::size_t c = k + 1; c <= unknowns; ++c) m[k][c] = m[k][c] * per_pivot;
    for (std::size_t j = 0; j < unknowns; ++j) {
      if (j == k) continue;
      const L factor = m[j][k];
      for (std::size_t c = k + 1; c <= unknowns; ++c) m[j][c] = m[j][c] - factor * m[k][c];
    }
  }
  move[0] = L(1.0);
  move[1] = m[0][unknowns];
  move[2] = L(0.0);
  if constexpr (N == 3) move[3] = m[1][unknowns];
  move[of_phase] = m[unknowns - 1][unknowns];
}

/// Moves the trajectory; returns by how much, relative to the harmonic response. Long moves are shortened: where drag
/// falls with speed the response lies far from the harmonic one, and whole moves would miss it.
template <class L, int N>
L DirectPackOrbit<L, N>::correct(const std::array<L, columns>& move, const Mask& where) {
  const L per_angle = omega_drive_ * per_speed_;
  L largest = max(abs(move[of_phase]), abs(move[1]) * per_angle);
  // The changes, first: how large they are decides how far to go.
  std::array<L, std::size_t(N)> by;
  by[0] = move[1];
  by[1] = L(0.0);
  if constexpr (N == 3) by[2] = move[3];
  for (std::size_t s = 0; s < segments_; ++s) {
    Linearised& linearised = linearised_[s];
    Vector omega;
    for (std::size_t j = 0; j < stages; ++j) {
      L sum = linearised.omega[0][j];
      for (std::size_t n = 0; n < std::size_t(N); ++n) sum = sum + linearised.omega[n + 1][j] * by[n];
      omega[j] = sum + linearised.omega[of_phase][j] * move[of_phase];
      largest = max(largest, abs(omega[j]) * per_speed_);
    }
    for (std::size_t j = 0; j < stages; ++j) {
      L angle(0.0);
      for (std::size_t l = 0; l < stages; ++l) angle = angle + L(rule_.a[j][l]) * omega[l];
      linearised.beta[j] = linearised.beta[j] + by[0] + length_in_time_ * angle;
      if constexpr (N == 3) {
        L i = linearised.current[j] + current_by_start_[j] * by[2];
        i = i + linearised.current_by_phase[j] * move[of_phase];
        for (std::size_t m = 0; m < stages; ++m) i = i + current_by_speed_[j][m] * omega[m];
        linearised.current[j] = i;
        largest = max(largest, abs(i) * per_current_);
      }
    }
    linearised.omega[0] = omega;
    by[0] = linearised.beta[stages - 1];
    by[1] = omega[stages - 1];
    if constexpr (N == 3) by[2] = linearised.current[stages - 1];
  }
  const L part = select<L>(where, min(L(1.0), L(longest_move) * inverse_of(max(largest, L(1e-9)))), L(0.0));
  phase_ = phase_ + part * move[of_phase];
  start_[0] = start_[0] + part * move[1];
  if constexpr (N == 3) start_[2] = start_[2] + part * move[3];
  for (std::size_t s = 0; s < segments_; ++s) {
    for (std::size_t j = 0; j < stages; ++j) {
      const std::size_t node = s * stages + j;
      beta_[node] = beta_[node] + part * linearised_[s].beta[j];
      omega_[node] = omega_[node] + part * linearised_[s].omega[0][j];
      if constexpr (N == 3) current_[node] = current_[node] + part * linearised_[s].current[j];
    }
  }
  return largest;
}

/// Newton's method until every lane's own last correction is small enough; a lane that is there moves no more.
template <class L, int N>
void DirectPackOrbit<L, N>::newton() {
  prepare_segments();
  Mask open = decided_;
  newton_change_ = L(std::numeric_limits<double>::infinity());
  const auto set_phase = [&] {
    sine_ = vehicle_.voltage * sin(phase_);
    cosine_ = vehicle_.voltage * cos(phase_);
  };
  set_phase();
  for (int n = 0; n < settings_.newton_iterations && any<L>(open); ++n) {
    std::array<Row, std::size_t(N)> end;
    for (std::size_t row = 0; row < std::size_t(N); ++row) {
      for (std::size_t c = 0; c < columns; ++c) end[row][c] = L(c == row + 1 ? 1.0 : 0.0);
    }
    std::array<L, std::size_t(N)> start = start_;
    for (std::size_t s = 0; s < segments_; ++s) {
      linearise(s, start, end);
      const std::size_t last = (s + 1) * stages - 1;
      start[0] = beta_[last];
      start[1] = omega_[last];
      if constexpr (N == 3) start[2] = current_[last];
    }
    for (std::size_t row = 0; row < std::size_t(N); ++row) {
      for (std::size_t c = 0; c < columns; ++c) half_map_[row][c] = select<L>(open, end[row][c], half_map_[row][c]);
    }
    std::array<L, columns> move;
    close(end, move);
    const L change = correct(move, open);
    newton_change_ = select<L>(open, change, newton_change_);
    // Written so that what is no number stays open.
    open = open && !(change <= L(settings_.closed));
    set_phase();
  }
}

}  // namespace wingbeat
