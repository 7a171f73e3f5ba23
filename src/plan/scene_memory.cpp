// Estimates the memory of a scene from the sizes of the arrays on one rank.
#include <algorithm>
#include <span>

#include "dca/articulated.hpp"
#include "dca/simd/side_by_side.hpp"
#include "dca/tree_body.hpp"
#include "joints/joint_models.hpp"
#include "math/with_number.hpp"
#include "plan/describe.hpp"
#include "scene/branch_limits.hpp"
#include "scene/branches.hpp"
#include "scene/freedom.hpp"
#include "scene/loops.hpp"
#include "terms/force_terms.hpp"
#include "tree/branches.hpp"

namespace catena::command {
namespace {

/// Bytes of the solver's data per segment and per joint.
struct SolverSizes {
    double segment, joint;
    /// Bytes of a run that is computed side by side with others: joints between its parts, and its
    /// bodies too.
    double kept = 0, all_kept = 0;
};
/// Returns the sizes for handles with K directions.
template <int K>
SolverSizes sizes() {
    return {
        static_cast<double>(sizeof(dca::SegmentMatrix<double, K>) +
                            sizeof(dca::SegmentBias<double, K>)),
        static_cast<double>(sizeof(dca::JointMatrix<double, K>) + 2 * sizeof(Vector<double, K>)),
        dca::kept_of_run<K>(false) * 8.0, dca::kept_of_run<K>(true) * 8.0};
}
/// Returns the bytes of a run that is computed side by side with others (dca/simd/runs.hpp): its
/// own lanes and those of a merge, kept bodies and the joint of the merge, and constants of its
/// bodies. Returns 0 if no runs are computed so. `runs` is the approximate number of runs per rank.
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
/// Returns the sizes for handles with this number of directions.
SolverSizes sizes_for(int directions, Handles handles) {
    if (handles == Handles::articulated)
        return {static_cast<double>(sizeof(dca::ArticulatedMatrix<double, 6>) +
                                    sizeof(dca::ArticulatedBias<double, 6>)),
                static_cast<double>(sizeof(dca::ArticulatedJoint<double, 6>) +
                                    sizeof(dca::ArticulatedOffset<double, 6>) +
                                    sizeof(dca::HandleState<double, 6>))};
    return with_number<1, 6>(directions, [](auto count) { return sizes<count>(); });
}

// Doubles per body in the arrays of the model and the dynamics (chain/chain_group.hpp and
// integrate/), apart from those of the directions.
constexpr double bead_numbers = 3 + 7 * 3, body_numbers = 39 + 3 * 4 + 16 * 3;
/// Rates at the stages of an embedded Runge-Kutta method.
constexpr double embedded_numbers = 6 * 7;
/// The scan along the chain, the start of a step and its sum, and rates.
constexpr double joint_numbers = 13 + 2 * 7 + 2 * 3;
/// A thermostat's forces in joint coordinates, and what is at rest.
constexpr double noise_numbers = 2 * 3;
/// Compliance of implicit joints and, in joint coordinates, its effect on the rates.
constexpr double yielding_numbers = 6 + 3;
/// Rates, torques and free rotation of rotors in absolute coordinates (JointRotors).
constexpr double rotor_numbers = 6 + 2 * 3 + 4;

/// Returns the doubles per body that an integrator keeps in addition to the model and the state.
/// `stands` is true if springs enter the matrices of the body's group.
double numbers_of(DynamicsSpec const& dynamics, bool stands) {
    if (!uses_joint_coordinates(dynamics.integrator)) return stands ? rotor_numbers : 0;
    double numbers = joint_numbers + (stands ? yielding_numbers : 0);
    if (is_adaptive(dynamics.integrator)) numbers += embedded_numbers;
    if (is_langevin(dynamics.integrator) && dynamics.friction > 0) numbers += noise_numbers;
    return numbers;
}

/// Returns the bytes of a branched chain's solver: segments and joints, beads with side paths, and
/// the numbers and lists of its paths.
double bytes_of_branches(ChainSpec const& chain, bool pairwise, SolverSizes const& size) {
    if (scene::is_body_tree(chain))
        return static_cast<double>(chain.size()) *
               (sizeof(dca::TreeBody<true>) + 3 * sizeof(std::int64_t));
    std::vector<std::int64_t> inboard(chain.size(), -1);
    for (std::size_t k = 1; k < inboard.size(); ++k)
        inboard[k] = static_cast<std::int64_t>(scene::inboard_of(chain.parent, k));
    dca::Branches const branches(inboard, pairwise);
    double constexpr of_place = 2 * sizeof(std::int64_t) + sizeof(std::int32_t) + 2,
                     of_fork = sizeof(Sym3) + 2 * sizeof(Vec3) + sizeof(dca::Fork),
                     of_path = sizeof(dca::Run) + sizeof(dca::Root) + sizeof(Vec3);
    return static_cast<double>(branches.slots) * (size.segment + sizeof(dca::Merge)) +
           static_cast<double>(branches.joints) * (size.joint + of_place) +
           static_cast<double>(branches.forks.size()) * of_fork +
           static_cast<double>(branches.paths()) * of_path;
}

/// Returns the bytes that cross-links add: two vectors per bead, and two matrices.
double bytes_of_crosslinks(ChainSpec const& chain) {
    if (!chain.is_cross_linked()) return 0;
    auto const count = static_cast<double>(chain.crosslinks.size());
    return sizeof(double) * (6 * static_cast<double>(chain.size()) + 2 * count * count);
}

/// Returns the bytes that loops add: four vectors per body, and two matrices.
double bytes_of_loops(ChainSpec const& chain) {
    if (!chain.has_loops()) return 0;
    auto const count = static_cast<double>(scene::directions_of_loops(chain));
    return sizeof(double) * (12 * static_cast<double>(chain.size()) + 2 * count * count);
}

/// Returns the bytes of a chain's scene data, which every rank holds.
double scene_bytes(ChainSpec const& chain) {
    BodyArrays const& b = chain.bodies;
    double const bead = sizeof(double) * 8 + sizeof(std::string),
                 body = sizeof(double) * (1 + 3 + 6 + 3 + 9 + 3 + 4 + 3) + 1;
    double loads = 0;
    terms::for_each_column([&](auto const& column) {
        std::span const values = b.*column.values;
        loads += static_cast<double>(values.size_bytes());
    });
    for (TermNumbers const& each : chain.term_numbers)
        loads += sizeof(double) * static_cast<double>(each.values.size());
    double const more = sizeof(double) * (3.0 * static_cast<double>(b.first_axis.size()) +
                                          static_cast<double>(b.pitch.size()));
    double const linked = sizeof(double) * (1 + 6 + 6 + 4 + 3 + 6 + 1);
    double const carried = sizeof(double) * 4 + sizeof(std::string);
    return sizeof(std::int64_t) * static_cast<double>(chain.parent.size()) +
           bead * static_cast<double>(chain.beads.size()) + body * static_cast<double>(b.size()) +
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
    auto const whole = static_cast<double>(
        std::count_if(scene.chains.begin(), scene.chains.end(), scene::goes_by_paths));
    Memory m;
    for (ChainSpec const& chain : scene.chains) {
        // Ranks share chains, or deal out whole ones.
        double const sharing = scene::goes_by_paths(chain)
                                   ? std::min(whole, static_cast<double>(ranks))
                                   : static_cast<double>(ranks);
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
        m.state += n * (sizeof(double) * (numbers + 2 * k) + 5) / sharing;
        m.solver += bytes_of_loops(chain) / sharing;
        if (scene::goes_by_paths(chain)) {
            m.solver +=
                (bytes_of_branches(chain, pairwise, size) + bytes_of_crosslinks(chain)) / sharing;
            continue;
        }
        m.solver += (2 * static_cast<double>(tree.runs) * size.segment + n * size.joint) / ranks;
        m.solver +=
            static_cast<double>(tree.runs) * side_by_side(scene, chain, size, k, runs) / ranks;
    }
    return m;
}

}  // namespace catena::command
