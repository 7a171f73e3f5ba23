// Collectives of Communicator for values, vectors and texts in place of bytes. Types are trivially
// copyable; ranks must be of one architecture. All functions are collective.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <numeric>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "mpi/communicator.hpp"

namespace catena {

/// A type whose values ranks can exchange as bytes: no pointers and no views.
template <class T>
concept Message =
    std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !std::ranges::borrowed_range<T>;

/// A vector, array or span of such values.
template <class Range>
concept Messages =
    std::ranges::contiguous_range<Range> && Message<std::ranges::range_value_t<Range>>;

/// Type of the values of a range.
template <Messages Range>
using ValueOf = std::ranges::range_value_t<Range>;

/// Returns the values as a span.
template <Messages Range>
auto span_of(Range&& values) {
    return std::span(std::ranges::data(values), std::ranges::size(values));
}
/// Returns the lengths in bytes of blocks of `counts` values.
template <Message T>
std::vector<std::int64_t> bytes_of_counts(std::vector<std::int64_t> counts) {
    for (std::int64_t& count : counts) count *= static_cast<std::int64_t>(sizeof(T));
    return counts;
}

/// Gathers counts[r] values of every rank r, in rank order, on every rank. All ranks know `counts`.
template <Messages Range>
std::vector<ValueOf<Range>> all_gathered(Communicator const& communicator, Range const& own,
                                         std::vector<std::int64_t> const& counts) {
    std::vector<ValueOf<Range>> all(
        static_cast<std::size_t>(std::accumulate(counts.begin(), counts.end(), std::int64_t{0})));
    communicator.all_gather(std::as_bytes(span_of(own)), std::as_writable_bytes(span_of(all)),
                            bytes_of_counts<ValueOf<Range>>(counts));
    return all;
}
/// Gathers the same number of values of every rank, in rank order, on every rank.
template <Messages Range>
std::vector<ValueOf<Range>> all_gathered_alike(Communicator const& communicator, Range const& own) {
    return all_gathered(communicator, own,
                        std::vector<std::int64_t>(static_cast<std::size_t>(communicator.size()),
                                                  std::ssize(span_of(own))));
}
/// Returns one value of every rank, in rank order, on every rank.
template <Message T>
std::vector<T> all_gathered(Communicator const& communicator, T const& own) {
    return all_gathered_alike(communicator, std::span(&own, 1));
}
/// Gathers counts[r] values of every rank r, in rank order, on rank 0; returns none elsewhere. All
/// ranks know `counts`.
template <Messages Range>
std::vector<ValueOf<Range>> gathered(Communicator const& communicator, Range const& own,
                                     std::vector<std::int64_t> const& counts) {
    bool const here = communicator.rank() == 0;
    std::vector<ValueOf<Range>> all(static_cast<std::size_t>(
        here ? std::accumulate(counts.begin(), counts.end(), std::int64_t{0}) : 0));
    communicator.gather(std::as_bytes(span_of(own)), std::as_writable_bytes(span_of(all)),
                        bytes_of_counts<ValueOf<Range>>(counts));
    return all;
}

/// Values of all ranks, one rank's after the other's, and how many each has.
template <Message T>
struct RankBlocks {
    std::vector<T> values;
    std::vector<std::int64_t> counts;

    /// Calls action(span of the values of a rank) for every rank, in rank order. Precondition: this
    /// rank has the values.
    template <class Action>
    void each(Action const& action) const {
        std::size_t begin = 0;
        for (std::int64_t const count : counts) {
            action(std::span(values).subspan(begin, static_cast<std::size_t>(count)));
            begin += static_cast<std::size_t>(count);
        }
    }
};
/// Gathers ranges of lengths that ranks do not know of each other, on every rank.
template <Messages Range>
RankBlocks<ValueOf<Range>> all_gathered_blocks(Communicator const& communicator, Range const& own) {
    auto counts = all_gathered(communicator, std::int64_t{std::ssize(span_of(own))});
    return {all_gathered(communicator, own, counts), counts};
}
/// Gathers ranges of lengths that ranks do not know of each other. Only rank 0 has their values.
template <Messages Range>
RankBlocks<ValueOf<Range>> gathered_blocks(Communicator const& communicator, Range const& own) {
    auto counts = all_gathered(communicator, std::int64_t{std::ssize(span_of(own))});
    return {gathered(communicator, own, counts), counts};
}

/// Copies rank 0's values to every rank.
template <Messages Range>
void broadcast(Communicator const& communicator, Range&& values) {
    communicator.broadcast(std::as_writable_bytes(span_of(values)));
}
/// Copies rank 0's value to every rank.
template <Message T>
    requires(!Messages<T>)
void broadcast(Communicator const& communicator, T& value) {
    broadcast(communicator, std::span(&value, 1));
}
/// Copies rank 0's text to every rank, with its length.
void broadcast(Communicator const&, std::string& text);

/// Sends to rank `to` and receives from rank `from`, as Communicator::exchange() does.
template <Messages Sent, Messages Received>
void exchange(Communicator const& communicator, Sent const& send, int to, Received&& receive,
              int from) {
    communicator.exchange(std::as_bytes(span_of(send)), to,
                          std::as_writable_bytes(span_of(receive)), from);
}

/// A rank's text; an empty one belongs to no rank.
struct RankText {
    int rank = -1;
    std::string text;
};
/// Returns the text of the first rank whose text is not empty, on every rank; an empty text if all
/// are empty.
RankText first_text(Communicator const&, std::string const& own);

}  // namespace catena
