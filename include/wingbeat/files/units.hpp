// Quantities with units, read through UDUNITS-2.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace wingbeat {

/// A text that is not the quantity asked for. what() is the end of a sentence, without file and key:
/// `expected a length such as "5 mm", got "5 kg"`.
class UnitError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// What becomes of a speed constant ("1000 rpm/V") where a torque constant is expected: it is refused, with the torque
/// constant to write instead, or taken as that, K = 60 / (2 pi Kv). Only the value of a key may be inverted, no
/// deviation.
enum class SpeedConstant { refused, inverted };

/// The SI value of a quantity such as "5 mm", "1.377e-3 N m/rad" or "22 Hz", where `expected_unit` is the SI unit of
/// what is asked for ("m", "N m/rad", "Hz", "1"). A number without a unit is taken as SI. Decimal prefixes are exact:
/// "29 mH" is the double 0.029. Throws UnitError; std::runtime_error where the unit database cannot be read.
///
/// Angles are kept apart although UDUNITS counts the radian as 1:
/// - radians may be left out of a compound unit ("N m" for "N m/rad") but not added ("N m/rad" for "N m"), except that
///   a torque constant may be written V s/rad;
/// - a frequency may be written as an angular speed and is divided by 2 pi: "1320 rpm" is 22 Hz. An angular speed may
///   not be written as a frequency, nor may Hz stand inside any other unit;
/// - an angle needs a unit of angle: a percentage is not one.
/// A temperature ("K", and "degC" for metrics) may be written in any unit of temperature, with its own zero.
/// Refused too: units with an offset for anything else, a logarithm or a factor ("5 2 mm", "5 mm·2"), and reciprocals
/// (s for Hz). Beside UDUNITS' own units: deg, rev, and products written as one word: Ah, Wh, Nm, Ncm, Nmm, Nms and Vs
/// with any prefix, and inertias such as gcm2.
double parse_quantity(std::string_view text, std::string_view expected_unit,
                      SpeedConstant speed_constant = SpeedConstant::refused);

/// Throws UnitError, as parse_quantity does, where a number in `unit` is no such quantity.
void require_unit(std::string_view unit, std::string_view expected_unit);

/// What a number in `unit` is multiplied by to give SI, under the rules of parse_quantity.
double unit_factor(std::string_view unit, std::string_view expected_unit);

/// What to write for a quantity in an SI unit, for messages: `a length such as "5 mm"` for "m".
std::string quantity_example(std::string_view unit);

/// Text fit for a message: one line, hidden characters escaped (core/text.hpp), cut after `longest` bytes.
std::string one_line(std::string_view text, std::size_t longest = 60);

/// A text fit for a message, in double quotes.
std::string in_quotes(std::string_view text);

}  // namespace wingbeat
