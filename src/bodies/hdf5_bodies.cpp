// Implements the reader of rigid bodies from HDF5 datasets.
#include "bodies/hdf5_bodies.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <span>

#include "bodies/hdf5_table.hpp"
#include "bodies/joint_entry.hpp"
#include "bodies/physics.hpp"
#include "error.hpp"
#include "io/trial.hpp"
#include "joints/joint_models.hpp"
#include "keys/maps.hpp"
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

Vec3 vector_at(double const* v) { return {{v[0], v[1], v[2]}}; }

/// Reads all datasets of one file, with one check per body and quantity.
class Hdf5Bodies {
  public:
    Hdf5Bodies(std::string const& path, Base base) : table_(path, "mass"), base_(base) {}

    /// Reads the datasets in the order of their dependencies: joints decide which numbers a body
    /// needs.
    ChainSpec read() {
        refuse_unknown();
        read_masses();
        read_joints();
        read_frames();
        read_axes();
        read_state();
        read_forces();
        return std::move(chain_);
    }

  private:
    /// The datasets as force terms read them (ForceTerm::read_table()).
    struct Loads {
        Hdf5Bodies& file;

        bool has(char const* name) const { return file.table_.has(name); }
        /// Throws InputError if the dataset is absent.
        void need(char const* name, char const* remedy) const { file.need(name, remedy); }
        /// Reads three numbers per body; check(k, v) takes them.
        template <class Check>
        void vectors(char const* name, std::vector<Vec3>& into, Check const& check) const {
            file.vectors(name, into, check);
        }
        /// Reads a number per coordinate of each joint.
        void coordinates(char const* name, std::vector<Vec3>& into) const {
            file.vectors(name, into, [&](std::size_t k, Vec3& v) {
                file.refuse_unused(name, k, v.data, file.count(k));
            });
        }
        /// Reads such numbers and refuses negative ones.
        void resistances(char const* name, std::vector<Vec3>& into) const {
            file.resistances(name, into);
        }
        void positions(char const* name, std::vector<std::array<double, 4>>& into) const {
            file.positions(name, into);
        }
        /// Reads `width` numbers per body, if the dataset is there; make(k, numbers) returns the
        /// entry.
        template <class Entry, class Make>
        void rows(char const* name, std::size_t width, std::vector<Entry>& into,
                  Make const& make) const {
            if (!has(name)) return;
            into.resize(file.table_.rows());
            file.table_.for_each(name, {{width}}, [&](std::size_t k, double const* v, std::size_t) {
                into[k] = make(k, v);
            });
        }
        [[noreturn]] void refuse_negative(char const* name, std::size_t k,
                                          std::span<double const> v) const {
            file.table_.refuse(name, k, fmt::format("{} {} is negative", name, fmt::join(v, ", ")),
                               "give 0 or positive numbers");
        }
    };

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
    /// Throws InputError if the dataset is missing; `why` is the reason in the message.
    void need(char const* name, std::string const& why) const {
        if (!table_.has(name))
            table_.refuse(name, Hdf5Table::whole, "the dataset is missing", "add it: " + why);
    }
    /// Throws InputError for body k if there is a fault.
    void refuse(char const* name, std::size_t k, std::optional<Fault> const& fault) const {
        if (fault) table_.refuse(name, k, fault->what, fault->remedy);
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
        vectors("com", bodies_.com, [](std::size_t, Vec3&) {});
        need("inertia", "one tensor per body, about its centre of mass");
        bodies_.inertia.resize(table_.rows());
        table_.for_each(
            "inertia", {{3, 3}, {6}}, [&](std::size_t k, double const* v, std::size_t width) {
                Mat3 const m = width == 9
                                   ? Mat3{{v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]}}
                                   : Mat3{{v[0], v[1], v[3], v[1], v[2], v[4], v[3], v[4], v[5]}};
                refuse("inertia", k, make_inertia(m, bodies_.inertia[k]));
            });
    }

    /// Reads a dataset [n, 3]; zeros if it is absent. `check(k, vector)` may change the vector of
    /// row k.
    template <class Check>
    void vectors(char const* name, std::vector<Vec3>& into, Check check) {
        into.assign(table_.rows(), Vec3::zero());
        if (!table_.has(name)) return;
        table_.for_each(name, {{3}}, [&](std::size_t k, double const* v, std::size_t) {
            into[k] = vector_at(v);
            check(k, into[k]);
        });
    }

    /// Reads `joint_type` [n]: names, or the codes of the joint models.
    void read_joints() {
        need("joint_type", "one number or one name per body");
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
        vectors("translation", bodies_.translation, [](std::size_t, Vec3&) {});
        bodies_.rotation.assign(table_.rows(), Mat3::identity());
        if (!table_.has("rotation")) return;
        table_.for_each("rotation", {{3, 3}}, [&](std::size_t k, double const* v, std::size_t) {
            Mat3& r = bodies_.rotation[k];
            std::copy(v, v + 9, r.data);
            refuse("rotation", k, make_rotation(r));
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
                need("axis",
                     fmt::format("body {} has a {} joint", k + 1, name_of(bodies_.joint[k])));
                break;
            }
        vectors("axis", bodies_.axis, [&](std::size_t k, Vec3& axis) {
            if (!has_axis(k)) return void(axis = Vec3::zero());
            refuse("axis", k, make_direction(axis));
        });
        if (any(has_two_axes)) {
            need("first_axis", "there are joints with two axes");
            vectors("first_axis", bodies_.first_axis, [&](std::size_t k, Vec3& axis) {
                if (!has_two_axes(bodies_.joint[k])) return void(axis = Vec3::zero());
                refuse("first_axis", k, make_direction(axis));
                refuse("first_axis", k, check_axes(bodies_.joint[k], axis, bodies_.axis[k]));
            });
        }
        if (!any(has_pitch)) return;
        need("pitch", "there are helical joints");
        bodies_.pitch.assign(table_.rows(), 0);
        table_.for_each("pitch", {{}}, [&](std::size_t k, double const* v, std::size_t) {
            if (!has_pitch(bodies_.joint[k])) return;
            if (v[0] == 0)
                table_.refuse("pitch", k, "a helical joint without pitch",
                              "give its shift per radian, or use a revolute joint");
            bodies_.pitch[k] = v[0];
        });
    }

    /// Reads a dataset [n, 4] of joint positions. Joints without coordinates may have an identity.
    void positions(char const* name, std::vector<std::array<double, 4>>& into) {
        into.resize(table_.rows());
        for (std::size_t k = 0; k < table_.rows(); ++k) into[k] = rest_position(bodies_.joint[k]);
        if (!table_.has(name)) return;
        table_.for_each(name, {{4}}, [&](std::size_t k, double const* v, std::size_t) {
            if (turns(k)) {
                std::copy(v, v + 4, into[k].begin());
                refuse(name, k, make_unit(into[k]));
            } else {
                std::copy(v, v + count(k), into[k].begin());
                refuse(name, k, check_range(into[k]));
                if (count(k) > 0 || v[0] != 1) refuse_unused(name, k, {v, 4}, count(k));
            }
        });
    }
    /// True if the position of joint k is a quaternion.
    bool turns(std::size_t k) const { return has_quaternion(bodies_.joint[k]); }

    /// Reads `q` [n, 4], `qd` [n, 3], `free_position` [3] and `free_velocity` [3].
    void read_state() {
        positions("q", bodies_.q);
        vectors("qd", bodies_.qd, [&](std::size_t k, Vec3& v) {
            refuse_unused("qd", k, v.data, rates_of_joint(bodies_.joint[k]));
        });
        table_.vector("free_position", bodies_.free_base.position.data);
        table_.vector("free_velocity", bodies_.free_base.velocity.data);
    }
    /// Number of coordinates of joint k; 0 for a free joint.
    int count(std::size_t k) const { return numbers_of(bodies_.joint[k]); }
    /// Throws InputError for a number other than 0 beyond the `count` that joint k has.
    void refuse_unused(char const* name, std::size_t k, std::span<double const> v,
                       int count) const {
        for (std::size_t i = static_cast<std::size_t>(count); i < v.size(); ++i)
            if (v[i] != 0)
                table_.refuse(name, k,
                              fmt::format("number {} of {} is {:.6g}, and a {} joint has {}", i + 1,
                                          name, v[i], name_of(bodies_.joint[k]), count),
                              "write 0 there");
    }

    /// Reads a dataset of stiffness or damping and refuses negative numbers.
    void resistances(char const* name, std::vector<Vec3>& into) {
        vectors(name, into, [&](std::size_t k, Vec3& v) {
            refuse_unused(name, k, v.data, count(k));
            for (double const x : v.data)
                if (!(x >= 0))
                    table_.refuse(name, k, fmt::format("{} {} is negative", name, x),
                                  "give 0 or positive numbers");
        });
    }

    /// Reads the datasets of force terms, which are all optional.
    void read_forces() {
        Loads loads{*this};
        terms::for_each([&](auto term) { decltype(term)::read_table(loads, chain_); });
    }

    Hdf5Table table_;
    Base base_;
    ChainSpec chain_;
    BodyArrays& bodies_ = chain_.bodies;
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
