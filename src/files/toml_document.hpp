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

struct Value {
  enum class Kind { text, number, boolean, array, table, other };
  Kind kind = Kind::other;
  std::string text;          ///< the text; of `other` what it is: "a date"
  double number = 0.0;       ///< 1 or 0 for a boolean
  std::vector<Value> items;  ///< of an array
  Origin origin;
};

/// "a number", "an array": what a value is, for messages.
std::string kind_of(const Value& value);

struct Document {
  std::string file_name;
  int last_line = 1;
  std::map<std::string, Value, std::less<>> values;     ///< by dotted path
  std::map<std::string, Origin, std::less<>> sections;  ///< by dotted path
  InputErrors errors;                                   ///< keys that are unknown or hold what they cannot
  std::vector<std::string> spoiled;  ///< these, and what they were to be: not to be called missing as well

  const Value* find(std::string_view path) const;
  bool has_section(std::string_view path) const;
  /// The place of a key, of the closest section around it, or the end of the file.
  Origin locate(std::string_view path) const;
};

/// A value of any TOML file, tables included.
struct TomlMember;
struct TomlNode {
  enum class Kind { text, number, boolean, array, table, other };
  Kind kind = Kind::other;
  std::string text;     ///< the text; of `other` what it is: "a date"
  double number = 0.0;  ///< 1 or 0 for a boolean
  bool whole = false;   ///< a number written without fraction and exponent
  int line = 0, column = 0;
  std::vector<TomlNode> items;      ///< of an array
  std::vector<TomlMember> members;  ///< of a table, in the order of the file

  const TomlNode* find(std::string_view key) const;
};

struct TomlMember {
  std::string key;  ///< unquoted
  TomlNode node;
};

/// A whole file as a table. Throws InputError for text that is not TOML, or longer than that.
TomlNode parse_toml_tree(std::string_view text, std::string_view file_name, std::size_t largest = largest_text);

/// "a number", "an array": what a node is, for messages.
std::string kind_of(const TomlNode& node);

/// Throws InputError for text that is not TOML. Unknown keys are among the document's errors.
Document parse_document(std::string_view text, std::string_view file_name);

/// Applies overrides as read_design documents it. Throws InputError for those that cannot be, the others being applied.
void apply_overrides(Document& document, std::span<const std::string> overrides);

}  // namespace wingbeat
