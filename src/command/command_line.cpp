// Implements the command line: the list of commands, and the request of the one that was given.
#include "command/command_line.hpp"

#include <algorithm>

#include "command/shared_options.hpp"
#include "report/version.hpp"

namespace catena::command {
namespace {

using Commands = std::vector<std::unique_ptr<Command>>;

/// Returns all commands, in the order of --help.
Commands all_commands() {
    Commands all;
    for (auto* const make :
         {check_command, plan_command, solve_command, run_command, report_command, bench_command,
          keys_command, analyse_command, convert_command, import_command})
        all.push_back(make());
    return all;
}

/// Returns a request that prints a text.
Answer answer(std::string text) {
    Answer a;
    a.text = std::move(text);
    return a;
}

/// Returns the words of the command line, parted by blanks.
std::string joined(int argc, char const* const* argv) {
    std::string words;
    for (int i = 0; i < argc; ++i) words += (i == 0 ? "" : " ") + std::string(argv[i]);
    return words;
}

}  // namespace

Request parse_command_line(int argc, char const* const* argv) {
    CommandParser parser("Catena: motion of very long articulated chains by divide and conquer.",
                         "catena");
    CommonOptions common;
    common.command_line = joined(argc, argv);
    bool version_asked = false;
    OptionList program = parser.program_options();
    program.flag("--version", version_asked, "print version, compiler and what is in the build");
    program.footer(
        "catena COMMAND --help explains a command. Commands run in parallel with mpirun -np P "
        "catena ...\nExit status: 0 success; 1 the computation failed or is INVALID; 2 the input "
        "is wrong; 3 a run was stopped by a signal and can be continued.");
    Commands const commands = all_commands();
    for (auto const& command : commands) {
        OptionList list = parser.add_command(command->name(), command->meaning());
        command->add_options(list, common);
        add_shared(list, common, command->shared());
    }
    if (std::string const help = parser.parse(argc, argv); !help.empty()) return answer(help);
    if (version_asked) return answer(version_text());
    if (parser.command().empty())
        throw InputError("no command is named", "command line", "see catena --help");
    auto const chosen = std::find_if(commands.begin(), commands.end(), [&](auto const& each) {
        return each->name() == parser.command();
    });
    return (*chosen)->request(common);
}

}  // namespace catena::command
