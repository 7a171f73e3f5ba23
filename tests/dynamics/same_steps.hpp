// Steps that chains are carried through together leave the bits of steps part by part, loop after
// loop.
#pragma once

#include <gtest/gtest.h>

#include "dynamics/absolute_dynamics.hpp"
#include "tests/support/same_bits.hpp"

namespace catena::test {

/// `carried` takes them in its own way. Configurations must be up to date.
inline void expect_same_steps(AbsoluteDynamics& carried, AbsoluteDynamics& looped, bool langevin,
                              std::uint64_t steps) {
    ConstrainedStep step;
    step.langevin = langevin;
    step.kick = step.drift = 0.005;
    step.sweeps = 3;
    step.thermostat = thermostat_of(0.9, 2.5, 11);
    auto const before = looped.state();
    for (step.number = 0; step.number < steps; ++step.number) {
        for (AbsoluteDynamics* const d : {&carried, &looped}) {
            d->assemble_matrices();
            d->set_simple_forces();
        }
        carried.step(step);
        looped.AbsoluteDynamics::step(step);
        auto const found = carried.state(), expected = looped.state();
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_TRUE(same_bits(found[i].values, expected[i].values)) << found[i].name;
    }
    EXPECT_FALSE(same_bits(before[0].values, looped.state()[0].values)) << "nothing moved";
}

}  // namespace catena::test
