// Scenes that the tests of whole runs share: every integrator with the chains it takes.
#pragma once

#include <string>

namespace catena::test {

struct RunScene {
    char const* name;
    std::string text;
};

/// Bodies of a zigzag of beads on links whose ends are pulled apart; every tenth bead is pulled
/// aside.
inline std::string pulled_zigzag(int beads) {
    std::string bodies;
    for (int k = 0; k < beads; ++k) {
        std::string const x = std::to_string(0.3 * k), y = k % 2 == 0 ? "0" : "0.25";
        bodies += (k > 0 ? ", {mass: 1, position: [" : "{mass: 1, position: [") + x + ", " + y +
                  ", 0]" + (k > 0 ? ", joint: {type: link}" : "") +
                  (k == 0           ? ", force: [-4, 0.5, 0]"
                   : k == beads - 1 ? ", force: [4, 0, 0.5]"
                   : k % 10 == 0    ? ", force: [0, 1, -0.25]"
                                    : "") +
                  "}";
    }
    return "bodies: [" + bodies + "]";
}

inline RunScene const run_scenes[] = {
    {"rattle_beads",
     "chains: [{name: a, velocities: thermal, generator: {freely_jointed: {beads: 150, length: "
     "0.38}}}, {name: b, base: fixed, velocities: "
     "thermal, "
     "generator: {random: {bodies: 20, joint: link, seed: 2}}}]\n"
     "forces: {gravity: [0, 0, -1]}\n"
     "dynamics: {integrator: rattle, step: 0.002, steps: 20, temperature: 300, seed: 5}\noutput: "
     "{every: 5, checkpoint_every: 10}\n"},
    {"langevin_beads",
     "chains: [{name: a, velocities: thermal, generator: {freely_jointed: {beads: 150, length: "
     "0.38}}}]\n"
     "dynamics: {integrator: g-baoab, step: 0.002, steps: 20, friction: 1, seed: 5}\noutput: "
     "{every: 5, checkpoint_every: 10}\n"},
    {"langevin_fixman",
     "chains: [{name: a, velocities: thermal, generator: {freely_jointed: {beads: 1200, length: "
     "0.38}}}, {name: b, base: fixed, "
     "velocities: "
     "thermal, tip: {joint: {type: link, anchor: [2, 3, 1]}}, generator: {freely_jointed: {beads: "
     "70, length: 0.38}}}]\n"
     "dynamics: {integrator: g-baoab, step: 0.002, steps: 20, friction: 1, seed: 5, fixman: "
     "true}\noutput: {every: 5, checkpoint_every: "
     "10}\n"},
    {"langevin_branched",
     "chains: [{name: s, count: 5, velocities: thermal, generator: {star: {arms: 4, arm_length: 9, "
     "length: 0.4}}}, {name: a, velocities: thermal, generator: {freely_jointed: {beads: 90, "
     "length: 0.38}}}, {name: b, base: fixed, velocities: thermal, generator: {brush: {backbone: "
     "40, side_length: 3, length: 0.4}}}]\n"
     "dynamics: {integrator: g-baoab, step: 0.002, steps: 20, friction: 1, seed: 5, fixman: "
     "true}\noutput: {every: 5, checkpoint_every: 10, joint_forces: true}\n"},
    {"rattle_branched",
     "chains: [{name: s, count: 3, velocities: thermal, generator: {dendrimer: {generations: 3, "
     "length: 0.4}}}]\n"
     "dynamics: {integrator: rattle, step: 0.002, steps: 20, temperature: 300, seed: 5}\noutput: "
     "{every: 5, checkpoint_every: 10}\n"},
    {"rattle_bodies",
     "chains: [{name: a, base: free, velocities: thermal, generator: {random: {bodies: 60, joint: "
     "spherical, seed: 1}}}, {name: b, base: "
     "fixed, velocities: thermal, "
     "generator: {random: {bodies: 9, joint: spherical, seed: 2}}}]\n"
     "dynamics: {integrator: rattle, step: 0.002, steps: 20, temperature: 300, seed: 5}\noutput: "
     "{every: 5, checkpoint_every: 10, "
     "joint_forces: true}\n"},
    {"langevin_bodies",
     "chains: [{name: a, base: free, velocities: thermal, generator: {random: {bodies: 60, joint: "
     "spherical, seed: 1}}}]\n"
     "dynamics: {integrator: g-baoab, step: 0.002, steps: 20, friction: 1, seed: 5}\noutput: "
     "{every: 5, checkpoint_every: 10}\n"},
    {"rattle_beads_and_bodies",
     "chains: [{name: a, velocities: thermal, generator: {freely_jointed: {beads: 40, length: "
     "0.38}}}, {name: b, base: free, velocities: "
     "thermal, generator: {random: {bodies: 20, joint: spherical, seed: 1}}}]\n"
     "dynamics: {integrator: rattle, step: 0.002, steps: 20, temperature: 300, seed: 5}\noutput: "
     "{every: 5, checkpoint_every: 10}\n"},
    {"rk4_thermal",
     "chains: [{name: a, base: free, velocities: thermal, generator: {random: {bodies: 30, joint: "
     "spherical, seed: 1}}}]\n"
     "dynamics: {integrator: rk4, step: 0.001, steps: 20, temperature: 300}\noutput: {every: 5, "
     "checkpoint_every: 10}\n"},
    {"rk4_revolute",
     "chains: [{name: a, base: fixed, generator: {random: {bodies: 60, joint: revolute, seed: "
     "1}}}, {name: b, base: free, generator: "
     "{random: {bodies: 13, joint: "
     "revolute, seed: 2}}}]\n"
     "forces: {gravity: [0, 0, -1]}\n"
     "dynamics: {integrator: rk4, step: 0.001, steps: 20}\noutput: {every: 5, checkpoint_every: "
     "10}\n"},
    {"leapfrog_revolute",
     "chains: [{name: a, base: fixed, generator: {random: {bodies: 60, joint: revolute, seed: "
     "1}}}, {name: b, base: free, generator: {random: {bodies: 13, joint: spherical, seed: 2}}}]\n"
     "forces: {gravity: [0, 0, -1]}\n"
     "dynamics: {integrator: leapfrog, step: 0.001, steps: 20}\noutput: {every: 5, "
     "checkpoint_every: 10, joint_forces: true}\n"},
    {"pulled",
     "chains: [{name: a, bodies: [{mass: 1, position: [0, 0, 0], force: [-1, 0, 0]}, {mass: 1, "
     "position: [1, 0.5, 0], joint: {type: link}}, {mass: 1, position: [2, 0, 0], joint: {type: "
     "link}, force: [1, 0, 0]}]}, {name: b, " +
         pulled_zigzag(130) +
         "}]\n"
         "dynamics: {integrator: rattle, step: 0.001, steps: 20}\noutput: {every: 5, "
         "checkpoint_every: 10}\n"},
    {"pulled_branched",
     "chains: [{name: a, count: 3, bodies: [{mass: 1, position: [0, 0, 0], force: [-1, 0, 0]}, "
     "{mass: 1, position: [1, 0.5, 0], joint: {type: link}}, {mass: 1, position: [2, 0, 0], joint: "
     "{type: link}, force: [1, 0, 0]}, {mass: 1, position: [1, 1, 1], joint: {type: link}, parent: "
     "2, force: [0, 1, 2]}]}]\n"
     "dynamics: {integrator: g-baoab, step: 0.001, steps: 20, friction: 1, temperature: 300, seed: "
     "5}\noutput: {every: 5, checkpoint_every: 10}\n"},
    {"rk4_spherical",
     "chains: [{name: a, base: free, generator: {random: {bodies: 60, joint: spherical, seed: "
     "1}}}]\n"
     "dynamics: {integrator: rk4, step: 0.001, steps: 20}\noutput: {every: 5, checkpoint_every: "
     "10}\n"},
    {"rattle_tips",
     "chains: [{name: a, base: fixed, velocities: thermal, tip: {joint: {type: link, anchor: [2, "
     "3, 1]}}, generator: {freely_jointed: "
     "{beads: 70, length: 0.38}}}, {name: b, base: free, velocities: thermal, tip: {joint: {type: "
     "spherical}}, generator: {random: "
     "{bodies: 40, joint: spherical, seed: 3}}}]\n"
     "dynamics: {integrator: rattle, step: 0.002, steps: 20, temperature: 300, seed: 5}\noutput: "
     "{every: 5, checkpoint_every: 10, "
     "joint_forces: true}\n"},
    {"rattle_rings",
     "chains: [{name: a, base: free, velocities: thermal, generator: {polygon: {bodies: 60, joint: "
     "spherical, mass: 10}}, tip: {ring: "
     "{type: "
     "spherical, translation: [1, 0, 0]}}}, {name: b, velocities: thermal, generator: {polygon: "
     "{bodies: 150, joint: link, mass: 10}}, "
     "tip: ring}]\n"
     "dynamics: {integrator: rattle, step: 0.002, steps: 20, temperature: 300, seed: 5}\noutput: "
     "{every: 5, checkpoint_every: 10, "
     "joint_forces: true}\n"},
    {"langevin_ring",
     "chains: [{name: a, velocities: thermal, generator: {polygon: {bodies: 90, joint: link, "
     "length: 0.38, mass: 50}}, tip: ring}]\n"
     "dynamics: {integrator: g-baoab, step: 0.002, steps: 20, friction: 1, seed: 5}\noutput: "
     "{every: 5, checkpoint_every: 10}\n"},
    {"rk4_rings",
     "chains: [{name: a, base: free, generator: {polygon: {bodies: 60, joint: spherical, spin: [1, "
     "2, 3]}}, tip: {ring: {type: spherical, "
     "translation: [1, 0, 0]}}}, {name: b, base: free, generator: {polygon: {bodies: 7, joint: "
     "revolute, spin: [1, 2, 3]}}, tip: {ring: "
     "{type: revolute, axis: [0, 0, 1], translation: [1, 0, 0]}}}]\n"
     "dynamics: {integrator: rk4, step: 0.001, steps: 20}\noutput: {every: 5, checkpoint_every: "
     "10, joint_forces: true}\n"},
    {"langevin_linked",
     "chains: [{name: a, velocities: thermal, generator: {random: {bodies: 60, joint: link, rigid: "
     "0.5, seed: 8}}}, {name: b, base: fixed, "
     "velocities: "
     "thermal, generator: {random: {bodies: 25, joint: link, rigid: 0.3, seed: 9}}}]\n"
     "dynamics: {integrator: g-baoab, step: 0.002, steps: 20, friction: 1, seed: 5}\noutput: "
     "{every: 5, checkpoint_every: 10}\n"},
    {"langevin_held",
     "chains: [{name: a, base: fixed, velocities: thermal, tip: {joint: {type: link, anchor: [2, "
     "3, 1]}}, generator: {random: {bodies: 30, "
     "joint: link, rigid: 0.5, seed: 8}}}, {name: b, base: fixed, velocities: thermal, tip: "
     "{joint: {type: link, anchor: [2, 3, 1]}}, "
     "generator: {freely_jointed: {beads: 1, length: 2}}}]\n"
     "dynamics: {integrator: g-baoab, step: 0.002, steps: 20, friction: 1, seed: 5}\noutput: "
     "{every: 5, checkpoint_every: 10}\n"},
    {"rattle_on_its_centre",
     "chains: [{name: a, base: fixed, bodies: [{mass: 2, inertia: [1, 2, 2.5], joint: {type: "
     "spherical, qd: [1, 2, 3]}}]}]\n"
     "dynamics: {integrator: rattle, step: 0.002, steps: 20}\noutput: {every: 5, checkpoint_every: "
     "10}\n"},
    {"rk4_every_joint",
     "chains: [{name: a, base: free, generator: {random: {bodies: 60, joint: mixed, seed: 1}}}, "
     "{name: b, base: fixed, tip: {joint: {type: "
     "universal, axes: [[1, 0, 0], [0, 1, 0]]}}, generator: {random: {bodies: 40, joint: "
     "universal, seed: 2}}}, {name: c, base: fixed, "
     "generator: {random: {bodies: 33, joint: planar, seed: 2}}}]\n"
     "forces: {gravity: [0, 0, -1], drag: {linear: 0.1, angular: 0.1}}\n"
     "dynamics: {integrator: rk4, step: 0.001, steps: 20}\noutput: {every: 5, checkpoint_every: "
     "10, joint_forces: true}\n"},
    {"adaptive_every_joint",
     "chains: [{name: a, base: free, generator: {random: {bodies: 60, joint: mixed, seed: 1}}}, "
     "{name: b, base: fixed, generator: "
     "{random: {bodies: 40, joint: spherical, seed: 2}}}, {name: c, base: fixed, bodies: ["
     "{mass: 1, com: [0.1, 0, 0], inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 1, 0], "
     "motion: {amplitude: 0.5, frequency: 2}}},"
     "{mass: 1, com: [0.1, 0, 0], inertia: [1, 1, 1], joint: {type: spherical, translation: [0.2, "
     "0, 0], stiffness: [30, 40, 50]}}]}]\n"
     "forces: {gravity: [0, 0, -1], drag: {linear: 0.1, angular: 0.1}}\n"
     "dynamics: {integrator: dormand-prince, step: 0.03, steps: 20, tolerance: 1e-8}\noutput: "
     "{every: 5, checkpoint_every: 10}\n"},
    {"adaptive_driven_tip",
     "chains: [{name: a, base: fixed, bodies: ["
     "{mass: 1, com: [0.25, 0, 0], inertia: [0.1, 0.1, 0.1], joint: {type: revolute, axis: [0, 0, "
     "1], motion: {amplitude: 0.3, "
     "frequency: 0.7, phase: 0.4}}},"
     "{mass: 1, com: [0.25, 0, 0], inertia: [0.1, 0.1, 0.1], joint: {type: revolute, axis: [0, 0, "
     "1], translation: [0.5, 0, 0], q: 1}},"
     "{mass: 1, com: [0.25, 0, 0], inertia: [0.1, 0.1, 0.1], joint: {type: revolute, axis: [0, 0, "
     "1], translation: [0.5, 0, 0], q: 1}},"
     "{mass: 1, com: [0.25, 0, 0], inertia: [0.1, 0.1, 0.1], joint: {type: revolute, axis: [0, 0, "
     "1], translation: [0.5, 0, 0], q: 1}}], "
     "tip: {joint: {type: revolute, axis: [0, 0, 1], translation: [0.5, 0, 0]}}}]\n"
     "forces: {gravity: [0, -1, 0]}\n"
     "dynamics: {integrator: dormand-prince, step: 0.1, steps: 12, tolerance: 1e-8, "
     "constraint_tolerance: 1e-8}\n"
     "output: {every: 3, checkpoint_every: 6}\n"},
    {"adaptive_rings",
     "chains: [{name: a, base: free, generator: {polygon: {bodies: 60, joint: spherical, spin: [1, "
     "2, 3]}}, tip: {ring: {type: spherical, "
     "translation: [1, 0, 0]}}}, {name: b, base: fixed, tip: {joint: {type: spherical}}, "
     "generator: {random: {bodies: 20, joint: revolute, "
     "seed: 4}}}]\n"
     "dynamics: {integrator: dormand-prince, step: 0.01, steps: 20, tolerance: 1e-7}\noutput: "
     "{every: 5, checkpoint_every: 10, "
     "joint_forces: true}\n"},
    {"dormand_prince",
     "chains: [{name: a, base: free, generator: {random: {bodies: 60, joint: mixed, seed: 1}}}]\n"
     "dynamics: {integrator: dormand-prince, step: 0.001, steps: 20}\noutput: {every: 5, "
     "checkpoint_every: 10}\n"},
    {"verlet_every_joint",
     "chains: [{name: a, base: fixed, generator: {random: {bodies: 50, joint: helical, seed: 1}}}, "
     "{name: b, base: free, generator: "
     "{random: {bodies: 40, joint: mixed, seed: 2}}}, {name: c, base: fixed, bodies: ["
     "{mass: 1, com: [0.1, 0, 0], inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 1, 0], "
     "motion: {amplitude: 0.5, frequency: 2}}},"
     "{mass: 1, com: [0.1, 0, 0], inertia: [1, 1, 1], joint: {type: spherical, translation: [0.2, "
     "0, 0]}}]},"
     "{name: d, base: fixed, tip: {joint: {type: spherical}}, generator: {random: {bodies: 20, "
     "joint: revolute, seed: 4}}}]\n"
     "forces: {gravity: [0, 0, -1]}\n"
     "dynamics: {integrator: velocity-verlet, step: 0.001, steps: 20}\noutput: {every: 5, "
     "checkpoint_every: 10}\n"},
    {"staggered",
     "chains: [{name: a, generator: {elastic_rod: {bodies: 60, mass: 650, length: 0.34, radius: 1, "
     "bend: 50, twist: 100, seed: 1}}}, "
     "{name: "
     "b, base: fixed, tip: {joint: {type: spherical}}, generator: {elastic_rod: {bodies: 20, mass: "
     "650, length: 0.34, radius: 1, bend: 50, "
     "twist: 100}}}, {name: c, base: fixed, bodies: ["
     "{mass: 1, com: [0.1, 0, 0], inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 1, 0], "
     "stiffness: 1e6, damping: 10, q: 0.01}},"
     "{mass: 1, com: [0.1, 0, 0], inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 1, 0], "
     "motion: {amplitude: 0.5, frequency: 2}}},"
     "{mass: 1, com: [0.1, 0, 0], inertia: [1, 1, 1], joint: {type: universal, axes: [[1, 0, 0], "
     "[0.6, 0.8, 0]], stiffness: [1e3, 1e7]}},"
     "{mass: 1, com: [0.1, 0, 0], inertia: [1, 1, 1], joint: {type: helical, axis: [0, 0, 1], "
     "pitch: 0.1, damping: 1e3, qd: 1}},"
     "{mass: 1, com: [0.1, 0, 0], inertia: [1, 1, 1], joint: {type: spherical, translation: [0.2, "
     "0, 0]}}]}]\n"
     "forces: {gravity: [0, 0, -1]}\n"
     "dynamics: {integrator: staggered, step: 0.05, steps: 20}\noutput: {every: 5, "
     "checkpoint_every: 10}\n"},
    {"implicit_langevin",
     "chains: [{name: a, generator: {elastic_rod: {bodies: 60, mass: 650, length: 0.34, radius: 1, "
     "bend: 50, twist: 100, seed: 1}}}, "
     "{name: "
     "b, base: fixed, tip: {joint: {type: spherical}}, generator: {elastic_rod: {bodies: 20, mass: "
     "650, length: 0.34, radius: 1, bend: 50, "
     "twist: 100}}}]\n"
     "dynamics: {integrator: implicit-baoab, step: 0.05, steps: 20, friction: 0.01, seed: "
     "5}\noutput: {every: 5, checkpoint_every: 10}\n"},
    {"implicit_langevin_rods",
     "chains: [{name: a, generator: {elastic_rod: {bodies: 60, mass: 650, length: 0.34, radius: 1, "
     "bend: 50, twist: 100, seed: 1}}}, "
     "{name: "
     "b, base: free, velocities: thermal, generator: {random: {bodies: 40, joint: spherical, seed: "
     "1, mass: 100, loads: false}}}]\n"
     "dynamics: {integrator: implicit-g-baoab, step: 0.5, steps: 20, friction: 0.02, seed: "
     "5}\noutput: {every: 5, checkpoint_every: 10}\n"},
    {"langevin_every_joint",
     "chains: [{name: a, base: free, generator: {random: {bodies: 60, joint: mixed, seed: 1}}}, "
     "{name: c, base: fixed, generator: {random: "
     "{bodies: 33, joint: planar, seed: 2}}}, {name: d, base: fixed, tip: {joint: {type: "
     "spherical}}, generator: {random: {bodies: 20, "
     "joint: revolute, seed: 4}}}]\n"
     "dynamics: {integrator: baoab, step: 0.001, steps: 20, friction: 1, seed: 5}\noutput: {every: "
     "5, checkpoint_every: 10}\n"},
};

}  // namespace catena::test
