// wingbeat reproduce PAPER: a paper's figures and statements, remade and judged.
#include <fmt/format.h>
#include <unistd.h>

#include <memory>

#include "command.hpp"
#include "wingbeat/io/claims.hpp"
#include "wingbeat/io/optimise_file.hpp"

namespace wingbeat::app {
namespace {

struct Arguments {
  std::string paper, output;
  bool coarse = false, json = false;
  int threads = 0;
};

int run(const Arguments& arguments) {
  const ForEach for_each = [&](std::size_t count, const std::function<void(std::size_t)>& act) {
    for_each_in_parallel(count, act, arguments.threads);
  };
  const PublishedFile file = read_published("data/published/friction2022.toml");
  const Judgement j = judge(file, for_each);
  print(arguments.json ? json_claims(file, j) : text_claims(file, j));
  return done;
}

}  // namespace

void add_reproduce(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("reproduce", "Remake a paper's figures and judge its statements");
  const auto a = std::make_shared<Arguments>();
  command->add_option("paper", a->paper, "Which paper: friction2022")->required()->type_name("PAPER");
  command->add_flag("--json", a->json, "Print one JSON object instead of a table");
  command->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace wingbeat::app
