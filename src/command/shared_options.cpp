// Implements the options that several commands have.
#include "command/shared_options.hpp"

namespace catena::command {
namespace {

/// Values that options accept.
constexpr std::string_view log_levels[] = {"trace", "debug", "info", "warn", "error", "off"};
constexpr std::string_view handle_names[] = {"projected", "full", "articulated"};

/// Declares the options that every command has.
void add_answer(OptionList& list, CommonOptions& c) {
    list.value(
        "--json", c.json, "FILE",
        "also write the results as JSON; - writes them to standard output instead of the text");
    list.flag("--quiet", c.quiet, "print errors only");
    list.value("--log-level", c.log_level, "LEVEL",
               "log lines on standard error: trace | debug | info | warn (default) | error | off");
}

/// Declares the options of every command with a scene or a benchmark.
void add_solver(OptionList& list, CommonOptions& c) {
    list.values("--set", c.set, "KEY.PATH=VALUE",
                "override a key of the scene, as in --set chains[0].count=10 (may be repeated)");
    list.value("--handles", c.handles, "KIND",
               "directions that the solver's blocks carry: projected (default) | full (6x6, beads "
               "3x3) | articulated (for ill-conditioned open chains on joints)");
    list.value("--threads", c.threads, "N",
               "threads per rank, for openmp and for work that GPUs leave to the host (0: cores of "
               "the host divided by its ranks)");
    list.value("--simd", c.simd, "LEVEL",
               "vector instructions for runs of bodies: auto (default: the widest) | avx512 | avx2 "
               "| off");
    list.value("--gpu-levels", c.gpu_levels, "UP[,DOWN]",
               "for cuda-levels: number of lowest tree levels that the GPU assembles (UP) and "
               "disassembles (DOWN), 0 to all; from 1 on also the bodies (auto: as predicted)");
}

/// Declares --backend for one backend.
void add_backend(OptionList& list, CommonOptions& c) {
    list.value("--backend", c.backend, "NAME",
               "auto (default) | serial | segments | openmp | cuda | cuda-levels (GPU and CPU "
               "together, see --gpu-levels)");
}

}  // namespace

void add_shared(OptionList& list, CommonOptions& common, SharedOptions shared) {
    if (shared == SharedOptions::backend) add_backend(list, common);
    if (shared != SharedOptions::answer) add_solver(list, common);
    add_answer(list, common);
}

void add_repeat(OptionList& list, std::string& text, std::string const& otherwise) {
    list.value("--repeat", text, "R", "number of timed evaluations (default " + otherwise + ")");
}

void add_refine(OptionList& list, CommonOptions& common) {
    list.value("--refine", common.refine, "K",
               "steps of iterative refinement of solutions in joint coordinates (default: the "
               "scene's solver.refine, 0): 1 or 2 restore the digits lost to nearly parallel "
               "revolute joints, light bodies between heavy ones and thin bodies");
}

void add_scene(OptionList& list, std::string& text) {
    list.argument("SCENE", text, "scene file (YAML)");
}

CommonOptions checked(CommonOptions c) {
    if (!c.backend.empty()) backend_named("--backend", c.backend);
    if (!c.handles.empty()) known_value("--handles", c.handles, handle_names);
    if (!c.threads.empty())
        c.threads = std::to_string(whole_number("--threads", c.threads, 0, 4096));
    if (!c.refine.empty()) c.refine = std::to_string(whole_number("--refine", c.refine, 0, 10));
    known_value("--log-level", c.log_level, log_levels);
    return c;
}

int repeat_of(std::string const& text, int otherwise) {
    return text.empty() ? otherwise : static_cast<int>(whole_number("--repeat", text, 1, 1000000));
}

std::vector<std::int64_t> sizes_of(std::string const& text) {
    std::vector<std::int64_t> sizes;
    if (!text.empty())
        for (std::string const& size : comma_list("--sizes", text))
            sizes.push_back(whole_number("--sizes", size, 1, 1000000000));
    return sizes;
}

}  // namespace catena::command
