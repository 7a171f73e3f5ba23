// The tree's sweeps by a team of threads that takes whole chains, one thread for each part of a run
// (tree.hpp): a thread keeps what belongs to the joints of its part, and the team hands on segments
// and forces. The same operations as of tree_sweeps.hpp, in the same order wherever one needs
// another: the same bits.
#pragma once

#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// What one thread of a team takes.
struct PartPlace {
    std::int64_t body = 0;           // local index of its first body
    std::int32_t count = 0;          // bodies; 0: the thread idles
    std::int32_t parts = 0;          // of its run
    std::int32_t run = 0, runs = 1;  // of its chain: its run, and how many there are
    std::int32_t piece = 0;          // of the group

    /// Body i, or one that is there in its place.
    CATENA_HD std::int64_t body_there(int i) const {
        return body + (i < count ? i : count > 0 ? count - 1 : 0);
    }
    CATENA_HD bool starts_chain(int part) const { return count > 0 && part == 0 && run == 0; }
    /// Whether a part of the same chain follows.
    CATENA_HD bool goes_on(int part) const {
        return part + 1 < parts || (count > 0 && run + 1 < runs);
    }
};

/// Whole chains dealt out to teams: thread t of team b takes place[b * threads + t], part t mod
/// parts_of_run of a run.
struct TeamPlan {
    int threads = 0;
    std::vector<PartPlace> place;
    std::vector<std::int32_t> levels;  // of merges, of every team's tallest chain
    std::int64_t teams() const { return std::ssize(levels); }
};
/// Neighbouring chains share a team while they have at most `runs` runs together; a longer one has
/// a team alone. Precondition: whole pieces, with runs of `longest_run`.
TeamPlan plan_teams(std::vector<Piece> const& pieces, std::int64_t runs);

/// One thread's part of the tree. A `Team` has levels(), part() of a run and slot() (of its run
/// among the team's), sync() for all of its threads, from_inboard(value) and from_outboard(value),
/// what the neighbouring thread of the same run gave, put(slot, segment), get<Segment>(slot),
/// put_force(slot, force) and force<K>(slot). All of its threads must come to each call of a
/// member.
///
/// Where a part has fewer bodies than part_length, what is computed for the others is not used:
/// side by side costs less than in turn.
template <class Team, int K>
struct PartTree {
    using Matrices = SegmentMatrix<double, K>;
    using Biases = SegmentBias<double, K>;
    using Joint = JointMatrix<double, K>;
    using Directions = Vector<double, K>;
    Team const& team;
    PartPlace place;
    Joint joint[part_length];  // inboard of each body
    Directions offset[part_length];

    /// leaf(i): the matrices of the part's body i; restricted(i): directions of its inboard joint;
    /// watch(i, factor): of every joint.
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
    /// bias(i) of the part's body i; accelerate(i, inboard_force, outboard_force) once the forces at its joints are known.
    CATENA_EITHER_SIDE
    template <class Bias, class Accelerate>
    CATENA_HD_IN_PLACE void solve(Bias const& bias, Accelerate const& accelerate) {
        climb<Biases>(
            offset, bias,
            [&](Biases const& inboard, Biases const& outboard, int i, Directions& of_joint) {
                return assemble(inboard, outboard, joint[i], of_joint);
            },
            [&](Biases const& floating) {
                team.put_force(team.slot(), solve_upper(joint[0].factor, solve_lower(joint[0].factor, -floating.b1)));
            });
        descend(accelerate);
    }

  private:
    CATENA_HD_IN_PLACE bool merges(int level) const {
        return place.count > 0 && team.part() == 0 && place.run != 0 && (place.run & ((2 << level) - 1)) == 1 << level;
    }
    /// The force at the chain's joint inboard of the team's run `ahead` from this one on; none after its end.
    CATENA_HD_IN_PLACE Directions force_ahead(int ahead) const {
        return place.run + ahead < place.runs ? team.template force<K>(team.slot() + ahead) : Directions::zero();
    }
    /// `kept`: of every joint, what join(inboard, outboard, i, kept[i]) leaves there.
    CATENA_EITHER_SIDE
    template <class Segment, class Kept, class Leaf, class Join, class Close>
    CATENA_HD_IN_PLACE void climb(Kept (&kept)[part_length], Leaf const& leaf, Join const& join, Close const& close) {
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
            team.put(inboard, join(team.template get<Segment>(inboard), team.template get<Segment>(team.slot()), 0, kept[0]));
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
            team.put_force(team.slot(), disassemble(joint[0], offset[0], team.template force<K>(team.slot() - width), force_ahead(width)));
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

/// The matrices of a team's chains, by any leaf's body k.
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
