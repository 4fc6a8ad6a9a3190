#include "wingbeat/files/input_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <system_error>
#include <utility>

#include "files/read_stream.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace fs = std::filesystem;

namespace {

struct Shelf {
  const char* folder;  ///< of the data
  const char* what;    ///< "a design", for messages
  const char* plural;
};

Shelf shelf_of(InputKind kind) {
  switch (kind) {
    case InputKind::vehicle: return {"designs", "design", "designs"};
    case InputKind::study: return {"studies", "study", "studies"};
    case InputKind::bench: return {"bench", "bench file", "bench files"};
    case InputKind::datasheet: return {"motors", "data sheet", "data sheets"};
    case InputKind::published: return {"published", "file of published values", "files of published values"};
    case InputKind::measured: return {"measured", "measured file", "measured files"};
  }
  return {};
}

bool is_readable_file(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error) && !fs::is_directory(file, error);
}

}  // namespace

const std::string& standard_input() {
  static const std::string text = [] {
    constexpr std::size_t largest = largest_study;  // whoever reads it may know a lower one
    std::string all = detail::read_stream(std::cin, largest);
    if (std::cin.bad()) throw InputError("standard input", 0, 0, "", "cannot be read");
    if (all.size() > largest) {
      throw InputError("standard input", 0, 0, "",
                       fmt::format("larger than {} MB, which no input file is", largest >> 20));
    }
    return all;
  }();
  return text;
}

namespace {

fs::path& stated_data() {
  static fs::path folder;
  return folder;
}

}  // namespace

void set_shipped_data(fs::path folder) { stated_data() = std::move(folder); }

fs::path shipped_data() {
  if (!stated_data().empty()) return stated_data();
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  // Installed: beside the folder of the programs. In the build folder: a link to the sources' data.
  for (const fs::path& folder : {program.parent_path().parent_path(), program.parent_path()}) {
    const fs::path data = folder / "share" / "wingbeat";
    if (fs::is_directory(data / "designs", error)) return data;
  }
  return {};
}

std::vector<std::string> shipped_names(InputKind kind) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(shipped_data() / shelf_of(kind).folder, error)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

fs::path find_input(const std::string& argument, InputKind kind) {
  if (argument == "-") return argument;
  const Shelf shelf = shelf_of(kind);
  const bool control = argument.find('\0') != std::string::npos;
  if (argument.empty() || control) throw InputError(in_quotes(argument), 0, 0, "", "not a file name");
  const fs::path given(argument);
  std::error_code error;
  if (fs::exists(given, error) || error) return given;  // a folder and the like are refused by whoever reads
  const bool named = !given.has_parent_path();
  const bool with_extension = given.extension() == ".toml";
  if (!with_extension && is_readable_file(argument + ".toml")) return argument + ".toml";
  if (!named) return given;
  const std::string stem = with_extension ? given.stem().string() : argument;
  const std::vector<std::string> names = shipped_names(kind);
  if (std::find(names.begin(), names.end(), stem) != names.end()) {
    return fs::canonical(shipped_data() / shelf.folder / (stem + ".toml"), error);
  }
  if (given.has_extension() && !with_extension) return given;
  const std::vector<std::string_view> known(names.begin(), names.end());
  std::string near(nearest_name(stem, known));
  for (const std::string& name : names) {
    if (near.empty() && stem.size() >= 3 && name.find(stem) != std::string::npos) near = name;
  }
  throw InputError(one_line(argument), 0, 0, "",
                   names.empty() ? "no such file"
                   : near.empty()
                       ? fmt::format("no such file, and no {} of that name comes with the program; its {} are {}",
                                     shelf.what, shelf.plural, fmt::join(names, ", "))
                       : fmt::format("no such file, and no {} of that name comes with the program; did you mean {}?",
                                     shelf.what, near));
}

fs::path find_vehicle(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const fs::path beside = folder / name;
  if (fs::exists(beside, error) || fs::path(name).has_parent_path()) return beside;
  const std::string stem = fs::path(name).extension() == ".toml" ? fs::path(name).stem().string() : name;
  const std::vector<std::string> names = shipped_names(InputKind::vehicle);
  const bool ours = std::find(names.begin(), names.end(), stem) != names.end();
  return ours ? fs::canonical(shipped_data() / "designs" / (stem + ".toml"), error) : beside;
}

bool is_there(const fs::path& file) {
  std::error_code cannot_be;
  return fs::exists(file, cannot_be);
}

std::string input_name(const fs::path& file) { return file == "-" ? "standard input" : file.string(); }

std::string written_name(const fs::path& file) { return input_name(file == "-" ? file : file.filename()); }

}  // namespace wingbeat
