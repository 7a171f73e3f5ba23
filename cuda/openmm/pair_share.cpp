// Implements the sharing of pairs among ranks and the exchange of forces.
#include "cuda/openmm/pair_share.hpp"

#include <algorithm>
#include <limits>

#include "mpi/collectives.hpp"
#include "neighbours/pair_cuts.hpp"

namespace catena::cuda {

static_assert(most_peers - 1 <= most_messages);

namespace {

/// True after 0, 1, 2, 4 and 8 evaluations; the shares then follow the sizes of the ranks' lists.
/// Shares also follow them whenever particles are reordered.
bool is_early(std::int64_t evaluations) {
    return evaluations <= 8 && (evaluations & (evaluations - 1)) == 0;
}

ForcesOnBeads forces_on(Room<Buffer<std::int32_t>> const& place, DeviceParticles const& particles) {
    return {particles.force, particles.places, (*place).data()};
}

}  // namespace

bool PairShare::fit(bool direct) {
    Communicator const& communicator = halo_.communicator();
    messages_.clear();
    for (Halo::Message const& m : halo_.lists().messages)
        messages_.push_back({m.rank, m.received, m.sent});
    if (direct && !inboxes_) inboxes_ = GhostInboxes::make(communicator, 1);
    if (inboxes_ && !memory_) memory_ = PeerMemory::connect(communicator);
    if (memory_ && boxes_.ranks == 0) boxes_ = memory_->boxes(0);
    if (!memory_ || (inboxes_ && !inboxes_->fit(messages_))) inboxes_.reset();
    if (inboxes_) {
        // Zeros are not sent, because most beads of other ranks are far from the pairs of this
        // rank. The inbox therefore starts with zeros.
        auto const bytes = static_cast<std::size_t>(received()) * 3 * sizeof(std::int64_t);
        if (bytes > 0)
            check(cudaMemsetAsync(inboxes_->box_of<std::int64_t>(communicator.rank()), 0, bytes,
                                  nullptr),
                  "clear memory");
        check(cudaStreamSynchronize(nullptr), "clear memory");
        communicator.barrier();  // no rank may send before
        return true;
    }
    sent_ = Buffer<std::int64_t>(static_cast<std::size_t>(3 * sent()));
    arrived_ = Buffer<std::int64_t>(static_cast<std::size_t>(3 * received()));
    out_ = std::make_unique<PinnedBuffer<std::int64_t>>(static_cast<std::size_t>(3 * sent()));
    in_ = std::make_unique<PinnedBuffer<std::int64_t>>(static_cast<std::size_t>(3 * received()));
    return false;
}

bool PairShare::choose(std::span<OpenMmOnDevice* const> contexts, bool new_order) {
    auto const rank = static_cast<std::size_t>(halo_.communicator().rank());
    int const ranks = halo_.communicator().size();
    std::int64_t const before = evaluations_++;
    if (has_list() && !new_order && !is_early(before) && !halo_.some_are_far()) return false;
    if (before == 0) {
        for (std::size_t i = 0; i < contexts.size(); ++i)
            contexts[i]->share(i == 0 ? *halo_.groups_of_share() : -1, static_cast<int>(rank),
                               ranks);
        cuts_.assign(contexts.size(), equal_cuts(ranks));
    } else if (new_order || is_early(before)) {
        even_out(contexts);
    }
    for (std::size_t i = 0; i < contexts.size(); ++i)
        contexts[i]->make_list(cuts_[i][rank], cuts_[i][rank + 1]);
    return true;
}

void PairShare::even_out(std::span<OpenMmOnDevice* const> contexts) {
    std::vector<double> own;
    for (OpenMmOnDevice* const context : contexts) own.push_back(context->tiles());
    std::vector<double> const all = all_gathered_alike(halo_.communicator(), own);
    has_list_.assign(contexts.size(), false);
    for (std::size_t i = 0; i < contexts.size(); ++i) {
        std::vector<double> of_context;
        for (std::size_t k = i; k < all.size(); k += contexts.size()) of_context.push_back(all[k]);
        cuts_[i] = evened_cuts(cuts_[i], of_context);
        has_list_[i] = *std::max_element(of_context.begin(), of_context.end()) > 0;
    }
}

void PairShare::keep_lists(std::span<OpenMmOnDevice* const> contexts) const {
    for (std::size_t i = 0; i < contexts.size(); ++i)
        if (has_list(i)) contexts[i]->keep_list();
}

double PairShare::lists_last(std::span<OpenMmOnDevice* const> contexts) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < contexts.size(); ++i)
        if (has_list(i)) least = std::min(least, contexts[i]->list_lasts());
    return least;
}

