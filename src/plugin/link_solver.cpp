// LinkSolver by the sweeps that bead dynamics uses.
#include "plugin/link_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "dca/host_space.hpp"
#include "dynamics/bead_chains.hpp"
#include "dynamics/bead_store.hpp"
#include "error.hpp"
#include "mpi/communicator.hpp"

namespace catena::plugin {
namespace {

/// Relative error below which no further sweep is made.
constexpr double enough = 1e-12;
/// Relative change of the error below which further sweeps change nothing: the constraints
/// contradict each other slightly.
constexpr double unchanged = 1e-3;
/// Largest number of sweeps, as many as OpenMM's CCMA permits itself.
constexpr int most_sweeps = 150;
/// Advice for a step that fails.
constexpr char const* what_to_do =
    "call applyConstraints of the Context if its positions are new, minimise the energy, or take a "
    "smaller step";

/// Constraints of the chains of one group.
class GroupLinks {
  public:
    virtual ~GroupLinks() = default;
    virtual void close(std::span<Vec3 const> from, std::span<Vec3> to, double tolerance) = 0;
    virtual void restore(std::span<Vec3> positions, double tolerance) = 0;
    virtual void project(std::span<Vec3 const> positions, std::span<Vec3> velocities) = 0;
};

/// `Fields` is BranchedFields for trees and chains with cross-links.
template <class Fields>
class LinksOf final : public GroupLinks {
    using Chains = BeadChainsIn<Fields>;

  public:
    LinksOf(ChainGroup const& group, ConstraintChains const& chains, HostSpace const& space,
            Communicator const& communicator)
        : group_(group),
          space_(space),
          solver_(make_tree_solver(group, space.on_host(), communicator)),
          links_(links_of(group)),
          piece_(local_pieces(group, chains.scene)),
          tip_(held_tips(group, [](std::int64_t) { return Vec3::zero(); })),
          position_(group.size),
          at_(group.size),
          momentum_(group.size),
          change_(group.size),
          direction_(group.link_entries()),
          tip_direction_(group.ends.has_tips() ? group.size : 0),
          bias_(group.link_entries() + 1, group.directions),
          tip_bias_(group.ends.has_tips() ? group.size : 0, group.directions),
          ring_ends_(group, space, communicator) {
        for (std::int64_t k = 0; k < group.size; ++k)
            particle_.push_back(
                static_cast<std::size_t>(chains.particle[std::size_t(group.scene_index(k))]));
    }

    void close(std::span<Vec3 const> from, std::span<Vec3> to, double tolerance) override {
        look_at(from);
        take(to);
        repeat(tolerance, [&] { correct(); });
        give(to);
    }
    void restore(std::span<Vec3> positions, double tolerance) override {
        take(positions);
        repeat(tolerance, [&] {
            assemble_or_refuse();
            correct();
        });
        give(positions);
    }
    void project(std::span<Vec3 const> positions, std::span<Vec3> velocities) override {
        look_at(positions);
        space_.for_each(group_.size, [&](std::int64_t k) {
            momentum_.view().store(k, group_.bodies.mass.view().at(k, 0) * velocities[particle(k)]);
        });
        solver_->solve({{}, momentum_.view(), {}, {}, {}}, {{}, change_.view(), {}, {}});
        double const size = space_.largest(
            group_.size, [&](std::int64_t k) -> double { return norm(change_.view().load(k)); });
        if (!std::isfinite(size))
            throw ComputationError(
                "velocities are no longer finite: set other velocities, minimise the energy, or "
                "take a smaller step");
        space_.for_each(group_.size,
                        [&](std::int64_t k) { velocities[particle(k)] = change_.view().load(k); });
    }

