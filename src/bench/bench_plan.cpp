// Implements `bench plan`: compares predictions with measured times, and choices with the best
// arrangement.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "bench/benchmarks.hpp"
#include "console/text.hpp"
#include "error.hpp"
#include "measure/hardware.hpp"
#include "plan/predictions.hpp"
#include "report/version.hpp"

namespace catena::command {
namespace {

using plan::Arrangement;
using plan::Prediction;

/// Returns the families of the random chains of the named joints, in joint axes and, if possible,
/// also in ground axes.
std::vector<plan::Family> families_named(std::vector<std::string> const& joints, Handles handles) {
    std::vector<plan::Family> chosen;
    for (plan::Family const& family : plan::all_families()) {
        std::string const name = family.name();
        bool const named = std::any_of(joints.begin(), joints.end(), [&](std::string const& joint) {
            return name == joint || name.starts_with(joint + ",") || name.starts_with(joint + " ");
        });
        if (named && family.handles == handles) chosen.push_back(family);
    }
    return chosen;
}

/// Predicted and measured times of one arrangement.
struct Compared {
    Prediction predicted;
    plan::PhaseSeconds measured{};
    /// Name of the arrangement with its levels.
    std::string name;
    double residual = 0, bound = 0;
    bool valid() const { return residual <= bound; }
    double typical() const { return measured[plan::typical_evaluation]; }
    double ratio() const {
        return predicted.seconds[plan::evaluation] / measured[plan::evaluation];
    }
    double ratio_to_median() const { return predicted.seconds[plan::evaluation] / typical(); }
};

/// Measures the arrangement of a prediction.
Compared compare(plan::Family const& family, Scene const& scene, Prediction const& predicted,
                 std::string const& gpu_levels) {
    Scene made = plan::arranged(scene, predicted.arrangement);
    made.solver.gpu_levels = gpu_levels;
    auto const alone = serial_communicator();
    ChainSystem system(made, family.axes, *alone);
    bool const levels = predicted.arrangement.backend == Backend::cuda_levels;
    Compared c{predicted, plan::measure_phases(system, {5, 200, 0.2}),
               predicted.arrangement.name() + (levels ? ", levels " + gpu_levels : ""),
               system.residual(), system.residual_bound()};
    spdlog::info("{} {} {}: {:.3g} predicted over measured", family.name(), scene.bodies(), c.name,
                 c.ratio());
    return c;
}

/// Measures every arrangement and, if there is a GPU, every number of levels on it.
std::vector<Compared> compare_all(plan::Planner& planner, plan::Family const& family,
                                  std::int64_t bodies) {
    Scene const scene = plan::sample(family, bodies);
    std::vector<plan::Share> const shares = plan::shares_of(scene, family.axes, 1);
    std::vector<Compared> all;
    for (Prediction const& p : planner.predict(shares))
        if (p.unusable.empty()) all.push_back(compare(family, scene, p, "all"));
    if (!planner.machine().no_gpu.empty()) return all;
    plan::LevelPlan const levels = planner.plan_levels(shares);
    GpuLevels const best = levels.best();
    auto const add = [&](GpuLevels cut) {
        all.push_back(compare(family, scene, planner.predict(shares, levels, cut),
                              fmt::format("{},{}", cut.up, cut.down)));
    };
    add(best);
    for (int k = 0; k <= levels.levels(); ++k) add({k, k});
    return all;
}

/// Converts a comparison to JSON.
Json json_of(Compared const& c) {
    Json phases = Json::object();
    for (std::size_t p = 0; p < plan::phases; ++p)
        phases[plan::phase_names[p]] = {{"predicted", c.predicted.seconds[p]},
                                        {"measured", c.measured[p]}};
    return {{"arrangement", c.name},  {"same_bits", c.predicted.alike},
            {"seconds", phases},      {"median", c.typical()},
            {"ratio", c.ratio()},     {"ratio_to_median", c.ratio_to_median()},
            {"residual", c.residual}, {"residual_bound", c.bound},
            {"valid", c.valid()}};
}

/// Returns the quickest measured arrangement among those for which `counts` is true.
template <class Counts>
Compared const& best_of(std::vector<Compared> const& all, Counts const& counts) {
    Compared const* best = nullptr;
    for (Compared const& c : all)
        if (counts(c) && (!best || c.typical() < best->typical())) best = &c;
    return *best;
}

/// Ratios farthest from 1, to the shortest measured time and to the median, and by how much the
/// worst choice is slower than the best.
struct Worst {
    double ratio = 1, to_median = 1, choice = 0;
    static void keep(double& worst, double r) {
        worst = std::abs(std::log(r)) > std::abs(std::log(worst)) ? r : worst;
    }
    void take(double of_shortest, double of_median) {
        keep(ratio, of_shortest);
        keep(to_median, of_median);
    }
};

/// Compares all arrangements for one family and size, and adds a row.
void add_case(Outcome& outcome, Table& table, Worst& worst, plan::Planner& planner,
              plan::Family const& family, std::int64_t bodies) {
    std::vector<Compared> const all = compare_all(planner, family, bodies);
    std::vector<Prediction> predictions;
    for (Compared const& c : all) predictions.push_back(c.predicted);
    Arrangement const arrangement = plan::quickest(predictions).arrangement;
    Compared const& chosen =
        best_of(all, [&](Compared const& c) { return c.predicted.arrangement == arrangement; });
    Compared const& best = best_of(all, [](Compared const& c) { return c.predicted.alike; });
    double const slower = chosen.typical() / best.typical() - 1;
    Worst here;
    bool valid = true;
    Json list = Json::array();
    for (Compared const& c : all) {
        here.take(c.ratio(), c.ratio_to_median());
        valid = valid && c.valid();
        list.push_back(json_of(c));
    }
    worst.take(here.ratio, here.to_median);
    worst.choice = std::max(worst.choice, slower);
    outcome.valid = outcome.valid && valid;
    table.add(
        {family.name(), std::to_string(bodies), chosen.name,
         duration_text(chosen.predicted.seconds[plan::evaluation]),
         duration_text(chosen.measured[plan::evaluation]), fmt::format("{:.2f}", chosen.ratio()),
         fmt::format("{:.2f}", chosen.ratio_to_median()), best.name, duration_text(best.typical()),
         fmt::format("{:.0f} %", 100 * slower), fmt::format("{:.2f}", here.ratio),
         fmt::format("{:.2f}", here.to_median), valid ? "VALID" : "INVALID"});
    outcome.json["results"].push_back(
        {{"kind", family.name()},
         {"bodies", bodies},
         {"chosen", chosen.name},
         {"best", best.name},
         {"best_of_any_tree", best_of(all, [](Compared const&) { return true; }).name},
         {"slower_by", slower},
         {"arrangements", list},
         {"valid", valid}});
}

/// Compares one case. A chain that cannot be computed is a finding; the other cases are still
/// compared.
void add_case_or_failure(Outcome& outcome, Table& table, Worst& worst, plan::Planner& planner,
                         plan::Family const& family, std::int64_t bodies) {
    try {
        add_case(outcome, table, worst, planner, family, bodies);
    } catch (ComputationError const& error) {
        spdlog::warn("{}, {} bodies: {}", family.name(), bodies, error.what());
        outcome.valid = false;
        table.add({family.name(), std::to_string(bodies), "-", "-", "-", "-", "-", "-", "-", "-",
                   "-", "-", "FAILED"});
        outcome.json["results"].push_back({{"kind", family.name()},
                                           {"bodies", bodies},
                                           {"failure", error.what()},
                                           {"valid", false}});
    }
}

}  // namespace

Outcome bench_plan(Communicator const& communicator, BenchRequest const& request) {
    if (communicator.size() > 1)
        throw InputError("predictions are compared on one rank", "catena bench plan",
                         "run it without mpirun");
    Table table({"kind", "bodies", "chosen", "predicted", "measured", "ratio", "to median", "best",
                 "median", "slower by", "worst", "worst to median", ""},
                {0, 2, 7, 12});
    Outcome outcome;
    outcome.json = {{"bench", "plan"},
                    {"build", version_json()},
                    {"hardware", hardware_json()},
                    {"results", Json::array()}};
    Worst worst;
    Handles const handles = request.handles == "full" ? Handles::full : Handles::projected;
    plan::with_planner(
        communicator, request.threads.empty() ? 0 : std::stoi(request.threads), largest_sample, "",
        [&](plan::Planner& planner) {
            for (plan::Family const& family : families_named(request.joints, handles))
                for (std::int64_t const bodies : request.sizes)
                    add_case_or_failure(outcome, table, worst, planner, family, bodies);
            outcome.json["left_out"] = planner.machine().no_gpu;
        });
    outcome.json["worst_ratio"] = worst.ratio;
    outcome.json["worst_ratio_to_median"] = worst.to_median;
    outcome.json["worst_choice_slower_by"] = worst.choice;
    outcome.json["valid"] = outcome.valid;
    outcome.text = fmt::format(
        "Time of an evaluation, predicted over measured; measured times are the shortest of "
        "several and their median. Worst: ratio of all arrangements farthest from 1. Best: "
        "smallest median of all arrangements that give the same bits. {}; {}, {}\n",
        hardware_text(), compiler_name(), instruction_set());
    outcome.text += table.text();
    outcome.text += fmt::format(
        "worst ratio {:.2f}, to the median {:.2f}; worst choice {:.0f} % slower than the best\n",
        worst.ratio, worst.to_median, 100 * worst.choice);
    std::string const no_gpu = outcome.json["left_out"];
    if (!no_gpu.empty()) outcome.text += "left out: cuda, cuda-levels: " + no_gpu + "\n";
    outcome.complaint =
        "a residual above its bound, or a chain that cannot be computed: see the results";
    return outcome;
}

}  // namespace catena::command
