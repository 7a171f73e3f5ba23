// Implements the relaxation of a start in two stages.
#include "start/start_relaxation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>
#include <vector>

#include "clock.hpp"
#include "error.hpp"
#include "generate/random.hpp"
#include "integrate/scene_beads.hpp"
#include "mpi/first_rank.hpp"
#include "start/descent.hpp"
#include "start/lone_forces.hpp"
#include "start/moving_chains.hpp"

namespace catena {
namespace {

double constexpr reach_of_contacts = 1;  // nm
double constexpr most_columns =
    1e4;  // cells of that width across the box: OpenMM spends a microsecond on each
std::int64_t constexpr most_of_contacts = 3000, window_of_contacts = 50;  // evaluations
double constexpr bead_evaluations =
    3e6;  // product of beads and evaluations with all forces: 300 evaluations of a slab of 10,000
          // beads take some minutes on a core
std::int64_t constexpr least_of_all = 200, most_of_all = 3000, window_of_all = 20;
double constexpr large_force = 400;  // kT/nm: larger than any force on a bead in thermal motion
int constexpr most_knocks = 8;
double constexpr knock_length = 0.06;  // nm: of the first knock
double constexpr least_fall = 0.02;    // ratio to the thermal energy, per window
double constexpr seconds_between_lines = 5;

/// Range of the forces between near beads, nm. Cells of OpenMM's neighbour lists are as wide as
/// that range. Short forces would therefore take longer in a wide box that is nearly empty.
double contact_reach(Scene const& scene, std::size_t beads) {
    if (!scene.box) return reach_of_contacts;
    Vec3 const& edge = *scene.box;
    double const widest = std::max({edge[0] * edge[1], edge[1] * edge[2], edge[0] * edge[2]});
    return std::max(reach_of_contacts,
                    std::sqrt(widest / std::max(most_columns, static_cast<double>(beads))));
}

/// Passes a line to the callback every few seconds of the whole relaxation.
class Teller {
  public:
    explicit Teller(RelaxationSays const& say) : say_(say) {}
    /// Callback of a descent along those forces.
    Descent::ProgressCallback of(char const* forces) {
        return [this, forces](std::int64_t evaluations, double energy) {
            if (!say_ || seconds_now() - last_ < seconds_between_lines) return;
            last_ = seconds_now();
            say_(fmt::format("relaxation, {}: {} evaluations, {:.0f} s, energy {:.6g} kJ/mol",
                             forces, evaluations, last_ - start_, energy));
        };
    }

  private:
    RelaxationSays const& say_;
    double start_ = seconds_now(), last_ = start_;
};

/// Largest distance between corresponding points.
double furthest(std::vector<Vec3> const& a, std::vector<Vec3> const& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, norm(a[i] - b[i]));
    return most;
}

/// Relaxation of a start by one rank.
class Relaxation {
  public:
    Relaxation(Scene const& scene, std::vector<MovingChain>& chains, RelaxationSays const& say)
        : scene_(scene),
          chains_(chains),
          teller_(say),
          all_(scene),
          at_(bead_positions_of(scene)),
          large_force_(large_force * scene.boltzmann() * scene.forces.openmm->temperature) {}

    /// Separates overlaps by forces between near beads, which cost little, then minimises the
    /// energy of all forces. Beads that are caught between links, or in a balance of large forces,
    /// are knocked out of it and relaxed again, a few times, or once if the energy stays infinite
    /// or NaN. Throws InputError if that fails.
    StartRelaxation run() {
        std::vector<Vec3> const given = at_;
        StartRelaxation found;
        found.from = found.to = look();
        refuse_undefined(found.from.energy);
        for (int knocks = 0;; ++knocks) {
            descend(found);
            found.to = look();
            bool const hopeless = knocks > 0 && !std::isfinite(found.to.energy);
            if (!found.to.is_absurd() || hopeless || knocks == most_knocks) break;
            knock(knocks);
        }
        found.moved = furthest(given, at_);
        refuse_absurd(scene_, found.to, found.way_text());
        return found;
    }

