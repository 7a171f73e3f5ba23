// Compares the memory that a scene needs with what the hosts of its ranks have free.
#pragma once

#include <optional>
#include <string>

#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena::command {

/// Returns the bytes that all processes of this host together may still take: those that the kernel
/// calls available, or fewer if a control group of version 1 or 2 allows less. Returns nothing if
/// the system does not say. `root` is the folder that holds proc and sys.
std::optional<double> free_host_memory(std::string const& root = "/");

/// Memory of a host or of a process, in bytes.
struct HostMemory {
    /// Least that a run needs, OpenMM's forces included, and what is free.
    double needed = 0, free = 0;
    /// True if `ulimit -v` sets what is free.
    bool by_ulimit = false;
    /// Returns the remark on it, with what to do.
    std::string note() const;
};

/// Returns the memory of the host or process that lacks most, if one lacks any; the same on every
/// rank. A process may be limited by `ulimit -v`. Returns nothing if the chains are computed on
/// GPUs, whose memory is checked when they are set up, or if the system does not say what is free.
/// Collective.
std::optional<HostMemory> lacking_memory(Scene const&, Communicator const&);

/// Throws InputError if the replicas of a scene, of which `first` has the chains of one, need more
/// memory in a run on `ranks` ranks, `on_host` of them on this host, than this host has. OpenMM's
/// memory counts unless a GPU may compute the chains.
void refuse_replicas_beyond_memory(Scene const& first, int ranks, int on_host);

}  // namespace catena::command
