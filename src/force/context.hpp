// ForceContext: one OpenMM Context for some beads of a scene. Only files that see OpenMM's headers
// include this one.
#pragma once

#include <OpenMM.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "force/platform.hpp"
#include "math/linear.hpp"
#include "neighbours/replica_places.hpp"

namespace catena {

/// Changes of coordinates that are allowed before OpenMM gets them. OpenMM computes in single
/// precision on most platforms.
enum class Placement {
    /// Coordinates are passed unchanged: a force may depend on the position in space.
    as_given,
    /// All coordinates may be shifted by one vector: forces depend on differences alone.
    shifted,
    /// Each bead may be wrapped into the box: forces depend on differences of nearest images.
    wrapped
};

/// Returns the placement that all of the System's forces allow.
Placement placement_for(OpenMM::System const&);
/// Returns the placement that all forces of all Systems allow. A System without forces allows any.
Placement placement_for(std::span<std::shared_ptr<OpenMM::System const> const>);

/// An OpenMM Context with its System and a cache of the shifts applied to its particles.
class ForceContext {
  public:
    /// `home` is another ForceContext, whose GPU context the new one shares and which must outlive
    /// it. If it is null, the new one makes its own. `box`: edges of the periodic box, nm. Throws
    /// what OpenMM throws if it refuses the forces.
    ForceContext(std::shared_ptr<OpenMM::System const> system, OpenMmPlatform const& platform,
                 std::optional<Vec3> const& box, ForceContext* home = nullptr);

    /// Gives each replica a place of its own, which replaces the common shift. Precondition: the
    /// placement is Placement::shifted.
    void keep_apart(ReplicaPlaces places) { replicas_ = std::move(places); }
    /// Number of particles, those of ghosts and spares included.
    std::int64_t size() const { return std::ssize(positions_); }

    /// Sets the positions of all particles, nm, W. With Placement::shifted the mean of the first
    /// `centred` positions is moved to the origin.
    ///
    /// Shifts and box images are kept for `evaluations_` calls, unless particles have moved far. A
    /// new shift looks to OpenMM like a large displacement, so OpenMM would rebuild its neighbour
    /// list. Platform Reference rebuilds the list anyway: there, shifts depend on these positions
    /// alone.
    void set_positions(std::span<Vec3 const> positions, std::size_t centred);
    /// Makes the next set_positions() compute new shifts and images, as in a Context that has just
    /// been made.
    void place_anew() { placed_for_ = 0; }
    /// Returns the forces of the groups in bit mask `groups` on particles 0 .. size() - 1,
    /// kJ/mol/nm, W.
    std::vector<OpenMM::Vec3> forces(int groups = -1);
    Placement placement() const { return placement_; }
    OpenMM::Context& context() { return *context_; }
    /// Stores the energy of each force in the groups `groups` at the index of its group, kJ/mol.
    /// Precondition: no two forces share a group.
    void find_energies(std::span<double> of_group, int groups = -1);

  private:
    /// Number of evaluations for which shifts are kept, on platform Reference `on_reference`.
    /// OpenMM's own integrators keep the order of particles for as many steps.
    static constexpr int evaluations_of_a_place = 250, on_reference = 1;

    /// Computes `place_` from these positions.
    void find_places(std::span<Vec3 const> positions, std::size_t centred);
    /// True if particles are too far from where they were when `place_` was computed.
    bool have_strayed(std::span<Vec3 const> positions, std::size_t centred) const;

    /// Edges of the periodic box, nm.
    std::optional<Vec3> box_;
    Placement placement_;
    std::shared_ptr<OpenMM::System const> system_;
    OpenMM::VerletIntegrator integrator_{0.001};  // required by OpenMM::Context; never steps
    std::unique_ptr<OpenMM::Context> context_;
    std::vector<OpenMM::Vec3> positions_;
    /// Vector subtracted from each particle's coordinates, nm.
    std::vector<Vec3> place_;
    ReplicaPlaces replicas_;  // empty without replicas
    /// Number of set_positions() calls that `place_` serves, and number of calls since it was
    /// computed.
    int evaluations_, placed_for_ = 0;
};

}  // namespace catena
