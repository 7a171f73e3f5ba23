// Implements the rows of `bench sampling` by Catena's and OpenMM's integrators.
#include "bench/sampling_rows.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <random>

#include "bench/step_makers.hpp"
#include "clock.hpp"
#include "console/option_values.hpp"
#include "error.hpp"
#include "io/output.hpp"
#include "observe/observables.hpp"
#include "structure/calvados2.hpp"

namespace catena::command {
namespace {

constexpr std::string_view method_names[] = {"rigid", "rigid-fixman", "bonds", "constraints"};
/// Tolerance of OpenMM's constraints, which it closes to 1e-5.
constexpr double tolerance_of_constraints = 2e-5;
/// Error of a bond, relative to its length, that counts as torn: ten standard deviations.
constexpr double torn = 0.5;

/// State of the chains at one moment.
struct Moment {
    std::vector<Vec3> position;
    /// Kinetic energy, kJ/mol.
    double kinetic = 0;
    /// Largest relative error of a link.
    double link_error = 0;
};

/// Moves the chains by one method.
class Mover {
  public:
    virtual ~Mover() = default;
    virtual void step(int count) = 0;
    virtual Moment now() = 0;
    /// Returns the largest link error at little cost, for use between samples.
    virtual double link_error() = 0;
    virtual double tolerance() const = 0;
    virtual void describe(SamplingRow&) = 0;
};

/// Moves the chains by Catena's g-BAOAB.
class CatenaMover final : public Mover {
  public:
    CatenaMover(Scene scene, Communicator const& communicator)
        : catena_(std::move(scene), communicator) {}
    void step(int count) override {
        catena_.step(count);
        catena_.adapt();
    }
    Moment now() override {
        SceneMotion snapshot = catena_.observe();
        double const kinetic = kinetic_energy(catena_.scene(), snapshot);
        return {std::move(snapshot.position), kinetic, catena_.constraint_error()};
    }
    double link_error() override { return catena_.constraint_error(); }
    double tolerance() const override { return catena_.tolerance(); }
    void describe(SamplingRow& row) override {
        row.engine.backend = name_of(catena_.system().backend());
        row.engine.platform = catena_.system().openmm()->platform();
        row.engine.path = catena_.system().openmm()->path();
    }

  private:
    CatenaSteps catena_;
};

/// Moves the chains by OpenMM's own integrator.
class OpenMmMover final : public Mover {
  public:
    OpenMmMover(Scene scene, BeadSystem const& beads, Communicator const& communicator,
                OwnLinks links, Backend backend)
        : links_(links), beads_(beads) {
        std::mt19937_64 draw(scene.dynamics.seed);
        std::vector<Vec3> x;
        for (ChainSpec& chain : scene.chains) {
            if (links == OwnLinks::bonds)
                warm_bonds(chain.beads.position, scene.boltzmann() * scene.dynamics.temperature,
                           draw);
            x.insert(x.end(), chain.beads.position.begin(), chain.beads.position.end());
        }
        own_ = make_openmm_integrator(*scene.forces.openmm, beads, communicator, links,
                                      own_run(scene, backend), x);
    }
    void step(int count) override { own_->step(count); }
    Moment now() override {
        Moment now{own_->positions(), own_->kinetic_energy()};
        now.link_error = catena::link_error(beads_.links, now.position);
        return now;
    }
    double link_error() override { return own_->link_error(); }
    double tolerance() const override {
        return links_ == OwnLinks::bonds ? torn : tolerance_of_constraints;
    }
    void describe(SamplingRow& row) override {
        row.engine.backend = "OpenMM";
        row.engine.platform = own_->platform();
    }

  private:
    OwnLinks links_;
    BeadSystem const& beads_;
    std::unique_ptr<OpenMmIntegrator> own_;
};

/// Returns the mover of a method, at the start of a row.
std::unique_ptr<Mover> make_mover(SampledChains& chains, Communicator const& communicator,
                                  Backend backend, SamplingMethod method, double step,
                                  double time) {
    Scene scene = chains.scene(step, time);
    scene.solver.backend = backend;
    if (method == SamplingMethod::bonds || method == SamplingMethod::constraints)
        return std::make_unique<OpenMmMover>(
            scene, chains.beads(), communicator,
            method == SamplingMethod::bonds ? OwnLinks::bonds : OwnLinks::constraints, backend);
    scene.dynamics.fixman = method == SamplingMethod::rigid_fixman;
    // The Fixman force is computed on the host; OpenMM stays on the GPU.
    if (scene.dynamics.fixman && uses_gpu(backend)) {
        scene.solver.backend = Backend::segments;
        if (scene.forces.openmm->platform.empty()) scene.forces.openmm->platform = "CUDA";
    }
    return std::make_unique<CatenaMover>(std::move(scene), communicator);
}

/// Series of samples: one value per chain and sample, and one kinetic energy of all chains.
struct Found {
    CopySeries gyration, end_to_end, cosine, virial, divergence, kinetic;
    /// Numbers of all chains together, with their values so far.
    std::vector<std::pair<SystemValue, CopySeries>> system;
    /// Centres of mass of the chains at the first sample and at the last.
    std::vector<Vec3> first, last;

