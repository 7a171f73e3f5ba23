// OpenMmForce: choice of model, platform, path and decomposition, and one evaluation of the forces.
#include "force/openmm_force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <numbers>
#include <optional>
#include <utility>

#include "clock.hpp"
#include "error.hpp"
#include "force/contacts.hpp"
#include "force/path.hpp"
#include "force/rank_forces.hpp"
#include "force/replicas_of_ranks.hpp"
#include "force/worker.hpp"
#include "mpi/collectives.hpp"
#include "mpi/first_rank.hpp"
#include "scene/node.hpp"
#include "structure/residue_table.hpp"
#include "systems/box.hpp"
#include "systems/extra_forces.hpp"
#include "systems/force_layers.hpp"
#include "systems/replicas.hpp"
#include "systems/subset.hpp"

namespace catena {

namespace {

// Largest number of characters quoted from a message of OpenMM.
std::size_t constexpr longest_message = 300;

std::string join(std::vector<std::string> const& words) {
    return fmt::format("{}", fmt::join(words, ", "));
}

/// State and times of the last evaluation of the forces.
struct LastEvaluation {
    /// True from begin() to finish().
    bool under_way = false;
    /// True once positions have been given.
    bool exists = false;
    Interval gathering, computing;
    /// Exception that ended it.
    std::exception_ptr error;
};

/// OpenMmForce on any path; the decomposition is a RankForces.
class OpenMmForces final : public OpenMmForce {
  public:
    /// `why_no_device` and `by_pairs` must be the same on every rank.
    OpenMmForces(OpenMmSpec const& spec, BeadSystem const& beads, Communicator const& communicator,
                 OpenMmModel model, OpenMmPlatform platform, std::string const& why_no_device,
                 bool by_pairs);

    void begin(ConstView<3> positions) override;
    void finish(View<3> forces) override;
    DevicePath* device_path() override { return device_.get(); }
    void forces_again(View<3> forces) override;
    std::vector<EnergyTerm> energies() override;
    Interval last_evaluation() const override { return last_.computing; }
    bool leaves_a_core() const override { return leaves_a_core_; }
    std::vector<std::string> description() const override;
    std::string platform() const override { return platform_.name(); }
    std::string path() const override { return path_.name(); }
    void renew_ghosts() override { rank_->renew_ghosts(); }
    bool ghosts_are_due() const override { return rank_->ghosts_are_due(); }
    GhostTraffic traffic() const override { return rank_->traffic(); }
    std::int64_t largest_context() const override { return rank_->largest_context(); }
    std::int64_t contexts() const override { return rank_->contexts(); }
    Interval last_gathering() const override { return last_.gathering; }

  private:
    std::int64_t first() const { return first_of_rank_[communicator_.rank()]; }
    std::int64_t own_count() const { return first_of_rank_[communicator_.rank() + 1] - first(); }
    /// True if ranks on path `device` have ghosts, which all forces take from one Context.
    bool shares_one_list() const {
        return path_.on_device() && communicator_.size() > 1 && !by_pairs_;
    }
    double pairs_of_one_list(BeadSystem const& beads) const;
    double most_pairs(OpenMmSpec const& spec, BeadSystem const& beads) const;
    /// Moves forces out of the model into layers, if that pays on this platform and path.
    std::vector<ForceLayer> layers(OpenMmSpec const& spec, BeadSystem const& beads);
    std::unique_ptr<RankForces> make_rank_forces(OpenMmSpec const& spec,
                                                 BeadSystem const& beads) const;
    /// Computes the forces and keeps the exception, if any, in `last_`.
    void evaluate() noexcept;
    /// Waits for the worker, if there is one.
    void wait();

