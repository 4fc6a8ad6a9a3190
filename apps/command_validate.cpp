// wingbeat validate [NAME...]: measured sets of vehicles that others made, beside what the model says of them.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "options.hpp"
#include "plot_option.hpp"
#include "progress.hpp"
#include "wingbeat/files/measured_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/report/validation_report.hpp"
#include "wingbeat/run/parallel.hpp"

namespace wingbeat::app {
namespace {

struct ValidateArguments {
  std::vector<std::string> names;
  std::string plot, plot_width;
  int threads = 0;
  bool all = false, json = false, force = false;
};

int run(const ValidateArguments& a) {
  const auto format = asked_format("--plot", a.plot, a.plot_width);
  if (a.all && !a.names.empty()) throw InputError("validate", 0, 0, "", "give names or --all, not both");
  if (format && a.names.size() != 1) throw InputError("--plot", 0, 0, "", "belongs to one measured set");
  const bool list = a.names.empty() && !a.all;
  std::vector<std::string> names = a.names.empty() ? shipped_names(InputKind::measured) : a.names;
  if (names.empty()) throw InputError("validate", 0, 0, "", "no measured files come with this program; name one");
  std::vector<ValidationSet> sets;
  for (const std::string& name : names) sets.push_back(read_measured(find_input(name, InputKind::measured)));
  if (list) {
    print(a.json ? json_validation(sets, {}) : text_validation_list(sets));
    return done;
  }
  std::optional<OutputFile> plot;
  if (format) plot.emplace("--plot", a.plot, OutputRules{plot_extensions, a.force});

  const ForEach for_each = [&](std::size_t count, const std::function<void(std::size_t)>& act) {
    for_each_in_parallel(count, act, a.threads);
  };
  std::vector<ValidationResult> results;
  for (const ValidationSet& set : sets) {
    ProgressLine line(set.name + ": ");
    try {
      results.push_back(validate_set(set, line.shower(), for_each));
    } catch (const ParameterError& error) {
      throw InputError(set.name, 0, 0, error.key(), error.reason());
    }
    line.clear();
    if (!a.json) print((results.size() > 1 ? "\n" : "") + text_validation(set, results.back()));
  }
  if (a.json) print(json_validation(sets, results));
  else if (sets.size() > 1) print("\n" + text_validation_summary(sets, results));
  if (plot) {
    plot_validation(sets.front(), results.front(), *format, plot->temporary());
    plot->commit();
  }
  return done;
}

}  // namespace

void add_validate(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("validate", "Compare the model with measured vehicles of others");
  const auto a = std::make_shared<ValidateArguments>();
  Values names;
  names.shipped = InputKind::measured;
  names.extensions = {".toml"};
  takes(command
            ->add_option("names", a->names,
                         "Measured files (TOML), or names of those that come with the program; without one they are "
                         "listed")
            ->type_name("NAME"),
        std::move(names));
  command->add_flag("--all", a->all, "Every measured set that comes with the program");
  add_json(command, a->json);
  add_threads(command, a->threads);
  add_file(command, "--plot", a->plot, plot_extensions, "Plot the differences of one set to FILE.svg, .pdf or .png");
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  command->footer(
      "Example:\n  wingbeat validate gammabot-thrust\n\n"
      "Each set is computed with nothing fitted, with one parameter fitted, and with all that a fit may change.\n"
      "A rule in the file chooses the rows for fits; the others are predicted.\n\n"
      "Exit status: 0 done, 1 something failed, 2 bad input or usage.");
  command->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace wingbeat::app
