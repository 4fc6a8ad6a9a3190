// Fields of a TOML file that is not a vehicle file: known keys only, numbers with units, every refusal with its place.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/toml_reader.hpp"
#include "wingbeat/core/names.hpp"

namespace wingbeat {

/// A table of a TOML file under its dotted name, read key by key.
class TomlFields {
 public:
  /// The node must be a table.
  TomlFields(std::string file, std::string path, const TomlNode& table);

  [[noreturn]] void refuse(const TomlNode& node, std::string_view key, const std::string& message) const;
  [[noreturn]] void refuse(std::string_view key, const std::string& message) const { refuse(table_, key, message); }

  void known_keys(std::span<const std::string_view> keys) const;
  bool has(std::string_view key) const { return table_.find(key) != nullptr; }
  /// The place of a key, or of the table where it is not given.
  const TomlNode& at(std::string_view key) const;

  std::optional<std::string> text(std::string_view key) const;
  std::optional<double> quantity(std::string_view key, std::string_view unit) const;
  std::optional<bool> boolean(std::string_view key) const;
  /// A whole number >= least.
  std::optional<int> count(std::string_view key, int least) const;
  std::string needed_text(std::string_view key, std::string_view expected) const;
  double needed_quantity(std::string_view key, std::string_view unit) const;
  /// One of the names; `fallback` where the key is not given, which must not be unless there is one.
  std::string choice(std::string_view key, std::span<const std::string_view> names,
                     std::optional<std::string_view> fallback = {}) const;
  /// A value of an enumeration by its name.
  template <NamedEnum E>
  E choice(std::string_view key, std::optional<E> fallback = {}) const {
    std::vector<std::string_view> names;
    for (const auto& [name, value] : names_of<E>) names.push_back(name);
    if (fallback && !has(key)) return *fallback;
    return *from_name<E>(choice(key, names));
  }
  std::optional<TomlFields> table(std::string_view key) const;
  /// The tables of [[key]]; empty where there is none.
  std::vector<TomlFields> tables(std::string_view key) const;

  const TomlNode& node() const { return table_; }
  const std::string& file() const { return reader_.file(); }
  std::string name_of(std::string_view key) const;

 private:
  TomlReader reader_;
  std::string path_;
  const TomlNode& table_;
};

}  // namespace wingbeat
