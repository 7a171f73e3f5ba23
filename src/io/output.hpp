// Output files of a run. Rank 0 writes them and receives the data of bodies in parts from the other
// ranks. Trajectories and checkpoints can also be written by all ranks together. Every writer
// checks each write, flush and close. A failure, a full disk included, throws ComputationError
// naming file and cause. Unusable existing files throw InputError.
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
#include "io/members.hpp"
#include "io/parallel_io_mode.hpp"
#include "math/executor.hpp"
#include "math/linear.hpp"
#include "math/rotation.hpp"

namespace catena {

/// Sites of a trajectory: a bead, a bead that a body carries, or the centre of mass of a body
/// without beads. Chains follow one another.
struct Topology {
    struct Chain {
        std::string name;
        std::int64_t first = 0, count = 0;  // sites [first, first + count)
        bool beads = true;                  // every site is a bead
        bool ring = false;
        std::int64_t replica = 0;  // chains of different replicas do not interact
        /// Site on which each site hangs, counted from 0 within the chain, -1 for the first; empty
        /// for an unbranched chain.
        std::vector<std::int64_t> parent = {};
        /// Ends of cross-links, counted from 0 within the chain.
        std::vector<std::array<std::int64_t, 2>> crosslinks = {};
    };
    std::string title;
    std::vector<Chain> chains;
    std::vector<std::string> residue;  // three-letter name of each site; bodies: "BDY"
    std::vector<double> mass;          // site masses, amu (kg if si)
    std::vector<std::int64_t> bodies;  // site of each rigid body, or the first of its beads
    std::vector<std::int64_t> tips;  // indices of chains whose last body has a joint to the ground
    bool body_states =
        false;  // the trajectory holds position, velocity and angular velocity of `bodies`
    bool joint_states = false;  // the trajectory holds their joint coordinates and rates
    std::optional<Vec3> box;    // edges of the periodic box, nm
    bool si = false;            // SI units: m, s, kg, N in place of nm, ps, amu, kJ/mol/nm
    /// Members of the chains, in sites; those of some chains, or of all chains, may be absent.
    Members members = {};
};

/// Frame of all sites, or a part of it with consecutive sites and bodies. Units are nm and ps, or m
/// and s with `units: si`.
struct Frame {
    std::int64_t step = 0;
    double time = 0;
    std::size_t first_site = 0,
                first_body = 0;   // indices of the part's first site and first body in the topology
    std::vector<Vec3> positions;  // per site, W, unwrapped
    std::vector<Vec3> velocities;    // per site, W; empty: not written
    std::vector<Quat> orientations;  // per body of the topology, body axes to W
    std::vector<Vec3> body_positions,
        body_velocities,                                 // centres of mass, W; empty: not written
        angular_velocities;                              // body axes; empty: not written
    std::vector<std::array<double, 4>> joint_positions;  // BodyArrays::q; empty: not written
    std::vector<Vec3> joint_rates;                       // BodyArrays::qd; empty: not written
    std::vector<Vector<double, 6>>
        joint_forces,  // [torque, force] at the inboard joint, W: for the first site of each body,
                       // else 0; empty: not written
        tip_forces;  // [torque, force] at the joint to the ground of each chain in Topology::tips,
                     // on the last body
};

/// Step from which a run continues in existing files.
struct Continuation {
    /// Advice in error messages about files that cannot be continued.
    static constexpr char const* way_beside =
        "continue in another folder: --restart CHECKPOINT --output OTHER";

    Continuation(std::int64_t step, std::int64_t least = 0)
        : after_step(step), records(least) {}  // NOLINT(google-explicit-constructor)
    std::int64_t after_step;                   // later frames and lines are removed
    std::int64_t records;  // smallest valid number of frames or lines up to that step
};

/// Writer of an H5MD 1.1 file for MDAnalysis and other programs.
class TrajectoryWriter {
  public:
    virtual ~TrajectoryWriter() = default;
    /// Begins a frame. Its parts follow one another, from the first site to the last. If all ranks
    /// write together, every call is collective. Each rank then puts its own sites in their order,
    /// any number of parts at a time. Tip forces count on rank 0 only.
    virtual void begin(std::int64_t step, double time) = 0;
    /// Writes parts of the current frame. Throws ComputationError if their arrays do not fit the
    /// topology.
    virtual void put(std::span<Frame const> parts) = 0;
    void put(Frame const& part) { put(std::span(&part, 1)); }
    /// Ends the frame. Throws ComputationError if sites or bodies are missing.
    virtual void end(std::vector<Vector<double, 6>> const& tip_forces) = 0;
    void write(Frame const& whole) {
        begin(whole.step, whole.time);
        put(whole);
        end(whole.tip_forces);
    }
    /// Number of frames in the file.
    virtual std::int64_t frames() const = 0;
    /// Writes all frames so far to disk before it returns.
    virtual void flush() = 0;
    virtual void close() = 0;
};
/// Creates `file`; with `go_on`, opens an existing one and removes the frames after that step.
/// Throws InputError in a build without HDF5.
std::unique_ptr<TrajectoryWriter> make_trajectory(std::string const& file, Topology const&,
                                                  bool velocities, bool joint_forces,
                                                  std::optional<Continuation> const& go_on);
/// Trajectory writer of all ranks. All ranks write if the file permits it (CATENA_HDF5). Otherwise
/// rank 0 writes, and the writer is null on the other ranks.
struct TrajectoryOfRanks {
    std::unique_ptr<TrajectoryWriter> writer;
    ParallelIoMode way;
};
/// Creates or opens the trajectory of all ranks for rank 0's topology. Collective.
TrajectoryOfRanks make_trajectory(Communicator const&, std::string const& file, Topology const&,
                                  bool velocities, bool joint_forces,
                                  std::optional<Continuation> const& go_on);

/// Writer of topology.pdb, and of topology.psf with masses and bonds. Above 99,999 sites
/// topology.cif (mmCIF) replaces topology.psf.
class TopologyWriter {
  public:
    /// Creates temporary files in `folder`, which finish() renames.
    TopologyWriter(std::string const& folder, Topology const&);
    ~TopologyWriter();
    /// Appends the positions of the next sites in W. The executor's threads format their lines.
    void put(std::vector<Vec3> const& positions, Executor const&);
    /// Completes the files and returns their paths.
    std::vector<std::string> finish();

