// Published values beside computed ones: the files in data/published.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {

/// How far a number could have been otherwise.
enum class Basis {
  calibrated,  ///< it was looked at when parameters that are not published were chosen
  predicted,   ///< it was not
  given        ///< it follows from the published tables
};
template <>
inline constexpr std::pair<const char*, Basis> names_of<Basis>[] = {
    {"calibrated", Basis::calibrated}, {"predicted", Basis::predicted}, {"given", Basis::given}};

/// A parameter that the paper states without an interval, and the relative standard deviation that is assumed for it.
struct UncertainPublished {
  std::string key;            ///< of the vehicle file
  double relative_deviation;  ///< of a normal distribution around the vehicle file's value [1]
  std::string why;            ///< where the assumption comes from
};

/// One published number: a metric of a design, or its ratio to the same metric of another.
struct PublishedValue {
  std::optional<double> voltage;    ///< operating point [V], or
  std::optional<double> frequency;  ///< [Hz]
  Metric metric;
  std::string design;
  std::optional<std::string> relative_to;  ///< the ratio's second design
  double published;                        ///< in the metric's SI unit, a ratio, or the ratio's change
  bool change = false;                     ///< the paper prints the ratio as a change: `published` is ratio - 1
  std::string published_text;              ///< with the digits of the file, which are those of the paper
  double digit = absent;                   ///< one unit of the last printed digit, in the unit of `published`
  double tolerance;                        ///< accepted relative deviation [1]
  std::string where;                       ///< in the paper; may be empty
  Basis basis = Basis::predicted;
};

/// What metrics do along a quantity or at one operating point, or what follows from the tables alone.
struct PublishedTrend {
  enum class Kind {
    crossing,         ///< frequency at which the metric is the same for both designs [Hz]
    peak_at,          ///< where the metric is highest, in the unit of what varies
    trough_at,        ///< where the metric has a minimum between higher values, in the unit of what varies
    peak,             ///< the highest value of the metric, in its unit
    value,            ///< the metric at an operating point
    change,           ///< the metric of the first design over that of the second, minus 1
    difference,       ///< the metric of the first design minus that of the second
    best_range,       ///< centre of the range of frequency, as wide as the published one, of highest metric [Hz]
    power_balance,    ///< (motor output - friction) / aerodynamic power [1]
    between,          ///< is the frequency of maximum system efficiency between those of motor and mechanism?
    steadier,         ///< does the first design turn more evenly and flap with the higher peak velocity?
    saturates,        ///< do lift and efficiency gain less above `at` than below it?
    initial_guesses,  ///< share of friction in the motor output; angle of attack at the largest lift
    constant_load_efficiency,  ///< most efficient constant load of the motor at `voltage` [1]
    spring_resonance,          ///< frequency at which the wings resonate with their springs [Hz]
    weight,                    ///< [N]
    best_friction_law,         ///< the law that predicts the published values of the other designs best
    generally,  ///< is the metric of the first design above (`bound`: below) that of the second in most of the range?
    turns,      ///< is it above at the low end of the range and below at the high end? The answer is where they cross
    ordered_conditions,  ///< does the metric rise from wingless over vacuum to air?
    wording              ///< nothing to compute; `reason` says why
  };
  enum class Bound {
    none,
    below,
    above
  };  ///< the published number is what the computed one is not to reach, or to exceed
  std::string statement, where;
  Kind kind;
  Basis basis = Basis::predicted;
  Metric metric = Metric::frequency;
  std::optional<Metric> share_of;  ///< the quantity is the metric over this one
  std::string design;
  std::optional<std::string> relative_to;  ///< of a crossing, change or difference
  std::string over;                        ///< what varies: a key of the vehicle file; empty: the flapping frequency
  double from = 0.0, to = 0.0;             ///< range of it, or of the frequency [SI]
  double over_value = absent;              ///< one value of it [SI]
  bool hold_stroke = false;                ///< the stroke amplitude stays, not the hinge offset
  std::optional<double> voltage;           ///< [V]
  std::optional<double> frequency;         ///< [Hz]
  std::optional<double> published;         ///< SI; empty: no published value
  std::optional<double> published_end;     ///< of a range, whose start is `published`
  std::string published_text;              ///< with the digits of the file, which are those of the paper
  double digit = absent;                   ///< one unit of the last printed digit [SI]
  bool approximate = false;                ///< the paper says "about": a whole unit of the last digit, not half of it
  std::optional<FrictionLaw> published_law;
  Bound bound = Bound::none;
  double tolerance = 0.0;  ///< accepted relative deviation [1]
  std::string unit;        ///< SI, of the published and the computed number; "1" without one
  std::string reason;      ///< given: the statement is not checkable, and why
  std::string note;        ///< what is to be said about the statement; may be empty
  std::string erratum;     ///< what is wrong in the paper here; may be empty
  bool restates = false;   ///< the same fact as another entry, in other words: not counted again
};

struct PublishedFile {
  std::string title;
  std::string source;
  double tolerance = absent;  ///< accepted relative deviation of every entry that states none of its own [1]
  std::map<std::string, Design<double>> designs;  ///< by the names that the values use
  std::vector<PublishedValue> values;
  std::vector<PublishedTrend> trends;
  std::vector<UncertainPublished> uncertain;  ///< what intervals of the computed numbers come from; may be empty
};

/// Reads the file and the vehicle files it names, which are sought beside it. Throws InputError.
PublishedFile read_published(const std::filesystem::path& file, std::span<const std::string> overrides = {});
/// The published file in a text; `design_named` gives the design of a vehicle file that it names.
PublishedFile parse_published(std::string_view text, std::string_view name,
                              const std::function<Design<double>(const std::string& file)>& design_named);

/// "3 V" or "22 Hz".
std::string operating_point(const std::optional<double>& voltage, const std::optional<double>& frequency);

}  // namespace wingbeat
