// Coupling of beads with OpenMM's particles on the GPU of one rank among several. Beads that are
// ghosts of other ranks are gathered on the GPU. They are written to the memory of the other ranks'
// GPUs, or pass through pinned memory of the host and messages, and are put into OpenMM's arrays
// there. The chains' own work continues during the transfer.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "clock.hpp"
#include "cuda/openmm/ghost_memory.hpp"
#include "cuda/openmm/pair_share.hpp"
#include "error.hpp"
#include "mpi/first_rank.hpp"
#include "neighbours/halo.hpp"

namespace catena::cuda {
namespace {

/// Stores the positions of these particles where their numbers say.
void scatter(std::span<int const> particle, std::span<Vec3 const> position,
             std::vector<Vec3>& of_particle) {
    for (std::size_t i = 0; i < particle.size(); ++i)
        of_particle[static_cast<std::size_t>(particle[i])] = position[i];
}
/// Returns the places of these particles.
std::vector<std::int32_t> places_of(std::span<int const> particle,
                                    std::span<std::int32_t const> place) {
    std::vector<std::int32_t> places;
    for (int const p : particle) places.push_back(place[static_cast<std::size_t>(p)]);
    return places;
}
/// Returns the numbers of beads at these places, in the order of the places.
std::vector<std::int64_t> sequence_by(std::span<std::int32_t const> place) {
    std::vector<std::int64_t> sequence(place.size());
    std::iota(sequence.begin(), sequence.end(), 0);
    std::sort(sequence.begin(), sequence.end(), [&](std::int64_t a, std::int64_t b) {
        return place[static_cast<std::size_t>(a)] < place[static_cast<std::size_t>(b)];
    });
    return sequence;
}

/// Checks kept lists of pairs on the host, in double precision. The GPU compares the positions in
/// OpenMM's arrays, which may be in single precision.
class ListAudit {
  public:
    /// Takes the positions `x` of own beads, nm, at which lists are built if `anew`. Otherwise
    /// throws SharedError on all ranks if a bead has moved farther than a kept list `lasts`, nm.
    /// Collective.
    void check(std::vector<Vec3> x, bool anew, double lasts, DeviceParticles const& particles,
               Communicator const& communicator) {
        bool holds = true;
        for (std::size_t i = 0; !anew && i < x.size(); ++i) {
            double const rounding = 0x1p-22 * (norm(x[i] - particles.origin) + norm(particles.box));
            holds = holds && norm(x[i] - listed_at_[i]) <= lasts + rounding;
        }
        if (communicator.sum(holds ? 0 : 1) > 0)
            throw SharedError(
                "a list of pairs was kept although a bead has moved beyond its margin");
        if (anew) listed_at_ = std::move(x);
    }

  private:
    std::vector<Vec3> listed_at_;  // positions of own beads at the last list
};

/// Coupling for one rank among several, by ghosts or by shared pairs.
class GhostPath final : public GpuPath {
  public:
    GhostPath(OpenMM::Context& home, DevicePathPlan plan)
        : GpuPath(home, std::move(plan), evaluations_of_ghosts),
          halo_(*plan_.halo),
          shown_(halo_, &flags_->data()->far, &flags_->data()->trouble),
          arrived_(halo_, &flags_->data()->of_ghosts) {
        if (!halo_.groups_of_share()) return;
        age_.set_most(OrderAge::unchecked);
        pairs_ = std::make_unique<PairShare>(halo_);
    }
    // The members' memory belongs to OpenMM's CUDA context.
    ~GhostPath() override { make_current(); }

    void begin(std::span<DeviceBeads* const> beads, bool timed) override {
        start(beads, timed);
        own_are_put_ = !age_.begins();
        if (own_are_put_)
            // Own positions are written now: OpenMM does not wait for later work of the streams.
            put_own(beads);
        goes_directly_ = can_go_directly();
        if (goes_directly_)
            exchange_directly();
        else if (has_lists_)
            show(beads);
        if (!plan_.overlap) exchange_and_compute(beads);
        if (timed) events_->chains_begin.record(stream_of(*beads.front()));
    }
    void go_on(std::span<DeviceBeads* const> beads) override {
        if (timed_) events_->chains_end.record(stream_of(*beads.back()));
        if (plan_.overlap) exchange_and_compute(beads);
    }
    void refuse_trouble() override { halo_.refuse_trouble(take_trouble()); }
    /// If kernels exchange the positions, the exchange interval is the time that the kernels take.
    /// The host's query during that time does not count.
    Clock clock() override {
        Clock clock = GpuPath::clock();
        if (goes_directly_) clock.exchange = {at(is_shown_), at(is_taken_)};
        return clock;
    }

