#include <algorithm>

#include "mpi/mpi_communicator.hpp"
#include "tests/mpi/connection.hpp"
#include "tests/mpi/world.hpp"

namespace catena::testing {

std::unique_ptr<Communicator> connected(Connection const& connection) {
    MpiOptions options;
    if (connection.in_pieces) options.largest_message = 5;
    int const ranks = world().size(), hosts = std::min(connection.hosts, ranks);
    options.gather =
        GatherChoice{hosts > 0 ? GatherChoice::Stages::two : GatherChoice::Stages::one, 0};
    for (int r = 0; r < ranks && hosts > 0; ++r)
        options.host_of_rank.push_back(connection.in_turn ? r % hosts : r * hosts / ranks);
    return mpi_communicator(nullptr, nullptr, options);
}

}  // namespace catena::testing
