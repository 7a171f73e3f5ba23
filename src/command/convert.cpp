// `catena convert`: a run's trajectory in another format.
#include <fmt/format.h>

#include <cmath>

#include "analysis/dcd.hpp"
#include "analysis/xtc.hpp"
#include "command/commands.hpp"
#include "console/option_values.hpp"
#include "console/text.hpp"
#include "mpi/first_rank.hpp"

namespace catena::command {
namespace {

/// Report on the files written: lines for the terminal, values for JSON.
struct Written {
    std::string frames;
    Json json;
    std::vector<std::string> notes;
};

/// Returns what a reader of the file must know, because the format cannot hold it.
std::vector<std::string> notes_on(TrajectoryFile const& trajectory,
                                  analysis::DcdWritten const& written, std::size_t first) {
    std::vector<std::string> notes;
    if (written.left_out > 0)
        notes.push_back(fmt::format(
            "{} left out: a DCD file holds one interval, here {} steps",
            counted(static_cast<long long>(written.left_out), "frame was", "frames were"),
            written.interval));
    double const time = trajectory.times()[first],
                 shown = written.time_step * static_cast<double>(written.first_step);
    if (std::abs(time - shown) > 1e-6 * std::max(std::abs(time), written.time_step) &&
        written.frames > 1)
        notes.push_back(fmt::format(
            "the first frame is at {:.6g} ps, but readers of DCD files take step times time step, "
            "{:.6g} ps",
            time, shown));
    return notes;
}

Written as_dcd(TrajectoryFile const& trajectory, ConvertRequest const& request) {
    analysis::DcdWritten const written = analysis::write_dcd(trajectory, request.frames);
    return {fmt::format("{} of {} sites, from step {} every {} steps of {:.6g} ps", written.frames,
                        written.sites, written.first_step, written.interval, written.time_step),
            {{"frames", written.frames},
             {"sites", written.sites},
             {"first_step", written.first_step},
             {"interval", written.interval},
             {"time_step", written.time_step},
             {"left_out", written.left_out}},
            notes_on(trajectory, written, request.frames.first)};
}

Written as_xtc(TrajectoryFile const& trajectory, ConvertRequest const& request) {
    analysis::XtcWritten const written =
        analysis::write_xtc(trajectory, request.frames, request.precision);
    return {fmt::format("{} of {} sites, steps {} to {}, rounded to 1/{:g} nm, {:.3g} bytes a site",
                        written.frames, written.sites, written.first_step, written.last_step,
                        request.precision,
                        static_cast<double>(written.bytes) /
                            static_cast<double>(written.frames * written.sites)),
            {{"frames", written.frames},
             {"sites", written.sites},
             {"first_step", written.first_step},
             {"last_step", written.last_step},
             {"precision", request.precision},
             {"bytes", written.bytes}},
            {}};
}

}  // namespace

Outcome convert_run(Communicator const& communicator, ConvertRequest const& request) {
    Outcome outcome;
    on_first_rank(communicator, [&] {
        require_writable(request.xtc ? "FILE.xtc" : "FILE.dcd", request.frames.file);
        TrajectoryFile const trajectory(request.folder);
        Written written = request.xtc ? as_xtc(trajectory, request) : as_dcd(trajectory, request);
        Text text;
        text.heading(trajectory.topology().title);
        text.entry("trajectory", trajectory.name());
        text.entry("written", request.frames.file);
        text.entry("frames", written.frames);
        for (std::string const& note : written.notes) text.note(note);
        outcome.text = text.str();
        outcome.json = std::move(written.json);
        outcome.json["trajectory"] = trajectory.name();
        outcome.json["file"] = request.frames.file;
        outcome.json["notes"] = written.notes;
    });
    return outcome;
}

}  // namespace catena::command
