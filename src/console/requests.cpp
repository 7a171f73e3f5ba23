// Implements overrides from options, and the defaults of benchmarks.
#include "console/requests.hpp"

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

std::vector<std::int64_t> bench_sizes(std::string const& name) {
    if (name == "solve" || name == "evaluation") return {1000, 10000, 100000};
    if (name == "peers") return {100, 200, 500, 1000, 10000, 100000};
    std::vector<std::int64_t> sizes;
    if (name == "plan")
        for (std::int64_t bodies = 16; bodies <= 1 << 20; bodies *= 2) sizes.push_back(bodies);
    if (name == "figures")
        for (std::int64_t bodies = 2; bodies <= 2048; bodies *= 2) sizes.push_back(bodies);
    return sizes;
}

bool bench_takes(std::string const& name, std::string const& option) {
    if (option == "--joints")
        return name == "solve" || name == "evaluation" || name == "peers" || name == "plan";
    if (option == "--alike") return name == "solve" || name == "evaluation";
    if (option == "--loads") return name == "solve" || name == "evaluation" || name == "peers";
    if (option == "--sizes" || option == "--repeat") return name != "sampling";
    return name == "figures" || (name == "overlap" && option == "--output");
}

}  // namespace catena::command
