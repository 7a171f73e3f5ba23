// DeviceConstraints by kernels that OpenMM compiles. Only virtual and inline functions of OpenMM's
// GPU classes are called, so that this library need not be linked with the platforms' libraries.
#include "plugin/device_constraints.hpp"

#include <OpenMM.h>
#include <fmt/format.h>
#include <openmm/common/ComputeContext.h>
#include <openmm/common/ContextSelector.h>
#include <openmm/internal/ContextImpl.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "plugin/context_constraints.hpp"
#include "plugin/device_kernels.hpp"

namespace catena::plugin {
namespace {

/// Beads of a thread, and threads of a group.
constexpr int run = 4, width = 128;
/// Sweeps of the first steps, and the largest number.
constexpr int first_sweeps = 8, most_sweeps = 40;
/// Steps between two looks at the errors.
constexpr int most_unseen_steps = 16;

/// First members of the platforms' data: CudaPlatform, HipPlatform and OpenCLPlatform have a vector
/// of pointers to their own kind of ComputeContext.
struct PlatformData {
    OpenMM::ContextImpl* context;
    std::vector<OpenMM::ComputeContext*> contexts;
};

/// Notes that OpenMM has sorted its particles anew. OpenMM owns it.
class Reordered final : public OpenMM::ComputeContext::ReorderListener {
  public:
    explicit Reordered(std::shared_ptr<bool> note) : note_(std::move(note)) {}
    void execute() override { *note_ = true; }

  private:
    std::shared_ptr<bool> note_;
};

/// Arrays and kernels that project velocities and close constraints, block by block.
class DeviceSweeps {
  public:
    DeviceSweeps(OpenMM::ComputeContext& gpu, ConstraintChains const& chains)
        : gpu_(gpu),
          is_double_(gpu.getUseDoublePrecision() || gpu.getUseMixedPrecision()),
          beads_(static_cast<int>(chains.particle.size())),
          blocks_((beads_ + run * width - 1) / (run * width)),
          particle_(chains.particle.begin(), chains.particle.end()) {
        OpenMM::ContextSelector const selected(gpu_);
        std::size_t const number = is_double_ ? sizeof(double) : sizeof(float);
        auto const beads = static_cast<std::size_t>(beads_), blocks = std::size_t(blocks_);
        place_ = array(beads, sizeof(int), "place");
        lengths_ = array(beads, number, "lengths");
        direction_ = array(beads + 1, 4 * number, "direction");
        joint_ = array(beads, 4 * number, "joint");
        segments_ = array(blocks, 6 * number, "segments");
        errors_ = array(blocks, number, "errors");
        block_force_ = array(blocks + 1, number, "blockForce");
        history_ = array(most_sweeps, number, "history");
        std::vector<double> lengths;
        for (ChainSpec const& chain : chains.scene.chains) {
            lengths.push_back(0);
            lengths.insert(lengths.end(), chain.beads.length.begin() + 1, chain.beads.length.end());
        }
        lengths_->upload(lengths, true);
        forget_errors();
        gpu_.getReorderListeners().push_back(new Reordered(reordered_));
        compile();
    }

    /// True if the GPU keeps the numbers in double precision.
    bool is_double() const { return is_double_; }
    OpenMM::ComputeContext& gpu() const { return gpu_; }
    /// Looks up where OpenMM keeps the beads, if that has changed.
    void find_places() {
        if (!*reordered_) return;
        *reordered_ = false;
        std::vector<int> const& particle_at = gpu_.getAtomIndex();
        std::vector<int> place_of(particle_at.size());
        for (std::size_t i = 0; i < particle_at.size(); ++i)
            place_of[std::size_t(particle_at[i])] = static_cast<int>(i);
        std::vector<int> places;
        places.reserve(particle_.size());
        for (std::size_t const particle : particle_) places.push_back(place_of[particle]);
        place_->upload(places);
    }
    /// Keeps the directions of the constraints at the present positions.
    void find_directions() { directions_->execute(beads_ + 1); }
    /// Projects velocities, or moves beads, over `step` (ps). Number `number` of a step's sweeps
    /// leaves its error in the history; -1: none.
    void sweep(bool project, double step, int number) {
        int const projecting = project ? 1 : 0;
        for (auto const& kernel : {assemble_, move_}) {
            kernel->setArg(2, projecting);
            set_number(kernel, 3, step);
        }
        solve_->setArg(1, number);
        assemble_->execute(blocks_ * width, width);
        solve_->execute(width, width);
        move_->execute(blocks_ * width, width);
    }
    /// Returns the largest error before each of a step's sweeps since the last call.
    std::vector<double> take_errors() {
        std::vector<double> history;
        if (is_double_) {
            history_->download(history);
        } else {
            std::vector<float> single;
            history_->download(single);
            history.assign(single.begin(), single.end());
        }
        forget_errors();
        return history;
    }

