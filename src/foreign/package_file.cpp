// Implements the reading of the CALVADOS package's YAML files.
#include "foreign/package_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "scene/fields.hpp"
#include "scene/files.hpp"

namespace catena::foreign {

namespace {

using scene::Node;

constexpr double most_whole = 1e15;
constexpr double most_part = 1e-6;  // relative difference of numbers that are written in full

/// Parses a file of keys and values. Throws InputError for other contents.
std::unique_ptr<Node> parsed(std::string const& text, std::string const& file) {
    if (scene::holds_no_keys(text))
        throw InputError("the file holds no keys with values", scene::shown_path(file),
                         "write it again, or move it out of the folder");
    return scene::parse_document(text, file);
}

}  // namespace

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
    if (node == nullptr || are_equal(scene::number(*node) * unit, made)) return;
    scene::fail(*node,
                fmt::format("`{}` is {:.6g}, and {} was written with {:.6g}", key,
                            scene::number(*node), system, made / unit),
                run_again);
}

std::int64_t whole_of(Node const& node, std::int64_t least) {
    double const found = scene::number(node);
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
    return node ? scene::number(*node) : otherwise;
}

double PackageFile::non_negative(std::string_view key, double otherwise) const {
    Node const* const node = find(key);
    return node ? scene::non_negative(*node) : otherwise;
}

std::int64_t PackageFile::whole(std::string_view key, double otherwise, std::int64_t least) const {
    Node const* const node = find(key);
    return node ? whole_of(*node, least) : static_cast<std::int64_t>(otherwise);
}

bool PackageFile::truth(std::string_view key) const {
    Node const* const node = find(key);
    return node != nullptr && scene::truth(*node);
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
