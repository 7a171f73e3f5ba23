// Implements the reader of rigid bodies from HDF5 datasets.
#include "bodies/hdf5_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bodies/body_datasets.hpp"
#include "bodies/hdf5_table.hpp"
#include "bodies/joint_entry.hpp"
#include "bodies/physics.hpp"
#include "error.hpp"
#include "io/trial.hpp"
#include "joints/joint_models.hpp"
#include "keys/maps.hpp"
#include "scene/branches.hpp"
#include "scene/fields.hpp"
#include "terms/force_terms.hpp"

namespace catena::scene {

namespace {

/// Model of a joint type as files name it: by its name or its code.
struct FileType {
    JointType type;
    std::string_view name;
    int code;
};
/// Returns all types of the list of joint models, by their codes.
std::vector<FileType> types_of_files() {
    std::vector<FileType> types;
    for_each_joint([&](auto model) {
        using Model = decltype(model);
        types.push_back({Model::type, Model::name, Model::code});
    });
    std::sort(types.begin(), types.end(),
              [](FileType const& a, FileType const& b) { return a.code < b.code; });
    return types;
}
/// Returns the codes that a file of bodies may use, with their names, for messages.
std::string codes_for_bodies() {
    std::string text;
    for (FileType const& type : types_of_files())
        if (!is_rod(type.type))
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", type.code, type.name);
    return text;
}

/// Reads all datasets of one file.
class Hdf5Bodies {
  public:
    Hdf5Bodies(std::string const& path, Base base) : table_(path, "mass"), base_(base) {}

    /// Reads the datasets in the order of their dependencies: joints decide which numbers a body
    /// needs.
    ChainSpec read() {
        refuse_unknown();
        read_masses();
        read_parents();
        read_joints();
        read_frames();
        read_axes();
        read_state();
        read_forces();
        return std::move(chain_);
    }

  private:
    /// Throws InputError for a dataset that is not declared, with the nearest known name.
    void refuse_unknown() const {
        std::vector<std::string_view> const known = keys::datasets.names();
        for (std::string const& name : table_.names()) {
            if (keys::datasets.find(name)) continue;
            auto const near = nearest(name, known);
            table_.refuse(name, Hdf5Table::whole, "unknown dataset",
                          near ? "did you mean `" + *near + "`?" : "use " + joined(known));
        }
    }
    /// Reads `mass` [n], `com` [n, 3] and `inertia` [n, 3, 3] or [n, 6]. Six numbers are the lower
    /// triangle, row by row.
    void read_masses() {
        bodies_.mass.resize(table_.rows());
        table_.for_each("mass", {{}}, [&](std::size_t k, double const* v, std::size_t) {
            if (!(v[0] > 0))
                table_.refuse("mass", k, fmt::format("mass {} is not positive", v[0]),
                              "give a number above 0");
            bodies_.mass[k] = v[0];
        });
        datasets_.vectors("com", bodies_.com, [](std::size_t, Vec3&) {});
        datasets_.need("inertia", "one tensor per body, about its centre of mass");
        bodies_.inertia.resize(table_.rows());
        table_.for_each(
            "inertia", {{3, 3}, {6}}, [&](std::size_t k, double const* v, std::size_t width) {
                Mat3 const m = width == 9
                                   ? Mat3{{v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]}}
                                   : Mat3{{v[0], v[1], v[3], v[1], v[2], v[4], v[3], v[4], v[5]}};
                datasets_.refuse("inertia", k, make_inertia(m, bodies_.inertia[k]));
            });
    }

    /// Reads `parent` [n]: the number of the body on which each body hangs, from 1; 0 for body 1.
    void read_parents() {
        if (!table_.has("parent")) return;
        std::vector<std::int64_t> inboard(table_.rows());
        table_.for_each("parent", {{}}, [&](std::size_t k, double const* v, std::size_t) {
            auto const before = static_cast<double>(k);
            bool const fits = k == 0 ? v[0] == 0 : v[0] >= 1 && v[0] <= before;
            if (!fits || v[0] != std::floor(v[0]))
                table_.refuse("parent", k, fmt::format("body {} hangs on body {:g}", k + 1, v[0]),
                              k == 0
                                  ? "give 0: body 1 hangs on none"
                                  : fmt::format("give the number of an earlier body, 1 to {}", k));
            inboard[k] = static_cast<std::int64_t>(v[0]) - 1;
        });
        chain_.parent = as_parents(std::move(inboard));
    }

    /// Reads `joint_type` [n]: names, or the codes of the joint models.
    void read_joints() {
        datasets_.need("joint_type", "one number or one name per body");
        bodies_.joint.resize(table_.rows());
        std::vector<FileType> const types = types_of_files();
        auto const find = [&](auto const& is) {
            auto const found = std::find_if(types.begin(), types.end(), is);
            return found == types.end() ? std::nullopt : std::optional(found->type);
        };
        if (table_.is_text("joint_type")) {
            table_.for_each_text("joint_type", [&](std::size_t k, std::string const& text) {
                auto const type = find([&](FileType const& t) { return t.name == text; });
                if (!type)
                    table_.refuse("joint_type", k,
                                  fmt::format("`{}` is not a joint type", shown(text)),
                                  "use the names of `joint.type`");
                set_joint(k, *type);
            });
            return;
        }
        table_.for_each("joint_type", {{}}, [&](std::size_t k, double const* v, std::size_t) {
            auto const type = find([&](FileType const& t) { return t.code == v[0]; });
            if (!type)
                table_.refuse("joint_type", k, fmt::format("{} is not a joint type", v[0]),
                              "use " + codes_for_bodies());
            set_joint(k, *type);
        });
    }

