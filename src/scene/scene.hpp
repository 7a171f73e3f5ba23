// What the user describes, validated: plain data, whole on every rank, in the units of the scene.
// Frames: W ground axes, B body axes, J joint frame (fixed in the inboard body, `rotation` and `translation`).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dca/linear.hpp"
#include "dca/rotation.hpp"

namespace catena {

enum class JointType : std::uint8_t { free, link, spherical, revolute };
enum class Base { free, fixed };
enum class Tip { free };
enum class StartVelocities { given, zero, thermal };

/// Rigid bodies of one chain; entry k is body k + 1 and its inboard joint. A body's origin is its inboard joint.
/// The last five arrays may be empty, which means zero.
struct BodyArrays {
    std::vector<double> mass;
    std::vector<Vec3> com;                 // from the origin, B
    std::vector<Sym3> inertia;             // about com, B
    std::vector<JointType> joint;          // entry 0 of a free base: JointType::free
    std::vector<Vec3> axis;                // revolute: unit axis, B (and J: the same components)
    std::vector<Mat3> rotation;            // R of the joint frame in the inboard body's axes (entry 0: ground)
    std::vector<Vec3> translation;         // origin of the joint frame from the inboard body's origin, inboard body's axes
    std::vector<std::array<double, 4>> q;  // revolute: {angle, 0, 0, 0}; spherical and free: unit quaternion w x y z of B in J (free: in W)
    std::vector<Vec3> qd;                  // revolute: {rate, 0, 0}; spherical and free: angular velocity relative to the inboard body, B
    Vec3 free_position = Vec3::zero();     // free base: origin of body 1, W
    Vec3 free_velocity = Vec3::zero();     // free base: its velocity, W
    std::vector<Vec3> torque;              // joint torque on body k + 1: revolute {t, 0, 0}; spherical: components in B
    std::vector<Vec3> stiffness;           // revolute {k, 0, 0}; spherical: on the components of the rotation vector from `rest`
    std::vector<Vec3> damping;             // on qd, as stiffness
    std::vector<std::array<double, 4>> rest;    // as q
    std::vector<std::pair<Vec3, Vec3>> wrench;  // external {torque, force} at com, W

    std::size_t size() const { return mass.size(); }
};

/// Point beads on rigid links; entry k is bead k + 1 and the link on its inboard side.
struct BeadArrays {
    std::vector<double> mass;
    std::vector<Vec3> position;        // W, unwrapped
    std::vector<Vec3> velocity;        // W
    std::vector<double> length;        // of the inboard link; entry 0 counts only for a fixed base (from the anchor)
    std::vector<std::string> residue;  // three-letter names for topology and force parameters; "UNK" where none is given
    Vec3 anchor = Vec3::zero();        // W, fixed base

    std::size_t size() const { return mass.size(); }
};

/// One chain. Exactly one of `beads` and `bodies` is filled. A scene's `count: N` becomes N such chains.
struct ChainSpec {
    std::string name;
    Base base = Base::free;
    Tip tip = Tip::free;
    StartVelocities velocities = StartVelocities::given;
    BeadArrays beads;
    BodyArrays bodies;

    bool is_beads() const { return beads.size() > 0; }
    std::size_t size() const { return beads.size() + bodies.size(); }
};

struct OpenMmSpec {
    std::string builder;   // "calvados2", or empty when `system` is given
    std::string system;    // serialised System XML, path resolved against the scene's folder
    std::string topology;  // PDB
    std::vector<std::pair<std::string, std::pair<std::int64_t, std::int64_t>>>
        map;                       // chain name -> first and last particle; empty: the topology's chains in order
    double temperature = 300;      // K
    double ionic_strength = 0.15;  // mol/l
    std::optional<double> ph;      // charge of histidine: 1 / (1 + 10^(pH - 6)); not given: neutral
    double switch_width = 0;       // nm before each cutoff over which the pair terms are switched off; 0: cut as published
    std::string platform;          // empty: CPU where present, else Reference
    std::string precision;         // GPU platforms
    int threads = 0;               // per rank; 0: cores / ranks
    int device = -1;
    std::string path = "auto";  // auto | host (worker thread) | inline; device: not in this version
    bool replicate = false;
    std::vector<int> force_groups;  // empty: all
};

struct ForceSpec {
    Vec3 gravity = Vec3::zero();  // W
    std::optional<OpenMmSpec> openmm;
};

enum class Integrator { rk4, rattle, g_baoab };

struct DynamicsSpec {
    bool given = false;  // the scene has a `dynamics` section
    Integrator integrator = Integrator::rattle;
    double step = 0;
    std::int64_t steps = 0;
    double temperature = 300;
    double friction = 0.01;
    std::uint64_t seed = 1;
    double constraint_tolerance = 1e-10;
};

enum class Backend { automatic, serial, segments, openmp, cuda, cuda_levels };
enum class Handles { projected, full };

struct SolverSpec {
    Backend backend = Backend::automatic;
    Handles handles = Handles::projected;
    int threads = 0;  // 0: cores / ranks on this host
    std::string gpu_levels = "auto";
};

struct OutputSpec {
    std::int64_t every = 100;              // steps between frames and observables
    std::int64_t checkpoint_every = 0;     // 0: only at the end
    std::vector<std::string> observables;  // columns, in order; empty: the default set
    bool joint_forces = false;             // constraint forces in the trajectory
    bool velocities = false;               // velocities in the trajectory
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
    std::string file;  // as the user named it
    std::string hash;  // of what decides the motion (not of solver, output and dynamics.steps): guards restarts

    double boltzmann() const { return si ? 1.380649e-23 : 0.00831446261815324; }
    std::int64_t bodies() const;
};

/// Reads and validates a scene file. `overrides`: "key.path=value" with list indices as in "chains[0].count=10".
/// Throws InputError with one line that names file, key, body index and remedy.
Scene load_scene(std::string const& file, std::vector<std::string> const& overrides = {});

/// As load_scene, from text; `name` stands for the file in messages and its folder resolves relative paths.
Scene parse_scene(std::string const& text, std::string const& name, std::vector<std::string> const& overrides = {});

char const* name_of(JointType);
char const* name_of(Integrator);
char const* name_of(Backend);
char const* name_of(Handles);

}  // namespace catena
