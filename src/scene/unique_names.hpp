// Names of chains that are made unique.
#pragma once

#include <fmt/format.h>

#include <string>
#include <unordered_map>
#include <unordered_set>

namespace catena::scene {

/// Makes names unique: the first chain keeps its name, the next ones are "A-2", "A-3", ...
class UniqueNames {
  public:
    /// Returns `name`, or the next free variant of it.
    std::string make(std::string const& name) {
        if (taken_.insert(name).second) return name;
        std::string unique;
        do {
            unique = fmt::format("{}-{}", name, 1 + ++copies_[name]);
        } while (!taken_.insert(unique).second);
        return unique;
    }

  private:
    std::unordered_set<std::string> taken_;
    std::unordered_map<std::string, std::size_t> copies_;
};

}  // namespace catena::scene
