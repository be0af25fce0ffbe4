#include "treacle/io/files/atomic_file.hpp"

#include "limited_files.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>

using namespace treacle;
using namespace treacle::test;
namespace fs = std::filesystem;

namespace {

std::size_t entries(const fs::path& directory) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory), fs::directory_iterator{}));
}

}  // namespace

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  TemporaryDirectory directory;
  {
    AtomicFile file(directory / "a");
    file.write("new");
    EXPECT_FALSE(fs::exists(directory / "a"));
    file.commit();
  }
  EXPECT_EQ(content(directory / "a"), "new");
  EXPECT_EQ(entries(directory.path()), 1u);
}

TEST(AtomicFile, ThrownAwayWithoutCommit) {
  TemporaryDirectory directory;
  writeFile(directory / "a", "old");
  { AtomicFile(directory / "a").write("new"); }
  EXPECT_EQ(content(directory / "a"), "old");
  EXPECT_EQ(entries(directory.path()), 1u);
}

TEST(AtomicFile, WritesPiecesOfAnySizeInOrder) {
  TemporaryDirectory directory;
  std::string expected;
  AtomicFile file(directory / "a");
  for (const std::size_t size : {1u, 1u << 20, 3u, (1u << 20) + 1, 5u << 20, 0u, 7u}) {
    const std::string piece(size, static_cast<char>('a' + expected.size() % 26));
    file.write(piece);
    expected += piece;
  }
  file.commit();
  EXPECT_TRUE(content(directory / "a") == expected);
}

TEST(AtomicFile, OverwritesWhatWasWritten) {
  TemporaryDirectory directory;
  AtomicFile file(directory / "a");
  const std::string large(3 << 20, 'x');
  file.write("0000 "), file.write(large), file.write(" 1111");
  EXPECT_EQ(file.size(), large.size() + 10);
  file.overwrite(0, "2222");
  file.overwrite(large.size() + 6, "3333");
  file.write("4");
  file.commit();
  EXPECT_EQ(content(directory / "a"), "2222 " + large + " 33334");
}

TEST(AtomicFile, FullDiskKeepsTheOldFileAndSaysWhy) {
  TemporaryDirectory directory;
  writeFile(directory / "a", "old");
  // One piece larger than the limit, then one that shows only when what was collected is flushed.
  for (const std::size_t size : {std::size_t{3} << 20, std::size_t{200} << 10}) {
    EXPECT_TRUE(withFileLimit(100 << 10, [&] {
      const std::string message = messageOf<RunError>([&] { writeFile(directory / "a", std::string(size, 'x')); });
      return message == "cannot write " + (directory / "a").string() + ": File too large";
    })) << size;
    EXPECT_EQ(content(directory / "a"), "old");
    EXPECT_EQ(entries(directory.path()), 1u);
  }
}

TEST(AtomicFile, DeviceWithoutSpace) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  TemporaryDirectory directory;
  // The temporary name leads to a device that takes nothing.
  fs::create_symlink("/dev/full", AtomicFile::temporaryName(directory / "a"));
  const std::string message = messageOf<RunError>([&] { writeFile(directory / "a", "text"); });
  EXPECT_NE(message.find("No space left on device"), std::string::npos) << message;
  EXPECT_EQ(entries(directory.path()), 0u);
}

TEST(AtomicFile, MissingDirectory) {
  TemporaryDirectory directory;
  const std::string message = messageOf<RunError>([&] { AtomicFile file(directory / "none/a"); });
  EXPECT_EQ(message, "cannot write " + (directory / "none/a").string() + ": No such file or directory");
}

TEST(AtomicFile, FailedRenameLeavesNothing) {
  TemporaryDirectory directory;
  fs::create_directories(directory / "a/b");
  EXPECT_THROW(writeFile(directory / "a", "text"), RunError);
  EXPECT_EQ(entries(directory.path()), 1u);
}

TEST(AtomicFile, LinksStayAndWhatTheyLeadToIsReplaced) {
  TemporaryDirectory directory;
  fs::create_directory(directory / "elsewhere");
  writeFile(directory / "elsewhere/a", "old");
  fs::create_symlink("elsewhere/a", directory / "link");
  fs::create_symlink("elsewhere/b", directory / "ahead");  // of a file that is not there yet
  for (const char* name : {"link", "ahead"}) {
    writeFile(directory / name, "new");
    EXPECT_TRUE(fs::is_symlink(directory / name));
    EXPECT_EQ(content(directory / name), "new");
  }
  EXPECT_EQ(entries(directory / "elsewhere"), 2u);
  EXPECT_EQ(entries(directory.path()), 3u);
}

TEST(AtomicFile, WhatIsNoFileIsWrittenToAndStays) {
  TemporaryDirectory directory;
  const fs::path pipe = directory / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0666), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  writeFile(pipe, "text");
  std::array<char, 10> got{};
  EXPECT_EQ(::read(reader, got.data(), got.size()), 4);
  EXPECT_STREQ(got.data(), "text");
  ::close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
  fs::create_symlink("/dev/null", directory / "null");
  writeFile(directory / "null", "text");
  EXPECT_TRUE(fs::is_symlink(directory / "null"));
  EXPECT_TRUE(fs::is_character_file(directory / "null"));
  EXPECT_EQ(entries(directory.path()), 2u);
}
