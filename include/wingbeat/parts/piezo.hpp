// Piezo bimorph that swings the wings through a flexure transmission; model.md section 15.
#pragma once

#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {

/// A bimorph under the voltage V with the tip displacement x, through a transmission of the stroke angle
/// \f$\beta = T(x)\f$, which takes the force \f$F_\mathrm{t}\f$ from the tip:
/// \f[
/// m_\mathrm{a} \ddot x + c_\mathrm{a} \dot x + k_\mathrm{a} x = \kappa (1 + \kappa_1 |V|) V - F_\mathrm{t}, \qquad
/// i = C \dot V + \kappa (1 + \kappa_1 |V|)\, \dot x, \qquad T(x) = T_1 x + T_3 x^3
/// \f]
/// With a series stiffness the transmission is at \f$x_\mathrm{t}\f$, \f$\beta = T(x_\mathrm{t})\f$, and
/// \f$F_\mathrm{t} = k_\mathrm{s} (x - x_\mathrm{t})\f$; without one \f$x = x_\mathrm{t}\f$.
template <Scalar S>
struct Piezo {
  static constexpr bool off_lanes = true;
  S force_per_volt = S(0);      ///< kappa [N/V], > 0; 0: no piezo moves the wings
  S voltage_factor = S(0);      ///< kappa_1 [1/V], >= 0
  S stiffness = S(0);           ///< k_a [N/m], > 0
  S damping = S(0);             ///< c_a [N s/m], >= 0
  S mass = S(0);                ///< m_a, moving with the tip [kg], > 0
  S capacitance = S(0);         ///< C [F], >= 0
  S loss_tangent = S(0);        ///< tan d [1], >= 0
  S recovered_share = S(1);     ///< of the energy that the capacitance gives back [1], 0 to 1
  S transmission_ratio = S(1);  ///< T_1 [rad/m], > 0
  S transmission_cubic = S(0);  ///< T_3 [rad/m3], >= 0
  S series_stiffness = S(0);    ///< k_s [N/m], >= 0; 0: a rigid transmission

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.force_per_volt, self.voltage_factor, self.stiffness, self.damping, self.mass, self.capacitance,
               self.loss_tangent, self.recovered_share, self.transmission_ratio, self.transmission_cubic,
               self.series_stiffness);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace piezo_key {
inline constexpr ParameterKey force_per_volt{"piezo.force_per_volt", "N/V", range::positive};
inline constexpr ParameterKey voltage_factor{"piezo.voltage_factor", "1/V", range::not_negative};
inline constexpr ParameterKey stiffness{"piezo.stiffness", "N/m", range::positive};
inline constexpr ParameterKey damping{"piezo.damping", "N s/m", range::not_negative};
inline constexpr ParameterKey mass{"piezo.mass", "kg", range::positive};
inline constexpr ParameterKey capacitance{"piezo.capacitance", "F", range::not_negative};
inline constexpr ParameterKey loss_tangent{"piezo.loss_tangent", "1", range::not_negative};
inline constexpr ParameterKey recovered_share{"piezo.recovered_share", "1", range::zero_to_one};
inline constexpr ParameterKey transmission_ratio{"piezo.transmission_ratio", "rad/m", range::positive};
inline constexpr ParameterKey transmission_cubic{"piezo.transmission_cubic", "rad/m3", range::not_negative};
inline constexpr ParameterKey series_stiffness{"piezo.series_stiffness", "N/m", range::positive};
}  // namespace piezo_key

/// Throws ParameterError unless every constant lies in its physical range.
void validate(const Piezo<double>& piezo);

template <Scalar S>
bool is_given(const Piezo<S>& p) {
  return value_of(p.force_per_volt) > 0.0;
}
template <Scalar S>
bool is_compliant(const Piezo<S>& p) {
  return value_of(p.series_stiffness) > 0.0;
}

/// The bimorph that acts as `count` equal ones do on the same voltage, in phase.
template <Scalar S>
Piezo<S> side_by_side(Piezo<S> p, const S& count) {
  for (S* each : {&p.force_per_volt, &p.stiffness, &p.damping, &p.mass, &p.capacitance, &p.series_stiffness}) {
    *each = *each * count;
  }
  return p;
}

/// What the transmission is at a stroke angle.
template <Scalar S>
struct FlexurePlace {
  S tip;     ///< x with T(x) = beta [m]
  S slope;   ///< T'(x) [rad/m]
  S second;  ///< T''(x) [rad/m2]
};

/// The transmission at the stroke angle beta [rad], of which x is the one root:
/// \f[
/// x = 2 a \sinh\left( \tfrac13 \operatorname{arsinh} \frac{3 \beta}{2 a T_1} \right), \qquad
/// a = \sqrt{\frac{T_1}{3 T_3}}
/// \f]
template <Scalar S>
FlexurePlace<S> flexure_at(const Piezo<S>& p, const S& beta) {
  const double T_1 = value_of(p.transmission_ratio), T_3 = value_of(p.transmission_cubic);
  double root = value_of(beta) / T_1;
  if (T_3 > 0.0) {
    const double a = std::sqrt(T_1 / (3.0 * T_3));
    root = 2.0 * a * std::sinh(std::asinh(1.5 * value_of(beta) / (a * T_1)) / 3.0);
  }
  // A step of Newton's method from the root on plain numbers has its derivatives.
  const auto slope = [&](const S& x) { return S(p.transmission_ratio + S(3.0) * p.transmission_cubic * square(x)); };
  const S x_0(root);
  const S off = (p.transmission_ratio + p.transmission_cubic * square(x_0)) * x_0 - beta;
  const S x = x_0 - off / slope(x_0);
  return {x, slope(x), S(6.0) * p.transmission_cubic * x};
}

/// Force per volt at a voltage [N/V].
template <Scalar S>
S force_per_volt_at(const Piezo<S>& p, const S& voltage) {
  using std::abs;
  return p.force_per_volt * (S(1.0) + p.voltage_factor * abs(voltage));
}

/// What the electronics and the dielectric lose [W] under \f$V_0 + V_\mathrm{a} \sin 2 \pi f t\f$: of the energy
/// \f$E_C\f$ that the capacitance gives back in a cycle all but the share recovered.
/// \f[
/// P = \pi f \tan\delta\, C V_\mathrm{a}^2 + (1 - r) f E_C, \qquad
/// E_C = \begin{cases} 2 C |V_0| V_\mathrm{a} & |V_0| \ge V_\mathrm{a} \\ C (V_0^2 + V_\mathrm{a}^2) & |V_0| <
/// V_\mathrm{a} \end{cases}
/// \f]
template <Scalar S>
S electronics_loss(const Piezo<S>& p, const S& offset, const S& amplitude, const S& frequency) {
  using std::abs;
  const S constant = abs(offset);
  const S energy = value_of(constant) >= value_of(amplitude) ? S(S(2.0) * p.capacitance * constant * amplitude)
                                                             : S(p.capacitance * (square(offset) + square(amplitude)));
  return frequency *
         (S(pi) * p.loss_tangent * p.capacitance * square(amplitude) + (S(1.0) - p.recovered_share) * energy);
}

}  // namespace wingbeat
