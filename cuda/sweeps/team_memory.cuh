// Data of a team's run in shared memory (revolute_teams.cuh): of the bodies ahead in the inward
// pass, and of the revolute joints behind in the outward pass. tests/support/cuda_on_host.hpp,
// included first, makes this file compile on the host.
#pragma once

#include "cuda/sweeps/stage_kernels.cuh"
#include "dca/fused_sweep.hpp"

namespace catena::cuda::kernels {

/// Number of bodies of a run of maximal length, and of those between the first and the last.
constexpr int bodies_of_whole_run = static_cast<int>(dca::longest_run),
              bodies_within = bodies_of_whole_run - 2;
/// Lanes per team: one for each body of a run.
constexpr int lanes_of_team = bodies_of_whole_run;
static_assert(32 % lanes_of_team == 0);
/// Array of `slots` records for each team of a warp.
template <class T, int slots>
class SlotsOfTeam {
    static constexpr int teams = 32 / lanes_of_team;
    using Records = PackedRecords<T, numbers_of<T>>;

  public:
    static constexpr std::size_t size = Records::size(teams * slots);
    __device__ SlotsOfTeam(double* memory, int lane)
        : records_{memory}, team_(lane / lanes_of_team) {}
    __device__ void put(int slot, T const& value) const {
        records_.store(slot * teams + team_, value);
    }
    __device__ T get(int slot) const { return records_.load(slot * teams + team_); }
    __device__ double& number(int slot, int n) const {
        return records_.number(slot * teams + team_, n);
    }

  private:
    Records records_;
    int team_;
};
/// Number of bodies of a team's run. `whole`: a run of maximal length. Otherwise it has three or
/// more bodies, and the warp's other teams may have other numbers.
template <bool whole>
class BodiesOfTeam {
  public:
    __device__ explicit BodiesOfTeam(dca::Run const& run) : count_(static_cast<int>(run.count)) {}
    __device__ int count() const { return whole ? bodies_of_whole_run : count_; }
    __device__ int last() const { return count() - 1; }
    __device__ bool is_within(int i) const { return i > 0 && i < last(); }
    __device__ int body_or_last(int i) const { return whole || i < count_ ? i : count_ - 1; }
    /// Returns the largest count among the warp's teams. All lanes call it together.
    __device__ int most(int lane) const {
        int most = count();
        if constexpr (!whole)
            for (int apart = lanes_of_team; apart < 32; apart *= 2)
                if (int const other = __shfl_sync(0xffffffffu, most, lane ^ apart); other > most)
                    most = other;
        return most;
    }

  private:
    int count_;
};
/// Data of a body that the inward pass needs to include it. They are computed before the pass
/// occupies the registers. The first and the last body are left out, so that eight warps fit in
/// shared memory.
struct BodyAhead : dca::BodyInRun<double> {
    /// Torque about the revolute joint if it is not part of the bodies' torques.
    double torque_about;
    dca::AddedBody<double> body;
    dca::Wrench<double> load;  // about handle 2
};
using BodiesAhead = SlotsOfTeam<BodyAhead, bodies_within>;
/// Data of a joint and a body that the outward pass needs, after the force at the run's first joint
/// is known.
struct RevoluteBehind {
    dca::PushedRevolute<double> revolute;
    dca::BodyInRun<double> body;
};
/// Data of a team's run for the outward pass, in shared memory.
template <class Sweep, bool whole>
class RevolutesBehind {
    using Tail = typename dca::RunWorkspace<typename Sweep::Sweeps>::Tail;
    using Revolutes = SlotsOfTeam<RevoluteBehind, bodies_of_whole_run - 1>;
    using Tails = SlotsOfTeam<Tail, 1>;
    // Frames of the first body and of the last two.
    using Frames = SlotsOfTeam<dca::RevoluteFrame<double>, 3>;
    static_assert(lanes_of_team >= 3);

  public:
    static constexpr std::size_t size = Revolutes::size + Tails::size + Frames::size;
    __device__ RevolutesBehind(BodiesOfTeam<whole> const& bodies, double* memory, int lane)
        : bodies_(bodies),
          revolutes_(memory, lane),
          tail_(memory + Revolutes::size, lane),
          frames_(memory + Revolutes::size + Tails::size, lane),
          own_(lane % lanes_of_team) {}
    /// Reads the data of all joints and bodies. All lanes of the warp call it together.
    template <class Kept, class Frame>
    __device__ void fetch(Kept const& kept, Vector<double, 5> const& first,
                          Frame const& frame) const {
        if (own_ < 3) frames_.put(own_, frame(own_ == 0 ? 0 : bodies_.count() - 3 + own_));
        if (int const i = 1 + own_; i < bodies_.count())
            revolutes_.put(i - 1, {pushed(kept.revolute(i), first), kept.body(i)});
        move_some<8>(
            own_, numbers_of<Tail>, lanes_of_team, [&](int n) { return kept.tail(n); },
            [&](int n, double v) { tail_.number(0, n) = v; });
        __syncwarp();
    }
    // The following members are the interface that dca::descend_revolutes() requires.
    __device__ dca::RevoluteFrame<double> frame(int i) const {
        return frames_.get(i == 0 ? 0 : i - (bodies_.count() - 3));
    }
    __device__ dca::PushedRevolute<double> revolute(int i) const {
        return revolutes_.get(i - 1).revolute;
    }
    __device__ dca::BodyInRun<double> body(int i) const { return revolutes_.get(i - 1).body; }
    __device__ dca::RunsEnd<double> end() const { return tail_.get(0).end; }
    __device__ Mat3 axes() const { return tail_.get(0).axes; }
    __device__ dca::BodyAcceleration<double> velocity_bias(int) const {
        return tail_.get(0).velocity_bias;
    }

  private:
    BodiesOfTeam<whole> bodies_;
    Revolutes revolutes_;
    Tails tail_;
    Frames frames_;
    int own_;
};

}  // namespace catena::cuda::kernels
