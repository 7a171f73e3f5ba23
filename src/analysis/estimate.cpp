// Implements means over frames and copies.
#include "analysis/estimate.hpp"

#include <algorithm>

namespace catena::analysis {
namespace {

constexpr std::int64_t most_blocks = 256;
constexpr std::int64_t last_dense_number = 128;  // consecutive numbers up to this one
constexpr double numbers_per_doubling = 16;
constexpr double rounding = 1e-13;

/// Returns the mean of a series over all copies, with the error by blocking. An error of the size
/// of roundings is none.
Blocked blocked(std::vector<double> const& series) {
    Blocked found = blocked_mean({series});
    if (found.error <= rounding * std::abs(found.mean)) {
        found.error = 0;
        found.plateau = true;
    }
    return found;
}

}  // namespace

double error_between(std::span<double const> values) {
    auto const count = static_cast<double>(values.size());
    if (values.size() < 2) return NAN;
    double mean = 0, squares = 0;
    for (double const value : values) mean += value / count;
    for (double const value : values) squares += (value - mean) * (value - mean);
    return std::sqrt(squares / (count * (count - 1)));
}

void count_replicas(Estimate& of, std::size_t replicas) {
    std::size_t constexpr many = 16;
    if (replicas < 2 || std::isnan(of.between)) return;
    of.error = std::isnan(of.error) ? of.between : std::max(of.error, of.between);
    of.plateau = of.plateau || replicas >= many;
}

Estimate CopyValues::estimate() const {
    std::size_t const frames = values_.size() / copies_;
    std::vector<double> of_frame(frames, 0.0), of_copy(copies_ / together_, 0.0);
    for (std::size_t f = 0; f < frames; ++f)
        for (std::size_t c = 0; c < copies_; ++c) {
            double const value = values_[f * copies_ + c];
            of_frame[f] += value / static_cast<double>(copies_);
            of_copy[c / together_] += value / static_cast<double>(frames * together_);
        }
    Blocked const found = blocked(of_frame);
    return {found.mean, found.error, found.plateau, error_between(of_copy)};
}

BlockMeans::BlockMeans(std::size_t width, std::int64_t frames)
    : width_(width), length_(std::max<std::int64_t>(1, (frames + most_blocks - 1) / most_blocks)) {}

std::span<double> BlockMeans::row() {
    auto const block = static_cast<std::size_t>(frames_ / length_);
    if (sums_.size() <= block * width_) sums_.resize((block + 1) * width_, 0.0);
    return std::span(sums_).subspan(block * width_, width_);
}

void BlockMeans::end_frame() {
    row();
    ++frames_;
}

std::vector<double> BlockMeans::means() const {
    std::vector<double> means(width_, 0.0);
    for (std::size_t k = 0; k < sums_.size(); ++k)
        means[k % width_] += sums_[k] / static_cast<double>(frames_);
    return means;
}

std::vector<double> BlockMeans::series(std::span<double const> weights) const {
    std::vector<double> values(static_cast<std::size_t>(frames_ / length_), 0.0);
    for (std::size_t block = 0; block < values.size(); ++block)
        for (std::size_t k = 0; k < width_; ++k)
            values[block] += weights[k] * sums_[block * width_ + k] / static_cast<double>(length_);
    return values;
}

std::vector<double> BlockMeans::series(std::size_t number) const {
    std::vector<double> values(static_cast<std::size_t>(frames_ / length_));
    for (std::size_t block = 0; block < values.size(); ++block)
        values[block] = sums_[block * width_ + number] / static_cast<double>(length_);
    return values;
}

Blocked BlockMeans::error_of(std::span<double const> weights) const {
    return blocked_mean({series(weights)});
}

CurveMeans::CurveMeans(std::size_t width, std::size_t copies, std::int64_t frames,
                       std::size_t together)
    : blocks_(width, frames),
      copies_(copies),
      together_(together),
      copy_sums_(width * (copies / together), 0.0) {}

void CurveMeans::add(std::size_t copy, std::span<double const> curve) {
    std::span<double> const row = blocks_.row();
    double* const own = copy_sums_.data() + copy / together_ * row.size();
    for (std::size_t k = 0; k < row.size(); ++k) {
        row[k] += curve[k] / static_cast<double>(copies_);
        own[k] += curve[k] / static_cast<double>(together_);
    }
}

void CurveMeans::end_frame() {
    blocks_.end_frame();
    ++frames_;
}

std::vector<double> CurveMeans::of_copy(std::size_t copy) const {
    std::size_t const width = blocks_.width();
    std::vector<double> means(copy_sums_.begin() + static_cast<std::ptrdiff_t>(copy * width),
                              copy_sums_.begin() + static_cast<std::ptrdiff_t>((copy + 1) * width));
    for (double& mean : means) mean /= static_cast<double>(frames_);
    return means;
}

Estimate CurveMeans::at(std::size_t point) const {
    std::vector<double> of_copy(copies());
    double mean = 0;
    for (std::size_t c = 0; c < copies(); ++c) {
        of_copy[c] = copy_sums_[c * blocks_.width() + point] / static_cast<double>(frames_);
        mean += of_copy[c] / static_cast<double>(copies());
    }
    Blocked const found = blocked(blocks_.series(point));
    return {mean, found.error, found.plateau, error_between(of_copy)};
}

std::vector<std::int64_t> spaced_numbers(std::int64_t most) {
    std::vector<std::int64_t> numbers;
    for (std::int64_t n = 1; n <= std::min(most, last_dense_number); ++n) numbers.push_back(n);
    double const factor = std::exp2(1 / numbers_per_doubling);
    for (double next = static_cast<double>(last_dense_number) * factor;; next *= factor) {
        std::int64_t const n = std::llround(next);
        if (n > most) return numbers;
        numbers.push_back(n);
    }
}

}  // namespace catena::analysis
