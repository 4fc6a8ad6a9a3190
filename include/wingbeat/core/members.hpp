// One list of members for each part. The copy of a part to another scalar, the transfer of its numbers to lanes and the
// test that no number was forgotten all follow it.
//
// A part is a template on its scalar, an aggregate, and lists its members in the order of declaration:
//
//   template <class Self, class Use>
//   static constexpr auto members(Self& of, const Use& use) {
//     return use(of.stiffness, of.damping);
//   }
//
// Members are numbers (S or std::optional<S>), parts, or what is the same for every scalar: choices, texts, tables. A
// part that lanes do not know says so (`static constexpr bool off_lanes = true`): see OffLanes.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "wingbeat/core/scalar.hpp"

namespace wingbeat {
namespace detail {

struct AnyMembers {
  template <class... M>
  constexpr int operator()(M&...) const {
    return 0;
  }
};

template <class M>
inline constexpr bool is_optional = false;
template <Scalar S>
inline constexpr bool is_optional<std::optional<S>> = true;
template <class M>
inline constexpr bool is_shared = false;
template <class M>
inline constexpr bool is_shared<std::shared_ptr<M>> = true;

}  // namespace detail

/// A type with a list of its members.
template <class P>
concept ListsMembers = requires(P& part) { std::remove_const_t<P>::members(part, detail::AnyMembers{}); };

namespace detail {

template <class P>
struct ListIsComplete {
  template <class... M>
  constexpr auto operator()(M&...) const {
    return std::bool_constant<requires { P{std::declval<M>()...}; } && !requires { P{std::declval<M>()..., {}}; }>{};
  }
};

struct NumberCount {
  template <class M>
  static constexpr int of() {
    if constexpr (ListsMembers<M>) return decltype(M::members(std::declval<M&>(), NumberCount{}))::value;
    return Scalar<M> || is_optional<M>;
  }
  template <class... M>
  constexpr auto operator()(M&...) const {
    return std::integral_constant<int, (0 + ... + of<M>())>{};
  }
};

}  // namespace detail

/// True if the list of P holds each of its members: P can be initialised from the members listed and not from one more.
template <class P>
inline constexpr bool lists_every_member = decltype(P::members(std::declval<P&>(), detail::ListIsComplete<P>{}))::value;

/// How many numbers a part holds, those of its parts included.
template <class P>
inline constexpr int number_count = detail::NumberCount::of<P>();

/// Calls visit(number) for every number of a part and its parts, S or std::optional<S>, in the order of the lists.
template <class P, class Visit>
constexpr void for_each_number(P& part, const Visit& visit) {
  const auto each = [&visit](auto& member) {
    using M = std::remove_const_t<std::remove_reference_t<decltype(member)>>;
    if constexpr (ListsMembers<M>) {
      for_each_number(member, visit);
    } else if constexpr (Scalar<M> || detail::is_optional<M>) {
      visit(member);
    }
  };
  std::remove_const_t<P>::members(part, [&each](auto&... member) {
    (each(member), ...);
    return 0;
  });
}

/// Calls visit(number) for every number of a part of which `other`, the same part of another scalar, has one too.
template <class P, class Q, class Visit>
constexpr void for_each_number_in_both(P& part, Q& other, const Visit& visit) {
  const auto each = [&visit](auto& member, auto& its) {
    using M = std::remove_const_t<std::remove_reference_t<decltype(member)>>;
    using O = std::remove_const_t<std::remove_reference_t<decltype(its)>>;
    if constexpr (ListsMembers<M> && ListsMembers<O>) {
      for_each_number_in_both(member, its, visit);
    } else if constexpr (Scalar<M> || detail::is_optional<M>) {
      visit(member);
    }
  };
  std::remove_const_t<P>::members(part, [&](auto&... member) {
    return std::remove_const_t<Q>::members(other, [&](auto&... its) {
      (each(member, its), ...);
      return 0;
    });
  });
}

/// A member for a part that lanes do not know: they have a null pointer there, which takes no time to set up.
template <template <Scalar> class Part, Scalar S>
using OffLanes = std::conditional_t<ScalarTraits<S>::reads_tables, Part<S>, std::nullptr_t>;

template <Scalar T, template <Scalar> class Part, Scalar S>
constexpr auto cast(const Part<S>& part);

namespace detail {

/// Derivatives are dropped where a T has none.
template <Scalar T, Scalar S>
constexpr T converted_number(const S& x) {
  if constexpr (std::is_constructible_v<T, const S&>) return T(x);
  else return T(value_of(x));
}

template <class M>
concept NotOnLanes = M::off_lanes;

template <Scalar T, class M>
constexpr auto converted(const M& member) {
  if constexpr (!ScalarTraits<T>::reads_tables && (NotOnLanes<M> || is_shared<M>)) {
    return nullptr;
  } else if constexpr (ListsMembers<M>) {
    return cast<T>(member);
  } else if constexpr (Scalar<M>) {
    return converted_number<T>(member);
  } else if constexpr (is_optional<M>) {
    return member ? std::optional<T>(converted_number<T>(*member)) : std::nullopt;
  } else {
    return member;
  }
}

}  // namespace detail

/// A part with every number as a T, choices and texts carried along; tables where a T can read them. A Part<T>:
/// as a return type that is written down, clang 14 crashes on it.
template <Scalar T, template <Scalar> class Part, Scalar S>
constexpr auto cast(const Part<S>& part) {
  static_assert(lists_every_member<Part<S>>, "a member is missing in Part::members");
  return Part<S>::members(part, [](const auto&... member) { return Part<T>{detail::converted<T>(member)...}; });
}

}  // namespace wingbeat
