// Datasets of rigid bodies on joints, with one check per body and quantity.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bodies/hdf5_table.hpp"
#include "bodies/physics.hpp"
#include "math/linear.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Readers of a table's datasets by what their numbers mean. Force terms read theirs with it
/// (ForceTerm::read_table()).
class BodyDatasets {
  public:
    /// The arguments must outlive the object. `joints`: types of the bodies' joints, which may be
    /// read later than this object is made.
    BodyDatasets(Hdf5Table const& table, std::vector<JointType> const& joints)
        : table_(table), joints_(joints) {}

    bool has(char const* name) const { return table_.has(name); }
    /// Throws InputError if the dataset is missing; `why` is the reason in the message.
    void need(char const* name, std::string const& why) const;
    /// Throws InputError for body k if there is a fault.
    void refuse(char const* name, std::size_t k, std::optional<Fault> const& fault) const;
    /// Throws InputError for numbers of body k of which one is negative.
    [[noreturn]] void refuse_negative(char const* name, std::size_t k,
                                      std::span<double const> v) const;
    /// Throws InputError for a number other than 0 beyond the `count` that joint k has.
    void refuse_unused(char const* name, std::size_t k, std::span<double const> v, int count) const;

    /// Reads a dataset [n, 3]; zeros if it is absent. `check(k, vector)` may change the vector of
    /// row k.
    template <class Check>
    void vectors(char const* name, std::vector<Vec3>& into, Check const& check) const {
        into.assign(table_.rows(), Vec3::zero());
        if (!table_.has(name)) return;
        table_.for_each(name, {{3}}, [&](std::size_t k, double const* v, std::size_t) {
            into[k] = Vec3{{v[0], v[1], v[2]}};
            check(k, into[k]);
        });
    }
    /// Reads `width` numbers per body, if the dataset is there; make(k, numbers) returns the entry.
    template <class Entry, class Make>
    void rows(char const* name, std::size_t width, std::vector<Entry>& into,
              Make const& make) const {
        if (!has(name)) return;
        into.resize(table_.rows());
        table_.for_each(name, {{width}},
                        [&](std::size_t k, double const* v, std::size_t) { into[k] = make(k, v); });
    }
    /// Reads a number per coordinate of each joint.
    void coordinates(char const* name, std::vector<Vec3>& into) const;
    /// Reads stiffness or damping per coordinate of each joint, and refuses negative numbers.
    void resistances(char const* name, std::vector<Vec3>& into) const;
    /// Reads a dataset [n, 4] of joint positions. Joints without coordinates may have an identity.
    void positions(char const* name, std::vector<std::array<double, 4>>& into) const;

  private:
    Hdf5Table const& table_;
    std::vector<JointType> const& joints_;
};

}  // namespace catena::scene
