// A vehicle file as a flat list of known keys, each with its place in the file; other TOML files as a tree.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/input_errors.hpp"
#include "wingbeat/files/design_file.hpp"

namespace wingbeat {

/// Where a value stands.
struct Origin {
  std::string file;  ///< file name, or "--set KEY=VALUE"
  int line = 0;
  int column = 0;
  bool overridden = false;

  [[noreturn]] void refuse(const std::string& key, const std::string& message) const {
    throw InputError(file, line, column, key, message);
  }
};

/// A value of any TOML file, tables included.
struct TomlMember;
struct TomlNode {
  enum class Kind { text, number, boolean, array, table, other };
  Kind kind = Kind::other;
  std::string text;          ///< the text; of `other` what it is: "a date"
  double number = 0.0;       ///< 1 or 0 for a boolean
  bool whole = false;        ///< a number written without fraction and exponent
  bool in_line = false;      ///< a table in braces
  int line = 0, column = 0;  ///< of a member its key's
  // Offsets into the text [bytes], ends exclusive.
  std::size_t begin = 0, end = 0;          ///< of the value; of a section [key] the header's begin alone
  std::size_t key_begin = 0, key_end = 0;  ///< of a member's key, of a dotted one its last part
  std::vector<TomlNode> items;             ///< of an array
  std::vector<TomlMember> members;         ///< of a table, in the order of the file

  const TomlNode* find(std::string_view key) const;
  /// The node of a dotted path.
  const TomlNode* find_path(std::string_view path) const;
};

struct TomlMember {
  std::string key;  ///< unquoted
  TomlNode node;
};

/// A whole file as a table. Throws InputError for text that is not TOML, or longer than that.
TomlNode parse_toml_tree(std::string_view text, std::string_view file_name, std::size_t largest = largest_text);

/// "a number", "an array": what a node is, for messages.
std::string kind_of(const TomlNode& node);

/// A node as a TOML value on one line.
std::string toml_value(const TomlNode& node);

/// A value of a vehicle file or of an override; what it holds has its place.
struct Value : TomlNode {
  Origin origin;
};

/// A value that replaces one of a vehicle file, as an override does, without a text of its own.
struct Setting {
  std::string path;
  TomlNode value;
  Origin origin;  ///< what messages name; `overridden`
};

/// [left] or [right]: what is of one side alone.
struct SideTable {
  Origin origin;
  std::vector<Setting> settings;
};

struct Document {
  std::string file_name;
  int last_line = 1;
  std::map<std::string, Value, std::less<>> values;     ///< by dotted path
  std::map<std::string, Origin, std::less<>> sections;  ///< by dotted path
  std::map<std::string, SideTable> sides;               ///< not among the sections
  InputErrors errors;                                   ///< keys that are unknown or hold what they cannot
  std::vector<std::string> spoiled;  ///< these, and what they were to be: not to be called missing as well

  const Value* find(std::string_view path) const;
  bool has_section(std::string_view path) const;
  /// The place of a key, of the closest section around it, or the end of the file.
  Origin locate(std::string_view path) const;
};

/// Throws InputError for text that is not TOML. Unknown keys are among the document's errors.
Document parse_document(std::string_view text, std::string_view file_name);

/// Applies settings, then overrides, as read_design documents the latter. Throws InputError for those that cannot be,
/// the others being applied.
void apply_overrides(Document& document, std::span<const Setting> settings, std::span<const std::string> overrides);

struct Requirement;
/// Why a key has no place beside a choice that does not allow it, and what takes its place.
std::string no_place_message(std::string_view path, const Requirement& requirement, std::string_view choice);

}  // namespace wingbeat
