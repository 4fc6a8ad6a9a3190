// The wings and their motion as a Python script for PteraSoftware.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/files/kinematics_file.hpp"
#include "wingbeat/parts/planform.hpp"

namespace wingbeat {
namespace {

/// Of the outline between its rows [m], or of a shape.
double chord_at(const Planform<double>& p, double distance) {
  const double share = distance / length_of(p);
  if (p.shape == PlanformShape::semi_ellipse) return detail::root_chord_of(p) * std::sqrt(1.0 - square(share));
  if (p.shape == PlanformShape::rectangle) return detail::root_chord_of(p);
  const auto& table = p.chord_table;
  const double x = distance / p.scale;
  const auto after = std::find_if(table.begin() + 1, table.end() - 1, [&](const auto& row) { return row.first >= x; });
  const auto [x0, c0] = *(after - 1);
  const auto [x1, c1] = *after;
  return p.scale * (c0 + (c1 - c0) * std::clamp((x - x0) / (x1 - x0), 0.0, 1.0));
}

std::string python_list(const std::vector<double>& values) {
  std::string text = "[";
  for (const double x : values) {
    text += text.size() == 1 ? "" : text.size() - text.rfind('\n') > 100 ? ",\n    " : ", ";
    text += fmt::format("{:.10g}", degrees_per_radian * x);
  }
  return text + "]";
}

std::string python_series(const AngleSeries& series) {
  return fmt::format("({:.10g}, {},\n    {})", degrees_per_radian * series.mean, python_list(series.cosine),
                     python_list(series.sine));
}

/// A text within a Python docstring.
std::string in_docstring(std::string text) {
  for (char& c : text) c = c == '\n' || c == '\r' || c == '"' || c == '\\' ? ' ' : c;
  return detail::printable(text);
}

constexpr const char* script_head = R"(import csv
import sys

import numpy as np
import pterasoftware as ps

)";

constexpr const char* script_body = R"(

def angle(series, cycle):
    mean, cosine, sine = series
    value = mean + 0.0 * cycle
    for k, (a, b) in enumerate(zip(cosine, sine), start=1):
        value = value + a * np.cos(2.0 * np.pi * k * cycle) + b * np.sin(2.0 * np.pi * k * cycle)
    return value


def motion(series, sign):
    """An angle as PteraSoftware takes it: base angle, amplitude, period, and a function of 2 pi t / period that is 0
    at 0 and has the amplitude 1."""
    values = angle(series, np.linspace(0.0, 1.0, 2001))
    start, amplitude = float(values[0]), float(np.ptp(values)) / 2.0
    if amplitude < 1e-9:
        return sign * start, 0.0, 0.0, "sine"

    def spacing(x):
        return sign * (angle(series, x / (2.0 * np.pi)) - start) / amplitude

