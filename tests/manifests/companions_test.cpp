#include "manifests/companions.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

TEST(Companions, AreMaterialLibrariesAndTheirTextures) {
  const test::TempFolder folder;
  folder.write("in/a.obj",
               "# mtllib no.mtl\nmtllib mat/two words.mtl\r\n  mtllib absent.mtl\nv 0 0 0\n");
  folder.write("in/mat/two words.mtl",
               "newmtl m\nmap_Kd -s 1 1 1 tex\\a b.png\n\tbump -bm 0.5 n.png\n"
               "map_Ks ../../secret.png\nmap_Ka /etc/hostname\nnorm absent.png\nKd 1 1 1\n");
  folder.write("in/mat/tex/a b.png", "png");
  folder.write("in/mat/n.png", "normals");
  folder.write("in/no.mtl", "");
  folder.write("secret.png", "not theirs");
  EXPECT_EQ(companions_of(folder / "in/a.obj"),
            (Paths{"mat/two words.mtl", "mat/tex/a b.png", "mat/n.png"}));
  folder.write("in/b.ply", "ply\ncomment TextureFile no.mtl\nend_header\ncomment TextureFile x\n");
  EXPECT_EQ(companions_of(folder / "in/b.ply"), Paths{"no.mtl"});
  EXPECT_EQ(companions_of(folder.write("in/c.stl", "solid")), Paths{});
}

TEST(Companions, AreCopiedAndReplaceNothing) {
  const test::TempFolder folder;
  folder.write("in/a.obj", "mtllib a.mtl\n");
  folder.write("in/a.mtl", "map_Kd t.png\n");
  folder.write("in/t.png", "");
  fs::create_directory(folder / "out");
  for (int i = 0; i < 2; ++i) copy_companions(folder / "in/a.obj", folder / "out/a.obj");
  EXPECT_EQ(test::read_all(folder / "out/a.mtl"), "map_Kd t.png\n");
  EXPECT_TRUE(fs::exists(folder / "out/t.png"));
  folder.write("out/a.mtl", "somebody's");
  EXPECT_THROW(copy_companions(folder / "in/a.obj", folder / "out/a.obj"), Error);
  EXPECT_EQ(test::read_all(folder / "out/a.mtl"), "somebody's");
}

}  // namespace
}  // namespace triglyph
