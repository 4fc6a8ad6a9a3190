// wingbeat sweep STUDY: the steady flapping of many vehicles, into one data set.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "command.hpp"
#include "options.hpp"
#include "plot_option.hpp"
#include "progress.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/files/written_files.hpp"
#include "wingbeat/report/plot.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/report/sweep_plot.hpp"
#include "wingbeat/run/sweep_run.hpp"
#include "wingbeat/run/sweep_summary.hpp"

namespace wingbeat::app {
namespace {

const char* unreached_meaning(const Sweep& sweep) {
  if (sweep.hold && is_lift(sweep.hold->held)) return "flapping, but not at the requested lift";
  if (sweep.hold && sweep.hold->held == Held::power) return "flapping, but not at the requested power";
  return "flapping, but not at the requested frequency";
}

struct SweepArguments {
  std::vector<std::string> overrides;
  std::string study, output;
  std::string tolerance, isa;
  int threads = 0;
  bool force = false;
  bool allow_extrapolation = false;
  bool json = false;
  std::string plot, plot_width;
  std::vector<std::string> plot_metrics;
};

volatile std::sig_atomic_t interrupted = 0;

void on_signal(int signal) {
  if (interrupted) remove_temporaries_and_end(signal);
  interrupted = 1;
}

/// The first signal ends the sweep after the chunks under way, the second at once.
void catch_signals() {
  struct sigaction action{};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM}) ::sigaction(signal, &action, nullptr);
}

std::string duration(double seconds) {
  if (seconds < 0.0995) return fmt::format("{:.0f} ms", 1e3 * seconds);
  if (seconds < 100.0) return fmt::format("{:.1f} s", seconds);
  const long s = std::lround(seconds);
  if (s < 6000) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s / 60 % 60);
}

std::string grouped(std::uint64_t n) {
  std::string text = fmt::format("{}", n);
  for (std::size_t position = text.size(); position > 3;) text.insert(position -= 3, 1, ',');
  return text;
}

/// Designs per second with three digits.
std::string rate(double designs, double seconds) {
  const double r = designs / std::max(seconds, 1e-9);
  const double unit = std::pow(10.0, std::max(0.0, std::floor(std::log10(std::max(r, 1.0))) - 2.0));
  return grouped(std::uint64_t(std::llround(r / unit) * std::llround(unit)));
}

std::string progress_text(const SweepProgress& p) {
  const double left = double(p.designs - p.done) * p.seconds / double(std::max<std::uint64_t>(p.computed, 1));
  return fmt::format("{}  {} designs/s  {} left ", progress_bar(double(p.done) / double(p.designs)),
                     rate(double(p.computed), p.seconds), duration(left));
}

/// The swept values of one design: "transmission_crank_radius 5.000 mm, springs on".
std::string description(const Sweep& sweep, std::uint64_t index) {
  const auto place = places(sweep, index);
  std::string text;
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    const SweepAxis& axis = sweep.axes[a];
    for (std::size_t q = 0; q < axis.quantities.size(); ++q) {
      const SweptQuantity& quantity = axis.quantities[q];
      text += fmt::format("{}{} ", text.empty() ? "" : ", ", quantity.key);
      if (quantity.kind == SweptQuantity::Kind::choice) {
        text += quantity.labels[place[a]];
      } else {
        const double x = axis.value(q, place[a]);
        const bool prefixed = quantity.unit == "m" || quantity.unit == "V" || quantity.unit == "Hz";
        text += prefixed               ? readable(x, quantity.unit)
                : quantity.unit == "1" ? fmt::format("{:.4g}", x)
                                       : fmt::format("{:.4g} {}", x, quantity.unit);
      }
    }
  }
  return text;
}

