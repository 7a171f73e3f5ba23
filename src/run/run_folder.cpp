// Implements the output folder of a run: creation, frames, checkpoints and final files.
#include "run/run_folder.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "error.hpp"
#include "io/output_file.hpp"
#include "mpi/first_rank.hpp"

namespace catena {
namespace fs = std::filesystem;
namespace {

bool same_folder(fs::path const& a, fs::path const& b) {
    std::error_code ignored;
    return fs::equivalent(a.empty() ? "." : a, b.empty() ? "." : b, ignored);
}

char const* const files_of_a_run[] = {
    "trajectory.h5md", "topology.pdb",           "topology.cif", "topology.psf",  "observables.csv",
    "checkpoint.h5",   "checkpoint.previous.h5", "summary.json", "timeline.json", "report.html",
    "replicas.csv"};

}  // namespace

bool holds_run(std::string const& folder) {
    std::error_code ignored;
    auto const has = [&](char const* file) { return fs::exists(fs::path(folder) / file, ignored); };
    return has("trajectory.h5md") || has("observables.csv") || has("checkpoint.h5");
}

namespace {

/// True if a run may begin in an existing folder as in a new one, i.e. if it contains at most a
/// lock.
bool is_vacant(std::string const& folder) {
    std::error_code error;
    fs::directory_iterator entries(folder, error);
    if (error) return false;
    return std::all_of(fs::begin(entries), fs::end(entries), [](fs::directory_entry const& e) {
        return e.path().filename() == run_lock_name;
    });
}

/// True if the folder exists. Throws InputError if that cannot be determined.
bool is_there(std::string const& folder) {
    std::error_code error;
    bool const exists = fs::exists(folder, error);
    if (error)
        throw InputError("the output folder cannot be read: " + error.message(), folder,
                         "name another folder with --output");
    return exists;
}

}  // namespace

RunFolder::RunFolder(Scene const& scene, Communicator const& communicator,
                     RunOptions const& options)
    : scene_(scene), communicator_(communicator), folder_(options.output) {
    requested_io_mode_of_run(
        communicator);  // a wrong request is refused before anything is replaced
    on_first_rank(communicator, [&] {
        bool const exists = is_there(folder_);
        std::error_code ignored;
        appends_ = exists && !options.restart.empty() &&
                   same_folder(fs::path(options.restart).parent_path(), folder_);
        if (exists && !fs::is_directory(folder_, ignored))
            throw InputError("the output exists and is not a folder", folder_,
                             "name another folder with --output");
        if (appends_ && options.branch)
            throw InputError("a branch needs a folder of its own", folder_,
                             "name another folder with --output");
        if (exists && !appends_) refuse_unless_free(options);
        make_output_folder(folder_);
        lock_ = std::make_unique<RunLock>(folder_);
        if (!appends_) refuse_unless_free(options);  // another run may have ended in the meantime
        for (char const* name : files_of_a_run)
            fs::remove(path(std::string(name) + ".writing"), ignored);
        if (exists && !appends_)
            for (char const* name : files_of_a_run) fs::remove(path(name), ignored);
    });
    appends_ = communicator.sum(appends_ ? 1 : 0) > 0;  // only rank 0 looked
}

void RunFolder::refuse_unless_free(RunOptions const& options) const {
    if (!lock_) RunLock::refuse_if_taken(folder_);
    if (options.overwrite || is_vacant(folder_)) return;
    std::string const checkpoint = newest_checkpoint();
    std::string remedy = "name another folder with --output";
    if (options.restart.empty())
        remedy += (checkpoint.empty() ? "" : ", continue with --restart " + checkpoint) +
                  ", or replace it with --overwrite";
    throw InputError("the output folder exists", folder_, remedy);
}

/// An interruption between the two renames of a checkpoint leaves only the preceding one.
std::string RunFolder::newest_checkpoint() const {
    std::error_code ignored;
    for (char const* name : {"checkpoint.h5", "checkpoint.previous.h5"})
        if (fs::exists(path(name), ignored)) return path(name);
    return {};
}

void refuse_large_checkpoint(OwnState const& own, Scene const& scene,
                             Communicator const& communicator, std::string const& folder) {
    double bytes = 0;
    for (auto const& [name, array] : own)
        bytes +=
            static_cast<double>(sizeof(double)) * static_cast<double>(scene.bodies()) * array.width;
    on_first_rank(communicator, [&] {
        rlimit limit{};
        if (getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY ||
            bytes <= static_cast<double>(limit.rlim_cur))
            return;
        throw InputError(fmt::format("a checkpoint takes {:.3g} MB at least, `ulimit -f` allows "
                                     "files of {:.3g} MB",
                                     1e-6 * bytes, 1e-6 * static_cast<double>(limit.rlim_cur)),
                         folder + "/checkpoint.h5", "raise it, or make fewer bodies or copies");
    });
}

void RunFolder::open(Topology const& topology, Observables const& observables,
                     Continuation const& go_on) {
    std::optional<Continuation> const after = appends_ ? std::optional(go_on) : std::nullopt;
    on_disk([&] {
        if (wants_topology()) topology_ = std::make_unique<TopologyWriter>(folder_, topology);
    });
    telling_way_back([&] {
        TrajectoryOfRanks made =
            make_trajectory(communicator_, path("trajectory.h5md"), topology,
                            scene_.output.velocities, scene_.output.joint_forces, after);
        trajectory_ = std::move(made.writer);
        frames_way_ = made.way;
    });
    on_first_rank(communicator_, [&] {
        auto const table = [&](char const* name, std::vector<std::string> const& columns) {
            return std::make_unique<ObservablesWriter>(path(name), columns, after,
                                                       scene_.si ? "s" : "ps");
        };
        observables_ = table("observables.csv", observables.columns());
        if (!observables.replica_columns().empty())
            of_replicas_ = table("replicas.csv", observables.replica_columns());
    });
}

std::int64_t RunFolder::records_before(std::int64_t n) const {
    return trajectory_ ? trajectory_->frames() - (step_ == n ? 1 : 0) : 0;
}

std::string RunFolder::way_back() const {
    std::string const checkpoint = newest_checkpoint();
    if (checkpoint.empty())
        return ": no checkpoint was written yet; correct this and run it again with --overwrite";
    return ": the last checkpoint and the frames up to it are whole; correct this and continue "
           "with "
           "--restart " +
           checkpoint;
}

template <class Action>
void RunFolder::telling_way_back(Action const& action) {
    try {
        action();
    } catch (SharedError const& error) {
        throw SharedError(error.what() + way_back());
    } catch (ComputationError const& error) {
        throw ComputationError(error.what() + way_back());
    }
}

template <class Action>
void RunFolder::on_disk(Action const& action) {
    on_first_rank(communicator_, [&] { telling_way_back(action); });
}

template <class Action>
void RunFolder::with_frames(Action const& action) {
    if (frames_way_.collective)
        telling_way_back(action);
    else if (communicator_.rank() == 0)
        keeping_failure(action);
}

template <class Action>
void RunFolder::keeping_failure(Action const& action) {
    if (failure_) return;
    try {
        action();
    } catch (...) {
        keep(std::current_exception());
    }
}

void RunFolder::throw_kept() {
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void RunFolder::put_topology(Frame const& part, Executor const& executor) {
    keeping_failure([&] { topology_->put(part.positions, executor); });
}

void RunFolder::end_topology() {
    if (communicator_.rank() > 0) return;
    keeping_failure([&] { topology_->finish(); });
    topology_.reset();
}

void RunFolder::begin(std::int64_t step, double time) {
    step_ = step;
    time_ = time;
    with_frames([&] { trajectory_->begin(step, time); });
}

void RunFolder::put(std::span<Frame const> parts) {
    with_frames([&] { trajectory_->put(parts); });
}

void RunFolder::end(std::vector<Vector<double, 6>> const& tip_forces,
                    std::vector<double> const& observables,
                    std::vector<double> const& of_replicas) {
    with_frames([&] { trajectory_->end(tip_forces); });
    if (communicator_.rank() > 0) return;
    keeping_failure([&] {
        observables_->write(step_, time_, observables);
        if (of_replicas_) of_replicas_->write(step_, time_, of_replicas);
    });
}

void RunFolder::check() {
    on_disk([&] { throw_kept(); });
}

void RunFolder::write_checkpoint(Checkpoint const& checkpoint, ChainSystem const& system,
                                 OwnState const& own) {
    with_frames(
        [&] { trajectory_->flush(); });  // a restart needs every frame up to the checkpoint's step
    on_disk([&] {
        throw_kept();
        each_table([](ObservablesWriter& table) { table.flush(); });
    });
    std::map<std::string, std::int64_t> sizes;
    for (auto const& [name, array] : own) sizes[name] = scene_.bodies() * array.width;
    CheckpointParts const parts(system);
    telling_way_back([&] {
        CheckpointWriter writer(communicator_, path("checkpoint.h5"), checkpoint, sizes);
        checkpoints_way_ = writer.way();
        for (auto const& [name, array] : own)
            if (checkpoints_way_.collective)
                parts.pass_own(array, [&, &of = name](std::vector<ArrayPart> const& own_parts) {
                    writer.put(of, own_parts);
                });
            else
                parts.pass(array, [&, &of = name](ArrayPart const& part) {
                    writer.put(of, std::span(&part, 1));
                });
        writer.finish();
    });
}

void RunFolder::finish(std::string const& summary, std::string const& timeline) {
    with_frames([&] { trajectory_->close(); });
    on_disk([&] {
        throw_kept();
        each_table([](ObservablesWriter& table) { table.close(); });
        replace_text_file(path("summary.json"), summary);
        replace_text_file(path("timeline.json"), timeline);
        write_run_report(folder_);
        require_files();
    });
}

ObservablesTable RunFolder::read_table(char const* name, ObservablesWriter* writer) {
    ObservablesTable found;
    on_disk([&] {
        throw_kept();
        if (!writer) return;
        writer->flush();
        // A table that was deleted is named by finish(), once the summary is written.
        if (fs::exists(path(name))) found = read_observables(path(name));
    });
    return found;
}

void RunFolder::require_files() const {
    std::vector<char const*> names{"trajectory.h5md", "observables.csv"};
    if (of_replicas_) names.push_back("replicas.csv");
    for (char const* const name : names)
        if (std::error_code ignored; !fs::exists(path(name), ignored))
            throw ComputationError("a file of the run was deleted while it ran (" + path(name) +
                                   "): run it again from the start");
}

}  // namespace catena
