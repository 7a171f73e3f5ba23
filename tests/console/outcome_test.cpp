#include "console/outcome.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "command/session.hpp"
#include "console/text.hpp"
#include "integrate/chain_system.hpp"
#include "mpi/first_rank.hpp"
#include "plan/describe.hpp"
#include "reader/load_scene.hpp"

namespace catena::command {
namespace {

TEST(JsonText, NumbersReadBackToTheSameDoubles) {
    std::vector<double> const values{0.1,
                                     -1.0 / 3,
                                     1e-310,
                                     1.7976931348623157e308,
                                     5e-324,
                                     -0.0,
                                     123456789.123456789,
                                     std::nextafter(1.0, 2.0)};
    Json const json{{"values", values}};
    auto const back = Json::parse(json_text(json)).at("values").get<std::vector<double>>();
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(back[i], values[i]);
        EXPECT_EQ(std::signbit(back[i]), std::signbit(values[i]));
    }
}

TEST(JsonText, RowsStandOnLinesOfTheirOwn) {
    EXPECT_EQ(
        json_text({{"a", {1, 2}}, {"b", {{1, 2}, {3}}}, {"c", Json::object()}, {"d", nullptr}}),
        "{\n  \"a\": [1,2],\n  \"b\": [\n    [1,2],\n    [3]\n  ],\n  \"c\": {},\n  \"d\": "
        "null\n}\n");
}

TEST(JsonText, WhatJsonCannotHoldBecomesNullOrAMark) {
    EXPECT_EQ(json_text(std::numeric_limits<double>::quiet_NaN()), "null\n");
    EXPECT_EQ(Json::parse(json_text({{"title", "\xff"}})).at("title"), "\xef\xbf\xbd");
}

TEST(Session, AnInvalidOutcomeIsStatusOne) {
    auto const alone = serial_communicator();
    CommonOptions quiet;
    quiet.quiet = true;
    Session const session(*alone, quiet);
    EXPECT_EQ(session.conclude({"", {}, true}), 0);
    EXPECT_EQ(session.conclude({"", {}, false}), 1);
}

TEST(FirstRank, FailuresKeepTheirKind) {
    auto const alone = serial_communicator();
    EXPECT_THROW(on_first_rank(*alone, [] { throw InputError("wrong"); }), InputError);
    EXPECT_THROW(on_first_rank(*alone, [] { throw ComputationError("failed"); }), SharedError);
    EXPECT_THROW(on_first_rank(*alone, [] { throw std::out_of_range("far"); }), SharedError);
    EXPECT_NO_THROW(on_first_rank(*alone, [] {}));
}

TEST(Table, ColumnsAreAsWideAsTheirWidestCell) {
    Table table({"name", "n", "kind"}, {0, 2});
    table.add({"a", "10", "x"});
    table.add({"long one", "1", "yy"});
    EXPECT_EQ(table.text(""), "name       n  kind\na         10  x\nlong one   1  yy\n");
}

TEST(Text, DurationsAndBytesAsPeopleReadThem) {
    EXPECT_EQ(duration_text(2.5e-6), "2.5 us");
    EXPECT_EQ(duration_text(0.0123), "12.3 ms");
    EXPECT_EQ(duration_text(75), "75 s");
    EXPECT_EQ(duration_text(std::nan("")), "?");
    EXPECT_EQ(bytes_text(1.5e9), "1.5 GB");
}

TEST(Describe, EqualNeighboursAreOneRow) {
    Scene const scene = parse_scene(
        "chains:\n  - {name: a, count: 1000, generator: {freely_jointed: {beads: 5, length: 1}}}\n"
        "  - {name: b, generator: {freely_jointed: {beads: 6, length: 1}}}\n",
        "test");
    std::string const table = chain_table(scene).text("");
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);
    EXPECT_NE(table.find("a-1 .. a-1000"), std::string::npos) << table;
    EXPECT_EQ(chains_json(scene).size(), 1001U);
}

/// The estimate against what a solver of this size reports.
TEST(Describe, MemoryFollowsTheSolversOwnCount) {
    for (char const* const joint : {"link", "spherical", "revolute"})
        for (int const bodies : {1000, 40000}) {
            std::string const random =
                "{random: {bodies: " + std::to_string(bodies) + ", joint: " + joint + "}}";
            Scene const scene =
                parse_scene("units: si\nchains: [{generator: " + random + "}]", "test");
            auto const alone = serial_communicator();
            ChainSystem const system(scene, Axes::joint, *alone);
            auto const counted = static_cast<double>(system.solver_reports().front().memory_bytes);
            EXPECT_NEAR(memory_of(scene, 1).solver / counted, 1, 0.05) << joint << ", " << bodies;
            if (bodies == 1000) continue;  // so short that all joints are kept, however many ranks
            EXPECT_NEAR(memory_of(scene, 4).solver * 4 / counted, 1, 0.05) << joint;
        }
}

}  // namespace
}  // namespace catena::command
