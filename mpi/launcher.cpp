// Detection of launchers by their environment variables.
#include "mpi/launcher.hpp"

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <optional>

namespace catena {
namespace {

/// Returns the value of a variable if it is a non-negative integer.
std::optional<int> number(char const* variable) {
    char const* const text = variable != nullptr ? std::getenv(variable) : nullptr;
    if (text == nullptr) return std::nullopt;
    int value = 0;
    char const* const end = text + std::strlen(text);
    auto const parsed = std::from_chars(text, end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end || value < 0) return std::nullopt;
    return value;
}

/// Names of the variables of one launcher.
struct Variables {
    char const* rank;
    char const* size;
};

// PMIx has no variable for the size. Under Slurm the job step's size is right; SLURM_NTASKS is not,
// because a batch script has it as well.
constexpr Variables known[] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                               {"PMI_RANK", "PMI_SIZE"},
                               {"MV2_COMM_WORLD_RANK", "MV2_COMM_WORLD_SIZE"},
                               {"PMIX_RANK", "SLURM_STEP_NUM_TASKS"}};

}  // namespace

Launch launch_environment() {
    for (Variables const& v : known) {
        std::optional<int> const rank = number(v.rank);
        if (!rank) continue;
        std::optional<int> const size = number(v.size);
        Launch launch{true, *rank, size && *size > *rank ? *size : *rank + 1, ""};
        launch.evidence = size ? std::string(v.size) + "=" + std::to_string(*size)
                               : std::string(v.rank) + "=" + std::to_string(*rank);
        return launch;
    }
    return {};
}

}  // namespace catena
