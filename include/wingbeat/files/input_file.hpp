// Input files as they are named on the command line: a path, "-" for standard input, or the name of a file that comes
// with the program.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "wingbeat/core/names.hpp"

namespace wingbeat {

/// What a file is expected to hold: where a file of that name is looked for among the program's own.
enum class InputKind { vehicle, study, bench, datasheet, published, measured };
template <>
inline constexpr std::pair<const char*, InputKind> names_of<InputKind>[] = {
    {"vehicle", InputKind::vehicle},     {"study", InputKind::study},         {"bench", InputKind::bench},
    {"datasheet", InputKind::datasheet}, {"published", InputKind::published}, {"measured", InputKind::measured}};

/// The file that `argument` names: "-", a file that exists, the same with ".toml", or, for a name without a folder, the
/// file that comes with the program ("friction2022": designs/friction2022.toml). Throws InputError, with the names that
/// are near, where there is none.
std::filesystem::path find_input(const std::string& argument, InputKind kind);

/// The vehicle file that a file in `folder` names: beside it, or one that comes with the program. It need not exist.
std::filesystem::path find_vehicle(const std::filesystem::path& folder, const std::string& name);

/// Whether there is a file of that name; not where no file can have it, such as one that is too long.
bool is_there(const std::filesystem::path& file);

/// The folder of the data that come with the program, found from where the program is; empty where there is none.
std::filesystem::path shipped_data();

/// Makes that another folder, for users of the library that have the data elsewhere. Not while other threads read
/// files.
void set_shipped_data(std::filesystem::path folder);

/// The names of the files of that kind that come with the program, sorted.
std::vector<std::string> shipped_names(InputKind kind);

/// The name of an input file in messages: "standard input" for "-".
std::string input_name(const std::filesystem::path& file);

/// The name of an input file in what is written, without the folder, which belongs to this machine only.
std::string written_name(const std::filesystem::path& file);

/// What standard input holds, up to the largest file that anything reads. It is read once; whoever asks again gets the
/// same text.
const std::string& standard_input();

}  // namespace wingbeat
