// Implements the readers of datasets by what their numbers mean.
#include "bodies/body_datasets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bodies/joint_entry.hpp"
#include "joints/joint_models.hpp"

namespace catena::scene {

void BodyDatasets::need(char const* name, std::string const& why) const {
    if (!has(name))
        table_.refuse(name, Hdf5Table::whole, "the dataset is missing", "add it: " + why);
}

void BodyDatasets::refuse(char const* name, std::size_t k,
                          std::optional<Fault> const& fault) const {
    if (fault) table_.refuse(name, k, fault->what, fault->remedy);
}

void BodyDatasets::refuse_negative(char const* name, std::size_t k,
                                   std::span<double const> v) const {
    table_.refuse(name, k, fmt::format("{} {} is negative", name, fmt::join(v, ", ")),
                  "give 0 or positive numbers");
}

void BodyDatasets::refuse_unused(char const* name, std::size_t k, std::span<double const> v,
                                 int count) const {
    for (std::size_t i = static_cast<std::size_t>(count); i < v.size(); ++i)
        if (v[i] != 0)
            table_.refuse(name, k,
                          fmt::format("number {} of {} is {:.6g}, and a {} joint has {}", i + 1,
                                      name, v[i], name_of(joints_[k]), count),
                          "write 0 there");
}

void BodyDatasets::coordinates(char const* name, std::vector<Vec3>& into) const {
    vectors(name, into, [&](std::size_t k, Vec3 const& v) {
        refuse_unused(name, k, v.data, numbers_of(joints_[k]));
    });
}

void BodyDatasets::resistances(char const* name, std::vector<Vec3>& into) const {
    vectors(name, into, [&](std::size_t k, Vec3 const& v) {
        refuse_unused(name, k, v.data, numbers_of(joints_[k]));
        for (double const& x : v.data)
            if (!(x >= 0)) refuse_negative(name, k, {&x, 1});
    });
}

void BodyDatasets::positions(char const* name, std::vector<std::array<double, 4>>& into) const {
    into.resize(table_.rows());
    for (std::size_t k = 0; k < table_.rows(); ++k) into[k] = rest_position(joints_[k]);
    if (!has(name)) return;
    table_.for_each(name, {{4}}, [&](std::size_t k, double const* v, std::size_t) {
        if (has_quaternion(joints_[k])) {
            std::copy(v, v + 4, into[k].begin());
            refuse(name, k, make_unit(into[k]));
            return;
        }
        int const count = numbers_of(joints_[k]);
        std::copy(v, v + count, into[k].begin());
        refuse(name, k, check_range(into[k]));
        if (count > 0 || v[0] != 1) refuse_unused(name, k, {v, 4}, count);
    });
}

}  // namespace catena::scene
