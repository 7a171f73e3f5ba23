// The options of `catena bench`.
#include <fmt/format.h>

#include <utility>

#include "bench/sampling_options.hpp"
#include "command/shared_options.hpp"
#include "report/figures.hpp"

namespace catena::command {
namespace {

/// Values that options accept.
constexpr std::string_view joint_names[] = {"link",      "planar",   "spherical",
                                            "universal", "revolute", "prismatic",
                                            "helical",   "weld",     "mixed"};
constexpr std::string_view load_names[] = {"none", "torques", "wrenches"};
constexpr std::string_view bench_names[] = {"list",    "evaluation", "solve",   "peers",
                                            "openmm",  "sampling",   "overlap", "figures",
                                            "network", "plan"};
/// Name that is reserved for a later version.
constexpr std::string_view later_bench = "sweeps";

/// Returns the joints that a benchmark measures unless told otherwise.
std::vector<std::string> joints_of(BenchRequest const& request) {
    if (request.name == "evaluation") return {"link", "spherical"};
    if (request.name == "plan")
        return {"link", "planar", "spherical", "universal", "revolute", "mixed"};
    return request.joints;
}

class BenchCommand final : public Command {
  public:
    std::string name() const override { return "bench"; }
    std::string meaning() const override { return "run reproducible benchmarks, with residuals"; }
    SharedOptions shared() const override { return SharedOptions::solver; }
    void add_options(OptionList& list, CommonOptions&) override {
        list.argument("NAME", name_, "benchmark; `list` describes all");
        add_sampling(list, sampling_);
        add_chains(list);
        add_repeat(list, repeat_, "21");
        list.value("--backend", backends_, "B,...",
                   "serial, segments, openmp, cuda, cuda-levels (default: all of this build for "
                   "processors; openmm, overlap and sampling take one, cuda if there is a GPU)");
        list.value("--figure", figures_, "F,...",
                   "for figures: table-2.1, 2.3, 2.5, 2.6, 2.7 of the DCA chapter (default: all)");
        list.value("--output", output_, "DIR",
                   "folder for figures.json and pictures (default catena-figures); for overlap: "
                   "folder for pictures");
        list.footer(
            "Examples:\n  catena bench list\n  catena bench solve --sizes 1e3,1e6 --joints link "
            "--backend segments,openmp --json bench.json\n"
            "  catena bench figures --figure 2.5,2.6 --output figures\n"
            "  catena bench sampling --methods rigid,bonds --steps 0.01,0.02,0.04 --duration 2000 "
            "--json sampling.json");
    }
    Request request(CommonOptions const& common) const override {
        auto request = common_request<BenchRequest>(common);
        request.name = known_name();
        refuse_others(request.name);
        read_chains(request);
        if (!backends_.empty())
            for (std::string const& backend : comma_list("--backend", backends_))
                request.backends.push_back(backend_named("--backend", backend));
        request.repeat = repeat_of(repeat_, request.repeat);
        read_figures(request);
        request.output = output_;
        request.sampling = sampling_options(sampling_, request.name, request.json);
        return request;
    }

  private:
    /// Declares the options that describe generated chains.
    void add_chains(OptionList& list) {
        list.value("--sizes", sizes_, "N,...",
                   "numbers of bodies (default of solve and evaluation: 1e3,1e4,1e5, the oracle is "
                   "left out above 1e6; peers: 100,200,500,1e3,1e4,1e5; openmm: "
                   "140,9940,99960,1000020; overlap: the last three, in whole chains of 140 beads; "
                   "figures: 2,4,8 to 2048; plan: 16,32 to 1048576)");
        list.value("--joints", joints_, "J,...",
                   "link, planar, spherical, universal, revolute, prismatic, helical, weld, mixed "
                   "(default: link,spherical,revolute; evaluation: link,spherical; peers accepts "
                   "these and planar)");
        list.value("--loads", loads_, "LOADS",
                   "for solve, evaluation and peers, in addition to gravity: none | torques (of "
                   "joints) | wrenches (default: joint torques and wrenches in ground axes on "
                   "every body)");
        list.flag("--alike", alike_,
                  "for solve and evaluation: all bodies have the same mass, inertia and joints "
                  "(default: random ones)");
    }
    /// Returns the benchmark's name. Throws InputError if it is missing or unknown.
    std::string known_name() const {
        if (name_.empty())
            throw InputError("no benchmark is named", "command line", "write catena bench list");
        if (name_ == later_bench) throw not_in_this_version("catena bench " + name_);
        return known_value("catena bench", name_, bench_names);
    }
    /// Throws InputError for an option that the benchmark does not have.
    void refuse_others(std::string const& benchmark) const {
        using Given = std::pair<char const*, std::string const&>;
        std::string const alike = alike_ ? "yes" : "";
        for (auto const& [option, given] :
             {Given{"--figure", figures_}, Given{"--output", output_}, Given{"--joints", joints_},
              Given{"--sizes", sizes_}, Given{"--repeat", repeat_}, Given{"--loads", loads_},
              Given{"--alike", alike}})
            if (!given.empty() && !bench_takes(benchmark, option))
                throw InputError(
                    fmt::format("catena bench {1} does not take {0}", option, benchmark),
                    "command line", "leave it out");
    }
    /// Reads the options that describe generated chains.
    void read_chains(BenchRequest& request) const {
        request.sizes = sizes_.empty() ? bench_sizes(request.name) : sizes_of(sizes_);
        request.joints = joints_.empty() ? joints_of(request) : comma_list("--joints", joints_);
        for (std::string const& joint : request.joints) {
            known_value("--joints", joint, joint_names);
            if (alike_ && joint == "mixed")
                throw InputError("mixed joints cannot be alike", "--alike",
                                 "leave out --alike or `mixed`");
        }
        if (!loads_.empty()) request.loads = loads_;
        request.alike = alike_;
        known_value("--loads", request.loads, load_names);
    }
    /// Reads --figure.
    void read_figures(BenchRequest& request) const {
        request.figures.assign(std::begin(figure_names), std::end(figure_names));
        if (!figures_.empty()) request.figures = comma_list("--figure", figures_);
        for (std::string const& figure : request.figures)
            known_value("--figure", figure, figure_names);
    }
    std::string name_, sizes_, joints_, loads_, backends_, repeat_, figures_, output_;
    bool alike_ = false;
    SamplingOptionTexts sampling_;
};

}  // namespace

std::unique_ptr<Command> bench_command() { return std::make_unique<BenchCommand>(); }

}  // namespace catena::command