    explicit Found(std::int64_t chains) : kinetic(1) {
        for (CopySeries* each : {&gyration, &end_to_end, &cosine, &virial, &divergence})
            each->resize(static_cast<std::size_t>(chains));
    }
    void add(std::vector<ChainSample> const& samples) {
        for (std::size_t c = 0; c < samples.size(); ++c) {
            gyration[c].push_back(samples[c].radius_of_gyration);
            end_to_end[c].push_back(samples[c].end_to_end);
            cosine[c].push_back(samples[c].cosine);
            virial[c].push_back(samples[c].virial);
            divergence[c].push_back(samples[c].divergence);
        }
    }
    void add(std::vector<SystemValue> const& values) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (i == system.size()) system.push_back({values[i], CopySeries(1)});
            system[i].second.front().push_back(values[i].value);
        }
    }
    void add_centres(std::vector<Vec3> centres) {
        if (first.empty()) first = centres;
        last = std::move(centres);
    }
    /// Returns <|dx|^2> / (6 t) in nm^2/ns with its standard error over chains. `time`: t, ps.
    Blocked diffusion(double time) const {
        CopySeries each;
        for (std::size_t c = 0; c < first.size(); ++c) {
            Vec3 const moved = last[c] - first[c];
            each.push_back({1e3 * dot(moved, moved) / (6 * time)});
        }
        return time > 0 ? blocked_mean(each) : Blocked{};
    }
};

/// The course of a row: discarded steps, then steps and samples.
class RowRun {
  public:
    RowRun(SampledChains& chains, BenchRequest const& request, SamplingRow& row)
        : chains_(chains),
          options_(request.sampling),
          quiet_(request.quiet),
          row_(row),
          found_(chains.chains()) {
        of_block_ = std::max<std::int64_t>(1, std::llround(options_.every / row.step));
        double const block = row.every = static_cast<double>(of_block_) * row.step;
        discarded_ = std::llround(std::ceil(options_.discard / block - 1e-9));
        wanted_ = std::max<std::int64_t>(1, std::llround(options_.duration / block));
    }
    /// Total time of the row, ps.
    double time() const {
        return static_cast<double>((discarded_ + wanted_) * of_block_) * row_.step;
    }

    /// Runs the row until its end or until --seconds.
    void run(Mover& mover) {
        Progress progress(quiet_, 0, (discarded_ + wanted_) * of_block_, row_.step, false);
        double const start = seconds_now();
        for (std::int64_t block = 0; block < discarded_ + wanted_ && !row_.cut; ++block) {
            double const before = seconds_now();
            mover.step(static_cast<int>(of_block_));
            double const after = seconds_now();
            if (block < discarded_) {
                row_.link_error = larger(row_.link_error, mover.link_error());
            } else {
                stepped_.push_back((after - before) / static_cast<double>(of_block_));
                row_.times.stepping += after - before;
                row_.times.steps += of_block_;
                sample(mover);
                row_.times.sampling += seconds_now() - after;
            }
            if (!(row_.link_error <= std::max(torn, mover.tolerance())))
                throw ComputationError("links are torn");
            progress.update((block + 1) * of_block_);
            row_.cut = options_.seconds > 0 && seconds_now() - start > options_.seconds &&
                       block + 1 < discarded_ + wanted_;
        }
        progress.finish();
    }

    /// Sets the means of the row from its samples.
    void conclude(SamplingMethod method) {
        Scene const& model = chains_.model();
        row_.samples = std::ssize(found_.kinetic.front());
        row_.time = static_cast<double>(row_.samples * of_block_) * row_.step;
        row_.all = 1e-3 * row_.time * static_cast<double>(chains_.copies());
        row_.gyration = blocked_mean(found_.gyration);
        for (std::vector<double> const& each : found_.gyration)
            row_.gyration_of_chains.push_back(blocked_mean({each}).mean);
        row_.end_to_end = blocked_mean(found_.end_to_end);
        row_.cosine = blocked_mean(found_.cosine);
        row_.times.seconds = spread_of(stepped_);
        if (row_.samples == 0) return;
        row_.temperature = blocked_ratio(found_.virial, found_.divergence);
        row_.temperature.mean /= model.boltzmann();
        row_.temperature.error /= model.boltzmann();
        std::int64_t dof = 3 * chains_.beads().size();
        if (method != SamplingMethod::bonds) dof -= std::ssize(chains_.beads().links);
        for (double& kinetic : found_.kinetic.front())
            kinetic *= 2 / (model.boltzmann() * static_cast<double>(dof));
        row_.kinetic = blocked_mean(found_.kinetic);
        for (auto const& [what, series] : found_.system)
            row_.together.means.push_back({what.name, what.unit, blocked_mean(series)});
        row_.together.diffusion = found_.diffusion(row_.time - row_.every);
    }

