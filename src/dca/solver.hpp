// What every backend is: matrices and biases are separate steps, so that the one can run while
// forces are computed and the other be repeated.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "chain/chain_group.hpp"
#include "math/executor.hpp"

namespace catena {

/// K numbers a body (K known at run time only), laid out as fields.
template <class Real>
struct BasicDirectionsView {
    Real* origin = nullptr;
    std::int64_t pitch = 0;  // as place_of() has it
    CATENA_HD Real& at(std::int64_t k, int direction) const {
        return origin[direction * to_next_number(pitch) + place_of(k, pitch)];
    }
    template <int K>
    CATENA_HD Vector<double, K> load(std::int64_t k) const {
        Vector<double, K> v;
        Real* const first = origin + place_of(k, pitch);
        CATENA_UNROLL
        for (int i = 0; i < K; ++i) v[i] = first[i * to_next_number(pitch)];
        return v;
    }
    template <int K>
    CATENA_HD void store(std::int64_t k, Vector<double, K> const& v) const {
        Real* const first = origin + place_of(k, pitch);
        CATENA_UNROLL
        for (int i = 0; i < K; ++i) first[i * to_next_number(pitch)] = v[i];
    }
    CATENA_HD explicit operator bool() const { return origin != nullptr; }
    CATENA_HD operator BasicDirectionsView<Real const>() const { return {origin, pitch}; }
};
using DirectionsView = BasicDirectionsView<double>;
using ConstDirectionsView = BasicDirectionsView<double const>;

class DirectionsField {
  public:
    DirectionsField() = default;
    DirectionsField(std::int64_t size, int directions) : pitch_(size | 1), data_(static_cast<std::size_t>(pitch_ * directions)) {}
    DirectionsView view() { return {data_.data(), pitch_}; }
    ConstDirectionsView view() const { return {data_.data(), pitch_}; }

