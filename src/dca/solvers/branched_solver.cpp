// Host solver of branched chains of point beads: the sweeps of tree_sweeps.hpp over the paths of
// one phase after the other, and the folds of side paths into the beads on which they hang.
#include "clock.hpp"
#include "dca/branched_leaf.hpp"
#include "dca/host_space.hpp"
#include "dca/tree_sweeps.hpp"

namespace catena::dca {
namespace {

/// Returns the sum of term(item), in pairs of an order that depends on the number of items alone.
template <class T, class Item, class Term>
T sum_of(std::span<Item> items, Term const& term) {
    std::size_t constexpr few = 4;
    if (items.size() > few) {
        std::size_t const half = items.size() / 2;
        return sum_of<T>(items.first(half), term) + sum_of<T>(items.subspan(half), term);
    }
    T sum = term(items[0]);
    for (Item& item : items.subspan(1)) sum = sum + term(item);
    return sum;
}

/// Returns the inverse of a symmetric positive definite matrix.
Sym3 inverse_of(Sym3 const& m) {
    Sym3 const factor = factorize(m, 3);
    Sym3 inverse;
    for (int j = 0; j < 3; ++j) {
        Vec3 unit = Vec3::zero();
        unit[j] = 1;
        Vec3 const column = solve_upper(factor, solve_lower(factor, unit));
        for (int i = j; i < 3; ++i) inverse(i, j) = column[i];
    }
    return inverse;
}

/// Returns the triangle of mu u u^T.
Vector<double, 6> inertia_along(double mu, Vec3 const& u) {
    Vector<double, 6> m;
    for (int i = 0, at = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) m[at++] = mu * u[i] * u[j];
    return m;
}

class BranchedSolver final : public ChainSolver {
    using Sweeps = TreeSweeps<BranchedLeaf>;

  public:
    /// Allocates all arrays. The group and the executor must outlive the solver.
    BranchedSolver(ChainGroup const& group, Executor const& executor,
                   Communicator const& communicator)
        : group_(group),
          branches_(group.branches),
          space_(executor),
          communicator_(communicator),
          fork_(static_cast<std::size_t>(group.size), -1),
          ends_(static_cast<std::size_t>(group.size), 0),
          forks_(std::ssize(branches_.forks)),
          matrices_(branches_.slots),
          biases_(branches_.slots),
          joints_(branches_.joints),
          offsets_(branches_.joints),
          forces_(branches_.joints),
          sweeps_{
              BranchedLeaf(group.view(), branches_.body.data(), fork_.data(), ends_.data(), forks_),
              nullptr,
              matrices_.view(),
              biases_.view(),
              joints_.view(),
              offsets_.view(),
              forces_.view(),
              &lost_} {
        for (std::size_t f = 0; f < branches_.forks.size(); ++f)
            fork_[at(branches_.forks[f].place)] = static_cast<std::int32_t>(f);
        for (std::int64_t path = 1; path <= branches_.paths(); ++path)
            ends_[at(branches_.first_of_path[at(path)] - 1)] = 1;
        restricted_.assign(static_cast<std::size_t>(branches_.joints), 0);
        for (std::int64_t place = 0; place < group.size; ++place)
            restricted_[at(place)] = group.restricted_of_joint[at(branches_.body[at(place)])];
        sweeps_.restricted = restricted_.data();
        if (branches_.phases() > 1)
            side_.resize(at(branches_.paths() - branches_.first_of_phase[1]));
        for (PhaseLists const& lists : branches_.lists)
            tree_.emplace_back(lists.runs, lists.levels, lists.roots, branches_.slots, restricted_,
                               Sweeps::in_stage);
    }

