// The validated description of a simulation: plain data, held whole by every rank. Quantities are
// in the scene's units: nm, ps, amu and kJ/mol, or SI units with `units: si`. Frames: W ground
// axes, B body axes, J joint frame (fixed in the inboard body by `rotation` and `translation`).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/members.hpp"
#include "joints/joint_type.hpp"
#include "math/linear.hpp"
#include "math/rotation.hpp"
#include "math/simd_level.hpp"
#include "scene/integrator.hpp"

namespace catena {

/// Base of a chain: body 1 moves freely, or its inboard joint attaches it to the ground.
enum class Base { free, fixed };
/// Tip of a chain: free, or attached by a TipJoint.
enum class Tip { free, jointed };
/// Velocities at the start: as written in the scene, zero, or drawn at DynamicsSpec::temperature.
enum class StartVelocities { given, zero, thermal };

/// Prescribed coordinate: offset + rate t + amplitude sin(2 pi frequency t + phase). The coordinate
/// is a length or an angle (rad); `frequency` is in cycles per time unit, `phase` in rad.
struct PrescribedMotion {
    double offset = 0, rate = 0, amplitude = 0, frequency = 0, phase = 0;
};
/// Joint with prescribed motion. Joints with one coordinate use the first course, universal and
/// cylindrical joints both. The courses replace the joint's q and qd at all times. Torque,
/// stiffness and damping of the joint are ignored.
struct DrivenJoint {
    /// Index of the body outboard of the joint, from 0; ascending in a list.
    std::int64_t body = 0;
    std::array<PrescribedMotion, 2> course;
};

/// Beads (points known to OpenMM) that are fixed in rigid bodies. All arrays are empty if no body
/// of the chain carries a bead.
struct CarriedBeads {
    /// Range of beads per body, bodies + 1 entries: body k carries beads [offset[k], offset[k+1]).
    std::vector<std::int64_t> offset;
    /// Position from the body's origin, B.
    std::vector<Vec3> position;
    /// Masses for the topology and OpenMM; the dynamics use only the body's own mass.
    std::vector<double> mass;
    /// Three-letter residue names; "UNK" where none is given.
    std::vector<std::string> residue;

    std::size_t size() const { return position.size(); }
};

/// Start of the origin of a body that moves freely, W.
struct FreeBase {
    Vec3 position = Vec3::zero();
    Vec3 velocity = Vec3::zero();
};

/// Rigid bodies of one chain in joint coordinates. Entry k describes body k + 1 and its inboard
/// joint. A body's origin is its inboard joint; for joints that translate it is the point at the
/// joint frame's origin at q = 0. X(q), the joint's own motion, relates B to J. Revolute:
/// rotation by q about `axis`. Prismatic: translation by q along `axis`. Helical: rotation by q and
/// translation by pitch q. Cylindrical: rotation by q[0], translation by q[1]. Planar3: translation
/// by q[0] along `first_axis` and by q[1] along `axis` x `first_axis`, both in J, and rotation by
/// q[2] about `axis`. Universal: rotation by q[0] about `first_axis`, then by q[1] about `axis`.
/// Weld: identity. Arrays from `first_axis` on may be empty, which means zero. An empty
/// `first_axis` means no joint with two axes, an empty `pitch` no helical joint.
struct BodyArrays {
    std::vector<double> mass;
    /// Centre of mass from the origin, B.
    std::vector<Vec3> com;
    /// Inertia about the centre of mass, B.
    std::vector<Sym3> inertia;
    /// Joint types; entry 0 of a free base is `free`.
    std::vector<JointType> joint;
    /// Unit axis in B; its components in J are equal. Universal joint: the second axis, B.
    std::vector<Vec3> axis;
    /// Rotation matrix of J relative to the inboard body's axes (entry 0: to the ground's).
    std::vector<Mat3> rotation;
    /// Origin of J from the inboard body's origin, in the inboard body's axes.
    std::vector<Vec3> translation;
    /// Joint positions: one number per coordinate, then zeros. Spherical and free: unit quaternion
    /// w x y z of B in J (free: in W). Weld: zeros.
    std::vector<std::array<double, 4>> q;
    /// Joint rates. Spherical and free: angular velocity relative to the inboard body, B.
    std::vector<Vec3> qd;
    /// Body 1 of a free base; ignored for a fixed one.
    FreeBase free_base;
    /// First axis of a universal joint, J; not parallel to `axis`. Planar3: direction of q[0], J,
    /// perpendicular to the normal `axis`.
    std::vector<Vec3> first_axis;
    /// Translation per radian of a helical joint.
    std::vector<double> pitch;
    /// Joint torque (force if the coordinate is a length) on body k + 1 along each coordinate.
    /// Spherical: components in B.
    std::vector<Vec3> torque;
    /// Spring constant per coordinate. Spherical: acts on the components of the rotation vector
    /// from `rest`.
    std::vector<Vec3> stiffness;
    /// Damping constant on qd, per coordinate as in `stiffness`.
    std::vector<Vec3> damping;
    /// Rest positions of the springs, in the format of `q`.
    std::vector<std::array<double, 4>> rest;
    /// External {torque, force} at the centre of mass, W.
    std::vector<std::pair<Vec3, Vec3>> wrench;
    /// Drag constants {linear, angular}: force -linear v at the centre of mass, torque -angular
    /// omega.
    std::vector<std::array<double, 2>> drag;
    /// Joints with prescribed motion; all others are absent from the list.
    std::vector<DrivenJoint> driven;
    CarriedBeads carried;

