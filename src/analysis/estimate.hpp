// Means over frames and copies with their standard errors.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "math/blocking.hpp"

namespace catena::analysis {

/// A mean over frames and copies of a chain, with two standard errors.
struct Estimate {
    double mean = NAN;
    /// Error by blocking of the mean over all copies as one time series. It assumes nothing about
    /// copies, which may interact. With replicas it is at least `between`. NaN if there are too few
    /// frames.
    double error = NAN;
    /// False if longer blocks than the series allows might give a larger error.
    bool plateau = false;
    /// Scatter of the copies' own means, or those of replicas, divided by the root of their number.
    /// It assumes that copies are independent, and nothing about time. NaN for a single copy.
    double between = NAN;
};

/// Makes the error of a quantity of `replicas` replicas at least that between them. From 16
/// replicas on it does not grow with longer blocks.
void count_replicas(Estimate&, std::size_t replicas);

/// Returns the scatter of independent values divided by the root of their number; NaN for fewer
/// than two.
double error_between(std::span<double const> values);

/// Values of a scalar quantity in all frames, for all copies of a chain.
class CopyValues {
  public:
    /// `together`: number of consecutive copies that are not independent (Kind::together()).
    explicit CopyValues(std::size_t copies = 1, std::size_t together = 1)
        : copies_(copies), together_(together) {}
    /// Appends the value of the next copy; copies follow one another, then frames.
    void add(double value) { values_.push_back(value); }
    std::size_t copies() const { return copies_; }
    /// All values, [frame][copy].
    std::vector<double> const& values() const { return values_; }
    Estimate estimate() const;

  private:
    std::size_t copies_, together_;
    std::vector<double> values_;
};

/// Means over frames of a row of numbers, by blocks of consecutive frames. It holds 256 rows at
/// most, whatever the number of frames.
class BlockMeans {
  public:
    /// Prepares for `frames` frames of rows of `width` numbers.
    BlockMeans(std::size_t width, std::int64_t frames);
    /// Sums of the current block, to which the values of the current frame are added.
    std::span<double> row();
    void end_frame();

    std::size_t width() const { return width_; }
    /// Means over all frames.
    std::vector<double> means() const;
    /// Weighted sums of the numbers, a value per whole block. The frames after the last whole block
    /// are left out.
    std::vector<double> series(std::span<double const> weights) const;
    /// Block means of a single number.
    std::vector<double> series(std::size_t number) const;
    /// Standard error by blocking of a weighted sum of the means. To first order this is the error
    /// of any function whose derivatives are the weights.
    Blocked error_of(std::span<double const> weights) const;

  private:
    std::size_t width_;
    std::int64_t length_, frames_ = 0;  // frames in a block; frames so far
    std::vector<double> sums_;          // [block][number]
};

/// A curve of every copy of a chain: block means over all copies, and means over all frames of each
/// copy.
class CurveMeans {
  public:
    /// `together`: number of consecutive copies that are not independent (Kind::together()).
    CurveMeans(std::size_t width, std::size_t copies, std::int64_t frames,
               std::size_t together = 1);
    /// Adds the curve of one copy in the current frame.
    void add(std::size_t copy, std::span<double const> curve);
    void end_frame();

    BlockMeans const& blocks() const { return blocks_; }
    /// Number of independent copies, or of groups of copies that are.
    std::size_t copies() const { return copies_ / together_; }
    /// Mean curve of one of them.
    std::vector<double> of_copy(std::size_t copy) const;
    /// Estimate at one point of the curve.
    Estimate at(std::size_t point) const;

  private:
    BlockMeans blocks_;
    std::size_t copies_, together_;
    std::int64_t frames_ = 0;
    std::vector<double> copy_sums_;  // [copy or group of copies][point]
};

/// Returns the numbers 1 to 128 and then about 16 per doubling, none above `most`.
std::vector<std::int64_t> spaced_numbers(std::int64_t most);

}  // namespace catena::analysis
