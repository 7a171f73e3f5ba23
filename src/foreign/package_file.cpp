// Implements the reading of the CALVADOS package's YAML files.
#include "foreign/package_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <regex>

#include "error.hpp"
#include "scene/fields.hpp"
#include "scene/files.hpp"

namespace catena::foreign {

namespace {

using scene::Node;

constexpr double most_whole = 1e15;
constexpr std::size_t longest_number = 100;  // characters
constexpr double most_part = 1e-6;  // relative difference of numbers that are written in full

/// Parses a file of keys and values. Throws InputError for other contents.
std::unique_ptr<Node> parsed(std::string const& text, std::string const& file) {
    if (scene::holds_no_keys(text))
        throw InputError("the file holds no keys with values", scene::shown_path(file),
                         "write it again, or move it out of the folder");
    return scene::parse_document(text, file);
}

/// Digits of an integer in a base that a sign and a prefix may precede.
std::optional<double> in_base(std::string_view digits, int base) {
    std::uint64_t value = 0;
    auto const read = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
    if (read.ec != std::errc() || read.ptr != digits.data() + digits.size()) return std::nullopt;
    return static_cast<double>(value);
}

/// Parts between colons, each worth 60 of the next; the last may have a fraction.
std::optional<double> in_base_60(std::string_view parts) {
    double sum = 0;
    while (!parts.empty()) {
        std::size_t const end = std::min(parts.find(':'), parts.size());
        double part = 0;
        if (scene::parse_number(parts.substr(0, end), part) != scene::NumberFault::none)
            return std::nullopt;
        sum = 60 * sum + part;
        parts.remove_prefix(std::min(end + 1, parts.size()));
    }
    return sum;
}

/// The number that PyYAML resolves an unquoted scalar to; nothing for texts, .inf and .nan. The
/// expressions are those of yaml/resolver.py.
std::optional<double> yaml_number(std::string text) {
    if (text.size() > longest_number) return std::nullopt;
    static std::regex const binary("[-+]?0b[01_]+"), octal("[-+]?0[0-7_]+"),
        hexadecimal("[-+]?0x[0-9a-fA-F_]+"),
        sixty(R"([-+]?([1-9][0-9_]*(:[0-5]?[0-9])+|[0-9][0-9_]*(:[0-5]?[0-9])+\.[0-9_]*))"),
        decimal(R"([-+]?(0|[1-9][0-9_]*|[0-9][0-9_]*\.[0-9_]*([eE][-+][0-9]+)?))"
                R"(|\.[0-9][0-9_]*([eE][-+][0-9]+)?)");
    auto const matches = [&](std::regex const& form) { return std::regex_match(text, form); };
    bool const two = matches(binary), sixteen = matches(hexadecimal), eight = matches(octal),
               colons = matches(sixty);
    if (!two && !sixteen && !eight && !colons && !matches(decimal)) return std::nullopt;
    std::erase(text, '_');
    double const sign = text[0] == '-' ? -1 : 1;
    std::string_view const digits = std::string_view(text).substr(text.find_first_not_of("+-"));
    std::optional<double> found;
    if (double value = 0; two || sixteen)
        found = in_base(digits.substr(2), two ? 2 : 16);
    else if (eight)
        found = in_base(digits, 8);
    else if (colons)
        found = in_base_60(digits);
    else if (scene::parse_number(digits, value) == scene::NumberFault::none)
        found = value;
    if (found) *found *= sign;
    return found;
}

std::optional<double> number_of_package(Node const& node) {
    bool const plain = node.kind == Node::Kind::scalar && !node.quoted;
    return plain ? yaml_number(node.text) : std::nullopt;
}

}  // namespace

double number_of(Node const& node) {
    std::optional<double> const found = number_of_package(node);
    return found ? *found : scene::number(node);
}

bool is_text_of_package(Node const& node) {
    double value = 0;
    return node.kind == Node::Kind::scalar && !node.quoted && !yaml_number(node.text) &&
           scene::parse_number(node.text, value) == scene::NumberFault::none;
}

bool truth_of(Node const& node) {
    if (std::optional<double> const found = number_of_package(node)) return *found != 0;
    static std::regex const yes("yes|Yes|YES|true|True|TRUE|on|On|ON"),
        no("no|No|NO|false|False|FALSE|off|Off|OFF");
    bool const plain = node.kind == Node::Kind::scalar && !node.quoted;
    if (plain && std::regex_match(node.text, yes)) return true;
    if (plain && std::regex_match(node.text, no)) return false;
    return scene::truth(node);
}

Node const* valued(Node const* entry) {
    bool const none = entry == nullptr || entry->kind == Node::Kind::null ||
                      entry->text == "null" || entry->text == "~";
    return none ? nullptr : entry;
}

bool are_equal(double a, double b) {
    return std::abs(a - b) <= most_part * std::max(std::abs(a), std::abs(b));
}

void refuse_another(PackageFile const& config, char const* key, double made, double unit,
                    std::string const& system) {
    Node const* const node = config.find(key);
    if (node == nullptr || are_equal(number_of(*node) * unit, made)) return;
    scene::fail(*node,
                fmt::format("`{}` is {:.6g}, and {} was written with {:.6g}", key, number_of(*node),
                            system, made / unit),
                run_again);
}

std::int64_t whole_of(Node const& node, std::int64_t least) {
    double const found = number_of(node);
    if (!(found >= static_cast<double>(least) && found <= most_whole && found == std::floor(found)))
        scene::fail(node, fmt::format("`{}` is not a whole number of {} or more", node.key, least),
                    "correct it");
    return static_cast<std::int64_t>(found);
}

PackageFile::PackageFile(std::string const& file) {
    Node at;
    at.text = file;
    root_ = parsed(scene::read_text_file(file, at), file);
}

Node const* PackageFile::find(std::string_view key) const { return valued(root_->find(key)); }

double PackageFile::number(std::string_view key, double otherwise) const {
    Node const* const node = find(key);
    return node ? number_of(*node) : otherwise;
}

double PackageFile::non_negative(std::string_view key, double otherwise) const {
    Node const* const node = find(key);
    if (node == nullptr) return otherwise;
    double const value = number_of(*node);
    if (!(value >= 0))
        scene::fail(*node, fmt::format("{} {:.9g} is negative", key, value),
                    "give 0 or a positive number");
    return value;
}

std::int64_t PackageFile::whole(std::string_view key, double otherwise, std::int64_t least) const {
    Node const* const node = find(key);
    return node ? whole_of(*node, least) : static_cast<std::int64_t>(otherwise);
}

bool PackageFile::truth(std::string_view key) const {
    Node const* const node = find(key);
    return node != nullptr && truth_of(*node);
}

std::string PackageFile::text(std::string_view key, char const* otherwise) const {
    Node const* const node = find(key);
    return node ? scene::text(*node) : otherwise;
}

std::string PackageFile::place(std::string_view key) const {
    Node const* const node = find(key);
    return scene::shown_path(node ? node->where() : root_->text);
}

}  // namespace catena::foreign