    Communicator const& communicator_;
    std::vector<std::int64_t> first_of_rank_;
    bool replicate_, by_pairs_, overlap_, leaves_a_core_;
    OpenMmModel model_;
    OpenMmPlatform platform_;
    PathChoice path_;
    std::vector<ForceLayer> layers_;  // layers whose forces were removed from model_
    std::unique_ptr<RankForces> rank_;
    std::unique_ptr<DevicePath> device_;
    // own positions, nm, and forces on them, kJ/mol/nm
    std::vector<Vec3> own_, forces_;
    LastEvaluation last_;
    // Declared last: its thread must end before the members it uses.
    std::unique_ptr<Worker> worker_;
};

}  // namespace

std::vector<std::int64_t> BeadSystem::beads_of(int rank) const {
    std::vector<std::int64_t> own;
    for (std::int64_t i = first_of_rank[rank]; i < first_of_rank[rank + 1]; ++i)
        own.push_back(by_rank.empty() ? i : by_rank[i]);
    return own;
}

namespace {

/// Returns the edges of the box if the forces are periodic.
std::optional<Vec3> box_of(OpenMmModel const& model, BeadSystem const& beads) {
    return model.system->usesPeriodicBoundaryConditions() ? beads.box : std::nullopt;
}

/// Describes the decomposition in a line, for people.
std::string split_text(RankForces const& rank) {
    if (rank.shares_pairs())
        return "split: every bead on each rank, which computes a share of the pairs";
    if (!std::isfinite(rank.reach()))
        return "split: every bead on each rank (a force has no cutoff)";
    std::string text = fmt::format("split: own beads and those within {} + {} nm on each rank",
                                   rank.reach(), rank.skin());
    std::vector<PairRange> const ranges = rank.ranges();
    for (std::size_t i = 1; i < ranges.size(); ++i)
        text +=
            fmt::format(", {} + {} nm where forces reach no farther", ranges[i].reach, rank.skin());
    return text;
}

/// Returns why positions and forces cannot stay on a GPU; empty if they can.
std::string cannot_stay_on_device(OpenMmSpec const& spec, OpenMmPlatform const& platform,
                                  Communicator const& communicator, ChainsOnDevice const& chains) {
    if (!chains.why_not.empty()) return chains.why_not;
    if (platform.name() != "CUDA") return fmt::format("OpenMM's platform is {}", platform.name());
    if (communicator.size() > 1 && spec.replicate)
        return "forces.openmm.replicate: every rank computes the whole System";
    if (spec.device >= 0 && spec.device != chains.device)
        return fmt::format("forces.openmm.device is {} and the chains are on GPU {}", spec.device,
                           chains.device);
    return cuda::why_no_device_path();
}

OpenMmForces::OpenMmForces(OpenMmSpec const& spec, BeadSystem const& beads,
                           Communicator const& communicator, OpenMmModel model,
                           OpenMmPlatform platform, std::string const& why_no_device, bool by_pairs)
    : communicator_(communicator),
      first_of_rank_(beads.first_of_rank),
      replicate_(spec.replicate),
      by_pairs_(by_pairs),
      overlap_(spec.overlap),
      leaves_a_core_(!platform.on_cpu() || cores_of_rank(communicator) > 1),
      model_(std::move(model)),
      platform_(std::move(platform)),
      path_(spec.path, platform_.on_cpu() && spec.overlap, why_no_device, beads.scene_file),
      layers_(layers(spec, beads)),
      rank_(make_rank_forces(spec, beads)),
      own_(static_cast<std::size_t>(own_count())),
      forces_(own_.size()) {
    if (path_.on_device()) device_ = rank_->device_path(spec.overlap);
}

/// Returns the number of pairs within the longest cutoff, per rank, if beads had a uniform density;
/// 0 without a box. Precondition: every force can be split.
double OpenMmForces::pairs_of_one_list(BeadSystem const& beads) const {
    std::optional<Vec3> const box = box_of(model_, beads);
    if (!box) return 0;
    double const count = static_cast<double>(beads.size()), reach = reach_of(*model_.system),
                 sphere = 4.0 / 3.0 * std::numbers::pi * reach * reach * reach;
    return count * count / 2 * sphere / ((*box)[0] * (*box)[1] * (*box)[2]) / communicator_.size();
}

/// Returns the largest part of the pairs of a single Context with which layers pay; 0: no layers.
/// With `auto`, GPUs have layers on path `device` from many_pairs on. There 20,000 beads of
/// CALVADOS 2 at 330 mg/ml took 0.95 times as long with layers, 10,000 beads 1.25 times (H200).
/// Path `host` on a GPU waits for every Context.
double OpenMmForces::most_pairs(OpenMmSpec const& spec, BeadSystem const& beads) const {
    double constexpr few = 0.6, all = 1, many_pairs = 5e6;
    if (spec.layers == "none" || spec.replicate || shares_one_list()) return 0;
    if (spec.layers == "all") return all;
    if (platform_.on_cpu()) return few;
    return path_.on_device() && pairs_of_one_list(beads) >= many_pairs ? few : 0;
}

std::vector<ForceLayer> OpenMmForces::layers(OpenMmSpec const& spec, BeadSystem const& beads) {
    double const most = most_pairs(spec, beads);
    if (most == 0) return {};
    std::vector<ForceLayer> taken = take_layers(model_, beads, most);
    for (ForceLayer& layer : taken) {
        model_.notes.insert(model_.notes.begin(), text_of(layer, beads));
        if (path_.on_device()) hold_chains_together(layer);
    }
    return taken;
}

std::unique_ptr<RankForces> OpenMmForces::make_rank_forces(OpenMmSpec const& spec,
                                                           BeadSystem const& beads) const {
    auto const make = communicator_.size() == 1 || spec.replicate ? make_whole_forces
                      : by_pairs_                                 ? make_pair_forces
                      : path_.on_device()                         ? make_halo_forces
                                                                  : make_split_forces;
    auto const make_all = path_.on_device() ? make_layers_on_device : make_layered_forces;
    return make_all({model_, platform_, beads, communicator_, box_of(model_, beads), spec.audit},
                    layers_, make);
}

void OpenMmForces::evaluate() noexcept {
    try {
        rank_->evaluate(forces_);
    } catch (...) {
        last_.error = std::current_exception();
    }
    last_.computing.end = seconds_now();
}

void OpenMmForces::begin(ConstView<3> positions) {
    wait();
    double const begun = seconds_now();
    for (std::int64_t k = 0; k < own_count(); ++k) own_[k] = positions.load(k);
    rank_->gather(own_);
    last_.gathering = {begun, seconds_now()};
    path_.settle(communicator_);
    last_.error = nullptr;
    last_.under_way = last_.exists = true;
    last_.computing.begin = seconds_now();
    if (!path_.runs_on_worker()) {
        evaluate();
        return;
    }
    if (!worker_) worker_ = std::make_unique<Worker>();
    worker_->post([this] { evaluate(); });
    if (!overlap_) wait();
}

void OpenMmForces::wait() {
    if (worker_) worker_->wait();
}

void OpenMmForces::finish(View<3> forces) {
    wait();
    if (!std::exchange(last_.under_way, false))
        throw ComputationError(
            "OpenMM's forces were requested before their computation was started");
    try {
        if (last_.error) std::rethrow_exception(last_.error);
    } catch (ComputationError const&) {
        throw;
    } catch (std::exception const& e) {
        throw ComputationError(
            fmt::format("OpenMM failed: {}", scene::shown(e.what(), longest_message)));
    }
    for (std::int64_t k = 0; k < own_count(); ++k)
        for (int c = 0; c < 3; ++c) forces.at(k, c) += forces_[k][c];
    path_.note(seconds_now() - last_.gathering.begin);
}

std::vector<EnergyTerm> OpenMmForces::energies() {
    wait();
    if (!last_.exists && !device_)
        throw ComputationError("OpenMM's energies were requested before it received positions");
    std::vector<double> values(model_.terms.size());
    std::string failure;
    try {
        rank_->find_energies(device_.get(), values);
    } catch (SharedError const& e) {
        throw SharedError(fmt::format("OpenMM failed to compute the energies: {}", e.what()));
    } catch (std::exception const& e) {
        if (communicator_.rank() != 0) throw;
        failure = e.what();
    }
    if (device_) device_->make_current();  // OpenMM may have left its own GPU context current
    char failed = failure.empty() ? 0 : 1;
    broadcast(communicator_, failed);
    if (failed != 0)
        throw ComputationError(fmt::format("OpenMM failed to compute the energies on rank 0{}{}",
                                           failure.empty() ? "" : ": ", failure));
    broadcast(communicator_, values);
    std::vector<EnergyTerm> terms;
    for (std::size_t i = 0; i < values.size(); ++i) terms.push_back({model_.terms[i], values[i]});
    return terms;
}

void OpenMmForces::forces_again(View<3> forces) {
    std::vector<Vec3> const again = rank_->forces_again();
    for (std::int64_t k = 0; k < own_count(); ++k)
        forces.store(k, again[static_cast<std::size_t>(k)]);
}

std::vector<std::string> OpenMmForces::description() const {
    std::vector<std::string> lines{
        platform_.name() == "CPU"
            ? fmt::format("{}, platform CPU, threads per rank: {}", openmm_version(),
                          platform_.threads)
            : fmt::format("{}, platform {}", openmm_version(), platform_.name())};
    lines.push_back("terms: " + (model_.terms.empty() ? std::string("none") : join(model_.terms)));
    lines.insert(lines.end(), model_.notes.begin(), model_.notes.end());
    lines.push_back("path " + path_.text());
    int const cores = cores_of_rank(communicator_);
    if (path_.runs_on_worker() && cores < 2)
        lines.push_back(
            "warning: OpenMM's worker thread has no core of its own (bind ranks to two or more "
            "cores, or set forces.openmm.path: inline)");
    if (platform_.threads > cores)
        lines.push_back(fmt::format("warning: {} threads share {} cores of this rank",
                                    platform_.threads, cores));
    if (communicator_.size() > 1 && replicate_)
        lines.push_back("replicated: every rank computes the whole System");
    if (communicator_.size() > 1 && !replicate_ && own_count() > 0)
        lines.push_back(split_text(*rank_) +
                        (shares_one_list() ? "; one list of pairs serves all forces" : ""));
    for (auto const& failure : platform_.not_loaded)
        lines.push_back("plugin not loaded: " + failure);
    return lines;
}

/// Returns the force's kind for messages, such as "NonbondedForce (PME)".
std::string name_for_refusal(OpenMM::Force const& force) {
    std::string const kind = kind_of(force);
    auto const* charges = dynamic_cast<OpenMM::NonbondedForce const*>(&force);
    if (charges == nullptr) return kind;
    auto const method = charges->getNonbondedMethod();
    return fmt::format("{} ({})", kind,
                       method == OpenMM::NonbondedForce::Ewald ? "Ewald"
                       : method == OpenMM::NonbondedForce::PME ? "PME"
                                                               : "LJPME");
}

/// Throws InputError that names the first force of the model that cannot be split.
void refuse_what_cannot_be_split(OpenMmModel const& model, std::string const& where, int ranks) {
    for (int i = 0; i < model.system->getNumForces(); ++i) {
        auto const& force = model.system->getForce(i);
        if (!can_be_split(force))
            throw InputError(
                fmt::format("{} cannot be split over {} ranks", name_for_refusal(force), ranks),
                where,
                "set forces.openmm.replicate: true, so that every rank computes the whole System, "
                "or run on one rank");
    }
}

/// Builds the model that the scene asks for. Throws InputError.
OpenMmModel model_of(OpenMmSpec const& spec, BeadSystem const& beads,
                     Communicator const& communicator, std::string const& where) {
    if (beads.size() == 0)
        throw InputError("OpenMM has no beads to act on", where,
                         "give the scene a chain of beads, or leave forces.openmm out");
    if (!built_in_table(spec.builder) && !(spec.builder.empty() && !spec.system.empty()))
        throw InputError(fmt::format("`{}` is not a builder of OpenMM's forces", spec.builder),
                         where, "use builder: calvados2, or system: and topology:");
    bool const repeats = beads.replicas > 1;
    BeadSystem const of_one = repeats ? first_replica(beads) : BeadSystem();
    BeadSystem const& one = repeats ? of_one : beads;
    OpenMmModel model = spec.system.empty() ? calvados2_model(spec, one) : system_model(spec, one);
    add_extra_forces(model, spec, one);
    if (repeats) repeat_model(model, one, beads.replicas);
    if (communicator.size() > 1 && !spec.replicate)
        refuse_what_cannot_be_split(model, where, communicator.size());
    return model;
}

/// OpenMM takes about a kilobyte per bead; the chains need GPU memory of their own as well.
constexpr std::int64_t most_beads_of_a_gpu = 20'000'000;

/// Returns why ranks cannot share out the pairs of all beads; empty if they can. `why_no_device`
/// must be the same on every rank.
std::string cannot_share_pairs(OpenMmSpec const& spec, OpenMM::System const& system,
                               BeadSystem const& beads, std::string const& why_no_device) {
    if (!why_no_device.empty()) return why_no_device;
    if (spec.path != "auto" && spec.path != "device") return "path is " + spec.path;
    auto const& first = beads.first_of_rank;
    if (std::adjacent_find(first.begin(), first.end()) != first.end()) return "a rank has no beads";
    if (std::string why = why_not_by_pairs(system); !why.empty()) return why;
    if (spec.split == "auto" && beads.size() > most_beads_of_a_gpu)
        return "each GPU may have too little memory for this many beads";
    return cuda::why_pairs_cannot_be_shared();
}

/// True if ranks share out the pairs; the same on every rank. Throws InputError if the scene
/// demands it in vain. Collective.
bool goes_by_pairs(OpenMmSpec const& spec, OpenMM::System const& system, BeadSystem const& beads,
                   Communicator const& communicator, std::string const& why_no_device) {
    if (spec.replicate && spec.split != "auto")
        throw InputError("forces.openmm.replicate excludes a split",
                         beads.scene_file + ": forces.openmm.split", "leave one of them out");
    if (communicator.size() == 1 || spec.replicate || spec.split == "ghosts") return false;
    std::string why_not =
        first_text(communicator, cannot_share_pairs(spec, system, beads, why_no_device)).text;
    if (why_not.empty() && !cuda::gpus_are_alike(communicator)) why_not = "their GPUs differ";
    if (spec.split == "pairs" && !why_not.empty())
        throw InputError(fmt::format("ranks cannot divide OpenMM's pairs: {}", why_not),
                         beads.scene_file + ": forces.openmm.split",
                         "use auto or ghosts, or chains of beads, --backend cuda and pair forces "
                         "with a cutoff on GPUs");
    return why_not.empty() &&
           (spec.split == "pairs" || cuda::gpus_may_write_to_each_other(communicator));
}

/// Returns what `action` makes. Exceptions of OpenMM become InputErrors.
template <class Action>
auto accepted(std::string const& where, Action const& action) {
    try {
        return action();
    } catch (InputError const&) {
        throw;
    } catch (std::bad_alloc const&) {
        throw;
    } catch (std::exception const& e) {  // OpenMM's exceptions have no more specific common base
        throw InputError(
            fmt::format("OpenMM refuses these forces: {}", scene::shown(e.what(), longest_message)),
            where, "correct the System, or use another platform");
    }
}

std::unique_ptr<OpenMmForce> make_force(OpenMmSpec const& spec, BeadSystem const& beads,
                                        Communicator const& communicator,
                                        ChainsOnDevice const& chains, std::optional<double> reach);

/// Makes the forces on replicas that are dealt out to ranks. Collective.
std::unique_ptr<OpenMmForce> make_forces_of_replicas(OpenMmSpec spec, BeadSystem const& beads,
                                                     Communicator const& communicator,
                                                     ChainsOnDevice chains,
                                                     std::optional<double> reach) {
    if (chains.why_not.empty())
        chains.why_not = "replicas are dealt out to several ranks: start a run for each GPU";
    std::unique_ptr<Communicator> alone = serial_communicator();
    std::unique_ptr<OpenMmForce> force;
    on_every_rank(communicator, [&] {
        BeadSystem const own = replicas_of_rank(beads, communicator.rank(), communicator.size());
        // A serial communicator would count the cores of all ranks.
        if (spec.threads == 0) spec.threads = useful_threads(own, communicator);
        force = make_force(spec, own, *alone, chains, reach);
    });
    return replicas_of_ranks(std::move(alone), std::move(force), communicator);
}

/// Makes the forces; `reach`: limit of pair forces, nm, if given. Collective.
std::unique_ptr<OpenMmForce> make_force(OpenMmSpec const& spec, BeadSystem const& beads,
                                        Communicator const& communicator,
                                        ChainsOnDevice const& chains, std::optional<double> reach) {
    if (beads.replicas > 1 && communicator.size() > 1)
        return make_forces_of_replicas(spec, beads, communicator, chains, reach);
    std::string const where = beads.scene_file + ": forces.openmm";
    OpenMmModel model;
    OpenMmPlatform platform;
    on_every_rank(communicator, [&] {
        model = model_of(spec, beads, communicator, where);
        refuse_box_beyond_cutoffs(*model.system, beads.scene_file + ": box");
        if (reach) shorten_pair_forces(*model.system, *reach);
        platform = accepted(
            where, [&] { return choose_platform(spec, beads, communicator, chains.device); });
    });
    std::string const why_no_device =
        first_text(communicator, cannot_stay_on_device(spec, platform, communicator, chains)).text;
    bool const by_pairs = goes_by_pairs(spec, *model.system, beads, communicator, why_no_device);
    std::unique_ptr<OpenMmForce> force;
    on_every_rank(communicator, [&] {
        force = accepted(where, [&]() -> std::unique_ptr<OpenMmForce> {
            return std::make_unique<OpenMmForces>(spec, beads, communicator, std::move(model),
                                                  std::move(platform), why_no_device, by_pairs);
        });
    });
    return force;
}

}  // namespace

std::unique_ptr<OpenMmForce> make_openmm_force(OpenMmSpec const& spec, BeadSystem const& beads,
                                               Communicator const& communicator,
                                               ChainsOnDevice const& chains) {
    return make_force(spec, beads, communicator, chains, std::nullopt);
}

std::unique_ptr<OpenMmForce> make_openmm_contacts(OpenMmSpec const& spec, BeadSystem const& beads,
                                                  Communicator const& communicator, double reach) {
    return make_force(spec, beads, communicator, {no_gpu_asked_for, -1}, reach);
}

}  // namespace catena