  private:
    std::int64_t pitch_ = 0;
    LongArray<double> data_;
};

/// The part of a chain in absolute coordinates on this rank.
struct LocalPiece {
    std::int64_t first = 0;     // local body
    std::int64_t in_scene = 0;  // its index over the scene
    Vec3 anchor;                // of a chain that begins at the ground, on a link or a joint there; W
    /// Local body k's index over the scene, which its noise goes by.
    CATENA_HD std::uint64_t body_of(std::int64_t k) const { return static_cast<std::uint64_t>(in_scene + k - first); }
};
CATENA_HD LocalPiece const& piece_of(LocalPiece const* piece, std::int64_t pieces, std::int64_t k) {
    std::int64_t low = 0, high = pieces;
    while (high - low > 1) {
        std::int64_t const middle = (low + high) / 2;
        if (piece[middle].first <= k)
            low = middle;
        else
            high = middle;
    }
    return piece[low];
}

/// What the matrices depend on.
struct ConfigurationView {
    ConstView<3> direction;      // links: unit direction of link k, from inboard to outboard, W; [0, size]; 0 where there is no link
    ConstView<4> rotation;       // bodies: quaternion w x y z: Axes::joint: of B in the meeting frame of its inboard joint; world: in W
    ConstView<3> tip_direction;  // links: of the link from last body k to the ground; absent where no tip is jointed
    /// Where the inboard side of joints moves in the inboard body (ChainGroup::moving_meeting): its handle 2 from the centre of mass and
    /// the meeting frame's axes; B.
    ConstView<3> r2;
    ConstView<6> axes2;
    /// Full handles of bodies without links: compliance of joint k along its three angular directions, the last ones (lower triangle): its
    /// outboard side yields by that to the joint's force. Absent where no joint does.
    ConstView<6> compliance{};
    /// Beads, for assemble_and_solve() alone, instead of directions: positions with their halo, W, and the pieces they belong to.
    ConstView<3> position{};
    LocalPiece const* piece = nullptr;
    std::int64_t pieces = 0;
};

/// For one that goes_by_revolutes(): of runs of two bodies or more omega is known of first bodies alone, and this stands in the place of torque
/// and force. A view without origin means zero.
struct RevoluteLoads {
    bool given = false;
    ConstView<4> rotation;  // of bodies on revolute joints: quaternion of B in the body before; those side by side have `frame` instead
    ConstView<4> frame;     // of the meeting frame there
    /// What joints do along their free directions, on body k along the axes of its inboard joint, of revolute joints about the last one; [0, size].
    ConstView<3> joint_torque;
    static constexpr int about_revolute = 2;  // component
    ConstView<3> torque, force;  // from outside, about the centre of mass, W
    ConstView<4> orientation;    // where these are: of first bodies, quaternion of B in W
};

/// What the biases depend on. A view without origin means zero.
struct LoadsView {
    ConstView<3> torque;       // on each body about its centre of mass, B, joint torques and -omega x J omega included
    ConstView<3> force;        // on each body: Axes::joint: B; Axes::world and beads: W
    ConstView<3> omega;        // angular velocity, B: for the centripetal terms at the handles
    ConstDirectionsView bias;  // subtracted velocity terms of joint k along its directions (chapter, eq 2.5): D^T (A_1^B - A_2^A) = -bias
    ConstDirectionsView tip_bias;  // the same of the joint between last body k and the ground
    ConstView<3> velocity{};       // with positions given instead of directions: of beads, with their halo, W; instead of `bias`
    bool gyroscopic = false;       // `torque` lacks -omega x J omega: the solver adds it
    /// For assemble_and_solve() that goes_by_revolutes(): rates of the revolute joints, of which it makes their biases. `bias` then is asked for of
    /// bodies alone that begin a chain or make a run by themselves.
    ConstView<1> revolute_rate{};
    RevoluteLoads revolutes{};
};

/// Of links: what the inverse of their matrix T (src/dca/README.md, "Link chains") says beyond solutions.
struct InverseView {
    View<1> pivot;      // of link k in the tree's order, those of tips among them: their product is det T; 1 where there is no link
    View<1> tip_pivot;  // of the link from last body k to the ground
    View<1> beside;     // (T^-1)_k,k+1 of the links on either side of body k; 0 where there are not two
};

struct AccelerationsView {
    View<3> alpha;               // angular, B; may be absent
    View<3> acceleration;        // of the centre of mass (bead), axes of LoadsView::force; may be absent
    DirectionsView joint_force;  // constraint force on body k along the directions of its inboard joint; [0, size]; may be absent
    DirectionsView tip_force;    // on the ground at the jointed tip of last body k; may be absent
    /// Of assemble_and_solve() that goes_by_revolutes(), in the place of most bodies' alpha and acceleration, which then are those of bodies
    /// that begin a chain, make a run by themselves, come before such a one, or are this rank's last. In runs of two bodies or more
    /// component 0 is the angular acceleration of body k about its revolute joint, against the body before or, of a run's first body, against the
    /// ground; component 1, of the joint after such a run, that of the run's last body against the ground about that joint's axis:
    /// [0, size].
    View<2> revolute_acceleration{};
    /// Whether runs on revolute joints find the accelerations of all their bodies, not only of those named above.
    CATENA_HD bool by_all_bodies() const { return !revolute_acceleration.origin || joint_force; }
};

/// Of a tree whose lowest levels are computed in one place and the others in another one (cuda-levels: GPU and CPU).
struct SplitSeconds {
    double lower_assembly = 0, upper_assembly = 0, lower_disassembly = 0, upper_disassembly = 0;  // leaves, top and exchange included
    double upload = 0, download = 0;

