// Damaged texts of Systems: a line and no crash, and no force is lost.
#include <OpenMM.h>

#include <random>

#include "systems/model.hpp"
#include "systems/xml_scan.hpp"
#include "tests/force/beads.hpp"
#include "tests/force/every_force.hpp"

namespace catena::testing {
namespace {

std::string const where = "scene.yaml: forces.openmm.system";

std::string scanned(std::string const& text) {
    return complaint([&] { scan_system_xml(text, "s.xml", where); });
}

std::string in_system(std::string const& inner) {
    return "<?xml version=\"1.0\" ?>\n<System openmmVersion=\"8\" type=\"System\" "
           "version=\"1\">\n" +
           inner + "\n</System>\n";
}

void expect_fault(std::string const& text, std::string const& fault) {
    EXPECT_NE(scanned(text).find("s.xml is not well-formed: " + fault), std::string::npos)
        << scanned(text);
}

/// A System with some forces of different kinds.
std::string small_system() { return xml_of(*every_force(proteins({"KDEKH"}))); }

/// How many forces OpenMM reads there; -1: refused in one line.
int forces_read(std::string const& text) {
    try {
        return read_openmm_system(scratch_file("damaged.xml", text), where)->getNumForces();
    } catch (InputError const& e) {
        EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
        return -1;
    }
}

TEST(XmlScan, TellsTheForces) {
    auto const outline =
        scan_system_xml(in_system("<!-- a > b --><Forces><Force type='A' energy='1 &lt; 2' "
                                  "function='80e4x'/>\n<Force type=\"B\"><CVs><CV>"
                                  "<Force type=\"C\"/></CV></CVs></Force></Forces>"),
                        "s.xml", where);
    EXPECT_EQ(outline.type, "System");
    EXPECT_EQ(outline.version, "8");
    EXPECT_EQ(outline.forces, (std::vector<std::string>{"A", "B"}));
}

TEST(XmlScan, NamesTheFaultAndItsLine) {
    expect_fault(in_system("<Forces>\n<Force type=\"A\">\n</Forces>"),
                 "</Forces> closes <Force> (line 5)");
    expect_fault(
        in_system("<Forces>\n<Force type=\"A\">\n<Bonds/>\n<Force type=\"B\"/></Force></Forces>"),
        "a <Force> is not closed before the next begins (2 lines below) (line 4)");
    expect_fault(in_system("<!-- open"), "a comment that is not closed (line 3)");
    expect_fault(in_system("<!-- a < b -->"), "a comment that holds `<` (line 3)");
    expect_fault("<?xml version=\"1\" <!> ?>\n" + in_system(""),
                 "a declaration that holds `<` (line 1)");
    expect_fault("<?xml <System", "a declaration that is not closed");
    expect_fault("<!DOCTYPE System>" + in_system(""), "a document type");
    expect_fault(in_system("") + "<System type=\"System\"/>", "a second element beside the System");
    expect_fault("<System type=\"System\">",
                 "<System> is not closed: the file is cut short or a line was lost");
    expect_fault(in_system("Bond d=\"1\"/>"), "`Bond d=\"1\"/>");
    expect_fault(in_system("<Bond d=\"1\""), "a tag or attribute without a name (line 4)");
    expect_fault("<System type=\"System\"><Bond d=\"1\"", "<Bond> has no `>`");
    expect_fault(in_system("<Bond d=1/>"), "the value of d has no quotes");
    expect_fault(in_system("<Bond d=\"1/>"), "the value of d has no closing quote");
    expect_fault(in_system("<Bond d=\"1\" d=\"2\"/>"), "attribute d is given twice");
    expect_fault(in_system("<Bond d=\"0.3x8\"/>"), "`0.3x8` of d is no number");
    expect_fault(in_system("<Bond d=\"x\"/>"), "`x` of d is no number");
    for (std::string const nan : {"nan", "NaN", "-nan", "nan(1)"})
        for (std::string const element : {"Particle", "Parameter", "Force"})
            expect_fault(in_system("<" + element + " q=\"" + nan + "\"/>"),
                         "`" + nan + "` of q is no number");
    EXPECT_NO_THROW(scan_system_xml(in_system("<Value v=\"nan\"/>"), "s.xml", where));
    EXPECT_NO_THROW(scan_system_xml(in_system("<Force name=\"nan\"/>"), "s.xml", where));
    expect_fault(in_system("<Force cutoff=\"2n\"/>"), "`2n` of cutoff is no number");
    expect_fault(in_system("<Forces/><Forces/>"), "<Forces> is there twice in <System>");
    expect_fault(in_system("<Forces><Force type=\"A\"><Bonds/><Bonds/></Force></Forces>"),
                 "<Bonds> is there twice in <Force>");
    expect_fault(in_system("<Force name=\"a\x01\"/>"), "a control character in the value of name");
    expect_fault("", "it has no element");
}

TEST(XmlScan, DeepNestingIsRefused) {
    std::string deep;
    for (int i = 0; i < 100000; ++i) deep += "<a>";
    expect_fault(in_system(deep), "elements lie more than 64 deep in each other");
    EXPECT_EQ(forces_read(in_system(deep)), -1);
}

TEST(XmlScan, ManyAttributesAndChildrenTakeLinearTime) {
    std::string attributes, children;
    for (int i = 0; i < 200000; ++i) {
        attributes += " a" + std::to_string(i) + "=\"1\"";
        children += "<a" + std::to_string(i) + "/>";
    }
    EXPECT_NO_THROW(scan_system_xml(
        in_system("<Bond" + attributes + "/><Force>" + children + "</Force>"), "s.xml", where));
    expect_fault(in_system("<Bond" + attributes + " a7=\"1\"/>"), "attribute a7 is given twice");
}

TEST(XmlScan, ListsOfTypesAndForcesWithinForcesAreLetIn) {
    EXPECT_NO_THROW(scan_system_xml(
        in_system("<Forces><Force type=\"CustomManyParticleForce\"><TypeFilters><Filter "
                  "index=\"0\" types=\"0,1\"/>"
                  "</TypeFilters></Force></Forces>"),
        "s.xml", where));
    auto const outline =
        scan_system_xml(in_system("<Forces><Force type=\"ATMForce\"><Forces><Force><Force "
                                  "type=\"A\"/></Force><Force><Force type=\"B\"/></Force></Forces>"
                                  "</Force></Forces>"),
                        "s.xml", where);
    EXPECT_EQ(outline.forces, (std::vector<std::string>{"ATMForce"}));
}

TEST(XmlScan, EveryForceIsAccepted) {
    auto const system = every_force(proteins({random_sequence(30, 1)}));
    EXPECT_EQ(forces_read(xml_of(*system)), system->getNumForces());
    EXPECT_EQ(forces_read("\xEF\xBB\xBF" + xml_of(*system) + "<!-- end -->\n"),
              system->getNumForces());
}

TEST(XmlScan, ASystemCutAnywhereIsRefused) {
    std::string const xml = small_system();
    std::size_t const end = xml.rfind("</System>") + 9;
    for (std::size_t size = 0; size < end; ++size)
        ASSERT_NE(scanned(xml.substr(0, size)).find("s.xml is not well-formed: "),
                  std::string::npos)
            << size;
    for (std::size_t size = 0; size < end; size += 97)
        EXPECT_EQ(forces_read(xml.substr(0, size)), -1) << size;
}

TEST(XmlScan, NoForceIsLostWithALine) {
    std::string const xml = small_system();
    int const forces = forces_read(xml);
    ASSERT_GT(forces, 5);
    for (std::size_t begin = 0; begin < xml.size();) {
        std::size_t const end = xml.find('\n', begin) + 1;
        std::string text = xml;
        text.erase(begin, end - begin);
        bool const opens_and_closes =
            xml.substr(begin, end - begin).find("<Force ") != std::string::npos &&
            xml.substr(begin, end - begin).find("/>") != std::string::npos;
        int const read = forces_read(text);
        EXPECT_TRUE(read == -1 || read == forces || opens_and_closes)
            << xml.substr(begin, end - begin);
        begin = end;
    }
}

TEST(XmlScan, NoForceIsLostToFlippedBytes) {
    std::string const xml = small_system();
    int const forces = forces_read(xml);
    std::mt19937 draw(1);
    int accepted = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        std::string text = xml;
        for (unsigned flips = 1 + draw() % 3; flips > 0; --flips)
            text[draw() % text.size()] ^= static_cast<char>(1U << (draw() % 8));
        int const read = forces_read(text);
        EXPECT_TRUE(read == -1 || read == forces) << trial;
        accepted += read >= 0;
    }
    EXPECT_GT(accepted, 100);  // digits of parameters
}

}  // namespace
}  // namespace catena::testing
