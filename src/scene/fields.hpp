// Strict reading of values: the right type, the right length, finite numbers, no key that nobody
// reads.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "math/linear.hpp"
#include "math/rotation.hpp"
#include "scene/node.hpp"

namespace catena::scene {

using Names = std::initializer_list<std::string_view>;

/// A map whose keys are all known. Throws InputError for a value that is no map, for an unknown key
/// (naming the nearest known one, or all of them) and for keys of `later`, which the contract knows
/// and this version does not.
class Fields {
  public:
    Fields(Node const& map, Names known, Names later = {});

    Node const& node() const { return map_; }
    /// nullptr when the key is absent. InputError when it is there without a value.
    Node const* find(std::string_view key) const;
    /// InputError when the key is absent; `example`, e.g. "mass: 1.2", is the remedy.
    Node const& need(std::string_view key, std::string const& example) const;

  private:
    Node const& map_;
};

/// The strict grammar of a number: an optional sign, decimal digits with at most one point, an
/// optional exponent, nothing else.
enum class NumberFault { none, not_a_number, not_finite, out_of_range };
NumberFault parse_number(std::string_view text, double& value);

double number(Node const&);
double positive(Node const&);
double non_negative(Node const&);
/// Digits, or a number without a fraction such as 1e6, in [least, most].
std::int64_t whole(Node const&, std::int64_t least, std::int64_t most = INT64_MAX);
std::uint64_t seed64(Node const&);
bool truth(Node const&);
/// Not empty.
std::string text(Node const&);
std::vector<double> numbers(Node const&, std::size_t count);
Vec3 vector3(Node const&);
Mat3 matrix3(Node const&);
Node const& list(Node const&);

/// The known name nearest to `name` by edit distance, when it is near enough to be what was meant.
std::optional<std::string> nearest(std::string_view name, std::span<std::string_view const> known);
std::string joined(std::span<std::string_view const> names);

/// One of the names of `choices`; InputError otherwise, "not in this version" for those of `later`.
template <class Value>
Value choice(Node const& node, std::initializer_list<std::pair<std::string_view, Value>> choices,
             Names later = {});

/// What both templates and plain code say about a name that is not among the choices.
[[noreturn]] void refuse_choice(Node const&, std::vector<std::string_view> const& choices,
                                Names later);

template <class Value>
Value choice(Node const& node, std::initializer_list<std::pair<std::string_view, Value>> choices,
             Names later) {
    std::vector<std::string_view> names;
    for (auto const& [name, value] : choices) {
        if (node.kind == Node::Kind::scalar && node.text == name) return value;
        names.push_back(name);
    }
    refuse_choice(node, names, later);
}

}  // namespace catena::scene
