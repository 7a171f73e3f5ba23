// mmCIF and compressed files in a build without gemmi.
#include "tests/reader/scene_files.hpp"

namespace catena::test {
namespace {

TEST_F(SceneFiles, mmcif_without_gemmi) {
    write("a.pdb", "data_x\n");
    EXPECT_EQ(refusal(with_pdb_),
              "built without gemmi (mmCIF file a.pdb): install gemmi (gemmi-dev, zlib1g-dev) and "
              "build again, or write a PDB file: gemmi convert in.cif out.pdb");
    write("a.pdb", "\x1F\x8B");
    EXPECT_NE(refusal(with_pdb_).find("unpack it: gunzip"), std::string::npos);
}

}  // namespace
}  // namespace catena::test