    std::size_t size() const { return mass.size(); }
};

/// Rigid bodies and point beads joined by links of fixed length, in absolute coordinates. Entry k
/// describes body k + 1 and its inboard link. That link runs from point `outboard` of the preceding
/// body to point `inboard` of this body.
struct LinkedArrays {
    std::vector<double> mass;
    /// Inertia about the centre of mass, B; all zero for a point bead.
    std::vector<Sym3> inertia;
    /// Position and velocity of the centre of mass, W; not wrapped into the box.
    std::vector<Vec3> position, velocity;
    /// Unit quaternion w x y z of B in W.
    std::vector<std::array<double, 4>> orientation;
    /// Angular velocity, B.
    std::vector<Vec3> omega;
    /// Ends of the links from the centre of mass, B; zero for a point bead.
    std::vector<Vec3> inboard, outboard;
    /// Length of the inboard link. Entry 0 is used only for a fixed base, where the link starts at
    /// `anchor`.
    std::vector<double> length;
    /// Carried beads, with positions from the centre of mass, B; a point bead carries itself.
    CarriedBeads carried;
    /// Ground point of the first link for a fixed base, W.
    Vec3 anchor = Vec3::zero();

    bool is_bead(std::size_t k) const { return inertia[k].data[0] == 0; }
    std::size_t size() const { return mass.size(); }
};

/// Joint between the last body and the ground, or the first body if the chain is a ring. The joint
/// frame J is fixed in the last body. G is the frame on the other side, in the role of an outboard
/// body's frame. A tip at the ground keeps G at rest at its start placement, G = J X(q). In a ring
/// G is the frame B of the first body, and q is ignored. A link instead runs from the last bead to
/// the ground point `anchor`; in a ring it runs to the first bead.
struct TipJoint {
    bool ring = false;
    JointType type = JointType::spherical;
    Vec3 axis = Vec3::zero(), first_axis = Vec3::zero();
    double pitch = 0;
    Mat3 rotation = Mat3::identity();
    Vec3 translation = Vec3::zero();
    /// Joint position at the start, in the format of BodyArrays::q.
    std::array<double, 4> q{0, 0, 0, 0};
    /// Required position of G's origin, W. A closure error above 1e-9 of the chain's reach is
    /// refused. Links to the ground require it.
    std::optional<Vec3> anchor;
    /// Length of a link; 0 means the distance at the start.
    double length = 0;
};

/// Point beads on rigid links. Entry k describes bead k + 1 and its inboard link.
struct BeadArrays {
    std::vector<double> mass;
    /// Position in W, not wrapped into the box.
    std::vector<Vec3> position;
    std::vector<Vec3> velocity;  // W
    /// Length of the inboard link. Entry 0 is used only for a fixed base, where the link starts at
    /// `anchor`.
    std::vector<double> length;
    /// Three-letter names for the topology and force parameters; "UNK" where none is given.
    std::vector<std::string> residue;
    /// Ground point of the first link for a fixed base, W.
    Vec3 anchor = Vec3::zero();

