// Solver whose pairwise tree is cut between two parts, one for the lowest levels and one for all
// others (level_solver.hpp).
#include "dca/level_solver.hpp"

#include <algorithm>

#include "clock.hpp"

namespace catena::dca {
namespace {

using Items = LevelPart::Items;

/// Returns the number of levels, limited to those of the schedule.
std::size_t within(int levels, Schedule const& schedule) {
    return std::min(static_cast<std::size_t>(levels), schedule.levels.size());
}

/// Adds the seconds since the previous call, or since construction, to one of the sums.
class Clock {
  public:
    void to(double& sum) {
        double const moment = seconds_now();
        sum += moment - last_;
        last_ = moment;
    }

  private:
    double last_ = seconds_now();
};

/// Runs both parts and transfers segments, forces and joints between them.
class LevelSolver final : public ChainSolver {
  public:
    /// Makes both parts and registers the lists of records that cross the cuts.
    LevelSolver(ChainGroup const& group, Communicator const& communicator, GpuLevels levels,
                LevelPartMaker const& lower, LevelPartMaker const& upper)
        : group_(group), communicator_(communicator), has_lower_(levels.up > 0 || levels.down > 0) {
        Schedule const& s = group.schedule;
        std::size_t const up = within(levels.up, s), down = within(levels.down, s);
        lower_.part = lower(group, {levels.up > 0, levels.down > 0, 0, up, 0, down, false});
        upper_.part = upper(group, {levels.up == 0, levels.down == 0, up, s.levels.size(), down,
                                    s.levels.size(), true});
        LevelCut const cut = cut_levels(s, levels);
        for (Side* side : {&lower_, &upper_}) {
            side->segments = side->part->choose(cut.segments);
            side->forces = side->part->choose(cut.forces);
            side->joints_up = side->part->choose(cut.joints_up);
            side->joints_down = side->part->choose(cut.joints_down);
        }
        std::vector<std::int64_t> own, all;
        for (FrontierUnit const& unit : s.shared) {
            if (unit.is_own) own.push_back(unit.slot);
            all.push_back(unit.slot);
        }
        own_units_ = upper_.part->choose(own);
        all_units_ = upper_.part->choose(all);
    }

    /// Matrix sweep: lower part, transfer of segments, upper part with the exchange between ranks,
    /// transfer of joints.
    void assemble_matrices(ConfigurationView const& configuration) override {
        double const start = seconds_now();
        SplitSeconds& spent = report_.split;
        Clock clock;
        lower_.part->set(configuration);
        clock.to(spent.upload);
        lower_.part->assemble_matrices();
        clock.to(spent.lower_assembly);
        lower_.part->get(Items::matrices, lower_.segments, segments_);
        lower_.part->get(Items::joints, lower_.joints_up, joints_up_);
        clock.to(spent.download);
        upper_.part->set(configuration);
        upper_.part->put(Items::matrices, upper_.segments, segments_);
        upper_.part->put(Items::joints, upper_.joints_up, joints_up_);
        upper_.part->assemble_matrices();
        gather_shared(Items::matrices);
        upper_.part->close_matrices();
        upper_.part->get(Items::joints, upper_.joints_down, joints_down_);
        clock.to(spent.upper_assembly);
        lower_.part->put(Items::joints, lower_.joints_down, joints_down_);
        clock.to(spent.upload);
        ++report_.matrix_sweeps;
        std::int64_t bad = upper_.part->first_indefinite();
        if (has_lower_) bad = std::min(bad, lower_.part->first_indefinite());
        report_.matrix_seconds += seconds_now() - start;
        if (bad < group_.schedule.joints) refuse_indefinite(group_, communicator_.rank(), bad);
    }

    /// Bias sweep and disassembly: lower part, upper part with the exchange between ranks, lower
    /// part.
    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        double const start = seconds_now();
        SplitSeconds& spent = report_.split;
        Clock clock;
        lower_.part->set(loads, out);
        clock.to(spent.upload);
        lower_.part->assemble_biases();
        clock.to(spent.lower_assembly);
        lower_.part->get(Items::biases, lower_.segments, segments_);
        lower_.part->get(Items::offsets, lower_.joints_up, joints_up_);
        clock.to(spent.download);
        upper_.part->set(loads, out);
        upper_.part->put(Items::biases, upper_.segments, segments_);
        upper_.part->put(Items::offsets, upper_.joints_up, joints_up_);
        upper_.part->assemble_biases();
        gather_shared(Items::biases);
        upper_.part->close_biases();
        clock.to(spent.upper_assembly);
        upper_.part->disassemble();
        upper_.part->get(Items::forces, upper_.forces, forces_);
        upper_.part->get(Items::offsets, upper_.joints_down, joints_down_);
        clock.to(spent.upper_disassembly);
        lower_.part->put(Items::forces, lower_.forces, forces_);
        lower_.part->put(Items::offsets, lower_.joints_down, joints_down_);
        clock.to(spent.upload);
        lower_.part->disassemble();
        clock.to(spent.lower_disassembly);
        lower_.part->fetch();
        upper_.part->fetch();
        clock.to(spent.download);
        ++report_.bias_sweeps;
        report_.bias_seconds += seconds_now() - start;
    }

