// Reads the whole text of an input.
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "files/read_stream.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/file_record.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat {

std::string read_text_file(const std::filesystem::path& file, std::size_t largest) {
  if (file == "-") return standard_input();
  const std::string name = file.string();
  const auto refuse = [&](const std::string& message) { throw InputError(name, 0, 0, "", message); };
  if (name.find('\0') != std::string::npos) throw InputError(one_line(name), 0, 0, "", "not a file name");
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) {
    const bool missing = !error || error == std::errc::no_such_file_or_directory;
    refuse(missing ? "no such file" : "cannot be read: " + error.message());
  }
  if (std::filesystem::is_directory(status)) refuse("is a directory, not a file");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse(fmt::format("cannot be read: {}", std::strerror(errno)));
  std::string text = detail::read_stream(stream, largest);
  if (stream.bad()) refuse("cannot be read");
  if (text.size() > largest) {
    refuse(fmt::format("larger than {} MB, which no {} is", largest >> 20,
                       largest == largest_text ? "vehicle file or table" : "study file"));
  }
  FileRecord::of_this_program().add_read(file);
  return text;
}

}  // namespace wingbeat
