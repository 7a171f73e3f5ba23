// Gather of a group's data to rank 0, and its permutation to the order of the scene.
#include "chain/gather.hpp"
#include "mpi/collectives.hpp"

#include <algorithm>

namespace catena {

void gather_to_scene(Communicator const& communicator, ChainGroup const& group, int width,
                     std::span<double const> own, std::vector<double>& in_scene_order) {
    std::vector<std::int64_t> const& first = group.first_of_rank();
    std::vector<std::int64_t> counts;
    for (int rank = 0; rank < communicator.size(); ++rank)
        counts.push_back((first[rank + 1] - first[rank]) * width);
    std::vector<double> const all = gathered(communicator, own, counts);
    if (communicator.rank() != 0) return;
    for (int chain = 0; chain < group.partition.chains(); ++chain) {
        auto const begin = all.begin() + group.partition.first_of_chain[chain] * width;
        auto const end = all.begin() + group.partition.first_of_chain[chain + 1] * width;
        std::copy(begin, end, in_scene_order.begin() + group.chains[chain].first_body * width);
    }
}

}  // namespace catena
