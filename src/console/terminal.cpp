// Implements output to the terminal and the sink of the log.
#include "console/terminal.hpp"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "error.hpp"
#include "io/memory_limit.hpp"
#include "io/printable.hpp"

namespace catena::command {
namespace {

/// Sink of the log that writes printable lines to standard error and flushes each of them.
class StandardError : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
  protected:
    void sink_it_(spdlog::details::log_msg const& message) override {
        spdlog::memory_buf_t line;
        formatter_->format(message, line);
        std::fputs(printable({line.data(), line.size()}).c_str(), stderr);
        flush_();
    }
    void flush_() override { std::fflush(stderr); }
};

}  // namespace

char const* out_of_memory() {
    return is_limited_by_ulimit()
               ? "the computation does not fit into the memory that `ulimit -v` allows: raise the "
                 "limit, run it on more ranks, or make fewer bodies"
               : "the computation does not fit into memory: run it on more ranks, or make fewer "
                 "bodies";
}

void print(std::string const& text) {
    errno = 0;
    bool const written = std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0;
    int const cause = errno;
    if (!written && cause != EPIPE)
        throw ComputationError("cannot write to standard output: " +
                               std::string(std::strerror(cause)));
}

void say_error(std::string const& line) {
    // Failures of memory are recognised by their text, because ranks share nothing else of rank 0's
    // failure.
    bool const memory = line.find("std::bad_alloc") != std::string::npos ||
                        line.find("std::bad_array_new_length") != std::string::npos;
    std::string one = memory ? out_of_memory() : printable(line);
    std::replace(one.begin(), one.end(), '\n', ' ');
    std::fflush(stdout);
    std::fprintf(stderr, "catena: %s\n", one.c_str());
}

void start_log(std::string const& level) {
    auto const logger =
        std::make_shared<spdlog::logger>("catena", std::make_shared<StandardError>());
    logger->set_pattern("catena: %l: %v");
    logger->set_level(spdlog::level::from_str(level));
    spdlog::set_default_logger(logger);
}

bool is_quiet() { return spdlog::get_level() >= spdlog::level::err; }

}  // namespace catena::command
