// What the user describes, validated: plain data, whole on every rank, in the units of the scene.
// Frames: W ground axes, B body axes, J joint frame (fixed in the inboard body, `rotation` and
// `translation`).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "math/linear.hpp"
#include "math/rotation.hpp"
#include "math/simd_level.hpp"

namespace catena {

enum class JointType : std::uint8_t {
    free,
    link,
    spherical,
    revolute,
    universal,
    weld,
    prismatic,
    helical
};
/// Whether the outboard body moves along the joint's axis.
CATENA_HD bool slides(JointType type) {
    return type == JointType::prismatic || type == JointType::helical;
}
enum class Base { free, fixed };
enum class Tip { free, jointed };
enum class StartVelocities { given, zero, thermal };

/// A prescribed coordinate: offset + rate t + amplitude sin(2 pi frequency t + phase).
struct PrescribedMotion {
    double offset = 0, rate = 0, amplitude = 0, frequency = 0, phase = 0;
};
/// A joint that is driven: revolute, prismatic and helical by the first course, universal by both.
/// What the joint's q and qd say is overwritten by the course at every time; its torque, stiffness
/// and damping mean nothing.
struct DrivenJoint {
    std::int64_t body = 0;  // index from 0; ascending in a list
    std::array<PrescribedMotion, 2> course;
};

/// Beads (points that OpenMM knows) fixed in bodies. Empty where no body of the chain carries any.
struct CarriedBeads {
    std::vector<std::int64_t> offset;  // bodies + 1: body k carries beads [offset[k], offset[k+1])
    std::vector<Vec3> position;        // from the body's origin, B
    std::vector<double>
        mass;  // for the topology and OpenMM; the body's own mass counts in the dynamics
    std::vector<std::string> residue;

    std::size_t size() const { return position.size(); }
};

/// Rigid bodies of one chain; entry k is body k + 1 and its inboard joint. A body's origin is its
/// inboard joint (prismatic and helical: the point that lies on the joint frame's origin at q = 0).
/// Between J and B stands the joint's own motion X(q): revolute: turn by q about `axis`; prismatic:
/// shift by q along `axis`; helical: turn by q and shift by pitch q; universal: turn by q[0] about
/// `first_axis`, then by q[1] about `axis`; weld: none. The arrays from `first_axis` on may be
/// empty, which means zero (first_axis: no universal joint; pitch: no helical joint).
struct BodyArrays {
    std::vector<double> mass;
    std::vector<Vec3> com;         // from the origin, B
    std::vector<Sym3> inertia;     // about com, B
    std::vector<JointType> joint;  // entry 0 of a free base: JointType::free
    std::vector<Vec3>
        axis;  // unit axis, B (and J: the same components); universal: the second axis, B
    std::vector<Mat3>
        rotation;  // R of the joint frame in the inboard body's axes (entry 0: ground)
    std::vector<Vec3> translation;  // origin of the joint frame from the inboard body's origin,
                                    // inboard body's axes
    std::vector<std::array<double, 4>>
        q;  // {angle or shift, 0, 0, 0}; universal {angle 1, angle 2, 0, 0}; spherical and free:
            // unit quaternion w x y z of B in J (free: in W); weld: zeros
    std::vector<Vec3>
        qd;  // rates of q; spherical and free: angular velocity relative to the inboard body, B
    Vec3 free_position = Vec3::zero();  // free base: origin of body 1, W
    Vec3 free_velocity = Vec3::zero();  // free base: its velocity, W
    std::vector<Vec3> first_axis;       // universal: the first axis, J; not parallel to `axis`
    std::vector<double> pitch;          // helical: shift a radian
    std::vector<Vec3> torque;           // joint torque (prismatic: force) on body k + 1 along each
                                        // coordinate; spherical: components in B
    std::vector<Vec3>
        stiffness;  // a coordinate; spherical: on the components of the rotation vector from `rest`
    std::vector<Vec3> damping;                  // on qd, as stiffness
    std::vector<std::array<double, 4>> rest;    // as q
    std::vector<std::pair<Vec3, Vec3>> wrench;  // external {torque, force} at com, W
    std::vector<std::array<double, 2>>
        drag;  // {linear, angular}: force -linear v at com, torque -angular omega
    std::vector<DrivenJoint> driven;  // sparse
    CarriedBeads carried;

    std::size_t size() const { return mass.size(); }
};

/// Rigid bodies and point beads joined by links of fixed length, in absolute coordinates; entry k
/// is body k + 1 and the link on its inboard side, which runs from point `outboard` of the body
/// before to point `inboard` of this one.
struct LinkedArrays {
    std::vector<double> mass;
    std::vector<Sym3> inertia;                       // about com, B; all zero: a point bead
    std::vector<Vec3> position, velocity;            // of com, W, unwrapped
    std::vector<std::array<double, 4>> orientation;  // unit quaternion w x y z of B in W
    std::vector<Vec3> omega;                         // B
    std::vector<Vec3> inboard, outboard;  // ends of the links from com, B; a point bead: zero
    std::vector<double>
        length;  // of the inboard link; entry 0 counts only for a fixed base (from the anchor)
    CarriedBeads carried;        // positions from com, B; a point bead carries itself
    Vec3 anchor = Vec3::zero();  // W, fixed base

