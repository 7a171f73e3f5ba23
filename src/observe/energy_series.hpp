// Energies of a run's frames, as its verdict needs them, in bounded memory and kept in checkpoints.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace catena {

/// A series of at most `most` entries. Each is one frame; of a longer run it is the mean of 2, 4,
/// 8, ... frames one after the other.
class EnergySeries {
  public:
    static constexpr std::size_t most = 4096;
    /// The energies of a frame. A step that is not later than the last one is left out: a restart
    /// writes its checkpoint's frame again.
    void add(std::int64_t step, double kinetic, std::optional<double> potential);

    std::size_t size() const { return entries_.size(); }
    std::int64_t first_step(std::size_t entry) const { return entries_[entry].first; }
    std::int64_t last_step() const { return entries_.back().last; }
    /// The middle of the steps of an entry.
    double middle(std::size_t entry) const;
    double kinetic(std::size_t entry) const;
    /// Kinetic and potential energy. Precondition: has_potential().
    double total(std::size_t entry) const;
    /// Whether every frame told its potential energy.
    bool has_potential() const { return has_potential_; }
    /// Of the first frame alone; the largest of all frames, of total energies without their signs.
    double first_total() const { return first_total_; }
    double largest_kinetic() const { return largest_kinetic_; }
    double largest_total() const { return largest_total_; }

    /// All of it, for a checkpoint.
    std::vector<double> state() const;
    /// Takes what state() gave. Returns false, and takes nothing, where no run of so many steps can
    /// have given that.
    bool set_state(std::vector<double> const& state, std::int64_t steps);

  private:
    /// Sums over the frames of an entry.
    struct Entry {
        std::int64_t first = 0, last = 0, frames = 0;
        double kinetic = 0, total = 0;
    };
    void halve();
    bool is_possible(std::int64_t steps) const;
    std::vector<Entry> entries_;  // all but the last of `frames_of_entry_` frames
    std::int64_t frames_of_entry_ = 1;
    bool has_potential_ = true;
    double first_total_ = 0, largest_kinetic_ = 0, largest_total_ = 0;
};

}  // namespace catena
