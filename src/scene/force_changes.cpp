// Implements the storage of changes as entries of OpenMmSpec::map: a control character, a letter
// for the list, and the text. The length of a link is stored bit by bit.
#include "scene/force_changes.hpp"

#include <bit>
#include <string_view>

namespace catena {

namespace {

constexpr char mark = '\x01';  // YAML allows no such character in a name
constexpr char extra = 'e', left_out = 'l', link = 'b';

bool is_change(std::string const& name) { return name.size() > 2 && name[0] == mark; }

void add(OpenMmSpec& spec, char list, std::string const& text, std::int64_t number) {
    spec.map.push_back({std::string{mark, list} + text, {number, 0}});
}

}  // namespace

void add_changes(ForceChanges const& changes, OpenMmSpec& spec) {
    for (std::string const& file : changes.extra) add(spec, extra, file, 0);
    for (std::string const& force : changes.leave_out) add(spec, left_out, force, 0);
    for (auto const& [force, length] : changes.links)
        add(spec, link, force, std::bit_cast<std::int64_t>(length));
}

ForceChanges changes_of(OpenMmSpec const& spec) {
    ForceChanges changes;
    for (auto const& [name, number] : spec.map) {
        if (!is_change(name)) continue;
        std::string const text = name.substr(2);
        if (name[1] == extra) changes.extra.push_back(text);
        if (name[1] == left_out) changes.leave_out.push_back(text);
        if (name[1] == link) changes.links.emplace_back(text, std::bit_cast<double>(number.first));
    }
    return changes;
}

ChainMap chain_map(OpenMmSpec const& spec) {
    ChainMap chains;
    for (auto const& entry : spec.map)
        if (!is_change(entry.first)) chains.push_back(entry);
    return chains;
}

}  // namespace catena
