// Model: a scene in memory. Its parts have the names, defaults and units of the keys of a scene
// file; inputs/keys describes them.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "catena/types.hpp"

namespace catena {

/// Further keys of a scene and their values, in YAML.
using FurtherKeys = std::map<std::string, std::string>;

/// Joint that connects a body to the one it hangs on, as `joint` of a scene. Lists have as many
/// numbers as the type has coordinates; empty lists leave the defaults.
struct Joint {
    /// Name of the type: free, revolute, planar, universal, spherical, prismatic, helical,
    /// cylindrical, planar3 or weld.
    std::string type = "revolute";
    /// Direction of the axis, the same in B and in the joint's frame J.
    std::optional<Triple> axis = {};
    /// The two axes of a universal joint; direction of q[0] and normal of a planar3 joint.
    std::vector<Triple> axes = {};
    /// Origin of J in the inboard body, and J's rotation matrix relative to it, row by row.
    Triple translation{};
    std::optional<std::array<Triple, 3>> rotation = {};
    /// Translation per radian of a helical joint.
    std::optional<double> pitch = {};
    /// Position and rate at the start. A free joint has {x, y, z} and a quaternion in `q`, and the
    /// angular velocity (B) and the velocity (W) in `qd`.
    std::vector<double> q = {}, qd = {};
    /// Torque or force along each coordinate, spring and damping constants, and the springs' rest.
    std::vector<double> torque = {}, stiffness = {}, damping = {}, rest = {};
    FurtherKeys keys = {};
};

/// Rigid body, as an entry of `bodies` of a scene.
struct Body {
    double mass = 0;
    /// Inertia about the centre of mass, B.
    std::array<Triple, 3> inertia{};
    /// Centre of mass from the body's origin, B.
    Triple com{};
    /// Absent for body 1 of a chain with a free base, and if `keys` has one.
    std::optional<Joint> joint = {};
    FurtherKeys keys = {};
    /// Number of the body on which it hangs, counted from 1; absent for the body before.
    std::optional<std::int64_t> parent = {};
};

/// Point mass on a rigid link to the bead before it, or to another one.
struct Bead {
    double mass = 0;
    /// Position at the start, W.
    Triple position{};
    std::optional<Triple> velocity = {};
    /// Length of the link; absent for the distance in the positions.
    std::optional<double> length = {};
    /// Three-letter name; empty for a bead without one.
    std::string residue = {};
    /// Number of the bead on which it hangs, counted from 1; absent for the bead before.
    std::optional<std::int64_t> parent = {};
};

/// Chain of bodies or of beads; exactly one of the two lists is filled.
struct Chain {
    std::string name = {};
    std::vector<Body> bodies = {};
    std::vector<Bead> beads = {};
    /// True if a joint or link connects the first body or bead to the ground.
    bool fixed_base = false;
    /// Point of the ground where the first link of beads on a fixed base begins.
    std::optional<Triple> anchor = {};
    FurtherKeys keys = {};
};

/// Units of all numbers: nm, ps, amu, kJ/mol, or SI.
enum class Units { md, si };

/// A scene in memory. Solver and Simulation read and check it when they are made.
class Model {
  public:
    /// Makes a scene without chains.
    explicit Model(Units units = Units::md);
    /// Reads a scene file. Throws Error if the file cannot be read.
    static Model from_file(std::string const& path);
    /// Makes a scene of the text of a scene file.
    static Model from_text(std::string const& yaml);
    ~Model();
    Model(Model const&);
    Model(Model&&) noexcept;
    Model& operator=(Model const&);
    Model& operator=(Model&&) noexcept;

    /// Adds a chain. Throws Error if the scene was made of a file or text.
    Model& add(Chain const& chain);
    /// Sets a key of the scene to a value in YAML, as the option --set does:
    /// set("dynamics", "{integrator: rk4, step: 0.001}"), set("solver.backend", "openmp").
    Model& set(std::string const& key, std::string const& value);
    Model& set(std::string const& key, double value);

    /// Returns the number of bodies and beads. Throws Error with the program's message if the scene
    /// is wrong, as do notes(), Solver and Simulation.
    std::int64_t bodies() const;
    /// Returns one sentence each on what the reader assumed, changed or left out.
    std::vector<std::string> notes() const;
    /// Checks what can be checked without a step: the scene, the backend, beads that coincide, and
    /// the time step where joints have springs. Returns notes() and a note on a step near the
    /// limit. Throws Error as `catena check` does. Simulation evaluates the forces of OpenMM.
    std::vector<std::string> check() const;

    /// Text and scene behind a model; for Catena's own sources.
    class Content;
    Content const& content() const { return *content_; }

  private:
    explicit Model(std::unique_ptr<Content> content);
    std::unique_ptr<Content> content_;
};

}  // namespace catena
