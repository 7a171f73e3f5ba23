#include "tests/force/ranks.hpp"
#include "tests/mpi/world.hpp"

namespace catena::testing {

void on_ranks(std::function<void(Communicator const&)> const& body) { body(world()); }

}  // namespace catena::testing
