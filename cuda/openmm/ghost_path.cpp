// Coupling of beads with OpenMM's particles on the GPU of one rank among several. Beads that are
// ghosts of other ranks are gathered on the GPU. They are written to the memory of the other ranks'
// GPUs, or pass through pinned memory of the host and messages, and are put into OpenMM's arrays
// there. The chains' own work continues during the transfer.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "clock.hpp"
#include "cuda/exchange/ghost_inboxes.hpp"
#include "cuda/openmm/gpu_path.hpp"
#include "cuda/openmm/pair_share.hpp"
#include "error.hpp"
#include "mpi/first_rank.hpp"
#include "neighbours/halo.hpp"

namespace catena::cuda {
namespace {

/// Coupling for one rank among several, by ghosts or by shared pairs.
class GhostPath final : public GpuPath {
  public:
    GhostPath(OpenMM::Context& home, DevicePathPlan plan)
        : GpuPath(home, std::move(plan), evaluations_of_ghosts), halo_(*plan_.halo) {
        if (!halo_.groups_of_share()) return;
        of_an_order_ = evaluations_of_an_order;
        pairs_ = std::make_unique<PairShare>(halo_);
    }
    // The members' memory belongs to OpenMM's CUDA context.
    ~GhostPath() override { make_current(); }

    void begin(std::span<DeviceBeads* const> beads, bool timed) override {
        start(beads, timed);
        own_are_put_ = of_this_order_ > 0;
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
    std::span<Vec3> out() const { return {(*out_).data(), lists().sent.size()}; }
    std::span<Vec3> in() const { return {(*in_).data(), lists().particle.size()}; }

    /// True if positions can be copied directly from OpenMM's arrays to other ranks' arrays, in the
    /// order of the particles. After a reordering the host must know where all beads are, so that
    /// the direct way is not used.
    bool can_go_directly() const {
        return pairs_ && inboxes_ && of_this_order_ > 0 && particles_.position &&
               !halo_.is_audited();
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
        std::int64_t next = 0;
        for (DeviceBeads* group : beads) {
            group->show(shown_.from(next));
            events_->positions.record(stream_of(*group));
            events_->positions.hold(last);
            next += group->count();
        }
        if (inboxes_) {
            inboxes_->advance();
            inboxes_->send(lists().messages, shown_.shown, lists().one_for_all, last);
        } else if (!out().empty()) {
            check(cudaMemcpyAsync(out().data(), shown_.shown, out().size_bytes(),
                                  cudaMemcpyDeviceToHost, last),
                  "show its beads");
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
            look_at_start();
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
            halo_.carry(out(), in());
        if (!goes_directly_) {
            place_all(beads);
            put_layers();
        }
        exchange_.end = seconds_now();
        if (pairs_) choose_pairs();
        compute(beads);
        if (pairs_) keep_lists();
    }

    /// See PairList.
    void keep_lists() {
        std::vector<OpenMmOnDevice*> const all = contexts();
        for (std::size_t i = 0; i < all.size(); ++i)
            if (pairs_->has_list(i)) all[i]->keep_list();
    }

    void compute_contexts() override {
        openmm_->compute();
        for (auto const& layer : layers_) layer->compute();
    }

    /// Returns the Context of all particles, then those of the layers.
    std::vector<OpenMmOnDevice*> contexts() const {
        std::vector<OpenMmOnDevice*> all{openmm_.get()};
        for (auto const& layer : layers_) all.push_back(&layer->openmm());
        return all;
    }
    /// Returns the distance, nm, that particles may move before a list must be rebuilt. All lists
    /// are then rebuilt at once, by all ranks.
    double lists_last() const {
        std::vector<OpenMmOnDevice*> const all = contexts();
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < all.size(); ++i)
            if (pairs_->has_list(i)) least = std::min(least, all[i]->list_lasts());
        return least;
    }

    /// Puts arrived ghosts, and own beads if necessary, into OpenMM's arrays; reorders particles if
    /// due.
    void place_all(std::span<DeviceBeads* const> beads) {
        if (inboxes_ && (halo_.is_audited() || of_this_order_ == 0 || !ghosts_are_placed_))
            look_into_inbox();
        if (halo_.is_audited()) halo_.audit(positions(), in());
        if (of_this_order_ == 0) {
            Others const others[] = {{lists().particle, in()}, {lists().idle, lists().aside}};
            std::vector<Vec3> const own = positions();
            order(own, others, pairs_ ? middle_of_all(own) : mean(own));
            own_are_put_ = ghosts_are_placed_ = false;
            if (pairs_) send_in_order(own);
        }
        if (!own_are_put_) put_own(beads);
        if (!std::exchange(ghosts_are_placed_, true)) place_ghosts();
        put_ghosts();
    }

    /// Sorts messages by place in OpenMM's arrays, so that the GPU reads and writes neighbouring
    /// numbers together.
    void send_in_order(std::vector<Vec3> const& own) {
        auto const place_of = [&](std::int64_t k) {
            return place_[static_cast<std::size_t>(plan_.particle[static_cast<std::size_t>(k)])];
        };
        std::vector<std::int64_t> sequence(own.size());
        std::iota(sequence.begin(), sequence.end(), 0);
        std::sort(sequence.begin(), sequence.end(),
                  [&](std::int64_t a, std::int64_t b) { return place_of(a) < place_of(b); });
        std::vector<Vec3> of_particle(place_.size());
        for (std::size_t i = 0; i < in().size(); ++i)
            of_particle[static_cast<std::size_t>(lists().particle[i])] = in()[i];
        halo_.send_in(sequence);
        for (std::size_t i = 0; i < in().size(); ++i)
            in()[i] = of_particle[static_cast<std::size_t>(lists().particle[i])];
        list_sent(own);
        std::vector<std::int32_t> of_own, of_others;
        for (std::int64_t const k : lists().sent) of_own.push_back(place_of(k));
        for (int const particle : lists().particle)
            of_others.push_back(place_[static_cast<std::size_t>(particle)]);
        pairs_->place(of_own, of_others);
    }

    void complete_forces() override {
        if (pairs_) pairs_->complete(particles_, stream_);
    }

    /// Chooses this rank's pairs and records if their list is rebuilt.
    void choose_pairs() {
        bool const anew = pairs_->choose(contexts(), of_this_order_ == 0);
        if (halo_.is_audited()) audit_list(anew);
        if (!pairs_->has_list()) return;
        of_an_order_ = evaluations_of_a_listed_order;
        note_list(anew, lists_last());
    }

    /// Checks on the host, in double precision, that no bead has moved farther than the kept list
    /// allows. The GPU compares the positions in OpenMM's arrays, which may be in single precision.
    /// Throws SharedError on all ranks if a list was kept for too long.
    void audit_list(bool anew) {
        std::vector<Vec3> x = positions();
        bool holds = true;
        double const lasts = lists_last();
        for (std::size_t i = 0; !anew && i < x.size(); ++i) {
            double const rounding =
                0x1p-22 * (norm(x[i] - particles_.origin) + norm(particles_.box));
            holds = holds && norm(x[i] - listed_at_[i]) <= lasts + rounding;
        }
        if (halo_.communicator().sum(holds ? 0 : 1) > 0)
            throw SharedError(
                "a list of pairs was kept although a bead has moved beyond its margin");
        if (anew) listed_at_ = std::move(x);
    }

    /// Returns the mean position of all beads, nm. It is bitwise identical on every rank, because
    /// ranks that share pairs must compute the same order.
    Vec3 middle_of_all(std::vector<Vec3> const& own) const {
        std::vector<Vec3> all(own.size() + in().size());
        for (std::size_t i = 0; i < own.size(); ++i)
            all[static_cast<std::size_t>(plan_.particle[i])] = own[i];
        for (std::size_t i = 0; i < in().size(); ++i)
            all[static_cast<std::size_t>(lists().particle[i])] = in()[i];
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

    /// Copies the inbox to the host.
    void look_into_inbox() {
        if (in().empty()) return;
        check(cudaMemcpyAsync(in().data(), inboxes_->arrived<double>(), in().size_bytes(),
                              cudaMemcpyDeviceToHost, stream_),
              "receive ghosts");
        check(cudaStreamSynchronize(stream_), "receive ghosts");
    }

    /// Checks on the host, at the first evaluation, that all positions are finite.
    void look_at_start() {
        std::vector<Vec3> const x = positions();
        for (std::size_t i = 0; i < x.size(); ++i)
            if (!std::isfinite(norm(x[i]))) flags_->data()->trouble = static_cast<std::int64_t>(i);
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
        if (!lists().keeps_particles) of_this_order_ = 0;
        ghosts_are_placed_ = false;
        has_lists_ = true;
        list_sent(x);
        if (!has_way_ && halo_.every_rank_has_beads())
            inboxes_ = GhostInboxes::make(halo_.communicator(), 2);
        has_way_ = true;
        if (inboxes_ && !inboxes_->fit(lists().messages)) inboxes_.reset();
        if (pairs_ && !pairs_->fit(inboxes_ != nullptr)) inboxes_.reset();
        out_.of(lists().sent.size());
        in_.of(lists().particle.size());
    }

    /// Uploads, for each own bead, the places in messages to which it is written.
    void list_sent(std::vector<Vec3> const& x) {
        ShownTable const table = shown_table(lists().sent, x.size());
        upload(first_.of(table.first.size()), table.first.data(), table.first.size());
        upload(place_of_shown_.of(table.place.size()), table.place.data(), table.place.size());
        if (lists().farthest) upload(shown_from_.of(3 * x.size()), x.front().data, 3 * x.size());
        check(cudaStreamSynchronize(stream_), "receive lists");
        shown_.first = (*first_).data();
        shown_.place = (*place_of_shown_).data();
        shown_.shown = show_.of(3 * lists().sent.size()).data();
        shown_.listed = lists().farthest ? (*shown_from_).data() : nullptr;
        double const farthest = lists().farthest.value_or(0);
        shown_.farthest_squared = farthest * farthest;
        shown_.far = lists().farthest ? &flags_->data()->far : nullptr;
        shown_.trouble = &flags_->data()->trouble;
    }

    /// Sets the places of ghosts in OpenMM's arrays, and puts particles that stand for no bead
    /// aside.
    void place_ghosts() {
        std::vector<DeviceBead> beads;
        for (std::size_t i = 0; i < in().size(); ++i)
            beads.push_back(bead_of(lists().particle[i], in()[i]));
        std::size_t const ghosts = beads.size(), all = ghosts + lists().idle.size();
        for (std::size_t i = 0; i < lists().idle.size(); ++i)
            beads.push_back(bead_of(lists().idle[i], lists().aside[i]));
        upload(ghost_.of(all), beads.data(), all);
        arrived_.of(3 * all);
        if (all > ghosts) {
            check(cudaMemcpyAsync((*arrived_).data() + 3 * ghosts, lists().aside.data(),
                                  (all - ghosts) * sizeof(Vec3), cudaMemcpyHostToDevice, stream_),
                  "receive lists");
            put(static_cast<std::int64_t>(all - ghosts), ghosts_from(ghosts), stream_);
        }
        check(cudaStreamSynchronize(stream_), "receive lists");
    }

    /// Returns the description of ghosts from number `first` on, for put().
    ArrivedBeads ghosts_from(std::size_t first) const {
        ArrivedBeads arrived{particles_, (*arrived_).data() + 3 * first};
        arrived.particles.bead = (*ghost_).data() + first;
        // reported by the ranks that own them
        arrived.particles.trouble = &flags_->data()->of_ghosts;
        arrived.particles.far = nullptr;  // checked by these ranks, too
        return arrived;
    }

    void put_ghosts() {
        if (in().empty()) return;
        ArrivedBeads arrived = ghosts_from(0);
        // Arrived numbers have the present order, unless particles were just reordered; the host
        // then has them in the new one.
        bool const in_sequence = !pairs_ || of_this_order_ > 0;
        if (inboxes_ && in_sequence)
            arrived.position = inboxes_->arrived<double>();
        else
            check(cudaMemcpyAsync((*arrived_).data(), in().data(), in().size_bytes(),
                                  cudaMemcpyHostToDevice, stream_),
                  "receive ghosts");
        put(static_cast<std::int64_t>(in().size()), arrived, stream_);
    }

    Halo& halo_;
    bool has_way_ = false, has_lists_ = false, own_are_put_ = false, ghosts_are_placed_ = false,
         goes_directly_ = false;
    std::unique_ptr<GhostInboxes> inboxes_;  // null: positions pass through the host
    std::unique_ptr<PairShare> pairs_;       // null: OpenMM computes all forces on own beads
    ShownBeads shown_;
    Event is_shown_{Event::For::clock}, is_sent_{Event::For::order}, is_taken_{Event::For::clock};
    Room<Buffer<std::int32_t>> first_, place_of_shown_;
    Room<Buffer<double>> shown_from_, show_, arrived_;
    Room<Buffer<DeviceBead>> ghost_;
    Room<PinnedBuffer<Vec3>> out_, in_;
    std::vector<Vec3> listed_at_;  // positions of own beads at the last list, for audits
};

}  // namespace

std::unique_ptr<DevicePath> make_halo_path(OpenMM::Context& home, DevicePathPlan plan) {
    return std::make_unique<GhostPath>(home, std::move(plan));
}

}  // namespace catena::cuda
