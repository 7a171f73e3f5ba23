// Transfer of body data between all ranks and rank 0 in the order of the scene, in windows of
// bounded size.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "chain/chain_group.hpp"

namespace catena {

/// Mapping between the bodies of the scene and those of groups and ranks.
class SceneWindows {
  public:
    /// Default size of a window.
    static constexpr std::int64_t usual_bytes = 4 << 20;

    /// `groups` together contain all bodies of the scene.
    SceneWindows(Communicator const&, std::vector<std::unique_ptr<ChainGroup>> const& groups,
                 std::int64_t bytes = usual_bytes);

    /// Callback that receives the numbers of bodies [first, first + values.size() / width) of the
    /// scene.
    using Take = std::function<void(std::int64_t first, std::span<double const> values)>;
    /// Passes all data to `take` on rank 0, window by window. `own[g]` has `width` numbers for each
    /// of this rank's bodies of group g. An exception from `take` leaves the other ranks waiting,
    /// so it must end the program. Collective.
    void pass(int width, std::vector<std::vector<double>> const& own, Take const& take) const;
    /// Gathers all data on rank 0, as pass() does, into the place of each body. Other ranks pass an
    /// empty span. Collective.
    void gather(int width, std::vector<std::vector<double>> const& own,
                std::span<double> in_scene_order) const;
    /// Distributes rank 0's data of all bodies to the ranks that own them, in the layout of `own`
    /// in pass(). Other ranks pass an empty span. Collective.
    std::vector<std::vector<double>> hand_out(int width,
                                              std::span<double const> in_scene_order) const;

    /// Consecutive bodies of the scene.
    struct Run {
        std::int64_t first, count;
    };
    /// Returns this rank's bodies as runs in the order of the scene.
    std::vector<Run> own_runs() const;
    /// Numbers of a run of own bodies, or of a part of one.
    struct Own {
        std::int64_t first;
        std::span<double const> values;
    };
    /// Passes `own` to `take` without messages, in the order of the scene and in rounds of bounded
    /// size. All ranks have equally many rounds; the last ones are empty on ranks with less data.
    /// Collective.
    void pass_own(int width, std::vector<std::vector<double>> const& own,
                  std::function<void(std::vector<Own> const&)> const& take) const;

  private:
    static constexpr std::size_t most_runs = 256;  // largest number of runs in a round
    /// Mean size in bytes from which parts are sent one by one instead of together in windows.
    static constexpr std::int64_t shortest_part_alone = 1 << 16;
    /// Bodies that are consecutive in the scene, in their group and on their rank.
    struct Part {
        std::int64_t first, count;  // indices in the scene
        std::size_t group;
        int rank;
        /// Index of the first body on its rank.
        std::int64_t local;
    };
    /// Bodies [first, end) of the scene; `first_part` is the first part that overlaps them.
    struct Window {
        std::int64_t first, end;
        std::size_t first_part;
    };
    template <class Action>
    void for_each_window(int width, Action const& action) const;
    template <class Action>
    void for_each_part_in(Window const&, Action const& action) const;
    std::vector<Part> joined_parts() const;
    std::vector<Part> own_parts() const;
    void send(Window const&, int width, std::vector<std::vector<double>> const& own) const;
    std::vector<double> receive(Window const&, int width,
                                std::vector<std::vector<double>> const& own) const;

    Communicator const& communicator_;
    std::int64_t bytes_, bodies_ = 0;
    std::vector<std::int64_t> own_size_;  // number of own bodies of every group
    std::vector<Part> parts_;             // sorted in the order of the scene
};

}  // namespace catena
