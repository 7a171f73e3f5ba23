#include "command/requests.hpp"

namespace catena::command {

std::vector<std::string> overrides_of(CommonOptions const& options) {
    std::vector<std::string> all = options.set;
    auto const add = [&](char const* key, std::string const& value) {
        if (!value.empty()) all.push_back("solver." + std::string(key) + "=" + value);
    };
    add("backend", options.backend);
    add("gpu_levels", options.gpu_levels);
    add("handles", options.handles);
    add("simd", options.simd);
    add("threads", options.threads);
    add("refine", options.refine);
    return all;
}

}  // namespace catena::command
