// The options of `catena analyse` and `catena convert`.

#include "command/shared_options.hpp"
#include "scene/files.hpp"

namespace catena::command {
namespace {

constexpr double longest = 1e12;  // cutoffs and separations
constexpr std::string_view axis_names[] = {"x", "y", "z", "none"};
constexpr std::string_view wrap_names[] = {"none", "chains", "sites"};

/// Texts of the options that name a run and some of its frames.
struct FrameTexts {
    std::string folder, first, last;

    void add(OptionList& list) {
        list.argument("FOLDER", folder, "folder of a run, or its trajectory.h5md");
        list.value("--first", first, "FRAME", "first frame, counted from 0 (default 0)");
        list.value("--last", last, "FRAME", "last frame (default: the trajectory's)");
    }
    /// Throws InputError if no folder is named.
    void require_folder(std::string const& command) const {
        if (folder.empty())
            throw InputError("no folder is named", "command line",
                             "write catena " + command + " with the folder of a run");
    }
    /// Reads --first and --last into members `first` and `last` of a request.
    template <class R>
    void read(R& request) const {
        request.first = frame_number("--first", first, request.first);
        request.last = frame_number("--last", last, request.last);
    }

  private:
    static std::size_t frame_number(std::string const& option, std::string const& text,
                                    std::size_t otherwise) {
        return text.empty() ? otherwise : static_cast<std::size_t>(whole_number(option, text, 0));
    }
};

/// Reads the two numbers of --fit.
analysis::Range fit_range(std::string const& text) {
    std::vector<std::string> const parts = comma_list("--fit", text);
    if (parts.size() != 2)
        throw InputError("`" + text + "` is not two numbers", "--fit", "write MIN,MAX, as in 6,70");
    analysis::Range const range{number_between("--fit", parts[0], 1, longest),
                                number_between("--fit", parts[1], 1, longest)};
    if (!(range.least < range.most))
        throw InputError("`" + text + "` is no range", "--fit", "give the smaller number first");
    return range;
}

class AnalyseCommand final : public Command {
  public:
    std::string name() const override { return "analyse"; }
    std::string meaning() const override {
        return "sizes, scaling, contacts, densities and diffusion of a run, with errors";
    }
    SharedOptions shared() const override { return SharedOptions::answer; }
    void add_options(OptionList& list, CommonOptions&) override {
        frames_.add(list);
        list.value("--discard", discard_, "FRACTION",
                   "part of the frames to leave out at the start, from 0 to below 1 (default 0)");
        list.value("--output", output_, "DIR",
                   "folder for tables, maps and picture (default: FOLDER/analysis)");
        list.value("--cutoff", cutoff_, "R",
                   "longest distance of a contact (default 1 nm; units si: none; 0: no contacts)");
        list.value("--fit", fit_, "MIN,MAX",
                   "separations |i - j| that the scaling exponent is fitted to (default: 6 to half "
                   "the sites of a chain, a quarter of a ring's)");
        list.value("--slab", slab_, "AXIS",
                   "axis of the density profile: x | y | z | none (default: the longest edge of a "
                   "box with several chains, if it is 1.5 times the others)");
        list.value("--bins", bins_, "N", "bins of the density profile, even (default 200)");
        list.flag("--members", members_,
                  "take each member of a complex as a chain, in the order of its residues "
                  "(default: the whole complex)");
        list.footer(
            "Examples:\n  catena analyse asyn --discard 0.2\n"
            "  catena analyse slab --slab z --cutoff 0.8 --json slab.json --output slab-analysis");
    }
    Request request(CommonOptions const& common) const override {
        auto request = common_request<AnalyseRequest>(common);
        frames_.require_folder(name());
        request.folder = frames_.folder;
        request.output = output_;
        request.members = members_;
        read(request.options);
        return request;
    }

  private:
    void read(analysis::Options& options) const {
        frames_.read(options);
        if (!discard_.empty() && !frames_.first.empty())
            throw InputError("both --first and --discard", "command line", "leave one of them out");
        if (!discard_.empty()) options.discard = number_between("--discard", discard_, 0, 0.999999);
        if (!cutoff_.empty()) options.cutoff = number_between("--cutoff", cutoff_, 0, longest);
        if (!fit_.empty()) options.fit = fit_range(fit_);
        if (!bins_.empty())
            options.bins = static_cast<std::size_t>(whole_number("--bins", bins_, 10, 100000));
        if (options.bins % 2 != 0)
            throw InputError(bins_ + " is odd", "--bins", "give an even number");
        if (slab_.empty()) return;
        known_value("--slab", slab_, axis_names);
        options.find_slab = false;
        if (slab_ != "none") options.slab = slab_[0] - 'x';
    }
    FrameTexts frames_;
    bool members_ = false;
    std::string output_, discard_, cutoff_, fit_, slab_, bins_;
};

class ConvertCommand final : public Command {
  public:
    std::string name() const override { return "convert"; }
    std::string meaning() const override {
        return "write a run's trajectory as DCD or XTC, for VMD, GROMACS and other tools";
    }
    SharedOptions shared() const override { return SharedOptions::answer; }
    void add_options(OptionList& list, CommonOptions&) override {
        frames_.add(list);
        list.argument("FILE", file_,
                      "file to write, FILE.dcd or FILE.xtc; an existing one is replaced");
        list.value("--wrap", wrap_, "HOW",
                   "none (default): as simulated, chains whole | chains: each whole, its middle in "
                   "the box | sites: every site in the box");
        list.value("--precision", precision_, "N",
                   "positions of an XTC file are rounded to 1/N nm (default 1000)");
        list.footer(
            "Examples:\n  catena convert asyn asyn.dcd\n"
            "  catena convert asyn asyn.xtc --precision 10000\n"
            "  catena convert slab slab.dcd --wrap chains --first 100\n"
            "Open it with the run's topology: vmd asyn/topology.psf asyn.dcd");
    }
    Request request(CommonOptions const& common) const override {
        auto request = common_request<ConvertRequest>(common);
        frames_.require_folder(name());
        request.folder = frames_.folder;
        request.frames.file = file_;
        std::string const ending = scene::ending_of(file_);
        request.xtc = ending == ".xtc";
        if (ending != ".dcd" && !request.xtc)
            throw InputError(file_.empty() ? "no file is named"
                                           : "`" + file_ + "` is no name of a DCD or XTC file",
                             "command line", "name one that ends in .dcd or .xtc");
        frames_.read(request.frames);
        if (!precision_.empty() && !request.xtc)
            throw InputError("a DCD file is not rounded", "--precision",
                             "leave it out, or name a file that ends in .xtc");
        if (!precision_.empty())
            request.precision = number_between("--precision", precision_, 1, finest);
        if (wrap_.empty()) return request;
        known_value("--wrap", wrap_, wrap_names);
        if (wrap_ == "chains") request.frames.wrap = analysis::Wrap::chains;
        if (wrap_ == "sites") request.frames.wrap = analysis::Wrap::sites;
        return request;
    }

  private:
    static constexpr double finest = 1e7;  // positions per nm that single precision tells apart
    FrameTexts frames_;
    std::string file_, wrap_, precision_;
};

}  // namespace

std::unique_ptr<Command> analyse_command() { return std::make_unique<AnalyseCommand>(); }
std::unique_ptr<Command> convert_command() { return std::make_unique<ConvertCommand>(); }

}  // namespace catena::command
