// Contact maps within and between chains, by cells.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "analysis/estimate.hpp"
#include "analysis/kinds.hpp"
#include "frames/trajectory_file.hpp"

namespace catena::analysis {

/// Probability that sites of two parts of chains are in contact.
struct ContactMap {
    struct Parts {
        bool within = false;                // sites of one chain; false: of two different chains
        std::size_t first = 0, second = 0;  // kinds of rows and columns
    };
    Parts parts;
    std::size_t rows = 0, columns = 0;
    /// Probabilities [row][column], means over frames and over copies (pairs of copies), and their
    /// standard errors from the scatter of up to 16 blocks of frames.
    std::vector<double> mean, error;
};

/// Scalars of the copies of a kind, [frame][copy].
struct ContactNumbers {
    CopyValues within, between;
};

/// Accumulates contacts of all frames. Sites are in contact if they are at most `cutoff` apart.
/// Within a chain the distance is that of the whole chain; between chains it is that of nearest
/// images. The time of a frame is proportional to the number of sites and of their neighbours.
class Contacts {
  public:
    /// Sites of a chain that are fewer than so many places (links) apart do not count in
    /// ContactNumbers::within. The maps hold all pairs.
    static constexpr std::int64_t least_separation = 3;

    /// Largest number of kinds for which there are maps between different kinds.
    static constexpr std::size_t most_paired_kinds = 32;

    Contacts(Topology const&, std::vector<Kind> const&, double cutoff, std::int64_t frames);
    ~Contacts();
    /// Throws InputError if the cutoff exceeds half an edge of the box.
    void add(Snapshot const&);

    /// Number of consecutive sites that share a row or column. It is 1 unless all kinds together
    /// have more than 1,000 sites.
    std::int64_t sites_a_row() const;
    /// Returns one map within each kind, then between all pairs of kinds that have two different
    /// chains.
    std::vector<ContactMap> maps() const;
    /// Returns numbers of contacts of a chain, by kind. A contact between two chains counts for
    /// both.
    std::vector<ContactNumbers> const& numbers() const;
    /// Number of pairs, over all frames, in which a chain is near its own periodic image. They are
    /// no contacts.
    std::int64_t own_images() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace catena::analysis
