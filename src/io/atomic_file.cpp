#include "treacle/io/atomic_file.hpp"

#include "posix.hpp"
#include "treacle/core/error.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

namespace treacle {

namespace {

constexpr std::size_t pendingLimit = 1 << 20;  // [B] what is collected before it goes to the system

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)), temporary_(temporaryName(path_)) {
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw RunError(writeFailure(path_, errno));
  pending_.reserve(pendingLimit);
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::write(const void* data, std::size_t bytes) {
  const char* first = static_cast<const char*>(data);
  if (pending_.size() + bytes > pendingLimit) flush();
  if (bytes > pendingLimit) {
    if (!writeAll(descriptor_, first, bytes)) fail();
  } else {
    pending_.insert(pending_.end(), first, first + bytes);
  }
}

void AtomicFile::commit() {
  flush();
  if (::fsync(descriptor_) != 0) fail();
  // Network file systems report a full disk as late as here.
  if (::close(std::exchange(descriptor_, -1)) != 0 || std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    const int error = errno;
    ::unlink(temporary_.c_str());
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
  ::unlink(temporary_.c_str());
}

void writeFile(const std::filesystem::path& path, std::string_view content) {
  AtomicFile file(path);
  file.write(content);
  file.commit();
}

}  // namespace treacle
