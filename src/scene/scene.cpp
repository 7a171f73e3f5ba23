// Implements the names of enumerators and the small queries of Scene.
#include "scene/scene.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "joints/joint_models.hpp"

namespace catena {

std::string Scene::name_in_file(std::size_t chain) const {
    std::string const& name = chains[chain].name;
    return replicas > 1 ? name.substr(0, name.rfind('-')) : name;
}

std::int64_t Scene::bodies() const {
    std::int64_t sum = 0;
    for (ChainSpec const& chain : chains) sum += static_cast<std::int64_t>(chain.size());
    return sum;
}

void Scene::note(std::string text) {
    // Repetitions of a note follow shortly after it. A search of all notes would be quadratic if
    // each of many chains has a note of its own.
    std::size_t constexpr looked_at = 1000;
    auto const from = notes.end() - static_cast<std::ptrdiff_t>(std::min(notes.size(), looked_at));
    if (std::find(from, notes.end(), text) == notes.end()) notes.push_back(std::move(text));
}

GpuLevels SolverSpec::levels_on_gpu() const {
    auto const number = [](std::string const& part) {
        return part == "auto" || part == "all" ? GpuLevels::all : std::stoi(part);
    };
    std::size_t const comma = gpu_levels.find(',');
    return {number(gpu_levels.substr(0, comma)),
            number(comma == std::string::npos ? gpu_levels : gpu_levels.substr(comma + 1))};
}

char const* name_of(JointType type) {
    return with_joint(type, [](auto model) { return decltype(model)::name; });
}

char const* name_of(Backend backend) {
    switch (backend) {
        case Backend::automatic:
            return "auto";
        case Backend::serial:
            return "serial";
        case Backend::segments:
            return "segments";
        case Backend::openmp:
            return "openmp";
        case Backend::cuda:
            return "cuda";
        case Backend::cuda_levels:
            return "cuda-levels";
    }
    return "?";
}

char const* name_of(Handles handles) {
    switch (handles) {
        case Handles::projected:
            return "projected";
        case Handles::full:
            return "full";
        case Handles::articulated:
            return "articulated";
    }
    return "?";
}

}  // namespace catena
