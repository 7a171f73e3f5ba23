// Gather of a group's data to rank 0, and its permutation to the order of the scene.
#include "chain/gather.hpp"

#include <algorithm>

namespace catena {

void gather_to_scene(Communicator const& communicator, ChainGroup const& group, int width,
                     std::span<double const> own, std::vector<double>& in_scene_order) {
    std::vector<std::int64_t> const& first = group.first_of_rank();
    std::vector<std::int64_t> bytes;
    for (int rank = 0; rank < communicator.size(); ++rank)
        bytes.push_back((first[rank + 1] - first[rank]) * width *
                        static_cast<std::int64_t>(sizeof(double)));
    std::vector<double> all(
        communicator.rank() == 0 ? static_cast<std::size_t>(group.partition.bodies() * width) : 0);
    communicator.gather(std::as_bytes(own), std::as_writable_bytes(std::span(all)), bytes);
    if (communicator.rank() != 0) return;
    for (int chain = 0; chain < group.partition.chains(); ++chain) {
        auto const begin = all.begin() + group.partition.first_of_chain[chain] * width;
        auto const end = all.begin() + group.partition.first_of_chain[chain + 1] * width;
        std::copy(begin, end, in_scene_order.begin() + group.first_in_scene[chain] * width);
    }
}

}  // namespace catena
