// Writer of trajectory.h5md. Layout of the file: trajectory_layout.hpp.
#include <algorithm>
#include <filesystem>

#include "clock.hpp"
#include "error.hpp"
#include "io/hdf5_data.hpp"
#include "io/output.hpp"
#include "io/parallel_io_mode.hpp"
#include "io/trajectory_layout.hpp"
#include "io/trial.hpp"
#include "io/writers.hpp"
#include "mpi/collectives.hpp"
#include "mpi/first_rank.hpp"

namespace catena {
namespace {

using namespace hdf5;

std::string const writing = "write the trajectory";
constexpr double seconds_between_flushes = 10;
/// Size in bytes from which all ranks write frames together. Smaller ones are gathered and written
/// by a thread of rank 0, while steps go on (run/frame_writer.hpp).
constexpr std::int64_t largest_frame_beside = std::int64_t{512} << 20;

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Quat) == 4 * sizeof(double),
              "frames are handed to HDF5 as they lie");

/// Returns access properties that keep metadata in memory between flushes. A killed run thus leaves
/// the file as its last flush left it, complete.
Properties access_of(Writers const& writers, std::string const& file) {
    Properties access(check(H5Pcreate(H5P_FILE_ACCESS), file, writing));
    H5AC_cache_config_t cache;
    cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
    check(H5Pget_mdc_config(access.get(), &cache), file, writing);
    cache.evictions_enabled = false;
    cache.incr_mode = H5C_incr__off;
    cache.flash_incr_mode = H5C_flash_incr__off;
    cache.decr_mode = H5C_decr__off;
    check(H5Pset_mdc_config(access.get(), &cache), file, writing);
    writers.prepare(access, file, writing);
    return access;
}

/// State between two frames that the next writer of the file needs.
struct FrameContext {
    TrajectoryContents contents;
    Vec3 box;
    hsize_t frames = 0;
    std::int64_t last_step = 0;
};
static_assert(std::is_trivially_copyable_v<FrameContext>, "goes from rank to rank as it lies");

/// True if a part of a frame lies within the arrays that the contents require and has all of them.
bool arrays_fit(Frame const& part, TrajectoryContents const& contents) {
    std::size_t const sites = part.positions.size(), bodies = part.orientations.size();
    auto const of_sites = [&](std::size_t size, bool wanted) { return !wanted || size == sites; };
    auto const of_bodies = [&](std::size_t size, bool wanted) { return !wanted || size == bodies; };
    return part.first_site + sites <= contents.sites &&
           part.first_body + bodies <= contents.bodies &&
           of_sites(part.velocities.size(), contents.velocities) &&
           of_sites(part.joint_forces.size(), contents.joint_forces) &&
           of_bodies(part.body_positions.size(), contents.body_states) &&
           of_bodies(part.body_velocities.size(), contents.body_states) &&
           of_bodies(part.angular_velocities.size(), contents.body_states) &&
           of_bodies(part.joint_positions.size(), contents.joint_states) &&
           of_bodies(part.joint_rates.size(), contents.joint_states);
}

/// Separates pairs [torque, force] into torques and forces.
std::pair<std::vector<double>, std::vector<double>> halves_of(
    std::span<Frame const> parts, std::vector<Vector<double, 6>> Frame::* wrenches) {
    std::pair<std::vector<double>, std::vector<double>> halves;
    for (Frame const& part : parts)
        for (Vector<double, 6> const& wrench : part.*wrenches) {
            halves.first.insert(halves.first.end(), wrench.data, wrench.data + 3);
            halves.second.insert(halves.second.end(), wrench.data + 3, wrench.data + 6);
        }
    return halves;
}

/// Row of a frame in the datasets of a file.
struct FrameRow {
    Place place;
    hsize_t frame;
    hid_t transfer;

    /// Writes the values of all parts by a single call of HDF5.
    template <class Value>
    void put(Series& series, std::span<Series::Part const> where, std::span<Frame const> parts,
             std::vector<Value> Frame::* values) const {
        if (parts.size() == 1)
            return series.put(place, frame, where, (parts[0].*values).data(), transfer);
        std::vector<Value> joined;
        for (Frame const& part : parts)
            joined.insert(joined.end(), (part.*values).begin(), (part.*values).end());
        series.put(place, frame, where, joined.data(), transfer);
    }
};

