// Shortening of pair forces to a given reach.
#include "force/contacts.hpp"

#include "systems/box.hpp"

namespace catena {

namespace {

double constexpr switched = 0.8;  // fraction of the reach at which switching off begins

/// Limits a pair force to `reach`, nm, with OpenMM's switching function.
template <class Force>
void shorten(Force& force, double reach) {
    if (force.getCutoffDistance() <= reach) return;
    force.setCutoffDistance(reach);
    force.setUseSwitchingFunction(true);
    force.setSwitchingDistance(switched * reach);
}

}  // namespace

void shorten_pair_forces(OpenMM::System& system, double reach) {
    for (int i = 0; i < system.getNumForces(); ++i) {
        if (auto* custom = dynamic_cast<OpenMM::CustomNonbondedForce*>(&system.getForce(i));
            custom && custom->getNonbondedMethod() != OpenMM::CustomNonbondedForce::NoCutoff) {
            custom->setUseLongRangeCorrection(false);
            shorten(*custom, reach);
        }
        if (auto* charges = dynamic_cast<OpenMM::NonbondedForce*>(&system.getForce(i));
            charges &&
            (charges->getNonbondedMethod() == OpenMM::NonbondedForce::CutoffNonPeriodic ||
             charges->getNonbondedMethod() == OpenMM::NonbondedForce::CutoffPeriodic)) {
            charges->setUseDispersionCorrection(false);
            shorten(*charges, reach);
        }
    }
}

}  // namespace catena
