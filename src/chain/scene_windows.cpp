// Windows over the bodies of the scene, and the messages that fill or distribute them.
#include "chain/scene_windows.hpp"

#include <algorithm>
#include <utility>

namespace catena {

SceneWindows::SceneWindows(Communicator const& communicator,
                           std::vector<std::unique_ptr<ChainGroup>> const& groups,
                           std::int64_t bytes)
    : communicator_(communicator), bytes_(bytes) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
        dca::Partition const& partition = groups[g]->partition;
        bodies_ += partition.bodies();
        own_size_.push_back(groups[g]->size);
        int rank = 0;
        for (int chain = 0; chain < partition.chains(); ++chain) {
            std::int64_t const begin = partition.first_of_chain[chain],
                               end = partition.first_of_chain[chain + 1];
            for (std::int64_t body = begin; body < end;) {
                while (partition.first_of_rank[rank + 1] <= body) ++rank;
                std::int64_t const next = std::min(end, partition.first_of_rank[rank + 1]);
                std::int64_t const first = groups[g]->chains[chain].first_body + body - begin;
                parts_.push_back(
                    {first, next - body, g, rank, body - partition.first_of_rank[rank]});
                body = next;
            }
        }
    }
    std::sort(parts_.begin(), parts_.end(),
              [](Part const& a, Part const& b) { return a.first < b.first; });
}

/// Calls action(part, begin, end) for every part that overlaps the window; bodies [begin, end) of
/// the part, counted from its first, lie in it.
template <class Action>
void SceneWindows::for_each_part_in(Window const& window, Action const& action) const {
    for (std::size_t p = window.first_part; p < parts_.size() && parts_[p].first < window.end; ++p)
        action(parts_[p], std::max(window.first - parts_[p].first, std::int64_t{0}),
               std::min(window.end - parts_[p].first, parts_[p].count));
}

/// Sends this rank's bodies of a window to rank 0.
void SceneWindows::send(Window const& window, int width,
                        std::vector<std::vector<double>> const& own) const {
    std::vector<double> packed;
    for_each_part_in(window, [&](Part const& part, std::int64_t begin, std::int64_t end) {
        if (part.rank != communicator_.rank()) return;
        auto const from = own[part.group].begin() + (part.local + begin) * width;
        packed.insert(packed.end(), from, from + (end - begin) * width);
    });
    if (!packed.empty()) communicator_.exchange(std::as_bytes(std::span(packed)), 0, {}, -1);
}

/// Receives one message from each rank that owns bodies of the window, and sorts all bodies into
/// the order of the scene.
std::vector<double> SceneWindows::receive(Window const& window, int width,
                                          std::vector<std::vector<double>> const& own) const {
    std::vector<std::int64_t> at(static_cast<std::size_t>(communicator_.size()) + 1, 0);
    for_each_part_in(window, [&](Part const& part, std::int64_t begin, std::int64_t end) {
        if (part.rank != 0) at[static_cast<std::size_t>(part.rank) + 1] += (end - begin) * width;
    });
    for (std::size_t r = 1; r < at.size(); ++r) at[r] += at[r - 1];
    std::vector<double> received(static_cast<std::size_t>(at.back())),
        values(static_cast<std::size_t>((window.end - window.first) * width));
    for (int rank = 1; rank < communicator_.size(); ++rank) {
        auto const r = static_cast<std::size_t>(rank);
        std::span<double> const from_rank(received.data() + at[r],
                                          static_cast<std::size_t>(at[r + 1] - at[r]));
        if (!from_rank.empty())
            communicator_.exchange({}, -1, std::as_writable_bytes(from_rank), rank);
    }
    for_each_part_in(window, [&](Part const& part, std::int64_t begin, std::int64_t end) {
        std::int64_t const numbers = (end - begin) * width;
        std::int64_t& next = at[static_cast<std::size_t>(part.rank)];
        double const* const from = part.rank == 0
                                       ? own[part.group].data() + (part.local + begin) * width
                                       : received.data() + std::exchange(next, next + numbers);
        std::copy_n(from, numbers, values.data() + (part.first + begin - window.first) * width);
    });
    return values;
}

/// Calls action(window) for all windows of the scene.
template <class Action>
void SceneWindows::for_each_window(int width, Action const& action) const {
    std::int64_t const length =
        std::max(bytes_ / (width * static_cast<std::int64_t>(sizeof(double))), std::int64_t{1});
    std::size_t first_part = 0;
    for (std::int64_t first = 0; first < bodies_; first += length) {
        while (parts_[first_part].first + parts_[first_part].count <= first) ++first_part;
        action(Window{first, std::min(first + length, bodies_), first_part});
    }
}

void SceneWindows::pass(int width, std::vector<std::vector<double>> const& own,
                        Take const& take) const {
    for_each_window(width, [&](Window const& window) {
        if (communicator_.rank() == 0)
            take(window.first, receive(window, width, own));
        else
            send(window, width, own);
    });
}

