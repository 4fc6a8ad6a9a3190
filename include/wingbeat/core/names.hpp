// Names of enumerations, as in files, options and results: one table beside each enumeration.
#pragma once

#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

namespace wingbeat {

/// The names of an enumeration's values, specialised beside it:
/// `template <> inline constexpr std::pair<const char*, E> names_of<E>[] = {{"air", E::air}, ...};`
template <class E>
inline constexpr std::nullptr_t names_of = nullptr;

template <class E>
concept NamedEnum = std::is_enum_v<E> && std::is_array_v<decltype(names_of<E>)>;

template <NamedEnum E>
constexpr const char* name_of(E value) {
  for (const auto& [name, known] : names_of<E>) {
    if (known == value) return name;
  }
  return "unknown";
}

/// The value of that name, or nothing.
template <NamedEnum E>
constexpr std::optional<E> from_name(std::string_view name) {
  for (const auto& [known, value] : names_of<E>) {
    if (name == known) return value;
  }
  return std::nullopt;
}

namespace detail {

/// A text put together while compiling.
struct ShortText {
  char text[120] = {};
  std::size_t size = 0;

  constexpr ShortText& add(std::string_view more) {
    for (const char c : more) text[size++] = c;
    return *this;
  }
  constexpr operator std::string_view() const { return {text, size}; }
};

template <NamedEnum E>
inline constexpr ShortText listed_names = [] {
  ShortText text;
  std::size_t left = std::size(names_of<E>);
  for (const auto& [name, value] : names_of<E>) text.add(name).add(--left > 1 ? ", " : left == 1 ? " or " : "");
  return text;
}();

}  // namespace detail

/// "air, vacuum or wingless".
template <NamedEnum E>
constexpr std::string_view listed_names() {
  return detail::listed_names<E>;
}

}  // namespace wingbeat
