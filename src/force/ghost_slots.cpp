// Assignment of ghost pieces to particles of a Context.
#include "force/ghost_slots.hpp"

#include <algorithm>
#include <utility>

namespace catena {

void GhostSlots::make(std::vector<std::int64_t> like, int idle_before) {
    slot_.assign(pieces_.kind.size(), -1);
    for (int const k : pieces_.kind) kinds_ = std::max(kinds_, k + 1);
    like_ = std::move(like);
    piece_.assign(like_.size(), -1);
    idle_before_ = idle_before;
    offset_ = {idle_before};
    for (std::int64_t const piece : like_) offset_.push_back(offset_.back() + pieces_.of(piece));
}

bool GhostSlots::take(std::span<std::int64_t const> pieces) { return take(pieces, false); }
bool GhostSlots::take_of_any_kind(std::span<std::int64_t const> pieces) {
    return take(pieces, true);
}

bool GhostSlots::take(std::span<std::int64_t const> pieces, bool of_any_kind) {
    std::vector<char> stays(piece_.size(), 0);
    std::vector<std::int64_t> come;
    for (std::int64_t const piece : pieces) {
        int const slot = slot_[static_cast<std::size_t>(piece)];
        if (slot < 0)
            come.push_back(piece);
        else
            stays[static_cast<std::size_t>(slot)] = 1;
    }
    std::vector<std::vector<int>> free(static_cast<std::size_t>(kinds_));
    for (std::int64_t s = slots() - 1; s >= 0; --s)
        if (!stays[static_cast<std::size_t>(s)])
            free[static_cast<std::size_t>(kind(like_[static_cast<std::size_t>(s)]))].push_back(
                static_cast<int>(s));
    std::vector<int> slot_of_come(come.size(), -1);
    for (std::size_t i = 0; i < come.size(); ++i) {
        auto& of_kind = free[static_cast<std::size_t>(kind(come[i]))];
        if (of_kind.empty()) continue;
        slot_of_come[i] = of_kind.back();
        of_kind.pop_back();
    }
    bool const all = std::find(slot_of_come.begin(), slot_of_come.end(), -1) == slot_of_come.end();
    if (!all && !(of_any_kind && give_others(come, free, slot_of_come))) return false;
    for (std::size_t s = 0; s < piece_.size(); ++s)
        if (!stays[s] && piece_[s] >= 0)
            slot_[static_cast<std::size_t>(std::exchange(piece_[s], -1))] = -1;
    for (std::size_t i = 0; i < come.size(); ++i) {
        slot_[static_cast<std::size_t>(come[i])] = slot_of_come[i];
        piece_[static_cast<std::size_t>(slot_of_come[i])] = come[i];
    }
    return true;
}

/// Gives pieces without a slot a free slot of their length, which takes on their kind. Either all
/// of them get one, or none.
bool GhostSlots::give_others(std::span<std::int64_t const> pieces,
                             std::vector<std::vector<int>>& free, std::vector<int>& slot_of_piece) {
    std::vector<std::vector<int>> of_length(BeadPieces::longest + 1);
    for (auto const& of_kind : free)
        for (int const s : of_kind)
            of_length[static_cast<std::size_t>(pieces_.of(like_[static_cast<std::size_t>(s)]))]
                .push_back(s);
    std::vector<std::pair<int, std::int64_t>> changed;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (slot_of_piece[i] >= 0) continue;
        std::vector<int>& some = of_length[static_cast<std::size_t>(pieces_.of(pieces[i]))];
        if (some.empty()) return false;
        slot_of_piece[i] = some.back();
        some.pop_back();
        changed.emplace_back(slot_of_piece[i], pieces[i]);
    }
    for (auto const& [slot, piece] : changed) like_[static_cast<std::size_t>(slot)] = piece;
    return true;
}

std::vector<std::int64_t> GhostSlots::like() const {
    std::vector<std::int64_t> beads(static_cast<std::size_t>(idle_before_), 0);
    for (std::int64_t const piece : like_)
        for (int i = 0; i < pieces_.of(piece); ++i) beads.push_back(piece + i);
    return beads;
}

std::vector<int> GhostSlots::after() const {
    std::vector<int> particles;
    for (std::size_t s = 0; s < like_.size(); ++s)
        for (int p = offset_[s] + 1; p < offset_[s + 1]; ++p) particles.push_back(p);
    return particles;
}

std::vector<int> GhostSlots::idle() const {
    std::vector<int> particles;
    for (std::size_t s = 0; s < piece_.size(); ++s)
        for (int p = offset_[s]; piece_[s] < 0 && p < offset_[s + 1]; ++p) particles.push_back(p);
    for (int p = 0; p < idle_before_; ++p) particles.push_back(p);
    return particles;
}

}  // namespace catena
