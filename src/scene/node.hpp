// The scene file as a tree: values with their line and their place, so that every message can name
// both. Far smaller than yaml-cpp's own tree, and it sees what that one hides: duplicate keys,
// quoted numbers, second documents.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "error.hpp"

namespace catena::scene {

struct Node {
    enum class Kind : std::uint8_t { null, scalar, list, map };

    Kind kind = Kind::null;
    bool quoted = false;           // a scalar in quotes is text, never a number
    int line = 0;                  // from 1; 0: given by --set
    std::string key;               // in the map that holds this value
    std::string text;              // of a scalar; of the root: the file's name
    std::vector<Node> items;       // of a list or a map
    Node const* parent = nullptr;  // nullptr: the root

    Node const* find(std::string_view name) const;
    /// As in --set: "chains[0].bodies[2].mass", list indices from 0; empty for the root.
    std::string path() const;
    /// Number, from 1, of the body that this value belongs to; 0 when it belongs to none.
    std::int64_t body() const;
    /// "file: path, body k, line n"; k: `index` where it is given, else body().
    std::string where(char const* noun = "body", std::int64_t index = 0) const;
};

/// Parses YAML text into a tree whose root is a map. Throws InputError (with the line) for a syntax
/// error, an empty or second document, duplicate keys, keys that are no plain text, tags, and
/// aliases that refer to themselves or multiply without bound.
std::unique_ptr<Node> parse_document(std::string const& text, std::string const& file);

/// Parses one YAML value; `origin` stands for the file in messages, lines are 0.
Node parse_value(std::string const& text, std::string const& origin);

/// Sets every `parent` below `node`; needed after a change of the tree.
void link_parents(Node& node);

/// "a map", "a list", "nothing", "`text`": for messages.
std::string describe(Node const&);

/// The text in one line, without control characters, cut at `longest` characters.
std::string shown(std::string_view text, std::size_t longest = 60);
/// A file's name, whole.
inline std::string shown_path(std::string_view path) { return shown(path, 4096); }

[[noreturn]] void fail(Node const& at, std::string const& what, std::string const& remedy);

/// As fail, for the entry `body` (from 1) of something that has no node of its own; `noun`: "body"
/// or "bead".
[[noreturn]] void fail_at(Node const& at, char const* noun, std::int64_t body,
                          std::string const& what, std::string const& remedy);

/// The contract knows `feature`, this version does not.
[[noreturn]] void fail_later(Node const& at, std::string const& feature);

}  // namespace catena::scene
