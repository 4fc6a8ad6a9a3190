// Content that is on the disk as a whole, or an error.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace wingbeat {

/// Makes `content` the content of a file, made where there is none. Throws std::runtime_error that begins with `shown`,
/// or the path where that is empty, if not all of it can be stored.
void store(const std::filesystem::path& file, std::string_view content, const std::string& shown = {});

/// Has the system keep what was written: errors of a full disk that it has not reported by now.
void settle(const std::filesystem::path& file, const std::string& shown = {});

/// What is missing at the end of a file by its extension, "its end, </svg>": of formats that mark their end (SVG, PDF,
/// PNG, HTML, NetCDF-4, MAT, FMU). Nothing for a complete file and for other formats.
std::optional<std::string> missing_end(const std::filesystem::path& file);
/// What is missing at the end of content in memory; NetCDF-4 can be asked for by its file alone.
std::optional<std::string> missing_end(std::string_view content, std::string_view extension);

}  // namespace wingbeat
