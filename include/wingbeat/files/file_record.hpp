// Which files a command has read and which it writes, so that the two never meet.
//
// The one rule for every output: readers record what they read, checked_output() refuses that as an output, and without
// --force also what the program did not write itself. A new reader calls FileRecord::add_read() unless it uses
// read_text_file(); a new output is an OutputFile, made before anything is computed.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wingbeat {

/// The files that this program has read and those that it will write, known by device and inode as well as by name, so
/// that links, hard links and relative paths count. Every reader of files reports here, whatever asked for the file.
class FileRecord {
 public:
  static FileRecord& of_this_program();

  void add_read(const std::filesystem::path& file);
  /// The name under which the file at `path` was read, or nothing.
  std::optional<std::string> name_read(const std::filesystem::path& path) const;

  /// Enters an output. The option under which the same file was entered before, or nothing; then it is entered.
  std::optional<std::string> add_output(const std::filesystem::path& target, const std::string& option);
  /// The output has replaced what was there.
  void written(const std::filesystem::path& target);
  /// The output will not be written.
  void withdraw(const std::filesystem::path& target);

  /// A file that has another name until it is complete, and a message in which it is called as the user calls it.
  void add_temporary(const std::filesystem::path& temporary, const std::string& shown);
  std::string with_given_names(std::string message) const;

  /// For a program that runs several commands one after another.
  void clear();

 private:
  struct Entry {
    std::filesystem::path path;  ///< absolute, links followed
    std::string shown;           ///< the name as it was given, or the option
    std::optional<std::pair<dev_t, ino_t>> identity;
  };
  static Entry entry_of(const std::filesystem::path& file, const std::string& shown);
  static const Entry* find(const std::vector<Entry>& entries, const Entry& wanted);

  mutable std::mutex mutex_;
  std::vector<Entry> read_, outputs_;
  std::vector<std::pair<std::string, std::string>> temporaries_;
};

/// How an output may be written.
struct OutputRules {
  std::string_view extensions = "";  ///< ".svg .pdf .png": the name must end in one of them; empty: any name
  bool force = false;                ///< replaces a file that the program did not write
};

/// Where an output goes, symbolic links followed, dangling ones too. The one rule for every file that is written: it is
/// none that was read, its name says what it holds, and a file that the program did not write is replaced only with
/// `force`. `option` is what the path was given for ("--plot"). Throws InputError.
std::filesystem::path checked_output(const std::string& option, const std::filesystem::path& path,
                                     const OutputRules& rules);

/// The first part of that rule alone, for a file that stands beside an output.
void check_not_read(const std::string& option, const std::filesystem::path& path, const std::filesystem::path& target);

/// The file a path leads to, symbolic links followed whether or not there is one. Throws InputError for a loop.
std::filesystem::path followed(const std::string& option, const std::filesystem::path& path);

/// True if the file says that the program wrote it: in its first lines, its metadata or its columns. So does an empty
/// file, with which nothing is lost.
bool written_by_wingbeat(const std::filesystem::path& file);

/// Enters that into a drawing (SVG, PDF or PNG by the file's extension), which the program that drew it did not. Throws
/// std::runtime_error that begins with `shown` where it cannot be stored.
void mark_drawing(const std::filesystem::path& file, const std::string& shown);

}  // namespace wingbeat
