// Implements the clustering of residues. The chain of nearest neighbours (Benzecri 1982, Murtagh
// 1983) finds all joins of average linkage in a time of the square of the number of residues. Joins
// above the threshold cannot precede others below it, since mean errors only grow.
#include "domains/confident_domains.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

namespace catena::scene {

namespace {

/// Average linkage over all residues of a list.
class Clustering {
  public:
    Clustering(std::vector<std::size_t> residues, PredictedError const& error)
        : residues_(std::move(residues)), count_(residues_.size()) {
        mean_.resize(count_ * count_);
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t j = 0; j < count_; ++j)
                mean_[i * count_ + j] = error.at(residues_[i], residues_[j]);
        size_.assign(count_, 1);
        root_.resize(count_);
        std::iota(root_.begin(), root_.end(), std::size_t{0});
    }

    /// Clusters of residues, each ascending, in the order of their first residues.
    std::vector<std::vector<std::size_t>> joined_up_to(double most) {
        std::vector<std::size_t> chain;
        for (std::size_t next = 0; next < count_;) {
            if (chain.empty()) {
                if (size_[next] == 0) {
                    ++next;
                    continue;
                }
                chain.push_back(next);
            }
            std::size_t const last = chain.back(),
                              before = chain.size() > 1 ? chain[chain.size() - 2] : count_;
            std::size_t const nearest = nearest_of(last, before);
            if (nearest == count_) break;  // one cluster is left
            if (nearest != before) {
                chain.push_back(nearest);
                continue;
            }
            chain.resize(chain.size() - 2);
            join(std::min(last, nearest), std::max(last, nearest), most);
        }
        return clusters();
    }

  private:
    /// The cluster of least mean error; `preferred` among equals, then the first.
    std::size_t nearest_of(std::size_t from, std::size_t preferred) const {
        std::size_t best = count_;
        double least = std::numeric_limits<double>::infinity();
        if (preferred < count_) best = preferred, least = mean_[from * count_ + preferred];
        for (std::size_t k = 0; k < count_; ++k)
            if (k != from && size_[k] > 0 && mean_[from * count_ + k] < least)
                best = k, least = mean_[from * count_ + k];
        return best;
    }
    /// Joins b to a in the tree; their residues become one cluster if the mean is small enough.
    void join(std::size_t a, std::size_t b, double most) {
        if (mean_[a * count_ + b] <= most) root_[find(b)] = find(a);
        double const na = static_cast<double>(size_[a]), nb = static_cast<double>(size_[b]);
        for (std::size_t k = 0; k < count_; ++k) {
            if (k == a || k == b || size_[k] == 0) continue;
            double const mean =
                (na * mean_[a * count_ + k] + nb * mean_[b * count_ + k]) / (na + nb);
            mean_[a * count_ + k] = mean_[k * count_ + a] = mean;
        }
        size_[a] += size_[b];
        size_[b] = 0;
    }
    std::size_t find(std::size_t k) const {
        while (root_[k] != k) k = root_[k];
        return k;
    }
    std::vector<std::vector<std::size_t>> clusters() const {
        std::vector<std::vector<std::size_t>> clusters;
        std::vector<std::size_t> place(count_, count_);
        for (std::size_t k = 0; k < count_; ++k) {
            std::size_t& at = place[find(k)];
            if (at == count_) {
                at = clusters.size();
                clusters.emplace_back();
            }
            clusters[at].push_back(residues_[k]);
        }
        return clusters;
    }

    std::vector<std::size_t> residues_;
    std::size_t count_;
    /// Mean error between two clusters.
    std::vector<double> mean_;
    /// Number of residues of a cluster; 0 for one that was joined to another.
    std::vector<std::size_t> size_;
    std::vector<std::size_t> root_;
};

/// Segments of ascending residues, joined across short loops.
std::vector<Segment> segments_of(std::vector<std::size_t> const& residues, std::size_t loop) {
    std::vector<Segment> segments;
    for (std::size_t const k : residues)
        if (!segments.empty() && k - segments.back()[1] <= loop + 1)
            segments.back()[1] = k;
        else
            segments.push_back({k, k});
    return segments;
}

}  // namespace

ConfidentDomains confident_domains(std::vector<double> const& plddt, PredictedError const& error,
                                   DomainThresholds const& thresholds) {
    std::vector<std::size_t> known;
    for (std::size_t k = 0; k < plddt.size(); ++k)
        if (plddt[k] >= thresholds.plddt) known.push_back(k);
    ConfidentDomains made;
    for (auto const& cluster : Clustering(known, error).joined_up_to(thresholds.pae)) {
        std::vector<Segment> domain;
        for (Segment const& segment :
             segments_of(cluster, static_cast<std::size_t>(thresholds.longest_loop))) {
            auto const length = static_cast<std::int64_t>(segment[1] - segment[0] + 1);
            (length >= thresholds.min_length ? domain : made.short_segments).push_back(segment);
        }
        if (!domain.empty()) made.domains.push_back(domain);
    }
    std::sort(made.domains.begin(), made.domains.end());
    std::sort(made.short_segments.begin(), made.short_segments.end());
    return made;
}

}  // namespace catena::scene
