// One OpenMM Context for some beads of a scene. For files that see OpenMM's headers.
#pragma once

#include <OpenMM.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dca/linear.hpp"
#include "force/openmm_platform.hpp"

namespace catena {

/// How coordinates may be changed before OpenMM, which computes in single precision on most platforms, gets them.
enum class Placement {
    as_given,  // a force may depend on where in space things are
    shifted,   // all by one vector: forces depend on differences alone
    wrapped    // each bead into the box: and on their nearest images
};

/// What the System's forces allow.
Placement placement_for(OpenMM::System const&);

class ForceContext {
  public:
    /// `home`: another one, which outlives it, in whose GPU context it is to be made; none: in one of its own. Throws what OpenMM throws
    /// if it refuses the forces.
    ForceContext(std::shared_ptr<OpenMM::System const> system, OpenMmPlatform const& platform, std::optional<Vec3> const& box,
                 ForceContext* home = nullptr);

    std::int64_t size() const { return std::ssize(positions_); }

    /// Of its particles, nm, W. Where all may be shifted, the middle of the first `centred` goes to the origin.
    void set_positions(std::span<Vec3 const> positions, std::size_t centred);
    /// Forces on particle i = 0 .. size - 1, kJ/mol/nm, W.
    std::vector<OpenMM::Vec3> forces();
    Placement placement() const { return placement_; }
    OpenMM::Context& context() { return *context_; }
    /// Energy of one force group, kJ/mol.
    double energy(int group);

  private:
    std::optional<Vec3> box_;
    Placement placement_;
    std::shared_ptr<OpenMM::System const> system_;
    OpenMM::VerletIntegrator integrator_{0.001};  // a Context wants one; it never steps
    std::unique_ptr<OpenMM::Context> context_;
    std::vector<OpenMM::Vec3> positions_;
};

}  // namespace catena
