// Physically valid random chains for tests: the same chain for the same seed on every machine.
#pragma once

#include <cstdint>
#include <optional>

#include "scene/scene.hpp"

namespace catena::test {

/// SplitMix64 (Steele, Lea & Flood 2014): short, and its numbers are the same wherever it runs.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    /// In [low, high).
    double uniform(double low = 0, double high = 1);
    bool chance(double probability) { return uniform() < probability; }
    /// Each component in [-size, size).
    Vec3 vector(double size);
    Vec3 direction();
    Quat orientation();

  private:
    std::uint64_t state_;
};

/// mixed: revolute and spherical; weld: welds among any other joints; planar: revolute, every axis
/// parallel to all the others (a free base: but for body 1's own motion); any: every kind but
/// cylindrical and planar3, which came later; all: every kind.
enum class RandomJoints {
    revolute,
    spherical,
    mixed,
    universal,
    weld,
    prismatic,
    helical,
    planar,
    any,
    cylindrical,
    planar3,
    all
};

struct RandomChainOptions {
    std::size_t bodies = 8;
    RandomJoints joints = RandomJoints::mixed;
    Base base = Base::fixed;
    bool moving = true;    // velocities
    bool loaded = true;    // joint torques and wrenches
    bool springs = false;  // joint springs (unequal about the three axes) and dampers
    bool drag = false;     // of every body
    double driven = 0;     // probability that a joint that can be driven is
    std::optional<JointType> tip =
        std::nullopt;   // type of the joint of the last body to ground; velocities are made to fit
    bool ring = false;  // that joint is to the first body instead; base: free
    double time = 0;    // at which they are made to fit: decides the rates of driven joints
};

/// Open chains of the seeds: every kind of joints, base, load and drive in turn; 1 to `most`
/// bodies.
RandomChainOptions options_in_turn(std::uint64_t seed, std::size_t most);

/// Rigid bodies of mass 0.3 .. 3, size about 0.3, any shape a real body can have.
ChainSpec random_chain(std::uint64_t seed, RandomChainOptions const& options);

/// Adds `count` loops with joints of one type between random bodies of an open chain, or a body and
/// the ground. Velocities are made to fit.
void add_random_loops(ChainSpec&, std::uint64_t seed, std::size_t count, JointType);

/// Point beads of mass 0.3 .. 3 on links of 0.2 .. 0.6; velocities keep the lengths to rounding. A
/// jointed tip: a link of that size from the last bead to the ground.
ChainSpec random_bead_chain(std::uint64_t seed, std::size_t beads, Base base, Tip tip = Tip::free);
/// Rigid bodies and beads mixed, on links of 0.2 .. 0.6; velocities keep the lengths to rounding.
/// Ends as random_bead_chain's.
ChainSpec random_linked_chain(std::uint64_t seed, std::size_t bodies, Base base,
                              Tip tip = Tip::free);
/// A free chain of links with its last body joined to its first by one more, as long as they are
/// apart; velocities are made to fit.
ChainSpec closed(ChainSpec chain);
/// A torque and a force on each body.
std::vector<std::pair<Vec3, Vec3>> random_wrenches(std::uint64_t seed, std::size_t bodies);
/// A force on each bead.
std::vector<Vec3> random_forces(std::uint64_t seed, std::size_t beads);

}  // namespace catena::test
