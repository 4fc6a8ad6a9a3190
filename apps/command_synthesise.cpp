// wingbeat synthesise MECHANISM: the links of a four-bar or slider-crank from the stroke that it is to have.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "command.hpp"
#include "operating_point.hpp"
#include "options.hpp"
#include "plot_option.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/files/design_edit.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/report/plot.hpp"
#include "wingbeat/report/synthesis_report.hpp"
#include "wingbeat/study/synthesis.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::app {
namespace {

struct SynthesiseArguments {
  std::string mechanism, stroke, envelope, shortest, stroke_ratio, time_ratio, transmission_angle, clearance;
  std::string vehicle, output, plot, plot_width;
  bool json = false, force = false;
};

/// An option for each number of the target.
struct TargetOption {
  const char* name;
  const char* key;  ///< of ParameterError
  const char* unit;
  std::string SynthesiseArguments::* text;
  double StrokeTarget::* value;
};
constexpr TargetOption target_options[] = {
    {"--stroke", "stroke", "rad", &SynthesiseArguments::stroke, &StrokeTarget::stroke},
    {"--envelope", "envelope", "m", &SynthesiseArguments::envelope, &StrokeTarget::envelope},
    {"--shortest", "shortest", "m", &SynthesiseArguments::shortest, &StrokeTarget::shortest},
    {"--stroke-ratio", "stroke_ratio", "1", &SynthesiseArguments::stroke_ratio, &StrokeTarget::stroke_ratio},
    {"--time-ratio", "time_ratio", "1", &SynthesiseArguments::time_ratio, &StrokeTarget::time_ratio},
    {"--transmission-angle", "transmission_angle", "rad", &SynthesiseArguments::transmission_angle,
     &StrokeTarget::transmission_angle}};

TransmissionType mechanism_of(const std::string& text) {
  const auto type = from_name<TransmissionType>(text);
  if (type == TransmissionType::four_bar || type == TransmissionType::slider_crank) return *type;
  throw InputError("mechanism", 0, 0, "", "must be four-bar or slider-crank, got " + in_quotes(text));
}

StrokeTarget target_of(const SynthesiseArguments& a) {
  StrokeTarget target{};
  for (const TargetOption& o : target_options) {
    const std::string& text = a.*o.text;
    if (text.empty()) continue;
    target.*o.value = quantity_of(o.name, text, o.unit);
    // Zero is what is not given.
    if (o.value == &StrokeTarget::shortest && !(target.shortest > 0.0)) {
      throw InputError(o.name, 0, 0, "", "must be > 0 m");
    }
  }
  return target;
}

SynthesisedMechanism synthesised(TransmissionType type, const StrokeTarget& target) {
  try {
    return type == TransmissionType::four_bar ? synthesise_four_bar(target) : synthesise_slider_crank(target);
  } catch (const ParameterError& error) {
    for (const TargetOption& o : target_options) {
      if (error.key() == o.key) throw InputError(o.name, 0, 0, "", error.reason());
    }
    throw;
  }
}

std::optional<ClearanceCost> clearance_of(const SynthesiseArguments& a, const SynthesisedMechanism& found) {
  if (a.clearance.empty()) return std::nullopt;
  const double clearance = quantity_of("--clearance", a.clearance, "m");
  if (!(clearance >= 0.0)) throw InputError("--clearance", 0, 0, "", "must be >= 0 m");
  try {
    return clearance_cost(found.transmission, clearance);
  } catch (const ParameterError&) {
    throw InputError("--clearance " + a.clearance, 0, 0, "", "the crank does not turn with so much play in the joints");
  }
}

/// The file that -o names: the vehicle with the mechanism in it, or the mechanism's section alone.
std::string written(const SynthesiseArguments& a, const SynthesisedMechanism& found) {
  const std::string head = fmt::format("# {} for a stroke of {}, by wingbeat {} synthesise.\n",
                                       name_of(found.transmission.type), one_line(a.stroke, 40), version);
  if (a.vehicle.empty()) return head + transmission_section(found.transmission);
  Design<double> design = read_design(a.vehicle);
  if (design.transmission.type == TransmissionType::direct) {
    throw InputError(a.vehicle, 0, 0, "transmission.type", "is direct: the motor of such a vehicle does not turn");
  }
  const Formulation formulation = design.transmission.formulation;
  const bool slider = design.transmission.type == TransmissionType::slider_crank;
  design.transmission = found.transmission;
  if (slider) design.transmission.formulation = formulation;
  try {
    validate(design);
  } catch (const ParameterError& error) {
    throw InputError(a.vehicle, 0, 0, error.key(), error.reason());
  }
  return head + edited_design(a.vehicle, a.output, design);
}

int run(const SynthesiseArguments& a) {
  const auto format = asked_format("--plot", a.plot, a.plot_width);
  const TransmissionType type = mechanism_of(a.mechanism);
  if (!a.vehicle.empty() && a.output.empty()) throw InputError("--vehicle", 0, 0, "", "needs -o, the file to write");
  const StrokeTarget target = target_of(a);
  const SynthesisedMechanism found = synthesised(type, target);
  if (!found.found) throw InputError("synthesise", 0, 0, "", why_not_found(found, type));
  const std::optional<ClearanceCost> clearance = clearance_of(a, found);
  std::optional<OutputFile> output, plot;
  if (!a.output.empty()) output.emplace("-o", a.output, OutputRules{".toml", a.force});
  if (format) plot.emplace("--plot", a.plot, OutputRules{plot_extensions, a.force});
  if (output) output->write(written(a, found));
  if (plot) plot->write(drawn_mechanism(found.transmission, *format));
  if (output) output->commit();
  if (plot) plot->commit();
  print(a.json ? json_synthesis(found, clearance) : text_synthesis(found, clearance));
  return done;
}

}  // namespace

