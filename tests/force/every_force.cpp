#include "tests/force/every_force.hpp"

#include <openmm/serialization/XmlSerializer.h>

#include <cmath>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

namespace catena::testing {

namespace {

using namespace OpenMM;

void add_bonds(System& system, int n, bool periodic) {
    auto* harmonic = new HarmonicBondForce;
    auto* custom = new CustomBondForce("k*(r-r0)^2/(1+r)");
    custom->addGlobalParameter("k", 12.5);
    custom->addPerBondParameter("r0");
    for (int i = 0; i + 1 < n; ++i)
        harmonic->addBond(i, i + 1, 0.38, 800);  // along links and between the chains' ends
    for (int i = 0; i + 37 < n; i += 5) harmonic->addBond(i, i + 37, 1.0 + 0.01 * i, 3);
    for (int i = 0; i + 3 < n; i += 2) custom->addBond(i, i + 3, {0.5 + 0.001 * i});
    harmonic->setUsesPeriodicBoundaryConditions(periodic);
    custom->setUsesPeriodicBoundaryConditions(periodic);
    system.addForce(harmonic);
    system.addForce(custom);
}

void add_angles_and_torsions(System& system, int n, bool periodic) {
    auto* angles = new HarmonicAngleForce;
    auto* custom_angles = new CustomAngleForce("k*(cos(theta)-c)^2");
    custom_angles->addPerAngleParameter("k");
    custom_angles->addGlobalParameter("c", -0.4);
    auto* torsions = new PeriodicTorsionForce;
    auto* rb = new RBTorsionForce;
    auto* custom_torsions = new CustomTorsionForce("k*(1+cos(3*theta))");
    custom_torsions->addPerTorsionParameter("k");
    for (int i = 0; i + 2 < n; ++i)
        (i % 2 ? custom_angles->addAngle(i, i + 1, i + 2, {7.0 + 0.1 * i})
               : angles->addAngle(i, i + 1, i + 2, 1.9, 20));
    for (int i = 0; i + 5 < n; ++i) {
        torsions->addTorsion(i, i + 1, i + 2, i + 3, 1 + i % 3, 0.3, 2.0);
        rb->addTorsion(i, i + 1, i + 3, i + 5, 0.1, 0.7, -0.3, 0.2, 0.1, -0.1);
        custom_torsions->addTorsion(i, i + 2, i + 3, i + 4, {1.5});
    }
    angles->setUsesPeriodicBoundaryConditions(periodic);
    custom_angles->setUsesPeriodicBoundaryConditions(periodic);
    torsions->setUsesPeriodicBoundaryConditions(periodic);
    rb->setUsesPeriodicBoundaryConditions(periodic);
    custom_torsions->setUsesPeriodicBoundaryConditions(periodic);
    for (Force* force :
         std::initializer_list<Force*>{angles, custom_angles, torsions, rb, custom_torsions})
        system.addForce(force);
}

void add_external(System& system, int n) {
    auto* external = new CustomExternalForce("k*((x-4)^2+y^2+(z+1)^2)");
    external->addPerParticleParameter("k");
    for (int i = 0; i < n; i += 3) external->addParticle(i, {0.05 * (i % 7)});
    system.addForce(external);
}

void add_charges(System& system, int n, bool periodic) {
    auto* charges = new NonbondedForce;
    charges->setNonbondedMethod(periodic ? NonbondedForce::CutoffPeriodic
                                         : NonbondedForce::CutoffNonPeriodic);
    charges->setCutoffDistance(1.4);
    charges->setUseSwitchingFunction(true);
    charges->setSwitchingDistance(1.1);
    charges->setReactionFieldDielectric(40);
    charges->addGlobalParameter("scale", 0.7);
    for (int i = 0; i < n; ++i) charges->addParticle(0.2 * (i % 5 - 2), 0.3 + 0.01 * (i % 4), 0.5);
    for (int i = 0; i + 1 < n; ++i) charges->addException(i, i + 1, 0, 1, 0);
    for (int i = 0; i + 24 < n; i += 6)
        charges->addException(i, i + 24, 0.3, 0.4, 0.1);  // farther than the cutoff and its skin
    for (int i = 0; i < n; i += 4) charges->addParticleParameterOffset("scale", i, 0.1, 0.0, 0.2);
    charges->addExceptionParameterOffset("scale", n, 0.2, 0.0, 0.0);
    charges->setExceptionsUsePeriodicBoundaryConditions(periodic);
    system.addForce(charges);
}

void add_pairs(System& system, int n, bool periodic) {
    auto const method =
        periodic ? CustomNonbondedForce::CutoffPeriodic : CustomNonbondedForce::CutoffNonPeriodic;
    auto* tabulated = new CustomNonbondedForce("a1*a2*shape(r)");
    tabulated->addPerParticleParameter("a");
    std::vector<double> values;
    for (int i = 0; i <= 40; ++i) values.push_back(std::exp(-0.1 * i) * std::sin(0.3 * i));
    tabulated->addTabulatedFunction("shape", new Continuous1DFunction(values, 0, 1.25));
    tabulated->setCutoffDistance(1.2);
    auto* charged =
        new CustomNonbondedForce("q1*q2*exp(-r)");  // farther than the others, between some
    charged->addPerParticleParameter("q");
    charged->setCutoffDistance(1.7);
    auto* grouped = new CustomNonbondedForce("g/r^2");
    grouped->addGlobalParameter("g", 0.25);
    grouped->setCutoffDistance(1.5);
    std::set<int> even, third;
    for (int i = 0; i < n; ++i) {
        tabulated->addParticle({1.0 + 0.2 * (i % 3)});
        charged->addParticle({i % 3 == 1 ? 0.8 : 0.0});
        grouped->addParticle();
        if (i % 2 == 0) even.insert(i);
        if (i % 3 == 0) third.insert(i);
    }
    for (int i = 0; i + 2 < n; ++i)
        tabulated->addExclusion(i, i + 2), charged->addExclusion(i, i + 2);
    grouped->addInteractionGroup(even, third);
    for (auto* pairs : {tabulated, charged, grouped}) {
        pairs->setNonbondedMethod(method);
        system.addForce(pairs);
    }
}

}  // namespace

std::unique_ptr<System> bare_system(BeadSystem const& beads) {
    auto system = std::make_unique<System>();
    for (double mass : beads.mass) system->addParticle(mass);
    if (beads.box)
        system->setDefaultPeriodicBoxVectors({(*beads.box)[0], 0, 0}, {0, (*beads.box)[1], 0},
                                             {0, 0, (*beads.box)[2]});
    return system;
}

std::unique_ptr<System> every_force(BeadSystem const& beads) {
    auto system = bare_system(beads);
    int const n = system->getNumParticles();
    bool const periodic = beads.box.has_value();
    add_bonds(*system, n, periodic);
    add_angles_and_torsions(*system, n, periodic);
    add_external(*system, n);
    add_charges(*system, n, periodic);
    add_pairs(*system, n, periodic);
    return system;
}

std::string xml_of(System const& system) {
    std::ostringstream text;
    XmlSerializer::serialize(&system, "System", text);
    return text.str();
}

std::string xml_of(Force const& force) {
    std::ostringstream text;
    XmlSerializer::serialize(&force, "Force", text);
    return text.str();
}

}  // namespace catena::testing