  private:
    StartForces look() {
        SingleRankForces::EnergyAndForces found = all_.at(at_);
        forces_ = std::move(found.forces);
        return start_forces_of(scene_, all_.beads(), at_, forces_, found.energy);
    }

    /// Throws InputError for positions that no descent improves, because only the energy is not
    /// finite.
    void refuse_undefined(double energy) {
        if (std::isfinite(energy) || !all_.are_finite()) return;
        StartForces const found =
            start_forces_of(scene_, all_.beads(), at_, all_.forces(at_), energy);
        if (found.is_undefined()) refuse_absurd(scene_, found);
    }

    void descend(StartRelaxation& found) {
        double const kt = scene_.boltzmann() * scene_.forces.openmm->temperature,
                     fall = least_fall * found.from.thermal;
        {
            SingleRankForces near(scene_, contact_reach(scene_, at_.size()));
            Descent descent(chains_, near, at_);
            found.steps += descent
                               .run({most_of_contacts, window_of_contacts, fall, large_force_, kt},
                                    teller_.of("forces between near beads"))
                               .evaluations;
        }
        auto const affordable =
            static_cast<std::int64_t>(bead_evaluations / static_cast<double>(at_.size()));
        Descent descent(chains_, all_, at_);
        Descent::Ended const ended = descent.run({std::clamp(affordable, least_of_all, most_of_all),
                                                  window_of_all, fall, large_force_, kt},
                                                 teller_.of("all forces"));
        found.steps += ended.evaluations;
        found.at_rest = ended.at_rest;
    }

    /// Moves the units that feel large forces, each in a random direction. Later knocks are longer.
    void knock(int number) {
        double const way = knock_length * (1 + number);
        for (std::size_t c = 0; c < chains_.size(); ++c) {
            std::vector<UnitMotion> by(chains_[c].units());
            scene::Draws draws(static_cast<std::uint64_t>(number), static_cast<std::int64_t>(c));
            for (std::size_t u = 0; u < by.size(); ++u)
                if (!(norm(chains_[c].acceleration(u, forces_).shift) <= large_force_))
                    by[u].shift = way * draws.on_sphere();
            chains_[c].move(by);  // leaves the chain as it is if its links cannot be closed
            chains_[c].put_beads(at_);
        }
    }

    Scene const& scene_;
    std::vector<MovingChain>& chains_;
    Teller teller_;
    SingleRankForces all_;
    /// Positions of all beads and the forces there.
    std::vector<Vec3> at_, forces_;
    double large_force_;  // kJ/mol/nm
};

}  // namespace

std::string StartRelaxation::text() const {
    return fmt::format("{}: from {} to {}", way_text(), from.text(), to.text());
}

std::string StartRelaxation::way_text() const {
    return fmt::format("{} evaluations{}, beads moved by up to {:.3g} nm", steps,
                       at_rest ? "" : ", the maximum", moved);
}

RelaxationSays relaxation_says(bool quiet) {
    if (quiet) return {};
    return [](std::string const& line) { std::fprintf(stderr, "catena: %s\n", line.c_str()); };
}

RelaxedScene relax_start(Scene const& scene, Communicator const& communicator,
                         RelaxationSays const& say) {
    if (!scene.forces.openmm)
        throw InputError("`relax` needs forces between beads, the scene has no forces.openmm",
                         scene.file + ": relax", "leave it out, or add `forces: {openmm: ...}`");
    RelaxedScene made{scene, {}};
    std::vector<MovingChain> chains = moving_chains(made.scene);
    on_first_rank(communicator, [&] { made.relaxation = Relaxation(scene, chains, say).run(); });
    for (MovingChain& chain : chains) {
        for (std::span<std::byte> const part : chain.bytes()) communicator.broadcast(part);
        chain.write();
    }
    return made;
}

std::optional<RelaxedScene> relaxed_where_asked(Scene const& scene,
                                                Communicator const& communicator,
                                                RelaxationSays const& say) {
    return scene.relax ? std::optional(relax_start(scene, communicator, say)) : std::nullopt;
}

}  // namespace catena
