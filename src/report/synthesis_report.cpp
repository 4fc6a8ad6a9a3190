#include "wingbeat/report/synthesis_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "report/described.hpp"
#include "report/result_schemas.hpp"
#include "wingbeat/core/math.hpp"

namespace wingbeat {
namespace {

double degrees(double angle) { return degrees_per_radian * angle; }

struct Synthesis {
  const SynthesisedMechanism& mechanism;
  const std::optional<ClearanceCost>& clearance;
};

/// Keys of the lengths, without their section.
std::vector<std::pair<const char*, double>> links_of(const TransmissionDesign<double>& t) {
  if (t.type == TransmissionType::four_bar) {
    return {{"crank_radius", t.crank_radius},
            {"coupler_length", t.coupler_length},
            {"rocker_length", t.rocker_length},
            {"ground_length", t.ground_length}};
  }
  return {{"crank_radius", t.crank_radius}, {"rod_length", t.rod_length}, {"hinge_offset", *t.hinge_offset}};
}

std::string row(const char* name, double value, const char* unit, const std::string& remark = {}) {
  const std::string line = fmt::format("{:<34}{:>10.4g}  {:<5}{}", name, value, unit, remark);
  return line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
}

}  // namespace

std::string transmission_section(const TransmissionDesign<double>& t) {
  std::string text = fmt::format("[transmission]\ntype = \"{}\"\n", name_of(t.type));
  for (const auto& [key, length] : links_of(t)) text += fmt::format("{} = \"{:.9g} mm\"\n", key, 1e3 * length);
  if (t.type == TransmissionType::four_bar) {
    if (t.stroke_ratio != 1.0) text += fmt::format("stroke_ratio = {:.9g}\n", t.stroke_ratio);
  } else {
    text += fmt::format("formulation = \"{}\"\n", name_of(t.formulation));
  }
  return text;
}

std::string text_synthesis(const SynthesisedMechanism& m, const std::optional<ClearanceCost>& clearance) {
  const MechanismQuality& q = m.quality;
  std::string text = fmt::format("{}\n\nKinematics\n", name_of(m.transmission.type));
  text += row("stroke, peak to peak", degrees(q.stroke), "deg");
  text += row("transmission angle, least", degrees(q.transmission_angle), "deg",
              fmt::format("{} carries {:.3g} times its force at 90 deg",
                          m.transmission.type == TransmissionType::four_bar ? "coupler" : "rod",
                          1.0 / std::sin(q.transmission_angle)));
  text += row("time ratio of the half-strokes", q.time_ratio, "", "at constant crank speed");
  text += row("flapping over crank speed, up", q.slope_up, "", "largest");
  text += row("flapping over crank speed, down", q.slope_down, "", "largest");
  text += row("envelope", 1e3 * q.envelope, "mm", "longest distance between points of its links");
  if (clearance) {
    const ClearanceCost& c = *clearance;
    text += fmt::format("\nPlay of {:.4g} mm in every joint (radial)\n", 1e3 * c.clearance);
    text += row("stroke, at least", degrees(c.stroke_lowest), "deg", "where springs or gusts push inwards at the ends");
    text += row("stroke, at most", degrees(c.stroke_highest), "deg", "where the wings' inertia pulls outwards");
    text += row("free angle of the wings", degrees(c.play), "deg",
                fmt::format("at mid-stroke; at most {:.3g} deg", degrees(c.play_highest)));
    text += row("phase", degrees(c.phase), "deg", "of the crank, before the wings follow a changed force");
  }
  if (!m.ratios.empty()) {
    text += "\nA gear pair or string between rocker and wings\n    stroke_ratio   least transmission angle (deg)\n";
    for (const StrokeRatioChoice& r : m.ratios) {
      text += fmt::format(
          "{:>16.3g}{:>33}\n", r.stroke_ratio,
          std::isnan(r.transmission_angle) ? "none turns" : fmt::format("{:.1f}", degrees(r.transmission_angle)));
    }
  }
  return text + "\n" + transmission_section(m.transmission);
}

std::string why_not_found(const SynthesisedMechanism& m, TransmissionType type) {
  const StrokeTarget& t = m.target;
  std::string text = fmt::format("no {} has a stroke of {:.6g} deg", name_of(type), degrees(t.stroke));
  if (t.stroke_ratio != 1.0) text += fmt::format(" at a stroke ratio of {:.4g}", t.stroke_ratio);
  text += fmt::format(" within {:.4g} mm and links of at least {:.4g} mm", 1e3 * t.envelope, 1e3 * t.shortest);
  if (t.transmission_angle > 0.0) {
    text += fmt::format(" and a transmission angle of at least {:.4g} deg", degrees(t.transmission_angle));
  }
  const double best = m.quality.transmission_angle;
  if (!std::isnan(best)) text += fmt::format("; the best one keeps {:.3g} deg", degrees(best));
  if (type == TransmissionType::slider_crank) return text + "; allow more space or shorter links";
  return text + (std::isnan(m.ratio_needed)
                     ? "; nor has one of any larger stroke ratio"
                     : fmt::format("; a stroke ratio of {:.4g} is enough, with a gear pair or string", m.ratio_needed));
}

namespace described {
namespace {

const Description<ClearanceCost>& clearance_description() {
  using R = ClearanceCost;
  static const Description<R> description =
      Description<R>()
          .always("clearance_m", "m", "radial, of every joint", &R::clearance)
          .always("stroke_min_rad", "rad", "stroke with all play taken up inwards at both ends", &R::stroke_lowest)
          .always("stroke_max_rad", "rad", "stroke with all play taken up outwards at both ends", &R::stroke_highest)
          .always("play_rad", "rad", "free angle of the wings at a held crank, at mid-stroke", &R::play)
          .always("play_max_rad", "rad", "largest free angle of any crank angle", &R::play_highest)
          .always("phase_rad", "rad", "turn of the crank before the wings follow a force that has changed its sign",
                  &R::phase);
  return description;
}

const Description<StrokeRatioChoice>& ratio_description() {
  using R = StrokeRatioChoice;
  static const Description<R> description =
      Description<R>()
          .always("stroke_ratio", "1", "", &R::stroke_ratio)
          .always("transmission_angle_min_rad", "rad", "best least transmission angle; null where no four-bar turns",
                  &R::transmission_angle);
  return description;
}

const Description<Synthesis>& synthesis_description() {
  const auto length = [](double TransmissionDesign<double>::* member) {
    return [member](const Synthesis& s) {
      const double x = s.mechanism.transmission.*member;
      return x > 0.0 ? std::optional(x) : std::nullopt;
    };
  };
  const auto quality = [](double MechanismQuality::* member) {
    return [member](const Synthesis& s) { return s.mechanism.quality.*member; };
  };
  using T = TransmissionDesign<double>;
  using Q = MechanismQuality;
  static const Description<Synthesis> description =
      Description<Synthesis>()
          .always("type", "", "transmission.type", [](const Synthesis& s) { return s.mechanism.transmission.type; })
          .always("crank_radius_m", "m", "", length(&T::crank_radius))
          .sometimes("rod_length_m", "m", "", length(&T::rod_length))
          .sometimes("hinge_offset_m", "m", "",
                     [](const Synthesis& s) { return s.mechanism.transmission.hinge_offset; })
          .sometimes("coupler_length_m", "m", "", length(&T::coupler_length))
          .sometimes("rocker_length_m", "m", "", length(&T::rocker_length))
          .sometimes("ground_length_m", "m", "", length(&T::ground_length))
          .always("stroke_ratio", "1", "turning angle of the wings over that of the rocker",
                  [](const Synthesis& s) { return s.mechanism.transmission.stroke_ratio; })
          .always("stroke_rad", "rad", "peak to peak", quality(&Q::stroke))
          .always("transmission_angle_min_rad", "rad",
                  "least angle between coupler and rocker, or of that and 180 deg; of a slider-crank between the rod "
                  "and the normal of its guide",
                  quality(&Q::transmission_angle))
          .always("time_ratio", "1", "longer half-stroke over the shorter at constant crank speed",
                  quality(&Q::time_ratio))
          .always("stroke_slope_up_max", "1", "largest flapping velocity over crank speed, stroke angle growing",
                  quality(&Q::slope_up))
          .always("stroke_slope_down_max", "1", "largest flapping velocity over crank speed, stroke angle falling",
                  quality(&Q::slope_down))
          .always("envelope_m", "m", "longest distance between two points that pins and axes reach",
                  quality(&Q::envelope))
          .part("clearance", "what play in the joints does; null unless asked for", clearance_description(),
                [](const Synthesis& s) { return s.clearance; })
          .parts("stroke_ratios", "what other stroke ratios of a four-bar allow", ratio_description(),
                 [](const Synthesis& s) { return s.mechanism.ratios; });
  return description;
}

}  // namespace

Json synthesis_schema() { return synthesis_description().schema(); }

}  // namespace described

std::string json_synthesis(const SynthesisedMechanism& mechanism, const std::optional<ClearanceCost>& clearance) {
  return detail::dumped(described::synthesis_description().json({mechanism, clearance}));
}

}  // namespace wingbeat
