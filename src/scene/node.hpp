// The scene file as a tree of values with their line and path, so that every message can name both.
// The tree is far smaller than yaml-cpp's own. It also detects duplicate keys, quoted numbers and
// second documents, which yaml-cpp hides.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "error.hpp"

namespace catena::scene {

/// One value of the scene file: empty, scalar, list or map.
struct Node {
    enum class Kind : std::uint8_t { null, scalar, list, map };

    Kind kind = Kind::null;
    /// True for a scalar in quotes, which is text and never a number.
    bool quoted = false;
    int line = 0;  // line number from 1; 0: given by --set
    /// Key in the map that holds this value.
    std::string key;
    /// Text of a scalar; the root holds the file's name.
    std::string text;
    /// Entries of a list or a map.
    std::vector<Node> items;
    Node const* parent = nullptr;  // nullptr: the root

    /// Returns the map's entry of that key, or nullptr.
    Node const* find(std::string_view name) const;
    /// Path in the syntax of --set: "chains[0].bodies[2].mass", list indices from 0; empty for the
    /// root.
    std::string path() const;
    /// Number (from 1) of the body that contains this value; 0 if no body does.
    std::int64_t body() const;
    /// Returns "file: path, body k, line n"; k is `index` unless 0, else body().
    std::string where(char const* noun = "body", std::int64_t index = 0) const;
};

/// Parses YAML text into a tree whose root is a map. Throws InputError with the line for a syntax
/// error, an empty or second document, duplicate keys and tags. Also refused are keys that are not
/// plain text, and aliases that refer to themselves or multiply without bound.
std::unique_ptr<Node> parse_document(std::string const& text, std::string const& file);

/// Parses one YAML value. `origin` takes the file's place in messages; lines are 0.
Node parse_value(std::string const& text, std::string const& origin);

/// Sets every `parent` below `node`. Call it after each change of the tree.
void link_parents(Node& node);

/// Describes a value for messages: "a map", "a list", "empty" or "`text`".
std::string describe(Node const&);

/// Returns the text in one line, without control characters, cut at `longest` characters.
std::string shown(std::string_view text, std::size_t longest = 60);
/// Returns the whole name of a file, in printable form.
inline std::string shown_path(std::string_view path) { return shown(path, 4096); }

/// Throws InputError with the place of the value.
[[noreturn]] void fail(Node const& at, std::string const& what, std::string const& remedy);

/// Throws like fail(), for the entry `body` (from 1) of a table without nodes; `noun` is "body" or
/// "bead".
[[noreturn]] void fail_at(Node const& at, char const* noun, std::int64_t body,
                          std::string const& what, std::string const& remedy);

/// Throws the error for a documented `feature` that this version does not support.
[[noreturn]] void fail_later(Node const& at, std::string const& feature);

}  // namespace catena::scene