  private:
    using Array = std::unique_ptr<OpenMM::ArrayInterface>;
    Array array(std::size_t size, std::size_t bytes, char const* name) {
        Array made(gpu_.createArray());
        made->initialize(gpu_, size, static_cast<int>(bytes), std::string("catena_") + name);
        return made;
    }
    void compile() {
        OpenMM::ComputeProgram const program = gpu_.compileProgram(
            device_kernels, {{"RUN", std::to_string(run)}, {"WIDTH", std::to_string(width)}});
        directions_ = program->createKernel("findDirections");
        assemble_ = program->createKernel("assembleBlocks");
        solve_ = program->createKernel("solveBlocks");
        move_ = program->createKernel("moveBeads");
        give(directions_, beads_, *place_, *lengths_, *direction_);
        give(assemble_, beads_, blocks_, Later{}, Later{}, gpu_.getPaddedNumAtoms(), *place_,
             *lengths_, *direction_, gpu_.getVelm(), gpu_.getLongForceBuffer(), *joint_, *segments_,
             *errors_);
        give(move_, beads_, blocks_, Later{}, Later{}, *place_, *direction_, *joint_, *block_force_,
             gpu_.getVelm());
        for (auto const& kernel : {directions_, assemble_, move_}) give_positions(kernel);
        give(solve_, blocks_, Later{}, *joint_, *segments_, *errors_, *block_force_, *history_);
    }
    struct Later {};  // An argument that is set before each launch.
    static void give_one(OpenMM::ComputeKernel const& kernel, Later) { kernel->addArg(); }
    static void give_one(OpenMM::ComputeKernel const& kernel, int value) { kernel->addArg(value); }
    static void give_one(OpenMM::ComputeKernel const& kernel, OpenMM::ArrayInterface& value) {
        kernel->addArg(value);
    }
    template <class... Arguments>
    static void give(OpenMM::ComputeKernel const& kernel, Arguments&&... arguments) {
        (give_one(kernel, arguments), ...);
    }
    void give_positions(OpenMM::ComputeKernel const& kernel) {
        kernel->addArg(gpu_.getPosq());
        if (gpu_.getUseMixedPrecision()) kernel->addArg(gpu_.getPosqCorrection());
    }
    void set_number(OpenMM::ComputeKernel const& kernel, int argument, double value) const {
        if (is_double_)
            kernel->setArg(argument, value);
        else
            kernel->setArg(argument, static_cast<float>(value));
    }
    void forget_errors() { history_->upload(std::vector<double>(most_sweeps, 0.0), true); }

    OpenMM::ComputeContext& gpu_;
    bool is_double_;
    int beads_, blocks_;
    std::vector<std::size_t> particle_;
    Array place_, lengths_, direction_, joint_, segments_, errors_, block_force_, history_;
    OpenMM::ComputeKernel directions_, assemble_, solve_, move_;
    std::shared_ptr<bool> reordered_ = std::make_shared<bool>(true);
};

/// Constraints that choose how many sweeps a step takes, and how often their errors are read.
class OnDevice final : public DeviceConstraints {
  public:
    /// `on_host`: null if OpenMM knows the constraints.
    OnDevice(OpenMM::ComputeContext& gpu, ConstraintChains const& chains,
             std::shared_ptr<ContextConstraints> on_host)
        : on_host_(std::move(on_host)), device_(gpu, chains) {}

    void before_step(double step, bool project) override {
        OpenMM::ContextSelector const selected(device_.gpu());
        device_.find_places();
        device_.find_directions();
        if (project) device_.sweep(true, step, -1);
    }
    void after_step(double step, double tolerance) override {
        OpenMM::ContextSelector const selected(device_.gpu());
        device_.find_places();
        close(step);
        if (++unseen_ >= seen_) look(step, tolerance);
    }
    std::optional<double> shifted_kinetic_energy(double shift) override {
        if (!on_host_ || shift == 0) return std::nullopt;
        return on_host_->shifted_kinetic_energy(shift);
    }
    void note_change() override {
        sweeps_ = std::max(sweeps_, first_sweeps);
        seen_ = 1;
    }

