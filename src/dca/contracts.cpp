// Asserts that the leaves, the sweeps and the Space of the host have what their concepts require.
#include "dca/contracts.hpp"

#include "dca/articulated_sweeps.hpp"
#include "dca/fused_sweep.hpp"

namespace catena::dca {
namespace {

template <class Leaf>
using Fused = FusedSweep<Leaf, Resting<Leaf>>;

template <int K, bool sliding = false>
using JointLeaf = BodyLeaf<K, JointFrameHandles<K, sliding>>;

static_assert(FloatingLeaf<BeadLeaf<1>> && FloatingLeaf<BeadLeaf<3>>);
static_assert(FloatingLeaf<BodyLeaf<1, LinkFrames<1>>> && FloatingLeaf<BodyLeaf<3, LinkFrames<3>>>);
static_assert(FloatingLeaf<BodyLeaf<3, GroundFrames<3>>> &&
              FloatingLeaf<BodyLeaf<6, GroundFrames<6>>>);
static_assert(FloatingLeaf<JointLeaf<2>> && FloatingLeaf<JointLeaf<3>> &&
              FloatingLeaf<JointLeaf<4>> && FloatingLeaf<JointLeaf<5>> &&
              FloatingLeaf<JointLeaf<6>> && FloatingLeaf<JointLeaf<5, true>> &&
              FloatingLeaf<JointLeaf<6, true>>);
static_assert(TreeLeaf<ArticulatedLeaf<false>> && TreeLeaf<ArticulatedLeaf<true>>);

static_assert(OutwardSweep<Fused<BodyLeaf<3, GroundFrames<3>>>> &&
              OutwardSweep<Fused<JointLeaf<2>>> && OutwardSweep<Fused<JointLeaf<5, true>>>);
static_assert(WholeRunSweep<Fused<JointLeaf<5>>>);

static_assert(SolverSpace<HostSpace>);

}  // namespace
}  // namespace catena::dca