/// Writes the arrays of the parts' sites and bodies.
void put_parts(FrameRow const& row, TrajectorySeries& series, TrajectoryContents const& contents,
               std::span<Frame const> parts) {
    std::vector<Series::Part> sites, bodies;
    for (Frame const& part : parts) {
        sites.push_back({part.first_site, part.positions.size()});
        bodies.push_back({part.first_body, part.orientations.size()});
    }
    row.put(series.position, sites, parts, &Frame::positions);
    if (contents.velocities) row.put(series.velocity, sites, parts, &Frame::velocities);
    if (contents.bodies > 0) row.put(series.orientation, bodies, parts, &Frame::orientations);
    if (contents.body_states) {
        row.put(series.body_position, bodies, parts, &Frame::body_positions);
        row.put(series.body_velocity, bodies, parts, &Frame::body_velocities);
        row.put(series.angular_velocity, bodies, parts, &Frame::angular_velocities);
    }
    if (contents.joint_states) {
        row.put(series.joint_position, bodies, parts, &Frame::joint_positions);
        row.put(series.joint_rate, bodies, parts, &Frame::joint_rates);
    }
    if (!contents.joint_forces) return;
    auto const [torque, force] = halves_of(parts, &Frame::joint_forces);
    series.torque.put(row.place, row.frame, sites, torque.data(), row.transfer);
    series.force.put(row.place, row.frame, sites, force.data(), row.transfer);
}

/// Returns the steps of the frames that are complete.
std::vector<std::int64_t> read_steps(TrajectorySeries& series, Place const& place) {
    hsize_t whole = series.step.frames(place);
    std::vector<std::int64_t> steps(whole);
    if (whole > 0)
        check(H5Dread(series.step.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                      steps.data()),
              place.file, "read the steps");
    for (Series* each : series.present()) whole = std::min(whole, each->frames(place));
    steps.resize(whole);
    return steps;
}

/// Reads, in a trial process, all that a continuation reads and a number of each last row.
void look_through(std::string const& file_name, TrajectoryContents const& contents) {
    File const file(
        check(H5Fopen(file_name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), file_name, writing));
    Place const place{file.get(), file_name, writing};
    TrajectorySeries series = open_trajectory(place, contents);
    read_steps(series, place);
    for (Series const* each : series.present()) each->look_at_last(place);
}

/// Returns the number of frames up to the continuation's step. Throws InputError if frames before
/// it are lost.
hsize_t frames_kept(std::vector<std::int64_t> const& steps, Continuation const& go_on,
                    std::string const& file_name) {
    auto const kept = std::find_if(steps.begin(), steps.end(),
                                   [&](std::int64_t step) { return step > go_on.after_step; }) -
                      steps.begin();
    if (kept < go_on.records)
        throw InputError("the trajectory has lost frames: " + std::to_string(kept) + " of the " +
                             std::to_string(go_on.records) + " before the checkpoint are there",
                         file_name,
                         std::string("restore the whole file, or ") + Continuation::way_beside);
    return static_cast<hsize_t>(kept);
}

/// Writer of one H5MD file, by one rank or by all ranks together.
class H5mdWriter final : public TrajectoryWriter {
  public:
    H5mdWriter(std::string file, Topology const& topology, bool velocities, bool joint_forces,
               std::optional<Continuation> const& go_on)
        : name_(std::move(file)),
          writers_(one_writer()),
          at_{contents_of(topology, velocities, joint_forces),
              topology.box.value_or(Vec3::zero())} {
        Quiet const quiet;
        if (go_on)
            open(*go_on);
        else
            create(topology);
        flush();
    }

    /// Continues a file that another writer has closed.
    H5mdWriter(std::string file, FrameContext const& standing, std::unique_ptr<Writers> writers)
        : name_(std::move(file)), writers_(std::move(writers)), at_(standing) {
        Quiet const quiet;
        try {
            file_ =
                File(check(H5Fopen(name_.c_str(), H5F_ACC_RDWR, access_of(*writers_, name_).get()),
                           name_, writing));
            writers_->watch(file_, name_, writing);
            series_ = open_trajectory(place(), at_.contents);
        } catch (...) {
            if (writers_->are_several()) leave_open();
            throw;
        }
    }

    /// Leaves the file open if all ranks write: the others may not know that this rank stops here,
    /// and closing is collective.
    ~H5mdWriter() override {
        Quiet const quiet;
        if (writers_->are_several()) leave_open();
        for (Series* series : series_.present()) *series = Series();
    }

