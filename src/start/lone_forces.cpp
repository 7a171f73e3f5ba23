// Implements OpenMM's forces on one rank, with a substitute for forces that are not finite.
#include "start/lone_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "error.hpp"
#include "force/contacts.hpp"
#include "generate/nearest.hpp"
#include "generate/random.hpp"
#include "integrate/scene_beads.hpp"

namespace catena {
namespace {

double constexpr pushed = 0.3;  // nm: beads this near push each other apart
double constexpr push = 1e6;    // kJ/mol/nm: larger than any force on a bead in thermal motion

}  // namespace

SingleRankForces::SingleRankForces(Scene const& scene, std::optional<double> reach)
    : alone_(serial_communicator()),
      beads_(bead_system_of(scene)),
      force_(make(scene, reach)),
      position_(beads_.size()),
      force_of_bead_(beads_.size()) {}

std::unique_ptr<OpenMmForce> SingleRankForces::make(Scene const& scene,
                                                    std::optional<double> reach) {
    beads_.first_of_rank = {0, beads_.size()};
    OpenMmSpec spec = *scene.forces.openmm;
    spec.platform = spec.platform == "Reference" ? "Reference" : "CPU";
    spec.threads = 1;  // OpenMM's threads share pairs by who comes first, and sums differ
    spec.precision = "", spec.path = "inline", spec.layers = "none";
    spec.replicate = spec.audit = false;
    return reach ? make_openmm_contacts(spec, beads_, *alone_, *reach)
                 : make_openmm_force(spec, beads_, *alone_);
}

std::vector<Vec3> SingleRankForces::forces(std::vector<Vec3> const& positions) {
    for (std::int64_t i = 0; i < beads_.size(); ++i) {
        position_.set(i, positions[static_cast<std::size_t>(i)]);
        force_of_bead_.set(i, Vec3::zero());
    }
    std::vector<Vec3> found;
    try {
        force_->begin(std::as_const(position_).view());
        force_->finish(force_of_bead_.view());
        for (std::int64_t i = 0; i < beads_.size(); ++i) found.push_back(force_of_bead_[i]);
        finite_ = std::all_of(found.begin(), found.end(),
                              [](Vec3 const& f) { return std::isfinite(dot(f, f)); });
    } catch (ComputationError const&) {
        finite_ = false;
    }
    return finite_ ? found : pushes(positions);
}

double SingleRankForces::energy() {
    double sum = 0;
    try {
        if (finite_)
            for (EnergyTerm const& term : force_->energies()) sum += term.value;
    } catch (ComputationError const&) {
        finite_ = false;
    }
    return finite_ && std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

SingleRankForces::EnergyAndForces SingleRankForces::at(std::vector<Vec3> const& positions) {
    std::vector<Vec3> found = forces(positions);
    double const sum = energy();
    return {sum, std::isfinite(sum) ? std::move(found) : pushes(positions)};
}

std::vector<Vec3> SingleRankForces::pushes(std::vector<Vec3> const& positions) const {
    std::vector<Vec3> forces(positions.size(), Vec3::zero());
    bool any = false;
    scene::for_each_near_pair(
        positions, beads_.box, pushed, [&](std::size_t i, std::size_t j, Vec3 const& apart) {
            double const distance = norm(apart);
            Vec3 const along = distance > 0
                                   ? (1 / distance) * apart
                                   : scene::Draws(i, static_cast<std::int64_t>(j)).on_sphere();
            forces[i] = plus_scaled(forces[i], push, along);
            forces[j] = plus_scaled(forces[j], -push, along);
            any = true;
        });
    for (std::size_t i = 0; i < forces.size() && !any; ++i)
        forces[i] = push * scene::Draws(i, 0).on_sphere();
    return forces;
}

}  // namespace catena
