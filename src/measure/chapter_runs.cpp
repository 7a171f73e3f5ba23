// The chapter's pendulum on all backends, and times of single tree levels.
#include "measure/chapter_runs.hpp"

#include <algorithm>
#include <cmath>

#include "cuda/device/gpu.hpp"
#include "error.hpp"
#include "integrate/stepper.hpp"
#include "reader/load_scene.hpp"

namespace catena {
namespace {

/// A case ready to be measured. Every step starts from the pendulum at rest.
class Prepared {
  public:
    Prepared(FigureCase const& what, Handles handles, std::int64_t bodies, int threads,
             Communicator const& communicator)
        : scene_(scene_of(what, handles, bodies, threads)),
          system_(scene_, Axes::joint, communicator),
          stepper_(make_stepper(system_, scene_.dynamics)) {
        point_.what = what;
        point_.handles = handles;
        point_.bodies = bodies;
        point_.threads = system_.executor().threads();
        system_.evaluate();
        point_.residual = system_.residual();
        point_.residual_bound = system_.residual_bound();
        start_ = system_.state();
    }

    /// Times one step as a whole, and another one with its sweeps measured separately. `counts`:
    /// false during warm-up.
    void step(bool counts) {
        Communicator const& communicator = system_.communicator();
        double const seconds = seconds_of_step();
        system_.measure(true);
        SolverReport const before = system_.solver_reports().front();
        seconds_of_step();
        SolverReport const after = system_.solver_reports().front();
        system_.measure(false);
        if (!counts) return;
        auto const solves = static_cast<double>(after.bias_sweeps + after.evaluations -
                                                before.bias_sweeps - before.evaluations);
        auto const add = [&](std::vector<double>& list, double value) {
            list.push_back(communicator.max(value));
        };
        add(step_, seconds);
        add(solve_, (after.matrix_seconds - before.matrix_seconds + after.bias_seconds -
                     before.bias_seconds) /
                        solves);
        add(upload_, (after.split.upload - before.split.upload) / solves);
        add(download_, (after.split.download - before.split.download) / solves);
        add(lower_, (after.split.lower() - before.split.lower()) / solves);
        add(upper_, (after.split.upper() - before.split.upper()) / solves);
    }

    FigurePoint point() const {
        FigurePoint p = point_;
        p.step = spread_of(step_);
        p.solve = spread_of(solve_);
        if (p.what.backend != Backend::cuda_levels) return p;
        p.upload = spread_of(upload_);
        p.download = spread_of(download_);
        p.lower = spread_of(lower_);
        p.upper = spread_of(upper_);
        return p;
    }

  private:
    /// Returns the seconds of one step from the start.
    double seconds_of_step() {
        system_.set_state(start_);
        system_.wait();
        system_.communicator().barrier();
        double const begin = seconds_now();
        stepper_->step(0, nullptr);
        system_.wait();
        return seconds_now() - begin;
    }
    static Scene scene_of(FigureCase const& what, Handles handles, std::int64_t bodies,
                          int threads) {
        Scene scene = chapter_pendulum(bodies, {});
        scene.solver.backend = what.backend;
        scene.solver.gpu_levels = what.gpu_levels;
        scene.solver.handles = handles;
        scene.solver.threads = threads;
        return scene;
    }

    Scene scene_;
    ChainSystem system_;
    std::unique_ptr<Stepper> stepper_;
    std::map<std::string, std::vector<double>> start_;
    FigurePoint point_;
    std::vector<double> step_, solve_, upload_, download_, lower_, upper_;
};

/// Solver for the pendulum at rest, with the tree cut above one level.
class CutTree {
  public:
    CutTree(ChainGroup const& group, Scene const& scene, Executor const& executor,
            Communicator const& communicator, int level, dca::LevelPartMaker const& lower,
            Executor const& upper)
        : dynamics_(make_joint_dynamics(group, scene, executor, communicator,
                                        dca::make_level_solver(group, communicator, {level, level},
                                                               lower, dca::host_levels(upper)))) {}

    /// Does one evaluation; `counts`: false during warm-up.
    void evaluate(bool counts) {
        SplitSeconds const before = dynamics_->solver().report().split;
        dynamics_->update_configuration();
        dynamics_->assemble_matrices();
        dynamics_->solve();
        dynamics_->set_rates();
        SplitSeconds spent = dynamics_->solver().report().split;
        spent -= before;
        if (counts) spent_.push_back(spent);
    }
    std::vector<SplitSeconds> const& spent() const { return spent_; }
    double residual() { return dynamics_->residual(*serial_executor()); }
    std::int64_t depth() const { return dynamics_->solver().report().depth; }

