// Writes the folder of a run that no simulation made, so that its readers (MDAnalysis, the plot,
// the report) can be tested alone:
//   io_synthetic_run beads|bodies|si FOLDER
// beads: alpha-synuclein, one bead a residue, links of exactly 0.38 nm that turn at random; bodies:
// a chain of rigid bodies beside one of beads in a periodic box, with velocities and joint forces;
// si: a pendulum in metres.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <random>

#include "io/output.hpp"

namespace catena {
namespace {

// UniProt P37840
constexpr std::string_view alpha_synuclein =
    "MDVFMKGLSKAKEGVVAAAEKTKQGVAEAAGKTKEGVLYVGSKTKEGVVHGVATVAEKTKEQVTNVGGAVVTGVTAVAQKTVEGAGSIAAATGF"
    "VKKDQLGKNEEGAPQEGILEDMPVDPDNEAYEMPSEEGYQ"
    "DYEPEA";
constexpr double residue_mass = 110, link = 0.38, boltzmann = 0.00831446261815324;
constexpr std::int64_t steps_between_frames = 100;

std::string three_letters(char one) {
    static constexpr std::pair<char, char const*> names[] = {
        {'A', "ALA"}, {'C', "CYS"}, {'D', "ASP"}, {'E', "GLU"}, {'F', "PHE"},
        {'G', "GLY"}, {'H', "HIS"}, {'I', "ILE"}, {'K', "LYS"}, {'L', "LEU"},
        {'M', "MET"}, {'N', "ASN"}, {'P', "PRO"}, {'Q', "GLN"}, {'R', "ARG"},
        {'S', "SER"}, {'T', "THR"}, {'V', "VAL"}, {'W', "TRP"}, {'Y', "TYR"}};
    auto const* const found = std::find_if(std::begin(names), std::end(names),
                                           [&](auto const& entry) { return entry.first == one; });
    return found->second;
}

/// A freely turning chain: every link's direction follows its neighbour's and wanders.
class Wanderer {
  public:
    Wanderer(std::size_t sites, double length, double stiffness)
        : length_(length), directions_(sites), noise_(12345) {
        for (std::size_t k = 0; k < sites; ++k)
            directions_[k] =
                unit(plus_scaled(gaussian(), stiffness, k > 0 ? directions_[k - 1] : gaussian()));
    }
    void wander(double amount) {
        Vec3 shared = gaussian();
        for (Vec3& direction : directions_) {
            shared = 0.9 * shared + 0.43 * gaussian();
            direction = unit(plus_scaled(direction, amount, shared));
        }
    }
    std::vector<Vec3> positions(Vec3 from) const {
        std::vector<Vec3> all;
        for (Vec3 const& direction : directions_) {
            all.push_back(from);
            from = plus_scaled(from, length_, direction);
        }
        return all;
    }
    Vec3 gaussian() { return {{normal_(noise_), normal_(noise_), normal_(noise_)}}; }
    double number() { return normal_(noise_); }

  private:
    static Vec3 unit(Vec3 const& v) { return (1 / norm(v)) * v; }
    double length_;
    std::vector<Vec3> directions_;
    std::mt19937 noise_;
    std::normal_distribution<double> normal_;
};

Topology beads_topology() {
    Topology topology;
    topology.title = "alpha-synuclein, synthetic";
    topology.chains = {{"asyn", 0, static_cast<std::int64_t>(alpha_synuclein.size()), true, false}};
    for (char const residue : alpha_synuclein) topology.residue.push_back(three_letters(residue));
    topology.mass.assign(alpha_synuclein.size(), residue_mass);
    return topology;
}

Topology bodies_topology() {
    Topology topology;
    topology.title = "bodies and beads, synthetic";
    topology.chains = {{"arm", 0, 20, false, false}, {"tail", 20, 10, true, false}};
    topology.residue.assign(20, "BDY");
    topology.residue.resize(30, "UNK");
    topology.mass.assign(30, 50);
    topology.bodies.resize(20);
    std::iota(topology.bodies.begin(), topology.bodies.end(), 0);
    topology.box = Vec3{{6, 7, 8}};
    return topology;
}

Topology si_topology() {
    Topology topology;
    topology.title = "pendulum in metres, synthetic";
    topology.chains = {{"pendulum", 0, 12, false, false}};
    topology.residue.assign(12, "BDY");
    topology.mass.assign(12, 12);
    topology.bodies.resize(12);
    std::iota(topology.bodies.begin(), topology.bodies.end(), 0);
    topology.si = true;
    return topology;
}

std::vector<double> observables_of(Frame const& frame, Wanderer& wanderer) {
    Vec3 centre = Vec3::zero();
    double const count = static_cast<double>(frame.positions.size());
    for (Vec3 const& x : frame.positions) centre = plus_scaled(centre, 1 / count, x);
    double squares = 0;
    for (Vec3 const& x : frame.positions) squares += dot(x - centre, x - centre) / count;
    double const kinetic = 1.5 * count * boltzmann * (300 + 20 * wanderer.number()),
                 potential = -120 + 6 * wanderer.number();
    return {potential,
            kinetic,
            potential + kinetic,
            kinetic / (1.5 * count * boltzmann),
            1e-12 * std::exp(wanderer.number()),
            std::sqrt(squares),
            norm(frame.positions.back() - frame.positions.front())};
}

void add_optional_parts(Frame& frame, Topology const& topology, Wanderer& wanderer) {
    for (std::size_t k = 0; k < topology.mass.size(); ++k) {
        frame.velocities.push_back(0.1 * wanderer.gaussian());
        Vec3 const torque = wanderer.gaussian(), force = wanderer.gaussian();
        frame.joint_forces.push_back(
            {{torque[0], torque[1], torque[2], force[0], force[1], force[2]}});
    }
    for (std::size_t k = 0; k < topology.bodies.size(); ++k)
        frame.orientations.push_back(from_rotation_vector(wanderer.gaussian()));
}

std::string timeline() {
    std::string ranks;
    for (int rank = 0; rank < 2; ++rank)
        ranks += std::string(rank > 0 ? "," : "") + R"({"rank": )" + std::to_string(rank) +
                 R"(, "steps": [{"step": 5000, "phases": [
            {"name": "kinematics", "lane": "main", "begin": 0, "end": 8e-6}, {"name": "forces", "lane": "OpenMM worker", "begin": 9e-6, "end": 1.9e-4},
            {"name": "matrix sweep", "lane": "main", "begin": 1e-5, "end": 9.1e-5}, {"name": "wait for forces", "lane": "main", "begin": 9.1e-5, "end": 1.92e-4},
            {"name": "bias sweep", "lane": "main", "begin": 1.92e-4, "end": 2.2e-4}, {"name": "exchange", "lane": "main", "begin": 2.2e-4, "end": 2.32e-4},
            {"name": "integrate", "lane": "main", "begin": 2.32e-4, "end": 2.4e-4}]}]})";
    return R"({"ranks": [)" + ranks + "]}\n";
}

