// Binds topologies of frames: the chains of a scene's sites, or those that Python names.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "catena/content.hpp"
#include "catena/errors.hpp"
#include "observe/sites.hpp"

namespace catena::python {
namespace {

/// Sites of a scene, with their positions on the bodies.
class SceneSites {
  public:
    explicit SceneSites(Scene scene) {
        scene.output.coordinates = false;  // frames hold positions alone
        sites_ = Sites(scene);
    }
    Topology const& topology() const { return sites_.topology(); }
    /// Returns the positions of all sites [site][component] from those of the bodies.
    nb::object positions(Numbers<2> const& position, Numbers<2> const& orientation) const {
        SceneBodies bodies;
        std::size_t const count = position.shape(0);
        if (orientation.shape(0) != count || position.shape(1) != 3 || orientation.shape(1) != 4)
            throw Error("the arrays have the wrong shape (positions): give those of a state",
                        Error::Reason::input);
        for (std::size_t k = 0; k < count; ++k) {
            double const *const x = position.data() + 3 * k, *const q = orientation.data() + 4 * k;
            bodies.motion.position.push_back({x[0], x[1], x[2]});
            bodies.motion.orientation.push_back({q[0], q[1], q[2], q[3]});
        }
        Frame const frame = sites_.part(bodies, false, this_thread());
        std::vector<Triple> rows;
        for (Vec3 const& x : frame.positions) rows.push_back(as_triple(x));
        return copy_of<3>(rows);
    }

  private:
    Sites sites_;
};

Topology topology_of(std::vector<std::tuple<std::string, std::int64_t>> const& chains, bool rings,
                     std::vector<double> masses, std::vector<std::string> residues,
                     std::optional<std::tuple<double, double, double>> const& box, bool si,
                     std::vector<std::vector<std::int64_t>> parents) {
    Topology topology;
    std::int64_t first = 0;
    for (auto const& [name, count] : chains) {
        topology.chains.push_back({name, first, count, true, rings});
        first += count;
    }
    for (std::size_t c = 0; c < std::min(parents.size(), topology.chains.size()); ++c)
        topology.chains[c].parent = std::move(parents[c]);
    topology.mass = std::move(masses);
    topology.residue = std::move(residues);
    if (box) topology.box = {std::get<0>(*box), std::get<1>(*box), std::get<2>(*box)};
    topology.si = si;
    return topology;
}

/// Returns name, first site, number of sites, and whether it is a ring, of each chain.
auto chains_of(Topology const& topology) {
    std::vector<std::tuple<std::string, std::int64_t, std::int64_t, bool>> chains;
    for (Topology::Chain const& each : topology.chains)
        chains.emplace_back(each.name, each.first, each.count, each.ring);
    return chains;
}

std::optional<std::tuple<double, double, double>> box_of(Topology const& topology) {
    if (!topology.box) return std::nullopt;
    return std::tuple{(*topology.box)[0], (*topology.box)[1], (*topology.box)[2]};
}

}  // namespace

void add_topology(nb::module_& module) {
    nb::class_<Topology>(module, "Topology", "Chains, masses and residues of the sites of frames.")
        .def_static("of", &topology_of, nb::arg("chains"), nb::arg("rings"), nb::arg("masses"),
                    nb::arg("residues"), nb::arg("box").none(), nb::arg("si"), nb::arg("parents"))
        .def_prop_ro("chains", &chains_of)
        .def_prop_ro("masses", [](Topology const& t) { return t.mass; })
        .def_prop_ro("residues", [](Topology const& t) { return t.residue; })
        .def_prop_ro("box", &box_of)
        .def_ro("si", &Topology::si);
    nb::class_<SceneSites>(module, "Sites", "Sites of a scene: beads, and beads on bodies.")
        .def_static(
            "of_model", [](Model const& model) { return SceneSites(model.content().scene()); },
            nb::arg("model"))
        .def_prop_ro("topology", &SceneSites::topology, nb::rv_policy::copy)
        .def("positions", &SceneSites::positions, nb::arg("positions"), nb::arg("orientations"));
}

}  // namespace catena::python
