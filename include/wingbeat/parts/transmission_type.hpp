// Which transmission a vehicle has, as its designer names it.
#pragma once

#include <utility>

#include "wingbeat/core/names.hpp"

namespace wingbeat {

/// A row for each transmission: its enumerator, its name in vehicle files, the type of its part. A further one is a
/// header that satisfies the concept of transmission.hpp, a row here, and its #include in any_transmission.hpp. Direct:
/// the motor shaft is the wing hinge, its angle is the stroke angle.
#define WINGBEAT_TRANSMISSIONS(ROW)              \
  ROW(slider_crank, "slider-crank", SliderCrank) \
  ROW(four_bar, "four-bar", FourBar)             \
  ROW(tabulated, "tabulated", StrokeTable)       \
  ROW(direct, "direct", DirectDrive)

#define WINGBEAT_ENUMERATOR(type, name, Part) type,
enum class TransmissionType { WINGBEAT_TRANSMISSIONS(WINGBEAT_ENUMERATOR) };
#undef WINGBEAT_ENUMERATOR

#define WINGBEAT_NAME(type, name, Part) {name, TransmissionType::type},
template <>
inline constexpr std::pair<const char*, TransmissionType> names_of<TransmissionType>[] = {
    WINGBEAT_TRANSMISSIONS(WINGBEAT_NAME)};
#undef WINGBEAT_NAME

/// How the rod force turns the wings (model.md section 2).
enum class Formulation {
  /// The paper's eq (1) as printed: \f$g = H (\sin\gamma \tan\beta + \cos\gamma)\f$; does not conserve power.
  rod_force,
  /// Straight frictionless guide: \f$g = H \cos\gamma / \cos^2\beta\f$; \f$F h \omega = F g \dot\beta\f$ identically.
  virtual_work
};
template <>
inline constexpr std::pair<const char*, Formulation> names_of<Formulation>[] = {
    {"rod-force", Formulation::rod_force}, {"virtual-work", Formulation::virtual_work}};

}  // namespace wingbeat
