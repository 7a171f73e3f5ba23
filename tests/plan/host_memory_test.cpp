// The memory that `plan` names beside what a run's arrays take: operators new and delete count
// here.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "integrate/stepper.hpp"
#include "plan/describe.hpp"
#include "reader/load_scene.hpp"

namespace {

std::atomic<std::int64_t> allocated{0};

void* counted(void* place) {
    if (place == nullptr) throw std::bad_alloc();
    allocated += static_cast<std::int64_t>(malloc_usable_size(place));
    return place;
}
void give_back(void* place) {
    if (place == nullptr) return;
    allocated -= static_cast<std::int64_t>(malloc_usable_size(place));
    std::free(place);
}
void* aligned(std::size_t size, std::align_val_t to) {
    auto const step = static_cast<std::size_t>(to);
    return counted(std::aligned_alloc(step, (size + step - 1) / step * step));
}

}  // namespace

void* operator new(std::size_t size) { return counted(std::malloc(size)); }
void* operator new(std::size_t size, std::align_val_t to) { return aligned(size, to); }
void* operator new(std::size_t size, std::nothrow_t const&) noexcept {
    void* const place = std::malloc(size);
    return place == nullptr ? nullptr : counted(place);
}
void operator delete(void* place) noexcept { give_back(place); }
void operator delete(void* place, std::size_t) noexcept { give_back(place); }
void operator delete(void* place, std::align_val_t) noexcept { give_back(place); }
void operator delete(void* place, std::size_t, std::align_val_t) noexcept { give_back(place); }

namespace catena::test {
namespace {

std::unique_ptr<Communicator> const alone = serial_communicator();
constexpr int rods = 4000;  // whose arrays stay below where large pages begin

struct Bytes {
    double planned = 0, taken = 0;
};
/// After a step, when everything is there.
Bytes bytes_of(std::string const& integrator, std::string const& chain) {
    std::string const text = fmt::format(
        "chains: [{{base: free, velocities: zero, generator: {}}}]\n"
        "dynamics: {{integrator: {}, step: 1e-6, steps: 1, friction: 0.1, temperature: 300}}\n"
        "solver: {{backend: segments, handles: full}}\n",
        chain, integrator);
    Scene const scene = parse_scene(text, "scene.yaml", {});
    Integrator const kind = scene.dynamics.integrator;
    command::Memory const memory = command::memory_of(scene, 1);
    std::int64_t const before = allocated;
    ChainSystem system(scene, uses_joint_coordinates(kind) ? Axes::joint : Axes::world, *alone,
                       is_implicit(kind) ? scene.dynamics.step : 0.0);
    auto const stepper = make_stepper(system, scene.dynamics);
    stepper->prepare(nullptr);
    stepper->step(0, nullptr);
    return {memory.state + memory.solver, static_cast<double>(allocated - before)};
}

std::string const rod = fmt::format(
    "{{elastic_rod: {{bodies: {}, mass: 650, length: 0.34, radius: 1, bend: 50, twist: 100}}}}",
    rods);
std::string const free_joints =
    fmt::format("{{random: {{bodies: {}, joint: spherical, seed: 1, loads: false}}}}", rods);

/// A rank has all of a branched chain or nothing; ranks share other chains.
TEST(HostMemory, OfAWholeChainIsNotShared) {
    auto const of = [](std::string const& chain, int ranks) {
        command::Memory const memory =
            command::memory_of(parse_scene("chains: [{" + chain + "}]\n", "scene.yaml", {}), ranks);
        return memory.state + memory.solver;
    };
    std::string const star = "generator: {star: {arms: 4, arm_length: 500, length: 0.5}}";
    EXPECT_EQ(of(star, 4), of(star, 1));
    EXPECT_NEAR(of(star + ", count: 4", 2), of(star + ", count: 4", 1) / 2, 1);
    std::string const plain = "generator: {freely_jointed: {beads: 2000, length: 0.5}}";
    EXPECT_NEAR(of(plain, 4), of(plain, 1) / 4, 1);
}

/// An estimate: loads are counted as if every joint had some.
TEST(HostMemory, IsWithinATenthOfWhatIsTaken) {
    for (std::string const& chain : {rod, free_joints})
        for (char const* const integrator :
             {"rk4", "dormand-prince", "velocity-verlet", "staggered", "baoab", "implicit-baoab",
              "rattle", "g-baoab", "implicit-g-baoab"}) {
            Bytes const bytes = bytes_of(integrator, chain);
            EXPECT_NEAR(bytes.planned / bytes.taken, 1, 0.1) << integrator << ", " << chain;
        }
}

/// What an integrator keeps beside another of its kind: compliances, rotors, noise. Half a number a
/// body for paddings and lists.
TEST(HostMemory, KnowsWhatSpringsAndNoiseTake) {
    struct Pair {
        char const *more, *less;
        std::string const& chain;
        double numbers;
    };
    for (Pair const& p : {Pair{"staggered", "velocity-verlet", rod, 9},
                          {"baoab", "velocity-verlet", rod, 6},
                          {"implicit-baoab", "velocity-verlet", rod, 15},
                          {"implicit-g-baoab", "g-baoab", rod, 16},
                          {"staggered", "velocity-verlet", free_joints, 0},
                          {"implicit-g-baoab", "g-baoab", free_joints, 0}}) {
        Bytes const more = bytes_of(p.more, p.chain), less = bytes_of(p.less, p.chain);
        double constexpr number = rods * sizeof(double);
        EXPECT_NEAR((more.taken - less.taken) / number, p.numbers, 0.5)
            << p.more << ", " << p.chain;
        EXPECT_NEAR((more.planned - less.planned) / number, p.numbers, 1e-9)
            << p.more << ", " << p.chain;
    }
}

}  // namespace
}  // namespace catena::test
