// The options of `catena check` and `catena solve`.
#include "command/shared_options.hpp"
#include "scene/files.hpp"

namespace catena::command {
namespace {

class CheckCommand final : public Command {
  public:
    std::string name() const override { return "check"; }
    std::string meaning() const override { return "validate a scene and describe it"; }
    void add_options(OptionList& list, CommonOptions&) override {
        add_scene(list, scene_);
        list.value("--picture", picture_, "FILE",
                   "draw the rigid domains that `rigid: {pae: ...}` decides, with pLDDT and "
                   "predicted errors, as SVG");
        list.footer(
            "Examples:\n  catena check inputs/arm.yaml\n  catena check inputs/several-chains.yaml "
            "--set chains[0].count=10 --json -");
    }
    Request request(CommonOptions const& common) const override {
        auto request = scene_request<CheckRequest>(common, scene_, name());
        request.picture = picture_;
        if (!picture_.empty() && scene::ending_of(picture_) != ".svg")
            throw InputError("the picture is an SVG file", "--picture " + picture_,
                             "name a file that ends in .svg");
        return request;
    }

  private:
    std::string scene_, picture_;
};

class SolveCommand final : public Command {
  public:
    std::string name() const override { return "solve"; }
    std::string meaning() const override {
        return "compute accelerations and joint forces of the start, with times and residual";
    }
    void add_options(OptionList& list, CommonOptions& common) override {
        add_scene(list, scene_);
        add_repeat(list, repeat_, "11");
        add_refine(list, common);
        list.value("--accelerations", accelerations_, "FILE",
                   "write accelerations and the forces of joints and tips, for any number of "
                   "bodies: .csv, .json or .h5 (HDF5)");
        list.footer(
            "Examples:\n  catena solve inputs/arm.yaml --json arm.json\n"
            "  catena solve inputs/random-revolute.yaml --set "
            "chains[0].generator.random.bodies=100000 --backend openmp --accelerations a.csv");
    }
    Request request(CommonOptions const& common) const override {
        auto request = scene_request<SolveRequest>(common, scene_, name(), accelerations_);
        request.accelerations = accelerations_;
        request.repeat = repeat_of(repeat_, request.repeat);
        return request;
    }

  private:
    std::string scene_, repeat_, accelerations_;
};

}  // namespace

std::unique_ptr<Command> check_command() { return std::make_unique<CheckCommand>(); }
std::unique_ptr<Command> solve_command() { return std::make_unique<SolveCommand>(); }

}  // namespace catena::command
