// Implements the reader of linked bodies. Positions in the file are those of the bodies' origins;
// the arrays hold centres of mass. Bodies are read in the order of the chain, so that each link
// starts at a body that has its final place.
#include "reader/linked.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "bodies/carried_beads.hpp"
#include "bodies/physics.hpp"
#include "generate/cells.hpp"
#include "generate/start_fit.hpp"
#include "keys/maps.hpp"
#include "terms/force_terms.hpp"

namespace catena::scene {

namespace {

/// Largest relative difference of a given length from the distance at the start.
double constexpr length_tolerance = 1e-9;

/// Adds bodies one by one to a linked chain.
class LinkedReader {
  public:
    /// Reader for a chain with this base; without a box no link can be cut.
    LinkedReader(Base base, Vec3 const& anchor, std::optional<Vec3> const& box) : base_(base) {
        made_.linked.anchor = anchor;
        if (box) images_.emplace(*box);
    }

    /// Adds the next body or bead with its inboard link.
    void add(Node const& item) {
        bool const bead = !item.find("inertia");
        if (bead)
            for (char const* const key : {"com", "quaternion", "omega", "beads"})
                if (Node const* const extra = item.find(key))
                    fail(*extra,
                         fmt::format("key `{}` does not apply to a point bead on a link", key),
                         "leave it out or give `inertia`");
        for (char const* const key : terms::keys_beside({}, {}))
            if (Node const* const extra = item.find(key))
                fail(*extra, fmt::format("key `{}` does not apply to a chain of links", key),
                     "leave it out");
        Fields const body(item, keys::linked);
        linked_.mass.push_back(positive(body.need("mass", "mass: 1.0")));
        bead ? add_bead(body) : add_rigid(body);
        Node const* const velocity = body.find("velocity");
        linked_.velocity.push_back(velocity ? vector3(*velocity) : Vec3::zero());
        made_.velocities = made_.velocities || velocity || body.find("omega");
        add_link(body);
    }

    /// Moves the result out.
    ExplicitLinked take() {
        linked_.carried = carried_.take();
        return std::move(made_);
    }

  private:
    /// Adds the properties of a point bead.
    void add_bead(Fields const& body) {
        linked_.inertia.push_back(Sym3::zero());
        linked_.position.push_back(vector3(body.need("position", "position: [0, 0, 0]")));
        linked_.orientation.push_back({1, 0, 0, 0});
        linked_.omega.push_back(Vec3::zero());
        linked_.inboard.push_back(Vec3::zero());
        Node const* const residue = body.find("residue");
        carried_.append(Vec3::zero(), linked_.mass.back(), residue ? text(*residue) : "UNK");
        carried_.close();
    }

    /// Adds the properties of a rigid body. The file measures from the body's origin, the arrays
    /// from the centre of mass.
    void add_rigid(Fields const& body) {
        if (Node const* const residue = body.find("residue"))
            fail(*residue, "key `residue` does not apply to a rigid body",
                 "give it `beads: [{residue: ALA, position: [0, 0, 0]}]`");
        linked_.inertia.push_back(inertia(*body.find("inertia")));
        Node const* const com_node = body.find("com");
        Vec3 const com = com_node ? vector3(*com_node) : Vec3::zero();
        Node const* const quaternion = body.find("quaternion");
        std::array<double, 4> const q =
            quaternion ? unit_quaternion(*quaternion) : std::array<double, 4>{1, 0, 0, 0};
        Vec3 const origin = vector3(body.need("position", "position: [0, 0, 0]"));
        linked_.position.push_back(origin + to_matrix(Quat{q[0], q[1], q[2], q[3]}) * com);
        linked_.orientation.push_back(q);
        Node const* const omega = body.find("omega");
        linked_.omega.push_back(omega ? vector3(*omega) : Vec3::zero());
        linked_.inboard.push_back(-com);
        carried_.add(body.find("beads"), com);
    }

    /// Position in W of a point given from the centre of mass of body k, in its axes.
    Vec3 at(std::size_t k, Vec3 const& point) const {
        auto const& q = linked_.orientation[k];
        return linked_.position[k] + to_matrix(Quat{q[0], q[1], q[2], q[3]}) * point;
    }

