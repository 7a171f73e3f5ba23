// The inside of the public classes, which is not installed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "catena/errors.hpp"
#include "catena/scene.hpp"
#include "error.hpp"
#include "math/rotation.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Calls `action` and throws the program's errors as Error. Other exceptions pass.
template <class Action>
auto with_public_errors(Action const& action) {
    try {
        return action();
    } catch (InputError const& error) {
        throw Error(error.what(), Error::Reason::input);
    } catch (ComputationError const& error) {
        throw Error(error.what(), Error::Reason::computation);
    }
}

inline Triple as_triple(Vec3 const& v) { return {v[0], v[1], v[2]}; }
inline UnitQuaternion as_unit_quaternion(Quat const& q) { return {q.w, q.x, q.y, q.z}; }
inline JointForce as_joint_force(Vector<double, 6> const& w) {
    return {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}};
}

/// Text of a scene, and the changes to be made to it.
class Model::Content {
  public:
    /// Text without chains, for chains that are added.
    explicit Content(Units units)
        : text_(units == Units::si ? "units: si\n" : "units: md\n"), name_("scene in memory") {}
    /// Whole text of a scene. `name` is the file's name in messages.
    Content(std::string text, std::string name)
        : text_(std::move(text)), name_(std::move(name)), is_whole_(true) {}

    /// Adds a chain. Throws InputError if the text is whole.
    void add(Chain const&);
    /// Adds a change in the syntax of --set.
    void set(std::string const& change);
    /// Reads the scene, or returns it if it was read since the last change. Throws InputError.
    Scene const& scene() const;

  private:
    std::string text_, name_;
    bool is_whole_ = false;
    std::string chains_;
    std::vector<std::string> changes_;
    mutable std::optional<Scene> read_;
};

}  // namespace catena
