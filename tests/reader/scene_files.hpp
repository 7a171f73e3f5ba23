// Scenes and the files they name, in a folder of their own.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "reader/load_scene.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace fs = std::filesystem;

/// A folder of its own, removed at the end. Messages are compared with its path cut out.
class SceneFiles : public testing::Test {
  protected:
    SceneFiles()
        : folder_(fs::temp_directory_path() /
                  (std::string("catena-scene-") +
                   testing::UnitTest::GetInstance()->current_test_info()->name() + "-" +
                   std::to_string(::getpid()))) {
        fs::create_directories(folder_);
    }
    ~SceneFiles() override { fs::remove_all(folder_); }

    std::string write(std::string const& name, std::string const& text) const {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }
    Scene read(std::string const& yaml) const {
        return parse_scene(yaml, (folder_ / "s.yaml").string());
    }
    std::string refusal(std::string const& yaml) const {
        return without_folder(refusal_of(yaml, {}, (folder_ / "s.yaml").string()));
    }
    std::string refusal_of_file(std::string const& name) const {
        try {
            load_scene((folder_ / name).string());
        } catch (InputError const& error) {
            return without_folder(error.what());
        }
        return "accepted";
    }
    std::vector<std::string> notes_of(Scene const& scene) const {
        std::vector<std::string> notes;
        for (std::string const& note : scene.notes) notes.push_back(without_folder(note));
        return notes;
    }
    std::string without_folder(std::string message) const {
        std::string const prefix = folder_.string() + "/";
        for (std::size_t at; (at = message.find(prefix)) != std::string::npos;)
            message.erase(at, prefix.size());
        return message;
    }

    fs::path folder_;
    std::string const with_table_ =
        "chains: [{sequence: GAS, model: calvados2, positions: start.csv}]";
    std::string const with_fasta_ = "chains: [{fasta: a.fasta, model: calvados2}]";
    std::string const with_pdb_ = "chains: [{pdb: a.pdb, model: calvados2, links: as_given}]";
};

inline std::string atom(int serial, std::string const& name, std::string const& residue, char chain,
                        int number, double x, char alternate = ' ', double y = 0.5,
                        double z = -0.25) {
    char line[100];
    std::snprintf(line, sizeof line, "ATOM  %5d  %-3s%c%-3s %c%4d    %8.3f%8.3f%8.3f  1.00  0.00\n",
                  serial, name.c_str(), alternate, residue.c_str(), chain, number, x, y, z);
    return line;
}

}  // namespace catena::test
