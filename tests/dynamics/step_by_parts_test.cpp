// A step by teams of threads that keep their beads in registers leaves the bits of one over arrays.
// The teams here are threads of the host.
#include <gtest/gtest.h>

#include <barrier>
#include <cstring>
#include <map>
#include <mutex>
#include <thread>

#include "dca/solvers/tree_solver.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/bead_dynamics.hpp"
#include "mpi/communicator.hpp"
#include "reader/load_scene.hpp"
#include "tests/dynamics/same_steps.hpp"
#include "tests/support/pulled.hpp"

namespace catena::test {
namespace {

/// What the threads of one team share.
struct Shared {
    explicit Shared(int threads) : barrier(threads), passed(static_cast<std::size_t>(threads)) {}
    using Numbers = Vector<double, 3>;
    std::barrier<> barrier;
    std::vector<Numbers> passed;  // from thread to thread
    std::map<int, Numbers> segment, force;
    std::mutex mutex;
};

/// As DeviceTeam.
class HostTeam {
  public:
    HostTeam(Shared& shared, dca::PartPlace const& place, int thread, int levels)
        : shared_(shared), place_(place), thread_(thread), levels_(levels) {}
    dca::PartPlace place() const { return place_; }
    int part() const { return thread_ % dca::parts_of_run; }
    int slot() const { return thread_ / dca::parts_of_run; }
    int levels() const { return levels_; }
    void sync() const { shared_.barrier.arrive_and_wait(); }
    template <class T>
    T from_inboard(T const& value) const {
        return passed(value, part() == 0 ? 0 : -1);
    }
    template <class T>
    T from_outboard(T const& value) const {
        return passed(value, part() + 1 == dca::parts_of_run ? 0 : 1);
    }
    Vec3 from_before(Vec3 const& value) const { return passed(value, thread_ == 0 ? 0 : -1); }
    Vec3 from_after(Vec3 const& value) const {
        return passed(value, thread_ + 1 == std::ssize(shared_.passed) ? 0 : 1);
    }
    template <class Segment>
    void put(int slot, Segment const& segment) const {
        keep(shared_.segment, slot, segment);
    }
    template <class Segment>
    Segment get(int slot) const {
        return kept<Segment>(shared_.segment, slot);
    }
    void put_force(int slot, Vector<double, 1> const& force) const {
        keep(shared_.force, slot, force);
    }
    template <int K>
    Vector<double, K> force(int slot) const {
        return kept<Vector<double, K>>(shared_.force, slot);
    }

  private:
    template <class T>
    static T part_of(Shared::Numbers const& numbers) {
        static_assert(sizeof(T) <= sizeof(numbers));
        T value;
        std::memcpy(&value, &numbers, sizeof(value));
        return value;
    }
    template <class T>
    T passed(T const& value, int from) const {
        std::memcpy(&shared_.passed[static_cast<std::size_t>(thread_)], &value, sizeof(value));
        sync();
        T const there = part_of<T>(shared_.passed[static_cast<std::size_t>(thread_ + from)]);
        sync();
        return there;
    }
    template <class T>
    void keep(std::map<int, Shared::Numbers>& where, int slot, T const& value) const {
        std::scoped_lock const lock(shared_.mutex);
        std::memcpy(&where[slot], &value, sizeof(value));
    }
    template <class T>
    T kept(std::map<int, Shared::Numbers>& where, int slot) const {
        std::scoped_lock const lock(shared_.mutex);
        return part_of<T>(where[slot]);
    }
    Shared& shared_;
    dca::PartPlace place_;
    int thread_, levels_;
};

/// The host's Space, but steps are carried out by teams.
class TeamSpace : public HostSpace {
  public:
    using HostSpace::HostSpace;
    struct Blocks {
        explicit Blocks(ChainGroup const& group) : plan(dca::plan_teams(group.pieces, 12)) {}
        dca::TeamPlan plan;
    };
    template <int K>
    static constexpr bool has_blocks = K == 1;
    template <int K>
    static constexpr bool has_teams = has_blocks<K>;
    bool pays_by_blocks(ChainGroup const&) const { return true; }
    template <class Action>
    void each_block(Blocks const& blocks, Action const& action) const {
        dca::TeamPlan const& plan = blocks.plan;
        for (std::size_t team = 0; team < plan.levels.size(); ++team) {
            Shared shared(plan.threads);
            std::vector<std::jthread> threads;
            for (int t = 0; t < plan.threads; ++t)
                threads.emplace_back([&, t] {
                    std::size_t const at =
                        team * static_cast<std::size_t>(plan.threads) + static_cast<std::size_t>(t);
                    action(HostTeam(shared, plan.place[at], t, plan.levels[team]));
                });
        }
    }
};

char const* const chains =
    "{base: fixed, generator: {random: {bodies: 70, joint: link, seed: 3}}},"
    "{count: 3, base: free, generator: {freely_jointed: {beads: 23, length: 0.38}}},"
    "{generator: {freely_jointed: {beads: 1, length: 0.38}}},"
    "{count: 2, generator: {freely_jointed: {beads: 2, length: 0.38}}},"
    "{base: fixed, generator: {random: {bodies: 33, joint: link, seed: 5}}},"
    "{base: fixed, generator: {random: {bodies: 16, joint: link, seed: 6}}},"
    "{base: free, generator: {random: {bodies: 64, joint: link, seed: 6}}},"
    "{base: free, generator: {random: {bodies: 140, joint: link, seed: 7}}},"
    "{base: fixed, generator: {random: {bodies: 17, joint: link, seed: 8}}}";

/// Whether steps are Langevin steps, and whether beads are pulled.
class StepByParts : public ::testing::TestWithParam<std::tuple<bool, bool>> {
  protected:
    StepByParts() {
        if (std::get<1>(GetParam())) scene_ = pulled(std::move(scene_));
        groups_ = make_groups(scene_, Axes::world, Handles::projected, false, *communicator_);
    }
    template <class Space>
    std::unique_ptr<AbsoluteDynamics> dynamics() const {
        Space const space(*executor_);
        auto d = std::make_unique<BeadDynamics<Space>>(
            *groups_[0], scene_, space, *communicator_,
            std::make_unique<dca::TreeSolver<dca::BeadLeaf<1>, Space>>(*groups_[0], space,
                                                                       *communicator_));
        d->update_configuration();
        d->assemble_matrices();
        d->draw_velocities(2.5, 7, std::vector<bool>(scene_.chains.size(), true));
        return d;
    }
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
    std::unique_ptr<Executor> executor_ = serial_executor();
    Scene scene_ = parse_scene(
        std::string("chains: [") + chains + "]\nforces: {gravity: [0.5, 0, -9.81]}", "scene.yaml");
    std::vector<std::unique_ptr<ChainGroup>> groups_;
};

TEST_P(StepByParts, LeavesTheSameBits) {
    expect_same_steps(*dynamics<TeamSpace>(), *dynamics<HostSpace>(), std::get<0>(GetParam()), 3);
}
INSTANTIATE_TEST_SUITE_P(Steps, StepByParts,
                         ::testing::Combine(::testing::Bool(), ::testing::Bool()),
                         [](auto const& each) {
                             return std::string(std::get<0>(each.param) ? "langevin" : "rattle") +
                                    (std::get<1>(each.param) ? "_pulled" : "");
                         });

}  // namespace
}  // namespace catena::test
