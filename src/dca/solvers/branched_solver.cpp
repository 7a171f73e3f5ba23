// Host solver of branched chains of point beads: the sweeps of tree_sweeps.hpp over the paths of
// one phase after the other, and the folds of side paths into the beads on which they hang.
#include "clock.hpp"
#include "dca/branched_leaf.hpp"
#include "dca/host_space.hpp"
#include "dca/tree_sweeps.hpp"

namespace catena::dca {
namespace {

/// Returns the sum of term(i) for i in [begin, end), in pairs of an order that depends on the range
/// alone.
template <class T, class Term>
T sum_of(std::int64_t begin, std::int64_t end, Term const& term) {
    std::int64_t constexpr few = 4;
    if (end - begin > few) {
        std::int64_t const middle = begin + (end - begin) / 2;
        return sum_of<T>(begin, middle, term) + sum_of<T>(middle, end, term);
    }
    T sum = term(begin);
    for (std::int64_t i = begin + 1; i < end; ++i) sum = sum + term(i);
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

/// Returns mu u u^T.
Sym3 inertia_along(double mu, Vec3 const& u) {
    Sym3 m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) m(i, j) = mu * u[i] * u[j];
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
        for (PhaseLists const& lists : branches_.lists)
            tree_.emplace_back(lists.runs, lists.levels, lists.roots, branches_.slots, restricted_,
                               Sweeps::in_stage);
    }

    void assemble_matrices(ConfigurationView const& configuration) override {
        double const start = seconds_now();
        sweeps_.leaf.set(configuration);
        for (std::int64_t phase = branches_.phases(); phase-- > 0;) {
            space_.climb(tree_[at(phase)], MatrixSweep<BranchedLeaf>{sweeps_});
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
            space_.climb(tree_[at(phase)], sweep);
            if (phase > 0) each_fork(phase - 1, [this](std::int64_t f) { fold_biases(f); });
        }
        for (std::int64_t phase = 0; phase < branches_.phases(); ++phase) {
            if (phase > 0)
                each_fork(phase - 1, [&](std::int64_t f) { unfold(f, out.acceleration); });
            space_.descend(tree_[at(phase)], sweep);
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
        r.memory_bytes =
            Sweeps::bytes(sizes) + std::ssize(branches_.forks) *
                                       static_cast<std::int64_t>(sizeof(Sym3) + 2 * sizeof(Vec3));
        return r;
    }

  private:
    static constexpr unsigned long long none_lost = PivotFailure{}.joint;
    static std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

    /// Calls action(f) for every fork of a phase.
    template <class Action>
    void each_fork(std::int64_t phase, Action const& action) const {
        std::int64_t const first = branches_.first_fork_of_phase[at(phase)],
                           end = branches_.first_fork_of_phase[at(phase) + 1];
        space_.for_each(end - first, [&](std::int64_t i) { action(first + i); });
    }
    /// Returns the place of the first bead of a path.
    std::int64_t head(std::int64_t path) const { return branches_.first_of_path[at(path)]; }
    /// Returns the effective mass at the inboard link of a path; 0 after a pivot failure.
    double mass_of(std::int64_t path) const { return sweeps_.joints.load(head(path)).factor(0, 0); }
    /// Sets the inverse mass of a fork: E^-1 = m 1 + sum mu u u^T.
    void fold_matrices(std::int64_t f) {
        Fork const& fork = branches_.forks[at(f)];
        auto const held =
            sum_of<Vector<double, 6>>(fork.first_path, fork.end_path, [&](std::int64_t path) {
                Sym3 const m = inertia_along(mass_of(path), sweeps_.leaf.inboard(head(path)));
                return Vector<double, 6>{
                    {m.data[0], m.data[1], m.data[2], m.data[3], m.data[4], m.data[5]}};
            });
        Sym3 m = as_symmetric(held);
        for (int i = 0; i < 3; ++i) m(i, i) += mass(f);
        forks_.inverse_mass[at(f)] = inverse_of(m);
    }
    /// Sets the force that the side paths of a fork exert on its bead at rest. The bias sweep has
    /// closed each of them as a chain on the ground.
    void fold_biases(std::int64_t f) { forks_.push[at(f)] = -given(f); }
    /// Computes the acceleration of a fork's bead and the forces at the inboard links of its side
    /// paths.
    void unfold(std::int64_t f, View<3> acceleration) {
        Vec3 const a = forks_.inverse_mass[at(f)] * (forks_.force[at(f)] + forks_.push[at(f)]);
        give(f, a);
        // These forces have the rounding errors of mu a, which exceed the forces if the side paths
        // are heavy. What they leave unbalanced is found from the forces themselves.
        Vec3 const change =
            forks_.inverse_mass[at(f)] * plus_scaled(forks_.force[at(f)] - given(f), -mass(f), a);
        give(f, change);
        if (acceleration.origin)
            acceleration.store(branches_.body[at(branches_.forks[at(f)].place)], a + change);
    }
    double mass(std::int64_t f) const {
        return group_.mass[branches_.body[at(branches_.forks[at(f)].place)]][0];
    }
    /// Adds to the forces at the inboard links of a fork's side paths what an acceleration of its
    /// bead contributes.
    void give(std::int64_t f, Vec3 const& acceleration) {
        Fork const& fork = branches_.forks[at(f)];
        for (std::int64_t path = fork.first_path; path < fork.end_path; ++path) {
            double const along = dot(sweeps_.leaf.inboard(head(path)), acceleration);
            Vector<double, 1> force = sweeps_.forces.load(head(path));
            force[0] = fused(mass_of(path), along, force[0]);
            sweeps_.forces.store(head(path), force);
        }
    }
    /// Returns the sum of the forces on the side paths of a fork.
    Vec3 given(std::int64_t f) const {
        Fork const& fork = branches_.forks[at(f)];
        return sum_of<Vec3>(fork.first_path, fork.end_path, [&](std::int64_t path) {
            return sweeps_.forces.load(head(path))[0] * sweeps_.leaf.inboard(head(path));
        });
    }

    ChainGroup const& group_;
    Branches const& branches_;
    HostSpace space_;
    Communicator const& communicator_;
    // By place: fork, end of the path, restricted directions of the inboard joint.
    std::vector<std::int32_t> fork_;
    std::vector<std::uint8_t> ends_, restricted_;
    ForkBeads forks_;
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
