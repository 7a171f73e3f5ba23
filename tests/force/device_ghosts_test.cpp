// Lists, slots and tables of the path on which positions and forces stay on GPUs, with plain memory
// in the place of these: forces are those of the replicated System, whatever order the particles
// are in and whenever lists were made.
#include "force/device_ghosts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include "force/pair_decomposition.hpp"
#include "mpi/first_rank.hpp"
#include "neighbours/bead_tables.hpp"
#include "tests/force/beads.hpp"
#include "tests/force/every_force.hpp"
#include "tests/force/ranks.hpp"

namespace catena::testing {
namespace {

/// What cuda/openmm/ghost_path.cpp does, on the host. Forces: HaloForces or PairForces.
template <class Forces>
class PlainMemory {
  public:
    explicit PlainMemory(Forces& forces)
        : halo_(forces),
          forces_(forces),
          particle_(forces.plan(true).particle),
          own_(particle_.size()),
          box_(forces.plan(true).box) {}

    std::vector<Vec3> evaluate(std::vector<Vec3> const& x) {
        far_ = 0;
        trouble_ = -1;
        if (has_lists_) show(x);
        if (halo_.are_used_up(far_ != 0, trouble_)) {
            halo_.make_lists(x);
            if (!halo_.lists().keeps_particles) ++contexts_;
            take_lists(x);
            show(x);
        }
        std::vector<Vec3> in(halo_.lists().particle.size());
        halo_.carry(out_, in);
        halo_.audit(x, in);
        return own_ == 0 ? std::vector<Vec3>() : forces_at(x, in);
    }
    void send_in(std::vector<std::int64_t> const& sequence, std::vector<Vec3> const& x) {
        halo_.send_in(sequence);
        take_lists(x);
    }
    int contexts() const { return contexts_; }  // or exchanges of their particles

  private:
    void take_lists(std::vector<Vec3> const& x) {
        table_ = shown_table(halo_.lists().sent, own_);
        out_.assign(halo_.lists().sent.size(), Vec3::zero());
        listed_ = x;
        has_lists_ = true;
    }
    void show(std::vector<Vec3> const& x) {
        ShownBeads shown;
        shown.first = table_.first.data();
        shown.place = table_.place.data();
        shown.shown = out_.empty() ? nullptr : out_.front().data;
        shown.listed = halo_.lists().farthest && !listed_.empty() ? listed_.front().data : nullptr;
        shown.farthest_squared = std::pow(halo_.lists().farthest.value_or(0), 2);
        shown.far = &far_;
        shown.trouble = &trouble_;
        std::size_t const half = own_ / 2;  // as if there were two groups of chains
        for (std::size_t k = 0; k < half; ++k) shown.show(static_cast<std::int64_t>(k), x[k]);
        for (std::size_t k = half; k < own_; ++k)
            shown.from(static_cast<std::int64_t>(half))
                .show(static_cast<std::int64_t>(k - half), x[k]);
    }
    std::vector<Vec3> forces_at(std::vector<Vec3> const& x, std::vector<Vec3> const& in) {
        Halo::Lists const& lists = halo_.lists();
        ForceContext& context = *forces_.computing();
        auto const particles = static_cast<std::size_t>(context.size());
        std::vector<std::int32_t> place(particles);
        std::iota(place.begin(), place.end(), 0);
        std::shuffle(place.begin(), place.end(), std::mt19937_64(particles));
        std::vector<double> position(4 * particles, NAN);
        std::int64_t trouble = -1;
        DeviceParticles to;
        to.double_position = position.data();
        to.trouble = &trouble;
        if (box_) to.box = *box_;
        auto const put = [&](std::vector<int> const& particle, std::vector<Vec3> const& at) {
            std::vector<DeviceBead> beads;
            for (std::size_t i = 0; i < particle.size(); ++i)
                beads.push_back(bead_at(place[static_cast<std::size_t>(particle[i])], at[i], box_));
            ArrivedBeads arrived{to, at.empty() ? nullptr : at.front().data};
            arrived.particles.bead = beads.data();
            for (std::size_t i = 0; i < particle.size(); ++i) arrived(static_cast<std::int64_t>(i));
        };
        put(particle_, x);
        put(lists.particle, in);
        put(lists.idle, lists.aside);
        EXPECT_EQ(own_ + lists.particle.size() + lists.idle.size(), particles);
        EXPECT_EQ(trouble, -1);
        std::vector<Vec3> of_particle(particles);
        for (std::size_t p = 0; p < particles; ++p)
            for (int c = 0; c < 3; ++c)
                of_particle[p][c] =
                    position[4 * static_cast<std::size_t>(place[p]) + static_cast<std::size_t>(c)];
        context.set_positions(of_particle, own_);
        auto const all = context.forces();
        std::vector<Vec3> forces;
        for (int const p : particle_) {
            auto const& f = all[static_cast<std::size_t>(p)];
            forces.push_back({{f[0], f[1], f[2]}});
        }
        return forces;
    }

