#include "measure/chain_sample.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace catena {
namespace {

using Beads = std::vector<Vec3>;

Beads beads_of(std::vector<Vec3> const& e, std::vector<double> const& length) {
    Beads x{Vec3::zero()};
    for (std::size_t j = 0; j < e.size(); ++j) x.push_back(plus_scaled(x.back(), length[j], e[j]));
    return x;
}

Vec3 unit(Vec3 const& v) { return (1 / norm(v)) * v; }

std::vector<Vec3> random_directions(int count, std::mt19937_64& draw) {
    std::normal_distribution<double> normal;
    std::vector<Vec3> e;
    for (int j = 0; j < count; ++j) e.push_back(unit({normal(draw), normal(draw), normal(draw)}));
    return e;
}

/// -d/dw of ln (det T)^1/2, summed over bonds, by differences.
double turned(std::vector<Vec3> const& e, std::vector<double> const& length,
              std::vector<double> const& mass) {
    double constexpr h = 1e-5;
    double sum = 0;
    for (std::size_t j = 1; j < e.size(); ++j) {
        Vec3 const w = plus_scaled(e[j - 1], -dot(e[j - 1], e[j]), e[j]);
        auto const at = [&](double way) {
            std::vector<Vec3> moved = e;
            moved[j] = unit(plus_scaled(length[j] * e[j], way, w));
            return half_log_det(moved, mass);
        };
        sum += (at(h) - at(-h)) / (2 * h);
    }
    return -sum;
}

TEST(ChainSample, TheMeasuresPartIsTheDerivativeOfTheDeterminant) {
    std::mt19937_64 draw(5);
    for (int const bonds : {2, 3, 9}) {
        std::vector<Vec3> const e = random_directions(bonds, draw);
        std::vector<double> length, mass{57};
        for (int j = 0; j < bonds; ++j) {
            length.push_back(0.3 + 0.05 * j);
            mass.push_back(60 + 40 * (j % 3));
        }
        Beads const x = beads_of(e, length), none(x.size(), Vec3::zero());
        ChainSample const rigid = sample_chain(x, none, mass, BondMeasure::rigid);
        ChainSample const flexible = sample_chain(x, none, mass, BondMeasure::flexible);
        EXPECT_NEAR(rigid.divergence - flexible.divergence, turned(e, length, mass), 1e-7) << bonds;
    }
}

/// Knots and weights of Gauss and Legendre on (-1, 1).
template <int n>
std::array<std::pair<double, double>, n> gauss() {
    std::array<std::pair<double, double>, n> found{};
    for (int i = 0; i < n; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1;
        for (int newton = 0; newton < 50; ++newton) {
            double p = 1, before = 0;
            for (int k = 1; k <= n; ++k)
                before = std::exchange(p, ((2 * k - 1) * x * p - (k - 1) * before) / k);
            slope = n * (x * p - before) / (x * x - 1);
            x -= p / slope;
        }
        found[static_cast<std::size_t>(i)] = {x, 2 / ((1 - x * x) * slope * slope)};
    }
    return found;
}

/// Springs between neighbours but one, and between the ends of four beads: smooth ones, k / 2 (d^2
/// - rest^2)^2.
struct Springs {
    double stiffness = 100;
    double energy(Beads const& x, Beads* force) const {
        double energy = 0;
        for (auto const& [a, b, rest] : {std::tuple{0, 2, 0.55}, {1, 3, 0.5}, {0, 3, 0.6}}) {
            Vec3 const d = x[static_cast<std::size_t>(b)] - x[static_cast<std::size_t>(a)];
            double const off = dot(d, d) - rest * rest;
            energy += 0.5 * stiffness * off * off;
            Vec3 const pull = (2 * stiffness * off) * d;
            (*force)[static_cast<std::size_t>(a)] = (*force)[static_cast<std::size_t>(a)] + pull;
            (*force)[static_cast<std::size_t>(b)] = (*force)[static_cast<std::size_t>(b)] - pull;
        }
        return energy;
    }
};

/// The temperature that `measured` gives of four beads distributed by `weight` at kT, integrated
/// over both angles and the dihedral.
double temperature_over_true(BondMeasure weight, BondMeasure measured) {
    double constexpr kt = 2.5;
    std::vector<double> const length{0.38, 0.41, 0.36}, mass{57, 186, 71, 131};
    int constexpr turns = 48;
    auto const knots = gauss<32>();
    double virial = 0, divergence = 0;
    for (auto const& [u1, w1] : knots)
        for (auto const& [u2, w2] : knots)
            for (int t = 0; t < turns; ++t) {
                double const first = std::numbers::pi / 2 * (1 + u1),
                             second = std::numbers::pi / 2 * (1 + u2);
                double const c1 = std::cos(first), s1 = std::sin(first), c2 = std::cos(second),
                             s2 = std::sin(second);
                double const phi = 2 * std::numbers::pi * t / turns;
                std::vector<Vec3> const e{
                    {c1, s1, 0}, {1, 0, 0}, {c2, s2 * std::cos(phi), s2 * std::sin(phi)}};
                Beads const x = beads_of(e, length);
                Beads force(4, Vec3::zero());
                double const energy = Springs().energy(x, &force);
                double const metric =
                    weight == BondMeasure::rigid ? std::exp(half_log_det(e, mass)) : 1.0;
                double const p = w1 * s1 * w2 * s2 * metric * std::exp(-energy / kt);
                ChainSample const s = sample_chain(x, force, mass, measured);
                virial += p * s.virial;
                divergence += p * s.divergence;
            }
    return virial / divergence / kt;
}

TEST(ChainSample, TheConfigurationalTemperatureIsThatOfTheEnsemble) {
    EXPECT_NEAR(temperature_over_true(BondMeasure::flexible, BondMeasure::flexible), 1, 1e-9);
    EXPECT_NEAR(temperature_over_true(BondMeasure::rigid, BondMeasure::rigid), 1, 1e-9);
}

TEST(ChainSample, TheOtherMeasureIsSeen) {
    EXPECT_GT(std::abs(temperature_over_true(BondMeasure::rigid, BondMeasure::flexible) - 1), 0.01);
    EXPECT_GT(std::abs(temperature_over_true(BondMeasure::flexible, BondMeasure::rigid) - 1), 0.01);
}

TEST(ChainSample, AFreelyJointedChainHasNoDivergenceInItsMeasure) {
    std::mt19937_64 draw(11);
    std::vector<double> const length(19, 0.38);
    std::vector<double> mass;
    for (int k = 0; k < 20; ++k) mass.push_back(57.0 + 43 * (k % 4));
    double sum = 0, square = 0, weights = 0, largest = 0;
    Beads const none(20, Vec3::zero());
    int constexpr samples = 20000;
    for (int i = 0; i < samples; ++i) {
        std::vector<Vec3> const e = random_directions(19, draw);
        double const weight = std::exp(half_log_det(e, mass) -
                                       half_log_det(std::vector<Vec3>(19, Vec3{1, 0, 0}), mass));
        double const d =
            weight * sample_chain(beads_of(e, length), none, mass, BondMeasure::rigid).divergence;
        weights += weight;
        sum += d;
        square += d * d;
        largest = std::max(largest, weight);
    }
    EXPECT_LT(std::abs(sum), 4 * std::sqrt(square));
    EXPECT_LT(largest, 0.01 * weights);
}

TEST(ChainSample, ShapeAndCosineOfARightAngle) {
    Beads const x{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 2, 0}}, none(4, Vec3::zero());
    std::vector<double> const mass(4, 3.0);
    ChainSample const s = sample_chain(x, none, mass, BondMeasure::flexible);
    EXPECT_NEAR(s.end_to_end, std::sqrt(5.0), 1e-15);
    EXPECT_NEAR(s.cosine, 0.5, 1e-15);
    EXPECT_NEAR(s.radius_of_gyration, std::sqrt(0.1875 + 0.6875), 1e-15);
    EXPECT_NEAR(s.divergence, 2, 1e-15);
}

}  // namespace
}  // namespace catena
