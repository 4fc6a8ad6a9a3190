// The rows of the parameter table, in the order of the reference. Whoever needs the table of a scalar S instantiates
// parameter_table<S>() in one source file: double in parameters.cpp, the dual numbers of gradients in src/cycle/.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>

#include "vehicle/body_rows.hpp"
#include "vehicle/drive_rows.hpp"
#include "vehicle/parameter_access.hpp"
#include "wingbeat/parts/any_transmission.hpp"
#include "wingbeat/parts/coefficient_sets.hpp"
#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/parts/spring.hpp"
#include "wingbeat/parts/wing_limits.hpp"

namespace wingbeat {

namespace detail {

template <class Row, std::size_t m, std::size_t n>
constexpr std::array<Row, m + n> joined(const std::array<Row, m>& a, const std::array<Row, n>& b) {
  std::array<Row, m + n> rows{};
  std::copy(a.begin(), a.end(), rows.begin());
  std::copy(b.begin(), b.end(), rows.begin() + m);
  return rows;
}

/// Of mechanism, springs, wings and air.
template <Scalar S>
constexpr auto wing_rows() {
  using enum PlanformShape;
  using D = Design<S>;
  using Crank = TransmissionIs<TransmissionType::slider_crank>;
  using StrokeLaw = TransmissionIs<TransmissionType::tabulated>;
  using Direct = TransmissionIs<TransmissionType::direct>;
  using Outline = ShapeIs<semi_ellipse, rectangle>;
  using FromRoot = ShapeIs<semi_ellipse, rectangle, tabulated>;
  using Tabulated = ShapeIs<tabulated>;
  using Moments = ShapeIs<moments>;
  constexpr auto hinge_offset = [](auto& d) -> auto& { return d.transmission.hinge_offset; };
  constexpr auto stroke_amplitude = [](auto& d) -> auto& { return d.transmission.stroke_amplitude; };
  constexpr auto stiffness = [](auto& d) -> auto& { return d.spring.stiffness; };
  constexpr auto resonance = [](auto& d) -> auto& { return d.spring.resonance; };
  constexpr auto spring_ratio = [](auto& d) -> auto& { return d.spring.resonance_ratio; };
  constexpr auto wing_resonance = [](auto& d) -> auto& { return d.wing.resonance; };
  constexpr auto areal_density = [](auto& d) -> auto& { return d.wing.areal_density; };
  constexpr auto chord_ratio = [](auto& d) -> auto& { return d.wing.planform.chord_ratio; };
  constexpr auto angle_of_attack = [](auto& d) -> auto& { return d.aerodynamics.angle_of_attack; };
  constexpr auto stop = [](auto& d) -> auto& { return d.pitch.stop; };
  constexpr auto stop_low = [](auto& d) -> auto& { return d.pitch.stop_low; };
  constexpr auto stop_high = [](auto& d) -> auto& { return d.pitch.stop_high; };
  using D = Design<S>;
  return std::array{
      choice<S, TransmissionChoice>(
          "kind of mechanism between motor and wings; direct: the motor shaft is the wing hinge"),
      number<S, WhereTaken<crank_radius_key>>(row(crank_radius_key, "required", "r_c, crank radius", {}, "5 mm"),
                                              [](auto& d) -> auto& { return d.transmission.crank_radius; }),
      number<S, WhereTaken<slider_crank_key::rod_length>>(
          row(slider_crank_key::rod_length, "required", "l, rod length", {}, "20 mm"),
          [](auto& d) -> auto& { return d.transmission.rod_length; }),
      alternative<S, WhereTaken<slider_crank_key::hinge_offset>>(
          row(slider_crank_key::hinge_offset, "required", "H, horizontal distance from slider to wing hinge",
              {"stroke_amplitude"}, "6 mm"),
          hinge_offset, stroke_amplitude),
      alternative<S, WhereTaken<slider_crank_key::stroke_amplitude>>(
          row(slider_crank_key::stroke_amplitude, "required",
              "half the peak-to-peak stroke angle; fixes H = r_c / tan(stroke_amplitude); "
              "not with mid_stroke_height",
              {"hinge_offset"}),
          stroke_amplitude, hinge_offset),
      number<S, WhereTaken<slider_crank_key::mid_stroke_height>>(
          row(slider_crank_key::mid_stroke_height, "rod_length",
              "y_0, slider height over the crank axis at stroke angle zero"),
          [](auto& d) -> auto& { return d.transmission.mid_stroke_height; }),
      number<S, Weighed>({"transmission.rod_linear_density", "kg/m", range::not_negative, "none: in vehicle.mass",
                          "mass of the rod or coupler over its length: that length times this, in addition to "
                          "vehicle.mass"},
                         [](auto& d) -> auto& { return d.masses.rod_linear_density; }),
      number<S, WhereTaken<four_bar_key::coupler_length>>(
          row(four_bar_key::coupler_length, "required", "l, from crank pin to rocker pin", {}, "20 mm"),
          [](auto& d) -> auto& { return d.transmission.coupler_length; }),
      number<S, WhereTaken<four_bar_key::rocker_length>>(
          row(four_bar_key::rocker_length, "required", "p, from rocker axis to rocker pin", {}, "7.5 mm"),
          [](auto& d) -> auto& { return d.transmission.rocker_length; }),
      number<S, WhereTaken<four_bar_key::ground_length>>(
          row(four_bar_key::ground_length, "required", "d, from crank axis to rocker axis", {}, "20.5 mm"),
          [](auto& d) -> auto& { return d.transmission.ground_length; }),
      number<S, WhereTaken<four_bar_key::stroke_ratio>>(
          row(four_bar_key::stroke_ratio, "1",
              "n_s, turning angle of the wings over that of the rocker: sector gear or string"),
          [](auto& d) -> auto& { return d.transmission.stroke_ratio; }),
      number<S, WhereTaken<four_bar_key::ground_angle>>(
          row(four_bar_key::ground_angle, "middle of the rocker's swing",
              "phi_mid, angle of the rocker from the direction crank axis to rocker axis at stroke angle zero"),
          [](auto& d) -> auto& { return d.transmission.ground_angle; }),
      table<S, StrokeLaw>({"transmission.file",
                           "",
                           {"name of a CSV file"},
                           "required",
                           "stroke law: columns crank_angle and stroke_angle, see below",
                           {"stroke_table"}}),
      table<S, StrokeLaw>({"transmission.stroke_table",
                           "",
                           {"four or more rows within a turn, crank angles growing"},
                           "required",
                           "stroke law in place: rows [crank angle, stroke angle], periodic spline of degree five",
                           {"file"},
                           "[[0, 0], [0.8, 0.5], [1.6, 0.7], [2.4, 0.47], [3.2, -0.04], [4.0, -0.53], [4.8, -0.69], "
                           "[5.6, -0.44]]"}),
      number<S, WhereTaken<stroke_table_key::scale>>(
          row(stroke_table_key::scale, "1", "multiplies the stroke angles of the table"),
          [](auto& d) -> auto& { return d.transmission.table.scale; }),
      number<S, WhereTaken<stroke_table_key::reference_radius>>(
          row(stroke_table_key::reference_radius, "required",
              "r_ref, radius at which the moment of the wings acts: load-proportional friction acts on "
              "that moment over r_ref",
              {}, "6 mm"),
          [](auto& d) -> auto& { return d.transmission.table.reference_radius; }),
      choice<S, FormulationChoice, Crank>(
          "how the rod force turns the wings: the paper's eq (1), or conserving power exactly",
          name_of(Formulation::virtual_work)),

      choice<S, FrictionChoice>("law of the transmission's friction torque T_f on the crank or shaft"),
      friction_number<S, FrictionLaw::load_proportional>(row(
          friction_key::radius, "required", "mu r_e, effective friction radius: T_f = mu r_e abs(F)", {}, "2.5 mm")),
      number<S, Direct>(row(direct_drive_key::reference_radius, "none",
                            "r_ref, radius at which the moment of the wings acts: load-proportional friction acts on "
                            "that moment over r_ref"),
                        [](auto& d) -> auto& { return d.friction.reference_radius; }),
      friction_number<S, FrictionLaw::viscous>(row(friction_key::damping, "required", "b_f: T_f = b_f omega")),
      friction_number<S, FrictionLaw::quadratic>(
          row(friction_key::quadratic, "required", "c_f: T_f = c_f omega abs(omega)")),
      friction_number<S, FrictionLaw::constant>(row(friction_key::torque, "required", "T_c: T_f = T_c sign(omega)")),

      alternative<S>(row(spring_key::stiffness, "required",
                         "k, stiffness of one hinge spring, at rest at stroke angle zero or at rest_angle",
                         {"resonance", "resonance_ratio"}),
                     stiffness, resonance, spring_ratio),
      alternative<S>(
          {"spring.resonance",
           "Hz",
           range::not_negative,
           "required",
           "f_s, resonance of one wing on its spring, k = J_w (2 pi f_s)^2; direct drive: of rotor and wings "
           "on all springs, N_w k = (J + N_w J_w) (2 pi f_s)^2",
           {"stiffness", "resonance_ratio"}},
          resonance, stiffness, spring_ratio),
      alternative<S, Direct>({"spring.resonance_ratio",
                              "1",
                              range::positive,
                              "required",
                              "frequency at which rotor and wings resonate on the springs, over the drive frequency; 1 "
                              "tunes the springs to the supply",
                              {"stiffness", "resonance"}},
                             spring_ratio, stiffness, resonance),
      number<S, Direct>(row(spring_key::rest_angle, "0 rad",
                            "beta_0, stroke angle at which the hinge springs are at rest, positive forward: the middle "
                            "of the stroke without a mean voltage"),
                        [](auto& d) -> auto& { return d.spring.rest_angle; }),
      number<S, WeighedSprings>({"spring.mass", "kg", range::not_negative, "none: in vehicle.mass",
                                 "mass of one hinge spring, in addition to vehicle.mass; one for each wing"},
                                [](auto& d) -> auto& { return d.masses.spring; }),

      number<S>({"wing.count", "1", range::count, "2", "N_w, number of wings that one motor drives", {}, "2"},
                [](auto& d) -> auto& { return d.wing.count; }),
      replaceable<S>(
          {"wing.inertia",
           "kg m2",
           range::positive,
           "required",
           "J_w, inertia of one wing about its hinge",
           {"resonance", "areal_density"},
           "7.2e-8 kg m2"},
          [](auto& d) -> auto& { return d.wing.inertia; }, wing_resonance, areal_density),
      alternative<S, Direct>(
          {"wing.resonance",
           "Hz",
           range::positive,
           "required",
           "frequency at which rotor and wings resonate on springs of a given stiffness: the inertia "
           "follows, J + N_w J_w = N_w k / (2 pi f)^2",
           {"inertia", "areal_density"}},
          wing_resonance, areal_density),
      alternative<S>(row(wing_material_key::areal_density, "required",
                         "sigma of the membrane, glue spread over it: the inertia follows from the planform's outline, "
                         "J_w = integral (sigma c + lambda) r^2 dr and that of the ribs",
                         {"inertia", "resonance"}),
                     areal_density, wing_resonance),
      number<S, Drawn>(row(wing_material_key::spar_density, "0 kg/m",
                           "lambda, mass of the leading-edge spar over its length, from root to tip"),
                       [](auto& d) -> auto& { return d.wing.spar_density; }),
      number<S, Drawn>(row(wing_material_key::rib_density, "0 kg/m",
                           "lambda_r, mass of a rib over its length, along the chord from edge to edge"),
                       [](auto& d) -> auto& { return d.wing.rib_density; }),
      number<S, Drawn>(row(wing_material_key::rib_count, "0",
                           "n_r, ribs of one wing, which divide its length into n_r + 1 equal bays"),
                       [](auto& d) -> auto& { return d.wing.rib_count; }),
      number<S, PitchingWing>(
          row(pitch_key::pitch_inertia, "from areal_density",
              "I_psi = integral x^2 dm of one wing about its pitch axis, where it pitches or twists; given with "
              "mass_product, or both follow from areal_density"),
          [](auto& d) -> auto& { return d.wing.pitch_inertia; }),
      number<S, PitchingWing>(
          row(pitch_key::mass_product, "from areal_density",
              "P = integral r x dm of one wing, r from the flapping hinge, x behind the pitch axis"),
          [](auto& d) -> auto& { return d.wing.mass_product; }),
      number<S>(
          row(torsion_key::stiffness, "none: no twist",
              "k_tau, torsion of one wing along its span: twist of the tip against the root, linear between; given, "
              "twist is a degree of freedom, in addition to the pitch hinge or instead of it"),
          [](auto& d) -> auto& { return d.wing.torsion.stiffness; }),
      number<S, Twisting>(row(torsion_key::damping, "0 N m s/rad", "c_tau of one wing"),
                          [](auto& d) -> auto& { return d.wing.torsion.damping; }),
      choice<S, ShapeChoice>("how the wing's outline is given", name_of(semi_ellipse)),
      number<S, Outline>(row(planform_key::length, "required", "R, wing root to tip", {}, "63 mm"),
                         [](auto& d) -> auto& { return d.wing.planform.length; }),
      replaceable<S, Outline>(
          row(planform_key::root_chord, "required", "c_0, chord at the root", {"chord_ratio"}, "25 mm"),
          [](auto& d) -> auto& { return d.wing.planform.root_chord; }, chord_ratio),
      alternative<S, Outline>(
          row(planform_key::chord_ratio, "required",
              "c_0 / R, chord at the root over the length: it follows when the length changes", {"root_chord"}),
          chord_ratio),
      number<S, FromRoot>(row(planform_key::hub_offset, "0 m", "distance from the hinge to the wing root"),
                          [](auto& d) -> auto& { return d.wing.planform.hub_offset; }),
      number<S, FromRoot>(row(planform_key::shoulder_distance, "0 m",
                              "distance between the hinges of two wings that share a body: the farther apart, the "
                              "farther beyond 90 deg they may swing before they meet"),
                          [](auto& d) -> auto& { return d.wing.planform.shoulder_distance; }),
      table<S, Tabulated>({"wing.planform.file",
                           "",
                           {"name of a CSV file"},
                           "required",
                           "chord table: columns distance (from the root) and chord, see below",
                           {"chords"}}),
      table<S, Tabulated>({"wing.planform.chords",
                           "",
                           {"two or more rows, distances growing, chords >= 0"},
                           "required",
                           "chord table in place: rows [distance from the root, chord], linear between",
                           {"file"}}),
      number<S, Moments>(row(planform_key::s2, "required", "S_2 = N_w integral c r^2 dr of all wings"),
                         [](auto& d) -> auto& { return d.wing.planform.s2; }),
      number<S, Moments>(row(planform_key::s3, "required", "S_3 = N_w integral c r^3 dr of all wings"),
                         [](auto& d) -> auto& { return d.wing.planform.s3; }),
      number<S, Moments>(row(planform_key::s22, "none", "S_22 = N_w integral c^2 r^2 dr of all wings, for added mass"),
                         [](auto& d) -> auto& { return d.wing.planform.s22; }),
      number<S>(row(planform_key::scale, "1",
                    "s, multiplies length, chords and hub_offset of the outline; s2, s3 and s22 with s^4, s^5 and s^5"),
                [](auto& d) -> auto& { return d.wing.planform.scale; }),
      text<S>({"wing.planform.scale_inertia",
               "",
               {"true or false"},
               "true",
               "inertia, pitch_inertia and mass_product grow with s^5; false: they are those of the scaled wing"},
              [](const D& d) { return std::string(d.wing.scale_inertia ? "true" : "false"); }),

      number<S>(row(pitch_key::stiffness, "none: the pitch law",
                    "k_psi of the hinge about which one wing pitches; given, pitch is a degree of freedom"),
                [](auto& d) -> auto& { return d.pitch.stiffness; }),
      number<S, Pitching>(row(pitch_key::damping, "0 N m s/rad", "c_psi of one hinge"),
                          [](auto& d) -> auto& { return d.pitch.damping; }),
      placed_alternative<S, Pitching>(
          row(pitch_key::stop, "none", "psi_max, pitch angle to either side at which stops hold the wing",
              {"stop_low", "stop_high"}),
          stop, stop_low, stop_high),
      placed_alternative<S, Pitching>(
          row(pitch_key::stop_low, "none",
              "lower stop, if the stops differ: smallest psi; the trailing edge is behind a wing that swings "
              "forward then",
              {"stop"}),
          stop_low, stop),
      placed_alternative<S, Pitching>(
          row(pitch_key::stop_high, "none", "upper stop, if the stops differ: largest psi", {"stop"}), stop_high, stop),
      number<S, Pitching>(row(pitch_key::friction, "0 N m", "T_psi, constant friction of one hinge's joint"),
                          [](auto& d) -> auto& { return d.pitch.friction; }),
      text<S, Pitching>({"pitch.rotational_lift",
                         "",
                         {"true or false"},
                         "true, with normal-force-robofly and robobee false",
                         "the force that the circulation of a pitching wing adds, C_rot = pi (0.75 - x_0)"},
                        [](const D& d) {
                          if (!Pitching::holds(d)) return std::string();
                          return std::string(d.pitch.rotational_lift ? "true" : "false");
                        }),
      number<S, Pitching>(row(pitch_key::damping_coefficient, "0, with normal-force-robofly and robobee 5",
                              "C_rd, drag coefficient of a wing that turns about its "
                              "leading edge"),
                          [](auto& d) -> auto& { return d.pitch.damping_coefficient; }),
      number<S, Pitching>(row(pitch_key::axis, "0",
                              "x_0, position of the pitch axis behind the leading edge over the chord: C_rot = "
                              "pi (0.75 - x_0)"),
                          [](auto& d) -> auto& { return d.pitch.axis; }),
      number<S, Pitching>(row(pitch_key::edge_suction, "0",
                              "s_L, share of the added mass's force along the chord that counts as lift: with 1 added "
                              "mass has no mean lift"),
                          [](auto& d) -> auto& { return d.pitch.edge_suction; }),

      number<S>(row(aerodynamics_key::air_density, "required", "rho, air density", {}, "1.225 kg/m3"),
                [](auto& d) -> auto& { return d.aerodynamics.air_density; }),
      replaceable<S, UnderPitchLaw>(
          row(aerodynamics_key::pitch_coefficient, "required",
              "C_alpha, passive pitching: alpha = pi/2 - C_alpha abs(beta')", {"angle_of_attack"}, "5 ms"),
          [](auto& d) -> auto& { return d.aerodynamics.pitch_coefficient; }, angle_of_attack),
      alternative<S, UnderPitchLaw>(
          row(aerodynamics_key::angle_of_attack, "required",
              "angle of attack at the largest abs(beta'), near mid-stroke: C_alpha is found for it at the operating "
              "point",
              {"pitch_coefficient"}),
          angle_of_attack),
      number<S, UnderPitchLaw>(
          row(aerodynamics_key::angle_of_attack_min, "none", "stop of the passive pitching: alpha falls no lower"),
          [](auto& d) -> auto& { return d.aerodynamics.angle_of_attack_min; }),
      text<S>(
          {"aerodynamics.added_mass",
           "",
           {"true or false"},
           "false",
           "air accelerated with the wings: J_a = pi/4 rho S_22 by strip theory; for wings on a pitch hinge also the "
           "air moved by pitching; without mean power"},
          [](const D& d) { return std::string(d.aerodynamics.added_mass ? "true" : ""); }),
      number<S>(row(wing_limits_key::kinematic_viscosity, "1.5e-5 m2/s",
                    "nu, kinematic viscosity of the air, for the Reynolds number; no force depends on it"),
                [](auto& d) -> auto& { return d.aerodynamics.kinematic_viscosity; }),
      number<S>(row(wing_limits_key::reynolds_number_min, "of a named set of coefficients 100, else none",
                    "lowest Reynolds number for which the coefficients hold"),
                [](auto& d) -> auto& { return d.aerodynamics.reynolds_number_min; }),
      number<S>(row(wing_limits_key::reynolds_number_max, "of a named set of coefficients 26000, else none",
                    "highest Reynolds number for which the coefficients hold"),
                [](auto& d) -> auto& { return d.aerodynamics.reynolds_number_max; }),
      number<S>(
          row(tip_loss_key::lifting_span, "1",
              "B, part of the distance from hinge to tip that lifts; beyond it the wings have only the drag C_D(0)"),
          [](auto& d) -> auto& { return d.aerodynamics.lifting_span; }),
      number<S>(row(induced_velocity_key::share, "none",
                    "applied share, 0 to 1, of the induced velocity of momentum theory. Coefficients measured on "
                    "flapping wings include a part of the wake, so that 1 counts this part twice"),
                [](auto& d) -> auto& { return d.aerodynamics.induced_velocity; }),
      number<S, InducedVelocityGiven>(
          row(induced_velocity_key::swept_area, "that of the stroke",
              "A_0, area of the actuator disc; else of each wing the sector of twice the stroke amplitude"),
          [](auto& d) -> auto& { return d.aerodynamics.swept_area; }),
      text<S, Pitching>(
          {"aerodynamics.centre_of_pressure",
           "",
           {wingbeat::listed_names<CentreOfPressure>()},
           name_of(CentreOfPressure::fourier),
           "where the force of translation acts along the chord: a Fourier series over the angle of attack, "
           "or a curve from 0.25 to 0.5"},
          [](const D& d) {
            const CentreOfPressure law = d.pitch.centre_of_pressure;
            const bool stated = Pitching::holds(d) && law != CentreOfPressure::fourier;
            return std::string(stated ? name_of(law) : "");
          }),
      text<S>({"aerodynamics.coefficients",
               "",
               {"translational-2022, normal-force-robofly (with pitch.stiffness), robobee, normal-tangential, or a "
                "table of the keys below"},
               "translational-2022",
               "lift and drag coefficient against angle of attack, eqs (12, 13); normal-force-robofly: "
               "C_L = 1.8 sin(2 alpha), C_D = 1.95 - 1.5 cos(2 alpha), of both the component normal to the chord; "
               "robobee: C_L = 1.8 sin(2 alpha), C_D = 1.9 - 1.5 cos(2 alpha); normal-tangential: "
               "C_N = 3.4 sin(alpha), C_T = 0.4 cos(2 alpha)^2 below 45 deg, else 0",
               {},
               "translational-2022"},
              [](const D& d) {
                const std::string& name = d.aerodynamics.coefficients_name;
                const bool named = name != "custom" && !d.aerodynamics.coefficients.table && !d.aerodynamics.load_table;
                return named ? name : std::string();
              }),
      wave_number<S>(
          {"aerodynamics.coefficients.lift.offset", "1", range::any, "required", "A of C_L = A + B sin(C alpha + D)"},
          [](auto& c) -> auto& { return c.lift.offset; }),
      wave_number<S>({"aerodynamics.coefficients.lift.amplitude", "1", range::any, "required",
                      "B of C_L = A + B sin(C alpha + D)"},
                     [](auto& c) -> auto& { return c.lift.amplitude; }),
      wave_number<S>(
          {"aerodynamics.coefficients.lift.rate", "1", range::any, "required", "C of C_L = A + B sin(C alpha + D)"},
          [](auto& c) -> auto& { return c.lift.rate; }),
      wave_number<S>(
          {"aerodynamics.coefficients.lift.phase", "rad", range::any, "required", "D of C_L = A + B sin(C alpha + D)"},
          [](auto& c) -> auto& { return c.lift.phase; }),
      wave_number<S>(
          {"aerodynamics.coefficients.drag.offset", "1", range::any, "required", "A of C_D = A + B cos(C alpha + D)"},
          [](auto& c) -> auto& { return c.drag.offset; }),
      wave_number<S>({"aerodynamics.coefficients.drag.amplitude", "1", range::any, "required",
                      "B of C_D = A + B cos(C alpha + D)"},
                     [](auto& c) -> auto& { return c.drag.amplitude; }),
      wave_number<S>(
          {"aerodynamics.coefficients.drag.rate", "1", range::any, "required", "C of C_D = A + B cos(C alpha + D)"},
          [](auto& c) -> auto& { return c.drag.rate; }),
      wave_number<S>(
          {"aerodynamics.coefficients.drag.phase", "rad", range::any, "required", "D of C_D = A + B cos(C alpha + D)"},
          [](auto& c) -> auto& { return c.drag.phase; }),
      wave_number<S>(
          {"aerodynamics.coefficients.tangential", "1", range::not_negative, "0",
           "C_T,0 of a force along the chord, in addition to C_L and C_D: C_T = C_T,0 cos(2 alpha)^2 below 45 deg, "
           "else 0"},
          [](auto& c) -> auto& { return c.tangential; }),
      table<S>({"aerodynamics.coefficients.table",
                "",
                {"name of a CSV file, or three or more rows, angles growing"},
                "none",
                "instead of lift and drag: rows [angle of attack, C_L, C_D], natural cubic splines, see below",
                {"lift", "drag"}}),
      text<S>({load_table_key::type,
               "",
               {"quasi-steady or tabulated"},
               "quasi-steady",
               "tabulated: lift and moments of the air are read from a table over the motion of the wings, in place of "
               "coefficients, rotational lift and rotational damping"},
              [](const D& d) { return std::string(LoadsTabulated::holds(d) ? "tabulated" : ""); }),
      table<S, LoadsTabulated>({load_table_key::file,
                                "",
                                {"name of a CSV file"},
                                "none",
                                "table of loads: columns flapping_velocity, lift, stroke_moment and others, see below",
                                {"load_table"}}),
      table<S, LoadsTabulated>({load_table_key::rows,
                                "",
                                {"rows of seven values"},
                                "none",
                                "table of loads in place: rows [stroke angle, flapping velocity, pitch angle, pitch "
                                "velocity, lift, stroke moment, pitch moment]",
                                {"file"}}),
      alternative<S, LoadsTabulated>(row(load_table_key::air_density, "aerodynamics.air_density",
                                         "density of the air for which the table holds; loads are proportional to it"),
                                     [](auto& d) -> auto& { return d.aerodynamics.table_air_density; }),
      alternative<S, LoadsTabulated>(row(load_table_key::wings, "all", "number of wings for the loads of the table"),
                                     [](auto& d) -> auto& { return d.aerodynamics.table_wings; }),
      number<S>(row(clap_and_fling_key::amplitude, "none",
                    "A: where wings meet at the reversal with the largest stroke angle, all aerodynamic forces are "
                    "multiplied by 1 + A exp(-s / (lambda c)) as they part, where s is the path of the 70 % station "
                    "since then and c the mean chord"),
                [](auto& d) -> auto& { return d.aerodynamics.clap.amplitude; }),
      number<S, ClapGiven>(row(clap_and_fling_key::decay, "1", "lambda, length of its decay over the mean chord"),
                           [](auto& d) -> auto& { return d.aerodynamics.clap.decay; }),
      number<S, ClapGiven>(
          row(clap_and_fling_key::gap, "1",
              "g, distance over the mean chord of the 70 % stations of the two wings at the reversal, up "
              "to which they interact"),
          [](auto& d) -> auto& { return d.aerodynamics.clap.gap; }),
      number<S, ClapGiven>(row(clap_and_fling_key::meeting_angle, "that of two wings on one body, about 90 deg",
                               "stroke angle at which the two wings touch"),
                           [](auto& d) -> auto& { return d.aerodynamics.clap.meeting_angle; }),

      number<S>({"bench.torque_constant", "N m/A", range::positive, "none",
                 "K_ref of a test bench, eq (17); enables power_motor_reference_w"},
                [](auto& d) -> auto& { return d.bench_torque_constant; })};
}

}  // namespace detail

template <Scalar S>
std::span<const Parameter<S>> parameter_table() {
  static constexpr auto parameters =
      detail::joined(detail::joined(detail::drive_rows<S>(), detail::wing_rows<S>()), detail::body_rows<S>());
  return parameters;
}

}  // namespace wingbeat
