// Vehicle files: TOML in, a validated Design out, and back. For the keys see vehicle/parameters.hpp and
// docs/vehicle-file.md.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

/// Input that cannot be used. what() is one sentence that says where, which key and what was expected:
/// `friction2022.toml:17:1: motor.torque_constan: unknown key; did you mean motor.torque_constant?`
class InputError : public std::runtime_error {
 public:
  /// Line and column count from 1; line 0: the input as a whole. `file` and `key` may be empty.
  InputError(std::string file, int line, int column, std::string key, const std::string& message);

  const std::string& file() const { return file_; }  ///< file name, or the override: "--set motor.inertia=-1"
  int line() const { return line_; }
  int column() const { return column_; }
  const std::string& key() const { return key_; }

  /// What else is wrong, in the order of the input, each entry alone; empty where this is all.
  const std::vector<InputError>& others() const { return others_; }
  void add_other(InputError other) {
    other.others_.clear();
    others_.push_back(std::move(other));
  }
  void forget_others() { others_.clear(); }

 private:
  std::string file_;
  int line_;
  int column_;
  std::string key_;
  std::vector<InputError> others_;
};

/// Gives the text of a table file (chord or coefficient CSV) that a vehicle file names. May throw std::runtime_error.
using TableLoader = std::function<std::string(const std::string& name)>;

/// Bytes of a vehicle file, and of most others, at most; of a study file, whose axes may have a million values each.
inline constexpr std::size_t largest_text = std::size_t(4) << 20, largest_study = std::size_t(64) << 20;

/// The whole text of a file, of standard input for "-"; throws InputError if it is missing, unreadable, a directory, or
/// larger than so many bytes.
std::string read_text_file(const std::filesystem::path& file, std::size_t largest = largest_text);

/// The design in a vehicle file, validated. CSV files that it names are sought beside it.
///
/// `overrides` are applied in order on top of the file, each KEY=VALUE: the value is a TOML value or a bare string
/// ("motor.inertia=1.5e-7 kg m2"). A later override of a key replaces an earlier one; an inline table replaces all keys
/// below its own. An override replaces the file's alternative to it (stroke_amplitude and hinge_offset, resonance and
/// stiffness, ...), and one that changes a type or shape drops the file's keys that belong to the old one.
///
/// Throws InputError, with all that is wrong and not only the first; nothing else for any content of file and
/// overrides.
Design<double> read_design(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// The design in the text of a vehicle file; `file_name` stands in messages. Without a loader, table files are refused;
/// no file is touched.
Design<double> parse_design(std::string_view text, std::string_view file_name,
                            std::span<const std::string> overrides = {}, const TableLoader& load_table = {});

/// A vehicle file, complete in itself (tables in place), that reads back to the bit-identical design: the record of
/// what was computed. The design must be valid.
std::string write_design(const Design<double>& design);

}  // namespace wingbeat
