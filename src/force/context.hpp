// One OpenMM Context for some beads of a scene. For files that see OpenMM's headers.
#pragma once

#include <OpenMM.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "force/platform.hpp"
#include "math/linear.hpp"

namespace catena {

/// How coordinates may be changed before OpenMM, which computes in single precision on most
/// platforms, gets them.
enum class Placement {
    as_given,  // a force may depend on where in space things are
    shifted,   // all by one vector: forces depend on differences alone
    wrapped    // each bead into the box: and on their nearest images
};

/// What the System's forces allow.
Placement placement_for(OpenMM::System const&);

class ForceContext {
  public:
    /// `home`: another one, which outlives it, in whose GPU context it is to be made; none: in one
    /// of its own. Throws what OpenMM throws if it refuses the forces.
    ForceContext(std::shared_ptr<OpenMM::System const> system, OpenMmPlatform const& platform,
                 std::optional<Vec3> const& box, ForceContext* home = nullptr);

    std::int64_t size() const { return std::ssize(positions_); }

    /// Of its particles, nm, W. Where all may be shifted, the middle of the first `centred` goes to
    /// the origin. Shifts and the cells that particles are taken from stay for a while, unless
    /// particles are found far from where they were: OpenMM takes a particle for one that has moved
    /// far where they change, and looks for all pairs anew. Platform Reference does so anyway:
    /// there they depend on these positions alone.
    void set_positions(std::span<Vec3 const> positions, std::size_t centred);
    /// Shifts and cells are found anew at the next positions: as in a Context that has just been
    /// made.
    void place_anew() { placed_for_ = 0; }
    /// Of these groups on particle i = 0 .. size - 1, kJ/mol/nm, W.
    std::vector<OpenMM::Vec3> forces(int groups = -1);
    Placement placement() const { return placement_; }
    OpenMM::Context& context() { return *context_; }
    /// Those of its System's forces in these groups, kJ/mol, each in the place of its group.
    /// Precondition: no two have one group.
    void find_energies(std::span<double> of_group, int groups = -1);

  private:
    /// As long as OpenMM's own integrators leave particles in one order.
    static constexpr int evaluations_of_a_place = 250, on_reference = 1;

    void find_places(std::span<Vec3 const> positions, std::size_t centred);
    /// Whether particles are too far from where they were when places were found.
    bool have_strayed(std::span<Vec3 const> positions, std::size_t centred) const;

    std::optional<Vec3> box_;
    Placement placement_;
    std::shared_ptr<OpenMM::System const> system_;
    OpenMM::VerletIntegrator integrator_{0.001};  // a Context wants one; it never steps
    std::unique_ptr<OpenMM::Context> context_;
    std::vector<OpenMM::Vec3> positions_;
    std::vector<Vec3> place_;           // what is taken off each particle's coordinates
    int evaluations_, placed_for_ = 0;  // of a place, and since it was found
};

}  // namespace catena
