// Beads and OpenMM's particles on the GPU of a rank among several. Beads that others have as ghosts
// are gathered on the GPU, are written into the memory of theirs, or pass through pinned memory of
// the host and messages, and are put into OpenMM's arrays there. While they travel, the chains' own
// work goes on.
#include <algorithm>
#include <cmath>
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

class GhostPath final : public GpuPath {
  public:
    GhostPath(OpenMM::Context& home, DevicePathPlan plan)
        : GpuPath(home, std::move(plan), evaluations_of_ghosts), halo_(*plan_.halo) {
        if (!halo_.groups_of_share()) return;
        of_an_order_ = evaluations_of_an_order;
        pairs_ = std::make_unique<PairShare>(halo_);
    }
    ~GhostPath() override { make_current(); }  // what it owns lives there

    void begin(std::span<DeviceBeads* const> beads, bool timed) override {
        start(beads, timed);
        own_are_put_ = of_this_order_ > 0;
        if (own_are_put_)
            put_own(beads);  // now: OpenMM is not to wait for what the streams are given next
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
    /// Where kernels exchange positions, as long as these take, not the host's question meanwhile.
    Clock clock() override {
        Clock clock = GpuPath::clock();
        if (goes_directly_) clock.exchange = {at(is_shown_), at(is_taken_)};
        return clock;
    }

  private:
    /// Where lists are made anew ghosts come from elsewhere.
    static constexpr int evaluations_of_ghosts = 250;

    Halo::Lists const& lists() const { return halo_.lists(); }
    std::span<Vec3> out() const { return {(*out_).data(), lists().sent.size()}; }
    std::span<Vec3> in() const { return {(*in_).data(), lists().particle.size()}; }

    /// From OpenMM's arrays into those of others, as particles stand there; with a new order the
    /// host must know where all beads are.
    bool can_go_directly() const {
        return pairs_ && inboxes_ && of_this_order_ > 0 && particles_.position &&
               !halo_.is_audited();
    }

    /// While the host asks how far beads are.
    void exchange_directly() {
        is_shown_.record(stream_);
        inboxes_->turn();
        pairs_->send_positions(particles_.position, *inboxes_, stream_);
        is_sent_.record(stream_);
        pairs_->wait_for_positions(stream_);
        pairs_->take_positions(particles_.position, *inboxes_, stream_);
        is_taken_.record(stream_);
    }

    /// What the streams do here comes after OpenMM's last forces, for which they waited, and so
    /// after the ghosts that these waited for: the buffers of the messages before are free again.
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
            inboxes_->turn();
            inboxes_->send(lists().messages, shown_.shown, lists().one_for_all, last);
        } else if (!out().empty()) {
            check(cudaMemcpyAsync(out().data(), shown_.shown, out().size_bytes(),
                                  cudaMemcpyDeviceToHost, last),
                  "show its beads");
        }
        is_shown_.record(last);
        is_sent_.record(last);
    }

    void exchange_and_compute(std::span<DeviceBeads* const> beads) {
        if (has_lists_)
            is_shown_.wait();
        else
            look_at_start();
        exchange_.begin = seconds_now();
        // The GPU may have been behind: its clock is the host's where both are known to be.
        if (has_lists_ && timed_)
            begun_ = exchange_.begin - is_shown_.seconds_since(events_->begun);
        bool const far = std::exchange(flags_->data()->far, 0) != 0;
        if (are_used_up(far)) {
            make_lists(beads);
            show(beads);
            is_shown_.wait();
            if (inboxes_)
                halo_.communicator()
                    .barrier();  // as are_used_up() is one: what all have shown has arrived
            goes_directly_ = false;
        }
        if (inboxes_)
            halo_.note_carried();
        else
            halo_.carry(out(), in());
        if (!goes_directly_) place_all(beads);
        exchange_.end = seconds_now();
        if (pairs_) choose_pairs();
        compute(beads);
        if (pairs_ && pairs_->has_list()) openmm_->keep_list();  // as LonePath does
    }

    /// What has arrived goes where it belongs.
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

    /// Neighbours in OpenMM's arrays are neighbours in messages, too: the GPU reads and writes them
    /// together.
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

    void choose_pairs() {
        bool const anew = pairs_->choose(*openmm_, of_this_order_ == 0);
        if (halo_.is_audited()) audit_list(anew);
        if (!pairs_->has_list()) return;
        of_an_order_ = evaluations_of_a_listed_order;
        note_list(anew);
    }

    /// On the host, in double precision: the GPU compares what OpenMM's arrays have of these
    /// positions, maybe in single.
    void audit_list(bool anew) {
        std::vector<Vec3> x = positions();
        bool holds = true;
        for (std::size_t i = 0; !anew && i < x.size(); ++i) {
            double const rounding =
                0x1p-22 * (norm(x[i] - particles_.origin) + norm(particles_.box));
            holds = holds && norm(x[i] - listed_at_[i]) <= openmm_->list_lasts() + rounding;
        }
        if (halo_.communicator().sum(holds ? 0 : 1) > 0)
            throw SharedError(
                "a list of pairs was kept though a bead is farther from where it was made than it "
                "lasts");
        if (anew) listed_at_ = std::move(x);
    }

    /// The same on every rank, to the bit: ranks that share out pairs must find them in one order.
    Vec3 middle_of_all(std::vector<Vec3> const& own) const {
        std::vector<Vec3> all(own.size() + in().size());
        for (std::size_t i = 0; i < own.size(); ++i)
            all[static_cast<std::size_t>(plan_.particle[i])] = own[i];
        for (std::size_t i = 0; i < in().size(); ++i)
            all[static_cast<std::size_t>(lists().particle[i])] = in()[i];
        return mean(all);
    }

    /// What was sent must not arrive in memory that is no more, where all ranks end.
    bool are_used_up(bool far) {
        try {
            return halo_.are_used_up(far, take_trouble());
        } catch (SharedError const&) {
            is_sent_.wait();
            halo_.communicator().barrier();
            throw;
        }
    }

    /// For the host.
    void look_into_inbox() {
        if (in().empty()) return;
        check(cudaMemcpyAsync(in().data(), inboxes_->arrived<double>(), in().size_bytes(),
                              cudaMemcpyDeviceToHost, stream_),
              "take ghosts");
        check(cudaStreamSynchronize(stream_), "take ghosts");
    }

    void look_at_start() {
        std::vector<Vec3> const x = positions();
        for (std::size_t i = 0; i < x.size(); ++i)
            if (!std::isfinite(norm(x[i]))) flags_->data()->trouble = static_cast<std::int64_t>(i);
    }

    /// The Context may be another one afterwards.
    void make_lists(std::span<DeviceBeads* const> beads) {
        std::vector<Vec3> const x = positions();
        for (DeviceBeads* group : beads)
            check(cudaStreamSynchronize(stream_of(*group)), "finish its work");
        bool const lasts = pairs_ && openmm_;  // which knows its share
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

    /// Of each own bead, the places where it is shown.
    void list_sent(std::vector<Vec3> const& x) {
        ShownTable const table = shown_table(lists().sent, x.size());
        upload(first_.of(table.first.size()), table.first.data(), table.first.size());
        upload(place_of_shown_.of(table.place.size()), table.place.data(), table.place.size());
        if (lists().farthest) upload(shown_from_.of(3 * x.size()), x.front().data, 3 * x.size());
        check(cudaStreamSynchronize(stream_), "take lists");
        shown_.first = (*first_).data();
        shown_.place = (*place_of_shown_).data();
        shown_.shown = show_.of(3 * lists().sent.size()).data();
        shown_.listed = lists().farthest ? (*shown_from_).data() : nullptr;
        double const farthest = lists().farthest.value_or(0);
        shown_.farthest_squared = farthest * farthest;
        shown_.far = lists().farthest ? &flags_->data()->far : nullptr;
        shown_.trouble = &flags_->data()->trouble;
    }

    /// Where ghosts go from now on, and who stands aside.
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
                  "take lists");
            put(static_cast<std::int64_t>(all - ghosts), ghosts_from(ghosts), stream_);
        }
        check(cudaStreamSynchronize(stream_), "take lists");
    }

    ArrivedBeads ghosts_from(std::size_t first) const {
        ArrivedBeads arrived{particles_, (*arrived_).data() + 3 * first};
        arrived.particles.bead = (*ghost_).data() + first;
        arrived.particles.trouble = &flags_->data()->of_ghosts;  // their ranks tell
        arrived.particles.far = nullptr;                         // and know how far they are
        return arrived;
    }

    void put_ghosts() {
        if (in().empty()) return;
        ArrivedBeads arrived = ghosts_from(0);
        bool const in_sequence =
            !pairs_ || of_this_order_ > 0;  // those that arrived; the host has them in the new one
        if (inboxes_ && in_sequence)
            arrived.position = inboxes_->arrived<double>();
        else
            check(cudaMemcpyAsync((*arrived_).data(), in().data(), in().size_bytes(),
                                  cudaMemcpyHostToDevice, stream_),
                  "take ghosts");
        put(static_cast<std::int64_t>(in().size()), arrived, stream_);
    }

    Halo& halo_;
    bool has_way_ = false, has_lists_ = false, own_are_put_ = false, ghosts_are_placed_ = false,
         goes_directly_ = false;
    std::unique_ptr<GhostInboxes> inboxes_;  // null: positions pass through the host
    std::unique_ptr<PairShare> pairs_;       // null: OpenMM computes all that acts on own beads
    ShownBeads shown_;
    Event is_shown_{Event::For::clock}, is_sent_{Event::For::order}, is_taken_{Event::For::clock};
    Room<Buffer<std::int32_t>> first_, place_of_shown_;
    Room<Buffer<double>> shown_from_, show_, arrived_;
    Room<Buffer<DeviceBead>> ghost_;
    Room<PinnedBuffer<Vec3>> out_, in_;
    std::vector<Vec3> listed_at_;  // own beads, where it is audited
};

}  // namespace

std::unique_ptr<DevicePath> make_halo_path(OpenMM::Context& home, DevicePathPlan plan) {
    return std::make_unique<GhostPath>(home, std::move(plan));
}

}  // namespace catena::cuda
