// Results described once: the members of a result with key, unit and meaning. What --json prints, its JSON Schema, the
// tables of the manual and the explorer's types all follow from these descriptions.
#pragma once

#include <array>
#include <concepts>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "report/schema_tools.hpp"
#include "wingbeat/study/sweep.hpp"

namespace wingbeat::described {

using detail::Json;

/// How values of a type are written, and the schema of that.
template <class V>
struct Form;

template <>
struct Form<bool> {
  static Json schema() { return schema::yes_or_no; }
  static Json json(bool x) { return x; }
};
/// Counts.
template <std::integral I>
struct Form<I> {
  static Json schema() { return schema::any_count; }
  static Json json(I x) { return x; }
};
template <>
struct Form<double> {
  static Json schema() { return schema::number_if_any; }
  static Json json(double x) { return detail::number_or_null(x); }
};
template <class T>
  requires std::convertible_to<T, std::string_view>
struct Form<T> {
  static Json schema() { return schema::any_text; }
  static Json json(std::string_view x) { return std::string(x); }
};
template <NamedEnum E>
struct Form<E> {
  static Json schema() { return schema::one_of_names<E>(); }
  static Json json(E x) { return name_of(x); }
};
template <>
struct Form<Metric> {
  static Json schema() { return schema::metric_key(); }
  static Json json(Metric x) { return metric_info(x).key; }
};
/// Only with a schema of its own.
template <>
struct Form<Json> {
  static Json json(Json x) { return x; }
};
template <class X>
struct Form<std::optional<X>> {
  static Json schema() {
    if constexpr (std::is_same_v<X, double>) return Form<X>::schema();  // may be null anyway
    else return schema::or_null(Form<X>::schema());
  }
  static Json json(const std::optional<X>& x) { return x ? Form<X>::json(*x) : Json(nullptr); }
};
template <class X>
struct Form<std::span<const X>> {
  static Json schema() { return schema::listed(Form<X>::schema()); }
  static Json json(std::span<const X> list) {
    Json all = Json::array();
    for (const X& x : list) all.push_back(Form<X>::json(x));
    return all;
  }
};
template <class X>
struct Form<std::vector<X>> : Form<std::span<const X>> {};
template <class X>
struct Form<std::array<X, 2>> {
  static Json schema() { return schema::pair_of(Form<X>::schema()); }
  static Json json(const std::array<X, 2>& x) { return Json::array({Form<X>::json(x[0]), Form<X>::json(x[1])}); }
};
/// Values under keys that depend on the input.
template <class X>
struct Form<std::vector<std::pair<std::string, X>>> {
  static Json schema() { return schema::by_name(Form<X>::schema()); }
  static Json json(const std::vector<std::pair<std::string, X>>& list) {
    Json all = Json::object();
    for (const auto& [key, x] : list) all[key] = Form<X>::json(x);
    return all;
  }
};

/// What may be there or not: an optional or a pointer.
template <class V>
inline constexpr bool may_lack = std::is_pointer_v<V> && !std::convertible_to<V, std::string_view>;
template <class X>
inline constexpr bool may_lack<std::optional<X>> = true;

template <class V>
struct HeldBy {
  using type = V;
};
template <class X>
struct HeldBy<std::optional<X>> {
  using type = X;
};
template <class X>
struct HeldBy<const X*> {
  using type = X;
};

/// The members of results of type R, in the order in which they are written.
template <class R>
class Description {
  template <class Value>
  using Found = std::remove_cvref_t<std::invoke_result_t<const Value&, const R&>>;

 public:
  struct Member {
    std::string key;
    Json schema;  ///< with meaning and unit as its description
    bool always;  ///< else left out where `value` gives nothing
    std::function<std::optional<Json>(const R&)> value;
  };

