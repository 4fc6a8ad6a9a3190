#include "wingbeat/files/bench_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "files/bench_columns.hpp"
#include "files/free_parameter.hpp"
#include "files/input_errors.hpp"
#include "files/table_form.hpp"
#include "files/toml_fields.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/drive.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

using detail::ColumnName, detail::metric_columns, detail::waveform_quantities;

/// Strings that name waveform quantities, as unknown_zero has them.
constexpr const char* zero_example = "expected a list of quantities, as [\"stroke_angle\"]";

class BenchReader {
 public:
  BenchReader(const std::filesystem::path& file, std::span<const std::string> overrides, std::vector<LogNotes>* notes)
      : path_(file),
        overrides_(overrides),
        notes_(notes),
        name_(input_name(file)),
        tree_(parse_toml_tree(read_text_file(file), name_)),
        root_(name_, "", tree_) {}

  BenchFit read() {
    const std::string_view sections[] = {"bench", "fit", "parameter", "deviation", "log", "balance"};
    errors_.attempt([&] { root_.known_keys(sections); });
    const auto bench = root_.table("bench");
    if (!bench) root_.refuse("bench", "missing section [bench] with the name of a vehicle file");
    const std::string_view bench_keys[] = {"vehicle", "title", "source"};
    errors_.attempt([&] { bench->known_keys(bench_keys); });
    errors_.attempt([&] { bench->text("title"), bench->text("source"); });
    BenchFit fit;
    errors_.attempt([&] { read_options(fit); });
    const bool has_vehicle = errors_.attempt([&] {
      const std::string vehicle = bench->needed_text("vehicle", "the name of a vehicle file");
      fit.design = read_design(find_vehicle(path_.parent_path(), vehicle), overrides_);
    });
    if (!has_vehicle) errors_.refuse();  // the rest is read for this vehicle
    errors_.attempt([&] { read_balance(fit); });
    errors_.attempt([&] { read_parameters(fit); });
    errors_.attempt([&] { read_logs(fit); });
    errors_.refuse();
    read_deviations(fit);
    return fit;
  }

 private:
  void read_options(BenchFit& fit) const {
    const auto options = root_.table("fit");
    if (!options) return;
    const std::string_view keys[] = {"loss", "loss_scale", "starts", "seed", "tolerance"};
    options->known_keys(keys);
    fit.loss = options->choice<Loss>("loss", Loss::none);
    fit.loss_scale = options->quantity("loss_scale", "1").value_or(fit.loss_scale);
    if (!(fit.loss_scale >= min_loss_scale && fit.loss_scale <= max_loss_scale)) {
      options->refuse(
          options->at("loss_scale"), "loss_scale",
          fmt::format("must lie between {:g} and {:g} standard deviations, got {:g}: elsewhere the coverage "
                      "of intervals is not as stated",
                      min_loss_scale, max_loss_scale, fit.loss_scale));
    }
    fit.starts = options->count("starts", 1).value_or(1);
    if (fit.starts > max_fit_starts) {
      options->refuse(
          options->at("starts"), "starts",
          fmt::format("must be at most {}, got {}; every start is a whole fit", max_fit_starts, fit.starts));
    }
    fit.seed = std::uint64_t(options->count("seed", 0).value_or(1));
    fit.tolerance = options->quantity("tolerance", "1").value_or(fit.tolerance);
    if (!(fit.tolerance >= 1e-12 && fit.tolerance <= 1e-3)) {
      options->refuse(options->at("tolerance"), "tolerance", "must lie between 1e-12 and 1e-3");
    }
  }

  static const char* positive_text(const BalanceNumber& n) { return n.may_be_zero ? "must be >= 0" : "must be > 0"; }

  void read_balance(BenchFit& fit) const {
    const auto section = root_.table("balance");
    if (!section) return;
    std::vector<std::string_view> keys;
    for (const BalanceNumber& n : balance_numbers) keys.push_back(n.key);
    section->known_keys(keys);
    Balance balance;
    for (const BalanceNumber& n : balance_numbers) {
      const double x = balance.*n.number = section->needed_quantity(n.key, n.unit);
      if (!(n.may_be_zero ? x >= 0.0 : x > 0.0)) section->refuse(section->at(n.key), n.key, positive_text(n));
    }
    fit.balance = balance;
  }

