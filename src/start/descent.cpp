// Implements the minimiser FIRE with a limit on the motion per step.
#include "start/descent.hpp"

#include <algorithm>
#include <cmath>

namespace catena {
namespace {

double constexpr cap = 0.02;           // nm: largest motion of a bead in a step
double constexpr first_step = 0.004;   // unit of time: beads weigh 1 and forces are in kJ/mol/nm
double constexpr longest_step = 0.02;  // stable for bonds of 10,000 kJ/mol/nm2
double constexpr shortest_step = 1e-6;
double constexpr first_mixing = 0.1, less_mixing = 0.99;  // start value and decay of the mixing
double constexpr longer = 1.1, shorter = 0.5;             // factors of the step's length
int constexpr patience = 5;  // downhill steps before the step becomes longer

}  // namespace

Descent::Descent(std::vector<MovingChain>& chains, SingleRankForces& forces, std::vector<Vec3>& at)
    : chains_(chains), forces_(forces), at_(at), step_(first_step), mixing_(first_mixing) {
    for (MovingChain const& chain : chains) velocity_.emplace_back(chain.units());
    acceleration_ = velocity_;
}

Descent::Ended Descent::run(Limits const& limits, ProgressCallback const& tell) {
    Ended ended;
    accelerate();
    ended.energy = forces_.energy();
    while (ended.evaluations < limits.most) {
        step();
        if (++ended.evaluations % limits.window != 0) continue;
        double const before = ended.energy;
        ended.energy = forces_.energy();
        tell(ended.evaluations, ended.energy);
        bool const pushed = largest_force_ > limits.large_force;
        double const fall = before - ended.energy;
        // Overlaps that push may raise the energy before it falls.
        if (std::isfinite(ended.energy) &&
            (pushed ? std::abs(fall) < limits.last_fall : fall < limits.fall)) {
            ended.at_rest = true;
            break;
        }
    }
    return ended;
}

void Descent::step() {
    for (std::size_t c = 0; c < chains_.size(); ++c)
        for (std::size_t u = 0; u < velocity_[c].size(); ++u) {
            UnitMotion const& a = acceleration_[c][u];
            UnitMotion& v = velocity_[c][u];
            v = {plus_scaled(v.shift, step_, a.shift), plus_scaled(v.rotation, step_, a.rotation)};
        }
    if (!move()) return stop(0.3);
    if (accelerate() > 0) {
        mix();
        if (++downhill_ > patience)
            step_ = std::min(longer * step_, longest_step), mixing_ *= less_mixing;
    } else {
        stop(shorter);
    }
}

double Descent::accelerate() {
    std::vector<Vec3> const found = forces_.forces(at_);
    largest_force_ = 0;
    for (Vec3 const& force : found) largest_force_ = std::max(largest_force_, norm(force));
    double power = 0;
    for (std::size_t c = 0; c < chains_.size(); ++c)
        for (std::size_t u = 0; u < velocity_[c].size(); ++u) {
            acceleration_[c][u] = chains_[c].acceleration(u, found);
            power += chains_[c].product(u, velocity_[c][u], acceleration_[c][u]);
        }
    return power;
}

/// Mixes a share `mixing_` of the forces' direction, at the norm of the velocities, into the
/// velocities.
void Descent::mix() {
    double speed = 0, force = 0;
    for (std::size_t c = 0; c < chains_.size(); ++c)
        for (std::size_t u = 0; u < velocity_[c].size(); ++u) {
            speed += chains_[c].product(u, velocity_[c][u], velocity_[c][u]);
            force += chains_[c].product(u, acceleration_[c][u], acceleration_[c][u]);
        }
    double const along = force > 0 ? mixing_ * std::sqrt(speed / force) : 0;
    for (std::size_t c = 0; c < chains_.size(); ++c)
        for (std::size_t u = 0; u < velocity_[c].size(); ++u) {
            UnitMotion const& a = acceleration_[c][u];
            UnitMotion& v = velocity_[c][u];
            v = {plus_scaled((1 - mixing_) * v.shift, along, a.shift),
                 plus_scaled((1 - mixing_) * v.rotation, along, a.rotation)};
        }
}

void Descent::stop(double shorten) {
    for (auto& chain : velocity_) std::fill(chain.begin(), chain.end(), UnitMotion{});
    step_ = std::max(shortest_step, shorten * step_);
    mixing_ = first_mixing, downhill_ = 0;
}

/// Velocities become what the links permit; no unit moves by more than the cap.
bool Descent::move() {
    bool moved = true;
    for (std::size_t c = 0; c < chains_.size(); ++c) {
        std::vector<UnitMotion> by = velocity_[c];
        for (std::size_t u = 0; u < by.size(); ++u) {
            double const way = step_ * chains_[c].size(u, by[u]),
                         part = step_ * (way > cap ? cap / way : 1);
            by[u] = {part * by[u].shift, part * by[u].rotation};
        }
        moved = chains_[c].move(by) && moved;
        chains_[c].put_beads(at_);
        for (std::size_t u = 0; u < by.size(); ++u)
            velocity_[c][u] = {(1 / step_) * by[u].shift, (1 / step_) * by[u].rotation};
    }
    return moved;
}

}  // namespace catena
