// ZIP archives, by libzip.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace wingbeat {

/// Writes an archive of these files, each a path within it ("resources/vehicle.bin") with its content. The same content
/// gives the same bytes. Throws std::runtime_error.
void write_zip(const std::filesystem::path& file, const std::vector<std::pair<std::string, std::string>>& content);

/// The files of an archive, as write_zip() takes them; without its folders. Throws std::runtime_error.
std::vector<std::pair<std::string, std::string>> read_zip(const std::filesystem::path& file);

}  // namespace wingbeat
