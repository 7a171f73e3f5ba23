#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "io/output.hpp"
#include "io/output_file.hpp"
#include "math/executor.hpp"
#include "sample_frames.hpp"
#include "temporary_folder.hpp"

namespace catena::test {
namespace {

std::vector<std::string> lines_of(std::string const& file, std::string const& record) {
    std::istringstream in(read_text_file(file));
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(record)) lines.push_back(line);
    return lines;
}

/// `chains` chains of `count` beads, one bead a nm further than the other.
Topology rows_of_beads(std::int64_t chains, std::int64_t count, Frame& frame) {
    Topology topology;
    for (std::int64_t c = 0; c < chains; ++c)
        topology.chains.push_back({"chain", c * count, count, true, false});
    topology.mass.assign(static_cast<std::size_t>(chains * count), 100);
    topology.residue.assign(topology.mass.size(), "GLY");
    for (std::int64_t k = 0; k < chains * count; ++k)
        frame.positions.push_back(
            {{static_cast<double>(k % count) - 0.5,
              std::floor(static_cast<double>(k) / static_cast<double>(count)), -1.25}});
    return topology;
}

TEST(Topology, PdbColumnsAreThoseOfTheFormat) {
    TemporaryFolder const folder;
    Topology topology = sample_topology();
    Frame frame = sample_frame(1, topology);
    frame.positions[0] = {{1.23456, -0.5, 12.3}};
    EXPECT_EQ(write_topology(folder.path(), topology, frame),
              (std::vector<std::string>{folder / "topology.pdb", folder / "topology.psf"}));
    auto const atoms = lines_of(folder / "topology.pdb", "ATOM");
    ASSERT_EQ(atoms.size(), 8U);
    EXPECT_EQ(atoms[0],
              "ATOM      1  CA  MET A   1      12.346  -5.000 123.000  1.00  0.00           C");
    EXPECT_TRUE(atoms[5].starts_with("ATOM      6  CA  BDY B   1    ")) << atoms[5];
    EXPECT_EQ(lines_of(folder / "topology.pdb", "CRYST1"),
              (std::vector<std::string>{
                  "CRYST1  100.000  110.000  120.000  90.00  90.00  90.00 P 1           1"}));
    EXPECT_EQ(lines_of(folder / "topology.pdb", "CONECT"),
              (std::vector<std::string>{"CONECT    1    2", "CONECT    2    1    3",
                                        "CONECT    3    2    4", "CONECT    4    3    5",
                                        "CONECT    5    4", "CONECT    6    7",
                                        "CONECT    7    6    8", "CONECT    8    7"}));
    topology.box.reset();
    topology.chains[0].ring = true;
    write_topology(folder.path(), topology, frame);
    EXPECT_TRUE(lines_of(folder / "topology.pdb", "CRYST1").empty());
    EXPECT_EQ(lines_of(folder / "topology.pdb", "CONECT")[0], "CONECT    1    5    2");
}

/// A star of six arms: the bonds go to the bead on which each hangs, four to a record.
TEST(Topology, BondsFollowBranches) {
    TemporaryFolder const folder;
    Frame frame;
    Topology topology = rows_of_beads(2, 7, frame);
    topology.chains[1].parent = {-1, 0, 0, 0, 0, 0, 0};
    write_topology(folder.path(), topology, frame);
    auto const bonds = lines_of(folder / "topology.pdb", "CONECT");
    ASSERT_EQ(bonds.size(), 15U);
    EXPECT_EQ(bonds[6], "CONECT    7    6");
    EXPECT_EQ(bonds[7], "CONECT    8    9   10   11   12");
    EXPECT_EQ(bonds[8], "CONECT    8   13   14");
    EXPECT_EQ(bonds[14], "CONECT   14    8");
    std::string const psf = read_text_file(folder / "topology.psf");
    EXPECT_NE(psf.find("      12 !NBOND: bonds\n"), std::string::npos);
    EXPECT_NE(psf.find("       8      14\n"), std::string::npos);
}

TEST(Topology, NamesAndNumbersWrapAsThePdbAllows) {
    TemporaryFolder const folder;
    Frame frame;
    Topology const topology = rows_of_beads(64, 2, frame);
    write_topology(folder.path(), topology, frame);
    auto const atoms = lines_of(folder / "topology.pdb", "ATOM");
    EXPECT_EQ(atoms[2 * 25][21], 'Z');
    EXPECT_EQ(atoms[2 * 26][21], 'a');
    EXPECT_EQ(atoms[2 * 61][21], '9');
    EXPECT_EQ(atoms[2 * 62][21], 'A');
    Frame long_frame;
    write_topology(folder.path(), rows_of_beads(1, 10002, long_frame), long_frame);
    auto const beads = lines_of(folder / "topology.pdb", "ATOM");
    EXPECT_EQ(beads[9998].substr(22, 4), "9999");
    EXPECT_EQ(beads[9999].substr(22, 4), "   0");
    EXPECT_EQ(beads[10001].substr(22, 4), "   2");
}

TEST(Topology, PartsAndThreadsWriteTheSameLines) {
    for (auto const& [chains, count] : {std::pair<std::int64_t, std::int64_t>{7, 13}, {30, 3400}}) {
        TemporaryFolder const folder;
        Frame frame;
        Topology const topology = rows_of_beads(chains, count, frame);
        auto const text_of = [](std::vector<std::string> const& files) {
            std::string all;
            for (std::string const& file : files) all += read_text_file(file);
            return all;
        };
        std::string const whole = text_of(write_topology(folder.path(), topology, frame));
        for (int const threads : {1, 2, 3, 8})
            for (std::ptrdiff_t const most : {5L, 13L, 26L, 9999L}) {
                if (count > 100 && most < 9999) continue;
                auto const executor =
                    openmp_is_built() ? openmp_executor(threads) : serial_executor();
                TopologyWriter writer(folder.path(), topology);
                for (auto at = frame.positions.begin(); at != frame.positions.end();) {
                    auto const end = at + std::min(most, frame.positions.end() - at);
                    writer.put({at, end}, *executor);
                    at = end;
                }
                EXPECT_TRUE(text_of(writer.finish()) == whole)
                    << threads << " threads, " << most << " sites at a time";
            }
    }
}

TEST(Topology, LargeCoordinatesLoseDecimalsNotColumns) {
    TemporaryFolder const folder;
    Frame frame;
    Topology const topology = rows_of_beads(1, 4, frame);
    frame.positions = {{{999.9, 0, 0}}, {{12345.6789, 0, 0}}, {{-1e6, 0, 0}}, {{1e9, 0, 0}}};
    write_topology(folder.path(), topology, frame);
    auto const atoms = lines_of(folder / "topology.pdb", "ATOM");
    EXPECT_EQ(atoms[0].substr(30, 8), "9999.000");
    EXPECT_EQ(atoms[1].substr(30, 8), "123456.8");
    EXPECT_EQ(atoms[2].substr(30, 8), "   0.000");
    EXPECT_EQ(atoms[3].substr(30, 8), "   0.000");
    for (std::string const& atom : atoms) EXPECT_EQ(atom.size(), 78U);
}

TEST(Topology, MetresAreShownAtAScaleThatIsNamed) {
    TemporaryFolder const folder;
    Frame frame;
    Topology topology = rows_of_beads(1, 3, frame);
    topology.si = true;
    for (Vec3& x : frame.positions) x = 0.02 * x;
    write_topology(folder.path(), topology, frame);
    EXPECT_EQ(lines_of(folder / "topology.pdb", "ATOM")[1].substr(30, 8), "   1.000");
    EXPECT_EQ(lines_of(folder / "topology.pdb", "REMARK").back(),
              "REMARK   1 COORDINATES: 1 ANGSTROM STANDS FOR 1E-02 M");
}

TEST(Topology, BeyondThePdbsSerialsMmcifIsWrittenAsWell) {
    TemporaryFolder const folder;
    Frame frame;
    Topology const topology = rows_of_beads(30, 3400, frame);
    EXPECT_EQ(write_topology(folder.path(), topology, frame),
              (std::vector<std::string>{folder / "topology.pdb", folder / "topology.cif"}));
    auto const atoms = lines_of(folder / "topology.pdb", "ATOM");
    ASSERT_EQ(atoms.size(), 102000U);
    EXPECT_EQ(atoms[99998].substr(6, 5), "99999");
    EXPECT_EQ(atoms[99999].substr(6, 5), "A0000");
    EXPECT_EQ(atoms[100000 + 36 - 1].substr(6, 5), "A0010");
    EXPECT_TRUE(lines_of(folder / "topology.pdb", "CONECT").empty());
    auto const rows = lines_of(folder / "topology.cif", "ATOM");
    ASSERT_EQ(rows.size(), 102000U);
    EXPECT_EQ(rows.back(),
              "ATOM 102000 C CA . GLY AD 1 3400 ? 33985.000 290.000 -12.500 1.00 0.00 3400 AD 1");
}

}  // namespace
}  // namespace catena::test