    Halo& halo_;
    Forces& forces_;
    std::vector<int> particle_;  // of own beads
    std::size_t own_;
    std::optional<Vec3> box_;
    bool has_lists_ = false;
    int contexts_ = 0;
    ShownTable table_;
    std::vector<Vec3> out_, listed_;
    std::int64_t far_ = 0, trouble_ = -1;
};

/// Sums of the same doubles in another order: relative to the largest force.
double constexpr same = 1e-12;

/// Chains side by side along a box or in the open that swing, and drift past each other.
std::vector<Vec3> moved(BeadSystem const& beads, int step) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> pace(0.02, 0.06), phase(0, 6.28), drift(-0.05, 0.05);
    std::vector<Vec3> x;
    for (std::size_t c = 0; c + 1 < beads.chain_offset.size(); ++c) {
        double const speed = drift(random);
        for (std::int64_t k = beads.chain_offset[c]; k < beads.chain_offset[c + 1]; ++k) {
            double const along = static_cast<double>(k - beads.chain_offset[c]);
            Vec3 at{{4.0 * static_cast<double>(c) + 0.8 * std::fmod(along, 5),
                     0.9 * std::floor(along / 5), 1.5}};
            for (double& y : at.data) y += 0.15 * std::sin(pace(random) * step + phase(random));
            at[0] += speed * step;
            x.push_back(at);
        }
    }
    return x;
}

struct Walk {
    std::int64_t rebuilds = 0, changes = 0, contexts = 0, largest = 0, ghosts = 0;
    int joined = 0;  // pairs of ghosts that are one molecule to OpenMM
};

int joined_ghosts(HaloForces& forces, int own) {
    if (own == 0) return 0;
    auto const& pairs = dynamic_cast<OpenMM::CustomNonbondedForce const&>(
        forces.computing()->context().getSystem().getForce(0));
    int joined = 0;
    for (int i = 0; i < pairs.getNumExclusions(); ++i) {
        int a, b;
        pairs.getExclusionParticles(i, a, b);
        joined += a >= own && b >= own ? 1 : 0;
    }
    return joined;
}

using Places = std::function<std::vector<Vec3>(BeadSystem const&, int)>;  // of all beads at a step

Walk walk(OpenMmSpec const& spec, BeadSystem const& all_beads, int steps,
          Communicator const& communicator, Places const& places = moved) {
    BeadSystem const beads = split(all_beads, communicator.size());
    std::int64_t const first = beads.first_of_rank[communicator.rank()];
    OpenMmModel const model =
        spec.system.empty() ? calvados2_model(spec, beads) : system_model(spec, beads);
    OpenMmPlatform const platform = choose_platform(spec, beads, communicator, -1);
    std::optional<Vec3> const box =
        model.system->usesPeriodicBoundaryConditions() ? beads.box : std::nullopt;
    HaloForces forces({model, platform, beads, communicator, box, true});
    auto const own = static_cast<std::size_t>(beads.first_of_rank[communicator.rank() + 1] - first);
    PlainMemory memory(forces);
    OpenMmSpec replicated = spec;
    replicated.replicate = true;
    auto const oracle = make_openmm_force(replicated, beads, communicator);
    for (int step = 0; step <= steps; ++step) {
        std::vector<Vec3> const x = places(beads, step);
        if (step % 7 == 3) forces.renew_ghosts();
        auto const found = memory.evaluate(
            {x.begin() + first, x.begin() + first + static_cast<std::ptrdiff_t>(own)});
        if (step % 3 != 0) continue;
        auto const expected = catena::testing::evaluate(*oracle, beads, communicator.rank(), x);
        EXPECT_EQ(found.size(), expected.size());
        EXPECT_LE(difference(found, expected), same * communicator.max(largest(expected)))
            << "step " << step << " on " << communicator.size() << " ranks, from bead " << first;
    }
    int const joined = spec.system.empty() ? joined_ghosts(forces, static_cast<int>(own)) : 0;
    return {forces.traffic().rebuilds, memory.contexts(),       forces.contexts(),
            forces.largest_context(),  forces.traffic().ghosts, joined};
}

BeadSystem eight_chains(std::optional<Vec3> const& box) {
    std::vector<std::string> sequences;
    for (std::uint64_t c = 0; c < 8; ++c) sequences.push_back(random_sequence(25, c));
    return proteins(sequences, 1, box);
}

TEST(Halo, ForcesAreThoseOfTheReplicatedSystem) {
    for (std::optional<Vec3> const& box :
         {std::optional<Vec3>{}, std::optional<Vec3>{Vec3{{40, 8.5, 8.2}}}})
        on_ranks([&](Communicator const& communicator) {
            Walk const w = walk(on_reference(), eight_chains(box), 120, communicator);
            EXPECT_GT(w.rebuilds, 120 / 7);
            EXPECT_LT(w.rebuilds, 60);
            EXPECT_LE(w.contexts, 4);
            if (communicator.size() > 1) {
                EXPECT_LT(w.changes, w.rebuilds / 2 + 1);
            }
        });
}

/// Chains alike go in pieces where they are whole on a rank; of 45, some are cut.
TEST(Halo, ChainsThatAreAlikeGoInPieces) {
    std::string const one = random_sequence(36, 31), other = random_sequence(20, 32);
    std::vector<std::string> sequences;
    for (int c = 0; c < 45; ++c) sequences.push_back(c % 2 == 0 ? one : other);
    for (std::optional<Vec3> const& box :
         {std::optional<Vec3>{}, std::optional<Vec3>{Vec3{{190, 8.5, 8.2}}}})
        on_ranks([&](Communicator const& communicator) {
            Walk const w = walk(on_reference(), proteins(sequences, 1, box), 24, communicator);
            EXPECT_GT(w.rebuilds, 24 / 7);
            EXPECT_EQ(w.joined > 0, communicator.size() > 1);
            EXPECT_LE(w.contexts, 4);
        });
}

/// Every second chain comes while the others go: there are no slots of its kinds, but as many of
/// their lengths.
TEST(Halo, PiecesTakeSlotsOfOtherKinds) {
    std::string const one = random_sequence(40, 33), other = random_sequence(40, 34);
    std::vector<std::string> sequences;
    for (int c = 0; c < 80; ++c) sequences.push_back(c % 2 == 0 ? one : other);
    Places const places = [](BeadSystem const& beads, int step) {
        std::vector<Vec3> x;
        for (std::int64_t b = 0; b < beads.size(); ++b) {
            std::int64_t const chain = b / 40, k = b % 40;
            bool const is_near = (chain % 2 == 0) == (step >= 6);
            x.push_back({{0.8 * static_cast<double>(k % 5) + 4.0 * static_cast<double>(chain % 40),
                          0.9 * static_cast<double>(k / 5),
                          (chain >= 40 ? is_near ? 2.0 : 40.0 : 0.0) +
                              0.1 * static_cast<double>(step % 2)}});
        }
        return x;
    };
    on_ranks([&](Communicator const& communicator) {
        Walk const w = walk(on_reference(), proteins(sequences, 1, Vec3{{170, 20, 90}}), 9,
                            communicator, places);
        if (communicator.size() != 2 || communicator.rank() != 0) return;
        EXPECT_EQ(w.contexts, 1);
        EXPECT_EQ(w.changes, 2);
        EXPECT_EQ(w.joined, 20 * (31 + 7));
    });
}

/// All of them come: a Context is made anew, and again where no place is left for particles that
/// align the slots.
TEST(Halo, MorePiecesThanSlots) {
    std::vector<std::string> const sequences(80, random_sequence(40, 35));
    Places const places = [](BeadSystem const& beads, int step) {
        std::vector<Vec3> x;
        for (std::int64_t b = 0; b < beads.size(); ++b) {
            std::int64_t const chain = b / 40, k = b % 40;
            bool const is_near = step >= 3 && (chain < 79 || step >= 6);
            x.push_back({{0.8 * static_cast<double>(k % 5) + 4.0 * static_cast<double>(chain % 40),
                          0.9 * static_cast<double>(k / 5),
                          chain >= 40 ? is_near       ? 2.0
                                        : chain == 40 ? 4.0
                                                      : 40.0
                                      : 0.0}});
        }
        return x;
    };
    on_ranks([&](Communicator const& communicator) {
        Walk const w = walk(on_reference(), proteins(sequences, 1, Vec3{{170, 20, 90}}), 9,
                            communicator, places);
        if (communicator.size() != 2) return;
        EXPECT_EQ(w.contexts, communicator.rank() == 0 ? 3 : 2);
        EXPECT_EQ(w.ghosts, 40 * 40);
    });
}

TEST(Halo, EveryForce) {
    BeadSystem const beads =
        proteins({random_sequence(40, 7), random_sequence(20, 8), random_sequence(30, 9)}, 1,
                 Vec3{{34, 6, 6}});
    OpenMmSpec spec = on_reference("");
    spec.system = scratch_file("halo.xml", xml_of(*every_force(beads)));
    on_ranks([&](Communicator const& communicator) { walk(spec, beads, 15, communicator); });
}

/// Exceptions that do not look for nearest images, of chains that reach beyond a face of the box:
/// no bead may be moved by itself.
TEST(Halo, ExceptionsAcrossAFace) {
    BeadSystem const beads = eight_chains(Vec3{{40, 3, 8.2}});
    OpenMM::System system;
    for (double const mass : beads.mass) system.addParticle(mass);
    system.setDefaultPeriodicBoxVectors({(*beads.box)[0], 0, 0}, {0, (*beads.box)[1], 0},
                                        {0, 0, (*beads.box)[2]});
    auto* charges = new OpenMM::NonbondedForce;
    charges->setNonbondedMethod(OpenMM::NonbondedForce::CutoffPeriodic);
    charges->setCutoffDistance(1.4);
    for (std::int64_t i = 0; i < beads.size(); ++i)
        charges->addParticle(0.2 * static_cast<double>(i % 5 - 2), 0.3, 0.5);
    for (int i = 0; i + 5 < static_cast<int>(beads.size()); i += 3)
        if (i % 25 < 20) charges->addException(i, i + 5, 0.3, 0.4, 0.1);
    charges->setExceptionsUsePeriodicBoundaryConditions(false);
    system.addForce(charges);
    OpenMmSpec spec = on_reference("");
    spec.system = scratch_file("face.xml", xml_of(system));
    on_ranks([&](Communicator const& communicator) { walk(spec, beads, 15, communicator); });
}

/// On the host nobody has a share: each rank computes all pairs, and what is sent back adds up to
/// so many times the forces.
TEST(Pairs, EveryBeadIsOnEachRank) {
    for (std::optional<Vec3> const& box :
         {std::optional<Vec3>{}, std::optional<Vec3>{Vec3{{40, 8.5, 8.2}}}})
        on_ranks([&](Communicator const& communicator) {
            if (communicator.size() == 1) return;
            BeadSystem const beads = split(eight_chains(box), communicator.size());
            OpenMmSpec spec = on_reference();
            OpenMmModel const model = calvados2_model(spec, beads);
            EXPECT_EQ(why_not_by_pairs(*model.system), "");
            PairForces forces({model, choose_platform(spec, beads, communicator, -1), beads,
                               communicator, beads.box, true});
            PlainMemory memory(forces);
            EXPECT_EQ(forces.groups_of_share(), 3);
            spec.replicate = true;
            auto const oracle = make_openmm_force(spec, beads, communicator);
            auto const begin = beads.first_of_rank[communicator.rank()],
                       end = beads.first_of_rank[communicator.rank() + 1];
            for (int step = 0; step <= 12; ++step) {
                std::vector<Vec3> const x = moved(beads, step);
                if (step == 7) forces.renew_ghosts();
                if (step == 5) {
                    std::vector<std::int64_t> backwards;
                    for (std::int64_t k = end - begin; k-- > 0;) backwards.push_back(k);
                    memory.send_in(backwards, {x.begin() + begin, x.begin() + end});
                    EXPECT_EQ(forces.lists().sent, backwards);
                }
                auto const found = memory.evaluate({x.begin() + begin, x.begin() + end});
                auto const expected =
                    catena::testing::evaluate(*oracle, beads, communicator.rank(), x);
                double const tolerance = same * communicator.max(largest(expected));
                EXPECT_LE(difference(found, expected), tolerance)
                    << "step " << step << " on " << communicator.size() << " ranks";
                std::vector<Vec3> summed = forces.forces_again();
                for (Vec3& f : summed) f = (1.0 / communicator.size()) * f;
                EXPECT_LE(difference(summed, expected), tolerance)
                    << "step " << step << " on " << communicator.size() << " ranks";
            }
            GhostTraffic const traffic = forces.traffic();
            EXPECT_EQ(traffic.rebuilds, 2);
            EXPECT_EQ(traffic.updates, 13);
            EXPECT_EQ(traffic.ghosts, beads.size() - (end - begin));
            EXPECT_EQ(traffic.messages, 2 * 13 * (communicator.size() - 1));
        });
}

/// On the host nobody has a share of pairs; all that is no pair's is the first rank's: bonds, and
/// what energies have beyond the cutoff.
TEST(Pairs, EnergiesAreAddedUp) {
    on_ranks([&](Communicator const& communicator) {
        if (communicator.size() == 1) return;
        BeadSystem const beads = split(eight_chains(Vec3{{40, 8.5, 8.2}}), communicator.size());
        OpenMmSpec const spec = on_reference();
        OpenMmPlatform const platform = choose_platform(spec, beads, communicator, -1);
        auto const model_with = [&](bool corrections) {
            OpenMmModel model = calvados2_model(spec, beads);
            auto* charges = new OpenMM::NonbondedForce;
            charges->setNonbondedMethod(OpenMM::NonbondedForce::CutoffPeriodic);
            charges->setCutoffDistance(1.4);
            charges->setUseDispersionCorrection(corrections);
            for (std::int64_t i = 0; i < beads.size(); ++i)
                charges->addParticle(0.2 * static_cast<double>(i % 5 - 2), 0.3, 0.5);
            auto* attraction = new OpenMM::CustomNonbondedForce("-(0.3/r)^6");
            attraction->setNonbondedMethod(OpenMM::CustomNonbondedForce::CutoffPeriodic);
            attraction->setCutoffDistance(1.4);
            attraction->setUseLongRangeCorrection(corrections);
            for (std::int64_t i = 0; i < beads.size(); ++i) attraction->addParticle({});
            auto* bonds = new OpenMM::HarmonicBondForce;
            for (int i = 0; i + 1 < static_cast<int>(beads.size()); i += 7)
                bonds->addBond(i, i + 1, 0.3, 1000);
            for (OpenMM::Force* force :
                 std::initializer_list<OpenMM::Force*>{charges, attraction, bonds}) {
                force->setForceGroup(model.system->getNumForces());
                model.system->addForce(force);
            }
            return model;
        };
        std::vector<Vec3> const x = moved(beads, 3);
        auto const energies_of = [&](OpenMmModel const& model) {
            ForceContext context(model.system, platform, beads.box);
            context.set_positions(x, x.size());
            std::vector<double> energies(5);
            context.find_energies(energies);
            return energies;
        };
        OpenMmModel const plain = model_with(false), corrected = model_with(true);
        std::vector<double> const of_pairs = energies_of(plain), of_all = energies_of(corrected);
        PairForces forces({corrected, platform, beads, communicator, beads.box});
        EXPECT_EQ(forces.groups_of_share(), communicator.rank() == 0 ? 31 : 15);
        PlainMemory memory(forces);
        memory.evaluate({x.begin() + beads.first_of_rank[communicator.rank()],
                         x.begin() + beads.first_of_rank[communicator.rank() + 1]});
        std::vector<double> found(5);
        forces.find_energies(nullptr, found);
        for (std::size_t i = 0; i < found.size(); ++i) {
            double const beyond = of_all[i] - of_pairs[i];
            EXPECT_EQ(std::abs(beyond) > 1e-6 * std::abs(of_all[i]), i == 2 || i == 3) << i;
            double const expected = (i == 4 ? 1 : communicator.size()) * of_pairs[i] + beyond;
            EXPECT_NEAR(found[i], expected, 1e-10 * (1 + std::abs(expected)))
                << i << " on " << communicator.size() << " ranks";
        }
    });
}

TEST(Pairs, WhatCannotBeSharedOut) {
    EXPECT_EQ(why_not_by_pairs(OpenMM::System()), "no force acts between pairs");
    OpenMM::System grouped;
    auto* pairs = new OpenMM::CustomNonbondedForce("r");
    pairs->setNonbondedMethod(OpenMM::CustomNonbondedForce::CutoffNonPeriodic);
    grouped.addForce(pairs);
    EXPECT_EQ(why_not_by_pairs(grouped), "");
    pairs->addInteractionGroup({0}, {1});
    EXPECT_EQ(why_not_by_pairs(grouped), "CustomNonbondedForce has interaction groups");
    OpenMM::System system;
    system.addForce(new OpenMM::HarmonicBondForce);
    auto* charges = new OpenMM::NonbondedForce;
    system.addForce(charges);
    for (int i = 0; i < 2; ++i) {
        system.addParticle(1);
        charges->addParticle(1, 0.3, 0.5);
    }
    EXPECT_EQ(why_not_by_pairs(system), "NonbondedForce has no cutoff");
    charges->setNonbondedMethod(OpenMM::NonbondedForce::CutoffNonPeriodic);
    EXPECT_EQ(why_not_by_pairs(system), "");
    charges->addException(0, 1, 0, 0.3, 0);
    EXPECT_EQ(why_not_by_pairs(system), "");
    charges->setExceptionParameters(0, 0, 1, 0, 0.3, 0.1);
    EXPECT_EQ(why_not_by_pairs(system), "NonbondedForce has exceptions that act");
    charges->setNonbondedMethod(OpenMM::NonbondedForce::PME);
    EXPECT_EQ(why_not_by_pairs(system), "NonbondedForce cannot be split");
}

TEST(Halo, FewerBeadsThanRanks) {
    on_ranks([&](Communicator const& communicator) {
        walk(on_reference(), proteins({"KD", "E"}), 15, communicator);
    });
}

TEST(Halo, ABeadInTroubleIsEverybodysMessage) {
    BeadSystem const all_beads = proteins({random_sequence(30, 4)});
    on_ranks([&](Communicator const& communicator) {
        BeadSystem const beads = split(all_beads, communicator.size());
        OpenMmSpec const spec = on_reference();
        OpenMmModel const model = calvados2_model(spec, beads);
        OpenMmPlatform const platform = choose_platform(spec, beads, communicator, -1);
        HaloForces forces({model, platform, beads, communicator, std::nullopt, false});
        bool const last = communicator.rank() + 1 == communicator.size();
        std::string message;
        try {
            forces.are_used_up(false, last ? 28 : -1);
        } catch (SharedError const& e) {
            message = e.what();
        }
        EXPECT_EQ(message,
                  "the position of bead 29, or OpenMM's force on it, is not finite: use a smaller "
                  "dynamics.step, or a start without overlaps");
        EXPECT_THROW(forces.refuse_trouble(last ? 0 : -1), SharedError);
        EXPECT_NO_THROW(forces.refuse_trouble(-1));
    });
}

}  // namespace
}  // namespace catena::testing
