// Implements the calibration cache. The file name contains a checksum of the machine's identity.
#include "plan/cache.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io/checksum.hpp"
#include "io/output.hpp"

namespace catena::plan {

std::string cache_file(Machine const& machine) {
    char const *const cache = std::getenv("XDG_CACHE_HOME"), *const home = std::getenv("HOME");
    std::filesystem::path folder;
    if (cache && *cache)
        folder = cache;
    else if (home && *home)
        folder = std::filesystem::path(home) / ".cache";
    if (folder.empty()) return {};
    Checksum sum;
    sum.add(std::string_view(machine.identity));
    char name[40];
    std::snprintf(name, sizeof name, "calibration-%016llx.json",
                  static_cast<unsigned long long>(sum.value()));
    return folder / "catena" / name;
}

Calibration read_cache(Machine const& machine) {
    try {
        auto const json = nlohmann::json::parse(std::ifstream(cache_file(machine)));
        if (json.at("machine") != machine.identity) return {};
        Calibration found;
        found.read(json);
        return found;
    } catch (std::exception const&) {
        return {};
    }
}

bool write_cache(Machine const& machine, Calibration const& calibration) {
    std::string const file = cache_file(machine);
    if (file.empty()) return false;
    try {
        std::filesystem::create_directories(std::filesystem::path(file).parent_path());
        nlohmann::json json = calibration.json();
        json["machine"] = machine.identity;
        write_text_file(file,
                        json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
        return true;
    } catch (std::exception const&) {
        return false;
    }
}

}  // namespace catena::plan
