// Strict reading of values. Each value must have the right type and length, numbers must be finite,
// and unknown keys are refused.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "keys/key.hpp"
#include "math/linear.hpp"
#include "math/rotation.hpp"
#include "scene/node.hpp"

namespace catena::scene {

using Names = std::initializer_list<std::string_view>;

/// A map with declared keys only. Throws InputError for a value that is not a map. Throws
/// InputError for an unknown key and names the nearest declared key, or all of them. Keys for later
/// versions are refused as not supported by this version.
class Fields {
  public:
    /// Checks the keys of `map` against the declared ones, which must outlive this object.
    Fields(Node const& map, KeyMap const& declared);

    Node const& node() const { return map_; }
    /// Returns nullptr if the key is absent. Throws InputError if the key has no value, and
    /// std::logic_error for a key that is not declared.
    Node const* find(std::string_view key) const;
    /// Throws InputError if the key is absent; `example`, e.g. "mass: 1.2", is the remedy.
    Node const& need(std::string_view key, std::string const& example) const;

  private:
    Node const& map_;
    KeyMap const* declared_;
};

/// Result of parse_number(). The grammar is strict: an optional sign, decimal digits with at most
/// one point, an optional exponent, nothing else.
enum class NumberFault { none, not_a_number, not_finite, out_of_range };
NumberFault parse_number(std::string_view text, double& value);

/// Reads a finite number.
double number(Node const&);
double positive(Node const&);
double non_negative(Node const&);
/// Reads digits, or a number without a fraction such as 1e6, in [least, most].
std::int64_t whole(Node const&, std::int64_t least, std::int64_t most = INT64_MAX);
std::uint64_t seed64(Node const&);
bool truth(Node const&);
/// Reads a text that is not empty.
std::string text(Node const&);
/// Reads a list of `count` finite numbers.
std::vector<double> numbers(Node const&, std::size_t count);
Vec3 vector3(Node const&);
/// Reads three rows of three numbers.
Mat3 matrix3(Node const&);
/// Returns the node itself; throws InputError unless it is a list.
Node const& list(Node const&);

/// Returns the known name nearest to `name` by edit distance. Returns nothing if none is near
/// enough to be a misspelling.
std::optional<std::string> nearest(std::string_view name, std::span<std::string_view const> known);
/// Names in backquotes, separated by commas, for messages.
std::string joined(std::span<std::string_view const> names);

/// Reads one of the names of `choices`. Throws InputError otherwise, "not in this version" for
/// names of `later`.
template <class Value>
Value choice(Node const& node, std::span<std::pair<std::string_view, Value> const> choices,
             Names later = {});
template <class Value>
Value choice(Node const& node, std::initializer_list<std::pair<std::string_view, Value>> choices,
             Names later = {});

/// Throws the InputError for a name that is not among the choices; used by the template choice().
[[noreturn]] void refuse_choice(Node const&, std::vector<std::string_view> const& choices,
                                Names later);

template <class Value>
Value choice(Node const& node, std::initializer_list<std::pair<std::string_view, Value>> choices,
             Names later) {
    return choice(node, std::span(choices.begin(), choices.size()), later);
}

template <class Value>
Value choice(Node const& node, std::span<std::pair<std::string_view, Value> const> choices,
             Names later) {
    std::vector<std::string_view> names;
    for (auto const& [name, value] : choices) {
        if (node.kind == Node::Kind::scalar && node.text == name) return value;
        names.push_back(name);
    }
    refuse_choice(node, names, later);
}

}  // namespace catena::scene