  /// A key that is always there. `value`: a pointer to a member, or a function of the result. `form`: a schema narrower
  /// than that of the value's type.
  template <class Value>
  Description& always(std::string key, std::string_view unit, std::string_view meaning, Value value, Json form = {}) {
    using V = Found<Value>;
    if constexpr (!std::is_same_v<V, Json>) {
      if (form.is_null()) form = Form<V>::schema();
    }
    return add(std::move(key), unit, meaning, std::move(form), true,
               [value](const R& r) { return std::optional<Json>(Form<V>::json(std::invoke(value, r))); });
  }
  /// A key that is left out where the optional that `value` gives is empty.
  template <class Value>
  Description& sometimes(std::string key, std::string_view unit, std::string_view meaning, Value value,
                         Json form = {}) {
    using V = typename HeldBy<Found<Value>>::type;
    if constexpr (!std::is_same_v<V, Json>) {
      if (form.is_null()) form = Form<V>::schema();
    }
    return add(std::move(key), unit, meaning, std::move(form), false, [value](const R& r) {
      const auto found = std::invoke(value, r);
      return found ? std::optional<Json>(Form<V>::json(*found)) : std::nullopt;
    });
  }
  /// An object with members of its own; null where `value` gives an optional or a pointer, and nothing in it.
  template <class X, class Value>
  Description& part(std::string key, std::string_view meaning, const Description<X>& description, Value value) {
    using V = Found<Value>;
    Json form = description.schema();
    if constexpr (may_lack<V>) form = schema::or_null(std::move(form));
    return add(std::move(key), "", meaning, std::move(form), true, [value, description](const R& r) {
      const auto& found = std::invoke(value, r);
      if constexpr (may_lack<V>) return std::optional<Json>(found ? description.json(*found) : Json(nullptr));
      else return std::optional<Json>(description.json(found));
    });
  }
  /// A part that is left out where there is nothing.
  template <class X, class Value>
  Description& sometimes_part(std::string key, std::string_view meaning, const Description<X>& description,
                              Value value) {
    return add(std::move(key), "", meaning, description.schema(), false, [value, description](const R& r) {
      const auto& found = std::invoke(value, r);
      return found ? std::optional<Json>(description.json(*found)) : std::nullopt;
    });
  }
  /// A list of objects.
  template <class X, class Value>
  Description& parts(std::string key, std::string_view meaning, const Description<X>& description, Value value) {
    return add(
        std::move(key), "", meaning, schema::listed(description.schema()), true,
        [value, description](const R& r) { return std::optional<Json>(description.list(std::invoke(value, r))); });
  }
  /// All members of what `value` gives, among those of this result.
  template <class X, class Value>
  Description& all_of(const Description<X>& description, Value value) {
    for (const auto& m : description.members()) {
      members_.push_back({m.key, m.schema, m.always,
                          [value, shown_value = m.value](const R& r) { return shown_value(std::invoke(value, r)); }});
    }
    return *this;
  }

  const std::vector<Member>& members() const { return members_; }

  Json schema() const {
    schema::SchemaKeys always, sometimes;
    for (const Member& m : members_) (m.always ? always : sometimes).push_back({m.key, m.schema});
    return schema::object(always, sometimes);
  }
  Json json(const R& result) const {
    Json object = Json::object();
    for (const Member& m : members_) {
      if (std::optional<Json> value = m.value(result)) object[m.key] = std::move(*value);
    }
    return object;
  }
  template <class List>
  Json list(const List& results) const {
    Json all = Json::array();
    for (const R& result : results) all.push_back(json(result));
    return all;
  }

 private:
  Description& add(std::string key, std::string_view unit, std::string_view meaning, Json form, bool always,
                   std::function<std::optional<Json>(const R&)> value) {
    if (form.is_null()) throw std::logic_error("a member without a schema: " + key);
    std::string text(meaning);
    if (!unit.empty() && unit != "1") text += (text.empty() ? "[" : " [") + std::string(unit) + "]";
    members_.push_back({std::move(key), text.empty() ? std::move(form) : schema::with_text(std::move(form), text),
                        always, std::move(value)});
    return *this;
  }

  std::vector<Member> members_;
};

const Description<Metrics<double>>& metrics_description();
/// Those of a cycle: without hover_s and endurance_s.
const Description<Metrics<double>>& cycle_metrics_description();

/// What `value_at(result, status)` gives, by status; `what` it is: "designs".
template <class R, class Value>
void add_by_status(Description<R>& description, std::string_view what, Value value_at) {
  for (int s = 0; s < sweep_status_count; ++s) {
    const char* name = name_of(SweepStatus(s));
    description.always(name, "", std::string(what) + ": " + name,
                       [value_at, s](const R& r) { return value_at(r, std::size_t(s)); });
  }
}

}  // namespace wingbeat::described
