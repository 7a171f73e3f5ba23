#include "tests/force/ranks.hpp"
#include "tests/mpi/world.hpp"

namespace catena::testing {

bool has_ranks(int ranks) { return world().size() == ranks; }

void on_ranks(int, std::function<void(Communicator const&)> const& body) { body(world()); }

}  // namespace catena::testing
