// The writer of trajectory.h5md; what lies where in the file: trajectory_layout.hpp.
#include <algorithm>
#include <chrono>
#include <filesystem>

#include "error.hpp"
#include "io/hdf5_data.hpp"
#include "io/output.hpp"
#include "io/trajectory_layout.hpp"

namespace catena {
namespace {

using namespace hdf5;

std::string const writing = "write the trajectory";
constexpr double seconds_between_flushes = 10;

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Quat) == 4 * sizeof(double), "frames are handed to HDF5 as they lie");

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Metadata stay in memory between flushes: a killed run leaves the file as its last flush left it, whole.
Properties keep_metadata_until_flush(std::string const& file) {
    Properties access(check(H5Pcreate(H5P_FILE_ACCESS), file, writing));
    H5AC_cache_config_t cache;
    cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
    check(H5Pget_mdc_config(access.get(), &cache), file, writing);
    cache.evictions_enabled = false;
    cache.incr_mode = H5C_incr__off;
    cache.flash_incr_mode = H5C_flash_incr__off;
    cache.decr_mode = H5C_decr__off;
    check(H5Pset_mdc_config(access.get(), &cache), file, writing);
    return access;
}

class H5mdWriter final : public TrajectoryWriter {
  public:
    H5mdWriter(std::string file, Topology const& topology, bool velocities, bool joint_forces, std::optional<std::int64_t> after_step)
        : name_(std::move(file)), contents_(contents_of(topology, velocities, joint_forces)), box_(topology.box.value_or(Vec3::zero())) {
        Quiet const quiet;
        if (after_step)
            open(*after_step);
        else
            create(topology);
        flush();
    }

    ~H5mdWriter() override {
        Quiet const quiet;
        for (Series* series : series_.present()) *series = Series();
    }

    void begin(std::int64_t step, double time) override {
        if (!file_) throw ComputationError("cannot write the trajectory (" + name_ + "): it is closed");
        if (frames_ > 0 && step <= last_step_) refuse(step, "its last frame is already of step " + std::to_string(last_step_));
        step_ = step;
        time_ = time;
        sites_ = bodies_ = 0;
    }

    void put(Frame const& part) override {
        std::size_t const sites = part.positions.size(), bodies = part.orientations.size();
        auto const fits = [&](std::size_t size, bool wanted) { return !wanted || size == sites; };
        if (part.first_site != sites_ || part.first_body != bodies_ || sites_ + sites > contents_.sites ||
            bodies_ + bodies > contents_.bodies.size() || !fits(part.velocities.size(), contents_.velocities) ||
            !fits(part.joint_forces.size(), contents_.joint_forces))
            refuse_arrays();
        whole_or_as_flushed([&] { put_part(part); });
    }
    void end(std::vector<Vector<double, 6>> const& tip_forces) override {
        if (sites_ != contents_.sites || bodies_ != contents_.bodies.size() ||
            (contents_.joint_forces && tip_forces.size() != contents_.tips))
            refuse_arrays();
        whole_or_as_flushed([&] { end_frame(tip_forces); });
    }
    void flush() override {
        whole_or_as_flushed([&] {
            make_room(file_, name_, writing);
            flush_to_disk(file_, name_, writing);
        });
        flushed_ = now();
    }
    void close() override {
        if (!file_) return;
        // A full disk shows at the flush; H5Fclose reports success all the same.
        flush();
        Quiet const quiet;
        for (Series* series : series_.present()) series->close(place());
        check(file_.close(), name_, writing);
    }

  private:
    template <class Action>
    void whole_or_as_flushed(Action const& action) {
        Quiet const quiet;
        try {
            action();
        } catch (...) {
            leave_as_flushed(file_);
            throw;
        }
    }
    void put_part(Frame const& part) {
        std::size_t const sites = part.positions.size(), bodies = part.orientations.size();
        series_.position.put(place(), frames_, sites_, sites, part.positions.data());
        if (contents_.velocities) series_.velocity.put(place(), frames_, sites_, sites, part.velocities.data());
        if (bodies > 0) series_.orientation.put(place(), frames_, bodies_, bodies, part.orientations.data());
        if (contents_.joint_forces) put_wrenches(part.joint_forces, sites_, series_.torque, series_.force);
        sites_ += sites;
        bodies_ += bodies;
    }

