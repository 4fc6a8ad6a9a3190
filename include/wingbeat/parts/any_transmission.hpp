// The transmissions that a vehicle can have, one at a time. A further one is a part that satisfies the concept of
// transmission.hpp, a name, a member and a case here.
#pragma once

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
  SliderCrank<S> slider_crank = {};
  FourBar<S> four_bar = {};
  StrokeTable<S> tabulated = {};
  DirectDrive<S> direct = {};

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.type, self.slider_crank, self.four_bar, self.tabulated, self.direct);
  }
};

/// Calls use(transmission) with the one that it is.
template <Scalar S, class Use>
constexpr auto visit(const AnyTransmission<S>& t, const Use& use) {
  switch (t.type) {
    case TransmissionType::four_bar: return use(t.four_bar);
    case TransmissionType::tabulated: return use(t.tabulated);
    case TransmissionType::slider_crank:
    case TransmissionType::direct: break;
  }
  return use(t.slider_crank);
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
