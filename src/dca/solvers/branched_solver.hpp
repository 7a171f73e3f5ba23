// Solver of branched chains of point beads in any Space: the sweeps of tree_sweeps.hpp over the
// paths phase by phase, and the folds of side paths into the beads on which they hang.
#pragma once

#include <utility>
#include <vector>

#include "dca/branched_leaf.hpp"
#include "dca/contracts.hpp"
#include "dca/host_space.hpp"
#include "dca/solvers/sweep_timer.hpp"
#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// Returns the sum of term(i), i < terms, which must be positive. Partial sums of four terms, of
/// four such sums and so on are added, so that the order depends on the number of terms alone.
template <class T, class Term>
CATENA_HD T sum_of(std::int64_t terms, Term const& term) {
    constexpr int radix = 4, levels = 12;
    T part[levels];
    int count[levels] = {};
    for (std::int64_t i = 0; i < terms; ++i) {
        T next = term(i);
        for (int l = 0; l < levels; ++l) {
            part[l] = count[l] == 0 ? next : part[l] + next;
            if (++count[l] < radix || l + 1 == levels) break;
            next = part[l];
            count[l] = 0;
        }
    }
    T sum = T::zero();
    bool any = false;
    for (int l = 0; l < levels; ++l) {
        if (count[l] == 0) continue;
        sum = any ? part[l] + sum : part[l];
        any = true;
    }
    return sum;
}

