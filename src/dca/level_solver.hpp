// The chapter's scheme on a GPU and a CPU together: the pairwise tree is cut twice, once for the
// way up (assembly) and once for the way down (disassembly). The lowest levels belong to one part,
// all others to a second one; segments cross the cut upwards, joint forces downwards. Neither part
// knows where the other one computes.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "dca/solver.hpp"

namespace catena::dca {

/// What one part does of a rank's schedule. Level l of the schedule is its l-th vector of merges,
/// [first, end) of them are the part's.
struct LevelWork {
    bool leaves_up = false,
         leaves_down = false;  // matrices and biases of the bodies; their accelerations
    std::size_t first_up = 0, end_up = 0, first_down = 0, end_down = 0;
    bool top = false;  // roots, and what is above the units of chains that ranks share: only where
                       // the host reads the memory
    bool leaves() const { return leaves_up || leaves_down; }
};

/// Views are of the host, whatever the part's memory is. What a member asks for is done when it
/// returns.
class LevelPart {
  public:
    enum class Items {
        matrices,
        biases,
        joints,
        offsets,
        forces
    };  // matrices and biases by slot, the others by joint
    virtual ~LevelPart() = default;
    virtual void set(ConfigurationView const&) = 0;
    virtual void set(LoadsView const&, AccelerationsView const&) = 0;
    virtual void assemble_matrices() = 0;
    virtual void close_matrices() = 0;  // of the top: its levels, then the roots
    virtual void assemble_biases() = 0;
    virtual void close_biases() = 0;  // of the top; back come the joint forces there
    virtual void disassemble() = 0;
    virtual void fetch() = 0;  // what was computed, into the host's views
    /// The first joint of this part whose matrix is not positive definite, or the number of joints.
    virtual std::int64_t first_indefinite() = 0;

    /// A list of slots or joints for get() and put(), which move the items there as plain numbers.
    virtual int choose(std::vector<std::int64_t> const& places) = 0;
    virtual void get(Items, int list, std::vector<double>& numbers) = 0;
    virtual void put(Items, int list, std::vector<double> const& numbers) = 0;
    virtual std::int64_t memory_bytes() const = 0;
    virtual int threads() const = 0;
};
using LevelPartMaker =
    std::function<std::unique_ptr<LevelPart>(ChainGroup const&, LevelWork const&)>;

/// On this host.
LevelPartMaker host_levels(Executor const&);

/// What crosses the cuts, `up` and `down` levels of merges being the lower part's.
struct LevelCut {
    std::vector<std::int64_t> segments;  // slots: the upper part's levels and roots start from them
    std::vector<std::int64_t> forces;    // joints: the lower part's disassembly starts from them
    std::vector<std::int64_t> joints_up,
        joints_down;  // eliminated by one part, disassembled by the other
};
LevelCut cut_levels(Schedule const&, GpuLevels);

/// The group's tree must be the pairwise one. Group, communicator and what the makers hold must
/// outlive the solver.
std::unique_ptr<ChainSolver> make_level_solver(ChainGroup const&, Communicator const&, GpuLevels,
                                               LevelPartMaker const& lower,
                                               LevelPartMaker const& upper);

}  // namespace catena::dca
