// wingbeat keys, metrics, schema and new: what may stand in a vehicle file, what comes out, and a file to start from.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

#include "command.hpp"
#include "options.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/report/reference.hpp"
#include "wingbeat/reproduction/schema.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat::app {
namespace {

struct ReferenceArguments {
  std::string filter;
  bool json = false;
};

int show(const ReferenceArguments& a, std::string (*text)(const std::string&), std::string (*json)(const std::string&),
         const char* what, const std::vector<std::string_view>& names) {
  if (text(a.filter).empty()) {
    const std::string_view near = nearest_name(a.filter, names);
    throw InputError(in_quotes(a.filter), 0, 0, "",
                     near.empty()
                         ? fmt::format("no {} has this in its name, unit or meaning", what)
                         : fmt::format("no {} has this in its name, unit or meaning; did you mean {}?", what, near));
  }
  print(a.json ? json(a.filter) : text(a.filter));
  return done;
}

struct NewArguments {
  std::string file = "vehicle.toml";
  std::string transmission = name_of(TransmissionType{});
};

int write_new(const NewArguments& a) {
  const auto type = from_name<TransmissionType>(a.transmission);
  if (!type) {
    throw InputError("--transmission", 0, 0, "",
                     fmt::format("must be {}, got {}", listed_names<TransmissionType>(), in_quotes(a.transmission)));
  }
  if (a.file == "-") {
    print(starting_vehicle(*type, "new vehicle"));
    return done;
  }
  std::filesystem::path file(a.file);
  if (file.extension().empty()) file += ".toml";
  if (file.extension() != ".toml") throw InputError(one_line(a.file), 0, 0, "", "the name must end in .toml");
  std::error_code error;
  if (std::filesystem::exists(std::filesystem::symlink_status(file, error))) {
    throw InputError(one_line(file.string()), 0, 0, "", "is there already and is never overwritten; give another name");
  }
  OutputFile output("new", file, {".toml", false});
  output.write(starting_vehicle(*type, file.stem().string()));
  output.commit();
  return done;
}

}  // namespace

void add_keys(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("keys", "List the keys of vehicle files: unit, range, default, meaning");
  const auto a = std::make_shared<ReferenceArguments>();
  takes(
      command->add_option("filter", a->filter, "Only keys with this in their name, unit or meaning")->type_name("WORD"),
      key_choices(""));
  add_json(command, a->json);
  command->footer("Example:\n  wingbeat keys torque");
  command->callback([a, &action] {
    action = [a] {
      std::vector<std::string_view> names;
      for (const auto& key : parameter_table<double>()) names.push_back(key.path);
      return show(*a, text_keys, json_keys, "key", names);
    };
  });
}

void add_metrics(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("metrics", "List the metrics of a run: name, unit, meaning");
  const auto a = std::make_shared<ReferenceArguments>();
  takes(command->add_option("filter", a->filter, "Only metrics with this in their name, unit or meaning")
            ->type_name("WORD"),
        metric_choices());
  add_json(command, a->json);
  command->footer("Example:\n  wingbeat metrics power");
  command->callback([a, &action] {
    action = [a] {
      std::vector<std::string_view> names;
      for (const MetricInfo& metric : metric_table()) names.push_back(metric.key);
      return show(*a, text_metrics, json_metrics, "metric", names);
    };
  });
}

void add_schema(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("schema", "Print the JSON Schema of what a command's --json prints");
  const auto schema_name = std::make_shared<std::string>("run");
  Values values;
  for (const std::string_view name : schema_commands()) values.choices.push_back({std::string(name)});
  takes(command->add_option("command", *schema_name, "The command (default run)")->type_name("COMMAND"),
        std::move(values));
  command->footer("Example:\n  wingbeat schema run");
  command->callback([schema_name, &action] {
    action = [schema_name] {
      const std::string schema = json_schema(*schema_name);
      if (schema.empty()) {
        const std::string_view near = nearest_name(*schema_name, schema_commands());
        throw InputError(in_quotes(*schema_name), 0, 0, "",
                         near.empty() ? "no command with --json has this name"
                                      : fmt::format("no command with --json has this name; did you mean {}?", near));
      }
      print(schema);
      return done;
    };
  });
}

void add_new(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("new", "Write a vehicle file to start from, every key explained");
  const auto a = std::make_shared<NewArguments>();
  add_file(command, "file", a->file, ".toml",
           "NAME or NAME.toml (default vehicle.toml), never overwritten; - for standard output");
  std::string types(listed_names<TransmissionType>());
  types.insert(types.find(a->transmission) + a->transmission.size(), " (default)");
  add_choice<TransmissionType>(command, "--transmission", a->transmission, types, "TYPE");
  command->footer("Example:\n  wingbeat new flapper.toml");
  command->callback([a, &action] { action = [a] { return write_new(*a); }; });
}

}  // namespace wingbeat::app