    void begin(std::int64_t step, double time) override {
        if (!file_)
            throw ComputationError("cannot write the trajectory (" + name_ + "): it is closed");
        if (at_.frames > 0 && step <= at_.last_step)
            refuse(step, "its last frame is already of step " + std::to_string(at_.last_step));
        step_ = step;
        time_ = time;
        sites_ = bodies_ = 0;
        if (writers_->are_several()) make_room_for_frame();
    }

    void put(std::span<Frame const> parts) override {
        for (Frame const& part : parts) require_fit(part);
        whole_or_as_flushed([&] {
            put_parts({place(), at_.frames, writers_->transfer()}, series_, at_.contents, parts);
        });
    }
    void end(std::vector<Vector<double, 6>> const& tip_forces) override {
        bool const whole =
            static_cast<hsize_t>(writers_->sum(static_cast<std::int64_t>(sites_))) ==
                at_.contents.sites &&
            static_cast<hsize_t>(writers_->sum(static_cast<std::int64_t>(bodies_))) ==
                at_.contents.bodies;
        if (!whole || (writers_->is_first() && at_.contents.joint_forces &&
                       tip_forces.size() != at_.contents.tips))
            refuse_arrays();
        whole_or_as_flushed([&] { end_frame(tip_forces); });
    }
    void flush() override {
        whole_or_as_flushed([&] {
            writers_->make_room(file_, 0, name_, writing);
            writers_->flush_to_disk(file_, name_, writing);
        });
        flushed_ = seconds_now();
    }
    void close() override {
        if (!file_) return;
        // A full disk causes an error at the flush; H5Fclose always reports success.
        flush();
        Quiet const quiet;
        for (Series* series : series_.present()) series->close(place());
        check(file_.close(), name_, writing);
    }

    std::int64_t frames() const override { return static_cast<std::int64_t>(at_.frames); }
    FrameContext const& standing() const { return at_; }
    bool is_for_all() const { return series_.position.is_for_all(place()); }

  private:
    /// Runs `action`. After a failure the file stays as its last flush left it.
    template <class Action>
    void whole_or_as_flushed(Action const& action) {
        Quiet const quiet;
        try {
            action();
        } catch (...) {
            if (!writers_->leave_as_flushed(file_)) leave_open();
            throw;
        }
    }
    void leave_open() {
        for (Series* series : series_.present()) series->release();
        file_.release();
    }

    /// Throws ComputationError if the arrays of a part do not fit the topology or the parts before.
    void require_fit(Frame const& part) {
        bool const in_order =
            writers_->are_several() || (part.first_site == sites_ && part.first_body == bodies_);
        if (!in_order || !arrays_fit(part, at_.contents)) refuse_arrays();
        sites_ += part.positions.size();
        bodies_ += part.orientations.size();
    }

    /// Reserves disk space for the next frame. Collective.
    void make_room_for_frame() {
        whole_or_as_flushed([&] {
            hsize_t more = 0;
            for (Series const* series : series_.present())
                more += series->growth(place(), at_.frames);
            writers_->make_room(file_, more, name_, writing);
        });
    }

    /// Writes the values of the whole frame, its step last, and flushes if that is due.
    void end_frame(std::vector<Vector<double, 6>> const& tip_forces) {
        Frame tips;
        tips.tip_forces = tip_forces;
        auto const [torque, force] = halves_of(std::span(&tips, 1), &Frame::tip_forces);
        if (at_.contents.periodic) put_from_first(series_.edges, at_.box.data);
        if (series_.tip_force) {
            put_from_first(series_.tip_torque, torque.data());
            put_from_first(series_.tip_force, force.data());
        }
        put_from_first(series_.time, &time_);
        put_from_first(series_.step, &step_);
        ++at_.frames;
        at_.last_step = step_;
        bool const at_once = std::exchange(
            is_first_here_, false);  // the file can be inspected from its first frame on
        bool const due = writers_->is_first() &&
                         (at_once || seconds_now() - flushed_ >= seconds_between_flushes);
        if (writers_->sum(due ? 1 : 0) == 0) return;
        writers_->make_room(file_, 0, name_, writing);
        check(H5Fflush(file_.get(), H5F_SCOPE_LOCAL), name_, writing);
        flushed_ = seconds_now();
    }
    /// Grows a series on all ranks; only the first rank writes values.
    void put_from_first(Series& series, void const* values) {
        series.put(place(), at_.frames, writers_->is_first() ? values : nullptr);
    }
    Place place() const { return {file_.get(), name_, writing}; }

