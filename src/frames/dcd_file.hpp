// Reader of DCD trajectories of CHARMM, NAMD, OpenMM and Catena, one frame at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "frames/trajectory_file.hpp"

namespace catena {

/// Open DCD file. Every member throws InputError naming the file if it is damaged.
class DcdFile {
  public:
    /// Reads the head of the file. Throws InputError for files of other byte order, with fixed
    /// atoms or with velocities.
    explicit DcdFile(std::string const& file);

    std::size_t sites() const { return sites_; }
    /// Returns the number of whole frames in the file, whatever its head says.
    std::size_t frames() const { return frames_; }
    std::string const& name() const { return name_; }
    /// Reads a frame: positions in nm as the file has them, which may be wrapped, and the edges of
    /// the box if the file has any. Throws InputError for boxes that are not rectangular.
    Snapshot read(std::size_t frame) const;

  private:
    /// Reads `count` bytes from `offset` on.
    std::string bytes(std::uint64_t offset, std::uint64_t count) const;
    /// Reads the record at `offset` and moves `offset` to its end.
    std::string record(std::uint64_t& offset) const;
    [[noreturn]] void damaged(std::string const& how) const;
    std::optional<Vec3> edges_in(std::string const& cell) const;

    std::string name_;
    std::uint64_t size_ = 0, first_frame_ = 0, frame_size_ = 0;  // bytes
    std::size_t sites_ = 0, frames_ = 0;
    bool has_cell_ = false;
};

}  // namespace catena
