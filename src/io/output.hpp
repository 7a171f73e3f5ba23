// The files of a run. Rank 0 writes them, handed what belongs to bodies in parts as they come from
// the ranks; trajectories and checkpoints can be all ranks' together. Every writer checks each
// write, flush and close and throws ComputationError naming file and cause (a full disk included);
// bad existing files give InputError.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/array_part.hpp"
#include "io/parallel_io_mode.hpp"
#include "math/executor.hpp"
#include "math/linear.hpp"
#include "math/rotation.hpp"

namespace catena {

/// What a trajectory shows: one site a bead, a bead that a body carries, or a body that carries
/// none (its centre of mass), chains one after the other.
struct Topology {
    struct Chain {
        std::string name;
        std::int64_t first = 0, count = 0;  // sites
        bool beads = true;                  // every site is one
        bool ring = false;
    };
    std::string title;
    std::vector<Chain> chains;
    std::vector<std::string> residue;  // three-letter name of each site; bodies: "BDY"
    std::vector<double> mass;
    std::vector<std::int64_t> bodies;  // a rigid body's site, or the first of those it carries
    std::vector<std::int64_t> tips;    // chains whose last body is on a joint to the ground
    bool body_states =
        false;  // the trajectory has positions, velocities and angular velocities of `bodies`
    bool joint_states = false;  // and their joint coordinates and rates
    std::optional<Vec3> box;
    bool si = false;  // units stay the user's: no unit attributes are written but "m", "s", ...
};

/// Of all sites, or of neighbours among them.
struct Frame {
    std::int64_t step = 0;
    double time = 0;
    std::size_t first_site = 0,
                first_body = 0;      // where a part begins, among the topology's sites and bodies
    std::vector<Vec3> positions;     // W, unwrapped
    std::vector<Vec3> velocities;    // empty: not written
    std::vector<Quat> orientations;  // of the topology's bodies, W
    std::vector<Vec3> body_positions,
        body_velocities,     // of their centres of mass, W; empty: not written
        angular_velocities;  // B; empty: not written
    std::vector<std::array<double, 4>> joint_positions;  // as BodyArrays::q; empty: not written
    std::vector<Vec3> joint_rates;                       // as BodyArrays::qd; empty: not written
    std::vector<Vector<double, 6>>
        joint_forces,  // [torque, force] on each site at its inboard joint (on a body's first), W;
                       // empty: not written
        tip_forces;    // the same at each of the topology's tips, on the last body
};

/// Where a run goes on in files that are there.
struct Continuation {
    static constexpr char const* way_beside =
        "go on in another folder: --restart CHECKPOINT --output OTHER";

    Continuation(std::int64_t step, std::int64_t least = 0)
        : after_step(step), records(least) {}  // NOLINT(google-explicit-constructor)
    std::int64_t after_step;                   // what is later is cut
    std::int64_t records;                      // frames or lines up to there, at least
};

/// H5MD 1.1 file for MDAnalysis and others.
class TrajectoryWriter {
  public:
    virtual ~TrajectoryWriter() = default;
    /// A frame in parts: these follow one another, from the first site to the last. Written by all
    /// ranks together, every call is collective and a rank's parts are its own sites in their
    /// order, however many at a time; tip forces are rank 0's.
    virtual void begin(std::int64_t step, double time) = 0;
    virtual void put(std::span<Frame const> parts) = 0;
    void put(Frame const& part) { put(std::span(&part, 1)); }
    virtual void end(std::vector<Vector<double, 6>> const& tip_forces) = 0;
    void write(Frame const& whole) {
        begin(whole.step, whole.time);
        put(whole);
        end(whole.tip_forces);
    }
    /// How many there are in the file.
    virtual std::int64_t frames() const = 0;
    /// All frames so far are on disk when this returns.
    virtual void flush() = 0;
    virtual void close() = 0;
};
/// Makes `file`; with `go_on`, opens an existing one and cuts the frames later than that step.
/// "built without HDF5" where it is absent.
std::unique_ptr<TrajectoryWriter> make_trajectory(std::string const& file, Topology const&,
                                                  bool velocities, bool joint_forces,
                                                  std::optional<Continuation> const& go_on);
/// The same for all ranks, of rank 0's topology: written by all of them where that can be
/// (CATENA_HDF5), else by rank 0, and the writer is null on the others. Collective.
struct TrajectoryOfRanks {
    std::unique_ptr<TrajectoryWriter> writer;
    ParallelIoMode way;
};
TrajectoryOfRanks make_trajectory(Communicator const&, std::string const& file, Topology const&,
                                  bool velocities, bool joint_forces,
                                  std::optional<Continuation> const& go_on);

/// PDB, and beside it PSF, which has masses and bonds; beyond 99,999 sites mmCIF in its place.
class TopologyWriter {
  public:
    TopologyWriter(std::string const& folder, Topology const&);
    ~TopologyWriter();
    /// The next sites' places; their lines are made by the executor's threads.
    void put(std::vector<Vec3> const& positions, Executor const&);
    /// Returns the paths written.
    std::vector<std::string> finish();

