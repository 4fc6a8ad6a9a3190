#include "wingbeat/parts/four_bar.hpp"

#include <algorithm>
#include <array>

#include "wingbeat/core/status.hpp"
#include "wingbeat/parts/transmission_angle.hpp"

namespace wingbeat {

void validate(const FourBar<double>& f) {
  const double r_c = f.crank_radius, l = f.coupler_length, p = f.rocker_length, d = f.ground_length;
  require(crank_radius_key, r_c);
  require(four_bar_key::coupler_length, l);
  require(four_bar_key::rocker_length, p);
  require(four_bar_key::ground_length, d);
  require(four_bar_key::stroke_ratio, f.stroke_ratio);
  // Grashof's condition first: without it the rocker's swing, and the middle of it, do not exist.
  std::array<double, 4> link = {r_c, l, p, d};
  std::sort(link.begin(), link.end());
  require(r_c < link[1], crank_radius_key.path, "must be the shortest link, or the crank cannot turn (Grashof)", "m",
          r_c);
  require(r_c + link[3] < link[1] + link[2], crank_radius_key.path,
          "with the longest link must be shorter than the other two links together, or the crank cannot turn (Grashof)",
          "m", r_c);
  const TransmissionCosines extremes = transmission_cosines(f);
  for (const double cosine : {extremes.least, extremes.largest}) {
    const double mu = degrees_per_radian * std::acos(std::clamp(cosine, -1.0, 1.0));
    require(mu >= transmission_angle_min_deg && mu <= 180.0 - transmission_angle_min_deg,
            four_bar_key::coupler_length.path,
            "must keep the transmission angle between coupler and rocker within 5 to 175", "deg", mu);
  }
  require(four_bar_key::ground_angle, f.ground_angle);
}

TransmissionCosines transmission_cosines(const FourBar<double>& f) {
  const double r_c = f.crank_radius, l = f.coupler_length, p = f.rocker_length, d = f.ground_length;
  const auto cosine = [&](double diagonal) { return (square(p) + square(l) - square(diagonal)) / (2.0 * p * l); };
  return {cosine(d - r_c), cosine(d + r_c)};
}

Reversals reversals(const FourBar<double>& f) {
  const RockerEnds<double> ends = rocker_ends(f);
  const auto direction_of_pin = [&](double phi) {
    return std::atan2(f.rocker_length * std::sin(phi), f.ground_length + f.rocker_length * std::cos(phi));
  };
  // Stretched out the crank points to the rocker's pin, folded over away from it; both pins have y > 0.
  Reversals r{{direction_of_pin(ends.stretched), direction_of_pin(ends.folded) + pi}, 2, 1.0};
  const double before = 0.5 * r.angle[0];
  r.first_sign = sign_of(crank_kinematics(f, std::sin(before), std::cos(before)).stroke_slope);
  return r;
}

}  // namespace wingbeat
