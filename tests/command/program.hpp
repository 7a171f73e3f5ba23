// The executable as a user calls it.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace catena::test {

struct Ended {
    int status = -1;  // -1: did not start, or was killed
    std::string out, err;
    nlohmann::json json() const { return nlohmann::json::parse(out); }
};

using Words = std::vector<std::string>;

/// catena WORDS... in `folder` (empty: this one).
Ended catena(Words const& words, std::string const& folder = "");
/// The same by mpirun.
Ended catena_on(int ranks, Words const& words, std::string const& folder = "");
/// Any program; `environment` adds to this one's.
Ended run_program(Words const& words, std::string const& folder = "",
                  Words const& environment = {});

std::string program();
/// A scene of inputs/.
std::string input(std::string const& name);

inline std::size_t count(std::string const& text, std::string const& part) {
    std::size_t found = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size()))
        ++found;
    return found;
}

/// Good, and nothing said on standard error.
inline void expect_good(Ended const& e) {
    EXPECT_EQ(e.status, 0) << e.err << e.out;
    EXPECT_EQ(e.err, "");
}
/// One line "catena: ..." that holds `part`, nothing on standard output.
inline void expect_refused(Ended const& e, int status, std::string const& part) {
    EXPECT_EQ(e.status, status) << e.out;
    EXPECT_EQ(e.out, "");
    EXPECT_TRUE(e.err.starts_with("catena: ")) << e.err;
    EXPECT_EQ(count(e.err, "\n"), 1U) << e.err;
    EXPECT_NE(e.err.find(part), std::string::npos) << e.err;
}

}  // namespace catena::test