    return sign * start, amplitude, 1.0 / FREQUENCY, spacing


def wing_cross_sections():
    sections = []
    for n, (distance, chord) in enumerate(SECTIONS):
        tip = n == len(SECTIONS) - 1
        before = SECTIONS[n - 1][0] if n else distance
        sections.append(
            ps.geometry.wing_cross_section.WingCrossSection(
                airfoil=ps.geometry.airfoil.Airfoil(name="naca0012"),
                num_spanwise_panels=None if tip else PANELS_PER_SECTION,
                chord=chord,
                Lp_Wcsp_Lpp=(0.0, distance - before, 0.0),
                control_surface_symmetry_type="symmetric",
                spanwise_spacing=None if tip else "uniform",
            )
        )
    return sections


def problem_of_flapping():
    stroke = motion(STROKE, 1.0)
    pitch = motion(PITCH, -1.0)  # a positive angle about y lowers what is behind the leading edge
    root = HINGE_OFFSET + ROOT_OFFSET
    wing = ps.geometry.wing.Wing(
        wing_cross_sections=wing_cross_sections(),
        name="Wing",
        Ler_Gs_Cgs=(0.0, root, 0.0),
        angles_Gs_to_Wn_ixyz=(stroke[0], pitch[0], 0.0),
        symmetric=True,
        symmetryNormal_G=(0.0, 1.0, 0.0),
        symmetryPoint_G_Cg=(0.0, 0.0, 0.0),
        num_chordwise_panels=CHORDWISE_PANELS,
        chordwise_spacing="uniform",
    )
    airplane = ps.geometry.airplane.Airplane(wings=[wing], name="Flapping wings")
    wing_movements = []
    for one in airplane.wings:  # the wing and its mirror image
        wing_movements.append(
            ps.movements.wing_movement.WingMovement(
                base_wing=one,
                wing_cross_section_movements=[
                    ps.movements.wing_cross_section_movement.WingCrossSectionMovement(base_wing_cross_section=section)
                    for section in one.wing_cross_sections
                ],
                ampAngles_Gs_to_Wn_ixyz=(stroke[1], pitch[1], 0.0),
                periodAngles_Gs_to_Wn_ixyz=(stroke[2], pitch[2], 0.0),
                spacingAngles_Gs_to_Wn_ixyz=(stroke[3], pitch[3], "sine"),
                phaseAngles_Gs_to_Wn_ixyz=(0.0, 0.0, 0.0),
                rotationPointOffset_Gs_Ler=(0.0, -ROOT_OFFSET, 0.0),
            )
        )
    movement = ps.movements.movement.Movement(
        airplane_movements=[
            ps.movements.airplane_movement.AirplaneMovement(base_airplane=airplane, wing_movements=wing_movements)
        ],
        operating_point_movement=ps.movements.operating_point_movement.OperatingPointMovement(
            base_operating_point=ps.operating_point.OperatingPoint(
                rho=AIR_DENSITY, vCg__E=INFLOW, alpha=0.0, beta=0.0, nu=KINEMATIC_VISCOSITY
            )
        ),
        delta_time=1.0 / (FREQUENCY * STEPS_PER_CYCLE),
        num_cycles=CYCLES,
    )
    return ps.problems.UnsteadyProblem(movement=movement)


def write_loads(problem, name):
    """The last cycle, in the columns that wingbeat compare-loads reads."""
    steps = list(problem.steady_problems)
    with open(name, "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["cycle", "lift_per_wing_n", "stroke_moment_per_wing_nm"])
        for step in range(len(steps) - STEPS_PER_CYCLE, len(steps)):
            airplane = steps[step].airplanes[0]
            panels = list(airplane.wings[0].panels.ravel())
            # Wind axes: x ahead, which is up in hover, y along the right wing, z down.
            moment = sum(panel.moments_W_CgP1[0] - HINGE_OFFSET * panel.forces_W[2] for panel in panels)
            lift = airplane.forces_W[0] / len(airplane.wings)
            rows.writerow([repr(step / STEPS_PER_CYCLE), repr(float(lift)), repr(float(moment))])


def main():
    problem = problem_of_flapping()
    solver = ps.unsteady_ring_vortex_lattice_method.UnsteadyRingVortexLatticeMethodSolver(unsteady_problem=problem)
    solver.run(prescribed_wake=PRESCRIBED_WAKE, calculate_streamlines=False)
    write_loads(problem, sys.argv[1] if len(sys.argv) > 1 else "loads.csv")


if __name__ == "__main__":
    main()
)";

}  // namespace

std::vector<std::pair<double, double>> wing_sections(const Planform<double>& planform, int count) {
  if (planform.shape == PlanformShape::moments) {
    throw ParameterError("wing.planform.shape",
                         "is moments, which give no outline; a vortex lattice needs semi-ellipse, rectangle or "
                         "tabulated");
  }
  const double length = length_of(planform), last = std::asin(0.995);  // a tip without a chord has no panels
  std::vector<std::pair<double, double>> sections;
  double widest = 0.0;
  for (int n = 0; n < count; ++n) {
    const double distance = length * std::sin(last * n / (count - 1));
    sections.push_back({distance, chord_at(planform, distance)});
    widest = std::max(widest, sections.back().second);
  }
  for (auto& [distance, chord] : sections) chord = std::max(chord, 0.01 * widest);
  return sections;
}

