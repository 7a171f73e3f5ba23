// Contact maps against all pairs, density profiles against known phases, kinds of chains.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/analysis.hpp"
#include "analysis/contacts.hpp"
#include "analysis/density.hpp"
#include "error.hpp"
#include "tests/analysis/sample_trajectory.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::analysis {
namespace {

TEST(Kinds, EqualChainsAreCopiesAndOthersAreNot) {
    Topology topology = test::topology_of({5, 5, 4, 5, 0});
    topology.residue[15] = "ALA";  // the fourth chain differs in one residue
    std::vector<Kind> const kinds = kinds_of(topology);
    ASSERT_EQ(kinds.size(), 3U);
    EXPECT_EQ(kinds[0].chains, (std::vector<std::size_t>{0, 1}));
    EXPECT_EQ(kinds[0].name, "chain");
    EXPECT_EQ(kinds[1].name, "chain-3");
    EXPECT_EQ(kinds[2].chains, (std::vector<std::size_t>{3}));
}

TEST(Kinds, MassesAndRingsTellChainsApart) {
    Topology topology = test::topology_of({3, 3, 3});
    topology.mass[4] = 2;
    topology.chains[2].ring = true;
    EXPECT_EQ(kinds_of(topology).size(), 3U);
}

/// Probability of contacts within and between chains, over all pairs.
struct Counted {
    std::vector<double> within, between, mixed;
    double pairs_within = 0, pairs_between = 0;
};

class SmallBox : public ::testing::Test {
  protected:
    SmallBox() : topology_(test::topology_of({9, 9, 9, 6})), kinds_(kinds_of(topology_)) {
        topology_.box = Vec3{{4.0, 5.0, 9.0}};
        test::RandomChains draw(11);
        for (int f = 0; f < 20; ++f) {
            Snapshot& s = frames_.emplace_back();
            s.box = topology_.box;
            for (Topology::Chain const& chain : topology_.chains) {
                Vec3 const at{{8 * draw.uniform() - 4, 5 * draw.uniform(), 9 * draw.uniform()}};
                for (Vec3 const& x : draw.chain(static_cast<std::size_t>(chain.count), 0.38, 0))
                    s.position.push_back(at + x);
            }
        }
    }

    Counted count(double cutoff) const {
        Counted found{std::vector<double>(81), std::vector<double>(81), std::vector<double>(54)};
        for (Snapshot const& s : frames_)
            for (std::size_t p = 0; p < 33; ++p)
                for (std::size_t q = 0; q < 33; ++q) {
                    std::size_t const a = p / 9, b = q / 9;
                    Vec3 d = s.position[p] - s.position[q];
                    if (a != b)
                        for (int i = 0; i < 3; ++i)
                            d[i] -= (*s.box)[i] * std::rint(d[i] / (*s.box)[i]);
                    if (p == q || norm(d) > cutoff) continue;
                    if (a == b && a < 3) found.within[p % 9 * 9 + q % 9] += 1.0 / (20 * 3);
                    if (a != b && a < 3 && b < 3)
                        found.between[p % 9 * 9 + q % 9] += 1.0 / (20 * 6);
                    if (a < 3 && b == 3) found.mixed[p % 9 * 6 + (q - 27)] += 1.0 / (20 * 3);
                    if (a == b && a < 3 && std::abs(int(p) - int(q)) >= 3)
                        found.pairs_within += 0.5 / (20 * 3);
                    if (a < 3 && a != b) found.pairs_between += 1.0 / (20 * 3);
                }
        return found;
    }