std::string summary(const Study& study, const SweepResult& result) {
  const SweepDigest& digest = result.digest;
  const Sweep& sweep = study.sweep;
  std::string text;
  auto out = std::back_inserter(text);
  if (!study.title.empty()) fmt::format_to(out, "{}\n", wrapped(study.title, 88, 0));
  fmt::format_to(out, "{} designs", grouped(sweep.size()));
  if (sweep.axes.size() > 1) {
    std::string shape;
    for (const SweepAxis& axis : sweep.axes) shape += fmt::format("{}{}", shape.empty() ? "" : " x ", axis.count);
    fmt::format_to(out, " ({})", shape);
  }
  const SweepProgress& p = result.progress;
  if (result.resumed > 0) fmt::format_to(out, ", {} of them from before", grouped(result.resumed));
  if (p.computed > 0) {
    fmt::format_to(out, "; {} computed in {}, {} designs/s", grouped(p.computed), duration(p.seconds),
                   rate(double(p.computed), p.seconds));
  }
  text += '\n';
  const char* const meanings[sweep_status_count] = {"",
                                                    "the motor never starts",
                                                    "the crank comes to rest",
                                                    "the equations of motion lose their unique solution on the way",
                                                    unreached_meaning(sweep),
                                                    "a parameter out of its range for the other parameters",
                                                    "start-up came to no end within the solvers' limits"};
  for (int s = 0; s < sweep_status_count; ++s) {
    const std::uint64_t n = digest.designs[std::size_t(s)];
    if (n == 0 && s > 0) continue;
    fmt::format_to(out, "  {:<12}{:>14}{:>9.2f} %   {}\n", name_of(SweepStatus(s)), grouped(n),
                   100.0 * double(n) / double(sweep.size()), meanings[s]);
    while (text[text.size() - 2] == ' ') text.erase(text.size() - 2, 1);
  }
  fmt::format_to(out, "  {:<12}{:>14}{:>9.2f} %   by the scalar solver\n", "recomputed", grouped(digest.recomputed),
                 100.0 * double(digest.recomputed) / double(sweep.size()));
  if (digest.outside > 0) {
    std::string limits;
    for (std::size_t k = 0; k < digest.beyond.size(); ++k) {
      if (digest.beyond[k] == 0) continue;
      limits +=
          fmt::format("{}{} {}", limits.empty() ? "" : ", ", grouped(digest.beyond[k]), domain_limit_table()[k].key);
    }
    fmt::format_to(out, "  {:<12}{:>14}{:>9.2f} %   flapping outside the model's domain ({})\n", "outside",
                   grouped(digest.outside), 100.0 * double(digest.outside) / double(sweep.size()), limits);
    if (sweep.allow_extrapolation)
      fmt::format_to(out, "extrapolation is allowed: designs outside the domain may be best\n");
  }
  const auto best = [&](const char* what, const SweepBest& b, const auto& value) {
    if (!b.design()) return;
    fmt::format_to(
        out, "{}\n",
        wrapped(fmt::format("{}: {}, {}{}", what, value(b.design()->value), description(sweep, b.design()->index),
                            b.carries_weight() ? " (of those that carry their weight)" : ""),
                88, 2));
  };
  best("maximum mean lift", digest.lift, [](double lift) { return readable(lift, "N"); });
  best("least electrical power", digest.power, [](double power) { return readable(power, "W"); });
  best("maximum efficiency", digest.efficiency, [](double share) { return fmt::format("{:.2f} %", 100.0 * share); });
  return text;
}

/// "sse2, avx2 or avx512"
std::string known_instruction_sets() {
  std::string names;
  for (std::size_t n = 0; n < std::size(instruction_sets); ++n) {
    names += n == 0 ? "" : n + 1 < std::size(instruction_sets) ? ", " : " or ";
    names += instruction_sets[n].first;
  }
  return names;
}

Study study_of(const SweepArguments& arguments) {
  const bool data_set = std::filesystem::path(arguments.study).extension() == ".nc";
  if (data_set && !arguments.overrides.empty()) {
    throw InputError("--set", 0, 0, "",
                     "a data set of an earlier sweep is computed again as it is; give its study file");
  }
  Study study = data_set ? read_study_in_data_set(arguments.study) : read_study(arguments.study, arguments.overrides);
  study.sweep.allow_extrapolation |= arguments.allow_extrapolation;
  EnsembleOptions& options = study.sweep.options;
  if (!arguments.tolerance.empty()) {
    try {
      options.tolerance = parse_quantity(arguments.tolerance, "1");
    } catch (const UnitError&) {
      options.tolerance = absent;
    }
    if (!(options.tolerance >= 1e-12 && options.tolerance <= 1e-2)) {
      throw InputError("--tolerance " + arguments.tolerance, 0, 0, "", "must be a number between 1e-12 and 1e-2");
    }
  }
  if (!arguments.isa.empty()) {
    const auto known = std::find_if(std::begin(instruction_sets), std::end(instruction_sets),
                                    [&](const auto& entry) { return entry.first == arguments.isa; });
    const std::string option = "--isa " + arguments.isa;
    if (known == std::end(instruction_sets)) throw InputError(option, 0, 0, "", "must be " + known_instruction_sets());
    if (!is_available(known->second)) throw InputError(option, 0, 0, "", "this processor cannot run it");
    options.isa = known->second;
  }
  return study;
}