/// Returns the inverse of a symmetric positive definite matrix.
CATENA_HD Sym3 inverse_of(Sym3 const& m) {
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
CATENA_HD Vector<double, 6> inertia_along(double mu, Vec3 const& u) {
    Vector<double, 6> m;
    for (int i = 0, at = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) m[at++] = mu * u[i] * u[j];
    return m;
}

/// The inboard link of a side path.
struct SideLink {
    Vec3 direction;
    double mass = 0;   // effective mass of the path at this link, mu; 0 after a pivot failure
    double force = 0;  // on the path
};

/// The folds of side paths into the beads on which they hang, as views of arrays of a Space.
struct Folds {
    TreeSweeps<BranchedLeaf> sweeps;
    Fork const* forks = nullptr;
    ForkBeads beads;
    /// Inboard links of side paths, in the order of the paths, of which `first_side` is the first.
    SideLink* side = nullptr;
    std::int64_t first_side = 0;
    // Body at each place, and the first place of each path.
    std::int64_t const *body = nullptr, *first_of_path = nullptr;
    ConstView<1> mass;

    /// Sets the inverse mass of a fork: E^-1 = m 1 + sum mu u u^T.
    CATENA_HD void fold_matrices(std::int64_t f) const {
        Fork const fork = forks[f];
        SideLink* const links = links_of(fork);
        for (std::int64_t i = 0; i < fork.paths(); ++i) {
            std::int64_t const place = head(fork, i);
            links[i].direction = sweeps.leaf.inboard(place);
            links[i].mass = sweeps.joints.load(place).factor(0, 0);
        }
        Sym3 m = as_symmetric(sum_of<Vector<double, 6>>(fork.paths(), [links](std::int64_t i) {
            return inertia_along(links[i].mass, links[i].direction);
        }));
        for (int i = 0; i < 3; ++i) m(i, i) += mass_of(fork);
        beads.inverse_mass[f] = inverse_of(m);
    }
    /// Sets the force that the side paths of a fork exert on its bead at rest. The bias sweep has
    /// closed each of them as a chain on the ground.
    CATENA_HD void fold_biases(std::int64_t f) const {
        Fork const fork = forks[f];
        SideLink* const links = links_of(fork);
        for (std::int64_t i = 0; i < fork.paths(); ++i)
            links[i].force = sweeps.forces.load(head(fork, i))[0];
        beads.push[f] = -given(fork);
    }
    /// Computes the acceleration of a fork's bead and the forces at the inboard links of its side
    /// paths.
    CATENA_HD void unfold(std::int64_t f, View<3> const& acceleration) const {
        Fork const fork = forks[f];
        Sym3 const& e = beads.inverse_mass[f];
        Vec3 const force = beads.force[f], a = e * (force + beads.push[f]);
        give(fork, a);
        // These forces have the rounding errors of mu a, which exceed the forces if the side paths
        // are heavy. What they leave unbalanced is found from the forces themselves.
        Vec3 const change = e * plus_scaled(force - given(fork), -mass_of(fork), a);
        give(fork, change);
        if (acceleration.origin) acceleration.store(body[fork.place], a + change);
        SideLink const* const links = links_of(fork);
        for (std::int64_t i = 0; i < fork.paths(); ++i)
            sweeps.forces.store(head(fork, i), {{links[i].force}});
    }

  private:
    CATENA_HD SideLink* links_of(Fork const& fork) const {
        return side + (fork.first_path - first_side);
    }
    /// Place of the first bead of a fork's side path i.
    CATENA_HD std::int64_t head(Fork const& fork, std::int64_t i) const {
        return first_of_path[fork.first_path + i];
    }
    CATENA_HD double mass_of(Fork const& fork) const { return mass.load(body[fork.place])[0]; }
    /// Returns the sum of the forces on side paths.
    CATENA_HD Vec3 given(Fork const& fork) const {
        SideLink const* const links = links_of(fork);
        return sum_of<Vec3>(
            fork.paths(), [links](std::int64_t i) { return links[i].force * links[i].direction; });
    }
    /// Adds to the forces on side paths what an acceleration of the fork's bead contributes.
    CATENA_HD void give(Fork const& fork, Vec3 const& acceleration) const {
        SideLink* const links = links_of(fork);
        for (std::int64_t i = 0; i < fork.paths(); ++i) {
            SideLink& l = links[i];
            l.force = fused(l.mass, dot(l.direction, acceleration), l.force);
        }
    }
};

// Loops over the forks of a phase, of which `first` is the first.
struct FoldMatrices {
    Folds folds;
    std::int64_t first = 0;
    CATENA_HD void operator()(std::int64_t i) const { folds.fold_matrices(first + i); }
};
struct FoldBiases {
    Folds folds;
    std::int64_t first = 0;
    CATENA_HD void operator()(std::int64_t i) const { folds.fold_biases(first + i); }
};
struct Unfold {
    Folds folds;
    View<3> acceleration;
    std::int64_t first = 0;
    CATENA_HD void operator()(std::int64_t i) const { folds.unfold(first + i, acceleration); }
};

/// Solver of one group of branched chains.
template <SolverSpace Space>
class BranchedSolver final : public ChainSolver {
    using Sweeps = TreeSweeps<BranchedLeaf>;
    template <class T>
    using Array = typename Space::template Array<T>;
    template <class T>
    using List = typename Space::template List<T>;
    template <class T, Order order>
    using Records = typename Space::template Records<T, order>;

  public:
    /// Allocates all arrays. The group, the executor of the space and the communicator must outlive
    /// the solver.
    BranchedSolver(ChainGroup const& group, Space const& space, Communicator const& communicator)
        : group_(group),
          branches_(group.branching.paths),
          space_(space),
          alone_(alone(space)),
          communicator_(communicator),
          model_(group),
          mass_(group.bodies.mass),
          places_(group),
          lists_(branches_, places_),
          forks_(branches_.forks.size(), static_cast<std::size_t>(side_paths())),
          records_(branches_.slots, branches_.joints),
          sweeps_{BranchedLeaf(model_.view(), lists_.body.data(), lists_.fork.data(),
                               lists_.ends.data(), forks_.beads()),
                  lists_.restricted.data(),
                  records_.matrices.view(),
                  records_.biases.view(),
                  records_.joints.view(),
                  records_.offsets.view(),
                  records_.forces.view(),
                  records_.lost.data()} {
        space_.put(records_.lost.data(), none_lost);
        for (PhaseLists const& lists : branches_.lists) {
            tree_.emplace_back(lists.runs, lists.levels, lists.roots, branches_.slots,
                               places_.restricted, Sweeps::in_stage);
            items_.push_back(0);
            for (Run const& run : lists.runs) items_.back() += run.count;
            for (std::vector<Merge> const& level : lists.levels) items_.back() += std::ssize(level);
        }
    }

    void assemble_matrices(ConfigurationView const& configuration) override {
        SweepTimer const timer(space_, measured_, report_.matrix_seconds);
        sweeps_.leaf.set(configuration);
        for (std::int64_t phase = 0; phase < branches_.phases(); ++phase) {
            if (phase > 0) each_fork(phase, FoldMatrices{folds()});
            space_of(phase).climb(tree_[at(phase)], MatrixSweep<BranchedLeaf>{sweeps_});
        }
        ++report_.matrix_sweeps;
        if (Space::answers_at_once) check();
    }

    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        SweepTimer const timer(space_, measured_, report_.bias_seconds);
        sweeps_.leaf.set(out.joint_force);
        BiasSweep<BranchedLeaf> const sweep{sweeps_, loads, {{}, out.acceleration, {}, {}}};
        for (std::int64_t phase = 0; phase < branches_.phases(); ++phase) {
            if (phase > 0) each_fork(phase, FoldBiases{folds()});
            space_of(phase).climb(tree_[at(phase)], sweep);
        }
        for (std::int64_t phase = branches_.phases(); phase-- > 0;) {
            space_of(phase).descend(tree_[at(phase)], sweep);
            if (phase > 0) each_fork(phase, Unfold{folds(), out.acceleration});
        }
        ++report_.bias_sweeps;
    }

    std::vector<double> time_evaluations(ConfigurationView const& configuration,
                                         LoadsView const& loads, AccelerationsView const& out,
                                         int chained, int repeat) override {
        return space_.time_chained(chained, repeat, false,
                                   [&] { assemble_and_solve(configuration, loads, out); });
    }

    void check() override {
        unsigned long long const bad = space_.get(records_.lost.data());
        if (bad == none_lost) return;
        space_.put(records_.lost.data(), none_lost);
        refuse_indefinite(group_, communicator_.rank(), branches_.body[at(bad)]);
    }
    void wait() override { space_.wait(); }
    void measure(bool on) override { measured_ = on; }

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
                         side_paths() * static_cast<std::int64_t>(sizeof(SideLink));
        return r;
    }

  private:
    static constexpr unsigned long long none_lost = PivotFailure{}.joint;
    static std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }
    static std::size_t at(unsigned long long i) { return i; }
    /// Items of a phase whose loops threads share.
    static constexpr std::int64_t worth_threads = 4096;

    /// Properties of each place that the leaf reads: the fork (-1: none), whether a path ends
    /// there, and the restricted directions of the inboard joint.
    struct Places {
        explicit Places(ChainGroup const& group)
            : fork(at(group.size), -1),
              ends(at(group.size), 0),
              restricted(at(group.branching.paths.joints), 0) {
            Branches const& b = group.branching.paths;
            for (std::size_t f = 0; f < b.forks.size(); ++f)
                fork[at(b.forks[f].place)] = static_cast<std::int32_t>(f);
            for (std::int64_t path = 1; path <= b.paths(); ++path)
                ends[at(b.first_of_path[at(path)] - 1)] = 1;
            for (std::int64_t place = 0; place < group.size; ++place)
                restricted[at(place)] = group.joints.restricted[at(b.body[at(place)])];
        }
        std::vector<std::int32_t> fork;
        std::vector<std::uint8_t> ends, restricted;
    };

    /// Constant lists in the memory of the space.
    struct Lists {
        Lists(Branches const& b, Places const& places)
            : body(b.body),
              first_of_path(b.first_of_path),
              forks(b.forks),
              fork(places.fork),
              ends(places.ends),
              restricted(places.restricted) {}
        List<std::int64_t> body, first_of_path;
        List<Fork> forks;
        List<std::int32_t> fork;
        List<std::uint8_t> ends, restricted;
    };
    /// Arrays of ForkBeads, and the inboard links of side paths.
    struct Forks {
        Forks(std::size_t forks, std::size_t side_paths)
            : inverse_mass(forks), push(forks), force(forks), side(side_paths) {}
        ForkBeads beads() { return {inverse_mass.data(), push.data(), force.data()}; }
        Array<Sym3> inverse_mass;
        Array<Vec3> push, force;
        Array<SideLink> side;
    };
    /// Arrays of TreeSweeps; joints have the numbers of places.
    struct Arrays {
        Arrays(std::int64_t slots, std::int64_t of_joints)
            : matrices(slots),
              biases(slots),
              joints(of_joints),
              offsets(of_joints),
              forces(of_joints),
              lost(1) {}
        Records<Sweeps::Matrices, Order::plain> matrices;
        Records<Sweeps::Biases, Order::plain> biases;
        Records<Sweeps::Joint, Order::by_body> joints;
        Records<Sweeps::Offset, Order::by_body> offsets;
        Records<Sweeps::State, Order::by_body> forces;
        Array<unsigned long long> lost;
    };

    /// Returns a space without threads, where that is another one.
    static Space alone(Space const& space) {
        if constexpr (std::is_same_v<Space, HostSpace>)
            return HostSpace(this_thread());
        else
            return space;
    }
    /// Returns the space of a phase's loops. Few items are not worth the barriers of threads.
    Space const& space_of(std::int64_t phase) const {
        return items_[at(phase)] < worth_threads ? alone_ : space_;
    }
    /// Runs a loop over the forks of a phase.
    template <class Loop>
    void each_fork(std::int64_t phase, Loop loop) const {
        loop.first = branches_.first_fork_of_phase[at(phase)];
        space_of(phase).for_each(branches_.first_fork_of_phase[at(phase) + 1] - loop.first, loop);
    }
    std::int64_t side_paths() const { return branches_.paths() - branches_.first_side(); }
    Folds folds() {
        return {sweeps_,
                lists_.forks.data(),
                forks_.beads(),
                forks_.side.data(),
                branches_.first_side(),
                lists_.body.data(),
                lists_.first_of_path.data(),
                mass_.view()};
    }

    ChainGroup const& group_;
    Branches const& branches_;
    Space space_, alone_;
    Communicator const& communicator_;
    typename Space::Model model_;
    typename Space::template Fixed<1> mass_;
    Places const places_;
    Lists lists_;
    Forks forks_;
    // Trees of the phases, and their numbers of bodies in runs and of merges.
    std::vector<typename Space::Tree> tree_;
    std::vector<std::int64_t> items_;
    Arrays records_;
    Sweeps sweeps_;
    bool measured_ = false;
    SolverReport report_;
};

}  // namespace catena::dca