  private:
    struct Files;
    std::unique_ptr<Files> files_;
};
/// All of it at once.
std::vector<std::string> write_topology(std::string const& folder, Topology const&,
                                        Frame const& first);

/// Everything that decides how a run goes on, in global order; doubles bit for bit.
struct Checkpoint {
    std::int64_t step = 0;
    double time = 0;
    std::string scene_hash;
    std::map<std::string, std::string> notes;  // e.g. tree table version, backend, catena version
    std::map<std::string, std::int64_t> integers;  // e.g. fixed number of projection sweeps
    std::map<std::string, std::vector<double>> arrays;
};
/// Writes to a temporary name, fsyncs, reopens and verifies a checksum, then renames; the
/// checkpoint before is kept as
/// `<name>.previous.h5`. Large arrays are written and verified by all ranks together where that can
/// be (CATENA_HDF5), else by rank 0.
class CheckpointWriter {
  public:
    /// Writes all but the arrays `later`, of so many numbers. The checkpoint is rank 0's.
    /// Collective.
    CheckpointWriter(Communicator const&, std::string const& file, Checkpoint const&,
                     std::map<std::string, std::int64_t> const& later);
    /// Not finished, it leaves the checkpoint before and nothing else.
    ~CheckpointWriter();
    ParallelIoMode const& way() const;
    /// Of one of `later`, parts in ascending order: of every rank its own, at the same time, where
    /// the way is collective; else by rank 0 alone, which keeps what fails there for finish().
    void put(std::string const& array, std::span<ArrayPart const> parts);
    /// Collective.
    void finish();

  private:
    struct Draft;
    std::unique_ptr<Draft> draft_;
};
/// All of it at once.
void write_checkpoint(std::string const& file, Checkpoint const&);
/// InputError for a file that is missing, not a checkpoint, cut short or altered (checksum).
Checkpoint read_checkpoint(std::string const& file);

/// observables.csv: a header of names with units, then one line a record, %.17g.
class ObservablesWriter {
  public:
    /// Column names as in "total_energy [kJ/mol]". With `go_on`, keeps the lines of an existing
    /// file up to that step and appends. The first two columns, "step" and "time [<time_unit>]",
    /// are the writer's own. InputError for a file that is missing, of other columns or of fewer
    /// lines than `go_on` says.
    ObservablesWriter(std::string const& file, std::vector<std::string> const& columns,
                      std::optional<Continuation> const& go_on,
                      std::string const& time_unit = "ps");
    ~ObservablesWriter();
    void write(std::int64_t step, double time, std::vector<double> const& values);
    void flush();
    void close();

  private:
    struct File;
    std::unique_ptr<File> file_;
};

/// report.html: one self-contained page (no network): title, the summary as tables, a line chart
/// (inline SVG) for each observable against time, a bar picture of the timeline of one step. Reads
/// observables.csv, summary.json and timeline.json in `folder`.
void write_run_report(std::string const& folder);

/// Writes text to a temporary name beside `file`, fsyncs and renames.
void write_text_file(std::string const& file, std::string const& text);

/// Progress of long work on a terminal or log: rate and time left. Silent when `quiet`; on a
/// terminal one line that is redrawn, else a line now and then.
class Progress {
  public:
    /// `time_step` in ps gives the rate in ns/day (left out for `si`).
    Progress(bool quiet, std::int64_t first_step, std::int64_t last_step, double time_step, bool si,
             std::FILE* out = stderr);
    void update(std::int64_t step);
    void finish();
    /// Steps a second since the start.
    double rate() const;
    /// As it is shown, without the bar.
    std::string line(bool last) const;

  private:
    void show(bool last) const;
    bool quiet_, si_, terminal_;
    std::FILE* out_;
    std::int64_t first_, last_, now_;
    double time_step_, start_, last_shown_, interval_;
};

std::string hdf5_version();  // "HDF5 1.10.8" or "none"
/// For programs, before they initialise MPI: an HDF5 that starts later closes its files once more
/// when MPI ends, and crashes on those that a full disk kept open.
void start_hdf5();

}  // namespace catena