  private:
    /// Takes one sample of all chains.
    void sample(Mover& mover) {
        Moment const now = mover.now();
        row_.link_error = larger(row_.link_error, now.link_error);
        double const nearest = chains_.nearest(now.position);
        if (std::isnan(nearest)) throw ComputationError("positions are not finite");
        row_.distances.nearest = std::min(row_.distances.nearest, nearest);
        std::vector<ChainSample> const samples =
            chains_.sample(now.position, measure_of(row_.method));
        for (ChainSample const& each : samples)
            if (!std::isfinite(each.radius_of_gyration + each.virial + each.divergence))
                throw ComputationError("positions or forces are not finite");
        found_.add(samples);
        found_.add(chains_.system_values(now.position));
        found_.add_centres(chains_.centres(now.position));
        found_.kinetic.front().push_back(now.kinetic);
    }

    SampledChains& chains_;
    SamplingOptions const& options_;
    bool quiet_;
    SamplingRow& row_;
    Found found_;
    std::vector<double> stepped_;
    std::int64_t of_block_, discarded_, wanted_;
};

/// Decides the state of a row.
void judge(SamplingRow& row, double tolerance) {
    row.state = "INVALID";
    if (row.samples == 0) {
        row.state = "too short";
        row.why = "no sample within --seconds: the discarded part took all the time";
    } else if (!(row.link_error <= tolerance)) {
        row.why =
            fmt::format("links have errors of {:.1e} of their length, the tolerance is {:.0e}",
                        row.link_error, tolerance);
    } else if (!(row.distances.nearest > longest_cutoff())) {
        row.why = fmt::format("two copies came within {:.3g} nm of each other, forces reach {} nm",
                              row.distances.nearest, longest_cutoff());
    } else if (!std::isfinite(row.gyration.mean + row.end_to_end.mean + row.cosine.mean +
                              row.temperature.mean)) {
        row.why = "a mean is not finite";
    } else {
        row.state = "VALID";
    }
}

}  // namespace

char const* name_of(SamplingMethod method) {
    return method_names[static_cast<std::size_t>(method)].data();
}

bool is_energy(SystemMean const& each) { return each.name.ends_with(" energy"); }

SamplingMethod sampling_method_named(std::string const& option, std::string const& name) {
    known_value(option, name, method_names);
    return static_cast<SamplingMethod>(
        std::find(std::begin(method_names), std::end(method_names), name) -
        std::begin(method_names));
}

BondMeasure measure_of(SamplingMethod method) {
    return method == SamplingMethod::rigid || method == SamplingMethod::constraints
               ? BondMeasure::rigid
               : BondMeasure::flexible;
}

SamplingRow run_sampling_row(SampledChains& chains, BenchRequest const& request,
                             Communicator const& communicator, Backend backend,
                             SamplingMethod method, double step) {
    SamplingRow row;
    row.method = method;
    row.step = step;
    RowRun run(chains, request, row);
    row.distances = chains.distances(run.time());
    std::unique_ptr<Mover> mover;
    try {
        mover = make_mover(chains, communicator, backend, method, step, run.time());
        mover->describe(row);
        run.run(*mover);
        run.conclude(method);
        judge(row, mover->tolerance());
    } catch (InputError const&) {
        throw;
    } catch (std::bad_alloc const&) {
        throw;
    } catch (std::exception const& error) {
        run.conclude(method);
        row.state = mover ? "unstable" : "failed";
        row.why = error.what();
        spdlog::info("{} at {} ps: {}", name_of(method), step, row.why);
    }
    return row;
}

void equilibrate(SampledChains& chains, BenchRequest const& request,
                 Communicator const& communicator, Backend backend, double time) {
    int constexpr of_block = 100;
    double const step = chains.model().dynamics.step;
    std::int64_t const blocks = std::llround(std::ceil(time / (step * of_block)));
    if (blocks == 0) return;
    std::unique_ptr<Mover> const mover =
        make_mover(chains, communicator, backend, SamplingMethod::rigid, step, time);
    Progress progress(request.quiet, 0, blocks * of_block, step, false);
    auto const fail = [step](std::string const& why) {
        throw ComputationError(
            fmt::format("equilibration on rigid links with dynamics.step {} ps: {}", step, why));
    };
    try {
        for (std::int64_t block = 0; block < blocks; ++block) {
            mover->step(of_block);
            progress.update((block + 1) * of_block);
        }
    } catch (ComputationError const& error) {
        fail(error.what());
    }
    progress.finish();
    Moment const now = mover->now();
    if (!(now.link_error <= mover->tolerance()))
        fail(fmt::format("links have errors of {:.1e} of their length", now.link_error));
    if (!(chains.nearest(now.position) > longest_cutoff())) fail("copies have met");
    chains.start_from(now.position);
}

}  // namespace catena::command
