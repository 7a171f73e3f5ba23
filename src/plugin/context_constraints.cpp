// Constraints of a Context on the host, and their place in the Context.
#include "plugin/context_constraints.hpp"

#include <OpenMM.h>
#include <openmm/internal/ContextImpl.h>
#include <openmm/kernels.h>

#include <utility>

#include "error.hpp"
#include "plugin/held_constraints.hpp"
#include "plugin/vectors.hpp"

namespace catena::plugin {
namespace {

// A Context keeps its kernels private. An explicit instantiation may name private members.
OpenMM::Kernel& constraints_kernel(OpenMM::ContextImpl& context);
template <OpenMM::Kernel OpenMM::ContextImpl::* member>
struct Opened {
    friend OpenMM::Kernel& constraints_kernel(OpenMM::ContextImpl& context) {
        return context.*member;
    }
};
template struct Opened<&OpenMM::ContextImpl::applyConstraintsKernel>;

/// Applies the platform's constraints, then Catena's.
class BothConstraints final : public OpenMM::ApplyConstraintsKernel {
  public:
    BothConstraints(OpenMM::Platform const& where, OpenMM::Kernel theirs,
                    std::shared_ptr<ContextConstraints> own)
        : ApplyConstraintsKernel(Name(), where), theirs_(std::move(theirs)), own_(std::move(own)) {}
    void initialize(OpenMM::System const&) override {}
    void apply(OpenMM::ContextImpl& context, double tolerance) override {
        theirs_.getAs<ApplyConstraintsKernel>().apply(context, tolerance);
        own_->restore_positions(tolerance);
        context.computeVirtualSites();
    }
    void applyToVelocities(OpenMM::ContextImpl& context, double tolerance) override {
        theirs_.getAs<ApplyConstraintsKernel>().applyToVelocities(context, tolerance);
        own_->project_velocities();
    }

  private:
    OpenMM::Kernel theirs_;
    std::shared_ptr<ContextConstraints> own_;
};

}  // namespace

std::vector<double> masses_of(OpenMM::System const& system) {
    std::vector<double> mass;
    for (int k = 0; k < system.getNumParticles(); ++k) mass.push_back(system.getParticleMass(k));
    return mass;
}

std::vector<Constraint> constraints_to_solve(OpenMM::System const& system) {
    std::vector<Constraint> open = constraints_in(system);
    std::vector<bool> const settled = left_to_settle(system.getNumParticles(), open);
    std::size_t i = 0;
    std::erase_if(open, [&](Constraint const& c) {
        return settled[i++] ||
               (system.getParticleMass(c.first) == 0 && system.getParticleMass(c.second) == 0);
    });
    return open;
}

ContextConstraints::ContextConstraints(OpenMM::ContextImpl& context, std::string user)
    : context_(context), user_(std::move(user)) {}

LinkSolver& ContextConstraints::solver() {
    OpenMM::System const& system = context_.getSystem();
    if (!solver_) solver_ = make_link_solver(masses_of(system), constraints_to_solve(system), 1);
    return *solver_;
}

void ContextConstraints::restore_positions(double tolerance) {
    std::vector<OpenMM::Vec3> x;
    context_.getPositions(x);
    as_openmm_error(user_, [&] { solver().restore(as_span(x), tolerance); });
    context_.setPositions(x);
}

void ContextConstraints::project_velocities() {
    std::vector<OpenMM::Vec3> x, v;
    context_.getPositions(x);
    context_.getVelocities(v);
    as_openmm_error(user_, [&] { solver().project(as_span(x), as_span(v)); });
    context_.setVelocities(v);
}

double ContextConstraints::shifted_kinetic_energy(double shift) {
    std::vector<OpenMM::Vec3> x, v, force;
    context_.getPositions(x);
    context_.computeShiftedVelocities(shift, v);
    as_openmm_error(user_, [&] { solver().project(as_span(x), as_span(v)); });
    double twice = 0;
    for (std::size_t k = 0; k < v.size(); ++k)
        twice += context_.getSystem().getParticleMass(static_cast<int>(k)) * v[k].dot(v[k]);
    return twice / 2;
}

void apply_in_context(OpenMM::ContextImpl& context,
                      std::shared_ptr<ContextConstraints> constraints) {
    OpenMM::Kernel& kernel = constraints_kernel(context);
    kernel =
        OpenMM::Kernel(new BothConstraints(context.getPlatform(), kernel, std::move(constraints)));
}

}  // namespace catena::plugin
