// Interface of all solver backends. Matrices and biases are separate steps, so that the matrix
// sweep can overlap with the computation of forces and the bias sweep can be repeated. Quantities
// are in the units of the scene: nm, ps, amu and kJ/mol unless it says `units: si`.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "chain/chain_group.hpp"
#include "math/executor.hpp"

namespace catena {

/// K numbers per body (K known at run time only), stored as fields: body by body for each number.
template <class Real>
struct BasicDirectionsView {
    Real* origin = nullptr;
    std::int64_t pitch = 0;  // Stride between the numbers of a body, as place_of() uses it.
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

/// Storage of K numbers per body for a DirectionsView. Each field is padded to an odd number of
/// elements.
class DirectionsField {
  public:
    DirectionsField() = default;
    DirectionsField(std::int64_t size, int directions)
        : pitch_(size | 1), data_(static_cast<std::size_t>(pitch_ * directions)) {}
    DirectionsView view() { return {data_.data(), pitch_}; }
    ConstDirectionsView view() const { return {data_.data(), pitch_}; }

  private:
    std::int64_t pitch_ = 0;
    LongArray<double> data_;
};

/// The part of one chain in absolute coordinates that this rank owns.
struct LocalPiece {
    std::int64_t first = 0;     // Local index of its first body.
    std::int64_t in_scene = 0;  // Index of that body in the scene.
    Vec3 anchor;  // Anchor of a chain that begins at the ground, on a link or a joint there; W.
    /// Returns the index in the scene of local body k. Its random numbers depend on this index.
    CATENA_HD std::uint64_t body_of(std::int64_t k) const {
        return static_cast<std::uint64_t>(in_scene + k - first);
    }
};
/// Returns the piece that local body k belongs to. `piece` is an array of `pieces` pieces, ordered
/// by their first bodies.
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

/// One side of the joint that closes a loop.
struct LoopEnd {
    Vec3 arm;   // Point of the joint from the body's centre of mass, B; from the origin of W.
    Mat3 axes;  // Axes of the joint, B or W.
};
/// Both sides of the joint that closes a loop, at a configuration.
struct LoopEnds {
    LoopEnd inboard, outboard;
};

/// Configuration of the bodies, on which the matrices depend. W stands for ground axes, B for body
/// axes.
struct ConfigurationView {
    /// Links: unit direction of link k, from inboard to outboard, W; [0, size]; 0 if there is no
    /// link.
    ConstView<3> direction;
    /// Bodies: quaternion w x y z. With Axes::joint it is the rotation of B in the meeting frame of
    /// the inboard joint, with Axes::world that in W.
    ConstView<4> rotation;
    /// Links: direction of the link from last body k to the ground; absent if no tip is jointed.
    ConstView<3> tip_direction;
    /// Outboard handle of bodies whose meeting frame depends on the joint's coordinates
    /// (LocalJoints::moving_meeting): handle 2 from the centre of mass, and two axes of the meeting
    /// frame; B.
    ConstView<3> r2;
    ConstView<6> axes2;
    /// Full handles of bodies without links: compliance of joint k along its three angular
    /// directions, the last ones (lower triangle). It is P B^-1 P^T of implicit springs and dampers
    /// (src/dca/README.md, "Joints"). Absent if no joint has a compliance.
    ConstView<6> compliance{};
    /// Beads: positions with their halo, W, and the pieces to which the beads belong. Only
    /// assemble_and_solve() uses them, instead of directions.
    ConstView<3> position{};
    LocalPiece const* piece = nullptr;
    std::int64_t pieces = 0;
    /// Ends of LocalLoops::own, on the host. They must stay valid until the last solve().
    LoopEnds const* loop_ends = nullptr;
};

/// Loads for a solver that eliminates_revolute_joints(). In runs of two bodies or more, omega is
/// known of the first bodies only, and these views replace torque and force. A view without origin
/// means zero.
struct RevoluteLoads {
    bool given = false;
    /// Rotation of bodies on revolute joints: quaternion of B in the axes of the body before.
    /// Bodies that are processed side by side have `frame` instead.
    ConstView<4> rotation;
    /// Rotation of the meeting frame in the axes of the body before, as a quaternion.
    ConstView<4> frame;
    /// Torques of joints along their free directions, on body k along the axes of its inboard
    /// joint; [0, size]. That of a revolute joint is about the last axis.
    ConstView<3> joint_torque;
    static constexpr int about_revolute = 2;  // Component of `joint_torque`.
    ConstView<3> torque, force;  // External torque about the centre of mass and external force, W.
    /// Rotation of first bodies, if there are external loads: quaternion of B in W.
    ConstView<4> orientation;
};

/// Loads and velocities of the bodies, on which the biases depend. A view without origin means
/// zero.
struct LoadsView {
    /// Torque on each body about its centre of mass, B. Joint torques and -omega x J omega are
    /// included, except where stated below.
    ConstView<3> torque;
    /// Force on each body; in B with Axes::joint, in W with Axes::world and for beads.
    ConstView<3> force;
    ConstView<3> omega;  // Angular velocity, B, for the centripetal terms at the handles.
    /// Subtracted velocity terms of joint k along its directions (chapter, eq 2.5): D^T (A_1^B -
    /// A_2^A) = -bias.
    ConstDirectionsView bias;
    /// Subtracted velocity terms of the joint between last body k and the ground.
    ConstDirectionsView tip_bias;
    /// Velocities of beads with their halo, W; given instead of `bias` where positions replace
    /// directions.
    ConstView<3> velocity{};
    bool gyroscopic = false;  // True if `torque` lacks -omega x J omega; the solver then adds it.
    /// Rates of the revolute joints, for assemble_and_solve() of a solver that
    /// eliminates_revolute_joints(). The solver computes the joints' velocity terms from them.
    /// `bias` is then needed only for bodies that begin a chain or form a run of one body.
    ConstView<1> revolute_rate{};
    RevoluteLoads revolutes{};
    /// Subtracted velocity terms of LocalLoops::own, along the directions of each, as `tip_bias`.
    Vector<double, 6> const* loop_bias = nullptr;
};

/// Results of ChainSolver::invert() for links: entries of the inverse of their matrix T
/// (src/dca/README.md, "Link chains").
struct InverseView {
    /// Pivot of link k in the elimination order of the tree; 1 if there is no link. The product of
    /// all pivots, those of tips included, is det T.
    View<1> pivot;
    View<1> tip_pivot;  // Pivot of the link from last body k to the ground.
    View<1> beside;     // Entry (T^-1)_k,k+1 of the two links of body k; 0 if it does not have two.
};

/// Results of a solver. Each view may be absent (without origin) if its values are not requested.
struct AccelerationsView {
    View<3> alpha;  // Angular acceleration, B.
    /// Acceleration of the centre of mass or of the bead, in the axes of LoadsView::force.
    View<3> acceleration;
    /// Constraint force on body k along the directions of its inboard joint; [0, size].
    DirectionsView joint_force;
    DirectionsView tip_force;  // Constraint force on the ground at the jointed tip of last body k.
    /// Joint accelerations, for assemble_and_solve() of a solver that eliminates_revolute_joints();
    /// [0, size]. They replace alpha and acceleration of most bodies. These two are then computed
    /// only for bodies that begin a chain, form a run of one body, precede such a body, or are this
    /// rank's last.
    ///
    /// In runs of two bodies or more, component 0 is the angular acceleration of body k about its
    /// revolute joint, relative to the body before; for a run's first body, relative to the ground.
    /// Component 1 belongs to the joint after such a run: angular acceleration of the run's last
    /// body about that joint's axis, relative to the ground.
    View<2> revolute_acceleration{};
    /// Constraint force of LocalLoops::own on the outboard bodies, along the directions of each.
    Vector<double, 6>* loop_force = nullptr;
    /// True if runs on revolute joints compute the accelerations of all their bodies, not only of
    /// those named above.
    CATENA_HD bool by_all_bodies() const { return !revolute_acceleration.origin || joint_force; }
};

/// Seconds of a solver whose tree is cut: its lowest levels are computed in one place and the
/// others in another (cuda-levels: GPU and CPU).
struct SplitSeconds {
    /// Leaves, top and exchange between ranks are included.
    double lower_assembly = 0, upper_assembly = 0, lower_disassembly = 0, upper_disassembly = 0;
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

/// Statistics of a solver, printed in reports.
struct SolverReport {
    std::string backend, handles;
    /// SIMD level of runs that are processed side by side, if there are any.
    SimdLevel simd = SimdLevel::off;
    int directions = 0, threads = 1, ranks = 1;
    std::int64_t run_length = 0, depth = 0, merges = 0;
    std::int64_t memory_bytes = 0;
    /// True if the GPUs of ranks write directly to each other's memory.
    bool direct_exchange = false;
    /// Numbers of sweeps; an evaluation computes matrices and biases together.
    std::int64_t matrix_sweeps = 0, bias_sweeps = 0, evaluations = 0;
    double matrix_seconds = 0, bias_seconds = 0, exchange_seconds = 0;
    SplitSeconds split;
};

/// A solver of the equations of motion of one group of chains, on one backend.
class ChainSolver {
  public:
    virtual ~ChainSolver() = default;
    /// Assembles the matrices; needs no forces. Collective. Throws ComputationError if a joint's
    /// matrix is not positive definite. Asynchronous backends report that failure from check().
    virtual void assemble_matrices(ConfigurationView const&) = 0;
    /// Computes the bias sweep and the disassembly with the matrices and the configuration given
    /// last; may be repeated. Collective.
    virtual void solve(LoadsView const&, AccelerationsView const&) = 0;
    /// Computes both, where no other work could be overlapped. The matrices are not kept for
    /// solve(), and the last bits may differ. Collective.
    virtual void assemble_and_solve(ConfigurationView const& configuration, LoadsView const& loads,
                                    AccelerationsView const& out) {
        assemble_matrices(configuration);
        solve(loads, out);
    }
    /// True if assemble_and_solve() is one fused sweep, which reads beads from their positions and
    /// velocities.
    virtual bool at_once() const { return false; }
    /// True if the solver computes runs on revolute joints by articulated-body inertias. It then
    /// needs less input: LoadsView::revolute_rate, RevoluteLoads,
    /// AccelerationsView::revolute_acceleration.
    virtual bool eliminates_revolute_joints() const { return false; }
    /// True if several runs are processed side by side in SIMD lanes (deal_out_runs()).
    virtual bool has_runs_side_by_side() const { return false; }
    /// Returns `repeat` times in seconds. Each is the mean of `chained` consecutive calls of
    /// assemble_and_solve(), whose views are already in the solver's memory. Collective.
    virtual std::vector<double> time_evaluations(ConfigurationView const&, LoadsView const&,
                                                 AccelerationsView const&, int chained, int repeat);
    /// Throws ComputationError if a joint's matrix on this rank has not been positive definite
    /// since the last call.
    virtual void check() {}
    /// Waits until all submitted work is complete.
    virtual void wait() {}
    /// Switches measurement on or off. With measurement, the report contains the seconds of every
    /// sweep; asynchronous backends wait after each for that.
    virtual void measure(bool /*on*/) {}
    /// Computes entries of T^-1 from the matrices that assemble_matrices() assembled last.
    /// Precondition: links, a backend without a GPU.
    virtual void invert(InverseView const&);
    /// Returns the statistics since construction.
    virtual SolverReport report() const = 0;
};

/// Adds run length and depth of the group's largest tree, directions and ranks to a report.
void add_tree(ChainGroup const&, Communicator const&, SolverReport&);

/// Throws the ComputationError that names a joint of this rank's schedule whose matrix is not
/// positive definite.
[[noreturn]] void refuse_indefinite(ChainGroup const&, int rank, std::int64_t joint);

/// Returns the divide-and-conquer solver over a group's canonical tree on the host. The group,
/// executor and communicator must outlive it.
std::unique_ptr<ChainSolver> make_tree_solver(ChainGroup const&, Executor const&,
                                              Communicator const&);

}  // namespace catena
