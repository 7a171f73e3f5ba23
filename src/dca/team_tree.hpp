// The tree's sweeps by a team of threads for whole chains, one thread per part of a run (tree.hpp).
// A thread stores the data of its part's joints, and the team exchanges segments and forces. The
// operations are those of tree_sweeps.hpp. Dependent ones have the same order, so that the results
// are bitwise identical.
#pragma once

#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// The part of a run that one thread of a team computes.
struct PartPlace {
    std::int64_t body = 0;           // Local index of its first body.
    std::int32_t count = 0;          // Number of bodies; 0: the thread is idle.
    std::int32_t parts = 0;          // Number of parts of its run.
    std::int32_t run = 0, runs = 1;  // Index of its run in the chain, and number of runs.
    std::int32_t piece = 0;          // Index of its piece in the group.

    /// Returns the index of body i, or of a valid body if the part has no body i.
    CATENA_HD std::int64_t body_there(int i) const {
        return body + (i < count ? i : count > 0 ? count - 1 : 0);
    }
    CATENA_HD bool starts_chain(int part) const { return count > 0 && part == 0 && run == 0; }
    /// True if the next part belongs to the same chain.
    CATENA_HD bool goes_on(int part) const {
        return part + 1 < parts || (count > 0 && run + 1 < runs);
    }
};

/// Distribution of whole chains to teams: thread t of team b computes place[b * threads + t], which
/// is part t mod parts_of_run of a run.
struct TeamPlan {
    int threads = 0;
    std::vector<PartPlace> place;
    std::vector<std::int32_t> levels;  // Number of merge levels of every team's tallest chain.
    std::int64_t teams() const { return std::ssize(levels); }
};
/// Returns the distribution of chains to teams. Neighbouring chains share a team while they have at
/// most `runs` runs together; a longer chain has its own team. Precondition: whole pieces, with
/// runs of `longest_run`.
TeamPlan plan_teams(std::vector<Piece> const& pieces, std::int64_t runs);

/// One thread's part of the tree. All threads of a team must reach each call of a member of `Team`,
/// which has:
/// - levels(), part() of a run, and slot(), the index of the run among the team's runs;
/// - sync() for all of its threads;
/// - from_inboard(value) and from_outboard(value), the neighbouring thread's value in the same run;
/// - put(slot, segment), get<Segment>(slot), put_force(slot, force) and force<K>(slot).
///
/// If a part has fewer bodies than part_length, values computed for missing bodies are discarded.
/// Computing them takes less time than branching.
template <class Team, int K>
struct PartTree {
    using Matrices = SegmentMatrix<double, K>;
    using Biases = SegmentBias<double, K>;
    using Joint = JointMatrix<double, K>;
    using Directions = Vector<double, K>;
    Team const& team;
    PartPlace place;
    Joint joint[part_length];  // Joints inboard of each body.
    Directions offset[part_length];

    /// Inward pass of the matrices. leaf(i) returns the matrices of the part's body i,
    /// restricted(i) the number of restricted directions of its inboard joint. watch(i, factor) is
    /// called for every joint.
    CATENA_EITHER_SIDE
    template <class Leaf, class Restricted, class Watch>
    CATENA_HD_IN_PLACE void assemble_matrices(Leaf const& leaf, Restricted const& restricted,
                                              Watch const& watch) {
        climb<Matrices>(
            joint, leaf,
            [&](Matrices const& inboard, Matrices const& outboard, int i, Joint& of_joint) {
                return assemble(inboard, outboard, restricted(i), of_joint);
            },
            [&](Matrices const& floating) {
                joint[0].factor = factorize(floating.z11, restricted(0));
            });
        CATENA_UNROLL
        for (int i = 0; i < part_length; ++i)
            if (i < place.count) watch(i, joint[i].factor);
    }
    /// Bias sweep. bias(i) returns the bias of the part's body i. accelerate(i, inboard_force,
    /// outboard_force) is called when the forces at its joints are known.
    CATENA_EITHER_SIDE
    template <class Bias, class Accelerate>
    CATENA_HD_IN_PLACE void solve(Bias const& bias, Accelerate const& accelerate) {
        climb<Biases>(
            offset, bias,
            [&](Biases const& inboard, Biases const& outboard, int i, Directions& of_joint) {
                return assemble(inboard, outboard, joint[i], of_joint);
            },
            [&](Biases const& floating) {
                team.put_force(
                    team.slot(),
                    solve_upper(joint[0].factor, solve_lower(joint[0].factor, -floating.b1)));
            });
        descend(accelerate);
    }

