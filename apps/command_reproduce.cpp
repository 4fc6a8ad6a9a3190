// wingbeat reproduce PAPER: a paper's figures and statements, reproduced and assessed.
#include <fmt/format.h>

#include <memory>

#include "command.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/files/written_files.hpp"
#include "wingbeat/reproduction/claims.hpp"
#include "wingbeat/reproduction/reproduce.hpp"
#include "wingbeat/run/parallel.hpp"

namespace wingbeat::app {
namespace {

struct ReproduceArguments {
  std::string paper, output;
  bool coarse = false, json = false, force = false;
  int threads = 0;
};

int run(const ReproduceArguments& arguments) {
  const KnownPaper& paper = known_paper(arguments.paper);
  ReproduceOptions options;
  options.output = arguments.output;
  options.coarse = arguments.coarse;
  options.force = arguments.force;
  options.version = version;
  options.for_each = [&](std::size_t count, const std::function<void(std::size_t)>& act) {
    for_each_in_parallel(count, act, arguments.threads);
  };
  ProgressLine line("");
  if (line.on_terminal()) {
    options.progress = [&](double share, const std::string& what) {
      line.show(fmt::format("{}  {} ", progress_bar(share), what));
    };
  }
  const ReproduceResult result = reproduce_paper(paper, options);
  line.clear();
  take_written();  // the folder stands for its files, and the text names it
  if (arguments.json) {
    note_written(arguments.output);
    print(json_claims(result.file, result.assessment));
  } else {
    print(text_claims(result.file, result.assessment) + fmt::format("{} figures written to {}; open {}\n",
                                                                    result.figures, arguments.output,
                                                                    (options.output / "report.html").string()));
  }
  return done;
}

}  // namespace

void add_reproduce(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("reproduce", "Reproduce a paper's figures and assess its statements");
  const auto a = std::make_shared<ReproduceArguments>();
  Values papers;
  for (const KnownPaper& paper : known_papers()) papers.choices.push_back({std::string(paper.name)});
  takes(command->add_option("paper", a->paper, "Which paper: friction2022")->required()->type_name("PAPER"),
        std::move(papers));
  add_folder(command, "-o,--output", a->output, "Folder to be written: new, empty, or of an earlier reproduction",
             "DIR")
      ->required();
  command->add_flag("--coarse", a->coarse, "Few points on each curve: a check in seconds; the assessment is the same");
  command->add_flag("--json", a->json, "Print the assessment as one JSON object instead of a table");
  add_threads(command, a->threads);
  add_force(*command, a->force);
  command->footer(
      "Example:\n"
      "  wingbeat reproduce friction2022 -o friction2022-reproduced\n\n"
      "Writes every figure as SVG and PDF, its data as CSV and NetCDF, the assessed statements as CSV and JSON, and\n"
      "report.html, which shows and explains all of it (docs/reproduce.md).\n\n"
      "Exit status: 0 done, whatever the outcomes, 2 bad input or usage, 1 anything else.");
  command->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace wingbeat::app
