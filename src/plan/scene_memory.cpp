#include <algorithm>

#include "dca/articulated.hpp"
#include "dca/simd/side_by_side.hpp"
#include "plan/describe.hpp"
#include "scene/freedom.hpp"
#include "tree/tree.hpp"

namespace catena::command {
namespace {

struct SolverSizes {
    double segment, joint;
    double kept = 0, all_kept = 0;  // of a run among those that go side by side: its joints between
                                    // parts, and its bodies too
};
template <int K>
SolverSizes sizes() {
    return {
        static_cast<double>(sizeof(dca::SegmentMatrix<double, K>) +
                            sizeof(dca::SegmentBias<double, K>)),
        static_cast<double>(sizeof(dca::JointMatrix<double, K>) + 2 * sizeof(Vector<double, K>)),
        dca::kept_of_run<K>(false) * 8.0, dca::kept_of_run<K>(true) * 8.0};
}
/// Bytes a run among those that go side by side (dca/simd/runs.hpp): places of its own and of a
/// merge, what is kept and the merge's joint, its bodies' constants. 0 where none do. `runs`: about
/// how many a rank has.
double side_by_side(Scene const& scene, ChainSpec const& chain, SolverSizes sizes, int directions,
                    double runs) {
    SimdLevel const level = scene.solver.simd.value_or(best_simd_level());
    if (level == SimdLevel::off || scene.solver.handles != Handles::projected ||
        scene.solver.pairwise())
        return 0;
    double const places =
        static_cast<double>(sizeof(dca::RunsInLanes) + sizeof(dca::MergesInLanes)) /
        lanes_of(level);
    using InJoints = dca::BodyLeaf<5, dca::JointFrameHandles<5, false>>;
    using InGround = dca::BodyLeaf<3, dca::GroundFrames<3>>;
    bool const joints = !chain.is_linked() && (!scene.dynamics.given ||
                                               uses_joint_coordinates(scene.dynamics.integrator));
    double const merge = sizes.kept / (dca::parts_of_run - 1);
    std::vector<JointType> const& types = chain.bodies.joint;
    bool const revolutes =
        joints && directions == InJoints::K &&
        std::none_of(types.begin(), types.end(), [](JointType t) { return slides(t); });
    int const in_joints =
        dca::constants_of<InJoints> - (revolutes ? 0 : dca::frame_constants<InJoints>);
    int const constants = chain.is_beads() ? 0 : joints ? in_joints : dca::constants_of<InGround>;
    if (revolutes) sizes.kept = sizes.all_kept = dca::kept_of_run_of<InJoints>(true) * 8.0;
    bool const all =
        !chain.is_beads() &&
        dca::may_keep_all(static_cast<std::int64_t>(runs * sizes.all_kept / sizeof(double)));
    return places + (all ? sizes.all_kept : sizes.kept) + merge +
           static_cast<double>(dca::longest_run * constants) * sizeof(double);
}
SolverSizes sizes_for(int directions, Handles handles) {
    if (handles == Handles::articulated)
        return {static_cast<double>(sizeof(dca::ArticulatedMatrix<double, 6>) +
                                    sizeof(dca::ArticulatedBias<double, 6>)),
                static_cast<double>(sizeof(dca::ArticulatedJoint<double, 6>) +
                                    sizeof(dca::ArticulatedOffset<double, 6>) +
                                    sizeof(dca::HandleState<double, 6>))};
    switch (directions) {
        case 1:
            return sizes<1>();
        case 2:
            return sizes<2>();
        case 3:
            return sizes<3>();
        case 4:
            return sizes<4>();
        case 5:
            return sizes<5>();
        default:
            return sizes<6>();
    }
}

// Doubles a body in the model's and the dynamics' arrays (chain/chain_group.hpp and integrate/),
// apart from those of the directions.
constexpr double bead_numbers = 3 + 7 * 3, body_numbers = 39 + 3 * 4 + 16 * 3;
constexpr double embedded_numbers = 6 * 7;  // rates of stages
constexpr double joint_numbers =
    13 + 2 * 7 + 2 * 3;  // the scan; where a step starts and its sum; rates
constexpr double noise_numbers =
    2 * 3;  // a thermostat's forces in joint coordinates; what is at rest
constexpr double yielding_numbers =
    6 + 3;  // implicit joints' compliance; in joint coordinates what it does to rates
constexpr double rotor_numbers =
    6 + 2 * 3 + 4;  // in absolute ones rates, torques and flights of rotors (JointRotors)

/// What an integrator keeps of a body beside the model and the state. `stands`: springs stand in
/// the matrices of the body's group.
double numbers_of(DynamicsSpec const& dynamics, bool stands) {
    if (!uses_joint_coordinates(dynamics.integrator)) return stands ? rotor_numbers : 0;
    double numbers = joint_numbers + (stands ? yielding_numbers : 0);
    if (dynamics.integrator == Integrator::dormand_prince) numbers += embedded_numbers;
    if (is_langevin(dynamics.integrator) && dynamics.friction > 0) numbers += noise_numbers;
    return numbers;
}

double scene_bytes(ChainSpec const& chain) {
    BodyArrays const& b = chain.bodies;
    double const bead = sizeof(double) * 8 + sizeof(std::string),
                 body = sizeof(double) * (1 + 3 + 6 + 3 + 9 + 3 + 4 + 3) + 1;
    double const loads =
        sizeof(double) *
        (3.0 * static_cast<double>(b.torque.size() + b.stiffness.size() + b.damping.size()) +
         4.0 * static_cast<double>(b.rest.size()) + 6.0 * static_cast<double>(b.wrench.size()));
    double const more = sizeof(double) * (3.0 * static_cast<double>(b.first_axis.size()) +
                                          static_cast<double>(b.pitch.size()) +
                                          2.0 * static_cast<double>(b.drag.size()));
    double const linked = sizeof(double) * (1 + 6 + 6 + 4 + 3 + 6 + 1);
    double const carried = sizeof(double) * 4 + sizeof(std::string);
    return bead * static_cast<double>(chain.beads.size()) + body * static_cast<double>(b.size()) +
           loads + more + linked * static_cast<double>(chain.linked.size()) +
           carried * static_cast<double>(b.carried.size() + chain.linked.carried.size());
}

}  // namespace

Memory memory_of(Scene const& scene, int ranks) {
    Directions const directions = directions_of(scene);
    bool const pairwise = scene.solver.pairwise();
    bool const implicit = scene.dynamics.given && is_implicit(scene.dynamics.integrator);
    auto const resists = [](ChainSpec const& chain) { return scene::resists(chain); };
    bool const together = scene.solver.handles == Handles::full &&
                          std::any_of(scene.chains.begin(), scene.chains.end(), resists);
    double const runs =
        static_cast<double>(scene.bodies()) / static_cast<double>(dca::longest_run * ranks);
    Memory m;
    for (ChainSpec const& chain : scene.chains) {
        bool const links = chain.is_beads() || chain.is_linked();
        int const k = links ? directions.beads : directions.bodies;
        auto const n = static_cast<double>(chain.size());
        SolverSizes const size = sizes_for(k, scene.solver.handles);
        dca::ChainTree const tree(static_cast<std::int64_t>(chain.size()),
                                  dca::run_length_for(pairwise));
        bool const stands = implicit && (together || resists(chain));
        double const numbers =
            chain.is_beads() ? bead_numbers : body_numbers + numbers_of(scene.dynamics, stands);
        m.scene += scene_bytes(chain);
        m.state += n * (sizeof(double) * (numbers + 2 * k) + 5) / ranks;
        m.solver += (2 * static_cast<double>(tree.runs) * size.segment + n * size.joint) / ranks;
        m.solver +=
            static_cast<double>(tree.runs) * side_by_side(scene, chain, size, k, runs) / ranks;
    }
    return m;
}

}  // namespace catena::command
