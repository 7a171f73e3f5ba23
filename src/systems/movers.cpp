// Implements the treatment of forces that move particles and of particles without dynamics.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "systems/model.hpp"

namespace catena {

namespace {

/// Describes what the force would do in OpenMM; empty if it does not move particles. `remedy`
/// receives the advice; it stays empty for a force that may be removed.
std::string work_of(OpenMM::Force const& force, std::string& remedy) {
    if (auto const* isotropic = dynamic_cast<OpenMM::MonteCarloBarostat const*>(&force)) {
        remedy = "remove it: Catena runs at constant volume, in the System's box";
        return fmt::format("which changes the box's volume to hold {:.6g} bar at {:.6g} K",
                           isotropic->getDefaultPressure(), isotropic->getDefaultTemperature());
    }
    if (kind_of(force).find("Barostat") != std::string::npos) {
        remedy = "remove it: Catena runs at constant volume, in the System's box";
        return "which changes the box's edges to hold a pressure";
    }
    if (auto const* andersen = dynamic_cast<OpenMM::AndersenThermostat const*>(&force)) {
        remedy =
            "remove it: Catena's own integrators hold the temperature (dynamics.integrator: "
            "g-baoab)";
        return fmt::format("which holds {:.6g} K by collisions", andersen->getDefaultTemperature());
    }
    if (dynamic_cast<OpenMM::CMMotionRemover const*>(&force))
        return "which has no energy and stops the centre of mass";
    return "";
}

/// Throws InputError for virtual sites and for masses that are not positive and finite.
void refuse_particles(OpenMM::System const& system, std::string const& where) {
    for (int p = 0; p < system.getNumParticles(); ++p) {
        if (system.isVirtualSite(p))
            throw InputError(fmt::format("particle {} (from 0) is a virtual site", p), where,
                             "leave virtual sites out: every particle is a bead with a mass");
        double const mass = system.getParticleMass(p);
        if (!(mass > 0))
            throw InputError(fmt::format("particle {} (from 0) has no mass", p), where,
                             "give it one: every particle is a bead that moves");
        if (!std::isfinite(mass))
            throw InputError(fmt::format("particle {} (from 0) has mass {}", p, mass), where,
                             "give it one in amu");
    }
}

}  // namespace

std::vector<std::string> leave_movers_out(OpenMM::System& system, std::vector<int> const& groups,
                                          std::string const& where) {
    refuse_particles(system, where);
    std::vector<std::string> notes;
    // The loop runs backwards, because removals shift later indices.
    for (int i = system.getNumForces() - 1; i >= 0; --i) {
        OpenMM::Force const& force = system.getForce(i);
        std::string remedy;
        std::string const kind = kind_of(force), work = work_of(force, remedy);
        if (work.empty()) continue;
        bool const excluded = !groups.empty() && std::find(groups.begin(), groups.end(),
                                                           force.getForceGroup()) == groups.end();
        if (!remedy.empty() && !excluded)
            throw InputError(fmt::format("the System holds {} {}, {}",
                                         kind.starts_with('A') ? "an" : "a", kind, work),
                             where, remedy);
        notes.insert(notes.begin(), fmt::format("The System's {}, {}, is left out.", kind, work));
        system.removeForce(i);
    }
    return notes;
}

}  // namespace catena
