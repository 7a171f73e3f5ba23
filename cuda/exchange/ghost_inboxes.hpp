// Inboxes for ghost positions and for forces on ghosts in the memory of each rank's GPU. The other
// ranks' GPUs write to them directly, so that these numbers do not pass through the host.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cuda/exchange/peer_memory.hpp"
#include "math/linear.hpp"
#include "neighbours/halo.hpp"

namespace catena::cuda {

/// One or two inboxes per rank (the same number on all ranks), which are filled alternately. With
/// two inboxes, one is read while the next positions arrive in the other. Between two fillings of
/// one inbox, every rank must know that every other rank has read it.
class GhostInboxes {
  public:
    /// Returns null on all ranks if GPUs cannot write to each other's memory. Collective.
    static std::unique_ptr<GhostInboxes> make(Communicator const&, int inboxes);
    ~GhostInboxes();
    GhostInboxes(GhostInboxes const&) = delete;
    GhostInboxes& operator=(GhostInboxes const&) = delete;

    /// Provides room for the positions of these messages and exchanges the offsets at which ranks
    /// write. Returns false on all ranks if mapping each other's memory fails. Precondition: no
    /// rank writes or reads an inbox. Collective.
    bool fit(std::span<Halo::Message const> messages);
    /// Selects the other inbox for the next filling and reading. Every rank must call it.
    void advance() { current_ = (current_ + 1) % inboxes_; }
    /// Enqueues copies of `shown`, three numbers per position, to the inboxes of the receivers.
    /// `shown` holds one message after the other, or a single message for all if `one_for_all`.
    template <class Number>
    void send(std::span<Halo::Message const> messages, Number const* shown, bool one_for_all,
              cudaStream_t stream) const {
        for (Halo::Message const& m : messages) {
            auto const bytes = 3 * static_cast<std::size_t>(m.sent) * sizeof(Number);
            if (bytes > 0)
                check(cudaMemcpyAsync(box_of<Number>(m.rank), shown, bytes, cudaMemcpyDefault,
                                      stream),
                      "show its beads");
            if (!one_for_all) shown += 3 * m.sent;
        }
    }
    /// Returns the address in the inbox of `rank` to which this rank sends. Number has at most
    /// eight bytes.
    template <class Number>
    Number* box_of(int rank) const {
        static_assert(sizeof(Number) <= sizeof(double));
        return static_cast<Number*>(box(rank)) + 3 * first_[static_cast<std::size_t>(rank)];
    }
    /// Returns the positions or forces that have arrived in this rank's inbox.
    template <class Number>
    Number const* arrived() const {
        return static_cast<Number const*>(box(communicator_.rank()));
    }

  private:
    GhostInboxes(Communicator const& communicator, int inboxes)
        : communicator_(communicator), inboxes_(inboxes) {}
    /// Allocates inboxes for `received` positions and maps them on all ranks. Collective.
    bool map_anew(std::int64_t received);
    /// Returns the inbox of `rank` that is filled now.
    void* box(int rank) const;

    Communicator const& communicator_;
    int inboxes_, current_ = 0;
    std::int64_t capacity_ = 0;  // positions per inbox, equal on every rank
    Buffer<double> own_;
    /// Base address of each rank's inboxes, as mapped here.
    std::vector<void*> base_;
    /// Offset of this rank's positions in each rank's inbox.
    std::vector<std::int64_t> first_;
};

}  // namespace catena::cuda
