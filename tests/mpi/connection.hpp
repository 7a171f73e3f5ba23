// The ranks of a test, otherwise connected.
#pragma once

#include <memory>

#include "mpi/communicator.hpp"

namespace catena::testing {

/// The same ranks, otherwise connected (with_mpi.cpp); without MPI one rank. In pieces: no message
/// is longer than 5 bytes. In two stages: ranks are dealt to hosts that they do not have, so many
/// of them, one after the other or one each in turn.
struct Connection {
    char const* name;
    bool in_pieces = false;
    int hosts = 0;  // 0: in one stage
    bool in_turn = false;
};
std::unique_ptr<Communicator> connected(Connection const&);

}  // namespace catena::testing
