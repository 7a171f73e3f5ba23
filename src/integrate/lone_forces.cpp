#include "integrate/lone_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "error.hpp"
#include "integrate/bead_system.hpp"
#include "scene/nearest.hpp"
#include "scene/random.hpp"

namespace catena {
namespace {

int constexpr threads_of_cpu = 4;  // the sum of forces depends on it
double constexpr pushed = 0.3;     // nm
double constexpr push = 1e6;       // kJ/mol/nm: more than any bead feels in a thermal state

}  // namespace

LoneForces::LoneForces(Scene const& scene)
    : alone_(serial_communicator()), beads_(bead_system_of(scene)), force_(make(scene)), position_(beads_.size()) {}

std::unique_ptr<OpenMmForce> LoneForces::make(Scene const& scene) {
    beads_.first_of_rank = {0, beads_.size()};
    OpenMmSpec spec = *scene.forces.openmm;
    spec.platform = spec.platform == "Reference" ? "Reference" : "CPU";
    spec.threads = spec.threads > 0 ? spec.threads : threads_of_cpu;
    spec.precision = "", spec.path = "inline", spec.layers = "none";
    spec.replicate = spec.audit = false;
    return make_openmm_force(spec, beads_, *alone_);
}

LoneForces::Evaluation LoneForces::at(std::vector<Vec3> const& positions) {
    Field<3> found(beads_.size());
    for (std::int64_t i = 0; i < beads_.size(); ++i) {
        position_.set(i, positions[static_cast<std::size_t>(i)]);
        found.set(i, Vec3::zero());
    }
    Evaluation made;
    try {
        force_->begin(std::as_const(position_).view());
        force_->finish(found.view());
        for (EnergyTerm const& term : force_->energies()) made.energy += term.value;
    } catch (ComputationError const&) {
        made.energy = std::numeric_limits<double>::infinity();
    }
    for (std::int64_t i = 0; i < beads_.size(); ++i) made.forces.push_back(found[i]);
    bool const finite = std::isfinite(made.energy) &&
                        std::all_of(made.forces.begin(), made.forces.end(), [](Vec3 const& f) { return std::isfinite(dot(f, f)); });
    return finite ? made : Evaluation{std::numeric_limits<double>::infinity(), pushes(positions)};
}

std::vector<Vec3> LoneForces::pushes(std::vector<Vec3> const& positions) const {
    std::vector<Vec3> forces(positions.size(), Vec3::zero());
    scene::for_each_near_pair(positions, beads_.box, pushed, [&](std::size_t i, std::size_t j, Vec3 const& apart) {
        double const distance = norm(apart);
        Vec3 const along = distance > 0 ? (1 / distance) * apart : scene::Draws(i, static_cast<std::int64_t>(j)).on_sphere();
        forces[i] = plus_scaled(forces[i], push, along);
        forces[j] = plus_scaled(forces[j], -push, along);
    });
    return forces;
}

}  // namespace catena