  /// A free number of the balance; false where the key is another one.
  bool read_of_balance(const TomlFields& p, const std::string& key, const BenchFit& fit, FreeParameter& free) const {
    free.of_bench = balance_unknown(key);
    if (!free.of_bench) return false;
    if (!fit.balance) p.refuse(p.at("key"), "key", key + " needs the section [balance]");
    const BalanceNumber& n = *free.of_bench->of_balance;
    free.parameter.key = key;
    free.parameter.unit = n.unit;
    free.lower = p.needed_quantity("lower", n.unit);
    free.upper = p.needed_quantity("upper", n.unit);
    free.start = p.quantity("start", n.unit).value_or((*fit.balance).*n.number);
    if (!(n.may_be_zero ? free.lower >= 0.0 : free.lower > 0.0)) p.refuse(p.at("lower"), "lower", positive_text(n));
    return true;
  }

  void read_parameters(BenchFit& fit) {
    const auto read_one = [&](const TomlFields& p) {
      const std::string_view keys[] = {"key", "lower", "upper", "start"};
      p.known_keys(keys);
      const std::string key = p.needed_text("key", "a number of the vehicle file, such as \"friction.radius\"");
      FreeParameter free;
      if (!read_of_balance(p, key, fit, free)) {
        free = detail::bounded_parameter(p, key);
        const std::optional<double> own = free.parameter.value(fit.design);
        const auto start = p.quantity("start", free.parameter.unit);
        if (!start && !own) p.refuse("start", fmt::format("missing; the vehicle file has no {}", key));
        free.start = start ? *start : *own;
      }
      if (!(free.lower < free.upper)) p.refuse(p.at("lower"), "lower", "must lie below upper");
      if (!(free.start >= free.lower && free.start <= free.upper)) {
        p.refuse(p.at("start"), "start",
                 fmt::format("must lie within the bounds, is {} {}", free.start, free.parameter.unit));
      }
      for (const double x : {free.lower, free.upper}) {
        if (free.of_bench) break;
        Design<double> design = fit.design;
        try {
          set_parameter(design, key, x);
          validate(design);
        } catch (const ParameterError& error) {
          p.refuse(p.at(x == free.lower ? "lower" : "upper"), x == free.lower ? "lower" : "upper", error.what());
        }
      }
      for (const FreeParameter& before : fit.parameters) {
        if (before.parameter.key == key) p.refuse(p.at("key"), "key", fmt::format("{} is given twice", key));
      }
      if (p.has("start")) {
        for (const std::string& assignment : overrides_) {
          if (!assignment.starts_with(key + "=")) continue;
          throw InputError("--set " + one_line(assignment, 120), 0, 0, key,
                           "has no effect: the bench file gives its start");
        }
      }
      fit.parameters.push_back(free);
    };
    const auto sections = root_.tables("parameter");
    for (const TomlFields& p : sections) errors_.attempt([&] { read_one(p); });
    if (sections.empty()) root_.refuse("parameter", "missing: which parameters are free? Give [[parameter]] sections");
  }

  void read_logs(BenchFit& fit) {
    const bool has_springs = fit.design.spring.stiffness || fit.design.spring.resonance;
    const auto read_one = [&](const TomlFields& l) {
      const std::string_view keys[] = {"file",      "condition",       "springs",   "given",
                                       "measured",  "voltage",         "frequency", "columns",
                                       "separator", "decimal",         "triggered", "sampling_rate",
                                       "burst",     "cycle_frequency", "cycles",    "unknown_zero"};
      l.known_keys(keys);
      const std::string file = l.needed_text("file", "the name of a CSV file");
      LogRequest request;
      request.log.condition = l.choice<Condition>("condition");
      const auto springs = l.boolean("springs");
      if (!springs && has_springs && request.log.condition != Condition::wingless) {
        l.refuse("springs", "missing; the vehicle file has springs: true, or false where they were taken off");
      }
      request.log.springs = springs.value_or(false) && request.log.condition != Condition::wingless;
      if (springs.value_or(false) && !has_springs) l.refuse(l.at("springs"), "springs", "the vehicle file has none");
      if (l.has("given")) request.given = l.choice<Given>("given");
      const auto voltage = l.quantity("voltage", "V"), frequency = l.quantity("frequency", "Hz");
      if (voltage && frequency) l.refuse(l.at("frequency"), "frequency", "give voltage or frequency, not both");
      if (voltage || frequency) {
        request.given = voltage ? Given::voltage : Given::frequency;
        request.given_value = voltage ? *voltage : *frequency;
        if (!(*request.given_value > 0.0)) l.refuse(voltage ? "voltage" : "frequency", "must be > 0");
      }
      if (const TomlNode* measured = l.node().find("measured")) {
        if (measured->kind != TomlNode::Kind::array) l.refuse(*measured, "measured", "expected a list of column names");
        for (const TomlNode& item : measured->items) {
          if (item.kind != TomlNode::Kind::text) l.refuse(item, "measured", "expected a list of column names");
          request.measured.push_back(item.text);
        }
      }
      read_waveform(l, fit, request);
      detail::StatedTable stated = detail::stated_table(l, "lift_mean");
      request.separator = stated.form.separator;
      request.decimal = stated.form.decimal;
      request.columns = std::move(stated.columns);
      const std::filesystem::path path = path_.parent_path() / file;
      std::string text;
      try {
        text = read_text_file(path);
      } catch (const InputError& error) {
        l.refuse(l.at("file"), "file", error.what());
      }
      LogNotes understood;
      fit.logs.push_back(parse_log(text, path.string(), request, &understood));
      if (notes_) notes_->push_back(std::move(understood));
      check_columns(l, fit);
      check_waveform(l, fit);
    };
    const auto sections = root_.tables("log");
    for (const TomlFields& l : sections) errors_.attempt([&] { read_one(l); });
    if (sections.empty()) root_.refuse("log", "missing: what was measured? Give [[log]] sections");
  }

