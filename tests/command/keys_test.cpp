// `catena keys` prints what the reader declares.
#include <algorithm>

#include "tests/command/program.hpp"

namespace catena::test {
namespace {

/// Names of the maps in the answer's JSON.
Words maps_of(Ended const& e) {
    Words names;
    nlohmann::json const answer = e.json();
    for (auto const& map : answer["maps"]) names.push_back(map["map"]);
    return names;
}

TEST(KeysCommand, PrintsAMapWithTypeDefaultUnitMeaningAndExample) {
    Ended const e = catena({"keys", "dynamics"});
    expect_good(e);
    EXPECT_TRUE(e.out.starts_with("dynamics (dynamics)\n")) << e.out;
    EXPECT_NE(e.out.find("  friction             number >= 0; unit: 1 / time; default: 0.01"),
              std::string::npos)
        << e.out;
    EXPECT_NE(e.out.find("  friction: 0.01\n"), std::string::npos) << e.out;
    EXPECT_EQ(e.out.find("forces"), std::string::npos) << e.out;
}

TEST(KeysCommand, TakesMapsAndTheirPartsAndKeys) {
    EXPECT_EQ(maps_of(catena({"keys", "forces", "--json", "-"})),
              (Words{"forces", "forces.drag", "forces.openmm"}));
    EXPECT_EQ(maps_of(catena({"keys", "openmm", "--json", "-"})), (Words{"forces.openmm"}));
    Ended const key = catena({"keys", "temperature", "--json", "-"});
    EXPECT_EQ(maps_of(key), (Words{"forces.openmm", "dynamics"}));
    EXPECT_EQ(key.json()["maps"][1]["keys"].size(), 1U) << key.out;
    EXPECT_EQ(key.json()["maps"][1]["keys"][0]["unit"], "kelvin") << key.out;
}

TEST(KeysCommand, SaysWhatElseAKeyTakesThatMayBeAMap) {
    EXPECT_EQ(maps_of(catena({"keys", "model", "--json", "-"})), (Words{"chains", "chains.model"}));
    Ended const e = catena({"keys", "model"});
    EXPECT_NE(e.out.find("`calvados2`, `calvados3`, `calvados_rna`, or a map"), std::string::npos)
        << e.out;
    EXPECT_EQ(maps_of(catena({"keys", "drag", "--json", "-"})), (Words{"forces.drag"}));
}

TEST(KeysCommand, WithoutANamePrintsAllMaps) {
    Words const all = maps_of(catena({"keys", "--json", "-"}));
    EXPECT_GE(all.size(), 36U);
    for (std::string const name : {"scene", "chains", "bodies.joint", "solver", "output"})
        EXPECT_NE(std::find(all.begin(), all.end(), name), all.end()) << name;
}

TEST(KeysCommand, RefusesWhatIsNoKey) {
    expect_refused(catena({"keys", "frictoin"}), 2,
                   "`frictoin` is neither a key nor a map of keys (command line): did you mean "
                   "`friction`?");
    expect_refused(catena({"keys", "wallpaper"}), 2, "catena keys prints all of them");
    expect_refused(catena({"keys", "friction", "--set", "a=1"}), 2, "`--set` is not an option");
}

TEST(KeysCommand, ExplainsItselfWithExamples) {
    Ended const e = catena({"keys", "--help"});
    expect_good(e);
    EXPECT_NE(e.out.find("Usage: catena keys"), std::string::npos) << e.out;
    EXPECT_NE(e.out.find("Examples:\n  catena keys dynamics"), std::string::npos) << e.out;
    EXPECT_NE(catena({"--help"}).out.find("\n  keys "), std::string::npos);
}

}  // namespace
}  // namespace catena::test