  private:
    struct Files;
    std::unique_ptr<Files> files_;
};
/// Writes the topology of one rank in a single call and returns the paths.
std::vector<std::string> write_topology(std::string const& folder, Topology const&,
                                        Frame const& first);

/// Everything that determines how a run continues, in global order. Doubles are kept bit for bit.
struct Checkpoint {
    std::int64_t step = 0;
    double time = 0;  // ps (s with `units: si`)
    std::string scene_hash;
    std::map<std::string, std::string> notes;      // e.g. version of the tree table, integrator
    std::map<std::string, std::int64_t> integers;  // e.g. fixed number of projection sweeps
    std::map<std::string, std::vector<double>> arrays;  // state of bodies and integrator, by name
};
/// Writer of a checkpoint. It writes under a temporary name, syncs, reopens the file, verifies a
/// checksum and renames the file. The preceding checkpoint is kept as `<name>.previous.h5`. Large
/// arrays are written and verified by all ranks together if the file permits it (CATENA_HDF5), else
/// by rank 0.
class CheckpointWriter {
  public:
    /// Writes everything except the elements of the arrays `later` (sizes by name). Rank 0's
    /// checkpoint is the one written. Collective.
    CheckpointWriter(Communicator const&, std::string const& file, Checkpoint const&,
                     std::map<std::string, std::int64_t> const& later);
    /// Removes the temporary file unless finish() has succeeded. The preceding checkpoint remains.
    ~CheckpointWriter();
    /// Mode chosen by the constructor: all ranks or the root.
    ParallelIoMode const& way() const;
    /// Writes parts of one of the arrays `later`, in ascending order. In collective mode every rank
    /// calls it at the same time with its own parts. Otherwise rank 0 alone calls it, and finish()
    /// throws the failures.
    void put(std::string const& array, std::span<ArrayPart const> parts);
    /// Completes, seals, verifies and renames the file. Collective.
    void finish();

  private:
    struct Draft;
    std::unique_ptr<Draft> draft_;
};
/// Writes a whole checkpoint from a single rank.
void write_checkpoint(std::string const& file, Checkpoint const&);
/// Reads a checkpoint. Throws InputError if the file is missing, no checkpoint, truncated or
/// altered (checksum).
Checkpoint read_checkpoint(std::string const& file);

/// Writer of observables.csv: a header of names with units, then one line per record in %.17g.
class ObservablesWriter {
  public:
    /// Creates the table. Column names have the form "total_energy [kJ/mol]". The writer itself
    /// adds the first two columns, "step" and "time [<time_unit>]". With `go_on`, the lines of an
    /// existing file up to that step are kept and new lines appended. Throws InputError if that
    /// file is missing, has other columns, or has fewer lines than `go_on` requires.
    ObservablesWriter(std::string const& file, std::vector<std::string> const& columns,
                      std::optional<Continuation> const& go_on,
                      std::string const& time_unit = "ps");
    ~ObservablesWriter();
    /// Appends a line. Throws ComputationError if `values` does not fit the columns.
    void write(std::int64_t step, double time, std::vector<double> const& values);
    /// Syncs the file to disk.
    void flush();
    void close();

  private:
    struct File;
    std::unique_ptr<File> file_;
};

/// Writes report.html, a single page that needs no network. It shows the title, the summary as
/// tables, a line chart (inline SVG) of each observable against time, and the timeline of one step.
/// It reads observables.csv, summary.json and timeline.json in `folder`.
void write_run_report(std::string const& folder);

/// Writes text to a temporary file in the same folder, syncs it and renames it to `file`. Devices,
/// pipes and links are written directly.
void write_text_file(std::string const& file, std::string const& text);

/// Progress of long work on a terminal or in a log: rate and time left. A terminal shows one line
/// that is redrawn; a log receives lines at intervals of 1 s, doubled up to 30 s. Nothing is
/// printed if `quiet`.
class Progress {
  public:
    /// `time_step` in ps determines the rate in ns/day, which is omitted for `si`.
    Progress(bool quiet, std::int64_t first_step, std::int64_t last_step, double time_step, bool si,
             std::FILE* out = stderr);
    /// Records the step and prints if the interval has elapsed.
    void update(std::int64_t step);
    /// Prints the last line, with the total time.
    void finish();
    /// Steps per second since the start.
    double rate() const;
    /// Line as printed, but without the bar. `last`: total time instead of time left.
    std::string line(bool last) const;

  private:
    void show(bool last) const;
    bool quiet_, si_, terminal_;
    std::FILE* out_;
    std::int64_t first_, last_, now_;
    double time_step_, start_, last_shown_, interval_;
};

std::string hdf5_version();  // "HDF5 1.10.8" or "none"
/// Initialises HDF5. Programs call it before they initialise MPI: an HDF5 that starts later closes
/// its files again when MPI ends. It then crashes on files that a full disk kept open.
void start_hdf5();

}  // namespace catena
