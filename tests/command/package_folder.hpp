// Folders of the CALVADOS package, for tests of `catena import`.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {

namespace fs = std::filesystem;

inline std::string text_in(std::string const& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

inline void write(std::string const& file, std::string const& text) { std::ofstream(file) << text; }

/// Replaces the first `part` of a file.
inline void replace_in(std::string const& file, std::string const& part, std::string const& other) {
    std::string text = text_in(file);
    text.replace(text.find(part), part.size(), other);
    write(file, text);
}

/// Configuration of the CALVADOS package as its prepare.py writes it, as far as it matters.
inline std::string config_of(std::string const& name, std::string const& more) {
    std::string const box = name == "slab"  ? "- 8.2\n- 8.2\n- 30\n"
                            : name == "idr" ? "- 50\n- 50\n- 50\n"
                                            : "- 20\n- 20\n- 20\n";
    return "box:\n" + box +
           "ext_force_expr: step(d2-18)*d2; d2=periodicdistance(x, y, z, 0, 0, z)^2\nfrestart: "
           "restart.chk\nfriction_coeff: 0.02\nrandom_number_seed: null\nrestart: "
           "checkpoint\nruntime: 0\nsteps: 7070000\nsysname: " +
           name + "\ntemp: 293.15\ntopol: center\nwfreq: 7000\n" + more;
}

/// A folder `name` of the CALVADOS package in `parent`, from tests/data/cases/calvados-folders.
inline std::string package_folder(TemporaryFolder const& parent, std::string const& name,
                                  std::string const& more = "slab_eq: false\n") {
    std::string const folder = parent / name, data = CATENA_TEST_DATA "/cases/calvados-folders/";
    fs::create_directories(folder);
    fs::copy_file(data + name + ".xml", folder + "/" + name + ".xml");
    fs::copy_file(data + name + ".pdb", folder + "/top.pdb");
    write(folder + "/config.yaml", config_of(name, more));
    write(folder + "/components.yaml",
          "defaults:\n  nmol: 1\n  restraint: false\nsystem:\n  " + name +
              ":\n    nmol: " + (name == "slab" ? "8" : "1") +
              "\n    restraint: " + (name == "two-domains" ? "true" : "false") + "\n");
    return folder;
}

}  // namespace catena::test
