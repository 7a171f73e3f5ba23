// Implements the recognition of screened charges by their energy, whatever its expression is.
#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <new>
#include <numeric>

#include "systems/model.hpp"
#include "systems/subset.hpp"

namespace catena {

namespace {

/// Distances at which the force is computed, relative to the cutoff or, without one, to 4 nm.
constexpr std::array<double, 3> places{0.3, 0.5, 0.7};
constexpr double usual_cutoff = 4;  // nm
/// Relative difference at the third distance up to which the energy has the form.
constexpr double same_force = 1e-6;
/// Largest inverse Debye length that is searched for, 1/nm: that of 1000 mol/l.
constexpr double largest_kappa = 100;

/// Forces between two particles like particle p, kJ/mol/nm, at the distances r.
std::array<double, 3> repulsion(OpenMM::System const& system, int force, int p,
                                std::array<double, 3> const& r) {
    auto pair = system_of(Subset{{p, p}, 2, 2}, system, {force});
    OpenMM::VerletIntegrator integrator(0.001);
    OpenMM::Context context(*pair, integrator, OpenMM::Platform::getPlatformByName("Reference"));
    std::array<double, 3> found{};
    for (std::size_t i = 0; i < r.size(); ++i) {
        context.setPositions({{0, 0, 0}, {r[i], 0, 0}});
        found[i] = context.getState(OpenMM::State::Forces).getForces()[1][0];
    }
    return found;
}

/// Logarithm of the prefactor that gives the force F at distance r.
double log_prefactor(double force, double r, double kappa) {
    return std::log(force * r * r) + kappa * r - std::log1p(kappa * r);
}

/// Prefactor and kappa of exp(-kappa r)/r from its forces at three distances; nothing for forces of
/// another form.
std::optional<Screening> fitted(std::array<double, 3> const& force,
                                std::array<double, 3> const& r) {
    if (!std::all_of(force.begin(), force.end(), [](double f) { return f > 0; }))
        return std::nullopt;
    double low = 0, high = largest_kappa;
    for (int i = 0; i < 100; ++i) {
        double const middle = std::midpoint(low, high);
        bool const small = log_prefactor(force[1], r[1], middle) <
                           log_prefactor(force[0], r[0], middle);  // rises with kappa
        (small ? low : high) = middle;
    }
    double const kappa = low < same_force ? 0 : std::midpoint(low, high),
                 scale = log_prefactor(force[0], r[0], kappa);
    for (std::size_t i = 1; i < r.size(); ++i)
        if (!(std::abs(log_prefactor(force[i], r[i], kappa) - scale) < same_force))
            return std::nullopt;
    return Screening{std::exp(scale), kappa};
}

/// Distances within the reach of the force.
std::array<double, 3> distances(OpenMM::CustomNonbondedForce const& force) {
    double reach = reach_of(force);
    if (!std::isfinite(reach)) reach = usual_cutoff;
    if (force.getUseSwitchingFunction()) reach = std::min(reach, force.getSwitchingDistance());
    std::array<double, 3> r = places;
    for (double& place : r) place *= reach;
    return r;
}

}  // namespace

std::vector<double> charges_of(OpenMM::Force const& force) {
    std::vector<double> charges, parameters;
    if (auto const* nonbonded = dynamic_cast<OpenMM::NonbondedForce const*>(&force))
        for (int p = 0; p < nonbonded->getNumParticles(); ++p) {
            double charge, sigma, epsilon;
            nonbonded->getParticleParameters(p, charge, sigma, epsilon);
            charges.push_back(charge);
        }
    auto const* custom = dynamic_cast<OpenMM::CustomNonbondedForce const*>(&force);
    for (int i = 0;
         custom != nullptr && charges.empty() && i < custom->getNumPerParticleParameters(); ++i) {
        std::string const& name = custom->getPerParticleParameterName(i);
        if (name != "q" && name != "Q" && name != "charge") continue;
        for (int p = 0; p < custom->getNumParticles(); ++p) {
            custom->getParticleParameters(p, parameters);
            charges.push_back(parameters[static_cast<std::size_t>(i)]);
        }
    }
    return charges;
}

std::optional<Screening> screening_of(OpenMM::System const& system) {
    for (int i = 0; i < system.getNumForces(); ++i) {
        auto const* pairs = dynamic_cast<OpenMM::CustomNonbondedForce const*>(&system.getForce(i));
        if (pairs == nullptr) continue;
        std::vector<double> const charges = charges_of(*pairs);
        auto const charged =
            std::find_if(charges.begin(), charges.end(), [](double q) { return q != 0; });
        if (charged == charges.end()) continue;
        try {
            std::array<double, 3> const r = distances(*pairs);
            auto found =
                fitted(repulsion(system, i, static_cast<int>(charged - charges.begin()), r), r);
            if (!found) continue;
            found->prefactor /= *charged * *charged;
            found->cutoff = reach_of(*pairs);
            found->charges = charges;
            return found;
        } catch (std::bad_alloc const&) {
            throw;
        } catch (std::exception const&) {
            continue;  // the System's own Context tells what is wrong with the force
        }
    }
    return std::nullopt;
}

}  // namespace catena
