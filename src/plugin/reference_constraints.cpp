// Catena's constraint solver in place of OpenMM's CCMA, on the platforms Reference and CPU.
#include "plugin/reference_constraints.hpp"

#include <OpenMM.h>
#include <openmm/internal/ContextImpl.h>
#include <openmm/reference/ReferenceConstraints.h>
#include <openmm/reference/ReferencePlatform.h>
#include <openmm/reference/ReferenceSETTLEAlgorithm.h>

#include <set>

#include "error.hpp"
#include "plugin/context_constraints.hpp"
#include "plugin/held_constraints.hpp"
#include "plugin/link_solver.hpp"
#include "plugin/vectors.hpp"

namespace catena::plugin {
namespace {

/// Catena's solver behind OpenMM's interface.
class ChainConstraints final : public OpenMM::ReferenceConstraintAlgorithm {
  public:
    ChainConstraints(std::unique_ptr<LinkSolver> solver, std::string user)
        : solver_(std::move(solver)), user_(std::move(user)) {}

    void apply(std::vector<OpenMM::Vec3>& from, std::vector<OpenMM::Vec3>& to,
               std::vector<double>& /*inverse_masses*/, double tolerance) override {
        as_openmm_error(user_, [&] {
            if (&from == &to)
                solver_->restore(as_span(to), tolerance);
            else
                solver_->close(as_span(from), as_span(to), tolerance);
        });
    }
    void applyToVelocities(std::vector<OpenMM::Vec3>& positions,
                           std::vector<OpenMM::Vec3>& velocities,
                           std::vector<double>& /*inverse_masses*/, double /*tolerance*/) override {
        as_openmm_error(user_, [&] { solver_->project(as_span(positions), as_span(velocities)); });
    }

  private:
    std::unique_ptr<LinkSolver> solver_;
    std::string user_;
};

/// Particles of the rigid clusters that OpenMM solves by SETTLE.
std::set<int> settled(OpenMM::ReferenceConstraints const& constraints) {
    std::set<int> particles;
    auto const* settle = dynamic_cast<OpenMM::ReferenceSETTLEAlgorithm*>(constraints.settle);
    for (int i = 0; settle != nullptr && i < settle->getNumClusters(); ++i) {
        int a = 0, b = 0, c = 0;
        double ab = 0, bc = 0;
        settle->getClusterParameters(i, a, b, c, ab, bc);
        particles.insert({a, b, c});
    }
    return particles;
}

/// Constraints that OpenMM would solve by CCMA. Like OpenMM, it skips those between two particles
/// without mass.
std::vector<Constraint> open_constraints(OpenMM::System const& system,
                                         std::set<int> const& settled) {
    std::vector<Constraint> found = constraints_in(system);
    std::erase_if(found, [&](Constraint const& c) {
        return settled.contains(c.first) ||
               (system.getParticleMass(c.first) == 0 && system.getParticleMass(c.second) == 0);
    });
    return found;
}

int threads_of(OpenMM::ContextImpl& context) {
    OpenMM::Platform const& platform = context.getPlatform();
    return platform.getName() == "CPU"
               ? std::stoi(platform.getPropertyValue(context.getOwner(), "Threads"))
               : 1;
}

}  // namespace

void solve_constraints(OpenMM::ContextImpl& context, std::string const& user) {
    std::string const platform = context.getPlatform().getName();
    if (platform != "Reference" && platform != "CPU")
        throw InputError(user + " on the platform " + platform, "Context",
                         "name the platform CPU, as in Platform.getPlatform('CPU')");
    auto const* data =
        reinterpret_cast<OpenMM::ReferencePlatform::PlatformData*>(context.getPlatformData());
    OpenMM::ReferenceConstraints& constraints = *data->constraints;
    if (dynamic_cast<ChainConstraints*>(constraints.ccma) != nullptr) return;
    OpenMM::System const& system = context.getSystem();
    std::vector<Constraint> const open = open_constraints(system, settled(constraints));
    if (open.empty()) return;
    auto solver = std::make_unique<ChainConstraints>(
        make_link_solver(masses_of(system), open, threads_of(context)), user);
    delete constraints.ccma;
    constraints.ccma = solver.release();
}

}  // namespace catena::plugin