    void create(Topology const& topology) {
        Properties const access = access_of(*writers_, name_);
        file_ = File(check(H5Fcreate(name_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()),
                           name_, writing));
        series_ = create_trajectory(place(), topology, at_.contents);
    }

    /// Opens an existing file after a trial, and removes the frames after the continuation's step.
    void open(Continuation const& go_on) {
        if (!std::filesystem::exists(name_))
            throw InputError("there is no trajectory to continue", name_,
                             std::string("restore it, or ") + Continuation::way_beside);
        if (std::string const end =
                trial([&] { look_through(name_, at_.contents); }, limits_for_file(name_));
            !end.empty())
            throw InputError("the trajectory is damaged, HDF5 fails to read it: " + end, name_,
                             Continuation::way_beside);
        Properties const access = access_of(*writers_, name_);
        file_ = File(H5Fopen(name_.c_str(), H5F_ACC_RDWR, access.get()));
        if (!file_)
            throw InputError("the trajectory cannot be opened, " + cause(), name_,
                             std::string("close it elsewhere, or ") + Continuation::way_beside);
        std::vector<std::int64_t> steps;
        try {
            series_ = open_trajectory(place(), at_.contents);
            steps = read_steps(series_, place());
        } catch (ComputationError const& error) {
            throw InputError("the trajectory is damaged, " + std::string(error.what()), name_,
                             Continuation::way_beside);
        }
        at_.frames = frames_kept(steps, go_on, name_);
        if (at_.frames > 0) at_.last_step = steps[at_.frames - 1];
        for (Series* series : series_.present()) series->cut(place(), at_.frames);
    }

    /// Throws ComputationError for a frame that cannot be written.
    [[noreturn]] void refuse(std::int64_t step, std::string const& why) const {
        throw ComputationError("cannot write the trajectory (" + name_ + ", step " +
                               std::to_string(step) + "): " + why);
    }
    [[noreturn]] void refuse_arrays() const {
        refuse(step_, "the frame's arrays do not match the topology");
    }

    std::string name_;
    std::unique_ptr<Writers> writers_;
    FrameContext at_;
    File file_;
    TrajectorySeries series_;
    std::int64_t step_ = 0;  // current frame
    double time_ = 0;
    std::size_t sites_ = 0, bodies_ = 0;  // this rank's part of the frame so far
    double flushed_ = 0;                  // time of the last flush, s
    bool is_first_here_ = true;           // no frame has been written here yet
};

}  // namespace

std::unique_ptr<TrajectoryWriter> make_trajectory(std::string const& file, Topology const& topology,
                                                  bool velocities, bool joint_forces,
                                                  std::optional<Continuation> const& go_on) {
    return std::make_unique<H5mdWriter>(file, topology, velocities, joint_forces, go_on);
}

TrajectoryOfRanks make_trajectory(Communicator const& communicator, std::string const& file,
                                  Topology const& topology, bool velocities, bool joint_forces,
                                  std::optional<Continuation> const& go_on) {
    std::unique_ptr<H5mdWriter> writer;
    bool fits = false;
    std::int64_t bytes = 0;
    on_first_rank(communicator, [&] {
        writer = std::make_unique<H5mdWriter>(file, topology, velocities, joint_forces, go_on);
        fits = writer->is_for_all();
        bytes = writer->standing().contents.bytes_of_frame();
    });
    RequestedIoMode const wish = requested_io_mode_of_run(communicator);
    ParallelIoMode way = choose_file_way(communicator, wish, file, bytes,
                                         {largest_frame_beside, "frames are small"});
    if (way.collective && communicator.sum(fits ? 1 : 0) == 0)
        way = by_the_root("an earlier version began the file");
    require_wished(wish, way, file);
    if (!way.collective) return {std::move(writer), way};
    FrameContext standing;
    on_first_rank(communicator, [&] {
        standing = writer->standing();
        writer->close();
    });
    broadcast(communicator, standing);
    std::unique_ptr<Writers> all;
    std::string const why = why_not_together(
        communicator,
        {[&] { all = all_writers(communicator); },
         [&] { writer = std::make_unique<H5mdWriter>(file, standing, std::move(all)); }});
    if (why.empty()) return {std::move(writer), way};
    writer.reset();
    way = by_the_root(why);
    require_wished(wish, way, file);
    on_first_rank(communicator,
                  [&] { writer = std::make_unique<H5mdWriter>(file, standing, one_writer()); });
    return {std::move(writer), way};
}

}  // namespace catena
