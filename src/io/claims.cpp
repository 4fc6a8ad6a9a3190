#include "wingbeat/io/claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "wingbeat/io/design_parameter.hpp"
#include "wingbeat/io/report.hpp"
#include "wingbeat/study/bench_fit.hpp"
#include "wingbeat/study/trend.hpp"

namespace wingbeat {
namespace {

constexpr int loss_points = 13;
constexpr double most_loss_stiffness = 1.5;  ///< of the springs of the vehicle that has them

std::string spaced(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

PublishedFile with_formulation(PublishedFile file, Formulation formulation) {
  for (auto& [name, design] : file.designs) design.transmission.formulation = formulation;
  return file;
}

/// A number for reading.
std::string shown(double x, const std::string& unit) {
  if (!std::isfinite(x)) return "-";
  if (unit == "1") return fmt::format("{:#.4g}", x);
  return readable(x, unit);
}

struct Answer {
  double value = absent;
  std::string remark;
};

Answer along(const PublishedFile& file, const PublishedTrend& t) {
  const bool frequency = t.over.empty();
  const auto value_of = [&](const std::string& name, double x) {
    Design<double> design = file.designs.at(name);
    RunOptions options;
    options.tolerance = 1e-8;
    design.supply = {SupplyType::constant, t.voltage.value_or(design.supply.voltage), 0.0, 1.0};
    if (frequency) {
      options.frequency = x;
    } else {
      if (t.hold_stroke) {
        const SliderCrank<double> crank = resolve(design).crank;
        design.transmission.stroke_amplitude = std::atan(crank.crank_radius / crank.hinge_offset);
        design.transmission.hinge_offset.reset();
      }
      design_parameter(t.over).set(design, x);
      try {
        validate(design);
      } catch (const ParameterError&) {
        return absent;
      }
    }
    const RunResult run = run_design(design, options);
    const bool reached = !run.search || run.search->outcome == FrequencyOutcome::reached;
    const bool counts = run.status == FlappingStatus::flapping && reached && run.domain.none();
    return counts ? run.metrics[t.metric] : absent;
  };
  if (t.kind == PublishedTrend::Kind::crossing) {
    const auto ratio = [&](double x) { return value_of(t.design, x) / value_of(*t.relative_to, x); };
    Answer answer{crossing_along(ratio, 1.0, t.from, t.to), ""};
    if (!std::isfinite(answer.value)) answer.remark = "never";
    return answer;
  }
  const TrendPeak peak = highest_along([&](double x) { return value_of(t.design, x); }, t.from, t.to);
  Answer answer{t.kind == PublishedTrend::Kind::peak ? peak.value : peak.at, ""};
  const std::string unit = frequency ? "Hz" : design_parameter(t.over).unit;
  if (t.kind == PublishedTrend::Kind::peak) {
    answer.remark = fmt::format("at {}", readable(peak.at, unit));
  } else {
    const MetricInfo& info = metric_info(t.metric);
    answer.remark =
        t.metric == Metric::lift_mean ? readable(peak.value, info.unit) : fmt::format("{:.2f} %", 100.0 * peak.value);
  }
  if (!peak.inside) {
    const double end = std::abs(peak.at - t.to) < std::abs(peak.at - t.from) ? t.to : t.from;
    answer.remark +=
        std::abs(peak.at - end) < 1e-3 * (t.to - t.from) ? ", end of the range" : ", at the edge of flapping";
  }
  return answer;
}

Answer answer_to(const PublishedFile& file, const PublishedTrend& t) {
  using Kind = PublishedTrend::Kind;
  if (t.kind == Kind::crossing || t.kind == Kind::peak_at || t.kind == Kind::peak) return along(file, t);
  if (t.kind == Kind::best_friction_law) return {};
  const Design<double>& design = file.designs.at(t.design);
  const Vehicle<double> vehicle = resolve(design);
  switch (t.kind) {
    case Kind::constant_load_efficiency:
      return {best_constant_load_efficiency(vehicle.motor, *t.voltage), ""};
    case Kind::spring_resonance:
      return {std::sqrt(vehicle.spring.stiffness / vehicle.wing_inertia) / two_pi, ""};
    case Kind::weight:
      return {total_mass(design).value_or(absent) * standard_gravity, ""};
    default:
      return {};
  }
}

Verdict verdict_of(const Claim& c) {
  if (c.within[0] && c.within[1]) return Verdict::reproduced;
  return c.within[0] || c.within[1] ? Verdict::depends_on_formulation : Verdict::not_reproduced;
}

void settle(Claim& c) {
  for (std::size_t f = 0; f < 2; ++f) {
    if (c.published) {
      c.deviation[f] = c.ours[f] / *c.published - 1.0;
      c.within[f] = std::abs(c.deviation[f]) <= c.tolerance;
    }
  }
  c.verdict = c.published ? verdict_of(c) : Verdict::as_found;
  c.published_text = c.published ? shown(*c.published, c.unit) : "-";
}

LawPrediction predict(const PublishedFile& file, FrictionLaw law, Formulation formulation) {
  PublishedFile changed = with_formulation(file, formulation);
  const PublishedValue& target = calibration_value(file);
  Design<double> calibrated = changed.designs.at(target.design);
  calibrated.supply = {SupplyType::constant, *target.voltage, 0.0, 1.0};
  LawPrediction p;
  p.law = calibrate_friction(calibrated, law, target.published);
  double stiffness = 0.0;
  for (auto& [name, design] : changed.designs) {
    design.friction = {law, p.law.coefficient};
    stiffness = std::max(stiffness, resolve(design).spring.stiffness);
  }
  p.comparison = compare(changed);
  double squares = 0.0;
  std::optional<double> frequency;
  for (std::size_t n = 0; n < p.comparison.values.size(); ++n) {
    const PublishedValue& v = p.comparison.values[n].published;
    if (v.design == target.design) continue;
    p.tests.push_back(n);
    squares += std::pow(p.comparison.values[n].deviation, 2.0);
    if (v.frequency) frequency = v.frequency;
  }
  p.rms = p.tests.empty() ? absent : std::sqrt(squares / double(p.tests.size()));
  if (frequency && stiffness > 0.0) {
    p.loss = loss_along_stiffness(changed.designs.at(target.design), *frequency, most_loss_stiffness * stiffness,
                                  loss_points);
  }
  return p;
}

const std::pair<const char*, std::function<bool(const Claim&)>> groups[] = {
    {"Predicted", [](const Claim& c) { return c.basis == Basis::predicted && c.verdict != Verdict::as_found; }},
    {"Given: what the published tables say by themselves", [](const Claim& c) { return c.basis == Basis::given; }},
    {"Calibrated: looked at when what is not published was chosen, so no evidence",
     [](const Claim& c) { return c.basis == Basis::calibrated; }},
    {"As found: the paper shows it, but no number is at hand",
     [](const Claim& c) { return c.verdict == Verdict::as_found; }}};

std::string percent(double deviation) {
  if (!std::isfinite(deviation)) return "";
  return std::abs(deviation) < 5e-4 ? "0.0 %" : fmt::format("{:+.1f} %", 100.0 * deviation);
}

std::string verdict_text(const Claim& c) {
  std::string text = name_of(c.verdict);
  if (c.verdict == Verdict::depends_on_formulation) {
    text += fmt::format(": {}", name_of(both_formulations[c.within[0] ? 0 : 1]));
  }
  return text;
}

}  // namespace

const char* name_of(Verdict verdict) {
  constexpr const char* names[] = {"reproduced", "not reproduced", "depends on formulation", "as found"};
  return names[std::size_t(verdict)];
}

const char* name_of(Formulation formulation) {
  return formulation == Formulation::rod_force ? "rod-force" : "virtual-work";
}

int Judgement::count(Verdict verdict) const {
  return int(std::count_if(claims.begin(), claims.end(), [&](const Claim& c) { return c.verdict == verdict; }));
}

const PublishedValue& calibration_value(const PublishedFile& file) {
  for (const PublishedValue& v : file.values) {
    if (v.metric == Metric::frequency && v.voltage && !v.relative_to) return v;
  }
  throw std::runtime_error("the published values hold no flapping frequency at a voltage to calibrate friction to");
}

Judgement judge(const PublishedFile& file, const ForEach& for_each, const std::function<void(double)>& done) {
  Judgement j;
  std::array<PublishedFile, 2> files;
  for (std::size_t f = 0; f < 2; ++f) files[f] = with_formulation(file, both_formulations[f]);
  const std::size_t trends = file.trends.size();
  std::array<std::vector<Answer>, 2> answers{std::vector<Answer>(trends), std::vector<Answer>(trends)};
  const bool laws_wanted = std::any_of(file.trends.begin(), file.trends.end(), [](const PublishedTrend& t) {
    return t.kind == PublishedTrend::Kind::best_friction_law;
  });
  std::vector<std::function<void()>> tasks;
  for (std::size_t f = 0; f < 2; ++f) {
    tasks.push_back([&, f] { j.comparisons[f] = compare(files[f]); });
    for (std::size_t t = 0; t < trends; ++t) {
      tasks.push_back([&, f, t] { answers[f][t] = answer_to(files[f], file.trends[t]); });
    }
  }
  if (laws_wanted) {
    j.laws.resize(2 * std::size(compared_friction_laws));
    for (std::size_t n = 0; n < j.laws.size(); ++n) {
      tasks.push_back([&, n] {
        j.laws[n] = predict(file, compared_friction_laws[n % std::size(compared_friction_laws)],
                            both_formulations[n / std::size(compared_friction_laws)]);
      });
    }
  }
  std::mutex mutex;
  std::size_t finished = 0;
  for_each(tasks.size(), [&](std::size_t n) {
    tasks[n]();
    const std::lock_guard<std::mutex> lock(mutex);
    if (done) done(double(++finished) / double(tasks.size()));
  });

  for (std::size_t n = 0; n < file.values.size(); ++n) {
    const PublishedValue& v = file.values[n];
    const MetricInfo& info = metric_info(v.metric);
    Claim c;
    c.statement =
        fmt::format("{}, {}{} at {}", info.long_name, spaced(v.design),
                    v.relative_to ? " over " + spaced(*v.relative_to) : "", operating_point(v.voltage, v.frequency));
    c.where = v.where;
    c.basis = v.basis;
    c.unit = v.relative_to ? "1" : info.unit;
    c.published = v.published;
    c.tolerance = v.tolerance;
    for (std::size_t f = 0; f < 2; ++f) {
      c.ours[f] = j.comparisons[f].values[n].computed;
      c.ours_text[f] = shown(c.ours[f], c.unit);
    }
    settle(c);
    j.claims.push_back(std::move(c));
  }
  for (std::size_t n = 0; n < trends; ++n) {
    const PublishedTrend& t = file.trends[n];
    Claim c;
    c.statement = t.statement;
    c.where = t.where;
    c.basis = t.basis;
    c.unit = t.unit;
    c.published = t.published;
    if (t.published) c.tolerance = t.tolerance;
    for (std::size_t f = 0; f < 2; ++f) {
      const Answer& answer = answers[f][n];
      c.ours[f] = answer.value;
      c.ours_text[f] = shown(answer.value, t.unit);
      if (!answer.remark.empty()) c.ours_text[f] += fmt::format(" ({})", answer.remark);
    }
    settle(c);
    if (t.kind == PublishedTrend::Kind::best_friction_law) {
      for (std::size_t f = 0; f < 2; ++f) {
        const auto first = j.laws.begin() + long(f * std::size(compared_friction_laws));
        const auto best =
            std::min_element(first, first + long(std::size(compared_friction_laws)),
                             [](const LawPrediction& p, const LawPrediction& q) { return p.rms < q.rms; });
        c.ours_text[f] = fmt::format("{} ({:.1f} % rms)", law_name(best->law.law), 100.0 * best->rms);
        c.within[f] = t.published_law == best->law.law;
      }
      c.published_text = t.published_law ? law_name(*t.published_law) : "-";
      c.verdict = t.published_law ? verdict_of(c) : Verdict::as_found;
    }
    j.claims.push_back(std::move(c));
  }
  return j;
}

std::string text_claims(const PublishedFile& file, const Judgement& judgement) {
  std::string text = wrapped(file.title, 96, 0) + "\n  " + wrapped("source: " + file.source, 94, 2) + "\n";
  auto out = std::back_inserter(text);
  for (const auto& [name, belongs] : groups) {
    bool first = true;
    for (const Claim& c : judgement.claims) {
      if (!belongs(c)) continue;
      if (std::exchange(first, false)) fmt::format_to(out, "\n{}\n", name);
      fmt::format_to(out, "  {}\n", wrapped(c.statement, 94, 2));
      const auto side = [&](std::size_t f) {
        const std::string off = percent(c.deviation[f]);
        return fmt::format("{} {}{}", name_of(both_formulations[f]), c.ours_text[f], off.empty() ? "" : ", " + off);
      };
      std::string line = c.published_text == "-" ? "" : fmt::format("published {}; ", c.published_text);
      line += fmt::format("{}; {}", side(0), side(1));
      if (c.verdict != Verdict::as_found) line += fmt::format("; {}", verdict_text(c));
      fmt::format_to(out, "      {}\n", wrapped(line, 90, 6));
    }
  }
  const int open = judgement.count(Verdict::as_found);
  fmt::format_to(out, "\n{} statements: {} reproduced, {} not reproduced, {} depend on the formulation; {} as found.\n",
                 judgement.claims.size() - std::size_t(open), judgement.count(Verdict::reproduced),
                 judgement.count(Verdict::not_reproduced), judgement.count(Verdict::depends_on_formulation), open);
  return text;
}

std::string json_claims(const PublishedFile& file, const Judgement& judgement) {
  using Json = nlohmann::ordered_json;
  const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  Json json;
  json["title"] = file.title;
  json["source"] = file.source;
  for (const Verdict v :
       {Verdict::reproduced, Verdict::not_reproduced, Verdict::depends_on_formulation, Verdict::as_found}) {
    json["verdicts"][spaced(name_of(v))] = judgement.count(v);
  }
  json["claims"] = Json::array();
  for (const Claim& c : judgement.claims) {
    Json entry;
    entry["statement"] = c.statement;
    entry["where"] = c.where;
    entry["basis"] = name_of(c.basis);
    entry["unit"] = c.unit;
    entry["published"] = c.published ? Json(*c.published) : Json(nullptr);
    entry["published_text"] = c.published_text;
    entry["tolerance"] = number(c.tolerance);
    for (std::size_t f = 0; f < 2; ++f) {
      Json& side = entry[name_of(both_formulations[f])];
      side["value"] = number(c.ours[f]);
      side["text"] = c.ours_text[f];
      side["deviation"] = number(c.deviation[f]);
      side["within"] = c.verdict == Verdict::as_found ? Json(nullptr) : Json(c.within[f]);
    }
    entry["verdict"] = name_of(c.verdict);
    json["claims"].push_back(entry);
  }
  json["friction_laws"] = Json::array();
  for (const LawPrediction& p : judgement.laws) {
    Json entry;
    entry["law"] = law_name(p.law.law);
    entry["formulation"] = name_of(p.law.formulation);
    entry["coefficient"] = p.law.coefficient;
    entry["calibrated"] = p.law.calibrated;
    entry["frequency_hz"] = number(p.law.frequency);
    entry["rms_deviation"] = number(p.rms);
    json["friction_laws"].push_back(entry);
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string csv_claims(const Judgement& judgement) {
  const auto field = [](const std::string& text) {
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
  };
  const auto number = [](double x) { return std::isfinite(x) ? fmt::format("{:.9g}", x) : std::string(); };
  std::string text =
      "statement,where,basis,unit,published,tolerance,rod_force,rod_force_text,rod_force_deviation,"
      "virtual_work,virtual_work_text,virtual_work_deviation,verdict\n";
  for (const Claim& c : judgement.claims) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", field(c.statement), field(c.where),
                        name_of(c.basis), c.unit, c.published ? number(*c.published) : "", number(c.tolerance),
                        number(c.ours[0]), field(c.ours_text[0]), number(c.deviation[0]), number(c.ours[1]),
                        field(c.ours_text[1]), number(c.deviation[1]), name_of(c.verdict));
  }
  return text;
}

}  // namespace wingbeat
