// The assessed statements as text, JSON and CSV.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "wingbeat/core/text.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/reproduction/claims.hpp"
#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat {
namespace {

bool has_outcome(const Claim& c) {
  return c.outcome != StatementOutcome::not_checkable && c.outcome != StatementOutcome::no_published_value;
}
bool predicted(const Claim& c) { return c.basis == Basis::predicted && has_outcome(c) && !c.restates; }

constexpr const char* keys[variant_count] = {"rod-force", "virtual-work", "virtual-work-own-calibration"};

using Json = nlohmann::ordered_json;
Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json counts(const Score& s, std::size_t variants) {
  Json json;
  json["reproduced"] = s.reproduced;
  json["depends_on_the_formulation"] = s.depends;
  json["not_reproduced"] = s.not_reproduced;
  for (std::size_t f = 0; f < variants; ++f) json["met"][keys[f]] = s.met[f];
  return json;
}

Json json_score(const Assessment& a, const std::string& reading) {
  Json json{{"statements", a.score(reading).statements}};
  json.update(counts(a.score(reading), a.variants));
  json["with_changes_as_ratios"] = counts(a.score(reading, Scoring::ratios), a.variants);
  json["within_printed_digits"] = counts(a.score(reading, Scoring::digits), a.variants);
  return json;
}

Json json_interval(const Interval& i) { return std::isfinite(i.low) ? Json{i.low, i.high} : Json(nullptr); }

/// "29.1 to 37.0 %" in the number's own unit and digits.
std::string interval_words(const Interval& i, const Claim& c) {
  return std::isfinite(i.low) ? fmt::format("95 % {} to {}", number_text(i.low, c), number_text(i.high, c)) : "";
}

}  // namespace

const std::vector<ClaimGroup>& claim_groups() {
  static const std::vector<ClaimGroup> groups = {
      {"Predictions", "Predictions, sections 3 and 4 and conclusion",
       [](const Claim& c) { return predicted(c) && c.reading.empty(); }},
      {"Predictions of section 5, hinge offset held", "Predictions of section 5, hinge offset held",
       [](const Claim& c) { return predicted(c) && c.reading == readings[0]; }},
      {"Predictions of section 5, stroke held", "Predictions of section 5, stroke held",
       [](const Claim& c) { return predicted(c) && c.reading == readings[1]; }},
      {"The same facts stated once more, not counted", "The same facts stated once more, not counted",
       [](const Claim& c) { return c.basis == Basis::predicted && has_outcome(c) && c.restates; }},
      {"Given: what the published tables say by themselves, not counted", "Given by the published tables, not counted",
       [](const Claim& c) { return c.basis == Basis::given && has_outcome(c); }},
      {"Used in the calibration of S_2 and S_3, listed separately, not counted", "Used in the calibration, not counted",
       [](const Claim& c) { return c.basis == Basis::calibrated && has_outcome(c); }},
      {"Not checkable", "Not checkable", [](const Claim& c) { return c.outcome == StatementOutcome::not_checkable; }},
      {"No published value", "No published value",
       [](const Claim& c) { return c.outcome == StatementOutcome::no_published_value; }}};
  return groups;
}

std::string number_text(double x, const Claim& c) {
  if (!std::isfinite(x)) return "-";
  if (c.unit != "1") return readable(x, c.unit);
  const bool percent = c.published_text.find('%') != std::string::npos;
  if (percent) return fmt::format("{:#.4g} %", 100.0 * x);
  return c.published_text.find("percentage") != std::string::npos ? fmt::format("{:#.3g} points", 100.0 * x)
                                                                  : fmt::format("{:#.4g}", x);
}

std::string domain_text(const Claim& c, std::size_t variant) {
  if (!std::isfinite(c.residual[variant])) return "no cycle";
  return c.outside[variant] ? fmt::format("outside the domain, residual {:.1f} %", 100.0 * c.residual[variant])
                            : "inside";
}

std::string percent_text(double deviation) {
  if (!std::isfinite(deviation)) return "";
  return std::abs(deviation) < 5e-4 ? "0.0 %" : fmt::format("{:+.1f} %", 100.0 * deviation);
}

std::string outcome_text(const Claim& c) {
  std::string text = name_of(c.outcome);
  if (c.outcome == StatementOutcome::depends_on_formulation) {
    text += fmt::format(": {}", name_of(both_formulations[c.within[0] ? 0 : 1]));
  }
  return text;
}

