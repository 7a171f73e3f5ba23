// Implements the addition of serialised forces. OpenMM itself judges each force in a Context of its
// own, so that every kind of force is checked by its own rules before ranks divide it.
#include "systems/extra_forces.hpp"

#include <fmt/format.h>
#include <openmm/serialization/XmlSerializer.h>

#include <algorithm>
#include <new>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "error.hpp"
#include "scene/force_changes.hpp"
#include "scene/node.hpp"

namespace catena {

namespace {

/// One file of ForceChanges::extra.
struct Extra {
    std::string file;
    /// Scene file and key in messages.
    std::string where;
    OpenMM::Force const& force;

    /// Returns "pull.xml (HarmonicBondForce)".
    std::string name() const {
        return fmt::format("{} ({})", scene::shown_path(file), kind_of(force));
    }
};

/// Throws InputError for a periodic force in a scene without a box.
void refuse_without_box(Extra const& extra, BeadSystem const& beads) {
    bool periodic = false;
    try {
        periodic = extra.force.usesPeriodicBoundaryConditions();
    } catch (std::exception const&) {  // a kind of force that does not tell
    }
    if (periodic && !beads.box)
        throw InputError(
            fmt::format("{} is periodic and the scene has no box", extra.name()), extra.where,
            "give the scene `box: {periodic: [...]}`, or write the force without periodicity");
}

/// Throws InputError if OpenMM refuses the force on the System's particles.
void refuse_misfit(Extra const& extra, OpenMM::System const& whole) {
    int const count = whole.getNumParticles();
    OpenMM::System alone;
    OpenMM::Vec3 a, b, c;
    whole.getDefaultPeriodicBoxVectors(a, b, c);
    alone.setDefaultPeriodicBoxVectors(a, b, c);
    for (int p = 0; p < count; ++p) alone.addParticle(whole.getParticleMass(p));
    alone.addForce(OpenMM::XmlSerializer::clone(extra.force));
    try {
        OpenMM::VerletIntegrator integrator(0.001);
        OpenMM::Context const context(alone, integrator,
                                      OpenMM::Platform::getPlatformByName("Reference"));
    } catch (std::bad_alloc const&) {
        throw;
    } catch (std::exception const& e) {
        throw InputError(fmt::format("{} does not fit the {} particles: {}", extra.name(), count,
                                     scene::shown(e.what(), 300)),
                         extra.where,
                         fmt::format("number its particles from 0 to {}, in the order of the {}",
                                     count - 1, "scene's beads or of the System"));
    }
}

/// Throws InputError for thermostats and the like, which change positions or velocities.
void refuse_movers(Extra const& extra) {
    std::string const kind = kind_of(extra.force);
    if (kind.find("Barostat") != std::string::npos ||
        kind.find("Thermostat") != std::string::npos || kind == "CMMotionRemover")
        throw InputError(fmt::format("{} is no force between beads", extra.name()), extra.where,
                         "leave it out: Catena has its own integrators, at constant volume");
}

using Pairs = std::set<std::pair<int, int>>;

/// Pairs that a pair force leaves out; nothing for other forces.
std::optional<Pairs> left_out_by(OpenMM::Force const& force) {
    Pairs pairs;
    int a = 0, b = 0;
    if (auto const* custom = dynamic_cast<OpenMM::CustomNonbondedForce const*>(&force)) {
        for (int i = 0; i < custom->getNumExclusions(); ++i) {
            custom->getExclusionParticles(i, a, b);
            pairs.insert(std::minmax(a, b));
        }
        return pairs;
    }
    if (auto const* charges = dynamic_cast<OpenMM::NonbondedForce const*>(&force)) {
        double product = 0, sigma = 0, epsilon = 0;
        for (int i = 0; i < charges->getNumExceptions(); ++i) {
            charges->getExceptionParameters(i, a, b, product, sigma, epsilon);
            pairs.insert(std::minmax(a, b));
        }
        return pairs;
    }
    return std::nullopt;
}

/// Gives a pair force the exclusions of the model's pair forces, which OpenMM wants to be the same
/// in all: neighbours along links, beads of one rigid body. Throws InputError where it has others.
void take_exclusions(Extra const& extra, OpenMM::Force& force, OpenMmModel& model) {
    std::optional<Pairs> const own = left_out_by(force);
    std::optional<Pairs> models;
    for (int i = 0; own && !models && i < model.system->getNumForces(); ++i)
        models = left_out_by(model.system->getForce(i));
    if (!models || *models == *own) return;
    auto* const custom = dynamic_cast<OpenMM::CustomNonbondedForce*>(&force);
    bool const lacks_some = std::includes(models->begin(), models->end(), own->begin(), own->end());
    if (!custom || !lacks_some)
        throw InputError(
            fmt::format("{} leaves out {} pairs and the model's pair forces {} others",
                        extra.name(), own->size(), models->size()),
            extra.where,
            "leave out the same pairs, as OpenMM demands: neighbours along links and beads of one "
            "rigid body");
    for (auto const& [a, b] : *models)
        if (!own->contains({a, b})) custom->addExclusion(a, b);
    model.notes.push_back(
        fmt::format("{} leaves out {} pairs more, as the model's pair forces do: neighbours along "
                    "links and beads of one rigid body",
                    extra.name(), models->size() - own->size()));
}

/// Names all forces and gives each a group of its own.
void name_all(OpenMmModel& model) {
    std::vector<int> all(static_cast<std::size_t>(model.system->getNumForces()));
    std::iota(all.begin(), all.end(), 0);
    model.terms = term_names(*model.system, all);
    for (int const i : all) {
        OpenMM::Force& force = model.system->getForce(i);
        force.setName(model.terms[static_cast<std::size_t>(i)]);
        force.setForceGroup(i);
        if (auto* charges = dynamic_cast<OpenMM::NonbondedForce*>(&force))
            charges->setReciprocalSpaceForceGroup(-1);  // same group as the direct space
    }
}

}  // namespace

void add_extra_forces(OpenMmModel& model, OpenMmSpec const& spec, BeadSystem const& beads) {
    std::vector<std::string> const files = changes_of(spec).extra;
    if (files.empty()) return;
    if (beads.box)
        model.system->setDefaultPeriodicBoxVectors({(*beads.box)[0], 0, 0}, {0, (*beads.box)[1], 0},
                                                   {0, 0, (*beads.box)[2]});
    for (std::size_t i = 0; i < files.size(); ++i) {
        std::string const where = openmm_key(beads.scene_file, fmt::format("extra[{}]", i));
        auto force = read_openmm_force(files[i], where);
        Extra const extra{files[i], where, *force};
        refuse_movers(extra);
        refuse_without_box(extra, beads);
        refuse_misfit(extra, *model.system);
        model.notes.push_back(fmt::format("added: {}", extra.name()));
        take_exclusions(extra, *force, model);
        model.system->addForce(force.release());
    }
    if (model.system->getNumForces() > force_groups_of_openmm)
        throw InputError(fmt::format("the scene has {} forces with those of `extra`",
                                     model.system->getNumForces()),
                         openmm_key(beads.scene_file, "extra"),
                         fmt::format("merge forces of one kind: OpenMM distinguishes {} groups",
                                     force_groups_of_openmm));
    name_all(model);
}

}  // namespace catena