int sweep_on_rank_0(const SweepArguments& arguments, Ranks* ranks) {
  SweepRunOptions options;
  options.output = arguments.output;
  options.version = version;
  options.threads = arguments.threads;
  options.ranks = ranks;
  options.force = arguments.force;
  options.stop = [] { return interrupted != 0; };
  ProgressLine line("");
  if (line.on_terminal()) options.progress = [&](const SweepProgress& p) { line.show(progress_text(p)); };

  const Study study = study_of(arguments);
  if (options.output.extension() != ".nc") {
    throw InputError("-o " + arguments.output, 0, 0, "", "the name must end in .nc");
  }
  std::vector<Metric> drawn;
  std::optional<OutputFile> plot;
  const auto format = asked_format("--plot", arguments.plot, arguments.plot_width, true);
  if (!arguments.plot.empty()) {
    const std::string option = "--plot " + arguments.plot;
    drawn = metrics_to_plot(study, arguments.plot_metrics, option);
    plot.emplace("--plot", arguments.plot, OutputRules{page_extensions, arguments.force});
  }
  const SweepResult result = run_sweep(study, options);
  line.clear();
  if (result.outcome == SweepResult::Outcome::stopped) {
    complain(fmt::format("stopped after {} of {} designs; they are kept in {}, and the same command resumes",
                         grouped(result.progress.done), grouped(result.progress.designs),
                         unfinished_file(options.output).string()));
    return failed;
  }
  std::string text = summary(study, result);
  const bool was_there = result.outcome == SweepResult::Outcome::was_finished;
  if (was_there) text += fmt::format("{} holds this sweep already: nothing to compute\n", arguments.output);
  else note_written(arguments.output);
  if (plot) {
    plot_sweep(study, options.output, drawn, *format, plot->temporary());
    plot->commit();
  }
  print(arguments.json ? json_sweep(study, result, arguments.output, arguments.plot) : text);
  return done;
}

int sweep(const SweepArguments& arguments) {
  catch_signals();
  const std::unique_ptr<Ranks> ranks = Ranks::join();
  if (!ranks || ranks->rank() == 0) {
    const SweepRelease release(ranks.get());
    return sweep_on_rank_0(arguments, ranks.get());
  }
  try {
    serve_sweep(*ranks, arguments.threads);
    return done;
  } catch (const std::exception& error) {
    complain(fmt::format("rank {}: {}", ranks->rank(), error.what()));
    ranks->abort();
  }
}

}  // namespace

void add_sweep(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("sweep", "Compute very many vehicles into one data set");
  const auto a = std::make_shared<SweepArguments>();
  CLI::Option* study = add_input(command, a->study, InputKind::study, "study",
                                 "Study file (TOML), or a data set of an earlier sweep (.nc)", "STUDY");
  Values readable = taken_by(study);
  readable.extensions.push_back(".nc");
  takes(study, std::move(readable));
  add_set(command, a->overrides);
  add_file(command, "-o,--output", a->output, ".nc", "Data set to be written (NetCDF-4)", "FILE.nc")->required();
  command->add_option("--tolerance", a->tolerance, "Relative accuracy of every metric, instead of the study's")
      ->type_name("NUMBER");
  command->add_flag("--allow-extrapolation", a->allow_extrapolation,
                    "Designs outside the model's domain may be best (docs/domain.md)");
  add_json(command, a->json);
  add_threads(command, a->threads);
  Values sets;
  for (const auto& [name, set] : instruction_sets) sets.choices.push_back({std::string(name)});
  takes(command->add_option("--isa", a->isa, "Instructions: sse2, avx2 or avx512 (default: the widest there is)")
            ->type_name("NAME"),
        std::move(sets));
  CLI::Option* plot =
      add_file(command, "--plot", a->plot, page_extensions,
               "Draw lines over one axis, contours over two, to FILE.svg, .pdf or .png, or to FILE.html, "
               "which shows the numbers of each design");
  takes(command
            ->add_option("--plot-metric", a->plot_metrics,
                         "What to draw, as lift_mean_n,frequency_hz (default: mean lift and system efficiency)")
            ->delimiter(',')
            ->needs(plot)
            ->type_name("METRIC,..."),
        metric_choices());
  command->add_option("--plot-metrics", a->plot_metrics)->delimiter(',')->needs(plot)->group("");  // the old spelling
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  command->footer(
      "Example:\n"
      "  wingbeat sweep crank-radius -o crank-radius.nc --plot crank-radius.svg\n\n"
      "Study files: docs/sweep.md. Stopped by Ctrl-C, or killed, the same command resumes. On several machines:\n"
      "  mpirun -n 8 wingbeat sweep STUDY.toml -o FILE.nc\n\n"
      "Exit status: 0 done, 2 bad input or usage, 1 anything else, a sweep that was stopped included.");
  command->callback([a, &action] {
    action = [a] {
      a->study = find_input(a->study, InputKind::study).string();
      return sweep(*a);
    };
  });
}

}  // namespace wingbeat::app
