// Implements `catena solve`.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "command/acceleration_table.hpp"
#include "command/commands.hpp"
#include "console/option_values.hpp"
#include "console/terminal.hpp"
#include "integrate/chain_system.hpp"
#include "measure/accelerations_file.hpp"
#include "measure/forward_error.hpp"
#include "measure/oracle_accelerations.hpp"
#include "measure/timing.hpp"
#include "mpi/first_rank.hpp"
#include "observe/observables.hpp"
#include "oracle/oracle.hpp"
#include "plan/choice.hpp"
#include "plan/describe.hpp"
#include "start/start_relaxation.hpp"
#include "start/start_report.hpp"
#include "start/start_velocities.hpp"

namespace catena::command {
namespace {

/// Largest number of bodies whose accelerations are part of the JSON.
constexpr std::int64_t most_bodies_in_json = 10000;

/// Returns why the oracle cannot compute the recursive Newton-Euler residual; empty if it can. It
/// needs all bodies on this rank, not too many, no links and no forces unknown to it. Loops of
/// bodies are excluded: the moments that their residuals are relative to may vanish where forces
/// pass through the joints.
std::string why_no_inverse_dynamics(ChainSystem const& system) {
    Scene const& scene = system.scene();
    auto const any_chain = [&](auto const& is) {
        return std::any_of(scene.chains.begin(), scene.chains.end(), is);
    };
    if (system.communicator().size() > 1) return "there are several ranks";
    if (scene.bodies() > most_bodies_in_json)
        return fmt::format("there are more than {} bodies", most_bodies_in_json);
    if (any_chain([](ChainSpec const& c) { return c.is_linked(); })) return "bodies are on links";
    if (any_chain([](ChainSpec const& c) { return c.is_cross_linked(); }))
        return "beads are cross-linked";
    if (any_chain([](ChainSpec const& c) { return !c.is_beads() && c.is_closed(); }))
        return "bodies form a loop";
    std::string lacking;
    terms::for_each([&](auto term) {
        using Term = decltype(term);
        if constexpr (Term::unknown_to_oracles != nullptr)
            if (terms::acts_in<Term>(scene))
                lacking = fmt::format("inverse dynamics has no {}", Term::unknown_to_oracles);
    });
    return lacking;
}

/// Returns the recursive Newton-Euler residual of the worst chain, or null where the oracle cannot
/// compute it.
Json inverse_dynamics_residual(ChainSystem const& system, Solution const& s) {
    Scene const& scene = system.scene();
    if (!why_no_inverse_dynamics(system).empty()) return nullptr;
    double worst = 0;
    std::size_t body = 0, bead = 0;
    for (ChainSpec const& chain : scene.chains) {
        oracle::Loads loads = oracle_loads(scene, 0, {});
        std::vector<Vec3> accelerations;
        Vec3 base = Vec3::zero();
        for (std::size_t k = 0; k < chain.size(); ++k, ++body) {
            Vec3 own = Vec3::zero();
            auto const first = s.acceleration_offset[body];
            for (std::int64_t i = 0;
                 i < std::min<std::int64_t>(3, s.acceleration_offset[body + 1] - first); ++i)
                own[static_cast<int>(i)] = s.acceleration[first + i];
            accelerations.push_back(own);
            if (s.acceleration_offset[body + 1] - first == 6)
                for (int i = 0; i < 3; ++i) base[i] = s.acceleration[first + 3 + i];
        }
        if (!s.bead_force.empty())
            loads.bead_forces.assign(s.bead_force.begin() + bead,
                                     s.bead_force.begin() + bead + chain.bead_count());
        bead += chain.bead_count();
        worst = larger(worst, oracle::rnea_residual(chain, loads, accelerations, base));
    }
    return worst;
}

/// True if all values are finite.
bool finite(std::vector<double> const& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// Returns the JSON that does not depend on the solution.
Json summary_json(ChainSystem const& system, Timing const& timing) {
    Scene const& scene = system.scene();
    Json phases = Json::object();
    for (auto const& [name, seconds] : timing.phases) phases[name] = seconds;
    return {{"scene", scene.file},
            {"title", scene.title},
            {"chains", chains_json(scene)},
            {"bodies", scene.bodies()},
            {"dof", degrees_of_freedom(scene)},
            {"backend", name_of(system.backend())},
            {"ranks", system.communicator().size()},
            {"threads", system.executor().threads()},
            {"simd", name_of(system.executor().simd())},
            {"gpu_levels", gpu_levels_json(scene)},
            {"handles", name_of(scene.solver.handles)},
            {"tree_table", dca::tree_table_version},
            {"seconds",
             {{"median", timing.evaluation.median},
              {"min", timing.evaluation.min},
              {"max", timing.evaluation.max},
              {"repeat", timing.evaluation.count}}},
            {"phases", phases},
            {"sweeps", {{"matrix", timing.matrix_sweeps}, {"bias", timing.bias_sweeps}}}};
}

/// True if a chain starts with thermal velocities.
bool starts_thermal(Scene const& scene) {
    return std::any_of(scene.chains.begin(), scene.chains.end(),
                       [](ChainSpec const& c) { return c.velocities == StartVelocities::thermal; });
}

/// Returns why the error of the accelerations is not estimated, where it is not.
char const* why_no_estimate(Scene const& scene) {
    bool const refinable =
        std::any_of(scene.chains.begin(), scene.chains.end(),
                    [](ChainSpec const& c) { return !c.is_beads() && !c.is_linked(); });
    return refinable ? "there are very many bodies" : "beads and bodies on links are not refined";
}

/// Adds what was solved, and on what.
void add_solver(Text& text, ChainSystem const& system, Json const& json) {
    Scene const& scene = system.scene();
    text.entry("solver", fmt::format("{}, {} handles, {}, {} each", name_of(system.backend()),
                                     name_of(scene.solver.handles),
                                     counted(system.communicator().size(), "rank", "ranks"),
                                     counted(system.executor().threads(), "thread", "threads")));
    text.entry("", json["backend_reason"]);
    for (std::size_t i = 0; system.openmm() && i < system.openmm()->description().size(); ++i)
        text.entry(i == 0 ? "OpenMM" : "", system.openmm()->description()[i]);
    if (json["velocities"] == "thermal")
        text.entry("velocities", fmt::format("thermal, {} K, seed {}, as at the start of a run",
                                             scene.dynamics.temperature, scene.dynamics.seed));
    if (json["relaxation"].is_string()) text.entry("relaxation", json["relaxation"]);
}

/// Adds the times of an evaluation, of its phases and of the refinement.
void add_times(Text& text, Scene const& scene, Json const& json, Timing const& timing) {
    text.entry(
        "time",
        fmt::format("{}, median of {} ({} to {}); {:.4g} ns per body",
                    duration_text(timing.evaluation.median), timing.evaluation.count,
                    duration_text(timing.evaluation.min), duration_text(timing.evaluation.max),
                    1e9 * timing.evaluation.median / static_cast<double>(scene.bodies())));
    // An evaluation computes matrices and biases in one sweep if it can; separate sweeps take
    // longer.
    for (auto const& [name, seconds] : timing.phases)
        text.entry("  " + name,
                   duration_text(seconds) + (name.ends_with("sweep") ? ", on its own" : ""));
    std::vector<double> const refinement = json["refinement"]["seconds_of_each"];
    if (!refinement.empty())
        text.entry("refinement",
                   fmt::format("{}, {} each", counted(std::ssize(refinement), "step", "steps"),
                               duration_text(spread_of(refinement).median)));
}

/// Adds the residuals and the estimated error.
void add_errors(Text& text, ChainSystem const& system, Json const& json) {
    Json const &inverse = json["rnea_residual"], &error = json["estimated_error"];
    text.entry(
        "inverse dynamics",
        inverse.is_null()
            ? fmt::format("residual not computed ({})", why_no_inverse_dynamics(system))
            : fmt::format(
                  "residual {:.2e}, {}", inverse.get<double>(),
                  error.is_null()
                      ? "for information only"
                      : "which grows with the condition number; the estimated error decides"));
    text.entry(
        "estimated error",
        error.is_null()
            ? fmt::format("not estimated ({})", why_no_estimate(system.scene()))
            : fmt::format(
                  "{:.1e} of the largest acceleration, bound {:.0e} (by one step of refinement)",
                  error.get<double>(), json["estimated_error_bound"].get<double>()));
    if (int const more = json["refinement"]["steps_unasked"]; more > 0)
        text.entry(
            "", fmt::format("after {} of refinement, which articulated handles use automatically",
                            counted(more, "step", "steps")));
    text.entry("residual",
               fmt::format("{:.2e}, bound {:.2e} (32 depth eps)",
                           json["residual"].is_null() ? NAN : json["residual"].get<double>(),
                           json["residual_bound"].get<double>()));
}

/// Returns the text that `catena solve` prints.
std::string text_of(ChainSystem const& system, Json const& json, Timing const& timing,
                    Solution const& solution) {
    Scene const& scene = system.scene();
    Text text;
    text.heading(title_of(scene));
    text.entry("bodies", fmt::format("{} in {}, {} degrees of freedom", scene.bodies(),
                                     counted(std::ssize(scene.chains), "chain", "chains"),
                                     degrees_of_freedom(scene)));
    add_accelerations(text, scene, solution);
    add_solver(text, system, json);
    add_times(text, scene, json, timing);
    for (auto const& [term, energy] : json["potential_energy"].items())
        text.entry("potential energy",
                   fmt::format("{} {:.10g} {}", term, energy.get<double>(), energy_unit(scene)));
    add_errors(text, system, json);
    for (std::string const& note : scene.notes) text.note(note);
    return text.str();
}

/// Refines the solution and returns the seconds of each step. Collective.
std::vector<double> refine(ChainSystem& system, int steps) {
    std::vector<double> seconds;
    for (int i = 0; i < steps; ++i) {
        double const start = seconds_now();
        system.refine();
        seconds.push_back(system.communicator().max(seconds_now() - start));
    }
    return seconds;
}

/// Checks that the file of --accelerations can be written. Throws InputError. Collective.
void prepare_file(Communicator const& communicator, std::string const& file) {
    on_first_rank(communicator, [&] {
        if (file.empty()) return;
        require_accelerations_writer(file);
        require_writable("--accelerations", file);
    });
}

/// True if a chain has links, whose solutions are neither refined nor articulated.
bool has_links(Scene const& scene) {
    return std::any_of(scene.chains.begin(), scene.chains.end(),
                       [](ChainSpec const& c) { return c.is_beads() || c.is_linked(); });
}

/// A solution and what is known about its errors.
struct Solved {
    Solution solution;  // empty if nobody reads it
    ForwardError error;
    double residual = 0, bound = 0;

    /// True if the residual and the estimated error are small and all values are finite. Values
    /// that are not finite make the residual large as well.
    bool is_valid() const {
        return residual <= bound && error.is_small() && finite(solution.acceleration) &&
               finite(solution.joint_force);
    }
    /// Returns the reason why the solution is not valid, with a remedy.
    std::string complaint(Scene const& scene) const {
        if (error.is_small() || !(residual <= bound))
            return fmt::format("residual {:.2e}, bound {:.2e}: {}", residual, bound,
                               has_links(scene) ? "compare with `catena report`, and look for "
                                                  "masses that differ by many decades"
                                                : "compare with --refine 2 or, for open chains on "
                                                  "joints, --handles articulated");
        char const* const more = scene.solver.refine < 2 ? "--refine 2" : "more steps of --refine";
        return fmt::format("estimated error of the accelerations {:.1e}, bound {:.0e}: use {}",
                           *error.estimate, largest_forward_error,
                           remedy_of_forward_error(scene, true, {more, "--handles articulated"}));
    }
};

/// Returns the solution of an evaluated and refined system. Arrays of all bodies are built only if
/// `wanted`. Collective.
Solved solved(ChainSystem& system, bool wanted) {
    Solved s;
    s.bound = system.residual_bound();
    s.error = forward_error(system, [&] {
        s.residual = system.residual();
        if (wanted) s.solution = solution_of(system);
    });
    return s;
}

/// Adds the errors of the solution.
void add_errors(Json& json, ChainSystem const& system, Solved const& s) {
    json["residual"] = s.residual;
    json["residual_bound"] = s.bound;
    json["residual_bound_formula"] = "32 depth(tree) 2^-53";
    json["estimated_error"] = s.error.estimate ? Json(*s.error.estimate) : Json(nullptr);
    json["estimated_error_bound"] = largest_forward_error;
    json["refinement"]["steps_unasked"] = s.error.steps;
    json["rnea_residual"] = inverse_dynamics_residual(system, s.solution);
}

/// Brings the start to where a run would begin: closes the tips, so that velocities fit them, and
/// refuses overlapping beads, whose accelerations are right but of no use. Throws InputError if the
/// scene asks for refinement and no chain can be refined. Collective.
void prepare_start(ChainSystem& system) {
    if (system.scene().solver.refine > 0 && system.joint().empty())
        throw InputError("chains of beads or linked bodies cannot be refined", "solver.refine",
                         "leave it out");
    system.close_tips();
    if (!system.openmm()) return;
    system.evaluate(false);
    look_at_start(system);
}

/// Returns the energy of each force term as JSON.
Json energies_json(std::vector<EnergyTerm> const& energies) {
    Json json = Json::object();
    for (EnergyTerm const& term : energies) json[term.name] = term.value;
    return json;
}

/// Solves the scene with the chosen backend. Collective.
Outcome solve_chosen(Scene const& given, Communicator const& communicator,
                     SolveRequest const& request, std::string const& reason) {
    std::optional<RelaxedScene> relaxed =
        relaxed_where_asked(given, communicator, relaxation_says(is_quiet()));
    if (!relaxed) refuse_coinciding(given, communicator);
    Scene const scene =
        with_start_velocities(relaxed ? std::move(relaxed->scene) : given, communicator);
    ChainSystem system(scene, Axes::joint, communicator);
    prepare_start(system);
    Timing const timing = time_evaluations(system, request.repeat);
    Outcome outcome;
    Json& json = outcome.json = summary_json(system, timing);
    json["backend_reason"] = reason;
    json["refinement"] = {{"steps", scene.solver.refine},
                          {"seconds_of_each", refine(system, scene.solver.refine)}};
    std::vector<EnergyTerm> const energies = system.potential_energy();
    bool const wanted = scene.bodies() <= most_bodies_in_json ||
                        communicator.max(request.accelerations.empty() ? 0 : 1) > 0;
    Solved const found = solved(system, wanted);
    outcome.valid = communicator.max(found.is_valid() ? 0 : 1) == 0;
    on_first_rank(communicator, [&] {
        add_errors(json, system, found);
        json["valid"] = outcome.valid;
        json["potential_energy"] = energies_json(energies);
        json["velocities"] = starts_thermal(given) ? "thermal" : "given";
        json["relaxation"] = relaxed ? Json(relaxed->relaxation.text()) : Json(nullptr);
        json["notes"] = scene.notes;
        if (scene.bodies() <= most_bodies_in_json) add_solution(json, scene, found.solution);
        if (!outcome.valid) outcome.complaint = found.complaint(scene);
        outcome.text = text_of(system, json, timing, found.solution) +
                       (outcome.valid ? "VALID" : "INVALID: " + outcome.complaint) + "\n";
        if (request.accelerations.empty()) return;
        write_accelerations(request.accelerations, scene, found.solution);
        spdlog::info("wrote {}", request.accelerations);
    });
    return outcome;
}

}  // namespace

Outcome solve_scene(Scene given, Communicator const& communicator, SolveRequest const& request) {
    prepare_file(communicator, request.accelerations);
    Outcome outcome;
    auto const choose = [&](Scene const& scene, std::string const& no_gpu) {
        return plan::choose(scene, Axes::joint, communicator, no_gpu);
    };
    plan::with_choice(std::move(given), choose,
                      [&](Scene const& scene, plan::Choice const& choice) {
                          outcome = solve_chosen(scene, communicator, request, choice.reason);
                      });
    return outcome;
}

}  // namespace catena::command