std::string text_claims(const PublishedFile& file, const Assessment& a) {
  std::string text = wrapped(file.title, 96, 0) + "\n  " + wrapped("source: " + file.source, 94, 2) + "\n";
  auto out = std::back_inserter(text);
  for (const ClaimGroup& group : claim_groups()) {
    bool first = true;
    for (const Claim& c : a.claims) {
      if (!group.holds(c)) continue;
      if (std::exchange(first, false)) fmt::format_to(out, "\n{}\n", group.name);
      fmt::format_to(out, "  {}\n", wrapped(c.statement, 94, 2));
      std::string line = c.published_text == "-" ? "" : fmt::format("published {}; ", c.published_text);
      for (std::size_t f = 0; f < a.variants; ++f) {
        const std::string off = percent_text(c.deviation[f]);
        line += fmt::format("{} {}{}{}; ", f == recalibrated ? "with its own calibration" : variant_name(f),
                            c.ours_text[f], off.empty() ? "" : ", " + off,
                            std::isfinite(c.interval[f].low) ? " (" + interval_words(c.interval[f], c) + ")" : "");
      }
      line += outcome_text(c);
      if (!c.reason.empty()) line += fmt::format(": {}", c.reason);
      if (!c.window.empty()) line += fmt::format("; searched in {}", c.window);
      fmt::format_to(out, "      {}\n", wrapped(line, 90, 6));
      if (!c.erratum.empty()) fmt::format_to(out, "      {}\n", wrapped("error of the paper: " + c.erratum, 90, 6));
    }
  }
  const auto met = [&](const Score& s) {
    std::string m;
    for (std::size_t f = 0; f < a.variants; ++f) {
      m += fmt::format("{}{} meets {}", f == 0 ? "" : ", ",
                       f == recalibrated ? "virtual-work with its own calibration" : variant_name(f), s.met[f]);
    }
    return m;
  };
  if (!a.calibrations.empty()) {
    text += "\nS_2 and S_3 computed anew from the two published peak lifts\n";
    for (const MomentCalibration& c : a.calibrations) {
      fmt::format_to(out, "  {:<13} S_2 {:.4g} m4, S_3 {:.4g} m5: {} and {}, {}\n", name_of(c.formulation), c.s2, c.s3,
                     readable(c.lift_peak[0], "N"), readable(c.lift_peak[1], "N"),
                     c.met ? "as published" : "the nearest that it can come to both");
    }
  }
  constexpr std::pair<Scoring, const char*> ways[] = {{Scoring::printed, "as printed"},
                                                      {Scoring::ratios, "with changes as ratios"},
                                                      {Scoring::digits, "within the printed digits"}};
  text += '\n';
  for (const auto& [scoring, name] : ways) {
    const Score s = a.score("", scoring);
    fmt::format_to(
        out, "{}\n",
        wrapped(fmt::format("{} predictions, {}{}: {} reproduced in both formulations, {} depend on the "
                            "formulation, {} not reproduced; {}.",
                            s.statements, name,
                            scoring == Scoring::digits ? "" : fmt::format(", to {:g} %", 100.0 * file.tolerance),
                            s.reproduced, s.depends, s.not_reproduced, met(s)),
                96, 0));
  }
  for (const char* reading : readings) {
    const Score r = a.score(reading);
    if (r.statements == 0) continue;
    fmt::format_to(
        out, "{}\n",
        wrapped(fmt::format("{} predictions of section 5, {}: {}; crank radii off by {:.0f} % rms (rod-force).",
                            r.statements, reading, met(r), 100.0 * r.rms_crank_radius),
                96, 0));
  }
  return text;
}

