// The torque of a spherical spring is minus the gradient of its energy along turns about the body's
// axes.
#include <gtest/gtest.h>

#include "dynamics/body_loads.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

TEST(Springs, TorqueIsTheGradientOfTheEnergy) {
    Random random(3);
    double const h = 1e-5;
    for (int sample = 0; sample < 200; ++sample) {
        Vec3 const stiffness{{random.uniform(0, 5), random.uniform(0, 5), random.uniform(0, 5)}};
        Quat const rest = random.orientation();
        Quat const turn =
            rest * from_rotation_vector(random.uniform(1e-6, 2.8) * random.direction());
        Vec3 const torque = spherical_spring_torque(stiffness, rest, turn);
        for (int i = 0; i < 3; ++i) {
            Vec3 step = Vec3::zero();
            step[i] = h;
            double const up =
                spherical_spring_energy(stiffness, rest, turn * from_rotation_vector(step));
            double const down =
                spherical_spring_energy(stiffness, rest, turn * from_rotation_vector(-step));
            EXPECT_NEAR(torque[i], -(up - down) / (2 * h),
                        1e-6);  // truncation h^2, rounding eps / h, both times some tens
        }
    }
}

}  // namespace
}  // namespace catena::test
