// Exchange of the segments of shared units between ranks.
#pragma once

#include <optional>

#include "dca/tree_sweeps.hpp"
#include "tree/frontier_exchange.hpp"

namespace catena::dca {

/// Records of shared units that ranks exchange between the inward and the outward pass of a sweep.
template <class Space, class Numbers>
struct ShownUnits {
    FrontierExchange<Space>& units;
    Numbers numbers;

    /// Distributes the records to all ranks. Collective.
    void gather(Space const& space, Communicator const& communicator) const {
        units.show(space, numbers);
        units.bring(space, communicator, numbers);
    }
};

/// Exchange of the segments of shared units among ranks: of their matrices, their biases, or both
/// together.
template <class Sweeps, class Space>
class SegmentExchange {
    using NumbersOfMatrices = RecordNumbers<typename Sweeps::Matrices>;
    using NumbersOfBiases = RecordNumbers<typename Sweeps::Biases>;
    using NumbersOfSegments = NumbersOfBoth<typename Sweeps::Matrices, typename Sweeps::Biases>;

  public:
    /// `at_once`: matrices and biases are also exchanged together. Collective.
    SegmentExchange(Schedule const& schedule, Space const& space, Communicator const& communicator,
                    bool at_once)
        : matrices_(schedule, NumbersOfMatrices::width, space, communicator),
          biases_(schedule, NumbersOfBiases::width, space, communicator) {
        if (at_once) both_.emplace(schedule, NumbersOfSegments::width, space, communicator);
    }
    ShownUnits<Space, NumbersOfMatrices> of_matrices(Sweeps const& sweeps) {
        return {matrices_, {sweeps.matrices, matrices_.own_units(), matrices_.units()}};
    }
    ShownUnits<Space, NumbersOfBiases> of_biases(Sweeps const& sweeps) {
        return {biases_, {sweeps.biases, biases_.own_units(), biases_.units()}};
    }
    /// Precondition: the exchange was made with `at_once`.
    ShownUnits<Space, NumbersOfSegments> of_both(Sweeps const& sweeps) {
        return {*both_, {sweeps.matrices, sweeps.biases, both_->own_units(), both_->units()}};
    }
    /// True if the ranks exchange units through host memory.
    bool asks_host() const { return matrices_.asks_host(); }
    /// True if the ranks exchange units from memory to memory of their GPUs.
    bool is_direct() const { return matrices_.is_direct(); }

  private:
    FrontierExchange<Space> matrices_, biases_;
    std::optional<FrontierExchange<Space>> both_;
};

}  // namespace catena::dca