std::string summary(Topology const& topology) {
    return R"({"title": ")" + topology.title +
           R"(", "scene": "none", "catena": "0.1.0", "ranks": 2, "threads": 1, "steps": 20000, "valid": true,
 "rate": {"steps_per_second": 3512.4, "ns_per_day": 3034.7, "wall_seconds": 5.694},
 "solver": {"backend": "segments", "handles": "projected", "residual": 3.1e-16, "residual_bound": 1.7e-14},
 "forces": {"platform": "CPU", "version": "8.6.1", "hidden_fraction": 0.83, "terms": {"ashbaugh_hatch": -121.5, "yukawa": 4.25}},
 "phases": [{"name": "forces", "seconds": 3.62, "share": 0.64}, {"name": "matrix sweep", "seconds": 1.62, "share": 0.28}, {"name": "bias sweep", "seconds": 0.45, "share": 0.08}]}
)";
}

void write_run(std::string const& kind, std::filesystem::path const& folder) {
    Topology const topology = kind == "beads"    ? beads_topology()
                              : kind == "bodies" ? bodies_topology()
                                                 : si_topology();
    bool const beads = kind == "beads";
    double const length = topology.si ? 1 : link;
    std::int64_t const frames = beads ? 201 : 11;
    double const time_step = topology.si ? 1e-3 : 0.01;
    Wanderer wanderer(topology.mass.size(), length, 1.6);
    std::filesystem::create_directories(folder);
    auto const trajectory =
        make_trajectory((folder / "trajectory.h5md").string(), topology, !beads, !beads, {});
    std::string const energy = topology.si ? " [J]" : " [kJ/mol]",
                      distance = topology.si ? " [m]" : " [nm]";
    ObservablesWriter table(
        (folder / "observables.csv").string(),
        {"potential_energy" + energy, "kinetic_energy" + energy, "total_energy" + energy,
         "temperature [K]", "constraint_error" + distance, "radius_of_gyration" + distance,
         "end_to_end_distance" + distance},
        {}, topology.si ? "s" : "ps");
    for (std::int64_t k = 0; k < frames; ++k) {
        Frame frame;
        frame.step = k * steps_between_frames;
        frame.time = static_cast<double>(frame.step) * time_step;
        frame.positions = wanderer.positions({{3, 3, 3}});
        if (!beads) add_optional_parts(frame, topology, wanderer);
        trajectory->write(frame);
        table.write(frame.step, frame.time, observables_of(frame, wanderer));
        if (k == 0) write_topology(folder.string(), topology, frame);
        wanderer.wander(0.06);
    }
    trajectory->close();
    table.close();
    write_text_file((folder / "summary.json").string(), summary(topology));
    write_text_file((folder / "timeline.json").string(), timeline());
    write_run_report(folder.string());
}

}  // namespace
}  // namespace catena

int main(int count, char** arguments) {
    std::string const kind = count > 1 ? arguments[1] : "";
    if (count != 3 || (kind != "beads" && kind != "bodies" && kind != "si")) {
        std::fputs("usage: io_synthetic_run beads|bodies|si FOLDER\n", stderr);
        return 2;
    }
    try {
        catena::write_run(kind, arguments[2]);
    } catch (std::exception const& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    std::printf("%s\n", arguments[2]);
}
