// Checkpoints of simulations in memory, as bytes that a program can keep anywhere.
#pragma once

#include <string>

#include "io/output.hpp"

namespace catena {

/// Returns a checkpoint as bytes: a mark with the version, a checksum, and CBOR. Doubles are kept
/// bit for bit.
std::string bytes_of(Checkpoint const&);
/// Returns the checkpoint that bytes_of() was given. Throws InputError for bytes of another origin
/// or version, and for damaged ones.
Checkpoint checkpoint_of(std::string const& bytes);

}  // namespace catena
