// The options of `catena import`.
#include "command/shared_options.hpp"

namespace catena::command {
namespace {

constexpr double longest_link = 1e6, shortest_link = 1e-9;  // nm

/// Reads FORCE=LENGTH. Throws InputError.
std::pair<std::string, double> link_of(std::string const& text) {
    auto const equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0)
        throw InputError("`" + text + "` names no force and length", "--links",
                         "write FORCE=LENGTH, as in CustomBondForce=0.97");
    return {text.substr(0, equals),
            number_between("--links", text.substr(equals + 1), shortest_link, longest_link)};
}

class ImportCommand final : public Command {
  public:
    std::string name() const override { return "import"; }
    std::string meaning() const override {
        return "write a scene from the folder of another tool: OpenMM System and topology";
    }
    SharedOptions shared() const override { return SharedOptions::answer; }
    void add_options(OptionList& list, CommonOptions&) override {
        list.argument("SOURCE", source_,
                      "folder (of the CALVADOS package, or any with one serialised System), or a "
                      "serialised System (XML)");
        list.argument("TOPOLOGY", topology_,
                      "PDB or mmCIF file with one atom per particle, or a serialised State with "
                      "positions (default: the folder's)");
        list.value("--output", output_, "SCENE",
                   "scene to write (default: the System's name with .yaml, in this folder)");
        list.value("--leave-out", leave_out_, "FORCE,...",
                   "forces of the System that shall not count, by name or kind");
        list.values("--links", links_, "FORCE=LENGTH",
                    "make the bonds of a CustomBondForce (FENE) rigid links of this length in nm "
                    "(may be repeated)");
        list.flag("--overwrite", overwrite_, "replace an existing scene");
        list.footer(
            "Examples:\n  catena import calvados-folder\n"
            "  catena import system.xml start.pdb --output mine.yaml\n"
            "  catena import system.xml state.xml --links FENE=0.97 --leave-out "
            "MonteCarloBarostat\n"
            "Temperature, friction and step are those of config.yaml (CALVADOS), of a serialised "
            "Integrator or of initArgs_N.h5 (polychrom) in the folder, else defaults, which are "
            "noted. The scene is checked before "
            "it is written.");
    }
    Request request(CommonOptions const& common) const override {
        if (source_.empty())
            throw InputError("no folder or System is named", "command line",
                             "write catena import FOLDER, or catena import SYSTEM.xml TOPOLOGY");
        auto request = common_request<ImportRequest>(common);
        request.source = source_;
        request.topology = topology_;
        request.output = output_;
        request.overwrite = overwrite_;
        if (!leave_out_.empty()) request.leave_out = comma_list("--leave-out", leave_out_);
        for (std::string const& link : links_) request.links.push_back(link_of(link));
        return request;
    }

  private:
    std::string source_, topology_, output_, leave_out_;
    std::vector<std::string> links_;
    bool overwrite_ = false;
};

}  // namespace

std::unique_ptr<Command> import_command() { return std::make_unique<ImportCommand>(); }

}  // namespace catena::command