    std::size_t size() const { return mass.size(); }
};

/// Rigid link between two beads of a chain, beside the links that join each bead to its inboard
/// one.
struct CrossLink {
    /// Beads, counted from 0 within their chain; the first is the smaller number.
    std::int64_t inboard = 0, outboard = 0;
    /// Length, nm.
    double length = 0;
    bool operator==(CrossLink const&) const = default;
};

/// Joint between two bodies of a chain, or a body and the ground, beside the inboard joints. The
/// joint frame J is fixed in the inboard body. The frame G, in the role of an outboard body's
/// frame, is fixed in the outboard body.
struct LoopClosure {
    /// Stands for the ground in the place of a body; its frame is W.
    static constexpr std::int64_t ground = -1;
    /// Bodies, counted from 0 within their chain.
    std::int64_t inboard = ground, outboard = ground;
    /// Joint with its frame J in the inboard body, and its position at the start. It is no ring.
    /// Its anchor is G's origin in the outboard body, if the scene gives that.
    TipJoint joint;
    /// Orientation and origin of G in the outboard body.
    Mat3 end_rotation = Mat3::identity();
    Vec3 end_translation = Vec3::zero();
};

/// Numbers that a force term without arrays of its own keeps for each body of a chain.
struct TermNumbers {
    std::string term;  // Name of the term (src/terms).
    int width = 0;     // Numbers per body.
    std::vector<double> values;
};

/// One chain. Exactly one of `beads`, `bodies` and `linked` is filled. `count: N` in a scene yields
/// N such chains.
struct ChainSpec {
    std::string name;
    Base base = Base::free;
    Tip tip = Tip::free;
    /// Joint of the tip; used only for Tip::jointed.
    TipJoint tip_joint;
    StartVelocities velocities = StartVelocities::given;
    BeadArrays beads;
    BodyArrays bodies;
    LinkedArrays linked;
    /// Inboard body of each body, counted from 0 within the chain; -1 for the first one, and always
    /// smaller than the body's own number. Empty for an unbranched chain, where it is the body
    /// before.
    std::vector<std::int64_t> parent = {};
    /// Cross-links of a chain of point beads, in the order of the scene.
    std::vector<CrossLink> crosslinks = {};
    /// Number of links, cross-links included, that keep their length at the start because the
    /// others do. They take no degree of freedom.
    std::int64_t redundant_links = 0;
    /// Joints that close loops of rigid bodies, in the order of the scene.
    std::vector<LoopClosure> loops = {};
    /// Number of directions that loops restrict at the start although other joints of the chain
    /// restrict them already. They take no degree of freedom.
    std::int64_t redundant_directions = 0;
    /// Chain identifiers and residue numbers of the beads, for topology files; empty unless a
    /// structure file gives them.
    Members members = {};
    /// Numbers by term and body; a term that acts on no body is absent.
    std::vector<TermNumbers> term_numbers = {};

