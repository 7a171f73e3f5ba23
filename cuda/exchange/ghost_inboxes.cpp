// Implements GhostInboxes on top of the mapped memory of peer_memory.hpp.
#include "cuda/exchange/ghost_inboxes.hpp"
#include "mpi/collectives.hpp"

#include <algorithm>

namespace catena::cuda {

std::unique_ptr<GhostInboxes> GhostInboxes::make(Communicator const& communicator, int inboxes) {
    if (!gpus_may_write_to_each_other(communicator)) return nullptr;
    return std::unique_ptr<GhostInboxes>(new GhostInboxes(communicator, inboxes));
}

/// Keeps this rank's memory allocated, because other ranks may still have it mapped. It is freed
/// with its CUDA context.
GhostInboxes::~GhostInboxes() {
    unmap(base_, communicator_.rank());
    static auto* const kept = new std::vector<Buffer<double>>;
    kept->push_back(std::move(own_));
}

bool GhostInboxes::fit(std::span<Halo::Message const> messages) {
    auto const ranks = static_cast<std::size_t>(communicator_.size());
    std::vector<std::int64_t> first_of(ranks, 0);
    std::int64_t received = 0;
    for (Halo::Message const& m : messages) {
        first_of[static_cast<std::size_t>(m.rank)] = received;
        received += m.received;
    }
    auto const most = static_cast<std::int64_t>(communicator_.max(static_cast<double>(received)));
    if ((most > capacity_ || base_.empty()) && !map_anew(most)) return false;
    std::vector<std::int64_t> const all = all_gathered_alike(communicator_, first_of);
    first_.resize(ranks);
    for (std::size_t r = 0; r < ranks; ++r)
        first_[r] = all[r * ranks + static_cast<std::size_t>(communicator_.rank())];
    return true;
}

bool GhostInboxes::map_anew(std::int64_t received) {
    unmap(base_, communicator_.rank());
    base_.clear();
    communicator_.barrier();  // no rank maps it from here on
    // A smaller allocation shares one of the driver's blocks with others, and cannot be mapped by
    // itself.
    std::int64_t constexpr own_block = 1 << 16;
    capacity_ = std::max<std::int64_t>(received + received / 8, own_block);
    own_ = Buffer<double>();
    own_ = Buffer<double>(static_cast<std::size_t>(inboxes_ * 3 * capacity_));
    base_ = map_each_others(communicator_, own_.data());
    return !base_.empty();
}

void* GhostInboxes::box(int rank) const {
    return static_cast<double*>(base_[static_cast<std::size_t>(rank)]) + 3 * current_ * capacity_;
}

}  // namespace catena::cuda
