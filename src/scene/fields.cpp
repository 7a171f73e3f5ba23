// Implements the strict readers of scalars, vectors and names.
#include "scene/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace catena::scene {

namespace {

bool among(std::string_view name, std::span<std::string_view const> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Levenshtein distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            std::size_t const above = row[j];
            row[j] =
                std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
            diagonal = above;
        }
    }
    return row[b.size()];
}

/// Returns a name in lower case, without the marks between its words: `CALVADOS_2` is `calvados2`.
std::string folded(std::string_view name) {
    std::string plain;
    for (char const c : name)
        if (c != '_' && c != '-' && c != ' ')
            plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return plain;
}

/// Returns the node's key, or the key of the list that holds it.
std::string const& name_of(Node const& node) {
    return node.key.empty() && node.parent ? name_of(*node.parent) : node.key;
}

/// Throws InputError unless the node is an unquoted scalar.
Node const& scalar(Node const& node, char const* expected, char const* remedy) {
    if (node.kind != Node::Kind::scalar || node.quoted)
        fail(node, describe(node) + " is not " + expected, remedy);
    return node;
}

/// Words of other programs, each with the key that says the same in maps that have it.
constexpr std::pair<std::string_view, std::string_view> synonyms[] = {
    {"force", "torque"},
    {"load", "wrench"},
    {"effort", "torque"},
    {"position", "q"},
    {"angle", "q"},
    {"velocity", "qd"},
    {"rate", "qd"},
    {"spring", "stiffness"},
    {"damper", "damping"},
    {"origin", "translation"},
    {"offset", "translation"},
    {"orientation", "rotation"},
    {"center_of_mass", "com"},
    {"dt", "step"},
    {"timestep", "step"},
    {"time_step", "step"},
    {"nsteps", "steps"},
    {"temp", "temperature"},
    {"gamma", "friction"},
    {"interval", "every"},
    {"frequency", "every"},
    {"stride", "every"},
    {"copies", "count"},
    {"salt", "ionic_strength"},
    {"ionic", "ionic_strength"},
};

/// Returns the declared key that says the same as `name`; nothing if there is none.
std::optional<std::string> synonym(std::string_view name, KeyMap const& declared) {
    for (auto const& [word, key] : synonyms)
        if (word == name && declared.find(key)) return std::string(key);
    return std::nullopt;
}

/// Throws the InputError for a key that is not declared.
[[noreturn]] void refuse_key(Node const& item, KeyMap const& declared) {
    if (among(item.key, declared.later)) fail_later(item, "key `" + item.key + "`");
    std::vector<std::string_view> const names = declared.names();
    std::vector<std::string_view> all = names;
    all.insert(all.end(), declared.later.begin(), declared.later.end());
    auto near = synonym(item.key, declared);
    if (!near) near = nearest(item.key, all);
    if (item.key == "<<")
        fail(item, "merge keys `<<` are not read", "write the keys out; an alias is a whole value");
    fail(item, "unknown key `" + shown(item.key) + "`",
         near ? "did you mean `" + *near + "`?" : "use one of " + joined(names));
}

}  // namespace

Fields::Fields(Node const& map, KeyMap const& declared) : map_(map), declared_(&declared) {
    if (map.kind != Node::Kind::map)
        fail(map, describe(map) + " is not a map",
             "give a map with keys among " + joined(declared.names()));
    for (Node const& item : map.items)
        if (!declared.find(item.key)) refuse_key(item, declared);
}

Node const* Fields::find(std::string_view key) const {
    if (!declared_->find(key))
        throw std::logic_error(
            fmt::format("key `{}` is not declared among those of {}", key, declared_->name));
    Node const* const found = map_.find(key);
    if (found && found->kind == Node::Kind::null)
        fail(*found, fmt::format("key `{}` has no value", key), "give one or leave the key out");
    return found;
}

Node const& Fields::need(std::string_view key, std::string const& example) const {
    Node const* const found = find(key);
    if (!found) fail(map_, fmt::format("key `{}` is missing", key), "add `" + example + "`");
    return *found;
}

