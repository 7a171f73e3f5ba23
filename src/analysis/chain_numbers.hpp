// Accumulates what one kind of chains shows, frame by frame.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/analysis.hpp"
#include "analysis/chain_size.hpp"
#include "analysis/even_frames.hpp"

namespace catena::analysis {

/// Sizes, internal distances, bond correlation and displacement of all copies of a chain.
class ChainNumbers {
  public:
    ChainNumbers(Topology const&, Kind const&, std::int64_t frames);
    void add(Snapshot const&);
    /// Adds quantities, curves and series of this kind to an analysis. Complexes have no ends,
    /// bonds and separations of their own. `even`: frames whose interval of time is the first one.
    void report(Analysis&, Options const&, EvenFrames const& even) const;

  private:
    void report_sizes(Analysis&) const;
    /// Notes a chain whose size hardly varies.
    void note_folded(Analysis&) const;
    void report_distribution(Analysis&) const;
    void report_distances(Analysis&, Options const&) const;
    void report_bonds(Analysis&) const;
    void report_displacement(Analysis&, EvenFrames const& even) const;

    Topology const& topology_;
    Kind const& kind_;
    /// True if the chains have several members: their beads do not follow one backbone.
    bool is_complex_;
    CopyValues radius_, end_to_end_, asphericity_;
    InternalMeans internal_;
    std::vector<Vec3> centres_;  // [frame][copy]
};

}  // namespace catena::analysis