    SolverReport report() const override {
        SolverReport r = report_;
        add_tree(group_, communicator_, r);
        r.threads = upper_.part->threads();
        r.memory_bytes = upper_.part->memory_bytes() + lower_.part->memory_bytes();
        return r;
    }

  private:
    // One part of the tree with its lists of items to be transferred.
    struct Side {
        std::unique_ptr<LevelPart> part;
        // Numbers of the lists that LevelPart::choose() returned.
        int segments = 0, forces = 0, joints_up = 0, joints_down = 0;
    };

    /// Distributes the units of chains that several ranks share to all ranks, in one collective
    /// operation.
    void gather_shared(Items items) {
        Schedule const& s = group_.schedule;
        if (s.shared.empty()) return;
        double const start = seconds_now();
        std::vector<double> own, all;
        upper_.part->get(items, own_units_, own);
        upper_.part->get(items, all_units_, all);  // Only the size of `all` matters here.
        std::vector<std::int64_t> bytes(static_cast<std::size_t>(communicator_.size()), 0);
        std::size_t const unit_bytes = all.size() / s.shared.size() * sizeof(double);
        for (FrontierUnit const& unit : s.shared)
            bytes[unit.owner] += static_cast<std::int64_t>(unit_bytes);
        communicator_.all_gather(std::as_bytes(std::span(own)),
                                 std::as_writable_bytes(std::span(all)), bytes);
        upper_.part->put(items, all_units_, all);
        report_.exchange_seconds += seconds_now() - start;
    }

    ChainGroup const& group_;
    Communicator const& communicator_;
    bool has_lower_;
    Side lower_, upper_;
    int own_units_ = 0, all_units_ = 0;
    // Buffers for transfers between the parts.
    std::vector<double> segments_, forces_, joints_up_, joints_down_;
    SolverReport report_;
};

/// Returns the places that are in `wanted` but not in `made`, each once, in increasing order.
std::vector<std::int64_t> missing(std::vector<std::int64_t> wanted,
                                  std::vector<std::int64_t> made) {
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    std::sort(made.begin(), made.end());
    std::vector<std::int64_t> left;
    std::set_difference(wanted.begin(), wanted.end(), made.begin(), made.end(),
                        std::back_inserter(left));
    return left;
}

/// Returns the slots of segments that the levels from `up` on, the roots and the shared units read
/// but do not compute.
std::vector<std::int64_t> segments_at(Schedule const& s, std::size_t up) {
    std::vector<std::int64_t> wanted, made;
    for (std::size_t l = up; l < s.levels.size(); ++l)
        for (Merge const& m : s.levels[l]) {
            wanted.insert(wanted.end(), {m.inboard, m.outboard});
            made.push_back(m.slot);
        }
    for (Root const& root : s.roots) wanted.push_back(root.slot);
    for (FrontierUnit const& unit : s.shared)
        if (unit.is_own) wanted.push_back(unit.slot);
    return missing(std::move(wanted), std::move(made));
}

/// Returns the joints whose forces the lowest `down` levels and the runs read but do not compute.
std::vector<std::int64_t> forces_at(Schedule const& s, std::size_t down) {
    std::vector<std::int64_t> wanted, made{s.none};
    for (std::size_t l = 0; l < down; ++l)
        for (Merge const& m : s.levels[l]) {
            wanted.insert(wanted.end(), {m.first, m.next});
            made.push_back(m.joint);
        }
    for (Run const& run : s.runs) wanted.insert(wanted.end(), {run.body, run.next});
    return missing(std::move(wanted), std::move(made));
}

/// Returns the joints of the merges of levels [from, to).
std::vector<std::int64_t> joints_between(Schedule const& s, std::size_t from, std::size_t to) {
    std::vector<std::int64_t> joints;
    for (std::size_t l = from; l < to; ++l)
        for (Merge const& m : s.levels[l]) joints.push_back(m.joint);
    return joints;
}

}  // namespace

LevelCut cut_levels(Schedule const& s, GpuLevels levels) {
    std::size_t const up = within(levels.up, s), down = within(levels.down, s);
    LevelCut cut;
    if (levels.up > 0) cut.segments = segments_at(s, up);
    if (levels.down > 0) cut.forces = forces_at(s, down);
    cut.joints_up = joints_between(s, down, up);
    cut.joints_down = joints_between(s, up, down);
    return cut;
}

std::unique_ptr<ChainSolver> make_level_solver(ChainGroup const& group,
                                               Communicator const& communicator, GpuLevels levels,
                                               LevelPartMaker const& lower,
                                               LevelPartMaker const& upper) {
    return std::make_unique<LevelSolver>(group, communicator, levels, lower, upper);
}

}  // namespace catena::dca
