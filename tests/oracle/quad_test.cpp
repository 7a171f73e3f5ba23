#include <gtest/gtest.h>

#include "oracle/quad.hpp"

namespace catena::oracle {
namespace {

double size(Quad x) { return static_cast<double>(abs(x)); }
double const eps = 0x1p-112;

TEST(Quad, CarriesMoreDigitsThanLongDouble) {
    Quad const third = Quad(1) / Quad(3);
    EXPECT_LE(size(third * Quad(3) - Quad(1)), eps);
    EXPECT_GT(size(third - Quad(1.0L / 3.0L)), 0.0);
    EXPECT_EQ(Quad(1) + Quad::epsilon() / Quad(2), Quad(1));
    EXPECT_NE(Quad(1) + Quad::epsilon(), Quad(1));
}

TEST(Quad, SquareRoot) {
    for (double const x : {1e-300, 1e-20, 0.1, 2.0, 3.0, 1e9, 1e300}) {
        Quad const s = sqrt(Quad(x));
        EXPECT_LE(size(s * s / Quad(x) - Quad(1)), 4 * eps) << x;
    }
    EXPECT_EQ(sqrt(Quad(0)), Quad(0));
    EXPECT_EQ(sqrt(Quad(49)), Quad(7));
}

TEST(Quad, SineAndCosineKeepTheAdditionTheorems) {
    for (double const x :
         {1e-20, 1e-3, 0.3, 0.7853981, 1.0, 1.5707963, 2.5, -3.1, 4.0, 100.25, -1e6}) {
        Quad const s = sin(Quad(x)), c = cos(Quad(x));
        EXPECT_LE(size(s * s + c * c - Quad(1)), 8 * eps) << x;
        EXPECT_LE(size(sin(Quad(2 * x)) - Quad(2) * s * c), 16 * eps) << x;
        EXPECT_LE(size(cos(Quad(x) + Quad(1)) - c * cos(Quad(1)) + s * sin(Quad(1))),
                  (16 + std::abs(x)) * eps)
            << x;
        EXPECT_NEAR(static_cast<double>(s), std::sin(x), 1e-15) << x;
        EXPECT_NEAR(static_cast<double>(c), std::cos(x), 1e-15) << x;
    }
}

TEST(Quad, ArcTangentUndoesSineAndCosine) {
    for (double const x : {1e-12, 0.1, 0.9, 1.6, 3.1, -0.4, -2.0, -3.1})
        EXPECT_LE(size(atan2(sin(Quad(x)), cos(Quad(x))) - Quad(x)), 16 * eps) << x;
    Quad const pi = Quad(4) * atan2(Quad(1), Quad(1));
    EXPECT_LE(size(sin(pi / Quad(6)) - Quad(1) / Quad(2)), 2 * eps);
    EXPECT_LE(size(pi - Quad(0x1.921fb54442d18p1) - Quad(0x1.1a62633145c07p-53) +
                   Quad(0x1.f1976b7ed8fbcp-109)),
              4 * eps);
}

}  // namespace
}  // namespace catena::oracle
