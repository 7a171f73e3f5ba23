// A step of chains of point beads by a team of threads. The team keeps the chains in registers for
// the whole step, up to four consecutive beads per thread (dca/team_tree.hpp). The arithmetic per
// bead is that of bead_step.hpp and bead_chains.hpp, as in all other ways to execute a step.
#pragma once

#include "dca/body_leaf.hpp"
#include "dca/team_tree.hpp"
#include "dca/tree_sweeps.hpp"
#include "dynamics/bead_chains.hpp"
#include "dynamics/constrained_step.hpp"

namespace catena {

template <class Way, class Fields>
struct BeadStep;

/// D numbers per bead of a thread's part, indexed from 0, and for one neighbour on either side.
template <int D>
struct PartField {
    Vector<double, D>* bead = nullptr;  // Entry 0 is the inboard neighbour.
    CATENA_HD_IN_PLACE double& at(std::int64_t i, int component) const {
        return bead[i + 1][component];
    }
    CATENA_HD_IN_PLACE Vector<double, D> load(std::int64_t i) const { return bead[i + 1]; }
    CATENA_HD_IN_PLACE void store(std::int64_t i, Vector<double, D> const& v) const {
        bead[i + 1] = v;
    }
};
/// Counterpart of BeadPlaces for a part; index part_length is the outboard neighbour.
struct PartPlaces {
    LocalPiece piece;
    bool starts = false;     // The part starts with its chain's first bead.
    bool to_anchor = false;  // That bead has a link to the ground.
    CATENA_HD_IN_PLACE LocalPiece const& piece_of(std::int64_t) const { return piece; }
    CATENA_HD_IN_PLACE bool linked(std::int64_t i) const { return i > 0 || !starts || to_anchor; }
    CATENA_HD_IN_PLACE bool to_ground(std::int64_t i) const { return i == 0 && starts; }
    CATENA_HD_IN_PLACE std::int64_t inboard(std::int64_t i) const { return i - 1; }
    CATENA_HD_IN_PLACE std::int64_t outboard(std::int64_t i) const { return i; }
};
/// Counterpart of BeadFields for a part in registers.
struct PartFields {
    using Places = PartPlaces;
    template <int D>
    using Given = PartField<D>;
    template <int D>
    using Found = PartField<D>;
    using Biases = PartField<1>;
};

/// One thread's part of a chain: its beads' state, and its part of the tree.
template <class Team, class Leaf>
class BeadPart {
    static constexpr int K = Leaf::K, length = dca::part_length;
    using Directions = Vector<double, K>;

  public:
    /// Loads the part's beads. Indices beyond its last bead load that bead again.
    CATENA_EITHER_SIDE
    template <class Step>
    CATENA_HD_IN_PLACE BeadPart(Team const& team, Step const& step)
        : team_(team),
          place_(team.place()),
          sweeps_(step.sweeps),
          chains_(step.chains),
          tree_{team, team.place(), {}, {}} {
        BeadChains const& chains = chains_;
        each([&](int i) {
            std::int64_t const k = place_.body_there(i);
            mass_[i + 1] = chains.mass.load(k);
            inverse_mass_[i + 1] = chains.inverse_mass.load(k);
            length_[i + 1] = chains.length.load(k);
            half_over_length_[i + 1] = chains.half_over_length.load(k);
            position_[i + 1] = chains.position.load(k);
            velocity_[i + 1] = chains.velocity.load(k);
            force_[i + 1] =
                step.forces_are_ahead ? step.forces.on(k, mass_[i + 1][0]) : chains.force.load(k);
            tree_.joint[i] = sweeps_.joints.load(k);
            direction_[i + 1] = ends_before(i) ? Vec3::zero() : chains.direction.load(k);
        });
        direction_[length + 1] =
            goes_on() ? chains.direction.load(place_.body + length) : Vec3::zero();
    }
    /// Views of this part's registers for the per-bead operations.
    CATENA_HD_IN_PLACE BeadChainsIn<PartFields> chains() {
        BeadChainsIn<PartFields> c;
        if (place_.count > 0) {
            LocalPiece const& piece = chains_.places.piece[place_.piece];
            c.places.piece = {piece.first - place_.body, piece.in_scene, piece.anchor};
            c.places.starts = place_.starts_chain(team_.part());
            c.places.to_anchor = c.places.starts && chains_.places.has_link[place_.body] != 0;
        }
        c.mass = {mass_};
        c.inverse_mass = {inverse_mass_};
        c.length = {length_};
        c.half_over_length = {half_over_length_};
        c.position = {position_};
        c.velocity = {velocity_};
        c.force = {force_};
        c.momentum = {momentum_};
        c.change = {change_};
        c.direction = {direction_};
        c.bias = {bias_};
        return c;
    }
    /// Writes back the state that a step changes. Positions are also written to OpenMM's particles
    /// if these exist.
    CATENA_HD_IN_PLACE void store(DeviceParticles const& particles) const {
        each([&](int i) {
            if (ends_before(i)) return;
            std::int64_t const k = place_.body + i;
            chains_.position.store(k, position_[i + 1]);
            chains_.velocity.store(k, velocity_[i + 1]);
            chains_.direction.store(k, direction_[i + 1]);
            if (particles.bead) particles.put(k, position_[i + 1]);
        });
    }

    // Execution policy of a BeadStep (bead_step.hpp).