  private:
    std::size_t particle(std::int64_t k) const { return particle_[std::size_t(k)]; }
    void take(std::span<Vec3 const> positions) {
        space_.for_each(group_.size, [&, to = position_.view()](std::int64_t k) {
            to.store(k, positions[particle(k)]);
        });
    }
    void give(std::span<Vec3> positions) {
        space_.for_each(group_.size, [&, from = position_.view()](std::int64_t k) {
            positions[particle(k)] = from.load(k);
        });
    }
    /// Assembles the matrices at the given positions, unless they are those of the last call.
    void look_at(std::span<Vec3 const> positions) {
        double const moved =
            space_.largest(group_.size, [&, at = at_.view()](std::int64_t k) -> double {
                Vec3 const now = positions[particle(k)];
                Vec3 const before = at.load(k);
                at.store(k, now);
                return now[0] == before[0] && now[1] == before[1] && now[2] == before[2] ? 0 : 1;
            });
        if (moved == 0 && assembled_) return;
        take(positions);
        assemble_or_refuse();
        assembled_ = true;
    }
    /// Assembles the matrices at position_.
    void assemble() {
        assembled_ = false;
        ring_ends_.take(position_.view(), position_.view());
        Chains const c = chains();
        space_.for_each(group_.size, [c](std::int64_t k) { c.set_direction(k); });
        space_.for_each(std::ssize(tip_), [c](std::int64_t i) { c.set_tip_direction(i); });
        space_.for_each(
            std::ssize(group_.branching.crosslinks),
            [c, first = group_.first_crosslink()](std::int64_t i) { c.set_direction(first + i); });
        solver_->assemble_matrices({direction_.view(),
                                    {},
                                    group_.ends.has_tips() ? tip_direction_.view() : View<3>{},
                                    {},
                                    {}});
    }
    /// Sets the biases to the length errors at position_. Returns the largest relative one, NaN if
    /// a position is.
    double measure() {
        Chains const c = chains();
        auto const at_link = [c](std::int64_t k) -> double {
            double const off = c.linked(k) ? norm(c.link(k)) - c.length.at(k, 0) : 0.0;
            c.bias.at(k, 0) = off;
            return off == 0 ? 0 : std::fabs(off) / c.length.at(k, 0);
        };
        double const along = space_.largest(group_.size, at_link);
        double const across = space_.largest(std::ssize(group_.branching.crosslinks),
                                             [at_link, first = group_.first_crosslink()](
                                                 std::int64_t i) { return at_link(first + i); });
        double const at_tips = space_.largest(std::ssize(tip_), [c](std::int64_t i) -> double {
            double const off = norm(c.tip_link(i)) - c.tip[i].length;
            c.tip_bias.at(c.tip[i].body, 0) = off;
            return std::fabs(off) / c.tip[i].length;
        });
        return larger(larger(along, across), at_tips);
    }
    /// Moves position_ by one sweep, from the biases of measure().
    void correct() {
        solver_->solve({{}, {}, {}, bias_.view(), of_tips(group_, tip_bias_)},
                       {{}, change_.view(), {}, {}});
        space_.for_each(group_.size, [x = position_.view(), d = change_.view()](std::int64_t k) {
            x.store(k, x.load(k) + d.load(k));
        });
    }
    /// Repeats sweep() until the links are closed to `enough` or to rounding, also if `tolerance`
    /// asks for less. What stays open nevertheless is within `tolerance`.
    template <class Sweep>
    void repeat(double tolerance, Sweep const& sweep) {
        double before = std::numeric_limits<double>::infinity();
        for (int sweeps = 0;; ++sweeps) {
            ring_ends_.take(position_.view(), position_.view());
            double const error = measure();
            if (error <= std::min(enough, tolerance)) return;
            if (!std::isfinite(error)) refuse_positions();
            if (error > before / 2 && error <= rounding()) return;
            bool const same = sweeps > 0 && std::fabs(error - before) <= unchanged * before;
            if ((same || sweeps == most_sweeps) && error <= tolerance) return;
            if (sweeps == most_sweeps) refuse(error);
            before = error;
            sweep();
        }
    }
    /// Relative error that rounding of positions explains.
    double rounding() {
        Chains const c = chains();
        return space_.largest(group_.size, [c](std::int64_t k) -> double {
            double const shortest = c.linked(k) ? c.length.at(k, 0) : 1.0;
            return 8 * std::numeric_limits<double>::epsilon() * norm(c.position.load(k)) / shortest;
        });
    }
    [[noreturn]] void refuse(double error) {
        std::int64_t worst = 0;
        Chains const c = chains();
        for (std::int64_t k = 0; k < group_.size; ++k)
            if (c.error(k) > c.error(worst)) worst = k;
        throw ComputationError(
            fmt::format("constraints stay open by {:.1e} of their length after {} sweeps (near "
                        "particle {}): {}",
                        error, most_sweeps, particle(worst), what_to_do));
    }
    void assemble_or_refuse() {
        try {
            assemble();
        } catch (ComputationError const&) {
            refuse_positions();
        }
    }
    /// Throws ComputationError for positions at which the matrices do not exist.
    [[noreturn]] void refuse_positions() {
        Chains const c = chains();
        for (std::int64_t k = 0; k < group_.size; ++k) {
            double const size = norm(position_.view().load(k));
            if (!std::isfinite(size))
                throw ComputationError(fmt::format(
                    "positions are no longer finite (particle {}): {}", particle(k), what_to_do));
            if (c.linked(k) && !(norm(c.link(k)) > 0))
                throw ComputationError(
                    fmt::format("particles {} and {}, which a constraint joins, coincide: set "
                                "other positions",
                                particle(c.places.inboard(k)), particle(k)));
        }
        throw ComputationError(
            "constraints depend on each other at these positions, as where particles coincide or a "
            "ring is stretched straight: set other positions");
    }
    Chains chains() {
        Chains c;
        if constexpr (std::is_same_v<Fields, BranchedFields>) {
            c.places.inboard_bead = group_.branching.inboard.data();
            c.places.crosslink = group_.branching.crosslinks.data();
        }
        c.places.size = group_.size;
        c.places.is_first = group_.ends.is_first.data();
        c.places.has_link = links_.data();
        c.places.piece = piece_.data();
        c.places.pieces = std::ssize(piece_);
        c.length = group_.joints.length.view();
        c.tip = tip_.data();
        c.position = position_.view();
        c.direction = direction_.view();
        c.tip_direction = tip_direction_.view();
        c.ring_ends = ring_ends_.view();
        c.bias = bias_.view();
        c.tip_bias = of_tips(group_, tip_bias_);
        return c;
    }

