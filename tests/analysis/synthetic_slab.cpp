// Writes the folder of a run that no simulation made, for the comparison with MDAnalysis and numpy:
//   analysis_synthetic_slab FOLDER
// Three kinds of chains in a slab across the faces of a long periodic box; they drift, unwrapped.
// Frames are 100 steps apart, and a last one is not.
#include <cstdio>
#include <filesystem>

#include "tests/analysis/sample_trajectory.hpp"

namespace catena::test {
namespace {

constexpr int frames = 60;
constexpr double time_step = 0.01;  // ps

Topology slab_topology() {
    Topology topology = topology_of({24, 24, 24, 24, 13, 13, 8});
    topology.title = "a slab, synthetic";
    topology.chains[6].ring = true;
    for (std::size_t k = 0; k < topology.mass.size(); ++k)
        topology.mass[k] = 57 + 30.5 * static_cast<double>(k < 96 ? k % 24 : k % 5);
    for (std::size_t k = 109; k < 122; ++k) topology.mass[k] = topology.mass[k - 13];
    for (std::size_t k = 0; k < topology.mass.size(); ++k)
        topology.residue[k] = topology.mass[k] > 100 ? "LYS" : "GLY";
    topology.box = Vec3{{6, 7, 30}};
    return topology;
}

void write_run(std::filesystem::path const& folder) {
    Topology const topology = slab_topology();
    RandomChains draw(2026);
    std::vector<Vec3> place;
    for (std::size_t c = 0; c < topology.chains.size(); ++c)
        place.push_back({{6 * draw.uniform(), 7 * draw.uniform(), 2 * draw.normal() + 29}});
    std::filesystem::create_directories(folder);
    auto const trajectory =
        make_trajectory((folder / "trajectory.h5md").string(), topology, false, false, {});
    for (int f = 0; f <= frames; ++f) {
        Frame frame;
        frame.step = f < frames ? 100 * f : 100 * frames - 50;
        frame.time = time_step * static_cast<double>(frame.step);
        for (std::size_t c = 0; c < topology.chains.size(); ++c) {
            place[c] = plus_scaled(place[c], 0.4, draw.gaussian());
            for (Vec3 const& x : draw.chain(static_cast<std::size_t>(topology.chains[c].count),
                                            0.38, c < 4 ? 0.8 : 0.6))
                frame.positions.push_back(place[c] + x);
        }
        trajectory->write(frame);
        if (f == 0) write_topology(folder.string(), topology, frame);
    }
    trajectory->close();
}

}  // namespace
}  // namespace catena::test

int main(int count, char** arguments) {
    if (count != 2) {
        std::fputs("usage: analysis_synthetic_slab FOLDER\n", stderr);
        return 2;
    }
    try {
        catena::test::write_run(arguments[1]);
    } catch (std::exception const& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    std::printf("%s\n", arguments[1]);
}
