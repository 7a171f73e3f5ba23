// Binds the analyses of `catena analyse` on arrays of positions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "analysis/analysis.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "catena/content.hpp"

namespace catena::python {
namespace {

using Frames = Numbers<3>;

/// Reads frames of an array; edges of the box [frame][component] or of a single frame, or none.
class ArrayFrames {
  public:
    ArrayFrames(Frames positions, std::optional<Numbers<2>> edges)
        : positions_(std::move(positions)), edges_(std::move(edges)) {}

    void read(std::size_t frame, Snapshot& into) const {
        std::size_t const sites = positions_.shape(1);
        double const* next = positions_.data() + 3 * sites * frame;
        into.position.resize(sites);
        for (Vec3& site : into.position)
            for (int i = 0; i < 3; ++i) site[i] = *next++;
        if (!edges_) return;
        double const* const edges =
            edges_->data() + (edges_->shape(0) > 1 ? 3 * static_cast<std::ptrdiff_t>(frame) : 0);
        into.box = {edges[0], edges[1], edges[2]};
    }

  private:
    Frames positions_;
    std::optional<Numbers<2>> edges_;
};

nb::dict dict_of(std::vector<analysis::Estimate> const& estimates) {
    std::vector<double> mean, error, between;
    for (analysis::Estimate const& each : estimates) {
        mean.push_back(each.mean);
        error.push_back(each.error);
        between.push_back(each.between);
    }
    nb::dict found;
    found["values"] = mean;
    found["errors"] = error;
    found["between"] = between;
    return found;
}

nb::dict dict_of(analysis::Quantity const& quantity) {
    nb::dict found;
    found["name"] = quantity.name;
    found["kind"] = quantity.kind;
    found["unit"] = quantity.unit;
    found["mean"] = quantity.value.mean;
    found["error"] = quantity.value.error;
    found["plateau"] = quantity.value.plateau;
    found["between"] = quantity.value.between;
    found["basis"] = quantity.basis;
    found["fit"] = std::tuple{quantity.fit.least, quantity.fit.most};
    found["prefactor"] = quantity.prefactor;
    return found;
}

nb::dict dict_of(analysis::Curve const& curve) {
    nb::dict found = dict_of(curve.y);
    found["name"] = curve.name;
    found["kind"] = curve.kind;
    found["variable"] = curve.variable;
    found["variable_unit"] = curve.variable_unit;
    found["unit"] = curve.unit;
    found["x"] = curve.x;
    return found;
}

nb::dict dict_of(analysis::Series const& series) {
    nb::dict found;
    found["name"] = series.name;
    found["kind"] = series.kind;
    found["copies"] = series.values.copies();
    found["values"] = series.values.values();
    return found;
}

nb::dict dict_of(analysis::Analysis const& all, analysis::ContactMap const& map) {
    nb::dict found;
    found["within"] = map.parts.within;
    found["first"] = all.kinds[map.parts.first].name;
    found["second"] = all.kinds[map.parts.second].name;
    found["rows"] = map.rows;
    found["columns"] = map.columns;
    found["mean"] = map.mean;
    found["error"] = map.error;
    return found;
}

nb::dict dict_of(analysis::Analysis const& all) {
    nb::list kinds, quantities, curves, series, maps;
    for (analysis::Kind const& kind : all.kinds)
        kinds.append(std::tuple{kind.name, kind.sites, kind.copies()});
    for (analysis::Quantity const& each : all.quantities) quantities.append(dict_of(each));
    for (analysis::Curve const& each : all.curves) curves.append(dict_of(each));
    for (analysis::Series const& each : all.series) series.append(dict_of(each));
    for (analysis::ContactMap const& each : all.maps) maps.append(dict_of(all, each));
    nb::dict found;
    found["kinds"] = kinds;
    found["quantities"] = quantities;
    found["curves"] = curves;
    found["series"] = series;
    found["maps"] = maps;
    found["frames"] = all.steps.size();
    found["length_unit"] = all.length_unit;
    found["time_unit"] = all.time_unit;
    found["cutoff"] = all.cutoff;
    found["sites_a_row"] = all.sites_a_row;
    found["notes"] = all.notes;
    return found;
}

nb::dict analyse(Topology const& topology, Frames const& positions,
                 std::optional<Numbers<2>> const& edges, std::vector<std::int64_t> const& steps,
                 std::vector<double> const& times, double discard, std::optional<double> cutoff,
                 std::optional<std::tuple<double, double>> const& fit, std::optional<int> slab,
                 bool find_slab, std::size_t bins) {
    ArrayFrames const frames(positions, edges);
    analysis::FrameSource const source{
        "positions", topology, true, false, steps, times, [&](std::size_t frame, Snapshot& into) {
            frames.read(frame, into);
        }};
    analysis::Options options;
    options.discard = discard;
    options.cutoff = cutoff;
    if (fit) options.fit = {std::get<0>(*fit), std::get<1>(*fit)};
    options.slab = slab;
    options.find_slab = find_slab;
    options.bins = bins;
    analysis::Analysis found;
    {
        nb::gil_scoped_release const free;
        found = with_public_errors([&] { return analysis::analyse(source, options); });
    }
    return dict_of(found);
}

}  // namespace

void add_analyse(nb::module_& module) {
    module.def("analyse", &analyse, nb::arg("topology"), nb::arg("positions"),
               nb::arg("edges").none(), nb::arg("steps"), nb::arg("times"), nb::arg("discard"),
               nb::arg("cutoff").none(), nb::arg("fit").none(), nb::arg("slab").none(),
               nb::arg("find_slab"), nb::arg("bins"));
}

}  // namespace catena::python
