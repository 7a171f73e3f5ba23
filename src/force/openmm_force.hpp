// Forces on beads from OpenMM. A Context a rank, or one a layer (systems/force_layers.hpp), driven
// by a worker thread or by the caller: begin() hands over positions, finish() takes forces. Not for
// several threads of a process at once: OpenMM's set-up of expressions is not safe there.
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

/// Why chains are not on a GPU where the scene does not ask for one: that needs no words.
inline constexpr char const* no_gpu_asked_for = "the backend is not cuda";

/// Whether the chains' positions and forces are on a GPU.
struct ChainsOnDevice {
    std::string why_not;  // empty: they are
    int device = -1;      // which the chains use; -1: none
};

class OpenMmForce {
  public:
    virtual ~OpenMmForce() = default;
    /// Starts the computation of the forces at `positions` (own beads in the order of
    /// BeadSystem::by_rank, nm, W, unwrapped). Collective. Returns at once on path `host`.
    virtual void begin(ConstView<3> positions) = 0;
    /// The path on which positions and forces stay on the GPU: begun, gone on with and finished
    /// there, with all beads in the order of BeadSystem::by_rank. nullptr: it is another path.
    virtual DevicePath* device_path() = 0;
    /// Path `device`: computes the forces at the positions given last once more, for the host.
    virtual void forces_again(View<3> forces) = 0;
    /// Waits for it and adds the forces (kJ/mol/nm) to `forces` (own beads). Throws
    /// ComputationError if OpenMM failed, perhaps on this rank alone.
    virtual void finish(View<3> forces) = 0;
    /// Potential energy of all beads, term by term in a fixed order, at the positions given last;
    /// the same on every rank. Collective, after finish().
    virtual std::vector<EnergyTerm> energies() = 0;
    /// When the last evaluation was under way: from when it was asked for, that a worker wakes up
    /// is a part of it.
    virtual Interval last_evaluation() const = 0;
    /// Whether the caller has a core to go on with meanwhile: this rank has a second one, or the
    /// forces need none.
    virtual bool leaves_a_core() const = 0;
    /// Lines for `check`, `plan` and the summary: platform and version, terms, threads, path, bonds
    /// left out because links replace them (with the number of them).
    virtual std::vector<std::string> description() const = 0;
    virtual std::string platform() const = 0;
    /// The path that runs: "device", "host" or "inline".
    virtual std::string path() const = 0;
    /// Lists of ghosts are made anew at the next evaluation. On every rank or none.
    virtual void renew_ghosts() = 0;
    virtual bool ghosts_are_due() const = 0;
    /// What this rank sent and holds where the forces are split over ranks; nothing elsewhere.
    virtual GhostTraffic traffic() const = 0;
    /// When positions were brought to this rank for the last evaluation.
    virtual Interval last_gathering() const = 0;
    /// Largest number of particles that a Context of this rank has held, ghosts and spares
    /// included, and how many Contexts it made.
    virtual std::int64_t largest_context() const = 0;
    virtual std::int64_t contexts() const = 0;
};

/// Throws InputError when the scene's terms cannot be had (unknown residue, missing platform,
/// unreadable XML, a force that cannot be split over ranks, ...) and "built without OpenMM" where
/// the build lacks it.
std::unique_ptr<OpenMmForce> make_openmm_force(OpenMmSpec const&, BeadSystem const&,
                                               Communicator const&,
                                               ChainsOnDevice const& = {no_gpu_asked_for, -1});

/// "OpenMM 8.6.1" or "none".
std::string openmm_version();
/// Platforms that are present ("Reference", "CPU", ...); none without OpenMM.
std::vector<std::string> openmm_platforms();

}  // namespace catena