    void assemble_matrices(ConfigurationView const& configuration) override {
        double const start = seconds_now();
        sweeps_.leaf.set(configuration);
        for (std::int64_t phase = branches_.phases(); phase-- > 0;) {
            space_of(phase).climb(tree_[at(phase)], MatrixSweep<BranchedLeaf>{sweeps_});
            if (phase > 0) each_fork(phase - 1, [this](std::int64_t f) { fold_matrices(f); });
        }
        ++report_.matrix_sweeps;
        report_.matrix_seconds += seconds_now() - start;
        check();
    }

    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        double const start = seconds_now();
        sweeps_.leaf.set(out.joint_force);
        BiasSweep<BranchedLeaf> const sweep{sweeps_, loads, {{}, out.acceleration, {}, {}}};
        for (std::int64_t phase = branches_.phases(); phase-- > 0;) {
            space_of(phase).climb(tree_[at(phase)], sweep);
            if (phase > 0) each_fork(phase - 1, [this](std::int64_t f) { fold_biases(f); });
        }
        for (std::int64_t phase = 0; phase < branches_.phases(); ++phase) {
            if (phase > 0)
                each_fork(phase - 1, [&](std::int64_t f) { unfold(f, out.acceleration); });
            space_of(phase).descend(tree_[at(phase)], sweep);
        }
        ++report_.bias_sweeps;
        report_.bias_seconds += seconds_now() - start;
    }

    void check() override {
        if (lost_ == none_lost) return;
        auto const place = static_cast<std::int64_t>(std::exchange(lost_, none_lost));
        refuse_indefinite(group_, communicator_.rank(), branches_.body[at(place)]);
    }

    SolverReport report() const override {
        SolverReport r = report_;
        add_tree(group_, communicator_, r);
        r.threads = space_.threads();
        Schedule sizes;
        sizes.slots = branches_.slots;
        sizes.joints = branches_.joints;
        r.memory_bytes = Sweeps::bytes(sizes) +
                         std::ssize(branches_.forks) *
                             static_cast<std::int64_t>(sizeof(Sym3) + 2 * sizeof(Vec3)) +
                         std::ssize(side_) * static_cast<std::int64_t>(sizeof(SideLink));
        return r;
    }

  private:
    static constexpr unsigned long long none_lost = PivotFailure{}.joint;
    static std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }
    /// Bodies of a phase whose loops threads share.
    static constexpr std::int64_t worth_threads = 4096;

