// Checkpoints, whose seal has to hold before HDF5 sees them.
#include "io/output.hpp"
#include "tests/fuzz/target.hpp"

void catena::fuzz::read(std::string_view bytes) {
    Checkpoint const checkpoint = read_checkpoint(NamedFile(bytes).path());
    require(checkpoint.step >= 0);
}
