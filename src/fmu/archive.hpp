// A design, or any other aggregate that lists its members, as bytes and back, bit for bit: what an FMU carries in place
// of a vehicle file, and what its saved states are made of.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "wingbeat/core/members.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat::fmu {

template <class T>
concept PlainValue = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Calls itself with each value in turn.
class ArchiveWriter {
 public:
  std::string bytes;

  template <class T>
  void operator()(const T& x) {
    if constexpr (PlainValue<T>) {
      bytes.append(reinterpret_cast<const char*>(&x), sizeof x);
    } else {
      T::members(x, [this](const auto&... member) {
        ((*this)(member), ...);
        return 0;
      });
    }
  }
  void operator()(const std::string& text) {
    (*this)(std::uint64_t(text.size()));
    bytes += text;
  }
  template <class T>
  void operator()(const std::optional<T>& x) {
    (*this)(x.has_value());
    if (x) (*this)(*x);
  }
  template <class A, class B>
  void operator()(const std::pair<A, B>& x) {
    (*this)(x.first), (*this)(x.second);
  }
  template <class T>
  void operator()(const std::vector<T>& list) {
    (*this)(std::uint64_t(list.size()));
    for (const T& x : list) (*this)(x);
  }
  template <class T, std::size_t N>
  void operator()(const std::array<T, N>& list) {
    for (const T& x : list) (*this)(x);
  }
  void operator()(const std::shared_ptr<const CoefficientTable>& table) {
    (*this)(table != nullptr);
    if (table) (*this)(table->alpha()), (*this)(table->lift()), (*this)(table->drag());
  }
  void operator()(const std::shared_ptr<const LoadTable>& table) {
    (*this)(table != nullptr);
    if (table) (*this)(table->rows());
  }
  void operator()(const std::shared_ptr<const StrokeCurve>& curve) {
    (*this)(curve != nullptr);
    if (curve) (*this)(curve->rows());
  }
};

/// Reads what a writer of the same build wrote. Throws std::runtime_error for fewer bytes.
class ArchiveReader {
 public:
  explicit ArchiveReader(std::string_view bytes) : rest_(bytes) {}
  bool done() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }

  template <class T>
  void operator()(T& x) {
    if constexpr (PlainValue<T>) {
      take(sizeof x).copy(reinterpret_cast<char*>(&x), sizeof x);
    } else {
      T::members(x, [this](auto&... member) {
        ((*this)(member), ...);
        return 0;
      });
    }
  }
  void operator()(std::string& text) { text = take(value<std::uint64_t>()); }
  template <class T>
  void operator()(std::optional<T>& x) {
    x.reset();
    if (value<bool>()) (*this)(x.emplace());
  }
  template <class A, class B>
  void operator()(std::pair<A, B>& x) {
    (*this)(x.first), (*this)(x.second);
  }
  template <class T>
  void operator()(std::vector<T>& list) {
    const auto count = value<std::uint64_t>();
    if (count > rest_.size()) throw std::runtime_error("the saved state is incomplete");
    list.assign(std::size_t(count), T{});
    for (T& x : list) (*this)(x);
  }
  template <class T, std::size_t N>
  void operator()(std::array<T, N>& list) {
    for (T& x : list) (*this)(x);
  }
  void operator()(std::shared_ptr<const CoefficientTable>& table) {
    table = nullptr;
    if (!value<bool>()) return;
    std::vector<double> alpha, lift, drag;
    (*this)(alpha), (*this)(lift), (*this)(drag);
    table = std::make_shared<const CoefficientTable>(alpha, lift, drag);
  }
  void operator()(std::shared_ptr<const LoadTable>& table) {
    table = nullptr;
    if (!value<bool>()) return;
    std::vector<LoadTable::Row> rows;
    (*this)(rows);
    table = std::make_shared<const LoadTable>(rows);
  }
  void operator()(std::shared_ptr<const StrokeCurve>& curve) {
    curve = nullptr;
    if (!value<bool>()) return;
    std::vector<std::pair<double, double>> rows;
    (*this)(rows);
    curve = std::make_shared<const StrokeCurve>(rows);
  }

  template <class T>
  T value() {
    T x{};
    (*this)(x);
    return x;
  }

 private:
  std::string_view take(std::uint64_t count) {
    if (count > rest_.size()) throw std::runtime_error("the saved state is incomplete");
    const std::string_view taken = rest_.substr(0, std::size_t(count));
    rest_.remove_prefix(std::size_t(count));
    return taken;
  }
  std::string_view rest_;
};

}  // namespace wingbeat::fmu
