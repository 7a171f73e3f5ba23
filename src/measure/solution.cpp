// Results of an evaluation in the layout that users get.
#include "measure/solution.hpp"

#include <algorithm>
#include <cmath>

#include "joints/joint_models.hpp"
#include "scene/branches.hpp"
#include "scene/freedom.hpp"

namespace catena {
namespace {

void append(std::vector<double>& list, Vec3 const& v) {
    list.insert(list.end(), v.data, v.data + 3);
}

/// Returns the outboard end of the link on the inboard side of body k, W. `body`: index of body k
/// in the scene.
Vec3 link_end(ChainSpec const& chain, std::size_t k, SceneMotion const& at, std::size_t body) {
    return chain.is_linked()
               ? at.position[body] + to_matrix(at.orientation[body]) * chain.linked.inboard[k]
               : at.position[body];
}
/// Returns the inboard end of that link, W.
Vec3 link_start(ChainSpec const& chain, std::size_t k, SceneMotion const& at, std::size_t body) {
    if (k == 0) return chain.is_linked() ? chain.linked.anchor : chain.beads.anchor;
    std::size_t const before = scene::inboard_of(chain.parent, k), inboard = body - k + before;
    return chain.is_linked() ? at.position[inboard] + to_matrix(at.orientation[inboard]) *
                                                          chain.linked.outboard[before]
                             : at.position[inboard];
}

/// Returns the tension of link k. The force along the link is -tension towards the outboard bead.
double tension(ChainSpec const& chain, std::size_t k, SceneMotion const& at, std::size_t body,
               Vector<double, 6> const& wrench) {
    if (k == 0 && chain.base == Base::free) return 0.0;
    Vec3 const link = link_end(chain, k, at, body) - link_start(chain, k, at, body);
    return -dot((1.0 / norm(link)) * link, Vec3{{wrench[3], wrench[4], wrench[5]}});
}

}  // namespace

char const* kind_of(ChainSpec const& chain) { return scene::name_of(scene::handle_kind(chain)); }

int accelerations_of(ChainSpec const& chain, std::size_t k) {
    if (chain.is_beads()) return 3;
    if (chain.is_linked()) return chain.linked.is_bead(k) ? 3 : 6;
    return scene::coordinates_of(chain.bodies.joint[k]);
}

Solution solution_of(ChainSystem& system) {
    ChainSystem::Accelerations const a = system.accelerations();
    SceneMotion const at = system.snapshot();
    Solution s;
    s.bead_force = a.bead_force;
    s.tip_force = a.tip_force;
    s.loop_force = a.loop_force;
    s.crosslink_tension = a.crosslink_tension;
    if (system.communicator().rank() != 0) return s;
    std::size_t body = 0;
    for (ChainSpec const& chain : system.scene().chains)
        for (std::size_t k = 0; k < chain.size(); ++k, ++body) {
            s.acceleration_offset.push_back(static_cast<std::int64_t>(s.acceleration.size()));
            s.force_offset.push_back(static_cast<std::int64_t>(s.joint_force.size()));
            if (chain.is_beads() || chain.is_linked()) {
                bool const bead = accelerations_of(chain, k) == 3;
                if (!bead)
                    append(s.acceleration,
                           transposed_times(to_matrix(at.orientation[body]), a.alpha[body]));
                append(s.acceleration, a.acceleration[body]);
                if (chain.is_beads()) s.bead_acceleration.push_back(a.acceleration[body]);
                s.joint_force.push_back(tension(chain, k, at, body, a.joint_force[body]));
                continue;
            }
            JointType const joint = chain.bodies.joint[k];
            for (int i = 0; i < std::min(3, scene::coordinates_of(joint)); ++i)
                s.acceleration.push_back(a.joint_acceleration[body][i]);
            if (floats(joint)) append(s.acceleration, a.base_acceleration[body]);
            s.joint_force.insert(s.joint_force.end(), a.joint_force[body].data,
                                 a.joint_force[body].data + 6);
        }
    s.acceleration_offset.push_back(static_cast<std::int64_t>(s.acceleration.size()));
    s.force_offset.push_back(static_cast<std::int64_t>(s.joint_force.size()));
    return s;
}

Solution layout_of(Scene const& scene) {
    Solution s;
    s.acceleration_offset.push_back(0);
    for (ChainSpec const& chain : scene.chains)
        for (std::size_t k = 0; k < chain.size(); ++k)
            s.acceleration_offset.push_back(s.acceleration_offset.back() +
                                            accelerations_of(chain, k));
    return s;
}

double largest_difference(Scene const& scene, Solution const& found,
                          std::vector<double> const& reference) {
    enum { angular, base, bead, sliding, classes };
    double difference[classes] = {}, largest[classes] = {};
    std::size_t body = 0;
    for (ChainSpec const& chain : scene.chains)
        for (std::size_t k = 0; k < chain.size(); ++k, ++body)
            for (std::int64_t i = found.acceleration_offset[body];
                 i < found.acceleration_offset[body + 1]; ++i) {
                bool const linear =
                    accelerations_of(chain, k) == 6 && i >= found.acceleration_offset[body] + 3;
                bool const slides =
                    chain.bodies.size() > 0 &&
                    is_length(chain.bodies.joint[k],
                              static_cast<int>(i - found.acceleration_offset[body]));
                int const kind =
                    chain.is_beads() || (chain.is_linked() && accelerations_of(chain, k) == 3)
                        ? bead
                    : slides ? sliding
                    : linear ? base
                             : angular;
                difference[kind] =
                    larger(difference[kind], std::abs(found.acceleration[i] - reference[i]));
                largest[kind] = std::max(largest[kind], std::abs(reference[i]));
            }
    double worst = 0;
    for (int kind = 0; kind < classes; ++kind)
        worst =
            larger(worst, largest[kind] > 0 ? difference[kind] / largest[kind] : difference[kind]);
    return worst;
}

}  // namespace catena
