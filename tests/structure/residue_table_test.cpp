// Residue tables: those of the program, and the refusals of faulty ones.
#include "structure/residue_table.hpp"

#include <gtest/gtest.h>

#include <map>

#include "error.hpp"

namespace catena {
namespace {

std::string const header = "one,three,MW,lambdas,sigmas,q,bondlength\n";
std::string const glycine = "G,GLY,57.05,0.705884373367,0.45,0,0.38\n";

std::string refusal_of(std::string const& text) {
    try {
        parse_residue_table(text, "t.csv");
    } catch (InputError const& error) {
        return error.what();
    }
    return "accepted";
}

TEST(ResidueTables, OfTheProgramHaveTheTwentyAminoAcids) {
    for (char const* const name : {"calvados2", "calvados3"}) {
        ResidueTable const* const table = built_in_table(name);
        ASSERT_NE(table, nullptr);
        EXPECT_EQ(table->letters(), "ARNDCQEGHILKMFPSTWYV");
        for (ResidueType const& type : table->types()) EXPECT_EQ(type.bond, 0.38);
    }
    EXPECT_EQ(built_in_table("calvados"), nullptr);
    EXPECT_EQ(built_in_table(""), nullptr);
}

/// Numbers of the package's residues_C2RNA.csv; all bases have those of its letter r.
TEST(ResidueTables, OfRnaHaveOneBackboneAndAlikeBases) {
    ResidueTable const* const table = built_in_table("calvados_rna");
    ASSERT_NE(table, nullptr);
    EXPECT_EQ(table->letters(), "pACGUr");
    EXPECT_EQ(*table->find('p'), (ResidueType{'p', "RBC", 194.1, 0, 0.6954, -1, 0.59}));
    ResidueType base{'r', "RNA", 126.3, 1.18, 0.6238, 0, 0.54};
    EXPECT_EQ(*table->find('r'), base);
    for (char const letter : {'A', 'C', 'G', 'U'}) {
        base.letter = letter, base.name = letter;
        EXPECT_EQ(*table->find(letter), base);
    }
}

/// The stickiness that Cao and others publish (doi 10.1002/pro.5172); all else is that of CALVADOS
/// 2.
TEST(ResidueTables, OfCalvados3HaveThePublishedStickiness) {
    std::map<char, double> const lambda = {
        {'A', 0.3377244362031627}, {'R', 0.7407902764839954}, {'N', 0.3706962163690402},
        {'D', 0.092587557536158},  {'C', 0.5922529084601322}, {'Q', 0.3143449791669133},
        {'E', 0.000249590539426},  {'G', 0.7538308115197386}, {'H', 0.4087176216525476},
        {'I', 0.5130398874425708}, {'L', 0.5548615312993875}, {'K', 0.1380602542039267},
        {'M', 0.5170874160398543}, {'F', 0.8906449355499866}, {'P', 0.3469777523519372},
        {'S', 0.4473142572693176}, {'T', 0.2672387936544146}, {'W', 1.033450123574512},
        {'Y', 0.950628687301107},  {'V', 0.2936174211771383}};
    for (ResidueType const& before : built_in_table("calvados2")->types()) {
        ResidueType expected = before;
        expected.lambda = lambda.at(before.letter);
        EXPECT_EQ(*built_in_table("calvados3")->find(before.letter), expected) << before.name;
    }
}

TEST(ResidueTables, HaveColumnsInAnyOrder) {
    ResidueTable const table = parse_residue_table(
        "\xEF\xBB\xBF# comment\r\n\r\nthree,one,bondlength,q,MW,lambdas, sigmas\r\n"
        "peg,J,0.33,0,44.05,0.2,0.4 # polyethylene glycol\r\nRNA,r,0.54,-1,126.3,1.18,0.6238",
        "t.csv");
    ASSERT_EQ(table.types().size(), 2U);
    EXPECT_EQ(table.types()[0], (ResidueType{'J', "PEG", 44.05, 0.2, 0.4, 0, 0.33}));
    EXPECT_EQ(table.find('r')->charge, -1);
    EXPECT_EQ(table.find('R'), nullptr);
    EXPECT_EQ(table.find("RNA"), &table.types()[1]);
}

TEST(ResidueTables, WithWrongColumnsAreRefused) {
    std::string const remedy =
        "name the columns `" + header.substr(0, header.size() - 1) + "`, in any order";
    EXPECT_EQ(refusal_of("residue,mass,lambda,sigma,charge\nALA,71.07,0.27,0.504,0\n"),
              "`residue` is not a column of a residue table (t.csv: line 1): " + remedy);
    EXPECT_EQ(refusal_of("# x\none,three,MW,lambdas,sigmas,bondlength\n"),
              "the table has no column `q` (t.csv: line 2): " + remedy);
    EXPECT_EQ(refusal_of("one,three,MW,lambdas,sigmas,q\n"),
              "the table has no column `bondlength` (t.csv: line 1): add it: the bond length in "
              "nm, 0.38 for amino acids");
    EXPECT_EQ(refusal_of("one,one,MW\n"), "column `one` is there twice (t.csv: line 1): " + remedy);
    EXPECT_EQ(refusal_of(glycine),
              "`G` is not a column of a residue table (t.csv: line 1): " + remedy);
    EXPECT_EQ(refusal_of("# nothing\n"), "the table has no residues (t.csv): give a line `" +
                                             header.substr(0, header.size() - 1) +
                                             "`, then one residue per line");
}

TEST(ResidueTables, WithARepeatedResidueAreRefused) {
    EXPECT_EQ(refusal_of(header + glycine + "\nG,ALA,71.07,0.3,0.504,0,0.38\n"),
              "one-letter code `G` is also in line 2 (t.csv: line 4): keep one of the two lines");
    EXPECT_EQ(refusal_of(header + glycine + "A,gly,71.07,0.3,0.504,0,0.38\n"),
              "residue `GLY` is also in line 2 (t.csv: line 3): keep one of the two lines");
}

TEST(ResidueTables, WithoutANumberAreRefused) {
    EXPECT_EQ(refusal_of(header + "G,GLY,57.05,0.7,,0,0.38\n"),
              "residue `GLY` has no value in column `sigmas` (t.csv: line 2): give a number");
    EXPECT_EQ(refusal_of(header + "G,GLY,57.05,0.7,0.45,0\n"),
              "the line has 6 values, not 7 (t.csv: line 2): give 7 values, as the first line "
              "names them");
    EXPECT_EQ(
        refusal_of(header + "G,GLY,57.05,0.7,nan,0,0.38\n"),
        "`nan` in column `sigmas` is not a finite number (t.csv: line 2): give a decimal number "
        "such as 0.38");
    EXPECT_EQ(
        refusal_of(header + "G,GLY,57.05,0.7,0.45,-,0.38\n"),
        "`-` in column `q` is not a finite number (t.csv: line 2): give a decimal number such "
        "as 0.38");
}

TEST(ResidueTables, WithImpossibleSizesAreRefused) {
    auto const refused = [](std::string const& line, std::string const& what) {
        EXPECT_EQ(refusal_of(header + line), what) << line;
    };
    std::string const nm = " (t.csv: line 2): give nanometres above 0, at most 1.78";
    refused("G,GLY,57.05,0.7,-0.45,0,0.38\n", "`sigmas` of residue `GLY` is -0.45 nm" + nm);
    refused("G,GLY,57.05,0.7,4.5,0,0.38\n", "`sigmas` of residue `GLY` is 4.5 nm" + nm);
    refused("G,GLY,57.05,0.7,0.45,0,0\n", "`bondlength` of residue `GLY` is 0 nm" + nm);
    refused("G,GLY,57.05,0.7,0.45,0,3.8\n", "`bondlength` of residue `GLY` is 3.8 nm" + nm);
    refused("G,GLY,0.05705,0.7,0.45,0,0.38\n",
            "`MW` of residue `GLY` is 0.05705 amu (t.csv: line 2): give amu (g/mol), at least 1");
    refused("G,GLY,57.05,-0.7,0.45,0,0.38\n",
            "`lambdas` of residue `GLY` is -0.7 (t.csv: line 2): give the stickiness, 0 to 3");
    refused("G,GLY,57.05,0.7,0.45,57,0.38\n",
            "`q` of residue `GLY` is 57 e (t.csv: line 2): give elementary charges, -10 to 10");
}

TEST(ResidueTables, WithImpossibleCodesAreRefused) {
    EXPECT_EQ(refusal_of(header + "GL,GLY,57.05,0.7,0.45,0,0.38\n"),
              "`GL` is not a one-letter code (t.csv: line 2): give one letter in column `one`");
    EXPECT_EQ(refusal_of(header + "*,GLY,57.05,0.7,0.45,0,0.38\n"),
              "`*` is not a one-letter code (t.csv: line 2): give one letter in column `one`");
    EXPECT_EQ(
        refusal_of(header + "G,GLYC,57.05,0.7,0.45,0,0.38\n"),
        "`GLYC` is not a three-letter code (t.csv: line 2): give one to three letters or digits "
        "in column `three`");
}

}  // namespace
}  // namespace catena
