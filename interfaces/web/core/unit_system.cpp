// The units of src/files/unit_system.hpp from tables (unit_table.hpp): products and quotients of words with prefixes
// and exponents, as UDUNITS reads them. Time stamps and logarithms are no units here.
#include "files/unit_system.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include "unit_table.hpp"

namespace wingbeat::detail {
namespace {

constexpr std::pair<std::string_view, int> superscripts[] = {{"\u00b9", 1}, {"\u00b2", 2}, {"\u00b3", 3}};
constexpr std::string_view middle_dot = "\u00b7";

bool same_word(std::string_view text, std::string_view word, bool symbol) {
  return text.size() == word.size() && std::equal(text.begin(), text.end(), word.begin(), [&](char a, char b) {
           return symbol ? a == b
                         : std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
         });
}

const web::UnitRow* find_unit(std::string_view word) {
  for (const bool symbol : {false, true}) {
    for (const web::UnitRow& row : web::unit_table()) {
      if (row.symbol == symbol && same_word(word, row.word, symbol)) return &row;
    }
  }
  return nullptr;
}

/// The longest prefix that the word begins with, names before symbols.
const web::PrefixRow* find_prefix(std::string_view word, bool symbols) {
  for (const bool symbol : {false, true}) {
    if (symbol && !symbols) break;
    const web::PrefixRow* longest = nullptr;
    std::size_t length = 0;
    for (const web::PrefixRow& row : web::prefix_table()) {
      const std::string_view text = row.word;
      if (row.symbol != symbol || text.size() <= length || !same_word(word.substr(0, text.size()), text, symbol))
        continue;
      longest = &row;
      length = text.size();
    }
    if (longest) return longest;
  }
  return nullptr;
}

struct KnownWord {
  const web::UnitRow* unit = nullptr;
  double prefix = 1.0;
};

KnownWord known_word(std::string_view word) {
  KnownWord found;
  bool symbols = true;
  while (!word.empty()) {
    found.unit = find_unit(word);
    if (found.unit) return found;
    const web::PrefixRow* prefix = find_prefix(word, symbols);
    if (!prefix) return {};
    found.prefix *= prefix->factor;
    symbols = symbols && !prefix->symbol;
    word.remove_prefix(std::string_view(prefix->word).size());
  }
  return {};
}

UnitAnatomy anatomy_of(const KnownWord& word) {
  UnitAnatomy result;
  result.scale = word.prefix * word.unit->scale;
  result.angle = word.unit->angle;
  result.plain = word.unit->plain;
  std::istringstream dimension(word.unit->dimension);
  std::string base;
  for (int power = 0; dimension >> base >> power;) result.dimension[base] = power;
  return result;
}

bool is_temperature(const UnitAnatomy& unit) {
  return unit.angle == 0 && unit.dimension.size() == 1 && unit.dimension.begin()->first == "K" &&
         unit.dimension.begin()->second == 1;
}

/// In products and powers a degree is a difference of temperatures.
UnitAnatomy without_zero(UnitAnatomy unit) {
  unit.plain = unit.plain || is_temperature(unit);
  return unit;
}

UnitAnatomy power_of(UnitAnatomy unit, int power) {
  unit = without_zero(unit);
  unit.scale = std::pow(unit.scale, power);
  unit.angle *= power;
  for (auto& [base, exponent] : unit.dimension) exponent *= power;
  return unit;
}

void multiply(UnitAnatomy& product, const UnitAnatomy& factor) {
  product.scale *= factor.scale;
  product.angle += factor.angle;
  product.plain = product.plain && factor.plain;
  for (const auto& [base, exponent] : factor.dimension) product.dimension[base] += exponent;
}

/// product: power, then powers after nothing, a sign of multiplication or of division; power: word or bracket, then an
/// exponent or none. Division binds as multiplication does, from the left.
class UnitText {
 public:
  explicit UnitText(std::string_view text) : rest_(text) {}

  std::optional<UnitAnatomy> whole() {
    const std::optional<UnitAnatomy> unit = product();
    skip_blanks();
    return rest_.empty() ? unit : std::nullopt;
  }

