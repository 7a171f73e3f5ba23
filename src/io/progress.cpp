// Implements the progress line.
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "clock.hpp"
#include "io/output.hpp"

namespace catena {
namespace {

constexpr double seconds_between_redraws = 0.2;
constexpr double first_interval = 1, longest_interval = 30;  // seconds between the lines of a log
constexpr std::int64_t widest_bar = 30, narrowest_bar = 8;   // characters

/// Formats a duration as "2 d 03 h", "1:02:03" or "2:03".
std::string duration(double seconds) {
    if (!std::isfinite(seconds) || seconds > 1e8) return "?";
    auto const whole = static_cast<std::int64_t>(std::llround(seconds));
    if (whole >= 86400) return fmt::format("{} d {:02} h", whole / 86400, whole / 3600 % 24);
    if (whole >= 3600)
        return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

/// Bar of `length` characters between brackets.
std::string bar(double fraction, std::size_t length) {
    auto const filled = static_cast<std::size_t>(fraction * static_cast<double>(length));
    return "[" + std::string(filled, '=') + std::string(length - filled, ' ') + "]";
}

/// Columns of the terminal, or 80 if unknown.
std::size_t width_of(int descriptor) {
    winsize size{};
    return ::ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

Progress::Progress(bool quiet, std::int64_t first_step, std::int64_t last_step, double time_step,
                   bool si, std::FILE* out)
    : quiet_(quiet),
      si_(si),
      terminal_(::isatty(::fileno(out)) == 1),
      out_(out),
      first_(first_step),
      last_(last_step),
      now_(first_step),
      time_step_(time_step),
      start_(seconds_now()),
      last_shown_(start_),
      interval_(terminal_ ? seconds_between_redraws : first_interval) {}

void Progress::update(std::int64_t step) {
    now_ = step;
    if (quiet_) return;
    double const moment = seconds_now();
    if (moment - last_shown_ < interval_) return;
    last_shown_ = moment;
    if (!terminal_) interval_ = std::min(2 * interval_, longest_interval);
    show(false);
}

void Progress::finish() {
    if (!quiet_) show(true);
}

double Progress::rate() const {
    double const elapsed = seconds_now() - start_;
    return elapsed > 0 ? static_cast<double>(now_ - first_) / elapsed : 0;
}

std::string Progress::line(bool last) const {
    double const steps = static_cast<double>(last_ - first_),
                 done = static_cast<double>(now_ - first_), speed = rate();
    double const fraction = steps > 0 ? std::clamp(done / steps, 0.0, 1.0) : 1;
    std::string text =
        fmt::format("{:5.1f} %  step {} of {}  {:.4g} steps/s", 100 * fraction, now_, last_, speed);
    if (!si_) text += fmt::format("  {:.4g} ns/day", speed * time_step_ * 86.4);
    text += last ? "  took " + duration(seconds_now() - start_)
                 : "  " + duration((steps - done) / speed) + " left";
    return text;
}

void Progress::show(bool last) const {
    std::string text = line(last);
    if (terminal_) {
        double const steps = static_cast<double>(last_ - first_);
        double const fraction =
            steps > 0 ? std::clamp(static_cast<double>(now_ - first_) / steps, 0.0, 1.0) : 1;
        std::size_t const width = width_of(::fileno(out_));
        auto const room =
            std::min<std::int64_t>(widest_bar, static_cast<std::int64_t>(width) -
                                                   static_cast<std::int64_t>(text.size()) - 4);
        if (room >= narrowest_bar)
            text = bar(fraction, static_cast<std::size_t>(room)) + " " + text;
        text = "\r" + text.substr(0, width - 1) + "\x1b[K";
    }
    if (!terminal_ || last) text += "\n";
    std::fputs(text.c_str(), out_);
    std::fflush(out_);
}

}  // namespace catena
