// Implements the bounded series of energies.
#include "observe/energy_series.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace catena {
namespace {

constexpr std::size_t numbers_before = 5,
                      numbers_of_entry = 5;  // numbers of a state before its entries, and per entry
/// Bound on frames per entry: more than any run has.
constexpr double most_frames = 1e15;

/// Returns the larger number. A NaN is kept, so that values that are not finite show.
double larger_of(double a, double b) { return std::isnan(a) || a > b ? a : b; }

/// True for an integer from 0 to `most_frames`.
bool is_count(double value) {
    return value >= 0 && value <= most_frames && value == std::floor(value);
}

}  // namespace

void EnergySeries::add(std::int64_t step, double kinetic, std::optional<double> potential) {
    if (!entries_.empty() && step <= last_step()) return;
    has_potential_ = has_potential_ && potential.has_value();
    double const total = kinetic + potential.value_or(0);
    if (entries_.empty()) first_total_ = total;
    largest_kinetic_ = larger_of(kinetic, largest_kinetic_);
    largest_total_ = larger_of(std::abs(total), largest_total_);
    if (entries_.empty() || entries_.back().frames == frames_of_entry_) {
        if (entries_.size() == most) halve();
        entries_.push_back({step, step, 0, 0, 0});
    }
    Entry& entry = entries_.back();
    entry.last = step;
    ++entry.frames;
    entry.kinetic += kinetic;
    entry.total += total;
}

void EnergySeries::halve() {
    for (std::size_t i = 0; i < most / 2; ++i) {
        Entry const &a = entries_[2 * i], &b = entries_[2 * i + 1];
        entries_[i] = {a.first, b.last, a.frames + b.frames, a.kinetic + b.kinetic,
                       a.total + b.total};
    }
    entries_.resize(most / 2);
    frames_of_entry_ *= 2;
}

double EnergySeries::middle(std::size_t entry) const {
    return 0.5 *
           (static_cast<double>(entries_[entry].first) + static_cast<double>(entries_[entry].last));
}

double EnergySeries::kinetic(std::size_t entry) const {
    return entries_[entry].kinetic / static_cast<double>(entries_[entry].frames);
}

double EnergySeries::total(std::size_t entry) const {
    return entries_[entry].total / static_cast<double>(entries_[entry].frames);
}

std::vector<double> EnergySeries::state() const {
    std::vector<double> numbers{static_cast<double>(frames_of_entry_), has_potential_ ? 1.0 : 0.0,
                                first_total_, largest_kinetic_, largest_total_};
    for (Entry const& e : entries_)
        numbers.insert(numbers.end(), {static_cast<double>(e.first), static_cast<double>(e.last),
                                       static_cast<double>(e.frames), e.kinetic, e.total});
    return numbers;
}

bool EnergySeries::set_state(std::vector<double> const& state, std::int64_t steps) {
    if (state.size() < numbers_before || (state.size() - numbers_before) % numbers_of_entry != 0)
        return false;
    EnergySeries read;
    if (!is_count(state[0])) return false;
    read.frames_of_entry_ = static_cast<std::int64_t>(state[0]);
    read.has_potential_ = state[1] != 0;
    read.first_total_ = state[2], read.largest_kinetic_ = state[3], read.largest_total_ = state[4];
    for (std::size_t i = numbers_before; i < state.size(); i += numbers_of_entry) {
        if (!is_count(state[i]) || !is_count(state[i + 1]) || !is_count(state[i + 2])) return false;
        read.entries_.push_back(
            {static_cast<std::int64_t>(state[i]), static_cast<std::int64_t>(state[i + 1]),
             static_cast<std::int64_t>(state[i + 2]), state[i + 3], state[i + 4]});
    }
    if (!read.is_possible(steps)) return false;
    *this = std::move(read);
    return true;
}

bool EnergySeries::is_possible(std::int64_t steps) const {
    if (entries_.size() > most || frames_of_entry_ < 1 ||
        (!entries_.empty() && last_step() > steps))
        return false;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        Entry const& e = entries_[i];
        bool const is_last = i + 1 == entries_.size();
        if (e.last < e.first || e.frames < 1 ||
            (is_last ? e.frames > frames_of_entry_ : e.frames != frames_of_entry_))
            return false;
        if (i > 0 && e.first <= entries_[i - 1].last) return false;
    }
    return true;
}

}  // namespace catena
