// Timed evaluations and their phases.
#include "measure/timing.hpp"

#include <algorithm>

#include "force/path.hpp"

namespace catena {
namespace {

/// Sums over the solvers of a system, and the system's own clocks, in seconds.
struct Clocks {
    double matrix = 0, bias = 0, exchange = 0, forces = 0, waiting = 0, moment = 0;
    SplitSeconds split;
    std::int64_t matrix_sweeps = 0, bias_sweeps = 0;
};

Clocks read_clocks(ChainSystem const& system) {
    Clocks c;
    for (SolverReport const& r : system.solver_reports()) {
        c.matrix += r.matrix_seconds;
        c.bias += r.bias_seconds;
        c.exchange += r.exchange_seconds;
        c.split += r.split;
        c.matrix_sweeps = std::max(c.matrix_sweeps, r.matrix_sweeps);
        c.bias_sweeps = std::max(c.bias_sweeps, r.bias_sweeps);
    }
    auto const own = [&](char const* phase) {
        auto const found = system.seconds().find(phase);
        return found == system.seconds().end() ? 0.0 : found->second;
    };
    c.forces = own("forces");
    c.waiting = own("waiting for forces");
    c.moment = seconds_now();
    return c;
}

/// Clock readings before and after each of many evaluations.
struct Samples {
    std::vector<Clocks> before, after;
    /// Returns the difference of a quantity over each evaluation, of the slowest rank. Collective.
    template <class Quantity>
    std::vector<double> of(Quantity const& quantity, Communicator const& communicator) const {
        std::vector<double> values;
        for (std::size_t i = 0; i < before.size(); ++i)
            values.push_back(communicator.max(quantity(after[i]) - quantity(before[i])));
        return values;
    }
    /// Returns the number of sweeps per evaluation. It is at least 1: if matrices and biases are
    /// computed in one sweep, they are not counted separately.
    int count(std::int64_t Clocks::* sweeps) const {
        return std::max(1, static_cast<int>(after.front().*sweeps - before.front().*sweeps));
    }
};
Samples sample(ChainSystem& system, int repeat, bool project) {
    Samples s;
    for (int i = 0; i < repeat; ++i) {
        system.communicator().barrier();
        s.before.push_back(read_clocks(system));
        system.evaluate(project);
        system.wait();
        s.after.push_back(read_clocks(system));
    }
    return s;
}

}  // namespace

Spread spread_of(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    std::size_t const n = values.size(), middle = n / 2;
    double const median = n % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
    return {median, values.front(), values.back(), static_cast<int>(n)};
}

Timing time_evaluations(ChainSystem& system, int repeat) {
    Communicator const& communicator = system.communicator();
    int const warm_up = system.openmm() ? 2 * PathChoice::trials + 1 : 2;
    for (int i = 0; i < warm_up; ++i) system.evaluate();

    repeat = std::max(repeat, 1);
    // Whole evaluations are measured first: measuring their sweeps separately would delay a GPU.
    Samples const whole = sample(system, repeat, false);
    system.measure(true);
    Samples const apart = sample(system, repeat, true);
    system.measure(false);
    auto const median = [&](auto const& quantity) {
        return spread_of(apart.of(quantity, communicator)).median;
    };

    Timing t;
    t.evaluation = spread_of(whole.of([](Clocks const& c) { return c.moment; }, communicator));
    int const matrix_sweeps = apart.count(&Clocks::matrix_sweeps),
              bias_sweeps = apart.count(&Clocks::bias_sweeps);
    t.matrix_sweep = spread_of(
        apart.of([&](Clocks const& c) { return c.matrix / matrix_sweeps; }, communicator));
    t.bias_sweep =
        spread_of(apart.of([&](Clocks const& c) { return c.bias / bias_sweeps; }, communicator));
    t.matrix_sweeps = whole.count(&Clocks::matrix_sweeps);
    t.bias_sweeps = whole.count(&Clocks::bias_sweeps);
    double const matrix = t.matrix_sweep.median * t.matrix_sweeps,
                 bias = t.bias_sweep.median * t.bias_sweeps;
    t.phases = {{"matrix sweep", matrix},
                {"bias sweep", bias},
                {"exchange of units", median([](Clocks const& c) { return c.exchange; })}};
    if (system.backend() == Backend::cuda_levels)  // parts of the sweeps
        for (auto const& [name, part] : {std::pair{"levels on the GPU", &SplitSeconds::lower},
                                         {"levels on the host", &SplitSeconds::upper},
                                         {"transfers", &SplitSeconds::transfers}})
            t.phases.emplace_back(
                name, median([seconds = part](Clocks const& c) { return (c.split.*seconds)(); }));
    if (system.openmm()) {
        t.phases.emplace_back("forces", median([](Clocks const& c) { return c.forces; }));
        t.phases.emplace_back("waiting for forces",
                              median([](Clocks const& c) { return c.waiting; }));
    }
    double const waiting = median([](Clocks const& c) { return c.waiting; });
    t.phases.emplace_back("other", std::max(0.0, t.evaluation.median - matrix - bias - waiting));
    return t;
}

}  // namespace catena