    void end_frame(std::vector<Vector<double, 6>> const& tip_forces) {
        if (contents_.periodic) series_.edges.put(place(), frames_, box_.data);
        if (series_.tip_force) put_wrenches(tip_forces, 0, series_.tip_torque, series_.tip_force);
        series_.time.put(place(), frames_, &time_);
        series_.step.put(place(), frames_, &step_);
        ++frames_;
        last_step_ = step_;
        if (now() - flushed_ < seconds_between_flushes) return;
        make_room(file_, name_, writing);
        check(H5Fflush(file_.get(), H5F_SCOPE_LOCAL), name_, writing);
        flushed_ = now();
    }
    Place place() const { return {file_.get(), name_, writing}; }

    void create(Topology const& topology) {
        Properties const access = keep_metadata_until_flush(name_);
        file_ = File(check(H5Fcreate(name_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), name_, writing));
        series_ = create_trajectory(place(), topology, contents_);
    }

    void open(std::int64_t after_step) {
        if (!std::filesystem::exists(name_)) throw InputError("no trajectory to go on with", name_, "restart in the folder that holds it");
        Properties const access = keep_metadata_until_flush(name_);
        file_ = File(H5Fopen(name_.c_str(), H5F_ACC_RDWR, access.get()));
        if (!file_)
            throw InputError("the trajectory cannot be opened, " + cause(), name_, "close it elsewhere, or start anew with --overwrite");
        std::vector<std::int64_t> steps;
        try {
            series_ = open_trajectory(place(), contents_);
            steps = read_steps();
        } catch (ComputationError const& error) {
            throw InputError("the trajectory is damaged, " + std::string(error.what()), name_, "start anew with --overwrite");
        }
        auto const kept = std::find_if(steps.begin(), steps.end(), [&](std::int64_t step) { return step > after_step; });
        frames_ = static_cast<hsize_t>(kept - steps.begin());
        if (frames_ > 0) last_step_ = steps[frames_ - 1];
        for (Series* series : series_.present()) series->cut(place(), frames_);
    }

    /// The steps of the frames that are whole.
    std::vector<std::int64_t> read_steps() {
        hsize_t whole = series_.step.frames(place());
        std::vector<std::int64_t> steps(whole);
        if (whole > 0)
            check(H5Dread(series_.step.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, steps.data()), name_, "read the steps");
        for (Series* series : series_.present()) whole = std::min(whole, series->frames(place()));
        steps.resize(whole);
        return steps;
    }

    [[noreturn]] void refuse(std::int64_t step, std::string const& why) const {
        throw ComputationError("cannot write the trajectory (" + name_ + ", step " + std::to_string(step) + "): " + why);
    }
    [[noreturn]] void refuse_arrays() const { refuse(step_, "the frame's arrays do not fit the topology"); }

    void put_wrenches(std::vector<Vector<double, 6>> const& wrenches, hsize_t first, Series& torques, Series& forces) {
        std::vector<double> torque, force;
        for (Vector<double, 6> const& wrench : wrenches) {
            torque.insert(torque.end(), wrench.data, wrench.data + 3);
            force.insert(force.end(), wrench.data + 3, wrench.data + 6);
        }
        torques.put(place(), frames_, first, wrenches.size(), torque.data());
        forces.put(place(), frames_, first, wrenches.size(), force.data());
    }

    std::string name_;
    TrajectoryContents contents_;
    Vec3 box_;
    File file_;
    TrajectorySeries series_;
    hsize_t frames_ = 0;
    std::int64_t last_step_ = 0;
    std::int64_t step_ = 0;  // of the frame on its way
    double time_ = 0;
    std::size_t sites_ = 0, bodies_ = 0;  // of it, so far
    double flushed_ = 0;
};

}  // namespace

std::unique_ptr<TrajectoryWriter> make_trajectory(std::string const& file, Topology const& topology, bool velocities, bool joint_forces,
                                                  std::optional<std::int64_t> after_step) {
    return std::make_unique<H5mdWriter>(file, topology, velocities, joint_forces, after_step);
}

}  // namespace catena
