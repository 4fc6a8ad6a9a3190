// A file that appears under its name only when it is complete.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "wingbeat/files/file_record.hpp"
#include "wingbeat/files/temporary_files.hpp"

namespace wingbeat {

/// Reserves a place for an output file at once, so that a path that cannot be written, or must not be, is refused
/// before any computing, and gives it its name in commit(), once it is known to be complete and on the disk. Without
/// commit() nothing is left behind and an existing file stays as it was; what processes that were killed have left in
/// the folder goes.
class OutputFile {
 public:
  /// `option` is what the path was given for ("--plot"). Throws InputError if no file can be written there, if the
  /// rules of checked_output() forbid it, and if another output of this program has the same name.
  OutputFile(std::string option, const std::filesystem::path& path, const OutputRules& rules);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// Where the content goes until commit().
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Throws std::runtime_error, as commit() does, if the content cannot be stored.
  void write(std::string_view content);
  void commit();

 private:
  std::string option_;
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  std::optional<mode_t> mode_;              ///< of the file that is replaced
  std::optional<std::uintmax_t> expected_;  ///< size of what write() has written
  TemporaryFile* remembered_ = nullptr;
  bool committed_ = false;
};

}  // namespace wingbeat
