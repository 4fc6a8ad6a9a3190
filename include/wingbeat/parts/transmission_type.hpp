// Which transmission a vehicle has, as its designer names it.
#pragma once

#include <utility>

#include "wingbeat/core/names.hpp"

namespace wingbeat {

enum class TransmissionType {
  slider_crank,
  four_bar,
  tabulated,
  direct  ///< the motor shaft is the wing hinge: its angle is the stroke angle
};
template <>
inline constexpr std::pair<const char*, TransmissionType> names_of<TransmissionType>[] = {
    {"slider-crank", TransmissionType::slider_crank},
    {"four-bar", TransmissionType::four_bar},
    {"tabulated", TransmissionType::tabulated},
    {"direct", TransmissionType::direct}};

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