  private:
    std::unique_ptr<JointDynamics> dynamics_;
    std::vector<SplitSeconds> spent_;
};

/// Returns the median of the difference in seconds between `more` and `less` in that part,
/// evaluation by evaluation, since they ran alternately. NaN if more than a quarter of the
/// differences are not positive: noise then exceeds the difference.
double median_of_differences(CutTree const& more, CutTree const& less,
                             double SplitSeconds::* part) {
    std::vector<double> differences;
    for (std::size_t i = 0; i < more.spent().size(); ++i)
        differences.push_back(more.spent()[i].*part - less.spent()[i].*part);
    auto const quarter = differences.begin() + std::ssize(differences) / 4;
    std::nth_element(differences.begin(), quarter, differences.end());
    return *quarter > 0 ? spread_of(differences).median : std::nan("");
}
/// Returns the seconds of the level between two cuts, as part of the lower levels.
LevelSeconds as_lower(CutTree const& below, CutTree const& above) {
    return {median_of_differences(above, below, &SplitSeconds::lower_assembly),
            median_of_differences(above, below, &SplitSeconds::lower_disassembly)};
}
/// Returns the seconds of the level between two cuts, as part of the upper levels.
LevelSeconds as_upper(CutTree const& below, CutTree const& above) {
    return {median_of_differences(below, above, &SplitSeconds::upper_assembly),
            median_of_differences(below, above, &SplitSeconds::upper_disassembly)};
}
/// Returns the median seconds of transfers per evaluation.
double median_of_transfers(CutTree const& cut) {
    std::vector<double> transfers;
    for (SplitSeconds const& s : cut.spent()) transfers.push_back(s.transfers());
    return spread_of(transfers).median;
}

}  // namespace

Scene chapter_pendulum(std::int64_t links, std::vector<std::string> const& overrides) {
    return parse_scene(
        "title: the chapter's pendulum\nunits: si\n"
        "chains: [{name: pendulum, generator: {pendulum: {links: " +
            std::to_string(links) +
            ", mass: 12, length: 1, radius: 0.01}}}]\n"
            "forces: {gravity: [0, -10, 0]}\n"
            "dynamics: {integrator: rk4, step: 1e-4, steps: 1}\n",
        "pendulum-" + std::to_string(links), overrides);
}

std::vector<FigureCase> figure_cases(std::vector<std::string>& left_out) {
    std::vector<FigureCase> cases{{"serial", Backend::serial}, {"segments", Backend::segments}};
    if (openmp_is_built())
        cases.push_back({"openmp", Backend::openmp});
    else
        left_out.emplace_back("openmp: built without OpenMP");
    for (char const* const levels : {"1", "3", "6", "all"}) {
        std::string const name = std::string("cuda-levels ") + levels;
        if (cuda::why_not().empty())
            cases.push_back({name, Backend::cuda_levels, levels});
        else
            left_out.push_back(name + ": " + cuda::why_not());
    }
    if (cuda::why_not().empty())
        cases.push_back({"cuda", Backend::cuda});
    else
        left_out.push_back("cuda: " + cuda::why_not());
    return cases;
}

std::vector<FigurePoint> measure_steps(std::vector<FigureCase> const& cases, Handles handles,
                                       std::int64_t bodies, int threads, int repeat,
                                       Communicator const& communicator) {
    std::vector<std::unique_ptr<Prepared>> prepared;
    for (FigureCase const& each : cases)
        prepared.push_back(
            std::make_unique<Prepared>(each, handles, bodies, threads, communicator));
    int constexpr warm_up = 3;
    for (int i = 0; i < warm_up + repeat; ++i)
        for (auto const& each : prepared) each->step(i >= warm_up);
    std::vector<FigurePoint> points;
    for (auto const& each : prepared) points.push_back(each->point());
    return points;
}

std::vector<std::int64_t> merges_of_levels(std::int64_t bodies) {
    dca::Partition const partition({bodies}, true, 1);
    std::vector<std::int64_t> merges;
    for (auto const& level : dca::make_schedule(partition, 0).levels)
        merges.push_back(std::ssize(level));
    return merges;
}

LevelStudy measure_levels(Handles handles, std::int64_t bodies, int threads, int repeat) {
    Scene const scene = chapter_pendulum(bodies, {});
    auto const communicator = serial_communicator();
    auto const groups = make_groups(scene, Axes::joint, handles, true, *communicator);
    auto const one = serial_executor(),
               many = openmp_is_built() ? openmp_executor(threads) : serial_executor();
    bool const gpu = cuda::why_not().empty() && cuda::choose_device(*communicator).empty();
    std::vector<std::int64_t> const merges = merges_of_levels(bodies);
    std::vector<std::unique_ptr<CutTree>> host,
        device;  // indexed by the number of levels below the cut
    for (int level = 0; level <= static_cast<int>(merges.size()); ++level) {
        auto const cut = [&](dca::LevelPartMaker const& lower) {
            return std::make_unique<CutTree>(*groups[0], scene, *one, *communicator, level, lower,
                                             *many);
        };
        host.push_back(cut(dca::host_levels(*one)));
        if (gpu) device.push_back(cut(cuda::make_levels));
    }
    int constexpr warm_up = 3;
    for (int i = 0; i < warm_up + repeat; ++i)
        for (auto* cuts : {&host, &device})
            for (auto const& cut : *cuts) cut->evaluate(i >= warm_up);
    LevelStudy study{handles, bodies, many->threads(),
                     {},      0,      32.0 * static_cast<double>(host[0]->depth()) * 0x1p-53};
    for (auto const* cuts : {&host, &device})
        for (auto const& cut : *cuts) study.residual = larger(study.residual, cut->residual());
    for (std::size_t k = 1; k < host.size(); ++k) {
        LevelPoint point;
        point.level = static_cast<int>(k);
        point.merges = merges[k - 1];
        point.one_core = as_lower(*host[k - 1], *host[k]);
        if (many->threads() > 1) point.threads = as_upper(*host[k - 1], *host[k]);
        if (gpu) {
            point.gpu = as_lower(*device[k - 1], *device[k]);
            point.transfers = median_of_transfers(*device[k]);
        }
        study.levels.push_back(point);
    }
    return study;
}

}  // namespace catena