    double lower() const { return lower_assembly + lower_disassembly; }
    double upper() const { return upper_assembly + upper_disassembly; }
    double transfers() const { return upload + download; }
    SplitSeconds& operator-=(SplitSeconds const& other) {
        lower_assembly -= other.lower_assembly, upper_assembly -= other.upper_assembly;
        lower_disassembly -= other.lower_disassembly, upper_disassembly -= other.upper_disassembly;
        upload -= other.upload, download -= other.download;
        return *this;
    }
    SplitSeconds& operator+=(SplitSeconds const& other) {
        lower_assembly += other.lower_assembly, upper_assembly += other.upper_assembly;
        lower_disassembly += other.lower_disassembly, upper_disassembly += other.upper_disassembly;
        upload += other.upload, download += other.download;
        return *this;
    }
};

struct SolverReport {
    std::string backend, handles;
    SimdLevel simd = SimdLevel::off;  // of runs that go side by side, where there are any
    int directions = 0, threads = 1, ranks = 1;
    std::int64_t run_length = 0, depth = 0, merges = 0;
    std::int64_t memory_bytes = 0;
    bool direct_exchange = false;  // ranks' GPUs write to each other's memory
    std::int64_t matrix_sweeps = 0, bias_sweeps = 0, evaluations = 0;  // of the latter each is both, matrices and biases together
    double matrix_seconds = 0, bias_seconds = 0, exchange_seconds = 0;
    SplitSeconds split;
};

class ChainSolver {
  public:
    virtual ~ChainSolver() = default;
    /// Needs no forces. Collective. Throws ComputationError when a joint's matrix is not positive definite, or leaves that to check()
    /// where it does not wait for what it asked for.
    virtual void assemble_matrices(ConfigurationView const&) = 0;
    /// The bias sweep and the disassembly with the matrices and the configuration given last; may be repeated. Collective.
    virtual void solve(LoadsView const&, AccelerationsView const&) = 0;
    /// Both, where nothing is to be hidden: the matrices are not kept for solve(), and the last bits may be others. Collective.
    virtual void assemble_and_solve(ConfigurationView const& configuration, LoadsView const& loads, AccelerationsView const& out) {
        assemble_matrices(configuration);
        solve(loads, out);
    }
    /// Whether assemble_and_solve() is one sweep, which reads beads by their positions and velocities.
    virtual bool at_once() const { return false; }
    /// Whether it takes runs on revolute joints by their inertias, and so can do with less: LoadsView::revolute_rate, RevoluteLoads,
    /// AccelerationsView::revolute_acceleration.
    virtual bool goes_by_revolutes() const { return false; }
    /// Whether runs go side by side (deal_out_runs()).
    virtual bool has_runs_side_by_side() const { return false; }
    /// Seconds of assemble_and_solve() where all its views are already, `repeat` times the mean of `chained` calls one after the other.
    /// Collective.
    virtual std::vector<double> time_evaluations(ConfigurationView const&, LoadsView const&, AccelerationsView const&, int chained,
                                                 int repeat);
    /// Throws ComputationError when a joint's matrix has not been positive definite since the last call, on this rank.
    virtual void check() {}
    /// Until everything asked for so far is done.
    virtual void wait() {}
    /// From here on the seconds of every sweep are in the report, if need be by waiting for each.
    virtual void measure(bool /*on*/) {}
    /// With the matrices assembled last by assemble_matrices(). Precondition: links, a backend without a GPU.
    virtual void invert(InverseView const&);
    virtual SolverReport report() const = 0;
};

/// Run length and depth of the group's largest tree, directions and ranks, into a report.
void add_tree(ChainGroup const&, Communicator const&, SolverReport&);

/// Throws what is wrong with a joint of the group's schedule on this rank: its matrix is not positive definite.
[[noreturn]] void refuse_indefinite(ChainGroup const&, int rank, std::int64_t joint);

/// The divide-and-conquer solver over a group's canonical tree. The group, executor and communicator must outlive it.
std::unique_ptr<ChainSolver> make_tree_solver(ChainGroup const&, Executor const&, Communicator const&);

}  // namespace catena
