// Chains of point beads of a group in any Space, and the loops over them.
#pragma once

#include <memory>
#include <utility>

#include "dca/solver.hpp"
#include "dynamics/bead_step.hpp"
#include "dynamics/bead_store.hpp"
#include "dynamics/closing.hpp"

namespace catena {

/// Fills the starting positions and velocities of the scene.
void place_beads(ChainGroup const&, Scene const&, View<3> position, View<3> velocity,
                 Executor const&);

/// Beads of a group in a Space, with their solver. It is an execution policy of a step
/// (bead_step.hpp): one loop over all chains after the other. All members are public because nvcc
/// accepts kernels in public members only.
template <class Space, class Fields>
struct BeadsIn {
    using Chains = BeadChainsIn<Fields>;

    ChainGroup const& group;
    Space space;
    Communicator const& communicator;
    std::unique_ptr<ChainSolver> solver;
    BeadConstants<Space> constants;
    BeadStore<Space> store;
    RingEnds<Space> ring_ends;
    DeferredError trouble;

    /// Places the beads as the scene says. Group and communicator must outlive this object; the
    /// solver must read and write views of the same Space.
    BeadsIn(ChainGroup const& of, Scene const& scene, Space const& in, Communicator const& ranks,
            std::unique_ptr<ChainSolver> solver_in)
        : group(of),
          space(in),
          communicator(ranks),
          solver(std::move(solver_in)),
          constants(of, scene, in.on_host()),
          store(of),
          ring_ends(of, in, ranks) {
        space.set(store.position, [&](View<3> position) {
            space.set(store.velocity, [&](View<3> velocity) {
                place_beads(group, scene, position, velocity, space.on_host());
            });
        });
    }

    /// Views of all arrays for loops over beads.
    Chains chains() {
        Chains c;
        constants.show(c);
        store.show(c);
        c.ring_ends = ring_ends.view();
        return c;
    }
    std::int64_t tips() const { return std::ssize(constants.tips()); }
    std::int64_t crosslinks() const { return std::ssize(group.branching.crosslinks); }

    // Execution policy of a step.

    template <class Action>
    void each_bead(Action const& action) const {
        space.for_each(group.size, action);
    }
    template <class Make, class Take>
    void each_bead(Make const& make, Take const& take) const {
        space.for_each(group.size,
                       [make, take] CATENA_LAMBDA(std::int64_t k) { take(k, make(k)); });
    }
    template <class Action>
    void each_link(Action const& action) const {
        space.for_each(group.size + (group.neighbours.outboard >= 0 ? 1 : 0), action);
    }
    template <class Action>
    void each_tip(Action const& action) const {
        space.for_each(tips(), action);
    }
    template <class Action>
    void each_crosslink(Action const& action) const {
        if constexpr (Fields::has_crosslinks) over_crosslinks(action);
    }
    template <class Action>
    void over_crosslinks(Action const& action) const {
        space.for_each(crosslinks(), [action, first = group.first_crosslink()] CATENA_LAMBDA(
                                         std::int64_t i) { action(first + i); });
    }
    /// Brings the vectors of the inboard neighbour's last bead and of the other ends of rings.
    void from_inboard(View<3> field) {
        exchange_from_inboard(communicator, group, field, space);
        ring_ends.take(field, field);
    }
    void from_inboard() { from_inboard(store.position.view()); }
    void from_outboard() {
        exchange_from_outboard(communicator, group, store.position.view(), space);
    }
    void assemble() {
        held([&] { solver->assemble_matrices(store.directions()); });
    }
    void project(View<3> momentum, View<3> out) const {
        solver->solve({{}, momentum, {}, {}, {}}, {{}, out, {}, {}});
    }
    void close(DirectionsView bias, DirectionsView tip_bias, View<3> out) const {
        solver->solve({{}, {}, {}, bias, tip_bias}, {{}, out, {}, {}});
    }

    // Pivot failures and errors of links.

    /// Runs `action`. On the host it keeps a pivot failure until the next check(); on a GPU the
    /// solver keeps it.
    template <class Action>
    void held(Action const& action) {
        if constexpr (Space::answers_at_once)
            trouble.hold(action);
        else
            action();
    }
    /// Throws ComputationError if a pivot failure is pending on this rank.
    void check() const {
        solver->check();
        trouble.check();
    }
    /// Largest relative error of the length of a link on this rank. Precondition: the neighbours'
    /// positions are up to date.
    double largest_error() {
        Chains const c = chains();
        double const along = space.largest(
            group.size, [c] CATENA_LAMBDA(std::int64_t k) -> double { return c.error(k); });
        double const at_tips = space.largest(
            tips(), [c] CATENA_LAMBDA(std::int64_t i) -> double { return c.tip_error(i); });
        double worst = larger(along, at_tips);
        for (std::int64_t i = 0; i < crosslinks(); ++i)
            worst = larger(worst, c.error(group.first_crosslink() + i));
        return worst;
    }
    /// True if largest_error() is known to be at most `tolerance`. Host only.
    bool closed_within(double tolerance) {
        Chains const c = chains();
        for (dca::Piece const& p : group.pieces)
            if (!(c.error(p.local) <= tolerance) ||
                !c.closed_along(p.local + 1, p.local + p.count, tolerance))
                return false;
        for (std::int64_t i = 0; i < tips(); ++i)
            if (!(c.tip_error(i) <= tolerance)) return false;
        for (std::int64_t i = 0; i < crosslinks(); ++i)
            if (!(c.error(group.first_crosslink() + i) <= tolerance)) return false;
        return true;
    }

    /// Draws thermal velocities of temperature kt (kJ/mol) for the chosen chains, before
    /// projection.
    void draw_velocities(double kt, std::uint64_t seed, std::vector<bool> const& of_chain) {
        auto const drawn = [&](std::size_t i) {
            return of_chain[static_cast<std::size_t>(group.pieces[i].chain)];
        };
        for (std::size_t i = 0, end = 0; i < group.pieces.size();
             i = end) {  // One loop over neighbouring pieces.
            std::int64_t count = 0;
            for (end = i; end < group.pieces.size() && drawn(end) == drawn(i); ++end)
                count += group.pieces[end].count;
            if (drawn(i))
                space.for_each(
                    count, [c = chains(), kt, seed, first = group.pieces[i].local] CATENA_LAMBDA(
                               std::int64_t k) { c.draw_velocity(first + k, kt, seed); });
        }
    }
};

}  // namespace catena