  private:
    /// Number of evaluations per order if ghost lists are used. Rebuilding these lists may change
    /// the particles, which also leads to a new order.
    static constexpr int evaluations_of_ghosts = 250;

    Halo::Lists const& lists() const { return halo_.lists(); }

    /// True if positions can be copied directly from OpenMM's arrays to other ranks' arrays, in the
    /// order of the particles. After a reordering the host must know where all beads are, so that
    /// the direct way is not used.
    bool can_go_directly() const {
        return pairs_ && inboxes_ && !age_.begins() && particles_.position && !halo_.is_audited();
    }

    /// Enqueues the direct exchange of positions, while the host checks how far beads have moved.
    void exchange_directly() {
        is_shown_.record(stream_);
        inboxes_->advance();
        pairs_->send_positions(particles_.position, *inboxes_, stream_);
        is_sent_.record(stream_);
        pairs_->wait_for_positions(stream_);
        pairs_->take_positions(particles_.position, *inboxes_, stream_);
        is_taken_.record(stream_);
        put_layers();
    }

    /// Enqueues the gathering and sending of own beads that are ghosts elsewhere. The streams
    /// waited for OpenMM's last forces and so for the ghosts that these needed. The buffers of the
    /// previous messages are therefore free again.
    void show(std::span<DeviceBeads* const> beads) {
        cudaStream_t const last = stream_of(*beads.back());
        shown_.gather(beads, events_->positions);
        if (inboxes_) {
            inboxes_->advance();
            inboxes_->send(lists().messages, shown_.messages(), lists().one_for_all, last);
        } else {
            shown_.to_host(last);
        }
        is_shown_.record(last);
        is_sent_.record(last);
    }

    /// Waits for the positions, rebuilds lists if necessary, distributes ghosts and starts OpenMM's
    /// computation.
    void exchange_and_compute(std::span<DeviceBeads* const> beads) {
        if (has_lists_)
            is_shown_.wait();
        else
            look_for_trouble(positions());
        exchange_.begin = seconds_now();
        // The GPU may have lagged: its clock is matched to the host's at a point that both have
        // reached.
        if (has_lists_ && timed_)
            begun_ = exchange_.begin - is_shown_.seconds_since(events_->begun);
        bool const far = std::exchange(flags_->data()->far, 0) != 0;
        if (are_used_up(far)) {
            make_lists(beads);
            show(beads);
            is_shown_.wait();
            // are_used_up() is a barrier in the same way: all positions sent before it have
            // arrived.
            if (inboxes_) halo_.communicator().barrier();
            goes_directly_ = false;
        }
        if (inboxes_)
            halo_.note_carried();
        else
            halo_.carry(shown_.out(), arrived_.in());
        if (!goes_directly_) {
            place_all(beads);
            put_layers();
        }
        exchange_.end = seconds_now();
        if (pairs_) choose_pairs();
        compute(beads);
        if (pairs_) pairs_->keep_lists(contexts());
    }

    void compute_contexts() override {
        openmm_->compute();
        for (auto const& layer : layers_) layer->compute();
    }

    /// Puts arrived ghosts, and own beads if necessary, into OpenMM's arrays; reorders particles if
    /// due.
    void place_all(std::span<DeviceBeads* const> beads) {
        if (inboxes_ && (halo_.is_audited() || age_.begins() || !ghosts_are_placed_))
            arrived_.look_into(*inboxes_, stream_);
        if (halo_.is_audited()) halo_.audit(positions(), arrived_.in());
        if (age_.begins()) {
            Others const others[] = {{lists().particle, arrived_.in()},
                                     {lists().idle, lists().aside}};
            std::vector<Vec3> const own = positions();
            order(own, others, pairs_ ? middle_of_all(own) : mean(own));
            own_are_put_ = ghosts_are_placed_ = false;
            if (pairs_) send_in_order(own);
        }
        if (!own_are_put_) put_own(beads);
        if (!std::exchange(ghosts_are_placed_, true)) place_ghosts();
        // Arrived numbers have the present order, unless particles were just reordered; the host
        // then has them in the new one.
        bool const in_sequence = !pairs_ || !age_.begins();
        arrived_.put(in_sequence ? inboxes_.get() : nullptr, particles_, stream_);
    }

