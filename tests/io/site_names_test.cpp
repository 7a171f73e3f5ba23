// Members of complexes in topology files: identifiers, residue numbers, terminal records, bonds.
#include "io/site_names.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "io/output_file.hpp"
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

/// Lines of a PSF file from the line that holds `title` to the next blank line, that line left out.
std::vector<std::string> section_of(std::string const& file, std::string const& title) {
    std::istringstream in(read_text_file(file));
    std::vector<std::string> lines;
    bool inside = false;
    for (std::string line; std::getline(in, line);) {
        if (inside && line.empty()) break;
        if (inside) lines.push_back(line);
        inside = inside || line.find(title) != std::string::npos;
    }
    return lines;
}

/// Topology of chains with these numbers of sites.
Topology chains_of(std::vector<std::int64_t> const& counts) {
    Topology topology;
    for (std::int64_t const count : counts) {
        topology.chains.push_back({"chain", std::ssize(topology.mass), count, true, false});
        topology.mass.resize(topology.mass.size() + static_cast<std::size_t>(count), 100);
    }
    topology.residue.assign(topology.mass.size(), "GLY");
    return topology;
}

/// A chain of 9 sites and one of 3. The first joins members H and L: residues 12 and 11 of H, the
/// body of H 10, L -1 to 1 and H 12A, and residues 3 and 4 of L behind a gap.
Topology complex() {
    Topology topology = chains_of({9, 3});
    topology.members = {
        {"H", "L"},
        {{0, 3, 0, 2, 12, -1}, {3, 3, 1, 0, -1, 1}, {6, 1, 0, 3, 12, 1, 'A'}, {7, 2, 1, 4, 3, 1}}};
    return topology;
}

Frame zeros(Topology const& topology) {
    Frame frame;
    frame.positions.assign(topology.mass.size(), Vec3::zero());
    return frame;
}

TEST(SiteNames, MembersHaveTheIdentifiersAndNumbersOfTheirFile) {
    TemporaryFolder const folder;
    Topology const topology = complex();
    write_topology(folder.path(), topology, zeros(topology));
    std::vector<std::string> found;
    for (std::string const& atom : lines_of(folder / "topology.pdb", "ATOM"))
        found.push_back(atom.substr(21, 6));
    EXPECT_EQ(found, (std::vector<std::string>{"H  12 ", "H  11 ", "H  10 ", "L  -1 ", "L   0 ",
                                               "L   1 ", "H  12A", "L   3 ", "L   4 ", "A   1 ",
                                               "A   2 ", "A   3 "}));
    std::vector<std::string> psf;
    for (std::string const& atom : section_of(folder / "topology.psf", "!NATOM"))
        psf.push_back(atom.substr(9, atom.find(" GLY") - 9));
    EXPECT_EQ(psf, (std::vector<std::string>{"H 12", "H 11", "H 10", "L -1", "L 0", "L 1", "H 12A",
                                             "L 3", "L 4", "A 1", "A 2", "A 3"}));
}

TEST(SiteNames, TerminalRecordsEndMembers) {
    TemporaryFolder const folder;
    Topology const topology = complex();
    write_topology(folder.path(), topology, zeros(topology));
    std::string order;
    std::istringstream in(read_text_file(folder / "topology.pdb"));
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("ATOM")) order += line[21];
        if (line.starts_with("TER")) order += '|';
    }
    EXPECT_EQ(order, "HHHLLLH|LL|AAA|");
}

TEST(SiteNames, BondsFollowResiduesAndJoinNoMembers) {
    TemporaryFolder const folder;
    Topology const topology = complex();
    EXPECT_EQ(SiteNames(topology).bonds(),
              (std::vector<SiteNames::Bond>{
                  {2, 1}, {1, 0}, {0, 6}, {3, 4}, {4, 5}, {7, 8}, {9, 10}, {10, 11}}));
    write_topology(folder.path(), topology, zeros(topology));
    EXPECT_EQ(lines_of(folder / "topology.pdb", "CONECT"),
              (std::vector<std::string>{
                  "CONECT    1    2    7", "CONECT    2    3    1", "CONECT    3    2",
                  "CONECT    4    5", "CONECT    5    4    6", "CONECT    6    5",
                  "CONECT    7    1", "CONECT    8    9", "CONECT    9    8", "CONECT   10   11",
                  "CONECT   11   10   12", "CONECT   12   11"}));
    EXPECT_EQ(section_of(folder / "topology.psf", "!NBOND"),
              (std::vector<std::string>{
                  "       3       2       2       1       1       7       4       5",
                  "       5       6       8       9      10      11      11      12"}));
}

TEST(SiteNames, IdentifiersOfSeveralMembersCount) {
    Topology topology = chains_of({2, 2, 2, 2});
    topology.members = {{"X", "B", "X", "has blank"}, {{0, 2, 0}, {2, 2, 1}, {4, 2, 2}, {6, 2, 3}}};
    SiteNames const names(topology);
    ASSERT_EQ(names.members(), 4U);
    EXPECT_EQ(names.identifier(0), "A");
    EXPECT_EQ(names.identifier(1), "B");
    EXPECT_EQ(names.identifier(2), "C");
    EXPECT_EQ(names.identifier(3), "D");
}

TEST(SiteNames, LongIdentifiersGetFreeLetters) {
    Topology topology = chains_of({1, 1, 1});
    topology.members = {{"B-2", "A", "heavy"}, {{0, 1, 0}, {1, 1, 1}, {2, 1, 2}}};
    SiteNames const names(topology);
    EXPECT_EQ(names.identifier(0), "B-2");
    EXPECT_EQ(names.identifier(2), "heavy");
    EXPECT_EQ(names.letter(0), 'B');
    EXPECT_EQ(names.letter(1), 'A');
    EXPECT_EQ(names.letter(2), 'C');
}

TEST(SiteNames, MmcifHasPlacesAndNumbers) {
    TemporaryFolder const folder;
    std::vector<std::int64_t> counts{9, 3};
    counts.push_back(100000);
    Topology topology = chains_of(counts);
    topology.members = complex().members;
    write_topology(folder.path(), topology, zeros(topology));
    auto const rows = lines_of(folder / "topology.cif", "ATOM");
    ASSERT_EQ(rows.size(), 100012U);
    EXPECT_EQ(rows[0], "ATOM 1 C CA . GLY H 1 3 ? 0.000 0.000 0.000 1.00 0.00 12 H 1");
    EXPECT_EQ(rows[6], "ATOM 7 C CA . GLY H 1 4 A 0.000 0.000 0.000 1.00 0.00 12 H 1");
    EXPECT_EQ(rows[8], "ATOM 9 C CA . GLY L 1 6 ? 0.000 0.000 0.000 1.00 0.00 4 L 1");
    EXPECT_EQ(rows[9], "ATOM 10 C CA . GLY A 1 1 ? 0.000 0.000 0.000 1.00 0.00 1 A 1");
}

}  // namespace
}  // namespace catena::test
