// Every refusal is the one line that its case says, in the grammar of all messages.
#include <regex>

#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

TEST_P(Refused, in_one_line) {
    std::string const message = refusal_of(GetParam().yaml);
    EXPECT_EQ(message, GetParam().message);
    static std::regex const grammar(
        R"(not in this version: \S.* \(s\.yaml: .*\)|\S.* \(s\.yaml.*\): \S.*)");
    EXPECT_TRUE(std::regex_match(message, grammar)) << message;
}

}  // namespace
}  // namespace catena::test
