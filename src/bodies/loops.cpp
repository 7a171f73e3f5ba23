// Implements the reader of loops.
#include "bodies/loops.hpp"

#include <fmt/format.h>

#include "bodies/joint_entry.hpp"
#include "bodies/ring.hpp"
#include "keys/maps.hpp"
#include "scene/fields.hpp"
#include "scene/freedom.hpp"
#include "scene/loops.hpp"

namespace catena::scene {
namespace {

void refuse_loops_of(Node const& node, ChainSpec const& chain) {
    if (chain.is_beads() || chain.is_linked())
        fail(node, "loops in a chain of links",
             chain.is_beads() ? "write `crosslinks`, which join beads by links"
                              : "leave them out: loops join rigid bodies on joints");
    if (chain.tip != Tip::free)
        fail(node, "loops in a chain whose tip is not free",
             fmt::format("leave out `tip` and write its joint as a loop, `bodies: [{}, {}]`",
                         chain.size(), chain.is_ring() ? 1 : 0));
}

/// Reads the number of a body, from 1, or 0 for the ground; returns it from 0.
std::int64_t end_of_loop(Node const& number, ChainSpec const& chain) {
    auto const bodies = static_cast<std::int64_t>(chain.size());
    std::int64_t const body = whole(number, INT64_MIN);
    if (body < 0 || body > bodies)
        fail(number, fmt::format("a loop ends at body {} of {}", body, bodies),
             "count the bodies of this chain from 1; 0 is the ground");
    return body == 0 ? LoopClosure::ground : body - 1;
}

/// Length that an opening is measured by: that of the chain's bodies and of the loop's arms.
double reach_around(ChainSpec const& chain, LoopClosure const& loop) {
    double length = norm(loop.joint.translation) + norm(loop.end_translation);
    for (std::size_t k = 1; k < chain.bodies.size(); ++k)
        length += norm(chain.bodies.translation[k]);
    return length > 0 ? length : 1;
}

/// Checks that the loop is closed at its given end.
void check_end(ChainSpec const& chain, LoopClosure const& loop, double opening, Node const& end,
               Scene& scene) {
    double const length = reach_around(chain, loop);
    if (opening <= closure_tolerance * length) return;
    std::string const what =
        fmt::format("the loop is open at the start: its joint is {:.3g} from `end`", opening);
    if (opening <= closable * length)
        return scene.note(what + ": the smallest change of the joints closes it");
    fail(end, what,
         fmt::format("move the bodies to within {:.3g}, correct `translation` or `end`, or leave "
                     "`end` out",
                     closable * length));
}

LoopClosure read_loop(Node const& item, ChainSpec const& chain, std::vector<Pose> const& poses,
                      Scene& scene) {
    Fields const fields(item, keys::loop);
    Node const& bodies = fields.need("bodies", "bodies: [2, 5]");
    if (bodies.kind != Node::Kind::list || bodies.items.size() != 2)
        fail(bodies, "`bodies` of a loop is not a list of two numbers", "write bodies: [2, 5]");
    LoopClosure loop;
    loop.inboard = end_of_loop(bodies.items[0], chain);
    loop.outboard = end_of_loop(bodies.items[1], chain);
    if (loop.inboard == loop.outboard)
        fail(bodies,
             loop.inboard == LoopClosure::ground
                 ? "a loop joins the ground to itself"
                 : fmt::format("a loop joins body {} to itself", loop.inboard + 1),
             "give two bodies, or a body and 0");
    loop.joint = read_loop_joint(fields.need("joint", "joint: {type: spherical}"));
    Pose const held = held_frame(poses, loop), body = pose_at(poses, loop.outboard);
    Mat3 const axes = to_matrix(body.orientation);
    loop.end_rotation = to_matrix(conjugate(body.orientation) * held.orientation);
    loop.end_translation = transposed_times(axes, held.origin - body.origin);
    if (Node const* const end = fields.find("end")) {
        Vec3 const given = vector3(*end);
        double const opening = norm(given - loop.end_translation);
        loop.end_translation = given;
        loop.joint.anchor = given;
        check_end(chain, loop, opening, *end, scene);
    }
    return loop;
}

}  // namespace

void close_loops(ChainSpec& chain, Node const& loops, Scene& scene) {
    refuse_loops_of(loops, chain);
    std::vector<Pose> const poses = start_poses(chain);
    for (Node const& item : list(loops).items)
        chain.loops.push_back(read_loop(item, chain, poses, scene));
    if (std::int64_t const all = directions_of_loops(chain); all > most_loop_directions)
        fail(loops, fmt::format("the loops restrict {} directions", all),
             fmt::format("give a chain loops that restrict at most {}", most_loop_directions));
    chain.redundant_directions = redundant_directions(chain);
    if (std::int64_t const nearby = redundant_nearby(chain); nearby < chain.redundant_directions)
        scene.note(fmt::format(
            "of the {} directions that the loops restrict, {} are redundant at the start, and {} "
            "nearby: this may be a singular position such as a dead centre, at which the loops "
            "close badly whatever the step; turn a joint by `q`, or move `translation` of the loop",
            directions_of_loops(chain), chain.redundant_directions, nearby));
    if (degrees_of_freedom(chain) == 0 && chain.bodies.driven.empty())
        scene.note(
            fmt::format("the loops of {} bodies leave no degree of freedom at the start: "
                        "nothing can move",
                        chain.size()));
}

}  // namespace catena::scene
