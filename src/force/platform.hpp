// Which platform OpenMM computes on, and with what. For files that see OpenMM's headers.
#pragma once

#include <OpenMM.h>

#include <map>
#include <string>
#include <vector>

#include "force/openmm_force.hpp"

namespace catena {

struct OpenMmPlatform {
    OpenMM::Platform* platform = nullptr;
    std::map<std::string, std::string> properties;
    int threads = 1;

    std::string const& name() const { return platform->getName(); }
    bool on_cpu() const { return name() == "CPU" || name() == "Reference"; }
};

/// The platform that the scene names, else CUDA where it is present and the rank has its chains on
/// GPU `device` (-1: it has not), else CPU where there is one, else Reference. CUDA takes the
/// chains' GPU unless the scene names another. CPU threads, where the scene gives no number: the
/// rank's cores, but one for every 500 beads at most (on two cores, a second thread slows 280 beads
/// down by a fifth). Throws InputError listing those present.
OpenMmPlatform choose_platform(OpenMmSpec const&, BeadSystem const&, Communicator const&,
                               int device);

}  // namespace catena
