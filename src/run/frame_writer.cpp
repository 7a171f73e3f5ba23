// Implements the writing of a run's frames.
#include "run/frame_writer.hpp"

#include <chrono>
#include <system_error>
#include <utility>

#include "clock.hpp"

namespace catena {
namespace {

/// Adds the wall time of its life to a sum.
class Stopwatch {
  public:
    explicit Stopwatch(double& sum) : sum_(sum), begin_(seconds_now()) {}
    Stopwatch(Stopwatch const&) = delete;
    Stopwatch& operator=(Stopwatch const&) = delete;
    ~Stopwatch() { sum_ += seconds_now() - begin_; }

  private:
    double& sum_;
    double begin_;
};

}  // namespace

FrameWriter::FrameWriter(Source const& run, Sites sites) : run_(run), sites_(std::move(sites)) {}

void FrameWriter::open(std::function<void()> const& look) {
    bool const root = run_.communicator.rank() == 0;
    at_start_ = observed(true);
    look();
    folder_ = std::make_unique<RunFolder>(run_.scene, run_.communicator, run_.options);
    observables_ = std::make_unique<Observables>(run_.scene, topology(), at_start_->terms);
    folder_->open(topology(), *observables_, run_.origin.go_on());
    if (folder_->frames_way().collective && !root)
        sites_ = Sites(run_.scene, Snapshots(run_.system).own_runs());
    if (!folder_->wants_topology()) return;
    topology_is_due_ = run_.communicator.size() == 1 &&
                       run_.origin.is_frame(run_.origin.first_step()) && may_write_beside() &&
                       run_.options.topology_beside.value_or(uses_gpu(run_.system.backend()));
    if (topology_is_due_) return;
    at_start_->bodies = own_bodies();
    write_topology(*at_start_->bodies);
    folder_->check();
}

bool FrameWriter::is_kept(std::int64_t n) const {
    return n == run_.origin.first_step() && !folder_->wants_topology() &&
           run_.origin.go_on().after_step == n;
}

void FrameWriter::write_topology(OwnBodies const& at_start) {
    Snapshots(run_.system).pass(at_start, [&](SceneBodies const& bodies) {
        folder_->put_topology(sites_.part(bodies, false, run_.system.executor()),
                              run_.system.executor());
    });
    folder_->end_topology();
}

FrameWriter::Observed FrameWriter::observed(bool anyway) {
    run_.stepper.observe({.joint_forces = run_.scene.output.joint_forces,
                          .energies = anyway || has_energies(run_.scene)});
    return {has_energies(run_.scene) ? run_.system.potential_energy() : std::vector<EnergyTerm>()};
}

OwnBodies FrameWriter::own_bodies() {
    return Snapshots(run_.system)
        .own(
            run_.scene.output.joint_forces,
            run_.scene.output.coordinates && uses_joint_coordinates(run_.scene.dynamics.integrator),
            std::exchange(spare_, {}));
}

bool FrameWriter::may_write_beside() const {
    std::int64_t const bodies = run_.scene.bodies();
    return bodies >= run_.options.bodies_beside &&
           (run_.communicator.size() == 1 ||
            (!folder_->frames_way().collective && bodies <= most_bodies_kept));
}

void FrameWriter::write(std::int64_t n, double constraint_error) {
    finish();
    {
        Stopwatch const watch(seconds_["observing frames"]);
        pending_ = {n, constraint_error, at_start_ ? std::move(*at_start_) : observed(), {}};
        if (!pending_->now.bodies) pending_->now.bodies = own_bodies();
        if (run_.scene.output.joint_forces)
            for (TipForce const& tip : run_.system.tip_forces())
                pending_->at_tips.push_back(tip.wrench);
    }
    double& writing = seconds_["writing frames"];
    if (may_write_beside()) {
        gather();
        is_beside_ = true;
        if (run_.communicator.rank() > 0 || write_beside(writing)) return;
    }
    Stopwatch const watch(writing);
    // The next call checks, as on ranks that have returned.
    if (is_beside_) return write_keeping_failure();
    write(*pending_);
    pending_.reset();
    folder_->check();
}

void FrameWriter::gather() {
    if (run_.communicator.size() == 1) return;
    Stopwatch const watch(seconds_["gathering frames"]);
    pending_->all =
        Snapshots(run_.system).gathered(*pending_->now.bodies, std::exchange(spare_of_all_, {}));
}

bool FrameWriter::write_beside(double& writing) {
    try {
        frame_ = std::async(std::launch::async, [this, &writing] {
            Stopwatch const watch(writing);
            write_keeping_failure();
        });
    } catch (std::system_error const&) {
        return false;
    }
    ++frames_beside_;
    return true;
}

void FrameWriter::write_keeping_failure() {
    try {
        write(*pending_);
    } catch (...) {
        folder_->keep(std::current_exception());
    }
}

void FrameWriter::poll() {
    if (run_.communicator.size() == 1 && frame_.valid() &&
        frame_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
        finish();
}

void FrameWriter::finish() {
    if (!std::exchange(is_beside_, false)) return;
    if (frame_.valid()) {
        Stopwatch const watch(seconds_["waiting for frames"]);
        frame_.get();
    }
    if (run_.scene.bodies() <= most_bodies_kept) {
        spare_ = std::move(pending_->now.bodies->rows);
        if (pending_->all) spare_of_all_ = std::move(pending_->all->rows);
    }
    pending_.reset();
    folder_->check();
}

void FrameWriter::write(PendingFrame const& frame) {
    if (std::exchange(topology_is_due_, false)) write_topology(*frame.now.bodies);
    folder_->begin(frame.step, run_.origin.time(frame.step));
    observables_->begin();
    bool const together = folder_->frames_way().collective;
    auto const take = [&](SceneBodies const& bodies) {
        Frame const part =
            sites_.part(bodies, run_.scene.output.velocities && !together, run_.system.executor());
        if (!together) folder_->put(std::span(&part, 1));
        observables_->add(bodies.motion, part.positions);
        for (Vec3 const& x : bodies.motion.position) run_.verdict.note_coordinate(norm(x));
    };
    if (frame.all)
        Snapshots(run_.system).pass(*frame.all, take);
    else
        Snapshots(run_.system).pass(*frame.now.bodies, take);
    if (together) put_own(*frame.now.bodies);
    bool const root = run_.communicator.rank() == 0;
    if (root) judge(frame);
    folder_->end(frame.at_tips, last_row_,
                 root ? observables_->replica_row() : std::vector<double>());
}

void FrameWriter::judge(PendingFrame const& frame) {
    last_row_ = observables_->row(frame.now.terms, frame.error);
    std::optional<double> potential;
    if (has_energies(run_.scene)) {
        potential = 0;
        for (EnergyTerm const& term : frame.now.terms) *potential += term.value;
    }
    run_.verdict.add_frame(frame.step, observables_->kinetic(), potential);
}

void FrameWriter::put_own(OwnBodies const& own) {
    Snapshots(run_.system).pass_own(own, [&](std::vector<SceneBodies> const& runs) {
        std::vector<Frame> parts(runs.size());
        run_.system.executor().for_each_of_many_or_few(
            std::ssize(runs), [&](std::int64_t i, Executor const& within) {
                auto const r = static_cast<std::size_t>(i);
                parts[r] = sites_.part(runs[r], run_.scene.output.velocities, within);
            });
        folder_->put(parts);
    });
}

}  // namespace catena
