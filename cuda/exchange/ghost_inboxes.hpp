// Where positions of ghosts, and forces on them, arrive on each rank's GPU, written there by the
// GPUs of the others: they do not pass through the host then.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cuda/exchange/peer_memory.hpp"
#include "math/linear.hpp"
#include "neighbours/halo.hpp"

namespace catena::cuda {

/// Every rank has as many inboxes, one or two, which are filled in turns: what arrived in one of
/// two is read while the next positions come. Between two fillings of one of them every rank must
/// have heard of every other that it has read it.
class GhostInboxes {
  public:
    /// Null on all ranks where GPUs do not reach each other. Collective.
    static std::unique_ptr<GhostInboxes> make(Communicator const&, int inboxes);
    ~GhostInboxes();
    GhostInboxes(GhostInboxes const&) = delete;
    GhostInboxes& operator=(GhostInboxes const&) = delete;

    /// Room for the positions of these messages. False on all ranks where GPUs do not reach each
    /// other after all. Precondition: nobody writes or reads. Collective.
    bool fit(std::span<Halo::Message const> messages);
    /// From now on the other one is filled and read. On every rank.
    void turn() { turn_ = (turn_ + 1) % inboxes_; }
    /// Sends `shown`, three numbers a position, one message after the other or one for all, once
    /// the stream comes here.
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
    /// Where in that rank's inbox what this rank sends goes: numbers of eight bytes or less.
    template <class Number>
    Number* box_of(int rank) const {
        static_assert(sizeof(Number) <= sizeof(double));
        return static_cast<Number*>(box(rank)) + 3 * first_[static_cast<std::size_t>(rank)];
    }
    template <class Number>
    Number const* arrived() const {
        return static_cast<Number const*>(box(communicator_.rank()));
    }

  private:
    GhostInboxes(Communicator const& communicator, int inboxes)
        : communicator_(communicator), inboxes_(inboxes) {}
    bool map_anew(std::int64_t received);
    /// The inbox of a rank that is filled now.
    void* box(int rank) const;

    Communicator const& communicator_;
    int inboxes_, turn_ = 0;
    std::int64_t capacity_ = 0;  // positions in each inbox, on every rank alike
    Buffer<double> own_;
    std::vector<void*> base_;          // of each rank
    std::vector<std::int64_t> first_;  // of this rank's positions in each rank's inbox
};

}  // namespace catena::cuda
