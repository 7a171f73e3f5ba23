// The options of `catena plan`.
#include "command/shared_options.hpp"

namespace catena::command {
namespace {

class PlanCommand final : public Command {
  public:
    std::string name() const override { return "plan"; }
    std::string meaning() const override {
        return "print what will run, how long an evaluation takes, what is left out, and why";
    }
    void add_options(OptionList& list, CommonOptions&) override {
        add_scene(list, scene_);
        list.flag("--explain", explain_, "also measure the time that is saved by what is left out");
        list.flag("--measure", measure_,
                  "also measure an evaluation and compare it with the prediction");
        list.flag("--calibrate", calibrate_,
                  "measure every kind of chain on this machine, for all later predictions (SCENE "
                  "may be left out)");
        add_ranks(list);
        list.footer(
            "Examples:\n  catena plan inputs/alpha-synuclein.yaml --explain\n  catena plan "
            "--calibrate\n"
            "  mpirun -np 4 catena plan inputs/random-revolute.yaml --backend segments\n"
            "  catena plan inputs/spherical-chain.yaml --ranks 4096 --hosts 512 --network "
            "network.json");
    }
    Request request(CommonOptions const& common) const override {
        PlanRequest request = calibrate_ && scene_.empty()
                                  ? common_request<PlanRequest>(common)
                                  : scene_request<PlanRequest>(common, scene_, name());
        request.explain = explain_;
        request.measure = measure_;
        request.calibrate = calibrate_;
        read_ranks(request);
        return request;
    }

  private:
    /// Declares the options of the prediction for many ranks.
    void add_ranks(OptionList& list) {
        list.value("--ranks", ranks_, "P",
                   "predict the time per step, computing and messages, on up to P ranks");
        list.value("--hosts", hosts_, "H", "number of hosts of these ranks (default 1)");
        list.value("--network", network_, "FILE",
                   "network for --ranks, written by mpirun ... catena bench network --json FILE");
        list.value("--latency", latency_, "T",
                   "latency of a message between hosts, instead of the file's (s, ms, us, ns)");
        list.value("--bandwidth", bandwidth_, "B",
                   "bandwidth between hosts, instead of the file's (B/s to GB/s, Mbit/s, Gbit/s)");
    }
    /// Reads the options of the prediction for many ranks.
    void read_ranks(PlanRequest& request) const {
        if (!ranks_.empty()) request.ranks = whole_number("--ranks", ranks_, 1, 1000000);
        if (!hosts_.empty()) request.hosts = whole_number("--hosts", hosts_, 1, 1000000);
        request.network = network_;
        read_link(request);
        if (request.ranks == 0 && (!hosts_.empty() || !network_.empty() || request.latency))
            throw InputError("--hosts, --network or --latency without --ranks", "command line",
                             "give the number of ranks: --ranks P");
        if (request.ranks > 0 && request.hosts > request.ranks)
            throw InputError("more hosts than ranks", "command line",
                             "give each host at least one rank");
        if (request.ranks > 0 && request.network.empty() && !request.latency)
            throw InputError("--ranks without --network", "command line",
                             "measure it with mpirun -np 2 catena bench network --json "
                             "network.json, then add --network network.json; or give --latency and "
                             "--bandwidth");
    }
    /// Reads --latency and --bandwidth, which must be given together.
    void read_link(PlanRequest& request) const {
        static constexpr Unit seconds[] = {{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}};
        static constexpr Unit bytes[] = {{"B/s", 1},    {"kB/s", 1e3},      {"MB/s", 1e6},
                                         {"GB/s", 1e9}, {"Mbit/s", 1.25e5}, {"Gbit/s", 1.25e8}};
        if (latency_.empty() != bandwidth_.empty())
            throw InputError("--latency and --bandwidth must be given together", "command line",
                             "give both, as in --latency 1.5us --bandwidth 12.5GB/s");
        if (latency_.empty()) return;
        request.latency = number_with_unit("--latency", latency_, seconds);
        request.seconds_a_byte = 1 / number_with_unit("--bandwidth", bandwidth_, bytes);
    }
    std::string scene_, ranks_, hosts_, network_, latency_, bandwidth_;
    bool explain_ = false, measure_ = false, calibrate_ = false;
};

}  // namespace

std::unique_ptr<Command> plan_command() { return std::make_unique<PlanCommand>(); }

}  // namespace catena::command
