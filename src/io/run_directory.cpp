#include "treacle/io/run_directory.hpp"

#include "posix.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/atomic_file.hpp"
#include "treacle/io/vtp.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

namespace treacle {

namespace fs = std::filesystem;

namespace {

std::string frameName(std::string_view group, std::size_t frame, std::string_view extension) {
  return fmt::format("frames/{}_{:06}.{}", group, frame, extension);
}

/// Whether the name is one that frameName gives, or its temporary form.
bool isFrameName(std::string_view name) {
  for (const std::string_view group : {"fluid_", "walls_"})
    for (const std::string_view extension : {".vtp", ".vtp.tmp", ".png", ".png.tmp"}) {
      if (!name.starts_with(group) || !name.ends_with(extension)) continue;
      if (name.size() < group.size() + 6 + extension.size()) continue;
      const auto number = name.substr(group.size(), name.size() - group.size() - extension.size());
      if (std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; })) return true;
    }
  return false;
}

[[noreturn]] void unusable(const fs::path& path, std::string_view why) {
  throw InputError(fmt::format("output directory {}: {}", path.string(), why));
}

void makeDirectory(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) unusable(path, fmt::format("cannot be created: {}", error.message()));
  if (::access(path.c_str(), W_OK | X_OK) != 0)
    unusable(path, fmt::format("not writable: {}", std::generic_category().message(errno)));
}

}  // namespace

RunDirectory RunDirectory::create(const fs::path& path, bool force) {
  RunDirectory run(path);
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_directory(status)) unusable(path, "exists and is no directory");
  makeDirectory(path);
  const bool empty = fs::is_empty(path, error);
  if (error) unusable(path, fmt::format("not readable: {}", error.message()));
  if (!empty) {
    if (!force)
      unusable(path, run.holdsRun() ? "holds a run already; choose another, or replace the run with --force"
                                    : "is not empty; choose another, or write into it with --force");
    if (!run.holdsRun() && fs::exists(run.caseFile(), error))
      unusable(path, "holds a case.toml but no run; the file would be overwritten, choose another directory");
  }
  run.lock();
  if (!empty) run.removeRun();
  makeDirectory(path / "frames");
  return run;
}

RunDirectory RunDirectory::open(const fs::path& path) {
  RunDirectory run(path);
  std::error_code error;
  if (!fs::exists(run.fluidIndex(), error))
    throw InputError(
        fmt::format("{}: not the directory of a run; expected to find fluid.pvd in it", path.string()));
  run.fluidFrames_ = readPvd(run.fluidIndex());
  // A run of an earlier version that was killed between the two left the fluid's alone.
  if (fs::exists(run.wallsIndex(), error)) run.wallsFrames_ = readPvd(run.wallsIndex());
  return run;
}

bool RunDirectory::holdsRun() const {
  std::error_code error;
  return fs::exists(fluidIndex(), error) || fs::exists(history(), error) || fs::exists(summary(), error) ||
         fs::exists(log(), error);
}

/// The lock goes with the process, however that ends. The file stays: another one of its name would not be locked.
void RunDirectory::lock() {
  const int descriptor = ::open(log().c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) unusable(path_, writeFailure(log(), errno));
  lock_ = std::shared_ptr<void>(nullptr, [descriptor](void*) { ::close(descriptor); });
  // A file system without locks does without.
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    unusable(path_, "another run is writing into it; choose another, or end that run first");
}

void RunDirectory::removeRun() const {
  std::vector<fs::path> files{caseFile(),   history(),    balance(),      summary(),       checkpoint(),
                              fluidIndex(), wallsIndex(), finalPicture(), historyPicture()};
  for (std::size_t i = 0, named = files.size(); i < named; ++i)
    files.push_back(AtomicFile::temporaryName(files[i]));
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path_ / "frames", error))
    if (isFrameName(entry.path().filename().string())) files.push_back(entry.path());
  for (const fs::path& file : files) {
    fs::remove(file, error);
    if (error) unusable(path_, fmt::format("cannot remove {}: {}", file.string(), error.message()));
  }
}

fs::path RunDirectory::fluidFrame(std::size_t frame) const { return path_ / frameName("fluid", frame, "vtp"); }
fs::path RunDirectory::wallsFrame(std::size_t frame) const { return path_ / frameName("walls", frame, "vtp"); }
fs::path RunDirectory::framePicture(std::size_t frame) const { return path_ / frameName("fluid", frame, "png"); }

void RunDirectory::writeFrame(const Frame& fluid, const Frame& walls, const OutputSettings& settings) {
  const std::size_t frame = frameCount();
  writeVtp(fluidFrame(frame), fluid, settings.fields, settings.precision);
  writeVtp(wallsFrame(frame), walls, settings.fields, settings.precision);
  fluidFrames_.push_back({fluid.time, frameName("fluid", frame, "vtp")});
  wallsFrames_.push_back({walls.time, frameName("walls", frame, "vtp")});
  // The index that makes a directory that of a run comes last.
  writePvd(wallsIndex(), wallsFrames_);
  writePvd(fluidIndex(), fluidFrames_);
}

}  // namespace treacle
