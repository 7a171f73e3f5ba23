#include "tests/force/beads.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <set>

#include "structure/calvados2.hpp"

namespace catena::testing {

BeadSystem split(BeadSystem beads, int ranks) {
    beads.first_of_rank.clear();
    for (int r = 0; r <= ranks; ++r) beads.first_of_rank.push_back(beads.size() * r / ranks);
    return beads;
}

BeadSystem proteins(std::vector<std::string> const& sequences, int ranks,
                    std::optional<Vec3> const& box) {
    BeadSystem beads;
    beads.box = box;
    beads.scene_file = "scene.yaml";
    beads.chain_offset.push_back(0);
    for (auto const& sequence : sequences) {
        beads.chain_name.emplace_back(1, static_cast<char>('A' + beads.chain_name.size()));
        std::int64_t const n = std::ssize(sequence);
        for (std::int64_t k = 0; k < n; ++k) {
            auto const* residue = find_calvados2(sequence[k]);
            if (k > 0) beads.links.push_back({beads.size() - 1, beads.size(), residue->bond});
            beads.mass.push_back(calvados2::bead_mass(*residue, {k, n}));
            beads.residue.push_back(residue->name);
        }
        beads.chain_offset.push_back(beads.size());
    }
    return split(beads, ranks);
}

std::vector<Vec3> wound(BeadSystem const& beads, std::uint64_t seed) {
    std::vector<Vec3> positions;
    for (std::size_t c = 0; c + 1 < beads.chain_offset.size(); ++c) {
        std::size_t const column = c % 3, row = c / 3;
        for (std::int64_t k = 0; k < beads.chain_offset[c + 1] - beads.chain_offset[c]; ++k) {
            double const turn = 0.9 * static_cast<double>(k);
            positions.push_back({{0.3 * static_cast<double>(k),
                                  1.7 * static_cast<double>(column) + 0.35 * std::cos(turn),
                                  1.7 * static_cast<double>(row) + 0.35 * std::sin(turn)}});
        }
    }
    shake(positions, 0.05, seed);
    return positions;
}

void shake(std::vector<Vec3>& positions, double amplitude, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> step(-amplitude, amplitude);
    for (auto& x : positions)
        for (int c = 0; c < 3; ++c) x[c] += step(random);
}

std::string random_sequence(std::size_t length, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::string sequence;
    for (std::size_t k = 0; k < length; ++k) sequence += calvados2_residues()[random() % 20].letter;
    return sequence;
}

std::vector<Vec3> evaluate(OpenMmForce& force, BeadSystem const& beads, int rank,
                           std::vector<Vec3> const& all) {
    std::int64_t const first = beads.first_of_rank[rank],
                       own = beads.first_of_rank[rank + 1] - first;
    Field<3> positions(own), forces(own);
    for (std::int64_t k = 0; k < own; ++k) positions.set(k, all[first + k]);
    force.begin(std::as_const(positions).view());
    force.finish(forces.view());
    std::vector<Vec3> result;
    for (std::int64_t k = 0; k < own; ++k) result.push_back(forces[k]);
    return result;
}

std::vector<Vec3> evaluate(OpenMmForce& force, std::vector<Vec3> const& all) {
    BeadSystem whole;
    whole.first_of_rank = {0, std::ssize(all)};
    return evaluate(force, whole, 0, all);
}

double largest(std::vector<Vec3> const& forces) {
    double value = 0;
    for (auto const& f : forces) value = std::max(value, norm(f));
    return value;
}

double difference(std::vector<Vec3> const& part, std::vector<Vec3> const& whole,
                  std::int64_t first) {
    double value = 0;
    for (std::size_t k = 0; k < part.size(); ++k)
        for (int c = 0; c < 3; ++c)
            value = std::max(value, std::abs(part[k][c] - whole[first + k][c]));
    return value;
}

OpenMmSpec on_reference(std::string const& builder) {
    OpenMmSpec spec;
    spec.builder = builder;
    spec.platform = "Reference";
    spec.path = "inline";
    return spec;
}

std::string scratch_file(std::string const& name, std::string const& text) {
    static struct Files {
        std::set<std::string> paths;
        ~Files() {
            for (auto const& path : paths) std::remove(path.c_str());
        }
    } files;
    std::string const path = fmt::format("{}catena-{}-{}", ::testing::TempDir(), getpid(), name);
    std::ofstream(path) << text;
    files.paths.insert(path);
    return path;
}

std::string pdb_of(BeadSystem const& beads, std::vector<Vec3> const& positions) {
    std::string text;
    for (std::size_t c = 0; c + 1 < beads.chain_offset.size(); ++c) {
        for (std::int64_t k = beads.chain_offset[c]; k < beads.chain_offset[c + 1]; ++k)
            text += fmt::format(
                "ATOM  {:5}  CA  {:>3} {}{:4}    {:8.3f}{:8.3f}{:8.3f}  1.00  0.00\n", k + 1,
                beads.residue[k], beads.chain_name[c], k - beads.chain_offset[c] + 1,
                10 * positions[k][0], 10 * positions[k][1], 10 * positions[k][2]);
        text += "TER\n";
    }
    return text + "END\n";
}

}  // namespace catena::testing