    bool is_beads() const { return beads.size() > 0; }
    bool is_linked() const { return linked.size() > 0; }
    bool is_branched() const { return !parent.empty(); }
    bool is_cross_linked() const { return !crosslinks.empty(); }
    bool has_loops() const { return !loops.empty(); }
    /// True if the chain has a jointed tip or loops.
    bool is_closed() const { return tip == Tip::jointed || has_loops(); }
    bool is_ring() const { return tip == Tip::jointed && tip_joint.ring; }
    std::size_t size() const { return beads.size() + bodies.size() + linked.size(); }
    CarriedBeads const& carried() const { return is_linked() ? linked.carried : bodies.carried; }
    /// Number of points known to OpenMM: the beads, or the beads carried by the bodies.
    std::size_t bead_count() const { return is_beads() ? beads.size() : carried().size(); }
};

/// Section `forces.openmm`: the force model and the way OpenMM computes it.
struct OpenMmSpec {
    std::string builder;   // "calvados2", or empty if `system` is given
    std::string system;    // serialised System XML, path resolved against the scene's folder
    std::string topology;  // PDB file; with a builder the chains' own residue table, or empty
    /// First and last particle of each named chain; an empty map assigns the topology's chains in
    /// order. With a builder the pair holds flags (0 or 1) for the charged first and last ends.
    std::vector<std::pair<std::string, std::pair<std::int64_t, std::int64_t>>> map;
    double temperature = 300;      // K
    double ionic_strength = 0.15;  // mol/l
    /// pH for the charge of histidine, 1 / (1 + 10^(pH - 6)); neutral without a value.
    std::optional<double> ph;
    /// Width in nm below each cutoff over which the pair terms are switched off; 0 cuts as
    /// published.
    double switch_width = 0;
    /// Name of the OpenMM platform. Empty selects CUDA with backend cuda if present, else CPU if
    /// present, else Reference.
    std::string platform;
    std::string precision;  // for GPU platforms
    int threads = 0;        // per rank; 0: cores / ranks
    /// Index of the GPU; -1 if not given.
    int device = -1;
    /// One of: auto, device (positions and forces stay on the GPU), host (worker thread), inline.
    std::string path = "auto";
    /// True if the chains' own work proceeds during the force computation (paths device and host).
    bool overlap = true;
    /// One of: auto, all, none. Long-range forces on few beads are placed in Contexts of their own.
    std::string layers = "auto";
    /// One of: auto, ghosts, pairs. Selects how ranks on GPUs divide the pair forces.
    std::string split = "auto";
    /// True if every rank holds all beads and computes all forces.
    bool replicate = false;
    /// True if every evaluation compares the ghosts with a search among all beads.
    bool audit = false;
    std::vector<int> force_groups;  // empty: all
};

/// Section `forces`.
struct ForceSpec {
    Vec3 gravity = Vec3::zero();  // acceleration, W
    /// Drag constants of all bodies without drag of their own.
    double linear_drag = 0, angular_drag = 0;
    std::optional<OpenMmSpec> openmm;
};

/// Section `dynamics`.
struct DynamicsSpec {
    /// True if the scene has a `dynamics` section.
    bool given = false;
    Integrator integrator = Integrator::rattle;
    /// Time step (ps).
    double step = 0;
    std::int64_t steps = 0;
    /// Temperature of the thermostat and of thermal starts, K.
    double temperature = 300;
    /// Friction rate of the Langevin integrators (1/ps).
    double friction = 0.01;
    std::uint64_t seed = 1;
    /// Largest permitted constraint violation, relative.
    double constraint_tolerance = 1e-10;
    /// Relative error tolerance of an adaptive step; 0 keeps the steps as long as `step`.
    double tolerance = 0;
    /// True if rigid links sample the ensemble of stiff springs.
    bool fixman = false;
    /// True if the scene gives the number of steps. It tells `steps: 0`, a single frame, from a
    /// missing key.
    bool has_steps = false;
};

/// Implementation of the solver; inputs/keys/solver.md describes each.
enum class Backend { automatic, serial, segments, openmp, cuda, cuda_levels };
inline bool uses_gpu(Backend backend) {
    return backend == Backend::cuda || backend == Backend::cuda_levels;
}
/// Directions that handles carry: the restricted directions of the joints (projected), or all
/// (full). `articulated` carries all directions of runs that are held at their inboard side
/// (dca/articulated.hpp); it avoids cancellation.
enum class Handles { projected, full, articulated };
inline bool carries_all(Handles handles) { return handles != Handles::projected; }

/// Numbers of the tree's lowest merge levels that the GPU assembles (`up`) and disassembles
/// (`down`) with cuda-levels. From 1 on the GPU also computes the bodies themselves. Numbers beyond
/// the tree's levels mean all levels.
struct GpuLevels {
    static constexpr int all = 1000;
    int up = all, down = all;
};

/// Section `solver`.
struct SolverSpec {
    Backend backend = Backend::automatic;
    Handles handles = Handles::projected;
    int threads = 0;  // 0: cores / ranks on this host
    /// Text form of GpuLevels: auto, all, "K" or "UP,DOWN".
    std::string gpu_levels = "auto";
    /// Number of iterative refinement steps of every solution in joint coordinates.
    int refine = 0;
    /// Vector instruction set; without a value the best that all ranks support.
    std::optional<SimdLevel> simd;
    /// True if ranks receive shares of the bodies by their speeds, which a run measures.
    bool balance = false;

