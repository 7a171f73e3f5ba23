// Energies of a run's frames for its verdict, in bounded memory and kept in checkpoints.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace catena {

/// Series of at most `most` entries. An entry is one frame; in longer runs it is the mean of 2, 4,
/// 8, ... consecutive frames. Energies are in kJ/mol (J with `units: si`).
class EnergySeries {
  public:
    static constexpr std::size_t most = 4096;
    /// Adds the energies of a frame. A step that is not later than the last one is ignored: a
    /// restart writes its checkpoint's frame again.
    void add(std::int64_t step, double kinetic, std::optional<double> potential);

    std::size_t size() const { return entries_.size(); }
    std::int64_t first_step(std::size_t entry) const { return entries_[entry].first; }
    std::int64_t last_step() const { return entries_.back().last; }
    /// Returns the middle of the steps of an entry.
    double middle(std::size_t entry) const;
    /// Returns the mean kinetic energy of an entry.
    double kinetic(std::size_t entry) const;
    /// Returns the mean of kinetic plus potential energy of an entry. Precondition:
    /// has_potential().
    double total(std::size_t entry) const;
    /// True if every frame had a potential energy.
    bool has_potential() const { return has_potential_; }
    /// Returns the total energy of the first frame.
    double first_total() const { return first_total_; }
    /// Returns the largest kinetic energy of all frames.
    double largest_kinetic() const { return largest_kinetic_; }
    /// Returns the largest magnitude of the total energy of all frames.
    double largest_total() const { return largest_total_; }

    /// Returns the whole series as numbers for a checkpoint.
    std::vector<double> state() const;
    /// Restores what state() returned. Returns false, and changes nothing, if no run of `steps`
    /// steps can have returned that.
    bool set_state(std::vector<double> const& state, std::int64_t steps);

  private:
    /// Sums over the frames of an entry.
    struct Entry {
        std::int64_t first = 0, last = 0, frames = 0;
        double kinetic = 0, total = 0;
    };
    /// Replaces pairs of entries by their means.
    void halve();
    /// True if a run of `steps` steps can have produced this series.
    bool is_possible(std::int64_t steps) const;
    std::vector<Entry> entries_;  // all except the last one hold `frames_of_entry_` frames
    std::int64_t frames_of_entry_ = 1;
    bool has_potential_ = true;
    double first_total_ = 0, largest_kinetic_ = 0, largest_total_ = 0;
};

}  // namespace catena
