// A synthesised mechanism, for people and for programs.
#pragma once

#include <optional>
#include <string>

#include "wingbeat/study/synthesis.hpp"

namespace wingbeat {

/// Links, kinematics, play, what stroke ratios allow, and the section of a vehicle file; at most 90 columns.
std::string text_synthesis(const SynthesisedMechanism& mechanism, const std::optional<ClearanceCost>& clearance);

/// One JSON object, SI.
std::string json_synthesis(const SynthesisedMechanism& mechanism, const std::optional<ClearanceCost>& clearance);

/// [transmission] of a vehicle file, lengths in mm to nine digits.
std::string transmission_section(const TransmissionDesign<double>& transmission);

/// Why no mechanism of that type was found, and what would do, in a sentence.
std::string why_not_found(const SynthesisedMechanism& mechanism, TransmissionType type);

}  // namespace wingbeat
