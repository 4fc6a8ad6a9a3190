// Nodes of a TOML file that is not a vehicle file, read one by one; what is not as expected is refused at its place.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/toml_document.hpp"
#include "wingbeat/core/names.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat {

struct SourceLocation {
  int line = 0, column = 0;
};
inline SourceLocation place_of(const TomlNode& node) { return {node.line, node.column}; }

/// `key` is the dotted name that messages give a node. Everything throws InputError.
class TomlReader {
 public:
  explicit TomlReader(std::string file) : file_(std::move(file)) {}

  const std::string& file() const { return file_; }

  [[noreturn]] void refuse(SourceLocation place, const std::string& key, const std::string& message) const;
  [[noreturn]] void refuse(const TomlNode& node, const std::string& key, const std::string& message) const;
  /// "expected ..., got ...".
  [[noreturn]] void wrong(const TomlNode& node, const std::string& key, std::string_view expected) const;
  /// An unknown key; `near` is what it was probably to be, empty where nothing is near.
  [[noreturn]] void unknown(const TomlNode& node, const std::string& key, std::string_view near,
                            std::span<const std::string_view> known) const;

  /// A text that is not empty.
  std::string text_of(const TomlNode& node, const std::string& key, std::string_view expected) const;
  /// A finite number of SI units, or a text with a unit.
  double quantity(const TomlNode& node, const std::string& key, std::string_view unit,
                  SpeedConstant speed_constant = SpeedConstant::refused) const;
  bool boolean(const TomlNode& node, const std::string& key) const;
  std::uint64_t whole_number(const TomlNode& node, const std::string& key, std::uint64_t least,
                             std::uint64_t max_value) const;
  std::string one_of(const TomlNode& node, const std::string& key, std::span<const std::string_view> known) const;
  std::string one_of(const TomlNode& node, const std::string& key,
                     std::initializer_list<std::string_view> known) const {
    return one_of(node, key, std::span(known.begin(), known.size()));
  }
  /// A value of an enumeration by its name.
  template <NamedEnum E>
  E one_of(const TomlNode& node, const std::string& key) const {
    std::vector<std::string_view> names;
    for (const auto& [name, value] : names_of<E>) names.push_back(name);
    return *from_name<E>(one_of(node, key, names));
  }

  /// Refuses a node that is not the section [key].
  void must_be_section(const TomlNode& node, const std::string& key) const;
  /// The sections [[key]] that the node holds.
  std::span<const TomlNode> sections(const TomlNode& node, const std::string& key) const;

 private:
  std::string file_;
};

}  // namespace wingbeat
