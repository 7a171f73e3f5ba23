// OpenMmForce: forces on beads from OpenMM.
//
// Each rank has one Context, or one per layer (systems/force_layers.hpp). A worker thread or the
// caller drives it. begin() passes positions on, finish() adds the forces. Several threads of a
// process must not use it at once: OpenMM is not thread-safe while it sets up expressions.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "math/field.hpp"
#include "mpi/communicator.hpp"
#include "neighbours/device_path.hpp"
#include "neighbours/ghost_traffic.hpp"
#include "scene/scene.hpp"
#include "systems/bead_system.hpp"

namespace catena {

/// Reason for chains not being on a GPU if the scene does not ask for one. It is not reported.
inline constexpr char const* no_gpu_asked_for = "the backend is not cuda";

/// Tells if the chains' positions and forces are on a GPU.
struct ChainsOnDevice {
    std::string why_not;  // reason; empty if they are
    int device = -1;      // GPU that the chains use; -1 if none
};

/// OpenMM's forces on this rank's beads, on any path and with any decomposition.
class OpenMmForce {
  public:
    virtual ~OpenMmForce() = default;
    /// Starts to compute the forces at `positions` (own beads in the order of BeadSystem::by_rank,
    /// nm, W, unwrapped). Returns at once on path `host`. Collective.
    virtual void begin(ConstView<3> positions) = 0;
    /// Returns path `device`, on which positions and forces stay on the GPU; null on other paths.
    /// Its own begin(), go_on() and finish() then replace those of this class. They get all own
    /// beads in the order of BeadSystem::by_rank.
    virtual DevicePath* device_path() = 0;
    /// Path `device`: computes the forces at the last positions again and stores them on the host,
    /// kJ/mol/nm, W.
    virtual void forces_again(View<3> forces) = 0;
    /// Waits for the forces and adds them (kJ/mol/nm, W) to `forces` (own beads). Throws
    /// ComputationError if OpenMM failed, possibly on this rank alone.
    virtual void finish(View<3> forces) = 0;
    /// Returns the potential energy of all beads, term by term in a fixed order, at the last
    /// positions. It is the same on every rank. Precondition: finish() has returned. Collective.
    virtual std::vector<EnergyTerm> energies() = 0;
    /// Interval of the last evaluation. It starts with the request, so it includes the time in
    /// which a worker wakes up.
    virtual Interval last_evaluation() const = 0;
    /// True if the caller has a core to compute on meanwhile: this rank has a second one, or OpenMM
    /// computes on a GPU.
    virtual bool leaves_a_core() const = 0;
    /// Returns lines for `check`, `plan` and the summary. They tell platform and version, terms,
    /// threads, path, and how many bonds were left out because links replace them.
    virtual std::vector<std::string> description() const = 0;
    /// Name of OpenMM's platform, such as "CPU".
    virtual std::string platform() const = 0;
    /// The path of the next evaluation: "device", "host" or "inline".
    virtual std::string path() const = 0;
    /// Makes the next evaluation rebuild the lists of ghosts. Must be called on every rank or on
    /// none.
    virtual void renew_ghosts() = 0;
    /// True if the next evaluation rebuilds the lists of ghosts.
    virtual bool ghosts_are_due() const = 0;
    /// Messages and ghosts of this rank if the forces are split over ranks; zeros otherwise.
    virtual GhostTraffic traffic() const = 0;
    /// Interval in which positions were exchanged between ranks for the last evaluation.
    virtual Interval last_gathering() const = 0;
    /// Largest number of particles of a Context of this rank so far, ghosts and spares included.
    virtual std::int64_t largest_context() const = 0;
    /// Number of Contexts that this rank has made.
    virtual std::int64_t contexts() const = 0;
};

/// Makes the forces that the scene asks for. Throws InputError if they cannot be had: unknown
/// residue, missing platform, unreadable XML, a force that cannot be split over ranks, and others.
/// Throws "built without OpenMM" in a build without it. Collective.
std::unique_ptr<OpenMmForce> make_openmm_force(OpenMmSpec const&, BeadSystem const&,
                                               Communicator const&,
                                               ChainsOnDevice const& = {no_gpu_asked_for, -1});

/// Returns OpenMM's version, such as "OpenMM 8.6.1", or "none".
std::string openmm_version();
/// Returns the available platforms ("Reference", "CPU", ...); none without OpenMM.
std::vector<std::string> openmm_platforms();

}  // namespace catena
