#include "force/ghost_slots.hpp"

#include <algorithm>
#include <utility>

namespace catena {

void GhostSlots::make(std::vector<std::int64_t> like) {
    slot_.assign(kind_of_bead_.size(), -1);
    for (int const k : kind_of_bead_) kinds_ = std::max(kinds_, k + 1);
    like_ = std::move(like);
    bead_.assign(like_.size(), -1);
}

bool GhostSlots::take(std::span<std::int64_t const> beads) { return take(beads, false); }
bool GhostSlots::take_of_any_kind(std::span<std::int64_t const> beads) { return take(beads, true); }

bool GhostSlots::take(std::span<std::int64_t const> beads, bool of_any_kind) {
    if (beads.size() > bead_.size()) return false;
    std::vector<char> stays(bead_.size(), 0);
    std::vector<std::int64_t> come;
    for (std::int64_t const bead : beads) {
        if (slot(bead) < 0)
            come.push_back(bead);
        else
            stays[static_cast<std::size_t>(slot(bead))] = 1;
    }
    std::vector<std::vector<int>> free(static_cast<std::size_t>(kinds_));
    for (std::int64_t s = size() - 1; s >= 0; --s)
        if (!stays[static_cast<std::size_t>(s)]) free[static_cast<std::size_t>(kind(like(s)))].push_back(static_cast<int>(s));
    std::vector<int> slot_of_come(come.size(), -1);
    for (std::size_t i = 0; i < come.size(); ++i) {
        auto& of_kind = free[static_cast<std::size_t>(kind(come[i]))];
        if (of_kind.empty()) continue;
        slot_of_come[i] = of_kind.back();
        of_kind.pop_back();
    }
    if (!of_any_kind && std::find(slot_of_come.begin(), slot_of_come.end(), -1) != slot_of_come.end()) return false;
    std::size_t any = 0;
    for (std::size_t i = 0; i < come.size(); ++i) {
        if (slot_of_come[i] >= 0) continue;
        while (free[any].empty()) ++any;  // there are enough in all
        slot_of_come[i] = free[any].back();
        free[any].pop_back();
        like_[static_cast<std::size_t>(slot_of_come[i])] = come[i];
    }
    for (std::size_t s = 0; s < bead_.size(); ++s)
        if (!stays[s] && bead_[s] >= 0) slot_[static_cast<std::size_t>(std::exchange(bead_[s], -1))] = -1;
    for (std::size_t i = 0; i < come.size(); ++i) {
        slot_[static_cast<std::size_t>(come[i])] = slot_of_come[i];
        bead_[static_cast<std::size_t>(slot_of_come[i])] = come[i];
    }
    return true;
}

std::vector<int> GhostSlots::idle() const {
    std::vector<int> slots;
    for (std::int64_t s = 0; s < size(); ++s)
        if (bead_[static_cast<std::size_t>(s)] < 0) slots.push_back(static_cast<int>(s));
    return slots;
}

}  // namespace catena
