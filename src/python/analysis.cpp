// Binds analyses of conformations: sizes of chains, and means with their errors.
#include <nanobind/nanobind.h>
#include <nanobind/stl/tuple.h>

#include <cmath>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "analysis/chain_size.hpp"
#include "analysis/estimate.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "catena/errors.hpp"

namespace catena::python {
namespace {

/// Positions [frame][site][component] of one chain.
using Frames = Numbers<3>;

/// New array of numbers, which Python owns.
using Values = nb::ndarray<nb::numpy, double, nb::ndim<1>>;

/// Returns numbers as an array of Python's.
Values array_of(std::vector<double> numbers) {
    auto* const kept = new std::vector<double>(std::move(numbers));
    nb::capsule const owner(kept,
                            [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
    return Values(kept->data(), {kept->size()}, owner);
}

/// Returns value(sites) of every frame.
template <class Value>
Values of_frames(Frames const& positions, Value const& value) {
    std::size_t const frames = positions.shape(0), sites = positions.shape(1);
    std::vector<double> values(frames);
    std::vector<Vec3> x(sites);
    {
        nb::gil_scoped_release const free;
        double const* next = positions.data();
        for (double& of_frame : values) {
            for (Vec3& site : x)
                for (int i = 0; i < 3; ++i) site[i] = *next++;
            of_frame = value(x);
        }
    }
    return array_of(std::move(values));
}

void require_sites(Frames const& positions, std::size_t least) {
    if (positions.shape(2) != 3 || positions.shape(1) < least)
        throw Error(
            "the positions have the wrong shape (positions): give an array of frames, "
            "sites and 3 components",
            Error::Reason::input);
}

Values radius_of_gyration(Frames const& positions, Numbers<1> const& masses) {
    require_sites(positions, 1);
    std::span<double const> const mass(masses.data(), masses.shape(0));
    if (mass.size() != positions.shape(1))
        throw Error("the number of masses is not that of the sites (masses): give one per site",
                    Error::Reason::input);
    for (double const m : mass)
        if (!(m > 0) || !std::isfinite(m))
            throw Error("a mass is not positive (masses): leave out sites without mass",
                        Error::Reason::input);
    return of_frames(positions, [&](std::vector<Vec3> const& x) {
        return analysis::gyration_of(x, mass).radius();
    });
}

Values end_to_end_distance(Frames const& positions) {
    require_sites(positions, 2);
    return of_frames(positions,
                     [](std::vector<Vec3> const& x) { return norm(x.back() - x.front()); });
}

/// Returns mean, error, whether it is a plateau, and the error between copies.
std::tuple<double, double, bool, double> estimate(Numbers<2> const& values) {
    if (values.size() == 0)
        throw Error("there are no values (values): give at least one frame", Error::Reason::input);
    analysis::CopyValues all(values.shape(1));
    for (std::size_t i = 0; i < values.size(); ++i) all.add(values.data()[i]);
    analysis::Estimate const found = all.estimate();
    return {found.mean, found.error, found.plateau, found.between};
}

}  // namespace

void add_analysis(nb::module_& module) {
    module.def("radius_of_gyration", &radius_of_gyration, nb::arg("positions"), nb::arg("masses"));
    module.def("end_to_end_distance", &end_to_end_distance, nb::arg("positions"));
    module.def("estimate", &estimate, nb::arg("values"));
}

}  // namespace catena::python
