// Implements the options of `bench sampling`.
#include "bench/sampling_options.hpp"

#include <fmt/format.h>

#include <utility>

#include "bench/sampling_rows.hpp"
#include "console/option_values.hpp"
#include "error.hpp"

namespace catena::command {
namespace {

/// Bounds of the options: ps, and number of steps between samples.
constexpr double longest_step = 1, longest_time = 1e9;  // ps
constexpr double most_steps = 1e9;                      // between samples

/// Throws InputError if an option of `bench sampling` was given for another benchmark.
void refuse_for(SamplingOptionTexts const& words, std::string const& name) {
    for (auto const& [option, given] : {std::pair{"SCENE", words.scene},
                                        {"--copies", words.copies},
                                        {"--methods", words.methods},
                                        {"--steps", words.steps},
                                        {"--duration", words.duration},
                                        {"--discard", words.discard},
                                        {"--every", words.every},
                                        {"--equilibrate", words.equilibration},
                                        {"--seconds", words.seconds},
                                        {"--dense", words.dense ? "yes" : ""}})
        if (!given.empty())
            throw InputError(
                fmt::format("catena bench {1} does not take {0}",
                            option == std::string("SCENE") ? "`" + given + "`" : option, name),
                "command line", "leave it out");
}

/// Returns a value of --steps in ps; throws InputError for one that looks like femtoseconds.
double step_of(std::string const& text) {
    double const step = number_between("--steps", text, 1e-6, longest_time);
    if (step > longest_step)
        throw InputError(fmt::format("{:.6g} ps is {:.6g} fs", step, 1000 * step), "--steps",
                         "give time steps in ps, such as 0.01");
    return step;
}

}  // namespace

void add_sampling(OptionList& bench, SamplingOptionTexts& words) {
    auto const add = [&](char const* option, std::string& word, char const* type,
                         char const* what) {
        bench.value(option, word, type, std::string("for sampling: ") + what);
    };
    add("SCENE", words.scene, "",
        "a scene of one chain with CALVADOS 2, with --dense of any number (default: "
        "alpha-synuclein)");
    add("--copies", words.copies, "N", "chains side by side that never meet (default 71)");
    bench.flag("--dense", words.dense,
               "for sampling: all chains of the scene in their periodic box, instead of copies "
               "that never meet; energies, contacts, and densities of slabs are compared, too "
               "(default scene: --copies of alpha-synuclein at 330 mg/ml)");
    add("--methods", words.methods, "M,...",
        "rigid, rigid-fixman, bonds, constraints: Catena's rigid links, without and with the "
        "Fixman potential; OpenMM's harmonic bonds and constraints (default: all but "
        "rigid-fixman)");
    add("--steps", words.steps, "H,...", "time steps, ps (default 0.01)");
    add("--duration", words.duration, "T", "sampled time of each copy, ps (default 1000)");
    add("--discard", words.discard, "T", "time of each row before sampling, ps (default 200)");
    add("--every", words.every, "T", "time between samples, ps (default 1)");
    add("--equilibrate", words.equilibration, "T",
        "time on rigid links before all rows, ps (default: five times --discard)");
    add("--seconds", words.seconds, "S",
        "limit of the run time of each row, s (default: no limit)");
}

SamplingOptions sampling_options(SamplingOptionTexts const& words, std::string const& name,
                                 std::string const& json) {
    SamplingOptions options;
    if (name != "sampling") {
        refuse_for(words, name);
        return options;
    }
    options.scene = words.scene;
    require_files_apart(words.scene, json, "");
    options.dense = words.dense;
    if (words.dense && !words.scene.empty() && !words.copies.empty())
        throw InputError("--copies repeats one chain, and --dense takes all chains of SCENE",
                         "--copies", "set chains[0].count of the scene");
    if (!words.copies.empty()) options.copies = whole_number("--copies", words.copies, 1, 100000);
    if (!words.methods.empty()) options.methods = comma_list("--methods", words.methods);
    for (std::string const& method : options.methods) sampling_method_named("--methods", method);
    if (!words.steps.empty()) {
        options.steps.clear();
        for (std::string const& step : comma_list("--steps", words.steps))
            options.steps.push_back(step_of(step));
    }
    auto const take = [](std::string const& option, std::string const& word, double least,
                         double& value) {
        if (!word.empty()) value = number_between(option, word, least, longest_time);
    };
    take("--duration", words.duration, 1e-6, options.duration);
    take("--discard", words.discard, 0, options.discard);
    take("--every", words.every, 1e-6, options.every);
    if (options.every > options.duration)
        throw InputError(fmt::format("{} ps between samples are more than the {} ps sampled",
                                     options.every, options.duration),
                         "--every", "give a shorter time, or a longer --duration");
    for (double const step : options.steps)
        if (options.every > most_steps * step || (!words.every.empty() && options.every < step))
            throw InputError(fmt::format("{} ps between samples are {} steps of {} ps",
                                         options.every, options.every / step, step),
                             "--every", fmt::format("give from one to {:.0e} steps", most_steps));
    options.equilibration = 5 * options.discard;
    take("--equilibrate", words.equilibration, 0, options.equilibration);
    take("--seconds", words.seconds, 1e-3, options.seconds);
    return options;
}

}  // namespace catena::command
