// The numbers of observables.csv, from a snapshot in scene order on rank 0.
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
/// Mass-weighted radius of gyration of the sites [first, first + count).
double radius_of_gyration(std::vector<double> const& mass, std::vector<Vec3> const& position, std::int64_t first, std::int64_t count);

class Observables {
  public:
    /// `terms`: names of the potential energy terms. The scene's output.observables choose the groups of columns; empty: all that it can
    /// have.
    Observables(Scene const&, Topology const&, std::vector<EnergyTerm> const& terms);
    /// Names with units, e.g. "total_energy [kJ/mol]".
    std::vector<std::string> const& columns() const { return columns_; }
    /// `positions`: of the topology's sites.
    std::vector<double> row(ChainSystem::Snapshot const&, std::vector<Vec3> const& positions, std::vector<EnergyTerm> const& terms,
                            double constraint_error) const;

  private:
    bool wants(std::string const& name) const;
    bool has_temperature_ = true;  // not where nothing moves freely, or motions are prescribed
    Scene const& scene_;
    Topology const& topology_;
    std::int64_t dof_;
    std::vector<std::string> columns_;
    static constexpr std::size_t most_single_chains_ = 10;  // beyond, shapes are averaged over chains
};

}  // namespace catena