    struct Way {
        BeadPart* part;
        template <class Action>
        CATENA_HD_IN_PLACE void each_bead(Action const& action) const {
            part->each(action);
        }
        /// A loop, so that the code of `make` exists only once in the program.
        template <class Make, class Take>
        CATENA_HD_IN_PLACE void each_bead(Make const& make, Take const& take) const {
            CATENA_NO_UNROLL
            for (int i = 0; i < length; ++i) {
                auto const made = make(i);
                CATENA_UNROLL
                for (int j = 0; j < length; ++j)
                    if (j == i) take(j, made);
            }
        }
        template <class Action>
        CATENA_HD_IN_PLACE void each_link(Action const& action) const {
            part->each(action);
            action(length);
            part->end_directions();
        }
        template <class Action>
        CATENA_HD_IN_PLACE void each_tip(Action const&) const {}
        template <class Action>
        CATENA_HD_IN_PLACE void each_crosslink(Action const&) const {}
        CATENA_EITHER_SIDE
        CATENA_HD_IN_PLACE void from_inboard() const {
            part->position_[0] = part->team_.from_before(part->position_[length]);
        }
        CATENA_EITHER_SIDE
        CATENA_HD_IN_PLACE void from_outboard() const {
            part->position_[length + 1] = part->team_.from_after(part->position_[1]);
        }
        CATENA_EITHER_SIDE
        CATENA_HD_IN_PLACE void assemble() const { part->assemble(); }
        CATENA_EITHER_SIDE
        CATENA_HD_IN_PLACE void project(PartField<3> momentum, PartField<3> out) const {
            BeadPart& p = *part;
            p.tree_.solve([&](int i) { return p.bias_of(momentum.load(i), i); },
                          [&](int i, Directions const& inboard, Directions const& outboard) {
                              out.store(i, p.acceleration(momentum.load(i), inboard, outboard, i));
                          });
        }
        CATENA_EITHER_SIDE
        CATENA_HD_IN_PLACE void close(PartField<1> bias, PartField<1>, PartField<3> out) const {
            BeadPart& p = *part;
            p.tree_.solve(
                [&](int i) {
                    auto b = dca::SegmentBias<double, K>::zero();
                    b.b1[0] = b.b1[0] + bias.at(i, 0);
                    return b;
                },
                [&](int i, Directions const& inboard, Directions const& outboard) {
                    out.store(i, p.acceleration(Vec3::zero(), inboard, outboard, i));
                });
        }
    };

  private:
    /// True if the chain continues in the next part.
    CATENA_HD_IN_PLACE bool goes_on() const { return place_.goes_on(team_.part()); }
    /// True if the part has no bead i.
    CATENA_HD_IN_PLACE bool ends_before(int i) const { return i >= place_.count; }
    /// Runs `action` for all slots of the part. Results of slots without a bead are not used.
    template <class Action>
    CATENA_HD_IN_PLACE void each(Action const& action) const {
        CATENA_UNROLL
        for (int i = 0; i < length; ++i) action(i);
    }
    /// Clears the direction behind a chain's last bead, where there is no link.
    CATENA_HD_IN_PLACE void end_directions() {
        CATENA_UNROLL
        for (int i = 0; i <= length; ++i)
            if (i < length ? ends_before(i) : !goes_on()) direction_[i + 1] = Vec3::zero();
    }
    CATENA_HD_IN_PLACE Vec3 const& outboard_direction(int i) const { return direction_[i + 2]; }
    /// Assembles the matrices and reports pivot failures.
    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void assemble() {
        dca::PivotFailure lost;
        tree_.assemble_matrices(
            [&](int i) {
                return dca::bead_matrix(inverse_mass_[i + 1][0], direction_[i + 1],
                                        outboard_direction(i), Directions{});
            },
            [&](int i) { return sweeps_.restricted[place_.body_there(i)]; },
            [&](int i, Symmetric<double, K> const& factor) {
                sweeps_.watch(sweeps_.at(place_.body + i), factor, lost);
            });
        sweeps_.note(lost);
    }
    /// Biases of bead i under `force` along its two links.
    CATENA_HD_IN_PLACE dca::SegmentBias<double, K> bias_of(Vec3 const& force, int i) const {
        return dca::bead_bias(inverse_mass_[i + 1][0], force, direction_[i + 1],
                              outboard_direction(i), Directions{});
    }
    /// Acceleration of bead i from `force` and the forces of its two links.
    CATENA_HD_IN_PLACE Vec3 acceleration(Vec3 const& force, Directions const& inboard,
                                         Directions const& outboard, int i) const {
        return dca::bead_acceleration(inverse_mass_[i + 1][0], force, inboard[0], direction_[i + 1],
                                      outboard[0], outboard_direction(i));
    }

    Team const& team_;
    dca::PartPlace place_;
    dca::TreeSweeps<Leaf> const& sweeps_;
    BeadChains const& chains_;
    dca::PartTree<Team, K> tree_;
    Vector<double, 1> mass_[length + 2] = {}, inverse_mass_[length + 2] = {},
                                     length_[length + 2] = {}, half_over_length_[length + 2] = {},
                                     bias_[length + 2] = {};
    Vec3 position_[length + 2] = {}, velocity_[length + 2] = {}, force_[length + 2] = {},
                            momentum_[length + 2] = {}, change_[length + 2] = {},
                            direction_[length + 2] = {};
};

/// One thread's share of `step` (StepOfChains). The team's threads hold the chains' parts
/// (dca/team_tree.hpp). from_before(value) and from_after(value) return what the previous and the
/// next thread of the team passed.
CATENA_EITHER_SIDE
template <class Team, class Step>
CATENA_HD_IN_PLACE void step_of_part(Team const& team, Step const& step) {
    using Part = BeadPart<Team, typename decltype(step.sweeps)::Leaf>;
    Part part(team, step);
    take_step(BeadStep<typename Part::Way, PartFields>{part.chains(), {&part}}, step.step);
    part.store(step.forces.particles);
}

}  // namespace catena
