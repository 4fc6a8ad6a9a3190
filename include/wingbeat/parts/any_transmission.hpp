// The transmissions that a vehicle can have, one at a time: the rows of transmission_type.hpp, whose headers are
// included here.
#pragma once

#include <string_view>

#include "wingbeat/core/members.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/direct_drive.hpp"
#include "wingbeat/parts/four_bar.hpp"
#include "wingbeat/parts/slider_crank.hpp"
#include "wingbeat/parts/stroke_table.hpp"
#include "wingbeat/parts/transmission.hpp"
#include "wingbeat/parts/transmission_type.hpp"

namespace wingbeat {

/// One of the transmissions, by its type; the members of the others are unused.
template <Scalar S>
struct AnyTransmission {
  TransmissionType type = TransmissionType::slider_crank;
#define WINGBEAT_MEMBER(type, name, Part) Part<S> type = {};
  WINGBEAT_TRANSMISSIONS(WINGBEAT_MEMBER)
#undef WINGBEAT_MEMBER

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
#define WINGBEAT_LISTED(type, name, Part) , self.type
    return use(self.type WINGBEAT_TRANSMISSIONS(WINGBEAT_LISTED));
#undef WINGBEAT_LISTED
  }
};

/// Calls use(transmission) with the one that it is; a direct drive, which turns no crank, with a slider-crank.
template <Scalar S, class Use>
constexpr auto visit(const AnyTransmission<S>& t, const Use& use) {
#define WINGBEAT_CASE(enumerator, name, Part)                                                  \
  case TransmissionType::enumerator:                                                           \
    if constexpr (Transmission<Part<S>, S>) return use(t.enumerator); /* NOLINT(bugprone-*) */ \
    break;
  switch (t.type) { WINGBEAT_TRANSMISSIONS(WINGBEAT_CASE) }
#undef WINGBEAT_CASE
  return use(t.slider_crank);
}

/// The transmission that a design describes in `design`, a TransmissionDesign.
template <Scalar S, class Design>
AnyTransmission<S> transmission_from(const Design& design) {
  AnyTransmission<S> transmission{};
  transmission.type = design.type;
#define WINGBEAT_CASE(enumerator, name, Part) \
  case TransmissionType::enumerator: transmission.enumerator = Part<S>::from(design); break; /* NOLINT(bugprone-*) */
  switch (design.type) { WINGBEAT_TRANSMISSIONS(WINGBEAT_CASE) }
#undef WINGBEAT_CASE
  return transmission;
}

/// Whether [transmission] takes that key for a transmission of that type.
constexpr bool takes_key(TransmissionType type, std::string_view key) {
  const auto listed = [&](const auto& keys) {
    for (const std::string_view each : keys) {
      if (each == key) return true;
    }
    return false;
  };
#define WINGBEAT_CASE(enumerator, name, Part) \
  case TransmissionType::enumerator: return listed(Part<double>::keys); /* NOLINT(bugprone-*) */
  switch (type) { WINGBEAT_TRANSMISSIONS(WINGBEAT_CASE) }
#undef WINGBEAT_CASE
  return false;
}

namespace detail {

template <Scalar S>
[[gnu::noinline]] CrankKinematics<S> kinematics_by_type(const AnyTransmission<S>& t, const S& sin_theta,
                                                        const S& cos_theta) {
  return visit(t, [&](const auto& of_type) { return crank_kinematics(of_type, sin_theta, cos_theta); });
}

}  // namespace detail

// The slider-crank is inlined into the equations of motion, all others share one call: code grows by the sum of
// transmissions and scalars.
template <Scalar S>
[[gnu::always_inline]] inline CrankKinematics<S> crank_kinematics(const AnyTransmission<S>& t, const S& sin_theta,
                                                                  const S& cos_theta) {
  if (t.type == TransmissionType::slider_crank) [[likely]]
    return crank_kinematics(t.slider_crank, sin_theta, cos_theta);
  return detail::kinematics_by_type(t, sin_theta, cos_theta);
}

template <Scalar S>
S stroke_amplitude(const AnyTransmission<S>& t) {
  return visit(t, [](const auto& of_type) { return stroke_amplitude(of_type); });
}
template <Scalar S>
S typical_stroke_slope(const AnyTransmission<S>& t) {
  return visit(t, [](const auto& of_type) { return typical_stroke_slope(of_type); });
}
template <Scalar S>
S typical_lever(const AnyTransmission<S>& t) {
  return visit(t, [](const auto& of_type) { return typical_lever(of_type); });
}
template <Scalar S>
S typical_crank_lever(const AnyTransmission<S>& t) {
  return visit(t, [](const auto& of_type) { return typical_crank_lever(of_type); });
}
inline Reversals reversals(const AnyTransmission<double>& t) {
  return visit(t, [](const auto& of_type) { return reversals(of_type); });
}
inline double stroke_reach(const AnyTransmission<double>& t) {
  return visit(t, [](const auto& of_type) { return stroke_reach(of_type); });
}
inline void validate(const AnyTransmission<double>& t) {
  visit(t, [](const auto& of_type) { validate(of_type); });
}

}  // namespace wingbeat