    /// Parses `gpu_levels`; `auto` that no planner has replaced means all levels.
    GpuLevels levels_on_gpu() const;
    /// True if the tree is the chapter's pairwise tree that starts at single bodies.
    bool pairwise() const { return backend == Backend::serial || backend == Backend::cuda_levels; }
};

/// Section `output`.
struct OutputSpec {
    /// Number of steps between frames and lines of observables.
    std::int64_t every = 100;
    std::int64_t checkpoint_every = 0;  // steps; 0: none by steps
    /// Names of the columns, in order; empty selects the default set.
    std::vector<std::string> observables;
    /// True if the trajectory holds constraint forces.
    bool joint_forces = false;
    /// True if the trajectory holds velocities.
    bool velocities = false;
    /// True if the trajectory holds orientations of bodies, joint coordinates and rates.
    bool coordinates = false;
    float checkpoint_minutes = 30;  // wall time; 0: none by time
};

/// Largest changes made by the reader to the given positions. The reader sets links to their
/// lengths, makes wrapped chains whole and relaxes overlaps.
struct StartChange {
    /// Largest change of a link's length.
    double link = 0;
    /// Largest displacement of a bead, without whole box edges.
    double position = 0;
    /// Place of that change, e.g. "chain `a`, beads 19 and 20: 9.31 to 0.38 nm"; empty if no link
    /// changed.
    std::string link_at;
    /// Place of that displacement, e.g. "chain `a`, bead 20"; empty if no bead moved.
    std::string moved_at;
};

/// A whole simulation: chains, forces, dynamics, solver and output.
struct Scene {
    std::string title;
    bool si = false;  // `units: si`
    std::vector<ChainSpec> chains;
    /// Number of replicas, which exert no forces on each other. The chains of a replica follow one
    /// another, and all replicas have the same chains.
    std::int64_t replicas = 1;
    /// Edges of the periodic box.
    std::optional<Vec3> box;
    ForceSpec forces;
    DynamicsSpec dynamics;
    SolverSpec solver;
    OutputSpec output;
    /// True if overlaps of the start are relaxed before the first step.
    bool relax = false;
    StartChange start;
    /// Sentences on what the reader assumed, changed or left out, in the order of reading.
    std::vector<std::string> notes;
    std::string file;  // path as given by the user
    /// Fingerprint of all that decides the motion, which guards restarts. It excludes solver,
    /// output and dynamics.steps.
    std::string hash;

    /// Boltzmann constant in the scene's units: kJ/mol/K or J/K.
    double boltzmann() const { return si ? 1.380649e-23 : 0.00831446261815324; }
    std::int64_t bodies() const;
    /// Returns the name of a chain without the number of its replica, as the scene file has it.
    std::string name_in_file(std::size_t chain) const;
    /// Number of chains of one replica.
    std::size_t chains_a_replica() const {
        return chains.size() / static_cast<std::size_t>(replicas);
    }
    /// Appends a note unless it is among the last thousand.
    void note(std::string text);
};

/// Names as scenes write them.
char const* name_of(JointType);
char const* name_of(Backend);
char const* name_of(Handles);

}  // namespace catena