std::string json_claims(const PublishedFile& file, const Assessment& a) {
  Json json;
  json["title"] = file.title;
  json["source"] = file.source;
  json["predictions"] = json_score(a, "");
  for (const char* reading : readings) {
    const Score s = a.score(reading);
    if (s.statements == 0) continue;
    Json& entry = json["section_5"][detail::underscored(reading)] = json_score(a, reading);
    entry["crank_radius_rms_deviation"] = number(s.rms_crank_radius);
  }
  json["calibration"] = Json::array();
  for (const MomentCalibration& c : a.calibrations) {
    json["calibration"].push_back({{"formulation", name_of(c.formulation)},
                                   {"s2_m4", number(c.s2)},
                                   {"s3_m5", number(c.s3)},
                                   {"lift_peak_n", {number(c.lift_peak[0]), number(c.lift_peak[1])}},
                                   {"published_n", {c.wanted[0], c.wanted[1]}},
                                   {"met", c.met}});
  }
  json["answer"] = Json::array();
  for (std::size_t f = 0; f < a.variants; ++f) {
    const TitleAnswer& t = a.answers[f];
    json["answer"].push_back({{"formulation", variant_name(f)},
                              {"frequency_hz", number(t.frequency)},
                              {"power_electrical_w", number(t.with)},
                              {"power_electrical_w_95", json_interval(t.with_interval)},
                              {"without_friction_w", number(t.without)},
                              {"without_friction_w_95", json_interval(t.without_interval)},
                              {"change", number(t.change)},
                              {"change_95", json_interval(t.change_interval)},
                              {"residual", number(t.residual_with)},
                              {"residual_without_friction", number(t.residual_without)},
                              {"inside_the_domain", !t.outside}});
  }
  json["samples"] = a.samples;
  json["claims"] = Json::array();
  for (const Claim& c : a.claims) {
    Json entry;
    entry["statement"] = c.statement;
    entry["where"] = c.where;
    entry["basis"] = name_of(c.basis);
    entry["counted"] = c.counted();
    entry["reading"] = c.reading.empty() ? Json(nullptr) : Json(c.reading);
    entry["unit"] = c.unit;
    entry["published"] = c.published ? Json(*c.published) : Json(nullptr);
    entry["published_text"] = c.published_text;
    entry["tolerance"] = number(c.tolerance);
    entry["printed_digits"] = number(c.digits);
    entry["searched_in"] = c.window.empty() ? Json(nullptr) : Json(c.window);
    for (std::size_t f = 0; f < a.variants; ++f) {
      Json& side = entry[keys[f]];
      side["value"] = number(c.ours[f]);
      side["text"] = c.ours_text[f];
      side["deviation"] = number(c.deviation[f]);
      side["ratio_deviation"] = number(c.ratio_deviation[f]);
      side["interval_95"] = json_interval(c.interval[f]);
      side["interval_from"] =
          std::isfinite(c.interval[f].low) ? Json(c.searched ? "searches" : "samples") : Json(nullptr);
      side["residual"] = number(c.residual[f]);
      side["domain"] = domain_text(c, f);
      side["within"] = has_outcome(c) ? Json(c.within[f]) : Json(nullptr);
    }
    entry["outcome"] = name_of(c.outcome);
    for (const auto& [key, said] :
         {std::pair("reason", &c.reason), std::pair("note", &c.note), std::pair("erratum", &c.erratum)}) {
      if (!said->empty()) entry[key] = *said;
    }
    json["claims"].push_back(entry);
  }
  json["friction_laws"] = Json::array();
  for (const LawPrediction& p : a.laws) {
    Json entry;
    entry["law"] = name_of(p.law.law);
    entry["drag_factor"] = p.drag_factor;
    entry["drag_factor_95"] = json_interval(p.drag_interval);
    entry["input_change_by_springs_95"] = json_interval(p.input_change_interval);
    entry["formulation"] = variant_name(p.variant);
    entry["coefficient"] = p.law.coefficient;
    entry["calibrated"] = p.law.calibrated;
    entry["frequency_hz"] = number(p.law.frequency);
    entry["values"] = p.tests.size();
    entry["rms_deviation"] = number(p.rms);
    entry["rms_deviation_as_ratios"] = number(p.rms_of_ratios);
    json["friction_laws"].push_back(entry);
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string csv_claims(const Assessment& a) {
  const auto field = [](const std::string& text) {
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
  };
  const auto digits = [](double x) { return std::isfinite(x) ? fmt::format("{:.9g}", x) : std::string(); };
  constexpr const char* columns[variant_count] = {"rod_force", "virtual_work", "virtual_work_own_calibration"};
  std::string text = "statement,where,basis,counted,reading,searched_in,unit,published,tolerance,printed_digits";
  for (std::size_t f = 0; f < a.variants; ++f) {
    text +=
        fmt::format(",{0},{0}_text,{0}_deviation,{0}_deviation_as_ratio,{0}_low_95,{0}_high_95,{0}_residual,{0}_domain",
                    columns[f]);
  }
  text += ",outcome,reason,note,erratum\n";
  for (const Claim& c : a.claims) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}", field(c.statement), field(c.where), name_of(c.basis),
                        c.counted() ? "yes" : "no", c.reading, c.window, c.unit,
                        c.published ? digits(*c.published) : "", digits(c.tolerance), digits(c.digits));
    for (std::size_t f = 0; f < a.variants; ++f) {
      text += fmt::format(",{},{},{},{},{},{},{},{}", digits(c.ours[f]), field(c.ours_text[f]), digits(c.deviation[f]),
                          digits(c.ratio_deviation[f]), digits(c.interval[f].low), digits(c.interval[f].high),
                          digits(c.residual[f]), field(domain_text(c, f)));
    }
    text += fmt::format(",{},{},{},{}\n", name_of(c.outcome), field(c.reason), field(c.note), field(c.erratum));
  }
  return text;
}

}  // namespace wingbeat