  void read_waveform(const TomlFields& l, const BenchFit& fit, LogRequest& request) const {
    const auto positive = [&](const char* key, const char* unit) {
      const std::optional<double> value = l.quantity(key, unit);
      if (value && !(*value > 0.0)) l.refuse(l.at(key), key, "must be > 0");
      return value;
    };
    request.sampling_rate = positive("sampling_rate", "Hz");
    request.burst = positive("burst", "s");
    request.cycle_frequency = positive("cycle_frequency", "Hz");
    request.cycles = l.count("cycles", 1);
    request.alternating = drive_of(fit.design).alternating;
    request.needs_point = true;
    request.log.phase_known = l.boolean("triggered").value_or(false);
    const TomlNode* zeros = l.node().find("unknown_zero");
    if (!zeros) return;
    if (zeros->kind != TomlNode::Kind::array) l.refuse(*zeros, "unknown_zero", zero_example);
    for (const TomlNode& item : zeros->items) {
      const ColumnName* column =
          item.kind == TomlNode::Kind::text ? detail::column_named(item.text, waveform_quantities()) : nullptr;
      if (!column) l.refuse(item, "unknown_zero", zero_example);
      request.log.unknown_zeros.push_back(column->quantity.quantity);
    }
  }

  /// What is stated of waveforms fits to what the file is.
  void check_waveform(const TomlFields& l, const BenchFit& fit) const {
    const BenchLog& log = fit.logs.back();
    for (const WaveformQuantity q : log.unknown_zeros) {
      const MeasuredQuantity wanted{true, {}, q};
      if (std::find(log.columns.begin(), log.columns.end(), wanted) == log.columns.end()) {
        l.refuse(l.at("unknown_zero"), "unknown_zero", fmt::format("the log has no waveform of {}", name_of(q)));
      }
    }
    if (log.in_time) return;
    for (const char* key : {"burst", "cycle_frequency", "triggered"}) {
      if (l.has(key)) l.refuse(l.at(key), key, "is of a record in time, and the file has no times");
    }
  }

  void check_columns(const TomlFields& l, const BenchFit& fit) const {
    for (const MeasuredQuantity& q : fit.logs.back().columns) {
      if (q.waveform) continue;
      if (q.metric == Metric::power_motor_reference && !fit.design.bench_torque_constant) {
        l.refuse(l.at("file"), "file", "power_motor_reference needs [bench] torque_constant in the vehicle file");
      }
      if (q.metric == Metric::lift_to_weight && !fit.design.mass) {
        l.refuse(l.at("file"), "file", "lift_to_weight needs [vehicle] mass in the vehicle file");
      }
      if (q.metric == Metric::hover || q.metric == Metric::endurance) {
        l.refuse(l.at("file"), "file",
                 fmt::format("{} is a whole flight's: a cycle cannot be fitted to it", metric_info(q.metric).key));
      }
      if (const char* lacks = missing_key(q.metric, fit.design)) {
        l.refuse(l.at("file"), "file",
                 fmt::format("{} needs {} in the vehicle file", metric_info(q.metric).key, lacks));
      }
      if (q.metric == Metric::floquet_multiplier_max)
        l.refuse(l.at("file"), "file", "a Floquet multiplier cannot be fitted");
    }
  }

