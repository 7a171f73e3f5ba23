// Implements Solver on a ChainSystem in joint coordinates.
#include "catena/solver.hpp"

#include <utility>

#include "catena/content.hpp"
#include "catena/own_forces.hpp"
#include "catena/start.hpp"
#include "measure/forward_error.hpp"
#include "measure/solution.hpp"

namespace catena {

class Solver::Content {
  public:
    Content(Scene const& scene, OwnForce force)
        : alone_(serial_communicator()),
          scene_(start_of(scene, Axes::joint, force != nullptr, *alone_)),
          system_(scene_, Axes::joint, *alone_) {
        if (scene_.solver.refine > 0 && system_.joint().empty())
            throw InputError("chains of beads or linked bodies cannot be refined", "solver.refine",
                             "leave it out");
        if (force) forces_.emplace(std::move(force), system_);
        system_.close_tips();
    }

    SolverResult solve() {
        system_.evaluate();
        for (int step = 0; step < scene_.solver.refine; ++step) system_.refine();
        SolverResult result;
        ForwardError const error = forward_error(system_, [&] { result = present(); });
        result.error = error.estimate;
        return result;
    }

  private:
    /// Result of the last evaluation and refinement.
    SolverResult present() {
        SolverResult result;
        Solution const s = solution_of(system_);
        ChainSystem::Accelerations const a = system_.accelerations();
        result.joint_acceleration = s.acceleration;
        result.first = s.acceleration_offset;
        for (Vec3 const& v : a.acceleration) result.acceleration.push_back(as_triple(v));
        for (std::size_t k = 0; k < a.alpha.size(); ++k)
            result.angular_acceleration.push_back(as_triple(a.alpha[k]));
        for (auto const& w : a.joint_force) result.joint_force.push_back(as_joint_force(w));
        for (TipForce const& tip : a.tip_force)
            result.tip_force.push_back(as_joint_force(tip.wrench));
        for (TipForce const& loop : a.loop_force)
            result.loop_force.push_back(as_joint_force(loop.wrench));
        result.residual = system_.residual();
        result.residual_bound = system_.residual_bound();
        result.error_bound = largest_forward_error;
        return result;
    }

    std::unique_ptr<Communicator> alone_;
    Scene scene_;
    ChainSystem system_;
    std::optional<OwnForces> forces_;
};

Solver::Solver(Model const& model, OwnForce force)
    : content_(with_public_errors(
          [&] { return std::make_unique<Content>(model.content().scene(), std::move(force)); })) {}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

SolverResult Solver::solve() {
    return with_public_errors([&] { return content_->solve(); });
}

}  // namespace catena