    bool is_bead(std::size_t k) const { return inertia[k].data[0] == 0; }
    std::size_t size() const { return mass.size(); }
};

/// A joint from the last body to the ground, or to the first body, which makes the chain a ring.
/// Its joint frame J is fixed in the last body as every joint's in its inboard body; on the other
/// side stands a frame G in the place of an outboard body's. At rest in the ground it is where the
/// start puts it: G = J X(q). In a ring it is the first body's B, and q means nothing. A link
/// instead runs from the last bead to the ground point `anchor`, in a ring to the first bead.
struct TipJoint {
    bool ring = false;
    JointType type = JointType::spherical;
    Vec3 axis = Vec3::zero(), first_axis = Vec3::zero();
    double pitch = 0;
    Mat3 rotation = Mat3::identity();
    Vec3 translation = Vec3::zero();
    std::array<double, 4> q{0, 0, 0, 0};  // as BodyArrays::q
    std::optional<Vec3> anchor;  // W: where G's origin must be (closure error above 1e-9 of the
                                 // chain's reach: refused); link: needed
    double length = 0;           // link; 0: the distance at the start
};

/// Point beads on rigid links; entry k is bead k + 1 and the link on its inboard side.
struct BeadArrays {
    std::vector<double> mass;
    std::vector<Vec3> position;  // W, unwrapped
    std::vector<Vec3> velocity;  // W
    std::vector<double>
        length;  // of the inboard link; entry 0 counts only for a fixed base (from the anchor)
    std::vector<std::string>
        residue;  // three-letter names for topology and force parameters; "UNK" where none is given
    Vec3 anchor = Vec3::zero();  // W, fixed base

    std::size_t size() const { return mass.size(); }
};

/// One chain. Exactly one of `beads`, `bodies` and `linked` is filled. A scene's `count: N` becomes
/// N such chains.
struct ChainSpec {
    std::string name;
    Base base = Base::free;
    Tip tip = Tip::free;
    TipJoint tip_joint;  // of a jointed tip
    StartVelocities velocities = StartVelocities::given;
    BeadArrays beads;
    BodyArrays bodies;
    LinkedArrays linked;

    bool is_beads() const { return beads.size() > 0; }
    bool is_linked() const { return linked.size() > 0; }
    bool is_ring() const { return tip == Tip::jointed && tip_joint.ring; }
    std::size_t size() const { return beads.size() + bodies.size() + linked.size(); }
    CarriedBeads const& carried() const { return is_linked() ? linked.carried : bodies.carried; }
    /// Points that OpenMM knows: beads, and those that bodies carry.
    std::size_t bead_count() const { return is_beads() ? beads.size() : carried().size(); }
};

struct OpenMmSpec {
    std::string builder;   // "calvados2", or empty when `system` is given
    std::string system;    // serialised System XML, path resolved against the scene's folder
    std::string topology;  // PDB
    std::vector<std::pair<std::string, std::pair<std::int64_t, std::int64_t>>>
        map;  // chain name -> first and last particle; empty: the topology's chains in order;
              // builder: charged ends
    double temperature = 300;      // K
    double ionic_strength = 0.15;  // mol/l
    std::optional<double> ph;      // charge of histidine: 1 / (1 + 10^(pH - 6)); not given: neutral
    double switch_width =
        0;  // nm before each cutoff over which the pair terms are switched off; 0: cut as published
    std::string platform;   // empty: CUDA with backend cuda where present, else CPU where present,
                            // else Reference
    std::string precision;  // GPU platforms
    int threads = 0;        // per rank; 0: cores / ranks
    int device = -1;
    std::string path = "auto";  // auto | device (positions and forces stay on the GPU) | host
                                // (worker thread) | inline
    bool overlap =
        true;  // the chains' own work goes on while forces are computed (paths device and host)
    std::string layers = "auto";  // auto | all | none: forces that reach far and act on few beads
                                  // in Contexts of their own
    std::string split = "auto";   // auto | ghosts | pairs: what ranks on GPUs share out
    bool replicate = false;
    bool audit = false;  // compares the ghosts with a search among all beads at every evaluation
    std::vector<int> force_groups;  // empty: all
};

struct ForceSpec {
    Vec3 gravity = Vec3::zero();               // W
    double linear_drag = 0, angular_drag = 0;  // of every body that has none of its own
    std::optional<OpenMmSpec> openmm;
};

enum class Integrator {
    rk4,
    dormand_prince,
    velocity_verlet,
    staggered,
    baoab,
    implicit_baoab,
    rattle,
    g_baoab,
    implicit_g_baoab
};
/// Whether the state is in joint coordinates (else: absolute ones).
inline bool uses_joint_coordinates(Integrator i) { return i < Integrator::rattle; }
/// Whether springs and dampers of joints are taken implicitly.
inline bool is_implicit(Integrator i) {
    return i == Integrator::staggered || i == Integrator::implicit_baoab ||
           i == Integrator::implicit_g_baoab;
}
/// An implicit integrator's spring K acts within a step h as a rotor of inertia c h^2 K in its
/// joint: c. 1/4 is the least that is stable where K is constant (src/dca/README.md, "Implicit
/// joint springs"); 1/2 leaves room for what bending and turning add to K. Under a thermostat a
/// joint turns by its thermal angle / sqrt(c) per step; anharmonic terms within that shift
/// equilibrium: 2 has a quarter of it.
inline double rotor_of_spring(Integrator i) { return i == Integrator::staggered ? 0.5 : 2.0; }
/// Whether it has a thermostat.
inline bool is_langevin(Integrator i) {
    return i == Integrator::baoab || i == Integrator::implicit_baoab || i >= Integrator::g_baoab;
}

struct DynamicsSpec {
    bool given = false;  // the scene has a `dynamics` section
    Integrator integrator = Integrator::rattle;
    double step = 0;
    std::int64_t steps = 0;
    double temperature = 300;
    double friction = 0.01;
    std::uint64_t seed = 1;
    double constraint_tolerance = 1e-10;
    double tolerance = 0;  // of an adaptive step; 0: steps are as long as `step` says
    bool fixman = false;   // rigid links sample as stiff springs would
    bool has_steps =
        false;  // the scene says how many: 0 of them are one frame, not a key that is missing

