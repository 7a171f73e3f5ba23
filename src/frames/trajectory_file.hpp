// Reader of a run's trajectory.h5md, one frame at a time. Layout: io/trajectory_layout.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/output.hpp"

namespace catena {

/// Positions of one frame.
struct Snapshot {
    std::vector<Vec3> position;  // per site, unwrapped, nm (m with `units: si`)
    std::optional<Vec3> box;     // edges of the periodic box, same unit
};

/// Order of the sites that a reader hands out.
enum class SiteOrder {
    /// Sites have the order of the file.
    stored,
    /// Members of complexes are chains of their own, see by_members().
    members
};

/// Open trajectory of a run. Every member throws InputError naming the file if it is damaged.
class TrajectoryFile {
  public:
    /// Opens `place`, the folder of a run or an H5MD file that Catena wrote. Residue names come
    /// from topology.pdb beside it. Throws InputError if there is no such file, if another program
    /// wrote it, if it has no frames, and in a build without HDF5.
    explicit TrajectoryFile(std::string const& place, SiteOrder order = SiteOrder::stored);
    ~TrajectoryFile();
    TrajectoryFile(TrajectoryFile const&) = delete;
    TrajectoryFile& operator=(TrajectoryFile const&) = delete;

    /// Chains, their members, masses, residues, title and units. `box` is that of the first frame;
    /// the lists of bodies and tips stay empty.
    Topology const& topology() const { return topology_; }
    /// True if topology.pdb gave the residue names. They are "UNK" otherwise.
    bool has_residues() const { return has_residues_; }
    /// Step and time of every frame, time in ps (s with `units: si`).
    std::vector<std::int64_t> const& steps() const { return steps_; }
    std::vector<double> const& times() const { return times_; }
    std::string const& name() const { return name_; }
    /// True if members of complexes are chains of their own, named COMPLEX:MEMBER.
    bool is_by_members() const { return !site_.empty(); }
    /// Reads a frame into `snapshot`, whose memory is reused. Throws InputError for positions that
    /// are not finite.
    void read(std::size_t frame, Snapshot& snapshot) const;

  private:
    struct Series;
    void open();
    void read_chains();
    void read_members();
    void read_branches();
    void read_crosslinks();
    void read_residues();

    std::string name_;
    Topology topology_;
    bool has_residues_ = false;
    std::vector<std::int64_t> steps_;
    std::vector<double> times_;
    /// Index in the file of each site; empty for the file's order.
    std::vector<std::size_t> site_;
    std::unique_ptr<Series> series_;
};

}  // namespace catena
