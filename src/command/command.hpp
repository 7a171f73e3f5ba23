// The commands as the command line sees them: each declares its options and makes its request of
// their values. command_line.cpp lists them.
#pragma once

#include <memory>
#include <string>

#include "console/command_parser.hpp"
#include "console/requests.hpp"

namespace catena::command {

/// Options that commands share, from few to all: --json, --quiet and --log-level; also --set and
/// those for keys of `solver`; also --backend for one backend.
enum class SharedOptions { answer, solver, backend };

/// A command of the command line. The texts of its options are members of the derived class.
class Command {
  public:
    Command() = default;
    virtual ~Command() = default;
    Command(Command const&) = delete;
    Command& operator=(Command const&) = delete;

    /// Returns the name on the command line.
    virtual std::string name() const = 0;
    /// Returns one line for the list of commands.
    virtual std::string meaning() const = 0;
    /// Returns which options of all commands this one has, after its own.
    virtual SharedOptions shared() const { return SharedOptions::backend; }
    /// Declares the options, with their help. `common` has the place of --refine, where that is one
    /// of them. The command must outlive the parser's list.
    virtual void add_options(OptionList&, CommonOptions& common) = 0;
    /// Returns the request. Throws InputError for what is missing, out of bounds or unknown.
    virtual Request request(CommonOptions const& common) const = 0;
};

/// Make one command each.
std::unique_ptr<Command> check_command();
std::unique_ptr<Command> plan_command();
std::unique_ptr<Command> solve_command();
std::unique_ptr<Command> run_command();
std::unique_ptr<Command> report_command();
std::unique_ptr<Command> bench_command();
std::unique_ptr<Command> keys_command();
std::unique_ptr<Command> analyse_command();
std::unique_ptr<Command> convert_command();
std::unique_ptr<Command> import_command();

}  // namespace catena::command
