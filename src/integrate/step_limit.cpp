// Estimate of the longest stable time step from the joints' springs.
#include "integrate/step_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "mpi/communicator.hpp"
#include "scene/freedom.hpp"
#include "terms/force_terms.hpp"

namespace catena {
namespace {

/// Limits of the sample: chains of one kind are alike, and so are the bodies of a long chain.
constexpr std::size_t most_chains = 4, most_bodies = 400;
constexpr int most_iterations = 400, least_iterations = 50;
// Relative change of the squared frequency between iterations at convergence.
constexpr double settled = 1e-4;
/// Fraction of the limit above which a note is given. At 0.71 of it, where four steps are a period
/// of the stiffest mode, energy grows by resonance.
constexpr double near = 0.65;

/// True if a joint of the chain has a spring.
bool has_springs(ChainSpec const& chain) {
    auto const& k = chain.bodies.stiffness;
    return std::any_of(k.begin(), k.end(),
                       [](Vec3 const& stiffness) { return norm(stiffness) > 0; });
}

/// Removes the entries of a list from `size` on.
template <class T>
void cut(std::vector<T>& list, std::size_t size) {
    if (list.size() > size)
        list.erase(list.begin() + static_cast<std::ptrdiff_t>(size), list.end());
}
/// Removes the bodies of a chain from `size` on, and its tip.
void cut(ChainSpec& chain, std::size_t size) {
    BodyArrays& b = chain.bodies;
    if (b.size() <= size) return;
    cut(b.mass, size), cut(b.com, size), cut(b.inertia, size), cut(b.joint, size),
        cut(b.axis, size), cut(b.rotation, size);
    cut(b.translation, size), cut(b.q, size), cut(b.qd, size), cut(b.first_axis, size),
        cut(b.pitch, size);
    terms::for_each_column([&](auto const& column) { cut(b.*column.values, size); });
    for (TermNumbers& each : chain.term_numbers)
        cut(each.values, size * static_cast<std::size_t>(each.width));
    std::erase_if(b.driven, [&](DrivenJoint const& joint) {
        return joint.body >= static_cast<std::int64_t>(size);
    });
    cut(chain.parent, size);
    chain.tip = Tip::free;
    chain.loops.clear();
    chain.redundant_directions = 0;
}

/// Returns a scene of the chains with springs only, for forward dynamics on one thread.
Scene sprung_part(Scene const& scene) {
    Scene part;
    part.si = scene.si;
    part.file = scene.file;
    part.forces.gravity = scene.forces.gravity;
    part.dynamics.integrator = Integrator::velocity_verlet;
    part.dynamics.given = true;
    part.solver.backend = Backend::segments;
    part.solver.threads = 1;
    // The scene's handles: those with fewer digits may fail or be far off.
    part.solver.handles = scene.solver.handles;
    for (ChainSpec const& chain : scene.chains) {
        if (!has_springs(chain) || part.chains.size() == most_chains) continue;
        part.chains.push_back(chain);
        part.chains.back().velocities = StartVelocities::zero;
        part.chains.back().bodies.carried = {};
        cut(part.chains.back(), most_bodies);
    }
    return part;
}

/// Displacements of all groups along their coordinates, and the accelerations that they add.
class Displacements {
  public:
    /// Sets all velocities to zero and starts from an irregular displacement.
    explicit Displacements(ChainSystem& system) : system_(system) {
        for (JointDynamics* const group : system_.joint()) {
            JointState at_rest = group->state();
            for (Field<3>* const rates : {&at_rest.qd, &at_rest.base_velocity})
                for (std::int64_t k = 0; k < rates->size(); ++k) rates->set(k, Vec3::zero());
            group->set_state(at_rest);
            start_.push_back(std::move(at_rest));
        }
        for (JointState const& s : start_) along_.push_back({s.qd, s.base_velocity});
        unmoved_ = accelerations();
        std::int64_t i = 0;
        // No mode is orthogonal to a sequence of numbers without a pattern.
        each([&](Vec3&, Vec3& along) {
            for (int c = 0; c < 3; ++c)
                along[c] = std::sin(1.0 + 12.9898 * static_cast<double>(++i));
        });
    }
    /// Replaces the displacement by the accelerations that it adds. Returns the ratio of their
    /// lengths.
    double iterate() {
        scale(1 / length());
        for (std::size_t g = 0; g < start_.size(); ++g) {
            JointDynamics& group = *system_.joint()[g];
            JointState s = start_[g];
            s.qd = along_[g].qdd;
            s.base_velocity = along_[g].base_acceleration;
            group.set_state(s);
            group.apply({JointOperator::drift}, small);
            s = group.state();
            s.qd = start_[g].qd;
            s.base_velocity = start_[g].base_velocity;
            group.set_state(s);
        }
        moved_ = accelerations();
        each([&](Vec3& change, Vec3& along) { along = change; });
        double const grown = length();
        return grown;
    }

