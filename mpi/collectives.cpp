// Implements the collectives of texts.
#include "mpi/collectives.hpp"

namespace catena {

void broadcast(Communicator const& communicator, std::string& text) {
    auto length = static_cast<std::int64_t>(text.size());
    broadcast(communicator, length);
    text.resize(static_cast<std::size_t>(length));
    if (length > 0) broadcast(communicator, std::span(text));
}

RankText first_text(Communicator const& communicator, std::string const& own) {
    if (communicator.max(own.empty() ? 0 : 1) == 0) return {};
    auto const all = all_gathered_blocks(communicator, own);
    RankText first;
    int rank = 0;
    all.each([&](std::span<char const> text) {
        if (first.rank < 0 && !text.empty()) first = {rank, {text.begin(), text.end()}};
        ++rank;
    });
    return first;
}

}  // namespace catena