    /// Sorts messages by place in OpenMM's arrays, so that the GPU reads and writes neighbouring
    /// numbers together.
    void send_in_order(std::vector<Vec3> const& own) {
        std::vector<std::int32_t> const place = places_of(plan_.particle, place_);
        std::span<Vec3> const in = arrived_.in();
        std::vector<Vec3> of_particle(place_.size());
        scatter(lists().particle, in, of_particle);
        halo_.send_in(sequence_by(place));
        for (std::size_t i = 0; i < in.size(); ++i)
            in[i] = of_particle[static_cast<std::size_t>(lists().particle[i])];
        shown_.list(own, stream_);
        std::vector<std::int32_t> of_sent;
        for (std::int64_t const k : lists().sent)
            of_sent.push_back(place[static_cast<std::size_t>(k)]);
        pairs_->place(of_sent, places_of(lists().particle, place_));
    }

    void complete_forces() override {
        if (pairs_) pairs_->complete(particles_, stream_);
    }

    /// Chooses this rank's pairs and records if their list is rebuilt.
    void choose_pairs() {
        std::vector<OpenMmOnDevice*> const all = contexts();
        bool const anew = pairs_->choose(all, age_.begins());
        double const lasts = pairs_->lists_last(all);
        if (halo_.is_audited())
            audit_.check(positions(), anew, lasts, particles_, halo_.communicator());
        if (!pairs_->has_list()) return;
        age_.set_most(OrderAge::checked);
        note_list(anew, lasts);
    }

    /// Returns the mean position of all beads, nm. It is bitwise identical on every rank, because
    /// ranks that share pairs must compute the same order.
    Vec3 middle_of_all(std::vector<Vec3> const& own) const {
        std::span<Vec3> const in = arrived_.in();
        std::vector<Vec3> all(own.size() + in.size());
        scatter(plan_.particle, own, all);
        scatter(lists().particle, in, all);
        return mean(all);
    }

    /// True if the lists must be rebuilt. Collective. If all ranks stop with an error, it first
    /// waits until no message is under way to memory that will be freed.
    bool are_used_up(bool far) {
        try {
            return halo_.are_used_up(far, take_trouble());
        } catch (SharedError const&) {
            is_sent_.wait();
            halo_.communicator().barrier();
            throw;
        }
    }

    /// Rebuilds the ghost lists; the Context may be another one afterwards. Collective.
    void make_lists(std::span<DeviceBeads* const> beads) {
        std::vector<Vec3> const x = positions();
        for (DeviceBeads* group : beads)
            check(cudaStreamSynchronize(stream_of(*group)), "finish its work");
        // The Context remains because it knows its share of pairs.
        bool const lasts = pairs_ && openmm_;
        if (!lasts) compute_with(nullptr);
        halo_.make_lists(x);
        if (!lasts) compute_with(on_device(halo_.context()));
        if (!make_current()) throw ComputationError("OpenMM's CUDA context cannot be made current");
        if (!lists().keeps_particles) age_.end();
        ghosts_are_placed_ = false;
        has_lists_ = true;
        shown_.list(x, stream_);
        if (!has_way_ && halo_.every_rank_has_beads())
            inboxes_ = GhostInboxes::make(halo_.communicator(), 2);
        has_way_ = true;
        if (inboxes_ && !inboxes_->fit(lists().messages)) inboxes_.reset();
        if (pairs_ && !pairs_->fit(inboxes_ != nullptr)) inboxes_.reset();
        shown_.fit();
        arrived_.fit();
    }

    /// Sets the places of ghosts in OpenMM's arrays, and puts particles that stand for no bead
    /// aside.
    void place_ghosts() {
        std::vector<DeviceBead> beads;
        std::span<Vec3> const ghosts = arrived_.in();
        for (std::size_t i = 0; i < ghosts.size(); ++i)
            beads.push_back(bead_of(lists().particle[i], ghosts[i]));
        for (std::size_t i = 0; i < lists().idle.size(); ++i)
            beads.push_back(bead_of(lists().idle[i], lists().aside[i]));
        arrived_.place(beads, particles_, stream_);
    }

    Halo& halo_;
    bool has_way_ = false, has_lists_ = false, own_are_put_ = false, ghosts_are_placed_ = false,
         goes_directly_ = false;
    std::unique_ptr<GhostInboxes> inboxes_;  // null: positions pass through the host
    std::unique_ptr<PairShare> pairs_;       // null: OpenMM computes all forces on own beads
    ShownMessages shown_;
    ArrivedGhosts arrived_;
    Event is_shown_{Event::For::clock}, is_sent_{Event::For::order}, is_taken_{Event::For::clock};
    ListAudit audit_;
};

}  // namespace

std::unique_ptr<DevicePath> make_halo_path(OpenMM::Context& home, DevicePathPlan plan) {
    return std::make_unique<GhostPath>(home, std::move(plan));
}

}  // namespace catena::cuda