void PairShare::place(std::span<std::int32_t const> own, std::span<std::int32_t const> others) {
    auto const upload = [](Room<Buffer<std::int32_t>>& to, std::span<std::int32_t const> from) {
        check(cudaMemcpy(to.of(from.size()).data(), from.data(), from.size_bytes(),
                         cudaMemcpyHostToDevice),
              "receive OpenMM's order");
    };
    upload(place_of_own_, own);
    upload(place_of_others_, others);
    check(cudaStreamSynchronize(nullptr), "receive OpenMM's order");
}

void PairShare::send_positions(float const* position, GhostInboxes const& inboxes,
                               cudaStream_t stream) const {
    SentPositions sent{position, (*place_of_own_).data()};
    for (Halo::Message const& m : messages_)
        sent.to[sent.messages++] = inboxes.box_of<float>(m.rank);
    send(own(), sent, stream);
}

void PairShare::take_positions(float* position, GhostInboxes const& inboxes,
                               cudaStream_t stream) const {
    take(sent(), {position, (*place_of_others_).data(), inboxes.arrived<float>()}, stream);
}

void PairShare::wait_for_positions(cudaStream_t stream) const {
    if (inboxes_) meet(boxes_, stream);
}

void PairShare::complete(DeviceParticles const& particles, cudaStream_t stream) {
    if (!inboxes_)
        exchange_by_host(particles, stream);
    else if (particles.double_position)
        exchange<std::int64_t>(particles, stream);
    else
        exchange<float>(particles, stream);
}

template <class Number>
void PairShare::exchange(DeviceParticles const& particles, cudaStream_t stream) const {
    SentForces<Number> forces{forces_on(place_of_others_, particles)};
    forces.all = false;
    for (Halo::Message const& m : messages_) forces.add(m.sent, inboxes_->box_of<Number>(m.rank));
    send(forces, stream);
    meet(boxes_, stream);
    add_arrived(inboxes_->box_of<Number>(halo_.communicator().rank()), particles, stream);
}

void PairShare::exchange_by_host(DeviceParticles const& particles, cudaStream_t stream) {
    SentForces<std::int64_t> forces{forces_on(place_of_others_, particles)};
    forces.add(sent(), sent_.data());
    send(forces, stream);
    carry_by_host(stream);
    add_arrived(arrived_.data(), particles, stream);
}

template <class Number>
void PairShare::add_arrived(Number* arrived, DeviceParticles const& particles,
                            cudaStream_t stream) const {
    add<Number>(
        own(),
        {forces_on(place_of_own_, particles), arrived, own(), static_cast<int>(messages_.size())},
        stream);
}

void PairShare::carry_by_host(cudaStream_t stream) {
    auto const bytes = [](std::int64_t beads) {
        return static_cast<std::size_t>(beads) * 3 * sizeof(std::int64_t);
    };
    if (sent() > 0)
        check(cudaMemcpyAsync(out_->data(), sent_.data(), bytes(sent()), cudaMemcpyDeviceToHost,
                              stream),
              "send forces");
    check(cudaStreamSynchronize(stream), "send forces");
    std::vector<Outgoing> out;
    std::vector<Incoming> in;
    std::int64_t first_sent = 0, first_received = 0;
    for (Halo::Message const& m : messages_) {
        out.push_back({m.rank, std::as_bytes(std::span(out_->data() + 3 * first_sent,
                                                       static_cast<std::size_t>(3 * m.sent)))});
        in.push_back(
            {m.rank, std::as_writable_bytes(std::span(in_->data() + 3 * first_received,
                                                      static_cast<std::size_t>(3 * m.received)))});
        first_sent += m.sent;
        first_received += m.received;
    }
    halo_.communicator().exchange_all(out, in);
    if (received() > 0)
        check(cudaMemcpyAsync(arrived_.data(), in_->data(), bytes(received()),
                              cudaMemcpyHostToDevice, stream),
              "receive forces");
}

}  // namespace catena::cuda
