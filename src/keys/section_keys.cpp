// Declares the keys of the scene file itself and of its sections but `chains`.
#include "keys/maps.hpp"

namespace catena::scene::keys {
namespace {

constexpr Key top_keys[] = {
    {"title", "text", "the file's name", "", "Reports and pictures bear this title.",
     "title: two arms"},
    {"units", "`md`, `si`", "`md`", "",
     "`md` means nm, ps, amu, kJ/mol and kelvin; `si` takes numbers as they are.", "units: si"},
    {"chains", "list of maps", "required*", "",
     "Each entry describes one chain or several copies of it.",
     "chains: [{sequence: GGG, model: calvados2}]"},
    {"replicas", "integer >= 1", "1", "",
     "The chains exist this many times, as replicas NAME-1, NAME-2 and so on, without forces "
     "between them.",
     "replicas: 256"},
    {"box", "`none`, or a map", "`none`", "",
     "Forces act across the sides of this periodic box; positions stay unwrapped.",
     "box: {periodic: [60, 60, 60]}"},
    {"forces", "map", "none", "", "Gravity, drag and OpenMM's forces act on the bodies.",
     "forces: {gravity: [0, 0, -9.81]}"},
    {"dynamics", "map", "none", "",
     "`run` needs to know how the chains move: integrator, step, temperature.",
     "dynamics: {integrator: rk4, step: 0.01}"},
    {"solver", "map", "all defaults", "",
     "The solver's backend, handles and threads are chosen here.", "solver: {backend: serial}"},
    {"output", "map", "all defaults", "",
     "A run writes frames, checkpoints and observables as often as this map says.",
     "output: {every: 50}"},
    {"relax", "true, false", "false", "",
     "Overlaps in the start positions are relaxed before the first step.", "relax: true"},
    {"place", "map", "the whole box", "",
     "Chains without positions start in a slab or another region of the box.",
     "place: {slab: {axis: z, thickness: 20}}"},
    {"start", "map", "as the chains say", "", "All chains start from a frame of another run.",
     "start: {from: run-1, frame: last}"},
};

constexpr Key box_keys[] = {
    {"periodic", "3 numbers > 0", "required without `cubic`", "length",
     "The rectangular periodic box has these edges.", "periodic: [60, 60, 60]"},
    {"cubic", "map", "none", "", "The periodic box is the cube that a concentration asks for.",
     "cubic: {concentration: 5 mg/ml}"},
    {"fill", "3 numbers > 0", "the whole box", "length",
     "Chains start in a region with these edges in the middle of the box, such as a slab or a "
     "droplet.",
     "fill: [8, 8, 10]"},
};

constexpr Key cubic_keys[] = {
    {"concentration", "number with unit", "required", "",
     "All chains together have this concentration; units are mg/ml, g/l, mol/l, mmol/l, umol/l.",
     "concentration: 5 mg/ml"},
};

constexpr Key place_keys[] = {
    {"slab", "map", "none", "", "Chains start in a slab in the middle of the box.",
     "slab: {axis: z, thickness: 20}"},
    {"region", "map", "none", "", "Chains start between two corners of a part of the box.",
     "region: {from: [0, 0, 10], to: [20, 20, 30]}"},
};

constexpr Key slab_keys[] = {
    {"axis", "`x`, `y`, `z`", "`z`", "", "The slab's faces are normal to this axis.", "axis: x"},
    {"thickness", "number > 0", "required", "length", "The slab is this thick.", "thickness: 20"},
};

constexpr Key region_keys[] = {
    {"from", "3 numbers", "required", "length", "The region begins at this corner.",
     "from: [0, 0, 10]"},
    {"to", "3 numbers", "required", "length", "The region ends at this corner.",
     "to: [20, 20, 30]"},
};

constexpr Key start_keys[] = {
    {"from", "path", "required", "",
     "Positions come from this run's folder, its `trajectory.h5md`, or a DCD file.", "from: run-1"},
    {"frame", "`last`, or integer >= 0", "`last`", "",
     "The start is this frame of the trajectory; frames count from 0.", "frame: 57"},
};

constexpr Key drag_keys[] = {
    {"linear", "number >= 0", "0", "mass / time",
     "The liquid exerts the force -linear v at the centre of mass.", "linear: 0.2"},
    {"angular", "number >= 0", "0", "mass length^2 / time",
     "The liquid exerts the torque -angular omega.", "angular: 0.01"},
};

constexpr Key forces_keys[] = {
    {"gravity", "3 numbers", "`[0, 0, 0]`", "length / time^2",
     "Every mass has this acceleration, given in W.", "gravity: [0, 0, -9.81]"},
    {"drag", "map", "none", "",
     "Viscous drag acts on every rigid body that has no `drag` of its own.",
     "drag: {linear: 0.2, angular: 0.01}"},
    {"openmm", "map", "none", "", "OpenMM computes forces on all beads; this needs `units: md`.",
     "openmm: {builder: calvados2}"},
};
constexpr std::string_view forces_later[] = {"springs", "torques"};

constexpr Key openmm_keys[] = {
    {"builder", "`calvados2`, `calvados3`", "none", "",
     "Catena builds this force field: Ashbaugh-Hatch up to 2 nm and Yukawa up to 4 nm, with links "
     "in the place of bonds; RNA has further terms.",
     "builder: calvados2"},
    {"system", "path", "none", "", "The forces are those of this serialised OpenMM System (XML).",
     "system: system.xml"},
    {"topology", "path", "required with `system` unless `map` is given", "",
     "This PDB file has one atom per particle, in the System's order, and tells the chains apart.",
     "topology: topology.pdb"},
    {"map", "map", "none", "",
     "Each chain's name has its [first, last] particle of the System, counted from 0, both "
     "included.",
     "map: {asyn: [0, 139]}"},
    {"temperature", "number > 0", "that of `dynamics`, else 300", "kelvin",
     "A builder takes the permittivity of water at this temperature; a System the thermal spread "
     "of its bonds.",
     "temperature: 300"},
    {"ionic_strength", "number >= 0", "0.15", "mol/l",
     "The builder screens charges by a salt of this strength.", "ionic_strength: 0.15"},
    {"ph", "number, 0 to 14", "none: neutral", "",
     "The builder gives histidine the charge 1 / (1 + 10^(pH - 6)) e.", "ph: 7"},
    {"switch_width", "number >= 0", "0", "length",
     "The builder switches pair terms off over this width before each cutoff; 0 cuts them as "
     "published.",
     "switch_width: 0.2"},
    {"platform", "text", "CUDA with backend `cuda`, else CPU, else Reference, as far as present",
     "", "OpenMM computes on this platform.", "platform: Reference"},
    {"precision", "`single`, `mixed`, `double`", "the platform's", "",
     "OpenMM's GPU platforms compute with this precision.", "precision: mixed"},
    {"threads", "integer >= 0", "0: the rank's cores, at most one for every 500 beads", "",
     "OpenMM's CPU platform has this number of threads on each rank.", "threads: 2"},
    {"device", "integer >= 0", "that of the chains with backend `cuda`, else OpenMM's choice", "",
     "OpenMM computes on the GPU of this number.", "device: 0"},
    {"path", "`auto`, `device`, `host`, `inline`", "`auto`", "",
     "Positions and forces stay on the GPU (`device`), pass through a worker on the host (`host`) "
     "or wait for each other (`inline`).",
     "path: inline"},
    {"overlap", "true, false", "true", "",
     "Matrices are assembled while forces are computed; false shows what this saves.",
     "overlap: false"},
    {"layers", "`auto`, `all`, `none`", "`auto`", "",
     "Far pair forces that act on few beads, such as charges, get an OpenMM Context of their own.",
     "layers: none"},
    {"split", "`auto`, `ghosts`, `pairs`", "`auto`", "",
     "Ranks on path `device` share out beads with their ghosts, or pairs.", "split: ghosts"},
    {"replicate", "true, false", "false", "",
     "Every rank has all beads and computes all forces; this is slower, and for forces that cannot "
     "be split.",
     "replicate: true"},
    {"audit", "true, false", "false", "",
     "Every evaluation compares the ghosts of each rank with a slow search among all beads, and "
     "ends the run if one is missed.",
     "audit: true"},
    {"force_groups", "list of integers, 0 to 31", "all", "",
     "Only these force groups of the System count.", "force_groups: [1, 2]"},
    {"leave_out", "list of texts", "none", "",
     "Forces of the System with one of these names or kinds do not count.",
     "leave_out: [CustomExternalForce]"},
    {"links", "map of lengths", "none", "length",
     "Bonds of a CustomBondForce, by its name or kind, become rigid links of this length where "
     "they "
     "join beads of a chain.",
     "links: {FENE: 0.97}"},
    {"extra", "list of paths", "none", "",
     "These serialised forces of OpenMM (XML) act in addition: restraints, pulling, umbrella "
     "windows.",
     "extra: [pull.xml]"},
    {"charge_termini", "`both`, `N`, `C`, `none`", "`both`", "",
     "These ends are charged termini in chains without a `charge_termini` of their own.",
     "charge_termini: N"},
};

constexpr Key dynamics_keys[] = {
    {"integrator",
     "`rk4`, `dormand-prince`, `velocity-verlet`, `leapfrog`, `staggered`, `baoab`, "
     "`implicit-baoab`, `rattle`, `g-baoab`, `implicit-g-baoab`",
     "required", "", "One integrator moves all chains of the scene.", "integrator: g-baoab"},
    {"step", "number > 0", "required", "time",
     "A step is this long; with a `tolerance` it is made of shorter inner steps.", "step: 0.01"},
    {"steps", "integer >= 0", "required by `run` without `--steps`", "",
     "The run ends after this number of steps; 0 writes one frame of the start.", "steps: 1e5"},
    {"temperature", "number >= 0", "300", "kelvin",
     "The thermostat and thermal starts have this temperature.", "temperature: 300"},
    {"friction", "number >= 0", "0.01; required by Langevin integrators with `units: si`",
     "1 / time", "Langevin integrators damp all velocities at this rate; 0 means no thermostat.",
     "friction: 0.01"},
    {"seed", "integer, 0 to 2^64 - 1", "1", "",
     "Noise, thermal starts and random chains follow from this number.", "seed: 1"},
    {"constraint_tolerance", "number > 0", "1e-10", "",
     "A run whose constraint violation exceeds this is INVALID.", "constraint_tolerance: 1e-12"},
    {"tolerance", "number, 1e-13 to 0.1", "none: steps as long as `step`", "",
     "An inner step of `dormand-prince` adds at most this relative error.", "tolerance: 1e-8"},
    {"fixman", "true, false", "false", "",
     "Chains of beads get Fixman's potential 1/2 kT log det T, with T the matrix of the links and "
     "kT that of `temperature`.",
     "fixman: true"},
};

constexpr Key solver_keys[] = {
    {"backend", "`auto`, `serial`, `segments`, `openmp`, `cuda`, `cuda-levels`", "`auto`", "",
     "Evaluations run on one core, on threads or on a GPU; `auto` takes what is predicted to be "
     "quickest.",
     "backend: serial"},
    {"handles", "`projected`, `full`, `articulated`", "`projected`", "",
     "Matrices have the directions that joints restrict, all directions, or all of runs held at "
     "their inboard side.",
     "handles: articulated"},
    {"threads", "integer >= 0",
     "0: the host's cores over its ranks, or fewer if `auto` finds that quicker", "",
     "Each rank has this number of threads with `openmp`, and for what GPUs leave to the host.",
     "threads: 2"},
    {"gpu_levels", "`auto`, `all`, `K` or `\"UP,DOWN\"`", "`auto`", "",
     "With `cuda-levels` the GPU assembles the lowest UP levels of merges and disassembles the "
     "lowest DOWN; one number is both.",
     "gpu_levels: \"6,2\""},
    {"simd", "`auto`, `off`, `avx2`, `avx512`", "`auto`", "",
     "Runs of bodies go side by side through the processor's vectors of this kind.", "simd: off"},
    {"refine", "integer, 0 to 10", "0", "",
     "Every solution in joint coordinates gets this number of steps of iterative refinement.",
     "refine: 2"},
    {"balance", "true, false", "false", "",
     "`run` cuts the chains by the measured speeds of the ranks.", "balance: true"},
};
constexpr std::string_view solver_later[] = {"precision"};

constexpr Key output_keys[] = {
    {"every", "integer >= 1", "100", "steps",
     "Frames and lines of `observables.csv` are this far apart; the last state is always one.",
     "every: 50"},
    {"checkpoint_every", "integer >= 0", "0: none by steps", "steps",
     "Checkpoints are this far apart; the last state is always saved.", "checkpoint_every: 1000"},
    {"checkpoint_minutes", "number >= 0", "30", "minutes",
     "Further checkpoints follow after this wall time; 0 means none.", "checkpoint_minutes: 10"},
    {"observables", "list of names", "all that the scene has", "",
     "`observables.csv` has a column for each of these.", "observables: [energy]"},
    {"joint_forces", "true, false", "false", "",
     "The trajectory holds constraint forces, also those of tips.", "joint_forces: true"},
    {"velocities", "true, false", "false", "", "The trajectory holds velocities.",
     "velocities: true"},
    {"coordinates", "true, false", "false", "",
     "The trajectory holds positions and velocities of rigid bodies, and those of joints if they "
     "are integrated.",
     "coordinates: true"},
};

}  // namespace

constinit KeyMap const top{"scene", "the scene file", top_keys};
constinit KeyMap const box{"box", "box", box_keys};
constinit KeyMap const cubic{"box.cubic", "box.cubic", cubic_keys};
constinit KeyMap const place{"place", "place, chains[i].place", place_keys};
constinit KeyMap const slab{"place.slab", "place.slab", slab_keys};
constinit KeyMap const region{"place.region", "place.region", region_keys};
constinit KeyMap const start{"start", "start", start_keys};
constinit KeyMap const forces{"forces", "forces", forces_keys, forces_later};
constinit KeyMap const drag{"forces.drag", "forces.drag, chains[i].bodies[k].drag", drag_keys};
constinit KeyMap const openmm{"forces.openmm", "forces.openmm", openmm_keys};
constinit KeyMap const dynamics{"dynamics", "dynamics", dynamics_keys};
constinit KeyMap const solver{"solver", "solver", solver_keys, solver_later};
constinit KeyMap const output{"output", "output", output_keys};

}  // namespace catena::scene::keys