  private:
    // size of the displacement
    static constexpr double small = 1e-6;
    /// Computes the accelerations of all groups at their present states.
    std::vector<JointRates> accelerations() {
        system_.solve_joint_groups();
        std::vector<JointRates> all;
        for (JointDynamics* const group : system_.joint()) {
            group->set_rates();
            all.push_back(group->rates());
        }
        return all;
    }
    /// Calls action(change of the acceleration per displacement, displacement) for the three
    /// numbers of every coordinate.
    template <class Action>
    void each(Action const& action) {
        for (std::size_t g = 0; g < along_.size(); ++g)
            for (Field<3> JointRates::* const part :
                 {&JointRates::qdd, &JointRates::base_acceleration})
                for (std::int64_t k = 0; k < (along_[g].*part).size(); ++k) {
                    Vec3 change =
                        moved_.empty()
                            ? Vec3::zero()
                            : (1 / small) * ((moved_[g].*part)[k] - (unmoved_[g].*part)[k]);
                    Vec3 along = (along_[g].*part)[k];
                    action(change, along);
                    (along_[g].*part).set(k, along);
                }
    }
    /// Euclidean length of the displacement.
    double length() {
        double square = 0;
        each([&](Vec3&, Vec3& along) { square += dot(along, along); });
        return std::sqrt(square);
    }
    void scale(double factor) {
        each([&](Vec3&, Vec3& along) { along = factor * along; });
    }

    ChainSystem& system_;
    std::vector<JointState> start_;
    std::vector<JointRates> along_, unmoved_, moved_;
};

/// Returns the largest angular frequency of the chains of `scene`; 0 if there is none.
double largest_frequency_of(Scene const& scene) {
    auto const alone = serial_communicator();
    ChainSystem system(scene, Axes::joint, *alone);
    Displacements displacements(system);
    double square = 0;
    for (int i = 0; i < most_iterations; ++i) {
        double const last = std::exchange(square, displacements.iterate());
        if (!std::isfinite(square) || square == 0) return 0;
        if (i >= least_iterations && std::abs(square - last) < settled * square) break;
    }
    return std::sqrt(square);
}

/// Returns 0 if there is no frequency, or if it cannot be computed: the run itself reports the
/// error.
double largest_frequency(Scene const& scene) {
    try {
        return largest_frequency_of(scene);
    } catch (ComputationError const&) {
        return 0;
    }
}

}  // namespace

std::optional<StepLimit> estimate_step_limit(Scene const& scene) {
    DynamicsSpec const& d = scene.dynamics;
    if (!d.given || is_implicit(d.integrator) || d.tolerance > 0) return std::nullopt;
    Scene const part = sprung_part(scene);
    if (part.chains.empty()) return std::nullopt;
    double const frequency = largest_frequency(part);
    if (frequency == 0) return std::nullopt;
    bool const whole =
        std::all_of(scene.chains.begin(), scene.chains.end(), [](ChainSpec const& chain) {
            return !has_springs(chain) || chain.bodies.size() <= most_bodies;
        });
    return StepLimit{frequency, traits_of(d.integrator).stability / frequency, whole};
}

std::string text_of(StepLimit const& limit, Scene const& scene) {
    return fmt::format("{:.3g} {} ({:.3g} / the largest frequency of the joints' springs)",
                       limit.step, scene.si ? "s" : "ps",
                       traits_of(scene.dynamics.integrator).stability);
}

std::string note_of_step(Scene const& scene, std::optional<StepLimit> const& limit) {
    double const step = scene.dynamics.step;
    if (!limit || step <= near * limit->step) return "";
    std::string const longest = "the longest stable step, " + text_of(*limit, scene);
    if (step > limit->step && limit->whole)
        throw InputError(fmt::format("a step of {:.4g} is longer than {}", step, longest),
                         scene.file + ": dynamics.step",
                         "choose a smaller one, or an implicit integrator");
    return fmt::format("dynamics.step = {:.4g} is {} {}: half of it conserves energy better", step,
                       step > limit->step ? "longer than" : "near", longest);
}

}  // namespace catena
