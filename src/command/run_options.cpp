// The options of `catena run`.
#include "command/shared_options.hpp"

namespace catena::command {
namespace {

class RunCommand final : public Command {
  public:
    std::string name() const override { return "run"; }
    std::string meaning() const override { return "simulate and write a folder of results"; }
    void add_options(OptionList& list, CommonOptions& common) override {
        add_scene(list, scene_);
        list.value("--steps", steps_, "N",
                   "last step, counted from the scene's start, instead of dynamics.steps");
        list.value("--output", output_, "DIR",
                   "output folder (default: the scene's name with -run; with --restart the "
                   "checkpoint's folder)");
        list.value("--restart", restart_, "FILE", "continue from a checkpoint");
        list.flag("--branch", branch_,
                  "with --restart and --output: start a new run from the checkpoint, with another "
                  "temperature, friction, seed, step, box, forces or integrator (in the same "
                  "coordinates); without --steps it runs dynamics.steps further steps");
        list.flag("--overwrite", overwrite_, "replace the results of a run in the folder");
        add_refine(list, common);
        list.footer(
            "Examples:\n  mpirun -np 2 catena run inputs/alpha-synuclein.yaml --output asyn\n  "
            "catena run inputs/alpha-synuclein.yaml --restart asyn/checkpoint.h5 --steps 20000\n  "
            "catena run inputs/alpha-synuclein.yaml --restart asyn/checkpoint.h5 --branch --set "
            "dynamics.temperature=310 --output warm\nAfter SIGINT, SIGTERM, SIGUSR1, SIGHUP or "
            "SIGXCPU on any rank, all ranks finish their step, write a checkpoint and exit with "
            "status 3.");
    }
    Request request(CommonOptions const& common) const override {
        auto request = scene_request<RunRequest>(common, scene_, name());
        if (!steps_.empty()) request.steps = whole_number("--steps", steps_, 0);
        request.output = output_;
        request.restart = restart_;
        request.overwrite = overwrite_;
        request.branch = branch_;
        if (request.branch && (request.restart.empty() || request.output.empty()))
            throw InputError("--branch without --restart or --output", "command line",
                             "name the checkpoint with --restart and a folder of the branch's own "
                             "with --output");
        if (request.overwrite && request.branch)
            throw InputError("both --overwrite and --branch", "command line",
                             "leave --overwrite out and name a new folder with --output");
        if (request.overwrite && !request.restart.empty())
            throw InputError("both --overwrite and --restart", "command line",
                             "a restart continues the existing run: leave --overwrite out");
        return request;
    }

  private:
    std::string scene_, steps_, output_, restart_;
    bool overwrite_ = false, branch_ = false;
};

}  // namespace

std::unique_ptr<Command> run_command() { return std::make_unique<RunCommand>(); }

}  // namespace catena::command