    Topology topology_;
    std::vector<Kind> kinds_;
    std::vector<Snapshot> frames_;
};

TEST_F(SmallBox, ContactsAreThoseOfAllPairs) {
    for (double const cutoff : {0.5, 0.9, 1.9}) {  // 8, 4 and 2 cells along the shortest edge
        Contacts contacts(topology_, kinds_, cutoff, 20);
        for (Snapshot const& frame : frames_) contacts.add(frame);
        Counted const right = count(cutoff);
        std::vector<ContactMap> const maps = contacts.maps();
        ASSERT_EQ(maps.size(), 4U);  // within both kinds, between copies, between kinds
        for (std::size_t k = 0; k < 81; ++k) {
            EXPECT_NEAR(maps[0].mean[k], right.within[k], 1e-12) << cutoff << " " << k;
            EXPECT_NEAR(maps[2].mean[k], right.between[k], 1e-12) << cutoff << " " << k;
        }
        for (std::size_t k = 0; k < 54; ++k)
            EXPECT_NEAR(maps[3].mean[k], right.mixed[k], 1e-12) << cutoff << " " << k;
        EXPECT_EQ(maps[3].rows, 9U);
        EXPECT_EQ(maps[3].columns, 6U);
        EXPECT_NEAR(contacts.numbers()[0].within.estimate().mean, right.pairs_within, 1e-12);
        EXPECT_NEAR(contacts.numbers()[0].between.estimate().mean, right.pairs_between, 1e-12);
        EXPECT_TRUE(std::isfinite(maps[0].error[3]));
    }
}

TEST_F(SmallBox, ACutoffLongerThanHalfTheBoxIsRefused) {
    Contacts contacts(topology_, kinds_, 2.1, 20);
    EXPECT_EQ(
        test::message_of([&] { contacts.add(frames_[0]); }),
        "a cutoff of 2.1 exceeds half of the box's edge of 4 (--cutoff): give a shorter one, or "
        "0 for no contacts");
}

TEST(Contacts, AChainAndItsOwnImageAreNoContact) {
    Topology topology = test::topology_of({21});
    topology.box = Vec3{{8.0, 8.0, 8.0}};
    std::vector<Kind> const kinds = kinds_of(topology);
    Snapshot s;
    s.box = topology.box;
    for (int k = 0; k < 21; ++k) s.position.push_back({{0.38 * k, 0, 0}});  // ends 0.4 nm apart
    Contacts contacts(topology, kinds, 0.45, 1);
    contacts.add(s);
    EXPECT_EQ(contacts.own_images(), 1);
    EXPECT_EQ(contacts.maps()[0].mean[20], 0);
    EXPECT_EQ(contacts.numbers()[0].within.values()[0], 0);
}

TEST(Contacts, LongChainsShareRows) {
    Topology const topology = test::topology_of({1500});
    std::vector<Kind> const kinds = kinds_of(topology);
    Snapshot s;
    for (int k = 0; k < 1500; ++k) s.position.push_back({{0.38 * k, 0, 0}});
    Contacts contacts(topology, kinds, 0.4, 1);
    contacts.add(s);
    EXPECT_EQ(contacts.sites_a_row(), 2);
    ContactMap const map = contacts.maps()[0];
    EXPECT_EQ(map.rows, 750U);
    EXPECT_DOUBLE_EQ(map.mean[0], 1);        // its only pair
    EXPECT_DOUBLE_EQ(map.mean[1], 1.0 / 4);  // one pair of four
    EXPECT_DOUBLE_EQ(map.mean[2], 0);
}

TEST(Contacts, ManyKindsHaveNumbersAndNoMapsOfPairs) {
    std::vector<std::int64_t> lengths;
    for (std::int64_t n = 2; n < 42; ++n) lengths.push_back(n);
    Topology const topology = test::topology_of(lengths);
    std::vector<Kind> const kinds = kinds_of(topology);
    Snapshot s;
    s.position.assign(topology.mass.size(), Vec3::zero());
    Contacts contacts(topology, kinds, 0.4, 1);
    contacts.add(s);
    EXPECT_EQ(contacts.maps().size(), 40U);
    EXPECT_EQ(contacts.numbers()[0].between.values()[0],
              2.0 * static_cast<double>(topology.mass.size() - 2));
}

/// Single sites with a dense part of 20 nm around `middle` in a box of 100 nm.
DensityProfile slab(double middle, int frames) {
    std::size_t const inside = 900, outside = 100;
    Topology topology = test::topology_of(std::vector<std::int64_t>(inside + outside, 1));
    topology.box = Vec3{{5.0, 5.0, 100.0}};
    std::vector<Kind> const kinds = kinds_of(topology);
    DensityProfile profile(topology, kinds, 2, 200, frames);
    test::RandomChains draw(8);
    for (int f = 0; f < frames; ++f) {
        Snapshot s;
        s.box = topology.box;
        for (std::size_t k = 0; k < inside + outside; ++k) {
            double const z = k < inside ? middle + 20 * (draw.uniform() - 0.5)
                                        : middle + 100 * (draw.uniform() - 0.5);
            s.position.push_back({{0, 0, z}});
        }
        profile.add(s);
    }
    return profile;
}

TEST(Density, ASlabHasTheConcentrationsItWasDrawnWith) {
    double const amu = 1.66053906892, dilute = amu * 100 / 2500, dense = dilute + amu * 900 / 500;
    for (double const middle : {0.0, 37.0, 149.5}) {  // also across the box's faces, and unwrapped
        DensityProfile const profile = slab(middle, 60);
        Interfaces const found = profile.interfaces();
        EXPECT_NEAR(found.position, 10, 0.5) << middle;
        Estimate const in = profile.in(1, DensityProfile::dense_region(found)),
                       out = profile.in(1, profile.dilute_region(found));
        // The middle of 1,000 sites is off by about 0.2 nm, which concerns the interfaces alone.
        EXPECT_LT(std::abs(in.mean - dense), 5 * in.error) << middle;
        EXPECT_LT(in.error, 0.01 * dense);
        EXPECT_LT(std::abs(out.mean - dilute), 5 * out.error) << middle;
        EXPECT_LT(out.error, 0.05 * dilute);
        double mass = 0;
        for (std::size_t bin = 0; bin < 200; ++bin)
            mass += profile.at(1, bin).mean * 0.5 * 25 / amu;
        EXPECT_NEAR(mass, 1000, 1e-9);
        EXPECT_NEAR(profile.z(0), -49.75, 1e-12);
    }
}

/// The analysis of single sites, drawn anew in every frame, in a box of 10 x 10 x 60 nm.
template <class Draw>
Analysis analysis_of(std::size_t sites, Draw const& draw, Options const& options = {}) {
    Topology topology = test::topology_of(std::vector<std::int64_t>(sites, 1));
    topology.box = Vec3{{10, 10, 60}};
    std::vector<std::int64_t> steps(40);
    std::iota(steps.begin(), steps.end(), 0);
    std::vector<double> const times(steps.begin(), steps.end());
    auto const read = [&](std::size_t, Snapshot& into) {
        into.box = topology.box;
        into.position.clear();
        for (std::size_t k = 0; k < sites; ++k) into.position.push_back(draw(k));
    };
    return analyse(FrameSource{"drawn", topology, true, false, steps, times, read}, options);
}

bool has_phases(Analysis const& found) {
    return std::any_of(
        found.quantities.begin(), found.quantities.end(),
        [](Quantity const& quantity) { return quantity.name == "dense_concentration"; });
}
bool says(Analysis const& found, std::string const& part) {
    return std::any_of(found.notes.begin(), found.notes.end(), [&](std::string const& note) {
        return note.find(part) != std::string::npos;
    });
}

TEST(Slab, FillsTheBoxAcrossItsAxis) {
    test::RandomChains draw(5);
    auto const slab = [&](std::size_t k) {
        double const thick = k % 20 == 0 ? 60 : 12;
        return Vec3{{10 * draw.uniform(), 10 * draw.uniform(), thick * (draw.uniform() - 0.5)}};
    };
    Analysis const found = analysis_of(400, slab);
    EXPECT_TRUE(has_phases(found));
    EXPECT_FALSE(says(found, "does not fill") || says(found, "so few chains"));
}

TEST(Slab, ADropletInALongBoxIsNone) {
    test::RandomChains draw(6);
    auto const droplet = [&](std::size_t) {
        return Vec3{{9, 1, 0}} + 4 * std::cbrt(draw.uniform()) * draw.direction();
    };
    Analysis const found = analysis_of(400, droplet);
    EXPECT_FALSE(has_phases(found));
    EXPECT_TRUE(says(found, "does not fill the box across the axis"));
    EXPECT_TRUE(says(found, "--slab z gives them nevertheless"));
    Options asked;
    asked.slab = 2;
    Analysis const forced = analysis_of(400, droplet, asked);
    EXPECT_TRUE(has_phases(forced));
    EXPECT_TRUE(says(forced, "the concentrations may not be those of two phases"));
}

TEST(Slab, FewChainsInALongBoxAreNoneByChance) {
    test::RandomChains draw(7);
    auto const even = [&](std::size_t) {
        return Vec3{{10 * draw.uniform(), 10 * draw.uniform(), 60 * draw.uniform()}};
    };
    for (std::size_t const sites : {6, 12, 100}) EXPECT_FALSE(has_phases(analysis_of(sites, even)));
}

TEST(Density, FitsFindTheProfileTheyAreGiven) {
    std::vector<double> z, density;
    for (int k = 0; k < 100; ++k) {
        z.push_back(0.25 + 0.5 * k);
        density.push_back(3 + 0.5 * (480 - 3) * (1 - std::tanh((z.back() - 12.3) / 1.7)));
    }
    Interfaces const found = fit_interfaces(z, density, 50);
    EXPECT_NEAR(found.position, 12.3, 1e-4);
    EXPECT_NEAR(found.width, 1.7, 1e-4);
    EXPECT_NEAR(found.dense, 480, 1e-2);
    EXPECT_NEAR(found.dilute, 3, 1e-2);
}

}  // namespace
}  // namespace catena::analysis
