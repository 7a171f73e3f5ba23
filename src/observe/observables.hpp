// Values of observables.csv, computed on rank 0 from bodies that arrive in scene order.
#pragma once

#include <string>
#include <vector>

#include "integrate/chain_system.hpp"
#include "io/output.hpp"

namespace catena {

/// Number of degrees of freedom of all chains (scene/freedom.hpp).
std::int64_t degrees_of_freedom(Scene const&);

/// True if the kinetic energy of frames has a temperature. There is none if nothing moves freely,
/// if motions are prescribed, and for implicit integrators, whose rotors hold energy of their own.
bool has_temperature(Scene const&);
/// Returns the temperature of a kinetic energy of `dof` degrees of freedom, K.
double temperature_of(Scene const&, std::int64_t dof, double kinetic_energy);

/// Returns the kinetic energy of all bodies, kJ/mol (J with `units: si`). `snapshot` in scene
/// order.
double kinetic_energy(Scene const&, SceneMotion const&);

/// Kinetic energy of a scene whose bodies are added in parts, in scene order.
class KineticEnergy {
  public:
    explicit KineticEnergy(Scene const& scene) : scene_(&scene) {}
    /// Adds the next bodies.
    void add(SceneMotion const&);
    double value() const { return sum_; }

  private:
    Scene const* scene_;
    std::size_t chain_ = 0, body_ = 0;  // indices of the next body
    double sum_ = 0;
};

/// Shape of one chain, whose sites are added in their order. Mean and square are updated by the
/// formulas of Welford (Technometrics 4, 419, 1962).
class Shape {
  public:
    void add(double mass, Vec3 const& position);
    double radius_of_gyration()
        const;  // weighted by masses: sqrt(sum m |x - x_m|^2 / sum m), x_m the centre of mass
    double unweighted_radius_of_gyration() const;  // every site has weight one
    double end_to_end_distance() const { return norm(last_ - first_); }

  private:
    std::int64_t sites_ = 0;
    double mass_ = 0, square_ = 0, unweighted_square_ = 0;  // sums of |x - mean|^2
    Vec3 first_ = Vec3::zero(), last_ = Vec3::zero(), mean_ = Vec3::zero(),
         unweighted_mean_ = Vec3::zero();  // mean positions relative to the first site
};

/// True if a Langevin integrator holds the temperature.
bool has_thermostat(DynamicsSpec const&);
/// True if rows contain energies. Potential energies may cost as much as several steps.
bool has_energies(Scene const&);

/// Columns of observables.csv, and one row per frame.
class Observables {
  public:
    /// `terms`: names of the potential energy terms. output.observables of the scene selects the
    /// groups of columns. An empty selection means all groups, except the unweighted radius of
    /// gyration, and the temperature with `units: si` without a thermostat. Branched chains have no
    /// end-to-end distance.
    Observables(Scene const&, Topology const&, std::vector<EnergyTerm> const& terms);
    /// Returns names with units, e.g. "total_energy [kJ/mol]". Sizes of many chains are means over
    /// them; with replicas there is a mean for each chain of a replica, "mean_SIZE_CHAIN".
    std::vector<std::string> const& columns() const { return columns_; }
    /// Returns the columns of each replica: those of the first mean for all replicas, then those of
    /// the next. Empty without replicas.
    std::vector<std::string> const& replica_columns() const { return replica_columns_; }
    /// Begins another row: discards what was added.
    void begin();
    /// Adds the next bodies, and their sites' positions in W.
    void add(SceneMotion const&, std::vector<Vec3> const& positions);
    /// Returns the kinetic energy of the bodies added so far.
    double kinetic() const { return kinetic_.value(); }
    /// Returns the values of all columns. Precondition: all bodies of the scene have been added.
    std::vector<double> row(std::vector<EnergyTerm> const& terms, double constraint_error) const;
    /// Returns the values of all replica_columns(). Precondition: that of row().
    std::vector<double> replica_row() const;

  private:
    /// Chains of a replica that a mean is taken over.
    struct Part {
        std::vector<std::size_t> chains;  // ascending
        std::string suffix;               // of the column's name
    };
    /// Returns the parts of a replica with columns of their own; they have the shape, whose name is
    /// that of a column.
    std::vector<Part> parts_of(std::string const& shape) const;
    void add_shape_columns(std::string const& shape, std::string const& unit);
    /// Returns the mean over a part's chains for each replica.
    std::vector<double> of_replicas(double (Shape::*value)() const, Part const& part) const;

    /// True if the group of columns is selected and defined.
    bool wants(std::string const& name) const;
    /// True if a chain has the shape, whose name is that of a column.
    bool has_shape(std::string const& name, std::size_t chain) const;
    bool has_temperature_;
    Scene const& scene_;
    Topology const& topology_;
    std::int64_t dof_;  // degrees of freedom
    std::vector<std::string> columns_, replica_columns_;
    KineticEnergy kinetic_;
    std::size_t chain_ = 0, site_ = 0;  // indices of the next site and its chain in the topology
    Shape shape_;                       // chain of the next site, so far
    std::vector<Shape> shapes_;         // completed chains
    static constexpr std::size_t most_single_chains_ = 10;  // shapes of more chains are averaged
};

}  // namespace catena
