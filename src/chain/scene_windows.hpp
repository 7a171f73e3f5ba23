// Numbers of bodies on their way to rank 0 and back, in the order of the scene, a window of bounded
// size at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "chain/chain_group.hpp"

namespace catena {

class SceneWindows {
  public:
    static constexpr std::int64_t usual_bytes = 4 << 20;

    /// `groups`: those that hold the scene's bodies between them.
    SceneWindows(Communicator const&, std::vector<std::unique_ptr<ChainGroup>> const& groups,
                 std::int64_t bytes = usual_bytes);

    /// Bodies [first, first + values.size() / width) of the scene.
    using Take = std::function<void(std::int64_t first, std::span<double const> values)>;
    /// `own[g]`: `width` numbers for each of this rank's bodies of group g. Rank 0 takes window
    /// after window. What `take` throws leaves the other ranks waiting: it is for failures that end
    /// the program. Collective.
    void pass(int width, std::vector<std::vector<double>> const& own, Take const& take) const;
    /// The reverse: what rank 0 has of all bodies (others give nothing) to the ranks that they are
    /// of, as `own`. Collective.
    std::vector<std::vector<double>> hand_out(int width,
                                              std::span<double const> in_scene_order) const;

    /// Neighbours in the scene.
    struct Run {
        std::int64_t first, count;
    };
    /// This rank's own, in the order of the scene.
    std::vector<Run> own_runs() const;
    /// The numbers of such a run, or of a part of one.
    struct Own {
        std::int64_t first;
        std::span<double const> values;
    };
    /// `own` without a message, in the order of the scene, in rounds of bounded size: as many on
    /// every rank, the last ones empty where a rank has less. Collective.
    void pass_own(int width, std::vector<std::vector<double>> const& own,
                  std::function<void(std::vector<Own> const&)> const& take) const;

  private:
    static constexpr std::size_t most_runs = 256;  // in a round
    /// Neighbours in the scene, in a group and on a rank.
    struct Part {
        std::int64_t first, count;  // in the scene
        std::size_t group;
        int rank;
        std::int64_t local;
    };
    struct Window {
        std::int64_t first, end;
        std::size_t first_part;
    };
    template <class Action>
    void for_each_window(int width, Action const& action) const;
    template <class Action>
    void for_each_part_in(Window const&, Action const& action) const;
    std::vector<Part> own_parts() const;
    void send(Window const&, int width, std::vector<std::vector<double>> const& own) const;
    std::vector<double> receive(Window const&, int width,
                                std::vector<std::vector<double>> const& own) const;

    Communicator const& communicator_;
    std::int64_t bytes_, bodies_ = 0;
    std::vector<std::int64_t> own_size_;  // of every group
    std::vector<Part> parts_;             // in the order of the scene
};

}  // namespace catena