    /// Sets the type of joint k. Throws InputError for links, and for a free joint anywhere but at
    /// body 1 of a free base.
    void set_joint(std::size_t k, JointType type) {
        bool const free = floats(type);
        if (is_rod(type))
            table_.refuse("joint_type", k, "a link in a file of rigid bodies on joints",
                          "write chains of links as a list or a generator");
        if (free && k > 0)
            table_.refuse("joint_type", k, "a free joint inside a chain",
                          "use it for body 1 of a chain with `base: free`");
        if (free && base_ == Base::fixed)
            table_.refuse("joint_type", k, "a free joint on a fixed base",
                          "write `base: free`, or give joint 1 another type");
        if (!free && k == 0 && base_ == Base::free)
            table_.refuse(
                "joint_type", k,
                fmt::format("a {} joint 1 on a free base, which has no joint 1", name_of(type)),
                "write `base: fixed`, or make joint 1 free");
        bodies_.joint[k] = type;
    }

    /// Reads `translation` [n, 3] and `rotation` [n, 3, 3]; by default joint frames coincide with
    /// the inboard body's.
    void read_frames() {
        datasets_.vectors("translation", bodies_.translation, [](std::size_t, Vec3&) {});
        bodies_.rotation.assign(table_.rows(), Mat3::identity());
        if (!table_.has("rotation")) return;
        table_.for_each("rotation", {{3, 3}}, [&](std::size_t k, double const* v, std::size_t) {
            Mat3& r = bodies_.rotation[k];
            std::copy(v, v + 9, r.data);
            datasets_.refuse("rotation", k, make_rotation(r));
        });
    }

    /// True if joint k has an axis.
    bool has_axis(std::size_t k) const {
        JointType const type = bodies_.joint[k];
        return has_one_axis(type) || has_two_axes(type);
    }
    /// True if any joint's type has the property.
    bool any(bool (*has)(JointType)) const {
        return std::any_of(bodies_.joint.begin(), bodies_.joint.end(), has);
    }

    /// Reads `axis` [n, 3], `first_axis` [n, 3] and `pitch` [n]. Axes are normalised; those of
    /// joints without an axis become 0.
    void read_axes() {
        for (std::size_t k = 0; k < table_.rows(); ++k)
            if (has_axis(k)) {
                datasets_.need("axis", fmt::format("body {} has a {} joint", k + 1,
                                                   name_of(bodies_.joint[k])));
                break;
            }
        datasets_.vectors("axis", bodies_.axis, [&](std::size_t k, Vec3& axis) {
            if (!has_axis(k)) return void(axis = Vec3::zero());
            datasets_.refuse("axis", k, make_direction(axis));
        });
        if (any(has_two_axes)) {
            datasets_.need("first_axis", "there are joints with two axes");
            datasets_.vectors("first_axis", bodies_.first_axis, [&](std::size_t k, Vec3& axis) {
                if (!has_two_axes(bodies_.joint[k])) return void(axis = Vec3::zero());
                datasets_.refuse("first_axis", k, make_direction(axis));
                datasets_.refuse("first_axis", k,
                                 check_axes(bodies_.joint[k], axis, bodies_.axis[k]));
            });
        }
        if (!any(has_pitch)) return;
        datasets_.need("pitch", "there are helical joints");
        bodies_.pitch.assign(table_.rows(), 0);
        table_.for_each("pitch", {{}}, [&](std::size_t k, double const* v, std::size_t) {
            if (!has_pitch(bodies_.joint[k])) return;
            if (v[0] == 0)
                table_.refuse("pitch", k, "a helical joint without pitch",
                              "give its shift per radian, or use a revolute joint");
            bodies_.pitch[k] = v[0];
        });
    }

    /// Reads `q` [n, 4], `qd` [n, 3], `free_position` [3] and `free_velocity` [3].
    void read_state() {
        datasets_.positions("q", bodies_.q);
        datasets_.vectors("qd", bodies_.qd, [&](std::size_t k, Vec3& v) {
            datasets_.refuse_unused("qd", k, v.data, rates_of_joint(bodies_.joint[k]));
        });
        table_.vector("free_position", bodies_.free_base.position.data);
        table_.vector("free_velocity", bodies_.free_base.velocity.data);
    }
    /// Reads the datasets of force terms, which are all optional.
    void read_forces() {
        terms::for_each([&](auto term) { decltype(term)::read_table(datasets_, chain_); });
    }

    Hdf5Table table_;
    Base base_;
    ChainSpec chain_;
    BodyArrays& bodies_ = chain_.bodies;
    BodyDatasets datasets_{table_, bodies_.joint};
};

}  // namespace

// The trial runs in a child process and shows whether HDF5 survives the file; its result is lost.
ChainSpec read_hdf5_bodies(std::string const& path, Base base) {
    std::string const end = trial([&] { Hdf5Bodies(path, base).read(); }, limits_for_file(path));
    if (!end.empty())
        throw InputError("the file is damaged, HDF5 fails to read it: " + end, shown_path(path),
                         "write the file again");
    return Hdf5Bodies(path, base).read();
}

}  // namespace catena::scene
