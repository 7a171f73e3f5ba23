// Choice of OpenMM's platform and its properties. Only files that see OpenMM's headers include this
// one.
#pragma once

#include <OpenMM.h>

#include <map>
#include <string>
#include <vector>

#include "force/openmm_force.hpp"

namespace catena {

/// An OpenMM platform with the properties to make a Context with.
struct OpenMmPlatform {
    OpenMM::Platform* platform = nullptr;
    std::map<std::string, std::string> properties;
    // threads of platform CPU
    int threads = 1;
    // plugins that this run could have used and OpenMM could not load, one line each
    std::vector<std::string> not_loaded;

    std::string const& name() const { return platform->getName(); }
    bool on_cpu() const { return name() == "CPU" || name() == "Reference"; }
};

/// Returns the number of threads of platform CPU for a rank's beads: its cores, at most one per 500
/// beads.
int useful_threads(BeadSystem const&, Communicator const&);

/// Returns the platform that the scene names. Otherwise it is CUDA if present and if the rank's
/// chains are on GPU `device` (-1: none), else CPU if present, else Reference. CUDA uses the
/// chains' GPU unless the scene names another.
/// If the scene gives no number of threads, CPU gets the rank's cores, at most one per 500 beads.
/// On two cores a second thread slows 280 beads down by a fifth.
/// Throws InputError that lists the available platforms.
OpenMmPlatform choose_platform(OpenMmSpec const&, BeadSystem const&, Communicator const&,
                               int device);

}  // namespace catena
