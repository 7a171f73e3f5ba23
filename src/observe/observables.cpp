// Implements observables: energies, temperature, constraint error and shapes of chains.
#include "observe/observables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "scene/freedom.hpp"

namespace catena {

std::int64_t degrees_of_freedom(Scene const& scene) {
    std::int64_t dof = 0;
    for (ChainSpec const& chain : scene.chains) dof += scene::degrees_of_freedom(chain);
    return dof;
}

bool has_temperature(Scene const& scene) {
    bool const is_driven = std::any_of(scene.chains.begin(), scene.chains.end(),
                                       [](auto const& c) { return !c.bodies.driven.empty(); });
    // Rotors of implicit springs hold kinetic energy that frames lack.
    bool const has_rotors = scene.dynamics.given && is_implicit(scene.dynamics.integrator);
    return !is_driven && !has_rotors && degrees_of_freedom(scene) > 0;
}

double temperature_of(Scene const& scene, std::int64_t dof, double kinetic_energy) {
    return 2.0 * kinetic_energy / (scene.boltzmann() * static_cast<double>(dof));
}

void KineticEnergy::add(SceneMotion const& s) {
    for (std::size_t i = 0; i < s.velocity.size(); ++i, ++body_) {
        for (; body_ == scene_->chains[chain_].size(); body_ = 0) ++chain_;
        ChainSpec const& chain = scene_->chains[chain_];
        if (chain.is_beads()) {
            sum_ += 0.5 * chain.beads.mass[body_] * dot(s.velocity[i], s.velocity[i]);
            continue;
        }
        bool const linked = chain.is_linked();
        sum_ += 0.5 * (linked ? chain.linked.mass[body_] : chain.bodies.mass[body_]) *
                dot(s.velocity[i], s.velocity[i]);
        Sym3 const& inertia = linked ? chain.linked.inertia[body_] : chain.bodies.inertia[body_];
        sum_ += 0.5 * dot(s.omega[i], inertia * s.omega[i]);
    }
}

double kinetic_energy(Scene const& scene, SceneMotion const& snapshot) {
    KineticEnergy energy(scene);
    energy.add(snapshot);
    return energy.value();
}

void Shape::add(double mass, Vec3 const& position) {
    if (sites_++ == 0) first_ = position;
    last_ = position;
    mass_ += mass;
    Vec3 const from_first = position - first_, before = from_first - mean_;
    mean_ = plus_scaled(mean_, mass / mass_, before);
    square_ += mass * dot(before, from_first - mean_);
    Vec3 const from_mean = from_first - unweighted_mean_;
    unweighted_mean_ = plus_scaled(unweighted_mean_, 1 / static_cast<double>(sites_), from_mean);
    unweighted_square_ += dot(from_mean, from_first - unweighted_mean_);
}

double Shape::radius_of_gyration() const { return std::sqrt(square_ / mass_); }
double Shape::unweighted_radius_of_gyration() const {
    return std::sqrt(unweighted_square_ / static_cast<double>(sites_));
}

namespace {

/// Column of a chain's shape and the function that computes it.
struct ShapeColumn {
    char const* name;
    double (Shape::*value)() const;
};
constexpr ShapeColumn unweighted = {"unweighted_radius_of_gyration",
                                    &Shape::unweighted_radius_of_gyration};
constexpr char const* end_to_end = "end_to_end_distance";
constexpr ShapeColumn shape_columns[] = {{"radius_of_gyration", &Shape::radius_of_gyration},
                                         unweighted,
                                         {end_to_end, &Shape::end_to_end_distance}};

/// True if the scene selects a group of columns; an empty selection excludes the unweighted radius.
bool asks_for(Scene const& scene, std::string const& name) {
    auto const& asked = scene.output.observables;
    if (asked.empty()) return name != unweighted.name;
    return std::find(asked.begin(), asked.end(), name) != asked.end();
}

}  // namespace

bool has_thermostat(DynamicsSpec const& dynamics) {
    return dynamics.given && is_langevin(dynamics.integrator) && dynamics.friction > 0;
}

bool has_energies(Scene const& scene) { return asks_for(scene, "energy"); }

Observables::Observables(Scene const& scene, Topology const& topology,
                         std::vector<EnergyTerm> const& terms)
    : has_temperature_(has_temperature(scene)),
      scene_(scene),
      topology_(topology),
      dof_(degrees_of_freedom(scene)),
      kinetic_(scene) {
    std::string const energy = scene.si ? " [J]" : " [kJ/mol]",
                      length = scene.si ? " [m]" : " [nm]";
    if (wants("energy")) {
        for (EnergyTerm const& term : terms) columns_.push_back(term.name + "_energy" + energy);
        for (char const* const name : {"potential_energy", "kinetic_energy", "total_energy"})
            columns_.push_back(name + energy);
    }
    if (wants("temperature")) columns_.push_back("temperature [K]");
    if (wants("constraint_error")) columns_.push_back("constraint_error [1]");
    for (auto const& [shape, value] : shape_columns)
        if (wants(shape)) add_shape_columns(shape, length);
}

std::vector<Observables::Part> Observables::parts_of(std::string const& shape) const {
    std::size_t const chains = scene_.chains_a_replica();
    std::vector<Part> parts;
    Part all;
    for (std::size_t c = 0; c < chains; ++c) {
        if (!has_shape(shape, c)) continue;
        all.chains.push_back(c);
        parts.push_back({{c}, "_" + scene_.name_in_file(c)});
    }
    if (parts.empty() || (chains > 1 && chains <= most_single_chains_)) return parts;
    return {all};
}

void Observables::add_shape_columns(std::string const& shape, std::string const& unit) {
    bool const is_mean = scene_.replicas > 1 || scene_.chains.size() > most_single_chains_;
    for (Part const& part : parts_of(shape)) {
        columns_.push_back((is_mean ? "mean_" : "") + shape + part.suffix + unit);
        for (std::int64_t r = 1; scene_.replicas > 1 && r <= scene_.replicas; ++r)
            replica_columns_.push_back(
                fmt::format("{}{}_replica_{}{}", shape, part.suffix, r, unit));
    }
}

bool Observables::has_shape(std::string const& name, std::size_t chain) const {
    return name != end_to_end || !scene_.chains[chain].is_branched();
}

/// A mechanism in SI units moves far beyond thermal motion. Its temperature tells nothing unless a
/// thermostat sets it, and is a column by name alone.
bool Observables::wants(std::string const& name) const {
    bool const is_default = scene_.output.observables.empty();
    if (name == "temperature" &&
        (!has_temperature_ || (is_default && scene_.si && !has_thermostat(scene_.dynamics))))
        return false;
    return asks_for(scene_, name);
}

void Observables::begin() {
    kinetic_ = KineticEnergy(scene_);
    chain_ = site_ = 0;
    shape_ = Shape();
    shapes_.clear();
}

void Observables::add(SceneMotion const& bodies, std::vector<Vec3> const& positions) {
    kinetic_.add(bodies);
    for (Vec3 const& position : positions) {
        shape_.add(topology_.mass[site_++], position);
        if (static_cast<std::int64_t>(site_) <
            topology_.chains[chain_].first + topology_.chains[chain_].count)
            continue;
        shapes_.push_back(std::exchange(shape_, Shape()));
        ++chain_;
    }
}

std::vector<double> Observables::row(std::vector<EnergyTerm> const& terms,
                                     double constraint_error) const {
    std::vector<double> row;
    double const kinetic = kinetic_.value();
    if (wants("energy")) {
        double potential = 0;
        for (EnergyTerm const& term : terms) {
            row.push_back(term.value);
            potential += term.value;
        }
        row.insert(row.end(), {potential, kinetic, potential + kinetic});
    }
    if (wants("temperature")) row.push_back(temperature_of(scene_, dof_, kinetic));
    if (wants("constraint_error")) row.push_back(constraint_error);
    for (auto const& [name, value] : shape_columns) {
        if (!wants(name)) continue;
        for (Part const& part : parts_of(name)) {
            std::vector<double> const values = of_replicas(value, part);
            row.push_back(std::accumulate(values.begin(), values.end(), 0.0) /
                          static_cast<double>(values.size()));
        }
    }
    return row;
}

std::vector<double> Observables::replica_row() const {
    std::vector<double> row;
    if (scene_.replicas == 1) return row;
    for (auto const& [name, value] : shape_columns)
        for (Part const& part : wants(name) ? parts_of(name) : std::vector<Part>()) {
            std::vector<double> const values = of_replicas(value, part);
            row.insert(row.end(), values.begin(), values.end());
        }
    return row;
}

std::vector<double> Observables::of_replicas(double (Shape::*value)() const,
                                             Part const& part) const {
    std::vector<double> values;
    for (std::size_t begin = 0; begin < shapes_.size(); begin += scene_.chains_a_replica()) {
        double sum = 0;
        for (std::size_t const c : part.chains) sum += (shapes_[begin + c].*value)();
        values.push_back(sum / static_cast<double>(part.chains.size()));
    }
    return values;
}

}  // namespace catena
