#include "treacle/io/files/atomic_file.hpp"

#include "posix.hpp"
#include "treacle/core/error.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

namespace treacle {

namespace {

constexpr std::size_t pendingLimit = 1 << 20;  // [B] what is collected before it goes to the system

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)), target_(path_) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  isFile_ = !fs::exists(status) || fs::is_regular_file(status) || fs::is_directory(status);
  // Loops fail at the end of it, as a name that cannot be opened.
  for (int links = 0; isFile_ && links < 40 && fs::is_symlink(target_, error); ++links)
    target_ = target_.parent_path() / fs::read_symlink(target_, error);
  temporary_ = temporaryName(target_);
  pending_.reserve(pendingLimit);  // before there is a file that would stay
  descriptor_ = isFile_ ? ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)
                        : ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor_ < 0) throw RunError(writeFailure(path_, errno));
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::write(const void* data, std::size_t bytes) {
  const char* first = static_cast<const char*>(data);
  size_ += bytes;
  if (pending_.size() + bytes > pendingLimit) flush();
  if (bytes > pendingLimit) {
    if (!writeAll(descriptor_, first, bytes)) fail();
  } else {
    pending_.insert(pending_.end(), first, first + bytes);
  }
}

void AtomicFile::overwrite(std::uint64_t place, const void* data, std::size_t bytes) {
  flush();
  if (!writeAllAt(descriptor_, place, static_cast<const char*>(data), bytes)) fail();
}

void AtomicFile::commit() {
  flush();
  if (isFile_ && ::fsync(descriptor_) != 0) fail();
  // Network file systems report a full disk as late as here.
  if (::close(std::exchange(descriptor_, -1)) != 0 ||
      (isFile_ && std::rename(temporary_.c_str(), target_.c_str()) != 0)) {
    const int error = errno;
    removeTemporary();
    throw RunError(writeFailure(path_, error));
  }
}

void AtomicFile::flush() {
  if (!writeAll(descriptor_, pending_.data(), pending_.size())) fail();
  pending_.clear();
}

void AtomicFile::fail() {
  const int error = errno;
  discard();
  throw RunError(writeFailure(path_, error));
}

void AtomicFile::discard() {
  if (descriptor_ < 0) return;
  ::close(std::exchange(descriptor_, -1));
  removeTemporary();
}

void AtomicFile::removeTemporary() {
  if (isFile_) ::unlink(temporary_.c_str());
}

void writeFile(const std::filesystem::path& path, std::string_view content) {
  AtomicFile file(path);
  file.write(content);
  file.commit();
}

}  // namespace treacle
