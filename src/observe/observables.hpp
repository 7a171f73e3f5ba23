// The numbers of observables.csv, on rank 0, from bodies that come in scene order.
#pragma once

#include <string>
#include <vector>

#include "integrate/chain_system.hpp"
#include "io/output.hpp"

namespace catena {

/// Of all chains (scene/freedom.hpp).
std::int64_t degrees_of_freedom(Scene const&);

/// Kinetic energy of all bodies. `snapshot` in scene order.
double kinetic_energy(Scene const&, ChainSystem::Snapshot const&);

/// The same from parts of the scene as they come.
class KineticEnergy {
  public:
    explicit KineticEnergy(Scene const& scene) : scene_(&scene) {}
    /// The next bodies.
    void add(ChainSystem::Snapshot const&);
    double value() const { return sum_; }

  private:
    Scene const* scene_;
    std::size_t chain_ = 0, body_ = 0;  // of the next one
    double sum_ = 0;
};

/// Of a chain's sites as they come, in one pass: mean and square follow Welford (Technometrics 4,
/// 419, 1962).
class Shape {
  public:
    void add(double mass, Vec3 const& position);
    double radius_of_gyration()
        const;  // weighted with masses: sqrt(sum m |x - x_m|^2 / sum m), x_m the centre of mass
    double unweighted_radius_of_gyration() const;  // every site counts one
    double end_to_end_distance() const { return norm(last_ - first_); }

  private:
    std::int64_t sites_ = 0;
    double mass_ = 0, square_ = 0, unweighted_square_ = 0;
    Vec3 first_ = Vec3::zero(), last_ = Vec3::zero(), mean_ = Vec3::zero(),
         unweighted_mean_ = Vec3::zero();
};

/// Whether rows have energies, of which potential ones may cost as much as several steps.
bool has_energies(Scene const&);

class Observables {
  public:
    /// `terms`: names of the potential energy terms. The scene's output.observables choose the
    /// groups of columns; empty: all that it can have, but for the unweighted radius of gyration.
    Observables(Scene const&, Topology const&, std::vector<EnergyTerm> const& terms);
    /// Names with units, e.g. "total_energy [kJ/mol]".
    std::vector<std::string> const& columns() const { return columns_; }
    /// Another row: forgets what was added.
    void begin();
    /// The next bodies and their sites.
    void add(ChainSystem::Snapshot const&, std::vector<Vec3> const& positions);
    /// Of what was added.
    double kinetic() const { return kinetic_.value(); }
    std::vector<double> row(std::vector<EnergyTerm> const& terms, double constraint_error) const;

  private:
    bool wants(std::string const& name) const;
    bool has_temperature_ = true;  // not where nothing moves freely, or motions are prescribed
    Scene const& scene_;
    Topology const& topology_;
    std::int64_t dof_;
    std::vector<std::string> columns_;
    KineticEnergy kinetic_;
    std::size_t chain_ = 0, site_ = 0;  // of the topology, next
    Shape shape_;                       // of that chain, so far
    std::vector<Shape> shapes_;         // of the chains before
    static constexpr std::size_t most_single_chains_ =
        10;  // beyond, shapes are averaged over chains
};

}  // namespace catena
