// Errors and times of OpenMM's forces on all platforms.
#include "measure/force_errors.hpp"

#include <algorithm>
#include <cmath>

namespace catena {
namespace {

/// A platform with a precision.
struct Kind {
    std::string platform, precision;
};

/// Returns all kinds, Reference first. The CPU platform computes pairs in single precision,
/// Reference in double precision.
std::vector<Kind> kinds() {
    std::vector<Kind> all;
    for (std::string const& platform : openmm_platforms())
        if (platform == "Reference")
            all.insert(all.begin(), {platform, "double"});
        else if (platform == "CPU")
            all.push_back({platform, "single"});
        else
            for (char const* const precision : {"single", "mixed", "double"})
                all.push_back({platform, precision});
    return all;
}

/// Returns the seconds per evaluation of the forces, after a warm-up of two evaluations.
Spread seconds_of_forces(ChainSystem& system, int repeat) {
    std::vector<double> all;
    for (int i = 0; i < repeat + 2; ++i) {
        double const before = system.seconds().at("forces");
        system.evaluate();
        system.wait();
        if (i >= 2) all.push_back(system.seconds().at("forces") - before);
    }
    return spread_of(all);
}

}  // namespace

double force_error_bound(std::string const& platform, std::string const& precision,
                         double rms_force) {
    bool const adds_in_steps = platform != "Reference" && platform != "CPU";
    double const of_pairs = 0x1p12 * (precision == "double" ? 0x1p-53 : 0x1p-24);
    return adds_in_steps ? of_pairs + 64 * 0x1p-24 + 64 * 0x1p-32 / rms_force : of_pairs;
}

ForceStudy study_force_errors(Scene const& given, Communicator const& communicator, int repeat) {
    ForceStudy study{given.title, 0, {}};
    std::vector<Vec3> exact;
    for (Kind const& kind : kinds()) {
        Scene scene = given;
        scene.forces.openmm->platform = kind.platform;
        scene.forces.openmm->precision = kind.precision;
        scene.forces.openmm->path = "inline";
        ChainSystem system(scene, Axes::world, communicator);
        system.evaluate();
        ForcePoint point{kind.platform, kind.precision, 0, 0, 0, seconds_of_forces(system, repeat)};
        std::vector<Vec3> const found = system.bead_forces();
        if (exact.empty()) exact = found;
        study.beads = static_cast<std::int64_t>(found.size());
        double squares = 0, difference = 0, largest = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) {
            Vec3 const error = found[i] - exact[i];
            squares += dot(exact[i], exact[i]);
            difference += dot(error, error);
            largest = std::max(largest, norm(exact[i]));
            point.largest_error = larger(point.largest_error, norm(error));
        }
        point.error = std::sqrt(difference / squares);
        point.largest_error /= largest;
        point.bound = force_error_bound(kind.platform, kind.precision,
                                        std::sqrt(squares / static_cast<double>(exact.size())));
        study.points.push_back(point);
    }
    return study;
}

}  // namespace catena
