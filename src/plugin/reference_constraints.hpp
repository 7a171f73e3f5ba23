// Constraints on OpenMM's platforms whose states are in host memory.
#pragma once

#include <string>

namespace OpenMM {
class ContextImpl;
}

namespace catena::plugin {

/// Replaces the solver of all constraints in a Context that OpenMM would solve by CCMA. Those that
/// OpenMM solves by SETTLE (rigid water) stay with it. The Context must be on the platform
/// Reference or CPU. `held`: constraints that the System lacks at present. `user` names the
/// integrator for messages. The second call in a Context does nothing. Throws InputError where
/// constraint_chains() does and on another platform.
void solve_constraints(OpenMM::ContextImpl& context, std::string const& user);

}  // namespace catena::plugin