  /// `{ relative = 0.01 }`, `{ absolute = "0.1 Hz" }` or "estimated".
  Deviation deviation_at(const TomlFields& section, std::string_view key, const std::string& unit) const {
    const TomlNode& node = *section.node().find(key);
    if (node.kind == TomlNode::Kind::text && node.text == "estimated") return {Deviation::Kind::estimated, 0.0};
    const char* expected = "expected { relative = 0.01 }, { absolute = \"a quantity\" } or \"estimated\"";
    if (node.kind != TomlNode::Kind::table || node.members.size() != 1) section.refuse(node, key, expected);
    const TomlFields form(name_, section.name_of(key), node);
    const std::string_view keys[] = {"relative", "absolute"};
    form.known_keys(keys);
    Deviation d;
    if (form.has("relative")) {
      d = {Deviation::Kind::relative, *form.quantity("relative", "1")};
    } else if (unit.empty()) {
      section.refuse(node, key, "an absolute deviation belongs to one column");
    } else {
      d = {Deviation::Kind::absolute, unit == "degree" ? degrees_per_radian * *form.quantity("absolute", "rad")
                                      : unit == "degC" ? *form.quantity("absolute", "K")
                                                       : *form.quantity("absolute", unit)};
    }
    if (!(d.value > 0.0)) section.refuse(node, key, "must be > 0");
    return d;
  }

  /// Whether every value of a column has the standard deviation that the log itself shows.
  static bool shows_scatter(const BenchLog& log, std::size_t c) {
    return std::all_of(log.rows.begin(), log.rows.end(), [&](const BenchRow& row) {
      return std::isnan(row.values[c]) || (c < row.deviations.size() && std::isfinite(row.deviations[c]));
    });
  }
  static bool shows_all_scatter(const BenchLog& log) {
    for (std::size_t c = 0; c < log.columns.size(); ++c) {
      if (!shows_scatter(log, c)) return false;
    }
    return true;
  }

  void read_deviations(BenchFit& fit) const {
    const auto section = root_.table("deviation");
    const bool all_known = std::all_of(fit.logs.begin(), fit.logs.end(), shows_all_scatter);
    if (!section && !all_known) {
      root_.refuse("deviation",
                   "missing section [deviation]: how well was each column measured? For example default = "
                   "{ relative = 0.01 }, or \"estimated\"");
    }
    std::vector<std::string_view> keys = {"default"};
    for (const ColumnName& c : metric_columns()) keys.push_back(c.name);
    for (const ColumnName& c : waveform_quantities()) keys.push_back(c.name);
    if (section) section->known_keys(keys);
    for (BenchLog& log : fit.logs) {
      for (std::size_t c = 0; c < log.columns.size(); ++c) {
        const MeasuredQuantity& q = log.columns[c];
        const auto& known = q.waveform ? waveform_quantities() : metric_columns();
        const ColumnName& column =
            *std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.quantity == q; });
        if (shows_scatter(log, c) && !(section && section->has(column.name))) {
          fit.deviations.try_emplace(q, Deviation{Deviation::Kind::scatter, 0.0});
          continue;
        }
        for (BenchRow& row : log.rows) {
          if (c < row.deviations.size()) row.deviations[c] = absent;
        }
        if (section && section->has(column.name)) {
          fit.deviations[q] = deviation_at(*section, column.name, column.unit);
        } else if (section && section->has("default")) {
          fit.deviations[q] = deviation_at(*section, "default", "");
        } else {
          (section ? *section : root_)
              .refuse(column.name, fmt::format("missing: the standard deviation of this column of {}", log.file));
        }
        if (fit.deviations[q].kind != Deviation::Kind::relative) continue;
        for (const BenchRow& row : log.rows) {
          if (row.values[c] == 0.0) {
            throw InputError(log.file, row.line, 1, column.name, "is 0: give an absolute standard deviation");
          }
        }
      }
    }
  }

  std::filesystem::path path_;
  std::span<const std::string> overrides_;
  std::vector<LogNotes>* notes_;
  InputErrors errors_;
  std::string name_;
  TomlNode tree_;
  TomlFields root_;
};

}  // namespace

std::filesystem::path vehicle_of_bench(const std::filesystem::path& file) {
  const TomlNode tree = parse_toml_tree(read_text_file(file), file.string());
  const TomlNode* bench = tree.find("bench");
  const TomlNode* vehicle = bench ? bench->find("vehicle") : nullptr;
  if (!vehicle) throw InputError(file.string(), 0, 0, "bench.vehicle", "missing; expected the name of a vehicle file");
  return find_vehicle(file.parent_path(), vehicle->text);
}

BenchFit read_bench(const std::filesystem::path& file, std::span<const std::string> overrides,
                    std::vector<LogNotes>* notes) {
  return BenchReader(file, overrides, notes).read();
}

}  // namespace wingbeat
