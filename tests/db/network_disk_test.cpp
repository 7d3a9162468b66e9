// tests/db/network_disk_test.cpp: the file systems where a log or a record is refused.
#include "db/network_disk.hpp"

#include "tests/temporary_folder.hpp"
#include <gtest/gtest.h>

namespace db {
namespace {

TEST(NetworkDisk, IsToldByTheNumberOfItsFileSystem) {
  // Numbers of statfs(2): NFS_SUPER_MAGIC, SMB2_MAGIC_NUMBER, EXT4_SUPER_MAGIC, TMPFS_MAGIC.
  EXPECT_EQ(network_file_system(0x6969), "NFS");
  EXPECT_EQ(network_file_system(0xFE534D42), "SMB");
  EXPECT_EQ(network_file_system(static_cast<unsigned long>(static_cast<int>(0xFE534D42))), "SMB");
  EXPECT_EQ(network_file_system(0xEF53), std::nullopt);
  EXPECT_EQ(network_file_system(0x01021994), std::nullopt);
}

TEST(NetworkDisk, ADiskOfThisMachineIsNotRefused) {
  const tests::TemporaryFolder folder;
  EXPECT_EQ(refusal_on_network((folder.path() / "missing.db").string()), std::nullopt);
  EXPECT_EQ(refusal_on_network(folder.path().string()), std::nullopt);
}

}  // namespace
}  // namespace db