void add_synthesise(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("synthesise", "Find the links of a mechanism from its stroke");
  const auto a = std::make_shared<SynthesiseArguments>();
  Values mechanisms;
  mechanisms.choices = {{"four-bar"}, {"slider-crank"}};
  takes(command->add_option("mechanism", a->mechanism, "four-bar or slider-crank")->required()->type_name("MECHANISM"),
        mechanisms);
  command->add_option("--stroke", a->stroke, "Stroke angle of the wings, peak to peak")->required()->type_name("ANGLE");
  command
      ->add_option("--envelope", a->envelope, "The room: longest distance between two points that pins and axes reach")
      ->required()
      ->type_name("LENGTH");
  command->add_option("--shortest", a->shortest, "No link is shorter (default a tenth of the envelope)")
      ->type_name("LENGTH");
  command
      ->add_option("--stroke-ratio", a->stroke_ratio,
                   "Angle of the wings over that of the rocker, by a gear pair or string (default 1)")
      ->type_name("RATIO");
  command
      ->add_option("--time-ratio", a->time_ratio, "Largest ratio of the longer half-stroke to the shorter (default 1)")
      ->type_name("RATIO");
  command
      ->add_option("--transmission-angle", a->transmission_angle, "Smallest transmission angle allowed (default 5 deg)")
      ->type_name("ANGLE");
  command->add_option("--clearance", a->clearance, "Radial play of every joint: give its effects")->type_name("LENGTH");
  add_input(command, a->vehicle, InputKind::vehicle, "--vehicle",
            "Write this vehicle with the mechanism instead of its own", "VEHICLE")
      ->required(false);
  add_file(command, "-o,--output", a->output, ".toml", "Write [transmission], or the vehicle with it", "FILE.toml");
  add_file(command, "--plot", a->plot, plot_extensions, "Draw the mechanism to FILE.svg, .pdf or .png");
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  add_json(command, a->json);
  command->footer(
      "Example:\n  wingbeat synthesise four-bar --stroke \"120 deg\" --envelope \"25 mm\" --stroke-ratio 2\n\n"
      "Of all four-bars with this stroke, envelope and ratio of the half-strokes, it finds the one with the largest\n"
      "minimum of the transmission angle between coupler and rocker; of slider-cranks the one with the longest\n"
      "rod. --clearance gives the effect of play in the joints on stroke and phase.\n\n"
      "Exit status: 0 done, 2 bad input or usage, or no such mechanism.");
  command->callback([a, &action] {
    action = [a] {
      if (!a->vehicle.empty()) a->vehicle = find_input(a->vehicle, InputKind::vehicle).string();
      return run(*a);
    };
  });
}

}  // namespace wingbeat::app
