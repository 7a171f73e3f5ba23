// Arrays of chains of point beads in the memory of a Space.
#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/bead_chains.hpp"

namespace catena {

/// For each local bead, 1 if it has an inboard link, else 0.
std::vector<std::uint8_t> links_of(ChainGroup const&);
/// 1 / (2 length) of each link; 0 without a link.
Field<1> halves_over(Field<1> const& length, Executor const&);

/// Constants of the beads, links and tips of a group, on the host and in a Space.
template <class Space>
class BeadConstants {
    template <class T>
    using List = typename Space::template List<T>;
    using Numbers = typename Space::template Fixed<1>;

  public:
    /// The group must outlive this object.
    BeadConstants(ChainGroup const& group, Scene const& scene, Executor const& on_host)
        : group_(group),
          links_(links_of(group)),
          halves_(halves_over(group.joints.length, on_host)),
          piece_(local_pieces(group, scene)),
          tip_(held_tips(group,
                         [&](std::int64_t k) {
                             return scene.chains[group.scene_chain(k)].beads.position.back();
                         })),
          is_first_(group.ends.is_first),
          has_link_(links_),
          inboard_(group.branching.inboard),
          pieces_(piece_),
          tips_(tip_),
          mass_(group.bodies.mass),
          inverse_mass_(group.bodies.inverse_mass),
          length_(group.joints.length),
          half_over_length_(halves_) {}
    // Lists of a host's Space view the vectors of this object.
    BeadConstants(BeadConstants const&) = delete;
    BeadConstants& operator=(BeadConstants const&) = delete;

    /// Sets the views of the constants.
    template <class Fields>
    void show(BeadChainsIn<Fields>& c) const {
        if constexpr (Fields::has_crosslinks) {
            c.places.inboard_bead = inboard_.data();
            c.places.crosslink = group_.branching.crosslinks.data();
        }
        c.places.size = group_.size;
        c.places.is_first = is_first_.data();
        c.places.has_link = has_link_.data();
        c.places.piece = pieces_.data();
        c.places.pieces = std::ssize(piece_);
        c.mass = mass_.view();
        c.inverse_mass = inverse_mass_.view();
        c.length = length_.view();
        c.half_over_length = half_over_length_.view();
        c.tip = tips_.data();
    }
    /// Sets the pieces of a configuration by positions.
    void show(ConfigurationView& at) const {
        at.piece = pieces_.data();
        at.pieces = std::ssize(piece_);
    }
    /// The tips of this rank, on the host.
    std::vector<HeldTip> const& tips() const { return tip_; }

  private:
    ChainGroup const& group_;
    // On the host.
    std::vector<std::uint8_t> links_;
    Field<1> halves_;
    std::vector<LocalPiece> piece_;
    std::vector<HeldTip> tip_;
    // In the space.
    List<std::uint8_t> is_first_, has_link_;
    List<std::int64_t> inboard_;
    List<LocalPiece> pieces_;
    List<HeldTip> tips_;
    Numbers mass_, inverse_mass_, length_, half_over_length_;
};

/// Numbers of the beads, links and tips of a group that change with time, in a Space.
template <class Space>
struct BeadStore {
    ChainGroup const& group;
    /// BeadChainsIn documents the fields.
    typename Space::template FieldOf<3> position, velocity, observed, force, momentum, change,
        direction, tip_direction;
    /// Biases and constraint forces along the directions of links and of tips' links.
    typename Space::Directions bias, joint_force, tip_bias, tip_force;

    /// Allocates the arrays. The group must outlive this object.
    explicit BeadStore(ChainGroup const& of)
        : group(of),
          position(of.size),
          velocity(of.size),
          observed(of.size),
          force(of.size),
          momentum(of.size),
          change(of.size),
          direction(of.link_entries()),
          tip_direction(of.ends.has_tips() ? of.size : 0),
          bias(of.link_entries() + 1, of.directions),
          joint_force(of.link_entries() + 1, of.directions),
          tip_bias(of.ends.has_tips() ? of.size : 0, of.directions),
          tip_force(of.ends.has_tips() ? of.size : 0, of.directions) {}

    /// Sets the views of the fields that loops over beads read and write.
    template <class Fields>
    void show(BeadChainsIn<Fields>& c) {
        c.position = position.view();
        c.velocity = velocity.view();
        c.observed = observed.view();
        c.force = force.view();
        c.momentum = momentum.view();
        c.change = change.view();
        c.direction = direction.view();
        c.tip_direction = tip_direction.view();
        c.bias = bias.view();
        c.tip_bias = of_tips(group, tip_bias);
    }
    /// Configuration for the solver by link directions.
    ConfigurationView directions() {
        return {
            direction.view(), {}, group.ends.has_tips() ? tip_direction.view() : View<3>{}, {}, {}};
    }
};

}  // namespace catena
