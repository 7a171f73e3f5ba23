// The Dormand-Prince integrator in joint coordinates, with fixed or adaptive inner steps.
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "integrate/checkpoint_values.hpp"
#include "integrate/joint_integrators.hpp"
#include "integrate/step_control.hpp"
#include "mpi/first_rank.hpp"

namespace catena {
namespace {

/// Coefficients of RK5(4)7M (Dormand & Prince, J. Comput. Appl. Math. 6, 19, 1980). Six stages make
/// a step of fifth order. The rates after it, which are the first of the next step, complete the
/// embedded solution of fourth order.
struct DormandPrince {
    static constexpr int stages = EmbeddedStage::stages;
    static constexpr double weight[stages][stages] = {
        {1.0 / 5, 0, 0, 0, 0, 0},
        {3.0 / 40, 9.0 / 40, 0, 0, 0, 0},
        {44.0 / 45, -56.0 / 15, 32.0 / 9, 0, 0, 0},
        {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729, 0, 0},
        {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656, 0},
        {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
    static constexpr double time[stages] = {1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
    /// Weights of the difference of the two orders; the last one belongs to the rates after the
    /// step.
    static constexpr double difference[stages + 1] = {
        71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
};

constexpr double eps = std::numeric_limits<double>::epsilon();
// Inner steps of one time step, rejected ones included.
constexpr std::int64_t most_inner_steps = 100000;
constexpr char const* name_of_state = "inner_step";

constexpr JointOperation save_rates{JointOperator::save};

/// JointIntegrator of the Dormand-Prince pair.
class DormandPrinceSteps final : public JointIntegrator {
  public:
    DormandPrinceSteps(ChainSystem& system, double tolerance, double step)
        : system_(system), groups_(system.joint()), tolerance_(tolerance), control_(step) {
        has_tips_ = std::any_of(groups_.begin(), groups_.end(),
                                [](JointDynamics const* g) { return g->group().has_closures(); });
    }
    /// Closing tips and loops changes the state, so that the accelerations at the step's end are no
    /// longer valid.
    bool carries_rates() const override { return !has_tips_; }
    void close_with(int corrections) override { corrections_ = corrections; }
    std::optional<SweepsAStep> last_step() const override { return last_; }
    StepControl const* control() const override { return tolerance_ > 0 ? &control_ : nullptr; }
    void save(Checkpoint& c) const override {
        if (tolerance_ > 0)
            c.arrays[name_of_state] = {control_.state().length, control_.state().previous};
    }
    void restored(Checkpoint const& c) override {
        if (std::vector<double> const kept = few_numbers_of(c, name_of_state, 2); !kept.empty())
            control_.restore({kept[0], kept[1]});
        ready_ = carries_rates();
    }
    void prepare() override {
        if (ready_) return make_ghosts(system_);
        solve();
        for (JointDynamics* const group : groups_) group->apply(save_rates, 0);
        ready_ = true;
    }

    void step(double h) override {
        prepare();
        double const start = groups_.empty() ? 0.0 : groups_.front()->time();
        std::int64_t tries = 0;
        for (double done = 0; done < h;) {
            if (done > 0) begin_at(start + done);
            double const left = h - done;
            for (InnerStep inner{start + done};; inner.again = true) {
                if (tries++ == most_inner_steps)
                    refuse(start + done, control_.state().length,
                           "100,000 inner steps are not enough");
                inner.length = tolerance_ > 0 ? control_.length(left) : h;
                bool const reaches = inner.length == left;
                inner.end = start + (reaches ? h : done + inner.length);
                if (inner.length <= 16 * eps * std::max(inner.end, h))
                    refuse(start + done, inner.length,
                           "the inner step cannot be shortened further");
                bool const there = advance(inner);
                if (tolerance_ > 0 &&
                    !control_.accepts(inner.length, there ? error(inner.length) : HUGE_VAL))
                    continue;
                done = reaches ? h : done + inner.length;
                break;
            }
            for (JointDynamics* const group : groups_) group->apply(save_rates, 0);
            ready_ = !has_tips_;
            ++now_.closings;
        }
        last_ = now_;
        now_ = {0, 0, 0};
    }

  private:
    /// Computes accelerations and counts the sweeps.
    void solve() {
        system_.solve_joint_groups();
        ++now_.matrices;
        ++now_.biases;
    }
    /// Starts the next inner step.
    void begin_at(double time) {
        if (has_tips_) system_.close_tips(corrections_);
        for (JointDynamics* const group : groups_) group->set_time(time);
        prepare();
    }
    /// Computes all stages of an inner step. Returns false if the step is far too long.
    bool advance(InnerStep const& inner) {
        for (int stage = 0; stage < DormandPrince::stages; ++stage) {
            EmbeddedStage const s = embedded_stage(stage, inner);
            for (JointDynamics* const group : groups_) group->apply(s);
            if (tolerance_ > 0 && is_wild(inner.length)) return false;
            solve();
        }
        return true;
    }
    /// True if the next stage's state is too far off. Checked before equations are solved, whose
    /// failure only one rank would see.
    bool is_wild(double length) {
        double worst = 0;
        for (JointDynamics* const group : groups_)
            worst = larger(worst, group->stage_divergence(length));
        return !(system_.communicator().max(worst) < 1);
    }
    /// Returns the largest error of a coordinate, divided by the allowed error. Maxima are exact in
    /// any order. Angles are relative to a radian, lengths to the reach of the longest chain, and
    /// velocities to the largest of their kind. Errors below the rounding of coordinates within the
    /// step do not count.
    double error(double length) {
        Speeds fastest;
        double reach = 0;
        for (JointDynamics* const group : groups_) {
            Speeds const s = group->fastest();
            fastest = {larger(fastest.angular, s.angular), larger(fastest.linear, s.linear)};
            reach = std::max(reach, group->reach());
        }
        Communicator const& all = system_.communicator();
        fastest = {all.max(fastest.angular), all.max(fastest.linear)};
        double const turning = std::max(tolerance_ * fastest.angular, 16 * eps / length);
        double const sliding =
            std::max(tolerance_ * std::max(fastest.linear, reach * fastest.angular),
                     16 * eps * reach / length);
        AllowedErrors const allowed{tolerance_, tolerance_ * reach, {turning, sliding}};
        double worst = 0;
        for (JointDynamics* const group : groups_)
            worst = larger(worst, group->embedded_error(embedded_difference(length), allowed));
        return all.max(worst);
    }
    /// Throws on every rank: all ranks find the same reason.
    [[noreturn]] void refuse(double time, double length, char const* why) const {
        std::ostringstream line;
        line << why << " for dynamics.tolerance " << tolerance_ << " at time " << time
             << " (the last inner step is " << length
             << " long): raise the tolerance, or look at the forces and joints there";
        throw SharedError(line.str());
    }

    ChainSystem& system_;
    std::vector<JointDynamics*> groups_;
    double tolerance_;
    StepControl control_;
    bool has_tips_ = false, ready_ = false;
    int corrections_ = JointDynamics::usual_corrections;
    // now_: sweeps of the step in progress, counted from its preparation.
    SweepsAStep now_{0, 0, 0}, last_;
};

}  // namespace

EmbeddedStage embedded_stage(int stage, InnerStep const& step) {
    EmbeddedStage s{
        stage, step.again && stage == 0, {}, step.start + DormandPrince::time[stage] * step.length};
    if (DormandPrince::time[stage] == 1) s.time = step.end;
    for (int i = 0; i <= stage; ++i) s.weight[i] = DormandPrince::weight[stage][i] * step.length;
    return s;
}

EmbeddedDifference embedded_difference(double length) {
    EmbeddedDifference d;
    for (int i = 0; i <= DormandPrince::stages; ++i)
        d.weight[i] = DormandPrince::difference[i] * length;
    return d;
}

std::unique_ptr<JointIntegrator> make_dormand_prince(ChainSystem& system, double tolerance,
                                                     double step) {
    return std::make_unique<DormandPrinceSteps>(system, tolerance, step);
}

}  // namespace catena