 private:
  void skip_blanks() {
    while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
  }
  bool take(std::string_view sign) {
    if (!rest_.starts_with(sign)) return false;
    rest_.remove_prefix(sign.size());
    return true;
  }
  static bool in_word(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return std::isalpha(byte) || c == '_' || c == '%' || c == '\'' || c == '"' || byte >= 0x80;
  }

  std::optional<UnitAnatomy> product() {
    std::optional<UnitAnatomy> result = power();
    while (result) {
      skip_blanks();
      if (rest_.empty() || rest_.front() == ')') break;
      bool divide = take("/");
      if (!divide && (rest_.starts_with("per ") || rest_.starts_with("PER "))) divide = take(rest_.substr(0, 4));
      if (!divide && !rest_.starts_with("**") && !take("*") && !take(".") && !take("-")) take(middle_dot);
      skip_blanks();
      const std::optional<UnitAnatomy> next = power();
      if (!next) return std::nullopt;
      *result = without_zero(*result);
      multiply(*result, divide ? power_of(*next, -1) : without_zero(*next));
    }
    return result;
  }

  std::optional<UnitAnatomy> power() {
    const std::optional<UnitAnatomy> base = basic();
    if (!base) return std::nullopt;
    if (take("^") || take("**")) {
      const std::optional<int> exponent = plain_exponent();
      return exponent ? std::optional(power_of(*base, *exponent)) : std::nullopt;
    }
    if (const std::optional<int> raised = superscript()) return power_of(*base, *raised);
    if (const std::optional<int> exponent = plain_exponent()) return power_of(*base, *exponent);
    return base;
  }

  std::optional<UnitAnatomy> basic() {
    if (take("(")) {
      skip_blanks();
      const std::optional<UnitAnatomy> inside = product();
      skip_blanks();
      return take(")") ? inside : std::nullopt;
    }
    if (rest_.starts_with("1") && (rest_.size() == 1 || !std::isdigit(static_cast<unsigned char>(rest_[1])))) {
      rest_.remove_prefix(1);
      return UnitAnatomy{};
    }
    std::size_t size = 0;
    while (size < rest_.size() && in_word(rest_[size]) && !is_sign_beyond_ascii(rest_.substr(size))) ++size;
    if (size == 0) return std::nullopt;
    const KnownWord word = known_word(rest_.substr(0, size));
    if (!word.unit) return std::nullopt;
    rest_.remove_prefix(size);
    return anatomy_of(word);
  }

  static bool is_sign_beyond_ascii(std::string_view text) {
    return text.starts_with(middle_dot) ||
           std::any_of(std::begin(superscripts), std::end(superscripts),
                       [&](const auto& digit) { return text.starts_with(digit.first); });
  }

  std::optional<int> plain_exponent() {
    std::size_t size = !rest_.empty() && (rest_.front() == '-' || rest_.front() == '+') ? 1 : 0;
    const std::size_t sign = size;
    while (size < rest_.size() && size < sign + 3 && std::isdigit(static_cast<unsigned char>(rest_[size]))) ++size;
    if (size == sign) return std::nullopt;
    const int exponent = std::atoi(std::string(rest_.substr(0, size)).c_str());
    rest_.remove_prefix(size);
    return exponent;
  }

  std::optional<int> superscript() {
    for (const auto& [text, digit] : superscripts) {
      if (take(text)) return digit;
    }
    return std::nullopt;
  }

  std::string_view rest_;
};

}  // namespace

std::optional<UnitAnatomy> dissect_unit(const std::string& unit) {
  std::optional<UnitAnatomy> result = UnitText(unit).whole();
  if (!result) return std::nullopt;
  std::erase_if(result->dimension, [](const auto& power) { return power.second == 0; });
  if (!(std::isfinite(result->scale) && result->scale > 0.0)) return std::nullopt;
  return result;
}

std::optional<double> converted_temperature(double value, const std::string& unit, const std::string& wanted) {
  const KnownWord from = known_word(unit), to = known_word(wanted);
  if (!from.unit || !to.unit || !is_temperature(anatomy_of(from)) || !is_temperature(anatomy_of(to))) {
    return std::nullopt;
  }
  const double kelvin = value * (from.prefix * from.unit->scale) + from.unit->offset;
  return (kelvin - to.unit->offset) / (to.prefix * to.unit->scale);
}

}  // namespace wingbeat::detail