    /// Returns the space of a phase's loops. Few bodies are not worth the barriers of threads.
    HostSpace const& space_of(std::int64_t phase) const {
        auto const place_of = [this](std::int64_t p) {
            return branches_.first_of_path[at(branches_.first_of_phase[at(p)])];
        };
        return place_of(phase + 1) - place_of(phase) < worth_threads ? alone_ : space_;
    }
    /// Calls action(f) for every fork of a phase.
    template <class Action>
    void each_fork(std::int64_t phase, Action const& action) const {
        std::int64_t const first = branches_.first_fork_of_phase[at(phase)],
                           end = branches_.first_fork_of_phase[at(phase) + 1];
        space_of(phase).for_each(end - first, [&](std::int64_t i) { action(first + i); });
    }
    /// Returns the place of the first bead of a path.
    std::int64_t head(std::int64_t path) const { return branches_.first_of_path[at(path)]; }
    /// The inboard link of a side path.
    struct SideLink {
        Vec3 direction;
        double mass = 0;   // effective mass of the path at this link, mu; 0 after a pivot failure
        double force = 0;  // on the path
    };
    /// Returns the inboard links of a fork's side paths.
    std::span<SideLink> links_of(Fork const& fork) {
        return std::span(side_).subspan(at(fork.first_path - branches_.first_of_phase[1]),
                                        at(fork.paths()));
    }
    std::int64_t bead(Fork const& fork) const { return branches_.body[at(fork.place)]; }
    double mass(Fork const& fork) const { return group_.mass[bead(fork)][0]; }
    /// Returns the sum of the forces on side paths.
    static Vec3 given(std::span<SideLink const> links) {
        return sum_of<Vec3>(links, [](SideLink const& l) { return l.force * l.direction; });
    }
    /// Adds to the forces on side paths what an acceleration of the fork's bead contributes.
    static void give(std::span<SideLink> links, Vec3 const& acceleration) {
        for (SideLink& l : links) l.force = fused(l.mass, dot(l.direction, acceleration), l.force);
    }
    /// Sets the inverse mass of a fork: E^-1 = m 1 + sum mu u u^T.
    void fold_matrices(std::int64_t f) {
        Fork const& fork = branches_.forks[at(f)];
        std::span<SideLink> const links = links_of(fork);
        std::int64_t path = fork.first_path;
        for (SideLink& l : links) {
            std::int64_t const place = head(path++);
            l.direction = sweeps_.leaf.inboard(place);
            l.mass = sweeps_.joints.load(place).factor(0, 0);
        }
        Sym3 m = as_symmetric(sum_of<Vector<double, 6>>(
            links, [](SideLink const& l) { return inertia_along(l.mass, l.direction); }));
        for (int i = 0; i < 3; ++i) m(i, i) += mass(fork);
        forks_.inverse_mass[at(f)] = inverse_of(m);
    }
    /// Sets the force that the side paths of a fork exert on its bead at rest. The bias sweep has
    /// closed each of them as a chain on the ground.
    void fold_biases(std::int64_t f) {
        Fork const& fork = branches_.forks[at(f)];
        std::span<SideLink> const links = links_of(fork);
        std::int64_t path = fork.first_path;
        for (SideLink& l : links) l.force = sweeps_.forces.load(head(path++))[0];
        forks_.push[at(f)] = -given(links);
    }
    /// Computes the acceleration of a fork's bead and the forces at the inboard links of its side
    /// paths.
    void unfold(std::int64_t f, View<3> acceleration) {
        Fork const& fork = branches_.forks[at(f)];
        std::span<SideLink> const links = links_of(fork);
        Sym3 const& e = forks_.inverse_mass[at(f)];
        Vec3 const force = forks_.force[at(f)], a = e * (force + forks_.push[at(f)]);
        give(links, a);
        // These forces have the rounding errors of mu a, which exceed the forces if the side paths
        // are heavy. What they leave unbalanced is found from the forces themselves.
        Vec3 const change = e * plus_scaled(force - given(links), -mass(fork), a);
        give(links, change);
        if (acceleration.origin) acceleration.store(bead(fork), a + change);
        std::int64_t path = fork.first_path;
        for (SideLink const& l : links) sweeps_.forces.store(head(path++), {{l.force}});
    }

    ChainGroup const& group_;
    Branches const& branches_;
    HostSpace space_, alone_{this_thread()};
    Communicator const& communicator_;
    // By place: fork, end of the path, restricted directions of the inboard joint.
    std::vector<std::int32_t> fork_;
    std::vector<std::uint8_t> ends_, restricted_;
    ForkBeads forks_;
    // Inboard links of side paths, in the order of the paths.
    std::vector<SideLink> side_;
    // Trees of the phases.
    std::vector<HostSpace::Tree> tree_;
    // As in TreeSolver; joints have the numbers of places.
    HostSpace::Records<Sweeps::Matrices, Order::plain> matrices_;
    HostSpace::Records<Sweeps::Biases, Order::plain> biases_;
    HostSpace::Records<Sweeps::Joint, Order::by_body> joints_;
    HostSpace::Records<Sweeps::Offset, Order::by_body> offsets_;
    HostSpace::Records<Sweeps::State, Order::by_body> forces_;
    unsigned long long lost_ = none_lost;
    Sweeps sweeps_;
    SolverReport report_;
};

}  // namespace

/// Returns the host solver of branched chains of point beads.
std::unique_ptr<ChainSolver> make_branched_solver(ChainGroup const& group, Executor const& executor,
                                                  Communicator const& communicator) {
    return std::make_unique<BranchedSolver>(group, executor, communicator);
}

}  // namespace catena::dca
