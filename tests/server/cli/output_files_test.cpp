// tests/server/cli/output_files_test.cpp: outputs are tried before the work, and leave no trace.
#include "server/cli/output_files.hpp"

#include <filesystem>

#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "server/run/text_file.hpp"

namespace server {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class OutputFilesTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

 private:
  tests::TemporaryFolder folder_{};
};

TEST_F(OutputFilesTest, AGoodPathIsAllowedAndNothingStays) {
  EXPECT_EQ(refuse_unwritable(path("new.csv")), "");
  EXPECT_FALSE(fs::exists(path("new.csv")));
  write_text(path("old.csv"), "kept");
  EXPECT_EQ(refuse_unwritable(path("old.csv")), "");
  EXPECT_EQ(read_text(path("old.csv")), "kept");
}

TEST_F(OutputFilesTest, AFileThatCannotBeWrittenIsRefused) {
  EXPECT_THAT(refuse_unwritable(path("none/new.csv")),
              StartsWith(path("none/new.csv") + ": cannot be written: "));
  EXPECT_FALSE(fs::exists(path("none")));
  EXPECT_THAT(refuse_unwritable(path("")), HasSubstr("is a folder"));
  EXPECT_THAT(refuse_unwritable(path("new/")), HasSubstr("cannot be written"));
  EXPECT_THAT(refuse_unwritable(path(std::string(300, 'x'))), HasSubstr("cannot be written"));
  EXPECT_THAT(refuse_unwritable(""), HasSubstr("the name of a file"));
}

TEST_F(OutputFilesTest, PipesDevicesAndLinksAreLeftAlone) {
  EXPECT_EQ(refuse_unwritable("/dev/null"), "");
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_EQ(refuse_unwritable(path("pipe")), "");
  fs::create_symlink(path("target"), path("link"));
  EXPECT_EQ(refuse_unwritable(path("link")), "");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_FALSE(fs::exists(path("target")));
}

TEST_F(OutputFilesTest, ADocumentMayLieInNewFolders) {
  EXPECT_EQ(refuse_unwritable_document(path("docs/new/a.md")), "");
  EXPECT_FALSE(fs::exists(path("docs")));
  write_text(path("file"), "");
  EXPECT_THAT(refuse_unwritable_document(path("file/a.md")), HasSubstr("cannot be written"));
  EXPECT_THAT(refuse_unwritable_document(path("file/new/a.md")), HasSubstr("cannot be written"));
  EXPECT_THAT(refuse_unwritable_document(path("new/")), HasSubstr("cannot be written"));
  EXPECT_THAT(refuse_unwritable_document(path("")), HasSubstr("is a folder"));
}

TEST_F(OutputFilesTest, OneFileIsNotWrittenTwiceNorOverAnInput) {
  write_text(path("in.log"), "");
  fs::create_hard_link(path("in.log"), path("hard"));
  fs::create_symlink(path("in.log"), path("soft"));
  const auto refused = [&](const std::string& first, const std::string& second) {
    try {
      refuse_shared_files({{"LOG", path("in.log")}}, {{"--poses", first}, {"--out", second}});
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused(path("a"), path("b")), "");
  EXPECT_EQ(refused("", ""), "");
  EXPECT_EQ(refused("/dev/null", "/dev/null"), "");
  EXPECT_THAT(refused(path("a"), path("new/../a")), HasSubstr("--poses and --out are one file"));
  for (const char* input : {"in.log", "./in.log", "hard", "soft"}) {
    EXPECT_THAT(refused("", path(input)), HasSubstr("LOG and --out are one file")) << input;
  }
}

}  // namespace
}  // namespace server