std::string kinematics_pterasoftware(const KinematicsSource& source, const Design<double>& design) {
  const Planform<double>& planform = design.wing.planform;
  const auto sections = wing_sections(planform, 9);
  const double root = hub_offset_of(planform), tip = root + length_of(planform);
  double speed = 0.0;
  for (std::size_t k = 0; k < source.stroke.cosine.size(); ++k) {
    speed += square(two_pi * source.frequency * double(k + 1)) * 0.5 *
             (square(source.stroke.cosine[k]) + square(source.stroke.sine[k]));
  }
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "\"\"\"Flapping wings for PteraSoftware: {}.\n\n"
                 "Written by wingbeat {} export-kinematics for PteraSoftware 5.1 (pip install pterasoftware). It was\n"
                 "checked against the signatures of that version, but has not been run with it: draw the wings, and\n"
                 "see how the loads change with panels, steps and cycles, before you use a number.\n\n"
                 "  python3 THIS_FILE [loads.csv]      then: wingbeat compare-loads VEHICLE loads.csv\n\n"
                 "The stroke axis is the x axis, from the leading edge backwards; the stroke plane is y and z. A\n"
                 "positive stroke angle turns the right wing (y) towards z. The force ahead, against x, is the\n"
                 "lift in hover.\n"
                 "Largest error of the series below, in degrees: stroke {:.3g}, pitch {:.3g}.\n\"\"\"\n",
                 in_docstring(source.vehicle), source.version, degrees_per_radian * source.stroke.error_max,
                 degrees_per_radian * source.pitch.error_max);
  text += script_head;
  fmt::format_to(out, "FREQUENCY = {:.12g}  # [Hz]\n", source.frequency);
  fmt::format_to(out, "AIR_DENSITY = {:.6g}  # [kg/m3]\nKINEMATIC_VISCOSITY = {:.6g}  # [m2/s]\n",
                 design.aerodynamics.air_density, design.aerodynamics.kinematic_viscosity);
  text += "# Distance from the wing root and chord of each section [m].\nSECTIONS = [\n";
  for (const auto& [distance, chord] : sections) fmt::format_to(out, "    ({:.9g}, {:.9g}),\n", distance, chord);
  fmt::format_to(out,
                 "]\nROOT_OFFSET = {:.9g}  # stroke axis to wing root [m]\n"
                 "HINGE_OFFSET = {:.9g}  # plane of symmetry to stroke axis [m]\n",
                 root, std::max(0.5 * planform.shoulder_distance, 1e-3 * length_of(planform)));
  fmt::format_to(out,
                 "# Speed along the stroke axis [m/s]: it must be above 0. A twentieth of the wing tip's speed\n"
                 "# (root mean square) is nearly hover.\nINFLOW = {:.4g}\n"
                 "CHORDWISE_PANELS, PANELS_PER_SECTION = 5, 2\nSTEPS_PER_CYCLE, CYCLES = 60, 4\n"
                 "PRESCRIBED_WAKE = False  # a wake in hover moves by itself: slower\n",
                 0.05 * tip * std::sqrt(speed));
  fmt::format_to(out,
                 "# Fourier series over the cycle in degrees: mean, cosines, sines.\nSTROKE = {}\n"
                 "# Zero where the chord is normal to the stroke plane, negative while the stroke angle grows.\n"
                 "PITCH = {}\n",
                 python_series(source.stroke), python_series(source.pitch));
  text += script_body;
  return text;
}

}  // namespace wingbeat