    ChainGroup const& group_;
    HostSpace space_;
    std::unique_ptr<ChainSolver> solver_;
    std::vector<std::uint8_t> links_;
    std::vector<LocalPiece> piece_;
    std::vector<HeldTip> tip_;
    std::vector<std::size_t> particle_;
    /// at_: positions at which the matrices were assembled, if assembled_.
    Field<3> position_, at_, momentum_, change_, direction_, tip_direction_;
    DirectionsField bias_, tip_bias_;
    RingEnds<HostSpace> ring_ends_;
    bool assembled_ = false;
};

/// Number of threads that pay for so many constraints: loops over fewer are as fast on one.
int worthwhile(int threads, std::size_t constraints) {
    std::size_t constexpr worth_a_thread = 8192;
    if (!openmp_is_built()) return 1;
    return std::min(threads,
                    static_cast<int>(std::max<std::size_t>(constraints / worth_a_thread, 1)));
}

std::unique_ptr<Executor> make_executor(int threads) {
    return threads > 1 ? openmp_executor(threads) : serial_executor();
}

class Solver final : public LinkSolver {
  public:
    Solver(std::vector<double> const& mass, std::vector<Constraint> const& constraints, int threads)
        : chains_(constraint_chains(mass, constraints)),
          communicator_(serial_communicator()),
          executor_(make_executor(worthwhile(threads, constraints.size()))),
          groups_(make_groups(chains_.scene, Axes::world, Handles::projected, false, *communicator_,
                              {.implicit = false, .shares = {}, .executor = *executor_})) {
        HostSpace const space(*executor_);
        for (auto const& group : groups_) {
            if (group->is_branched())
                links_.push_back(std::make_unique<LinksOf<BranchedFields>>(*group, chains_, space,
                                                                           *communicator_));
            else
                links_.push_back(
                    std::make_unique<LinksOf<BeadFields>>(*group, chains_, space, *communicator_));
        }
    }
    void close(std::span<Vec3 const> from, std::span<Vec3> to, double tolerance) override {
        for (auto const& links : links_) links->close(from, to, tolerance);
    }
    void restore(std::span<Vec3> positions, double tolerance) override {
        for (auto const& links : links_) links->restore(positions, tolerance);
    }
    void project(std::span<Vec3 const> positions, std::span<Vec3> velocities) override {
        for (auto const& links : links_) links->project(positions, velocities);
    }

  private:
    ConstraintChains chains_;
    std::unique_ptr<Communicator> communicator_;
    std::unique_ptr<Executor> executor_;
    std::vector<std::unique_ptr<ChainGroup>> groups_;
    std::vector<std::unique_ptr<GroupLinks>> links_;
};

}  // namespace

std::unique_ptr<LinkSolver> make_link_solver(std::vector<double> const& mass,
                                             std::vector<Constraint> const& constraints,
                                             int threads) {
    return std::make_unique<Solver>(mass, constraints, threads);
}

}  // namespace catena::plugin
