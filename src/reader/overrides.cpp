// Implements the parsing and application of overrides. The tree is changed before any key is read,
// so that overrides are checked like the file itself.
#include "reader/overrides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace catena::scene {

namespace {

/// One step of a path: a map key or, if `key` is empty, a list index.
struct Step {
    /// Map key; empty for an index.
    std::string key;
    /// List index, from 0.
    std::size_t index = 0;
};

/// A parsed override.
class Override {
  public:
    /// Parses "key.path=value"; throws InputError for a malformed text.
    explicit Override(std::string const& text) : origin_("--set " + shown(text)) {
        std::size_t const equals = text.find('=');
        if (equals == std::string::npos || equals == 0)
            refuse("not of the form `key.path=value`", "write, e.g., --set dynamics.steps=1000");
        value_ = text.substr(equals + 1);
        if (value_.find_first_not_of(" \t") == std::string::npos)
            refuse("the value is empty", "give one, or `null` to remove the key");
        read_path(text.substr(0, equals));
    }

    /// Follows the path from the root and replaces or removes the value there.
    void apply(Node& root) const {
        Node value = parse_value(value_, origin_);
        Node* at = &root;
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            bool const last = i + 1 == steps_.size();
            // `null` removes a key; a list entry becomes empty instead.
            if (last && value.kind == Node::Kind::null && !steps_[i].key.empty())
                return remove(*at, steps_[i].key);
            at = steps_[i].key.empty() ? &entry(*at, steps_[i].index) : &member(*at, steps_[i].key);
        }
        value.key = at->key;
        *at = std::move(value);
    }

  private:
    /// Throws InputError that quotes the option.
    [[noreturn]] void refuse(std::string const& what, std::string const& remedy) const {
        throw InputError(what, origin_, remedy);
    }

    /// Splits the path at its dots.
    void read_path(std::string const& path) {
        for (std::size_t begin = 0; begin <= path.size();) {
            std::size_t const end = std::min(path.find('.', begin), path.size());
            read_step(path.substr(begin, end - begin));
            begin = end + 1;
        }
    }
    /// Parses a key with any number of indices: "chains[0]".
    void read_step(std::string const& word) {
        std::size_t at = word.find('[');
        std::string const key = word.substr(0, at);
        if (key.empty()) refuse("a key in the path is empty", "write, e.g., chains[0].count");
        steps_.push_back({key, 0});
        while (at != std::string::npos && at < word.size()) {
            std::size_t const close = word.find(']', at);
            std::size_t index = 0;
            bool good = word[at] == '[' && close != std::string::npos;
            if (good) {
                auto const result =
                    std::from_chars(word.data() + at + 1, word.data() + close, index);
                good = result.ec == std::errc() && result.ptr == word.data() + close;
            }
            if (!good)
                refuse(fmt::format("`{}` is not a list index", shown(word.substr(at))),
                       "write a whole number from 0 in brackets, as in chains[0]");
            steps_.push_back({{}, index});
            at = close + 1;
        }
    }
    /// Returns the map's entry of that key, added if it is missing.
    Node& member(Node& map, std::string const& key) const {
        if (map.kind == Node::Kind::null) map.kind = Node::Kind::map;
        if (map.kind != Node::Kind::map)
            refuse(
                fmt::format("`{}` is {} and has no key `{}`", shown(map.key), describe(map), key),
                "correct the path");
        auto const found = std::find_if(map.items.begin(), map.items.end(),
                                        [&](Node const& item) { return item.key == key; });
        if (found != map.items.end()) return *found;
        map.items.emplace_back().key = key;
        return map.items.back();
    }
    /// Returns an entry of a list; throws InputError if the list is too short.
    Node& entry(Node& list, std::size_t index) const {
        if (list.kind == Node::Kind::null)
            refuse(fmt::format("there is no list `{}`", shown(list.key)), "correct the path");
        if (list.kind != Node::Kind::list)
            refuse(fmt::format("`{}` is not a list", shown(list.key)), "leave the index out");
        if (index >= list.items.size())
            refuse(fmt::format("index {} is beyond the list `{}` of {}", index, shown(list.key),
                               list.items.size()),
                   "indices are counted from 0");
        return list.items[index];
    }
    /// Removes the key if the node is a map that has it.
    static void remove(Node& map, std::string const& key) {
        std::erase_if(map.items, [&](Node const& item) {
            return map.kind == Node::Kind::map && item.key == key;
        });
    }

    /// Option as quoted in messages, and text of the value.
    std::string origin_, value_;
    std::vector<Step> steps_;
};

}  // namespace

void apply_override(Node& root, std::string const& override_text) {
    Override(override_text).apply(root);
    link_parents(root);
}

}  // namespace catena::scene
