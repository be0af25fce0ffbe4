#include "treacle/io/files/row_file.hpp"

#include "posix.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/files/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace treacle {

RowFile::RowFile(std::filesystem::path path, const std::string& header) : path_(std::move(path)) {
  const std::string firstLine = header + '\n';
  writeFile(path_, firstLine);
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor_ < 0) throw RunError(writeFailure(path_, errno));
  size_ = static_cast<std::int64_t>(firstLine.size());
}

RowFile::~RowFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void RowFile::append(std::string row) {
  row += '\n';
  // The system would go on to take rows for a file that no longer has a name.
  struct stat state {};
  if (::fstat(descriptor_, &state) == 0 && state.st_nlink == 0)
    throw RunError(fmt::format("cannot write {}: it was removed while the run went on", path_.string()));
  if (!writeAll(descriptor_, row.data(), row.size())) {
    std::string message = writeFailure(path_, errno);
    if (::ftruncate(descriptor_, size_) != 0) message += "; its last row is incomplete";
    throw RunError(message);
  }
  size_ += static_cast<std::int64_t>(row.size());
}

}  // namespace treacle