  private:
    /// Performs the sweeps of a step.
    void close(double step) {
        for (int s = 0; s < sweeps_; ++s) device_.sweep(false, step, s);
    }
    /// Largest errors before the last sweep but one and before the last one, since the last look.
    struct Errors {
        double before = 0, last = 0;
        /// Error after the last sweep, if it closes as much as the one before it.
        double after() const { return last < before ? last * last / before : last; }
        bool stays() const { return last > before / 2; }
    };
    Errors read() {
        std::vector<double> const history = device_.take_errors();
        unseen_ = 0;
        return {history[std::size_t(sweeps_ - 2)], history[std::size_t(sweeps_ - 1)]};
    }
    /// Reads the errors. Repeats the sweeps of a step that is looked at alone until it is closed.
    /// Chooses the number of sweeps.
    void look(double step, double tolerance) {
        // In single precision, coordinates of 1000 nm are rounded by 1e-4 of a length.
        double const enough = device_.is_double() ? 1e-9 : 1e-6,
                     rounding = device_.is_double() ? 1e-7 : 1e-3;
        int const unseen = unseen_;
        Errors errors = read();
        auto const closed = [&](double error) {
            return error <= std::max(tolerance, enough) || (errors.stays() && error <= rounding);
        };
        for (int more = sweeps_; unseen == 1 && !closed(errors.after()) && more < most_sweeps;
             more += sweeps_) {
            close(step);
            errors = read();
        }
        if (!std::isfinite(errors.last)) throw ComputationError("positions are no longer finite");
        if (!closed(errors.after())) refuse(errors.after(), unseen);
        seen_ = std::min(2 * seen_, most_unseen_steps);
        if (errors.last > enough && !errors.stays())
            sweeps_ = std::min(sweeps_ + 2, most_sweeps);
        else if (errors.before <= enough || errors.stays())
            sweeps_ = std::max(sweeps_ - 1, 2);
    }
    [[noreturn]] void refuse(double error, int steps) {
        note_change();
        throw ComputationError(fmt::format(
            "constraints stay open by {:.1e} of their length {}: take a smaller step, "
            "or minimise the energy first",
            error,
            steps == 1 ? "after a step" : fmt::format("in one of the last {} steps", steps)));
    }

    std::shared_ptr<ContextConstraints> on_host_;
    DeviceSweeps device_;
    int sweeps_ = first_sweeps;
    /// unseen_: steps since the last look at errors; seen_: steps until the next.
    int unseen_ = 0, seen_ = 1;
};

void refuse_other_shapes(ConstraintChains const& chains, std::string const& platform,
                         std::string const& user) {
    std::size_t bead = 0;
    for (ChainSpec const& chain : chains.scene.chains) {
        char const* const shape = chain.is_cross_linked() ? "net"
                                  : chain.is_ring()       ? "ring"
                                  : chain.is_branched()   ? "tree"
                                                          : nullptr;
        if (shape != nullptr)
            throw InputError(
                fmt::format("constraints that form a {} on the platform {}", shape, platform),
                fmt::format("System, with particle {}", chains.particle[bead]),
                user + " solves chains there; take the platform CPU");
        bead += chain.beads.size();
    }
}

}  // namespace

bool is_device_platform(std::string const& name) {
    return name == "CUDA" || name == "HIP" || name == "OpenCL";
}

std::unique_ptr<DeviceConstraints> make_device_constraints(OpenMM::ContextImpl& context,
                                                           bool unknown, std::string const& user) {
    OpenMM::System const& system = context.getSystem();
    std::vector<Constraint> const open = constraints_to_solve(system);
    if (open.empty()) return nullptr;
    ConstraintChains const chains = constraint_chains(masses_of(system), open);
    refuse_other_shapes(chains, context.getPlatform().getName(), user);
    auto const* data = static_cast<PlatformData*>(context.getPlatformData());
    auto const on_host = unknown ? std::make_shared<ContextConstraints>(context, user) : nullptr;
    if (on_host) apply_in_context(context, on_host);
    return std::make_unique<OnDevice>(*data->contexts.at(0), chains, on_host);
}

}  // namespace catena::plugin