    /// Why a GPU cannot do it; empty where it can.
    std::string why_host_alone() const;
};

enum class Backend { automatic, serial, segments, openmp, cuda, cuda_levels };
inline bool uses_gpu(Backend backend) {
    return backend == Backend::cuda || backend == Backend::cuda_levels;
}
/// Directions that handles carry: those that joints restrict, or all. articulated: all, of runs
/// held at their inboard side (dca/articulated.hpp), where nothing cancels.
enum class Handles { projected, full, articulated };
inline bool carries_all(Handles handles) { return handles != Handles::projected; }

/// Of the backend cuda-levels: how many of the tree's lowest levels of merges the GPU assembles
/// (`up`) and disassembles (`down`); from 1 on the bodies themselves are the GPU's too. Numbers
/// beyond the tree's levels mean all of them.
struct GpuLevels {
    static constexpr int all = 1000;
    int up = all, down = all;
};

struct SolverSpec {
    Backend backend = Backend::automatic;
    Handles handles = Handles::projected;
    int threads = 0;                  // 0: cores / ranks on this host
    std::string gpu_levels = "auto";  // as GpuLevels: auto, all, "K", "UP,DOWN"
    int refine = 0;                   // steps of refinement of every solution in joint coordinates
    std::optional<SimdLevel> simd;    // none: the best that all ranks can run
    bool balance = false;  // ranks' shares of the bodies by their speeds, which a run measures

    /// `auto`, where no planner has chosen: all.
    GpuLevels levels_on_gpu() const;
    /// Whether the tree is the chapter's, of pairs from the leaves on.
    bool pairwise() const { return backend == Backend::serial || backend == Backend::cuda_levels; }
};

struct OutputSpec {
    std::int64_t every = 100;              // steps between frames and observables
    std::int64_t checkpoint_every = 0;     // 0: none by steps
    std::vector<std::string> observables;  // columns, in order; empty: the default set
    bool joint_forces = false;             // constraint forces in the trajectory
    bool velocities = false;               // velocities in the trajectory
    bool coordinates =
        false;  // orientations of bodies, joint coordinates and rates in the trajectory
    float checkpoint_minutes = 30;  // of wall time between checkpoints; 0: none by time
};

/// How far the reader moved the positions that the user gave: links take their lengths, wrapped
/// chains are made whole, overlaps relaxed.
struct StartChange {
    double link = 0;       // largest change of a link's length
    double position = 0;   // largest displacement of a bead, without whole box edges
    std::string link_at;   // "chain `a`, beads 19 and 20: 9.31 to 0.38 nm"; empty: no link changed
    std::string moved_at;  // "chain `a`, bead 20"; empty: no bead moved
};

struct Scene {
    std::string title;
    bool si = false;  // units: si
    std::vector<ChainSpec> chains;
    std::optional<Vec3> box;  // edges of the periodic box
    ForceSpec forces;
    DynamicsSpec dynamics;
    SolverSpec solver;
    OutputSpec output;
    bool relax = false;  // overlaps of the start are relaxed before the first step
    StartChange start;
    std::vector<std::string>
        notes;  // what the reader assumed, changed or left out: a sentence each, in the order met
    std::string file;  // as the user named it
    std::string hash;  // of what decides the motion (not of solver, output and dynamics.steps):
                       // guards restarts

    double boltzmann() const { return si ? 1.380649e-23 : 0.00831446261815324; }
    std::int64_t bodies() const;
    /// Adds a note unless it is there.
    void note(std::string text);
};

char const* name_of(JointType);
char const* name_of(Integrator);
char const* name_of(Backend);
char const* name_of(Handles);

}  // namespace catena
