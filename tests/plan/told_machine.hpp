// A machine whose times are told by formulas, so that the best choice is known.
#pragma once

#include "plan/choice.hpp"
#include "reader/load_scene.hpp"

namespace catena::test {

/// Evaluations (a drift takes 1.2 times as long, each of its sweeps 0.4, noise 0.1): one core takes
/// 1 us a body, t threads 20 us more than their share of it, the GPU 100 us and 10 ns a body. A
/// level of m merges: the host 0.5 us each, the GPU 10 us and 1 ns each; transfers: 5 us and 1 ns
/// an item.
inline plan::Machine told_machine(bool gpu) {
    using plan::Arrangement;
    plan::Machine m;
    m.threads = 4;
    m.identity = "told";
    m.alike = {{Backend::segments, 1}, {Backend::openmp, 2}, {Backend::openmp, 4}};
    if (gpu) m.alike.push_back({Backend::cuda, 4});
    m.others = {{Backend::serial, 1}};
    if (!gpu) m.no_gpu = "there is no GPU";
    m.measure = [](plan::Family const&, std::int64_t bodies, Arrangement const& on) {
        auto const n = static_cast<double>(bodies);
        double const t = on.backend == Backend::cuda ? 1e-4 + 1e-8 * n
                         : on.threads > 1            ? 2e-5 + 1e-6 * n / on.threads
                                                     : 1e-6 * n;
        return plan::PhaseSeconds{0.2 * t, 0.5 * t, 0.3 * t, t, t};
    };
    m.measure_drifts = [measure = m.measure](plan::Family const& family, std::int64_t bodies,
                                             Arrangement const& on) {
        double const t = measure(family, bodies, on)[plan::evaluation];
        return plan::DriftSeconds{1.2 * t, 0.4 * t, 0.1 * t};
    };
    m.measure_levels = [](plan::Family const&, std::int64_t bodies, plan::Place place, int) {
        auto const n = static_cast<double>(bodies);
        bool const host = place == plan::Place::host;
        double const merges = host ? 0.25e-6 * n : 1e-5 + 0.5e-9 * n,
                     leaves = host ? 1e-6 * n : 1e-5 + 1e-9 * n;
        double const transfer = host ? 0 : 5e-6 + 1e-9 * n;
        return plan::LevelSeconds{leaves,   leaves,   merges,   0.5 * merges,
                                  transfer, transfer, transfer, transfer};
    };
    m.gpu_memory = [](plan::Family const&, std::int64_t bodies) {
        return 1000.0 * static_cast<double>(bodies);
    };
    m.free_gpu_memory = [] { return 1e9; };
    m.openmm_on_gpu = [] { return true; };
    return m;
}

inline Scene told_scene(std::int64_t bodies, std::string const& solver = "{}") {
    return parse_scene(
        "chains: [{name: a, base: fixed, generator: {random: {joint: revolute, bodies: " +
            std::to_string(bodies) + ", seed: 1}}}]\nsolver: " + solver,
        "told.yaml");
}

}  // namespace catena::test
