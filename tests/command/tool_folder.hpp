// A folder with files of another tool, for tests of `catena import`.
#pragma once

#include <OpenMM.h>
#include <fmt/format.h>
#include <openmm/serialization/XmlSerializer.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {

namespace fs = std::filesystem;

inline constexpr int beads = 12;

/// The folder `mine` with a System of twelve beads, 1 nm apart on springs that become links.
class ToolFolder : public ::testing::Test {
  protected:
    TemporaryFolder here;

    void SetUp() override {
        fs::create_directories(here / "mine");
        OpenMM::System system;
        auto* bonds = new OpenMM::HarmonicBondForce;
        for (int p = 0; p < beads; ++p) {
            system.addParticle(100);
            if (p > 0) bonds->addBond(p - 1, p, 1, 5000);
        }
        system.addForce(bonds);
        serialize(system, "System", "system.xml");
    }
    std::string file(std::string const& name) const { return here / ("mine/" + name); }
    void write(std::string const& name, std::string const& text) const {
        std::ofstream(file(name)) << text;
    }
    std::string text_in(std::string const& name) const {
        std::ostringstream text;
        text << std::ifstream(here / name).rdbuf();
        return text.str();
    }
    template <class Object>
    void serialize(Object const& object, std::string const& root, std::string const& name) const {
        std::ofstream out(file(name));
        OpenMM::XmlSerializer::serialize(&object, root, out);
    }
    /// Writes `atoms` atoms along x, `spacing` apart in the file's own unit.
    void write_pdb(std::string const& name, int atoms, double spacing,
                   std::string const& title = "") const {
        std::ostringstream text;
        if (!title.empty()) text << "TITLE     " << title << "\nMODEL     1\n";
        for (int k = 1; k <= atoms; ++k)
            text << fmt::format(
                "ATOM  {:5d}  CA  ASP A{:4d}    {:8.3f}{:8.3f}{:8.3f}  1.00  0.00           C\n", k,
                k, spacing * k, 0.0, 0.0);
        write(name, text.str() + "END\n");
    }
    void write_state(std::string const& name) const {
        OpenMM::System system;
        std::vector<OpenMM::Vec3> positions;
        for (int p = 0; p < beads; ++p) {
            system.addParticle(100);
            positions.emplace_back(p, 0, 0);
        }
        OpenMM::VerletIntegrator integrator(0.001);
        OpenMM::Context context(system, integrator,
                                OpenMM::Platform::getPlatformByName("Reference"));
        context.setPositions(positions);
        serialize(context.getState(OpenMM::State::Positions), "State", name);
    }
    /// Cuts a file to a part of its length.
    void cut(std::string const& name, double part) const {
        fs::resize_file(file(name),
                        static_cast<std::uintmax_t>(part * double(fs::file_size(file(name)))));
    }
    Ended import(Words more = {}) const {
        more.insert(more.begin(), {"import", "mine", "--overwrite"});
        return catena(more, here.path());
    }
    void expect_noted(std::string const& part, Words const& more = {}) const {
        Ended const e = import(more);
        ASSERT_EQ(e.status, 0) << e.err;
        EXPECT_NE(e.out.find(part), std::string::npos) << e.out;
    }
};

}  // namespace catena::test
