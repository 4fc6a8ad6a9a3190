// What all study files have in common: [study] with a vehicle and what is held, [set] with keys that replace the
// vehicle's, and how a study file refuses.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/input_errors.hpp"
#include "files/toml_reader.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/files/two_sides_file.hpp"
#include "wingbeat/study/hold.hpp"

namespace wingbeat::detail {

using Kind = TomlNode::Kind;

/// What an error of a vehicle says, without its place: `key: reason`.
std::string reason_of(const InputError& error);

/// A sine on what has to turn.
bool swings_a_crank(const Design<double>& design);
inline constexpr const char* no_swinging_crank =
    "a sine supply gives no steady flapping in crank angle; expected constant or pwm";

/// What can be held beside the voltage: a key of study.hold, and an axis of a sweep.
struct HeldKey {
  std::string_view key;
  Held held;
  const char* unit;  ///< SI
  const char* name;  ///< in words
  const char* axis;  ///< of its variable in a data set, where no metric is called so
};
inline constexpr HeldKey held_keys[] = {
    {"frequency", Held::frequency, "Hz", "frequency", "frequency"},
    {"lift", Held::lift, "N", "mean lift", "lift"},
    {"lift_to_weight", Held::lift_to_weight, "1", "lift over the weight", "held_lift_to_weight"},
    {"power", Held::power, "W", "electrical power", "power"},
};
/// Of a value to be held.
std::string must_be_positive(std::string_view unit);
/// Null where the key is none of them.
const HeldKey* held_key(std::string_view key);
const HeldKey& held_key(Held held);  ///< other than the voltage
/// Why a vehicle's supply or mass allows no such hold; empty where it does.
std::string no_hold(const HeldKey& key, const Design<double>& design);
/// Whether a key of the vehicle has no effect where that is held.
bool is_void_at(const HeldKey& held, std::string_view key, const Design<double>& design);

/// Keys of the vehicle that a part of a study file gives, as [set] does.
struct KeySettings {
  std::map<std::string, const TomlNode*, std::less<>> values;
  std::string shown;  ///< what errors write before a key: "set"
};

/// The sections that every study file has. Derived classes read the others.
class StudySections : public TomlReader {
 public:
  /// Everything that refuses does so in the study file unless it names another. `sections` are those it may have beside
  /// [study] and [set], `keys` those of [study] beside vehicle, title, tolerance, metrics and hold.
  StudySections(std::string name, std::string_view text, std::span<const std::string> overrides,
                std::initializer_list<std::string_view> sections, std::initializer_list<std::string_view> keys = {});

  /// Keeps an InputError for finish(), so that all of them are reported; false if there was one.
  template <class Do>
  bool attempt(const Do& act) const {
    return errors_.attempt(act);
  }
  void finish() const { errors_.refuse(); }

  std::string vehicle_file() const;

  [[noreturn]] void refuse_file(const char* section, const char* key, const std::string& message) const;

  /// The vehicle in a file with [set], further settings, a held voltage and the overrides of the command line.
  Design<double> vehicle_in(const std::filesystem::path& vehicle,
                            std::span<const KeySettings* const> further = {}) const;
  /// vehicle_in() of a file that may have sides.
  VehicleFile sides_in(const std::filesystem::path& vehicle) const;

 protected:
  void known_keys(const TomlNode& table, const std::string& section,
                  std::initializer_list<std::string_view> known) const;
  void known_keys(const TomlNode& table, const std::string& section, std::span<const std::string_view> names) const;

  const TomlNode& need(const TomlNode& table, const std::string& section, std::string_view key,
                       std::string_view expected) const;

  /// The sections [[name]], none where there are none.
  std::span<const TomlNode> sections_of(const std::string& name) const;

  /// Refuses an override of the command line that the study would make void.
  void no_override_of(std::string_view key, const std::string& reason) const;

  // What studies share

  void read_tolerance(EnsembleOptions& options) const;
  void read_metrics(EnsembleOptions& options) const;
  /// What vehicles without a motor that heats up, without added mass, pitch hinges or wings with a shape do not have is
  /// no metric unless the study names it. Beside the endurance goes the time of hover, of vehicles whose mass is known.
  void complete_metrics(EnsembleOptions& options, std::span<const Design<double>* const> designs) const;
  std::string read_title() const;
  /// The vehicle with [set], its file being sought in that folder.
  Design<double> read_vehicle(const std::filesystem::path& folder,
                              std::span<const KeySettings* const> further = {}) const;
  VehicleFile read_sides(const std::filesystem::path& folder) const;
  /// Adds the keys of a table in which sections may be nested, below `path`.
  void read_keys(const TomlNode& table, const std::string& path, KeySettings& into) const;
  Metric metric_called(const TomlNode& node, const std::string& where, const std::string& name) const;
  /// Whether designs outside the model's domain count as best, feasible or hovering.
  bool read_allow_extrapolation() const;
  Condition read_condition() const;
  /// What is held but for the voltage, if anything. A vehicle that cannot hold it, or that has no steady flapping, is
  /// refused.
  std::optional<Hold> read_hold(const Design<double>& design) const;
  /// What a study holds that has such a key; without a check of the vehicle.
  Hold held_target() const;
  /// A number of the vehicle that can be varied and differentiated.
  DesignParameter parameter_named(const TomlNode& node, const std::string& where, const Design<double>& design) const;

  TomlNode root_;
  const TomlNode* study_ = nullptr;
  const TomlNode* held_voltage_ = nullptr;
  const TomlNode* held_target_ = nullptr;
  const HeldKey* held_key_ = nullptr;  ///< with it
  KeySettings set_{{}, "set"};

 private:
  /// What `read` makes of [set], further settings and a held voltage; what it refuses names their lines.
  template <class Read>
  auto with_settings(SupplyType supply, std::span<const KeySettings* const> further, const Read& read) const;
  std::filesystem::path found_vehicle(const std::filesystem::path& folder) const;
  const std::string* override_of(std::string_view key) const;
  void check_overrides() const;
  void find_hold();

  std::vector<std::string> overrides_;
  mutable InputErrors errors_;
  mutable std::set<std::pair<const TomlNode*, std::string>> spoiled_;  ///< keys that were misspelt
};

}  // namespace wingbeat::detail