    /// Adds the body's inboard link, which also sets the outboard end of the preceding body.
    void add_link(Fields const& body) {
        std::size_t const k = linked_.mass.size() - 1;
        // The next link starts where this one ends, unless its `translation` says otherwise.
        linked_.outboard.push_back(linked_.inboard[k]);
        bool const none = k == 0 && base_ == Base::free;
        Node const* const node =
            k == 0 ? body.find("joint") : &body.need("joint", "joint: {type: link}");
        Node const* length = nullptr;
        if (node) {
            Fields const joint(*node, keys::link);
            length = joint.find("length");
            if (length && none)
                fail(*length, "a link length for body 1 of a free base, which has no link",
                     "leave it out or write `base: fixed`");
            if (Node const* const translation = joint.find("translation"))
                start_link(*translation, k);
        }
        linked_.position[k] = linked_.position[k] + shift_;
        if (!none) make_whole(length, k);
        linked_.length.push_back(none ? 0 : measured(body.node(), length, k));
    }

    /// Start of the inboard link of body k, W.
    Vec3 start_of_link(std::size_t k) const {
        return k == 0 ? linked_.anchor : at(k - 1, linked_.outboard[k - 1]);
    }

    /// Length of the longest link so far.
    double longest_so_far() const {
        return linked_.length.empty()
                   ? 0
                   : *std::max_element(linked_.length.begin(), linked_.length.end());
    }

    /// Moves the body by whole edges of the box if the link's nearest image fits its length better.
    /// Without a length the image must be half as long, or shorter and not much longer than the
    /// preceding links.
    void make_whole(Node const* given, std::size_t k) {
        if (!images_) return;
        Vec3 const link = at(k, linked_.inboard[k]) - start_of_link(k),
                   image = images_->shortest(link);
        double const length = given ? positive(*given) : 0;
        if (!(std::abs(norm(image) - length) <
              (1 - length_tolerance) * std::abs(norm(link) - length)))
            return;
        if (!given && norm(image) > std::max(most_usual * longest_so_far(), 0.5 * norm(link))) {
            if (made_.doubtful == 0)
                made_.doubtful = static_cast<std::int64_t>(k) + 1,
                made_.doubtful_length = norm(link);
            return;
        }
        Vec3 const by = images_->whole_edges(link);
        shift_ = shift_ - by, linked_.position[k] = linked_.position[k] - by;
        if (made_.cut_links++ == 0) made_.first_cut = static_cast<std::int64_t>(k) + 1;
    }

    /// Sets the start of the link in the preceding body, given from that body's origin.
    void start_link(Node const& translation, std::size_t k) {
        if (k == 0)
            fail(translation, "a translation for link 1, which starts at the ground",
                 "leave it out: the chain's `anchor` sets the position");
        if (linked_.is_bead(k - 1))
            fail(translation,
                 fmt::format("a translation for a link that starts at bead {}, a point", k),
                 "leave it out");
        linked_.outboard[k - 1] = vector3(translation) + linked_.inboard[k - 1];
    }

    /// Returns the link's length. Throws InputError if its ends coincide or a given length does not
    /// fit.
    double measured(Node const& body, Node const* given, std::size_t k) const {
        Vec3 const from = start_of_link(k), to = at(k, linked_.inboard[k]);
        double const distance = norm(to - from);
        // Positions are rounded to half a unit in their last place. A link shorter than a few of
        // these units has no direction.
        if (!(distance > 16 * std::numeric_limits<double>::epsilon() * (norm(from) + norm(to))))
            fail(body, fmt::format("the ends of link {} coincide: it has no direction", k + 1),
                 "move one of its bodies");
        if (!given) return distance;
        double const length = positive(*given);
        if (std::abs(length - distance) > length_tolerance * length)
            fail(*given,
                 fmt::format("the link's length is {:.12g}, its ends are {:.12g} apart", length,
                             distance),
                 "correct the positions, or leave `length` out");
        return length;
    }

    Base base_;
    ExplicitLinked made_;
    LinkedArrays& linked_ = made_.linked;
    /// Beads of all bodies so far.
    CarriedList carried_;
    /// Images in the periodic box, if any.
    std::optional<Images> images_;
    /// Whole edges by which this and all further bodies are moved.
    Vec3 shift_ = Vec3::zero();
};

}  // namespace

ExplicitLinked read_linked(Node const& bodies, Base base, Vec3 const& anchor,
                           std::optional<Vec3> const& box) {
    LinkedReader reader(base, anchor, box);
    for (Node const& item : bodies.items) reader.add(item);
    return reader.take();
}

}  // namespace catena::scene
