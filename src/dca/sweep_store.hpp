// Memory of the sweeps over one group of chains in any Space.
#pragma once

#include <utility>

#include "chain/chain_group.hpp"
#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// The arrays of all sweeps over one group of chains in the memory of a Space, and their views.
template <class Leaf, class Space>
class SweepStore {
    template <class T, Order order>
    using Records = typename Space::template Records<T, order>;

  public:
    using Sweeps = typename SweepsOf<Leaf>::Sweeps;

    /// Allocates the arrays for all slots and joints of the group's schedule. `model` is the
    /// group's model in the space.
    SweepStore(ChainGroup const& group, Space const& space, typename Space::Model model)
        : model_(std::move(model)),
          matrices_(group.schedule.slots),
          biases_(group.schedule.slots),
          joints_(group.schedule.joints),
          offsets_(group.schedule.joints),
          forces_(group.schedule.joints),
          lost_(1),
          sweeps_{Leaf(model_.view()), model_.restricted(), matrices_.view(), biases_.view(),
                  joints_.view(),      offsets_.view(),     forces_.view(),   lost_.data()} {
        space.put(lost_.data(), PivotFailure{}.joint);
    }
    // The views point to the arrays of this object.
    SweepStore(SweepStore const&) = delete;
    SweepStore& operator=(SweepStore const&) = delete;

    typename Space::Model const& model() const { return model_; }
    /// Views of the arrays, with the leaf that holds the configuration.
    Sweeps& sweeps() { return sweeps_; }
    Sweeps const& sweeps() const { return sweeps_; }
    /// Returns the pivot failure that sweeps have found since the last call, if any, and forgets
    /// it.
    PivotFailure take_failure(Space const& space) {
        PivotFailure const found{space.get(lost_.data())};
        if (!found.none()) space.put(lost_.data(), PivotFailure{}.joint);
        return found;
    }

  private:
    typename Space::Model model_;
    // Segments are indexed by slot, nodes and states by joint.
    Records<typename Sweeps::Matrices, Order::plain> matrices_;
    Records<typename Sweeps::Biases, Order::plain> biases_;
    Records<typename Sweeps::Joint, Order::by_body> joints_;
    Records<typename Sweeps::Offset, Order::by_body> offsets_;
    Records<typename Sweeps::State, Order::by_body> forces_;
    // PivotFailure::joint of the sweeps.
    typename Space::template Array<unsigned long long> lost_;
    Sweeps sweeps_;
};

}  // namespace catena::dca
