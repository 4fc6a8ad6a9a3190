// The sets of force coefficients that vehicle files name, with where they come from and for what they hold; model.md
// sections 3, 12 and 17.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "wingbeat/parts/blade_element.hpp"

namespace wingbeat {

/// C_rd of rotational damping [1] (Whitney and Wood, J. Fluid Mech. 660, 2010).
inline constexpr double rotational_damping_coefficient = 5.0;

/// From where to where coefficients hold [1].
struct ReynoldsRange {
  double lowest = 0.0, highest = std::numeric_limits<double>::infinity();
};

/// What a set of coefficients goes with where wings pitch. Both terms oppose rotation: together they may count its
/// damping twice.
struct RotationTerms {
  bool lift;       ///< F_rot of the circulation
  double damping;  ///< C_rd [1]
};

/// A named set.
struct CoefficientSet {
  const char* name;
  const char* formula;
  const char* source;      ///< of the coefficients, and of the wing that they were measured on
  ReynoldsRange reynolds;  ///< [1]
  double aspect_ratio;     ///< of the wing that they were measured on, R over the mean chord; not a number: not known
  RotationTerms rotation;
  bool hinged_alone;  ///< not under the pitch law
};

/// How vehicle files name the sets.
inline constexpr const char* translational_set = "translational-2022";
inline constexpr const char* normal_force_set = "normal-force-robofly";
inline constexpr const char* robobee_set = "robobee";
inline constexpr const char* normal_tangential_set = "normal-tangential";

/// All of the sets whose coefficients are those of the wing of Dickinson, Lehmann and Sane (Science 284, 1999), at
/// Re = 136. Below about 100 lift falls and drag grows (Wu and Sun, J. Exp. Biol. 207, 2004); from 1100 to 26000,
/// mayfly to quail, the coefficients of revolving wings hardly change (Usherwood and Ellington, J. Exp. Biol. 205,
/// 2002).
inline constexpr ReynoldsRange robofly_reynolds_range{100.0, 26000.0};

/// R over the mean chord of that wing: a length of 0.25 m and an area of 0.0167 m2 (Sane and Dickinson, J. Exp. Biol.
/// 204, 2001).
inline constexpr double robofly_aspect_ratio = 0.25 * 0.25 / 0.0167;

/// normal-force-robofly was used for wings on hinges with C_rd = 5 and no F_rot (Whitney and Wood 2010), and so was the
/// set of the RoboBee; the others, of the same wing, with F_rot alone (Sane and Dickinson 2002).
inline constexpr CoefficientSet coefficient_sets[] = {
    {translational_set,
     "C_L = 0.225 + 1.58 sin(2.13 alpha - 7.2 deg), C_D = 1.92 - 1.55 cos(2.04 alpha - 9.82 deg)",
     "eqs (12, 13); Dickinson, Lehmann and Sane 1999",
     robofly_reynolds_range,
     robofly_aspect_ratio,
     {true, 0.0},
     false},
    {normal_force_set,
     "C_L = 1.8 sin(2 alpha), C_D = 1.95 - 1.5 cos(2 alpha), of both the component normal to the chord",
     "Whitney and Wood 2010, after Dickinson, Lehmann and Sane 1999",
     robofly_reynolds_range,
     robofly_aspect_ratio,
     {false, rotational_damping_coefficient},
     true},
    {robobee_set,
     "C_L = 1.8 sin(2 alpha), C_D = 1.9 - 1.5 cos(2 alpha)",
     "models of the RoboBee, after Dickinson, Lehmann and Sane 1999",
     robofly_reynolds_range,
     robofly_aspect_ratio,
     {false, rotational_damping_coefficient},
     false},
    {normal_tangential_set,
     "C_N = 3.4 sin(alpha), C_T = 0.4 cos(2 alpha)^2 below 45 deg, else 0",
     "Dickinson, Lehmann and Sane 1999",
     robofly_reynolds_range,
     robofly_aspect_ratio,
     {true, 0.0},
     false}};

inline const CoefficientSet* coefficient_set(std::string_view name) {
  for (const CoefficientSet& set : coefficient_sets) {
    if (name == set.name) return &set;
  }
  return nullptr;
}

/// The force coefficients of that name; none for any other. Of normal-force-robofly C_L and C_D along the normal, of
/// which every coefficient is a number of its own; of normal-tangential C_N = C_L cos(alpha) + C_D sin(alpha) with
/// \f$C_\mathrm{L} = 1.7 \sin 2\alpha\f$ and \f$C_\mathrm{D} = 1.7 - 1.7 \cos 2\alpha\f$.
inline std::optional<ForceCoefficients<double>> named_coefficients(std::string_view name) {
  if (name == translational_set) return translational_2022();
  if (name == normal_force_set) return ForceCoefficients<double>{{0.0, 1.8, 2.0, 0.0}, {1.95, -1.5, 2.0, 0.0}, {}};
  if (name == robobee_set) return ForceCoefficients<double>{{0.0, 1.8, 2.0, 0.0}, {1.9, -1.5, 2.0, 0.0}, {}};
  if (name == normal_tangential_set) {
    return ForceCoefficients<double>{{0.0, 1.7, 2.0, 0.0}, {1.7, -1.7, 2.0, 0.0}, {}, 0.4};
  }
  return std::nullopt;
}

/// Of a vehicle's own coefficients those of translational-2022.
inline RotationTerms rotation_with(std::string_view coefficients) {
  const CoefficientSet* set = coefficient_set(coefficients);
  return set ? set->rotation : RotationTerms{true, 0.0};
}

/// A vehicle's own coefficients are not limited.
inline ReynoldsRange reynolds_range_of(std::string_view coefficients) {
  const CoefficientSet* set = coefficient_set(coefficients);
  return set ? set->reynolds : ReynoldsRange{};
}

/// The names, for messages: "a, b or c".
inline std::string coefficient_set_names() {
  std::string names;
  for (const CoefficientSet& set : coefficient_sets) names += std::string(names.empty() ? "" : ", ") + set.name;
  return names;
}

}  // namespace wingbeat
