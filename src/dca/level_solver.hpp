// The chapter's scheme for a GPU and a CPU together. The pairwise tree is cut twice, once for the
// inward pass (assembly) and once for the outward pass (disassembly). One part computes the lowest
// levels, a second part all others. Segments cross the cut inwards, joint forces outwards. Neither
// part depends on where the other one computes.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "dca/solver.hpp"

namespace catena::dca {

/// Work of one part on a rank's schedule. Level l is the l-th vector of merges of the schedule; the
/// part owns the levels [first, end).
struct LevelWork {
    /// True if the part computes the matrices and biases of the bodies, and their accelerations.
    bool leaves_up = false, leaves_down = false;
    std::size_t first_up = 0, end_up = 0, first_down = 0, end_down = 0;
    /// True if the part computes the roots and what is above the units of shared chains. Only a
    /// part in host memory can.
    bool top = false;
    bool leaves() const { return leaves_up || leaves_down; }
};

/// One part of the tree. All views are in host memory, whatever the memory of the part. Each member
/// returns when its work is complete.
class LevelPart {
  public:
    /// Records that can be transferred: matrices and biases are indexed by slot, the others by
    /// joint.
    enum class Items { matrices, biases, joints, offsets, forces };
    virtual ~LevelPart() = default;
    /// Sets the configuration; only parts with leaves need it.
    virtual void set(ConfigurationView const&) = 0;
    /// Sets the loads and the views for the results.
    virtual void set(LoadsView const&, AccelerationsView const&) = 0;
    /// Inward pass of the matrices over this part's leaves and levels.
    virtual void assemble_matrices() = 0;
    virtual void close_matrices() = 0;  // Computes the top: its levels, then the roots.
    /// Inward pass of the biases over this part's leaves and levels.
    virtual void assemble_biases() = 0;
    /// Computes the top and, in its outward pass, the joint forces there.
    virtual void close_biases() = 0;
    /// Outward pass over this part's levels and leaves, from the joint forces that it has.
    virtual void disassemble() = 0;
    virtual void fetch() = 0;  // Copies the results to the host's views.
    /// Returns the first joint of this part whose matrix is not positive definite, or the number of
    /// joints if there is none.
    virtual std::int64_t first_indefinite() = 0;

    /// Registers a list of slots or joints and returns its number. get() and put() copy the items
    /// of such a list as plain numbers.
    virtual int choose(std::vector<std::int64_t> const& places) = 0;
    virtual void get(Items, int list, std::vector<double>& numbers) = 0;
    virtual void put(Items, int list, std::vector<double> const& numbers) = 0;
    /// Returns the size of this part's arrays, in bytes.
    virtual std::int64_t memory_bytes() const = 0;
    virtual int threads() const = 0;
};
/// Makes a part that does the given work on a group.
using LevelPartMaker =
    std::function<std::unique_ptr<LevelPart>(ChainGroup const&, LevelWork const&)>;

/// Returns the maker of parts on this host. The executor must outlive them.
LevelPartMaker host_levels(Executor const&);

/// Items that cross the cuts. The lower part owns `up` levels of merges in the inward pass and
/// `down` levels in the outward pass.
struct LevelCut {
    /// Slots from which the upper part's levels and roots start.
    std::vector<std::int64_t> segments;
    /// Joints from whose forces the lower part's disassembly starts.
    std::vector<std::int64_t> forces;
    /// Joints that one part eliminates and the other disassembles.
    std::vector<std::int64_t> joints_up, joints_down;
};
/// Returns the items that cross the cuts for the given numbers of levels.
LevelCut cut_levels(Schedule const&, GpuLevels);

/// Returns the solver made of two parts. The group's tree must be the pairwise one. Group,
/// communicator and the objects that the makers refer to must outlive it.
std::unique_ptr<ChainSolver> make_level_solver(ChainGroup const&, Communicator const&, GpuLevels,
                                               LevelPartMaker const& lower,
                                               LevelPartMaker const& upper);

}  // namespace catena::dca
