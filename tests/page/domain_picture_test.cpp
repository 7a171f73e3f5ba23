// The picture of rigid domains.
#include "page/domain_picture.hpp"

#include <gtest/gtest.h>

namespace catena::test {
namespace {

std::size_t count(std::string const& text, std::string const& part) {
    std::size_t found = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

DomainPicture two_domains(std::size_t residues) {
    DomainPicture picture{"Rigid domains of <a>", {}, {}, 70, 5, {}};
    picture.plddt.assign(residues, 90);
    picture.error = [residues](std::size_t i, std::size_t j) {
        return (i < residues / 2) == (j < residues / 2) ? 2.0 : 30.0;
    };
    picture.domains = {{0, residues / 2 - 1}, {residues / 2, residues - 1}};
    return picture;
}

TEST(DomainPicture, MarksDomainsInBothPanels) {
    std::string const svg = domain_pictures({two_domains(40)});
    EXPECT_TRUE(svg.starts_with("<svg xmlns="));
    EXPECT_EQ(count(svg, "fill=\"#ffe2b8\""), 2U);                       // bands
    EXPECT_EQ(count(svg, "stroke=\"#d55e00\" stroke-width=\"2\""), 2U);  // squares
    EXPECT_EQ(count(svg, "<polyline"), 1U);
    EXPECT_NE(svg.find("Rigid domains of &lt;a&gt;"), std::string::npos);
    EXPECT_NE(svg.find("pLDDT 70"), std::string::npos);
    EXPECT_NE(svg.find(">5 Å<"), std::string::npos);
    // Rows of equal cells are one rectangle, and the largest errors need none.
    EXPECT_EQ(count(svg, "fill=\"#115c2d\""), 40U + 1U);
}

TEST(DomainPicture, StaysSmallForLongChainsAndHoldsSeveral) {
    std::string const svg = domain_pictures({two_domains(900), two_domains(300)});
    EXPECT_LT(svg.size(), 200000U);
    EXPECT_EQ(count(svg, "<polyline"), 2U);
    EXPECT_EQ(count(svg, "<g transform="), 2U);
}

}  // namespace
}  // namespace catena::test
