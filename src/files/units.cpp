#include "wingbeat/files/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <system_error>
#include <utility>

#include "files/read_number.hpp"
#include "files/unit_system.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/core/text.hpp"

namespace wingbeat {

namespace {

using detail::UnitAnatomy;

constexpr std::size_t longest_unit = 80;

/// "gcm2" as "g cm2". No symbol can say this: UDUNITS takes the exponent for that of the whole word.
std::string inertia_apart(const std::string& unit) {
  static const std::regex together("(^|[^A-Za-z_])([kmu]?g)([cm]?m)(2|\\^2|\\*\\*2|\u00b2)(?![0-9])");
  return std::regex_replace(unit, together, "$1$2 $3$4");
}

std::optional<UnitAnatomy> dissect(const std::string& unit) {
  const std::optional<UnitAnatomy> found = detail::dissect_unit(unit);
  return found ? found : detail::dissect_unit(inertia_apart(unit));
}

/// Units of what is asked for that have a zero of their own to be converted to.
bool is_temperature(std::string_view unit) { return unit == "K" || unit == "degC"; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Of the signs beyond ASCII that UDUNITS reads only these are letters, which may bear an exponent.
bool ends_in_letter(std::string_view text) {
  constexpr std::string_view letters[] = {"\u03a9", "\u2126", "\u00c5", "\u212b"};  // ohm twice, angstrom twice
  return std::any_of(std::begin(letters), std::end(letters), [&](auto letter) { return text.ends_with(letter); });
}

/// A number inside a unit that is no exponent. UDUNITS would multiply by it.
bool has_stray_number(std::string_view unit) {
  if (unit == "1") return false;
  for (std::size_t n = 0; n < unit.size(); ++n) {
    if (!is_digit(unit[n]) || (n > 0 && is_digit(unit[n - 1]))) continue;
    std::size_t before = n;
    if (before > 0 && (unit[before - 1] == '-' || unit[before - 1] == '+')) --before;
    if (before == 0) {
      const bool reciprocal = unit.size() > 1 && unit[0] == '1' && (unit[1] == '/' || unit.substr(1, 2) == " /");
      if (reciprocal) continue;
      return true;
    }
    const auto previous = static_cast<unsigned char>(unit[before - 1]);
    const bool power = previous == '^' || (previous == '*' && before > 1 && unit[before - 2] == '*');
    if (!(std::isalpha(previous) || previous == ')' || power || ends_in_letter(unit.substr(0, before)))) return true;
  }
  return false;
}

/// Spaces and powers as word processors write them, in the form that UDUNITS reads.
std::string typewritten(std::string_view text) {
  static constexpr std::pair<std::string_view, std::string_view> replacements[] = {
      {"\u00a0", " "}, {"\u2009", " "}, {"\u202f", " "}, {"\u2074", "^4"}, {"\u2075", "^5"}, {"\u03bc", "\u00b5"}};
  std::string result(text);
  for (const auto& [from, to] : replacements) {
    for (auto position = result.find(from); position != std::string::npos;
         position = result.find(from, position + to.size())) {
      result.replace(position, from.size(), to);
    }
  }
  return std::string(detail::trimmed(result));
}

/// number * factor, exact where the factor is a power of ten: the decimal point is moved in the text.
double scaled(std::string_view number, double value, double factor) {
  if (factor == 1.0 || value == 0.0) return value;
  const double power = std::round(std::log10(factor));
  if (std::abs(factor / std::pow(10.0, power) - 1.0) > 1e-13) return value * factor;
  const auto e = number.find_first_of("eE");
  long exponent = 0;
  if (e != std::string_view::npos) {
    std::string_view digits = number.substr(e + 1);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    if (std::from_chars(digits.data(), digits.data() + digits.size(), exponent).ec != std::errc{}) {
      return value * factor;
    }
  }
  const std::string moved = fmt::format("{}e{}", number.substr(0, e), exponent + long(power));
  double result = value * factor;
  detail::read_number(moved.data(), moved.data() + moved.size(), result);
  return result;
}

struct Factor {
  double value = 1.0;
  std::string complaint;  ///< what is wrong with the unit beyond its dimension, or empty
  bool ok = true;
  bool of_reciprocal = false;  ///< not ok, but `value` converts the reciprocal: a speed for a torque constant
};

Factor refuse(std::string complaint) { return {1.0, std::move(complaint), false}; }

bool are_reciprocals(const UnitAnatomy& a, const UnitAnatomy& b) {
  return a.dimension.size() == b.dimension.size() &&
         std::all_of(a.dimension.begin(), a.dimension.end(), [&](const auto& power) {
           const auto other = b.dimension.find(power.first);
           return other != b.dimension.end() && other->second == -power.second;
         });
}

Factor factor_for(const std::string& unit, std::string_view expected_unit) {
  if (unit.empty()) return {};
  const bool garbled = unit.size() > longest_unit || unit.find('\0') != std::string::npos;
  std::optional<UnitAnatomy> given;
  if (!garbled) {
    if (has_stray_number(unit)) return refuse(", which holds a second number");
    given = dissect(unit);
  }
  if (!given) return refuse(fmt::format(" with the unknown unit {}", in_quotes(unit)));
  const std::optional<UnitAnatomy> expected = dissect(std::string(expected_unit));
  if (!expected) throw std::logic_error(fmt::format("{} is not a unit", in_quotes(expected_unit)));

  if (!given->plain) return refuse(fmt::format("; {} has an offset or a logarithm", in_quotes(unit)));
  static const std::map<std::string, int> rate = {{"s", -1}};
  static const std::map<std::string, int> torque_constant = {{"kg", 1}, {"m", 2}, {"s", -2}, {"A", -1}};
  if (expected->dimension == torque_constant && expected->angle == 0 && are_reciprocals(*given, *expected)) {
    if (given->angle == 0) return refuse("; a speed constant names the angle, as in rpm/V or rad/s/V");
    if (given->angle != 1) return refuse("");
    return {given->scale * expected->scale, "; a speed constant is the reciprocal of a torque constant", false, true};
  }
  if (given->dimension != expected->dimension) return refuse("");
  const Factor converts{given->scale / expected->scale, ""};
  if (expected->dimension == rate) {
    if (given->angle == expected->angle) return converts;
    if (given->angle == 1 && expected->angle == 0) return {converts.value / two_pi, ""};
    return refuse(expected->angle == 1 ? "; name the angle, as in rad/s, deg/s or rpm" : "");
  }
  if (unit.find("Hz") != std::string::npos || unit.find("hertz") != std::string::npos) {
    return refuse("; a cycle is 2 pi rad, so write s or rad/s instead of Hz");
  }
  if (given->angle == expected->angle) return converts;
  if (expected->dimension.empty()) return refuse("");
  if (given->angle == 0) return converts;
  if (expected->dimension == torque_constant && expected->angle == 0 && given->angle == -1) return converts;
  return refuse("");
}

std::string refusal(std::string_view text, std::string_view unit, std::string_view complaint) {
  return fmt::format("expected {}, got {}{}", quantity_example(unit), in_quotes(text), complaint);
}

}  // namespace

std::string one_line(std::string_view text, std::size_t longest) {
  const bool cut = text.size() > longest;
  if (cut) {
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // not inside a UTF-8 sequence
    text = text.substr(0, end);
  }
  std::string result;
  for (const char c : detail::printable(text)) {
    if (c == '\n') result += "\\n";
    else if (c == '\t') result += "\\t";
    else result += c;
  }
  return result + (cut ? "..." : "");
}

std::string in_quotes(std::string_view text) { return '"' + one_line(text) + '"'; }

std::string quantity_example(std::string_view unit) {
  static constexpr std::pair<std::string_view, std::string_view> examples[] = {
      {"1", "a number such as 2"},
      {"m", "a length such as \"5 mm\""},
      {"kg", "a mass such as \"3 g\""},
      {"s", "a time such as \"5 ms\""},
      {"V", "a voltage such as \"3 V\""},
      {"A", "a current such as \"0.2 A\""},
      {"C", "an electric charge such as \"50 mA h\""},
      {"Hz", "a frequency such as \"22 Hz\""},
      {"rad", "an angle such as \"40 deg\""},
      {"rad/s", "an angular speed such as \"100 rad/s\""},
      {"ohm", "a resistance such as \"9 ohm\""},
      {"H", "an inductance such as \"29 mH\""},
      {"N m/A", "a torque constant such as \"0.01 N m/A\""},
      {"kg m2", "a moment of inertia such as \"1.5e-7 kg m2\""},
      {"N m", "a torque such as \"0.1 mN m\""},
      {"N m/rad", "a torsional stiffness such as \"1.4e-3 N m/rad\""},
      {"N m s/rad", "a torsional damping such as \"3.6e-6 N m s/rad\""},
      {"N m s2/rad2", "a quadratic damping such as \"2e-8 N m s2/rad2\""},
      {"kg/m", "a mass over a length such as \"2 g/m\""},
      {"kg/m2", "a mass over an area such as \"20 g/m2\""},
      {"J/kg", "an energy over a mass such as \"160 W h/kg\""},
      {"kg/m3", "a density such as \"1.225 kg/m3\""},
      {"K", "a temperature such as \"25 degC\""},
      {"degC", "a temperature such as \"25 degC\""},
      {"K/W", "a thermal resistance such as \"20 K/W\""},
      {"1/K", "a temperature coefficient such as \"0.0039 1/K\""},
      {"m2", "an area such as \"0.02 m2\""},
      {"m2/s", "a kinematic viscosity such as \"1.5e-5 m2/s\""},
      {"N/V", "a force per volt such as \"0.4 mN/V\""},
      {"1/V", "a growth per volt such as \"1e-3 1/V\""},
      {"N/m", "a stiffness such as \"240 N/m\""},
      {"N s/m", "a damping such as \"0.02 N s/m\""},
      {"F", "a capacitance such as \"10 nF\""},
      {"rad/m", "an angle over a length such as \"2600 rad/m\""},
      {"rad/m3", "an angle over a volume such as \"4e9 rad/m3\""},
      {"m4", "a chord moment such as \"2.5e-6 m4\""},
      {"m5", "a chord moment such as \"1e-7 m5\""}};
  for (const auto& [known, example] : examples) {
    if (known == unit) return std::string(example);
  }
  return fmt::format("a quantity in {}", unit);
}

void require_unit(std::string_view unit, std::string_view expected_unit) {
  if (is_temperature(expected_unit)) {
    parse_quantity("0 " + std::string(unit), expected_unit);
  } else {
    unit_factor(unit, expected_unit);
  }
}

double unit_factor(std::string_view unit, std::string_view expected_unit) {
  const Factor factor = factor_for(typewritten(unit), expected_unit);
  if (!factor.ok) throw UnitError(refusal(unit, expected_unit, factor.complaint));
  return factor.value;
}

double parse_quantity(std::string_view text, std::string_view expected_unit, SpeedConstant speed_constant) {
  const auto fail = [&](std::string_view complaint) -> double {
    throw UnitError(refusal(text, expected_unit, complaint));
  };
  const std::string whole = typewritten(text);
  std::string_view number = whole;
  if (number.starts_with('+')) number.remove_prefix(1);
  // from_chars also reads "inf" and "nan", and the beginning of "nano".
  const std::string_view digits = number.substr(number.starts_with('-') && number.size() == whole.size() ? 1 : 0);
  if (digits.empty() || !(is_digit(digits[0]) || (digits[0] == '.' && digits.size() > 1 && is_digit(digits[1])))) {
    return fail(", which does not begin with a number");
  }
  double value = 0.0;
  const auto [end, error] = detail::read_number(number.data(), number.data() + number.size(), value);
  if (error != std::errc{}) return fail(", a number too large or too small to store");
  const std::string_view mantissa = number.substr(0, std::size_t(end - number.data()));
  const std::string unit(detail::trimmed(number.substr(mantissa.size())));
  if (unit.starts_with(',')) return fail("; write a decimal point, not a comma");
  if (is_temperature(expected_unit) && !unit.empty() && unit.size() <= longest_unit && !has_stray_number(unit)) {
    const auto kelvin_or_celsius = detail::converted_temperature(value, unit, std::string(expected_unit));
    if (kelvin_or_celsius && std::isfinite(*kelvin_or_celsius)) return *kelvin_or_celsius;
  }
  const Factor factor = factor_for(unit, expected_unit);
  if (factor.of_reciprocal) {
    const double reciprocal = 1.0 / scaled(mantissa, value, factor.value);
    if (!(reciprocal > 0.0 && std::isfinite(reciprocal))) return fail("; a speed constant must be > 0");
    if (speed_constant == SpeedConstant::inverted) return reciprocal;
    return fail(fmt::format("{}: write {:.6g} {}", factor.complaint, reciprocal, expected_unit));
  }
  if (!factor.ok) return fail(factor.complaint);
  const double result = scaled(mantissa, value, factor.value);
  if (!std::isfinite(result)) return fail(", a number too large or too small to store");
  return result;
}

}  // namespace wingbeat
