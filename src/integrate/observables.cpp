#include "integrate/observables.hpp"

#include <algorithm>
#include <cmath>

#include "scene/freedom.hpp"

namespace catena {

std::int64_t degrees_of_freedom(Scene const& scene) {
    std::int64_t dof = 0;
    for (ChainSpec const& chain : scene.chains) dof += scene::degrees_of_freedom(chain);
    return dof;
}

double kinetic_energy(Scene const& scene, ChainSystem::Snapshot const& snapshot) {
    double energy = 0;
    std::size_t i = 0;
    for (ChainSpec const& chain : scene.chains) {
        auto const add = [&](double mass, Sym3 const* inertia) {
            energy += 0.5 * mass * dot(snapshot.velocity[i], snapshot.velocity[i]);
            if (inertia) energy += 0.5 * dot(snapshot.omega[i], *inertia * snapshot.omega[i]);
            ++i;
        };
        for (double const mass : chain.beads.mass) add(mass, nullptr);
        for (std::size_t k = 0; k < chain.bodies.size(); ++k) add(chain.bodies.mass[k], &chain.bodies.inertia[k]);
        for (std::size_t k = 0; k < chain.linked.size(); ++k) add(chain.linked.mass[k], &chain.linked.inertia[k]);
    }
    return energy;
}

double radius_of_gyration(std::vector<double> const& mass, std::vector<Vec3> const& position, std::int64_t first, std::int64_t count) {
    double total = 0, square = 0;
    Vec3 centre = Vec3::zero();
    for (std::int64_t i = first; i < first + count; ++i) {
        total += mass[i];
        centre = plus_scaled(centre, mass[i], position[i] - position[first]);
    }
    centre = position[first] + (1.0 / total) * centre;
    for (std::int64_t i = first; i < first + count; ++i) square += mass[i] * dot(position[i] - centre, position[i] - centre);
    return std::sqrt(square / total);
}

Observables::Observables(Scene const& scene, Topology const& topology, std::vector<EnergyTerm> const& terms)
    : scene_(scene), topology_(topology), dof_(degrees_of_freedom(scene)) {
    for (ChainSpec const& chain : scene.chains) has_temperature_ = has_temperature_ && chain.bodies.driven.empty();
    has_temperature_ = has_temperature_ && dof_ > 0 && !(scene.dynamics.given && is_implicit(scene.dynamics.integrator));
    std::string const energy = scene.si ? " [J]" : " [kJ/mol]", length = scene.si ? " [m]" : " [nm]";
    if (wants("energy")) {
        for (EnergyTerm const& term : terms) columns_.push_back(term.name + "_energy" + energy);
        for (char const* const name : {"potential_energy", "kinetic_energy", "total_energy"}) columns_.push_back(name + energy);
    }
    if (wants("temperature")) columns_.push_back("temperature [K]");
    if (wants("constraint_error")) columns_.push_back("constraint_error [1]");
    for (char const* const shape : {"radius_of_gyration", "end_to_end_distance"}) {
        if (!wants(shape)) continue;
        if (scene.chains.size() == 1)
            columns_.push_back(shape + length);
        else if (scene.chains.size() <= most_single_chains_)
            for (ChainSpec const& chain : scene.chains) columns_.push_back(shape + ("_" + chain.name) + length);
        else
            columns_.push_back("mean_" + std::string(shape) + length);
    }
}

bool Observables::wants(std::string const& name) const {
    if (name == "temperature" && !has_temperature_) return false;
    auto const& asked = scene_.output.observables;
    return asked.empty() || std::find(asked.begin(), asked.end(), name) != asked.end();
}

std::vector<double> Observables::row(ChainSystem::Snapshot const& snapshot, std::vector<Vec3> const& positions,
                                     std::vector<EnergyTerm> const& terms, double constraint_error) const {
    std::vector<double> row;
    double const kinetic = kinetic_energy(scene_, snapshot);
    if (wants("energy")) {
        double potential = 0;
        for (EnergyTerm const& term : terms) {
            row.push_back(term.value);
            potential += term.value;
        }
        row.insert(row.end(), {potential, kinetic, potential + kinetic});
    }
    if (wants("temperature")) row.push_back(2.0 * kinetic / (scene_.boltzmann() * static_cast<double>(dof_)));
    if (wants("constraint_error")) row.push_back(constraint_error);
    for (bool const gyration : {true, false}) {
        if (!wants(gyration ? "radius_of_gyration" : "end_to_end_distance")) continue;
        std::vector<double> values;
        for (Topology::Chain const& chain : topology_.chains)
            values.push_back(gyration ? radius_of_gyration(topology_.mass, positions, chain.first, chain.count)
                                      : norm(positions[chain.first + chain.count - 1] - positions[chain.first]));
        if (values.size() <= most_single_chains_) {
            row.insert(row.end(), values.begin(), values.end());
            continue;
        }
        double sum = 0;
        for (double const v : values) sum += v;
        row.push_back(sum / static_cast<double>(values.size()));
    }
    return row;
}

}  // namespace catena
