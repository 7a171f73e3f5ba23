// Search for the chains, rings and trees that constraints form.
#include "plugin/constraint_chains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "error.hpp"
#include "joints/link.hpp"

namespace catena::plugin {
namespace {

/// Neighbours of every particle, with the distances to them.
class Neighbours {
  public:
    struct Link {
        std::int64_t particle;
        double distance;
    };
    Neighbours(std::size_t particles, std::vector<Constraint> const& constraints)
        : begin_(particles + 1, 0), links_(2 * constraints.size()) {
        for (Constraint const& c : constraints)
            ++begin_[std::size_t(c.first) + 1], ++begin_[std::size_t(c.second) + 1];
        for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
        std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
        for (Constraint const& c : constraints) {
            links_[next[std::size_t(c.first)]++] = {c.second, c.distance};
            links_[next[std::size_t(c.second)]++] = {c.first, c.distance};
        }
    }
    std::span<Link const> of(std::int64_t particle) const {
        auto const i = static_cast<std::size_t>(particle);
        return std::span(links_).subspan(begin_[i], begin_[i + 1] - begin_[i]);
    }

  private:
    std::vector<std::size_t> begin_;
    std::vector<Link> links_;
};

/// Particles that constraints join, and what they form.
struct Cluster {
    std::vector<std::int64_t> particles;
    std::size_t links = 0, most_links = 0;
    std::int64_t first_end = -1;  // A particle with one constraint.

    bool is_ring() const { return links == particles.size() && most_links == 2; }
    std::int64_t start() const { return first_end >= 0 ? first_end : particles.front(); }
};

/// Returns the cluster of a particle, and marks its particles as seen.
Cluster cluster_of(std::int64_t start, Neighbours const& neighbours, std::vector<char>& seen) {
    Cluster cluster;
    cluster.particles.push_back(start);
    seen[std::size_t(start)] = 1;
    std::size_t ends_of_links = 0;
    for (std::size_t i = 0; i < cluster.particles.size(); ++i) {
        std::int64_t const particle = cluster.particles[i];
        auto const links = neighbours.of(particle);
        ends_of_links += links.size();
        cluster.most_links = std::max(cluster.most_links, links.size());
        if (links.size() == 1 && (cluster.first_end < 0 || particle < cluster.first_end))
            cluster.first_end = particle;
        for (auto const& link : links)
            if (!std::exchange(seen[std::size_t(link.particle)], char{1}))
                cluster.particles.push_back(link.particle);
    }
    cluster.links = ends_of_links / 2;
    return cluster;
}

/// Appends a bead to a chain of the scene.
void add_bead(ChainSpec& chain, double mass, double length) {
    chain.beads.mass.push_back(mass);
    chain.beads.position.push_back(Vec3::zero());
    chain.beads.velocity.push_back(Vec3::zero());
    chain.beads.length.push_back(length);
}

/// Builder of the scene's chains.
class Chains {
  public:
    Chains(std::vector<double> const& mass, Neighbours const& neighbours)
        : mass_(mass), neighbours_(neighbours), bead_of_(mass.size(), -1) {}

    /// Appends a tree, from one of its ends on. Each bead follows the one on which it hangs.
    /// Constraints that close loops become cross-links.
    void add_tree(Cluster const& cluster) {
        ChainSpec chain;
        std::vector<Step> open{{cluster.start(), -1, 0}};
        while (!open.empty()) {
            Step const step = open.back();
            open.pop_back();
            if (bead_of_[std::size_t(step.particle)] >= 0) continue;  // reached by another link
            std::int64_t const bead = add(chain, step.particle, step.distance);
            chain.parent.push_back(step.parent);
            for (auto const& link : neighbours_.of(step.particle)) {
                std::int64_t const there = bead_of_[std::size_t(link.particle)];
                if (there < 0)
                    open.push_back({link.particle, bead, link.distance});
                else if (there != step.parent)
                    chain.crosslinks.push_back({there, bead, link.distance});
            }
        }
        if (cluster.most_links <= 2) chain.parent.clear();
        close(std::move(chain));
    }
    /// Appends a ring, from its lowest particle on.
    void add_ring(Cluster const& cluster) {
        ChainSpec chain;
        std::int64_t const first = cluster.particles.front();
        std::int64_t particle = first;
        double length = 0;
        while (particle >= 0) {
            add(chain, particle, length);
            std::int64_t next = -1;
            for (auto const& link : neighbours_.of(particle))
                if (next < 0 && bead_of_[std::size_t(link.particle)] < 0)
                    next = link.particle, length = link.distance;
            particle = next;
        }
        chain.tip = Tip::jointed;
        chain.tip_joint.ring = true;
        chain.tip_joint.type = LinkJoint::type;
        std::int64_t const last = chains_.particle.back();
        for (auto const& link : neighbours_.of(first))
            if (link.particle == last) chain.tip_joint.length = link.distance;
        close(std::move(chain));
    }
    ConstraintChains take() { return std::move(chains_); }

  private:
    struct Step {
        std::int64_t particle, parent;
        double distance;
    };
    std::int64_t add(ChainSpec& chain, std::int64_t particle, double length) {
        std::int64_t const bead = std::ssize(chain.beads.mass);
        bead_of_[std::size_t(particle)] = bead;
        add_bead(chain, mass_[std::size_t(particle)], length);
        chains_.particle.push_back(particle);
        return bead;
    }
    void close(ChainSpec chain) {
        chain.name = "constraints-" + std::to_string(chains_.scene.chains.size() + 1);
        chains_.scene.chains.push_back(std::move(chain));
    }

    std::vector<double> const& mass_;
    Neighbours const& neighbours_;
    std::vector<std::int64_t> bead_of_;  // Bead of each particle within its chain; -1: none yet.
    ConstraintChains chains_;
};

void check_distances(std::vector<Constraint> const& constraints) {
    for (std::size_t i = 0; i < constraints.size(); ++i)
        if (!(constraints[i].distance > 0) || !std::isfinite(constraints[i].distance))
            throw InputError(
                fmt::format("a constraint to the distance {} nm", constraints[i].distance),
                fmt::format("System, particles {} and {}", constraints[i].first,
                            constraints[i].second),
                "give a positive, finite distance");
}

}  // namespace

ConstraintChains constraint_chains(std::vector<double> const& mass,
                                   std::vector<Constraint> const& constraints) {
    check_distances(constraints);
    Neighbours const neighbours(mass.size(), constraints);
    Chains chains(mass, neighbours);
    std::vector<char> seen(mass.size(), 0);
    for (std::int64_t k = 0; k < std::ssize(mass); ++k) {
        if (seen[std::size_t(k)] || neighbours.of(k).empty()) continue;
        Cluster const cluster = cluster_of(k, neighbours, seen);
        if (cluster.is_ring())
            chains.add_ring(cluster);
        else
            chains.add_tree(cluster);
    }
    return chains.take();
}

}  // namespace catena::plugin
