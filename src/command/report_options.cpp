// The options of `catena report`.
#include <utility>

#include "command/shared_options.hpp"

namespace catena::command {
namespace {

constexpr std::string_view suite_names[] = {"stability"};

class ReportCommand final : public Command {
  public:
    std::string name() const override { return "report"; }
    std::string meaning() const override {
        return "measure errors against run time of solver, integrators and forces; write a page, "
               "tables, JSON and pictures";
    }
    void add_options(OptionList& list, CommonOptions&) override {
        list.arguments(
            "SCENE", scenes_,
            "scene files (default: generated chains); integrators are compared if a scene has "
            "`dynamics` without OpenMM, forces if it has OpenMM");
        add_suite(list);
        list.flag("--quick", quick_, "fewer and smaller cases, less than a minute");
        list.value("--output", output_, "DIR",
                   "folder for report.html, report.json and pictures (default catena-report)");
        add_repeat(list, repeat_, "11, with --quick 3");
        list.footer(
            "Examples:\n  catena report --quick\n  catena report inputs/arm.yaml "
            "inputs/random-link.yaml --repeat 51 --output errors\n"
            "  catena report --suite stability --output stability");
    }
    Request request(CommonOptions const& common) const override {
        auto request = common_request<ReportRequest>(common);
        request.scenes = scenes_;
        request.quick = quick_;
        if (!suite_.empty()) request.suite = known_value("--suite", suite_, suite_names);
        if (!request.suite.empty() && !request.scenes.empty())
            throw InputError("both --suite and a scene", "command line",
                             "the suite has its own chains: leave the scene out");
        if (!request.suite.empty()) refuse_with_suite(common);
        if (request.suite.empty()) refuse_without_suite();
        if (!cases_.empty()) request.cases = comma_list("--cases", cases_);
        request.sizes = sizes_of(sizes_);
        if (!output_.empty()) request.output = output_;
        request.repeat = repeat_of(repeat_, request.quick ? 3 : request.repeat);
        return request;
    }

  private:
    /// Declares --suite and the options that need it.
    void add_suite(OptionList& list) {
        list.value("--suite", suite_, "NAME",
                   "stability: measure chains that are hard to solve instead, up to 2^20 bodies: "
                   "growth of rounding errors, errors, bounds, verdicts; without --quick also "
                   "Simbody and Pinocchio if installed (tests/bench/peers/README.md)");
        list.value("--sizes", sizes_, "N,...",
                   "for --suite: only coils and dills with these numbers of bodies");
        list.value("--cases", cases_, "WORD,...",
                   "for --suite: only families whose names contain one of these words");
    }
    /// Throws InputError for options that contradict --suite, which has its own chains and measures
    /// no times.
    void refuse_with_suite(CommonOptions const& common) const {
        for (auto const& [option, given] : {std::pair{"--set", !common.set.empty()},
                                            {"--repeat", !repeat_.empty()},
                                            {"--threads", !common.threads.empty()},
                                            {"--gpu-levels", !common.gpu_levels.empty()}})
            if (given)
                throw InputError("both --suite and " + std::string(option), "command line",
                                 "the suite has its own chains, and its errors depend neither on "
                                 "threads nor on repetition: leave it out");
    }
    /// Throws InputError for options that need --suite.
    void refuse_without_suite() const {
        for (auto const& [option, given] : {std::pair{"--sizes", sizes_}, {"--cases", cases_}})
            if (!given.empty())
                throw InputError(option + std::string(" without --suite"), "command line",
                                 "write --suite stability, or leave it out");
    }
    std::vector<std::string> scenes_;
    std::string suite_, sizes_, cases_, output_, repeat_;
    bool quick_ = false;
};

}  // namespace

std::unique_ptr<Command> report_command() { return std::make_unique<ReportCommand>(); }

}  // namespace catena::command