  private:
    // True if this thread's first joint is eliminated by a merge of this level.
    CATENA_HD_IN_PLACE bool merges(int level) const {
        return place.count > 0 && team.part() == 0 && place.run != 0 &&
               (place.run & ((2 << level) - 1)) == 1 << level;
    }
    /// Returns the force at the inboard joint of the run that is `ahead` runs further in the chain;
    /// zero beyond the chain's end.
    CATENA_HD_IN_PLACE Directions force_ahead(int ahead) const {
        return place.run + ahead < place.runs ? team.template force<K>(team.slot() + ahead)
                                              : Directions::zero();
    }
    /// Inward pass. join(inboard, outboard, i, kept[i]) stores the data of joint i in `kept`.
    CATENA_EITHER_SIDE
    template <class Segment, class Kept, class Leaf, class Join, class Close>
    CATENA_HD_IN_PLACE void climb(Kept (&kept)[part_length], Leaf const& leaf, Join const& join,
                                  Close const& close) {
        Segment own = leaf(0);
        CATENA_UNROLL
        for (int i = 1; i < part_length; ++i) {
            Segment const both = join(own, leaf(i), i, kept[i]);
            own = i < place.count ? both : own;
        }
        CATENA_UNROLL
        for (int p = 1; p < parts_of_run; ++p) {
            bool const mine = team.part() == p && place.count > 0;
            Kept here;
            Segment const both = join(team.from_inboard(own), own, 0, here);
            own = mine ? both : own;
            kept[0] = mine ? here : kept[0];
        }
        team.sync();
        if (place.count > 0 && team.part() + 1 == place.parts) team.put(team.slot(), own);
        CATENA_NO_UNROLL
        for (int level = 0; level < team.levels(); ++level) {
            team.sync();
            if (!merges(level)) continue;
            int const inboard = team.slot() - (1 << level);
            team.put(inboard, join(team.template get<Segment>(inboard),
                                   team.template get<Segment>(team.slot()), 0, kept[0]));
        }
        team.sync();
        if (place.starts_chain(team.part())) close(team.template get<Segment>(team.slot()));
    }
    CATENA_EITHER_SIDE
    template <class Accelerate>
    CATENA_HD_IN_PLACE void descend(Accelerate const& accelerate) {
        CATENA_NO_UNROLL
        for (int level = team.levels() - 1; level >= 0; --level) {
            team.sync();
            if (!merges(level)) continue;
            int const width = 1 << level;
            team.put_force(team.slot(), disassemble(joint[0], offset[0],
                                                    team.template force<K>(team.slot() - width),
                                                    force_ahead(width)));
        }
        team.sync();
        Directions const first = team.template force<K>(team.slot());
        Directions begin = first, next = force_ahead(1);
        CATENA_UNROLL
        for (int p = parts_of_run - 1; p > 0; --p) {
            Directions const here = disassemble(joint[0], offset[0], first, next);
            begin = team.part() == p && p < place.parts ? here : begin;
            Directions const after = team.from_outboard(begin);
            next = team.part() + 1 == p && p < place.parts ? after : next;
        }
        CATENA_UNROLL
        for (int i = part_length - 1; i >= 0; --i) {
            Directions const here = i == 0 ? begin : disassemble(joint[i], offset[i], begin, next);
            accelerate(i, here, next);
            next = i < place.count ? here : next;
        }
    }
};

/// Assembles the matrices of a team's chains and stores their joints, for any leaf with matrix(k).
template <class Leaf>
struct MatricesOfChains {
    static constexpr int K = Leaf::K;
    TreeSweeps<Leaf> sweeps;

    CATENA_EITHER_SIDE
    template <class Team>
    CATENA_HD_IN_PLACE void operator()(Team const& team) const {
        PartTree<Team, K> tree{team, team.place(), {}, {}};
        PartPlace const& place = tree.place;
        PivotFailure lost;
        tree.assemble_matrices([&](int i) { return sweeps.leaf.matrix(place.body_there(i)); },
                               [&](int i) { return sweeps.restricted[place.body_there(i)]; },
                               [&](int i, Symmetric<double, K> const& factor) {
                                   sweeps.watch(sweeps.at(place.body + i), factor, lost);
                                   sweeps.joints.store(place.body + i, tree.joint[i]);
                               });
        sweeps.note(lost);
    }
};

}  // namespace catena::dca