std::vector<std::vector<double>> SceneWindows::hand_out(
    int width, std::span<double const> in_scene_order) const {
    std::vector<std::vector<double>> own;
    for (std::int64_t const size : own_size_)
        own.emplace_back(static_cast<std::size_t>(size * width));
    int const rank = communicator_.rank();
    for_each_window(width, [&](Window const& window) {
        // This has the data of every rank on rank 0, elsewhere only the rank's own.
        std::vector<std::vector<double>> of_rank(static_cast<std::size_t>(communicator_.size()));
        for_each_part_in(window, [&](Part const& part, std::int64_t begin, std::int64_t end) {
            std::vector<double>& numbers = of_rank[static_cast<std::size_t>(part.rank)];
            if (rank == 0) {
                auto const from = in_scene_order.begin() + (part.first + begin) * width;
                numbers.insert(numbers.end(), from, from + (end - begin) * width);
            } else if (rank == part.rank) {
                numbers.resize(numbers.size() + static_cast<std::size_t>((end - begin) * width));
            }
        });
        for (int other = 1; other < communicator_.size(); ++other) {
            std::vector<double>& numbers = of_rank[static_cast<std::size_t>(other)];
            if (numbers.empty()) continue;
            if (rank == 0)
                communicator_.exchange(std::as_bytes(std::span(numbers)), other, {}, -1);
            else
                communicator_.exchange({}, -1, std::as_writable_bytes(std::span(numbers)), 0);
        }
        auto next = of_rank[static_cast<std::size_t>(rank)].begin();
        for_each_part_in(window, [&](Part const& part, std::int64_t begin, std::int64_t end) {
            if (part.rank != rank) return;
            std::int64_t const numbers = (end - begin) * width;
            std::copy_n(std::exchange(next, next + numbers), numbers,
                        own[part.group].begin() + (part.local + begin) * width);
        });
    });
    return own;
}

/// Returns all parts; parts of one rank that are also consecutive in their group are joined.
std::vector<SceneWindows::Part> SceneWindows::joined_parts() const {
    std::vector<Part> joined;
    for (Part const& part : parts_) {
        if (!joined.empty() && joined.back().rank == part.rank &&
            joined.back().group == part.group &&
            joined.back().first + joined.back().count == part.first &&
            joined.back().local + joined.back().count == part.local)
            joined.back().count += part.count;
        else
            joined.push_back(part);
    }
    return joined;
}

std::vector<SceneWindows::Part> SceneWindows::own_parts() const {
    std::vector<Part> own = joined_parts();
    std::erase_if(own, [&](Part const& part) { return part.rank != communicator_.rank(); });
    return own;
}

void SceneWindows::gather(int width, std::vector<std::vector<double>> const& own,
                          std::span<double> in_scene_order) const {
    std::vector<Part> const parts = joined_parts();
    std::int64_t const bytes = width * static_cast<std::int64_t>(sizeof(double)),
                       length = std::max(bytes_ / bytes, std::int64_t{1});
    if (bodies_ * bytes < std::ssize(parts) * shortest_part_alone)
        return pass(width, own, [&](std::int64_t first, std::span<double const> values) {
            std::copy(values.begin(), values.end(), in_scene_order.begin() + first * width);
        });
    for (Part const& part : parts)
        for (std::int64_t at = 0; at < part.count; at += length) {
            auto const numbers =
                static_cast<std::size_t>(std::min(length, part.count - at) * width);
            auto const from = [&] {
                return std::span(own[part.group].data() + (part.local + at) * width, numbers);
            };
            auto const to = [&] {
                return in_scene_order.subspan(static_cast<std::size_t>((part.first + at) * width),
                                              numbers);
            };
            if (communicator_.rank() > 0) {
                if (part.rank == communicator_.rank())
                    communicator_.exchange(std::as_bytes(from()), 0, {}, -1);
            } else if (part.rank > 0) {
                communicator_.exchange({}, -1, std::as_writable_bytes(to()), part.rank);
            } else {
                std::ranges::copy(from(), to().begin());
            }
        }
}

std::vector<SceneWindows::Run> SceneWindows::own_runs() const {
    std::vector<Run> runs;
    for (Part const& part : own_parts()) runs.push_back({part.first, part.count});
    return runs;
}

void SceneWindows::pass_own(int width, std::vector<std::vector<double>> const& own,
                            std::function<void(std::vector<Own> const&)> const& take) const {
    std::int64_t const length =
        std::max(bytes_ / (width * static_cast<std::int64_t>(sizeof(double))), std::int64_t{1});
    std::vector<std::vector<Own>> rounds;
    std::int64_t room = 0;  // bodies that fit in the last round
    for (Part const& part : own_parts())
        for (std::int64_t at = 0; at < part.count;) {
            if (room == 0 || rounds.back().size() == most_runs) {
                rounds.emplace_back();
                room = length;
            }
            std::int64_t const count = std::min(part.count - at, room);
            double const* const values = own[part.group].data() + (part.local + at) * width;
            rounds.back().push_back(
                {part.first + at, std::span(values, static_cast<std::size_t>(count * width))});
            at += count;
            room -= count;
        }
    rounds.resize(static_cast<std::size_t>(communicator_.max(static_cast<double>(rounds.size()))));
    for (std::vector<Own> const& round : rounds) take(round);
}

}  // namespace catena
