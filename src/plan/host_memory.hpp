// Compares the memory that a scene needs with what this host has free.
#pragma once

#include <optional>
#include <string>

#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena::command {

/// Returns the bytes that processes of this host may still take: those that the kernel calls
/// available, or fewer if a control group or `ulimit -v` allows less. Returns nothing if the
/// system does not say. `root` is the folder that holds proc and sys.
std::optional<double> free_host_memory(std::string const& root = "/");

/// Memory of all ranks of this host, in bytes.
struct HostMemory {
    /// Least that the scene needs, OpenMM's forces included, and what is free.
    double needed = 0, free = 0;
    /// Returns the remark on it, with what to do.
    std::string note() const;
};

/// Returns both if the scene needs more than is free; nothing otherwise, or if the system does not
/// say what is free.
std::optional<HostMemory> lacking_memory(Scene const&, Communicator const&);

}  // namespace catena::command