NumberFault parse_number(std::string_view text, double& value) {
    std::string_view digits = text;
    if (!digits.empty() && (digits[0] == '+' || digits[0] == '-')) digits.remove_prefix(1);
    if (digits.empty()) return NumberFault::not_a_number;
    if (digits[0] != '.' && (digits[0] < '0' || digits[0] > '9')) {
        std::string lower(digits);
        std::transform(lower.begin(), lower.end(), lower.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        return lower == "nan" || lower == "inf" || lower == "infinity" ? NumberFault::not_finite
                                                                       : NumberFault::not_a_number;
    }
    if (digits == ".nan" || digits == ".NaN" || digits == ".NAN" || digits == ".inf" ||
        digits == ".Inf" || digits == ".INF")
        return NumberFault::not_finite;
    char const* const begin = &digits.front();
    char const* const end = begin + digits.size();
    auto const result = std::from_chars(begin, end, value);
    if (result.ec == std::errc::invalid_argument || result.ptr != end)
        return NumberFault::not_a_number;
    if (result.ec != std::errc()) return NumberFault::out_of_range;
    if (text[0] == '-') value = -value;
    return NumberFault::none;
}

double number(Node const& node) {
    char const* const remedy = "give a finite decimal number such as 0.38";
    double value = 0;
    switch (parse_number(scalar(node, "a number", remedy).text, value)) {
        case NumberFault::none:
            return value;
        case NumberFault::not_a_number:
            fail(node, describe(node) + " is not a number", remedy);
        case NumberFault::not_finite:
            fail(node, describe(node) + " is not finite", remedy);
        case NumberFault::out_of_range:
            break;
    }
    fail(node, describe(node) + " is beyond the range of double precision", remedy);
}

double positive(Node const& node) {
    double const value = number(node);
    if (!(value > 0))
        fail(node, fmt::format("{} {} is not positive", name_of(node), value),
             "give a number above 0");
    return value;
}

double non_negative(Node const& node) {
    double const value = number(node);
    if (!(value >= 0))
        fail(node, fmt::format("{} {} is negative", name_of(node), value),
             "give 0 or a positive number");
    return value;
}

std::int64_t whole(Node const& node, std::int64_t least, std::int64_t most) {
    char const* const remedy = "give a whole number such as 1000";
    std::string const& digits = scalar(node, "a whole number", remedy).text;
    std::int64_t value = 0;
    auto const result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (result.ec != std::errc() || result.ptr != digits.data() + digits.size()) {
        double real = 0;
        bool const is_whole =
            parse_number(digits, real) == NumberFault::none && real == std::floor(real);
        if (is_whole && real > 0x1p53)
            fail(node, fmt::format("{} {} is above {}", name_of(node), digits, most),
                 fmt::format("give {} or less", most));
        if (!is_whole || real < -0x1p53)
            fail(node, describe(node) + " is not a whole number", remedy);
        value = static_cast<std::int64_t>(real);
    }
    if (value < least)
        fail(node, fmt::format("{} {} is below {}", name_of(node), value, least),
             fmt::format("give {} or more", least));
    if (value > most)
        fail(node, fmt::format("{} {} is above {}", name_of(node), value, most),
             fmt::format("give {} or less", most));
    return value;
}

std::uint64_t seed64(Node const& node) {
    char const* const remedy = "give a whole number from 0 to 18446744073709551615";
    std::string const& digits = scalar(node, "a seed", remedy).text;
    std::uint64_t value = 0;
    auto const result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (result.ec != std::errc() || result.ptr != digits.data() + digits.size())
        fail(node, describe(node) + " is not a seed", remedy);
    return value;
}

bool truth(Node const& node) {
    std::string const& word = scalar(node, "true or false", "give true or false").text;
    if (word != "true" && word != "false")
        fail(node, describe(node) + " is not true or false", "give true or false");
    return word == "true";
}

std::string text(Node const& node) {
    if (node.kind != Node::Kind::scalar || node.text.empty())
        fail(node, describe(node) + " is not a text", "give a text");
    return node.text;
}

Node const& list(Node const& node) {
    if (node.kind != Node::Kind::list)
        fail(node, describe(node) + " is not a list", "give a list in brackets or with dashes");
    return node;
}

std::vector<double> numbers(Node const& node, std::size_t count) {
    std::string const remedy = fmt::format("give {} numbers in brackets", count);
    if (node.kind != Node::Kind::list) fail(node, describe(node) + " is not a list", remedy);
    if (node.items.size() != count)
        fail(node, fmt::format("the list has {} entries, not {}", node.items.size(), count),
             remedy);
    std::vector<double> values;
    for (Node const& item : node.items) values.push_back(number(item));
    return values;
}

Vec3 vector3(Node const& node) {
    std::vector<double> const v = numbers(node, 3);
    return {{v[0], v[1], v[2]}};
}

Mat3 matrix3(Node const& node) {
    if (node.kind != Node::Kind::list)
        fail(node, describe(node) + " is not a list", "give 3 rows of 3 numbers");
    if (node.items.size() != 3)
        fail(node, fmt::format("the matrix has {} rows, not 3", node.items.size()),
             "give 3 rows of 3 numbers");
    Mat3 m;
    for (int i = 0; i < 3; ++i) {
        Vec3 const row = vector3(node.items[static_cast<std::size_t>(i)]);
        for (int j = 0; j < 3; ++j) m(i, j) = row[j];
    }
    return m;
}

std::optional<std::string> nearest(std::string_view name, std::span<std::string_view const> known) {
    if (name.size() > 60) return std::nullopt;
    std::string const plain = folded(name);
    std::size_t best = std::max<std::size_t>(2, name.size() / 3) + 1;
    std::optional<std::string> found;
    for (std::string_view const candidate : known) {
        std::size_t const distance = edit_distance(plain, folded(candidate));
        if (distance < best && distance < candidate.size()) {
            best = distance;
            found = std::string(candidate);
        }
    }
    return found;
}

std::string joined(std::span<std::string_view const> names) {
    std::string line;
    for (std::string_view const name : names)
        line += (line.empty() ? "`" : ", `") + std::string(name) + "`";
    return line;
}

void refuse_choice(Node const& node, std::vector<std::string_view> const& choices, Names later) {
    if (node.kind == Node::Kind::scalar && among(node.text, {later.begin(), later.size()}))
        fail_later(node, fmt::format("`{}: {}`", node.key, node.text));
    std::vector<std::string_view> all = choices;
    all.insert(all.end(), later.begin(), later.end());
    auto const near = node.kind == Node::Kind::scalar ? nearest(node.text, all) : std::nullopt;
    std::string const remedy =
        near ? "did you mean `" + *near + "`?" : "use one of " + joined(choices);
    fail(node, fmt::format("{} is not a value of `{}`", describe(node), name_of(node)), remedy);
}

}  // namespace catena::scene
