#include "treacle/io/files/run_directory.hpp"

#include "case/toml_string.hpp"
#include "posix.hpp"
#include "text_file.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/files/atomic_file.hpp"
#include "treacle/io/frames/pvtp.hpp"
#include "treacle/io/frames/vtp.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <string>
#include <system_error>

namespace treacle {

namespace fs = std::filesystem;

namespace {

std::string frameName(std::string_view group, std::size_t frame, std::string_view extension) {
  return fmt::format("frames/{}_{:06}.{}", group, frame, extension);
}

/// The extension of a process's part of a frame.
std::string pieceExtension(int rank) { return fmt::format("p{}.vtp", rank); }

/// Without its first digits, of which there must be `least` or more; nothing where there are fewer.
std::optional<std::string_view> withoutNumber(std::string_view text, std::size_t least) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789"), text.size());
  return end < least ? std::nullopt : std::optional(text.substr(end));
}

/// Whether the name is one that frameName gives, or its temporary form.
bool isFrameName(std::string_view name) {
  const std::string_view group = name.substr(0, name.find('_') + 1);
  if (group != "fluid_" && group != "walls_" && group != "surface_") return false;
  auto rest = withoutNumber(name.substr(group.size()), 6);
  if (rest && rest->ends_with(".tmp")) rest->remove_suffix(4);
  if (rest && rest->starts_with(".p"))
    if (const auto extension = withoutNumber(rest->substr(2), 1))
      rest = extension == ".vtp" ? extension : std::nullopt;
  return rest == ".vtp" || rest == ".pvtp" || rest == ".ply" || rest == ".png";
}

/// Likewise of probe() and probePicture(), for a probe of the case whose text this is: others' files may stand
/// there, too.
bool isProbeName(std::string_view name, const std::string& caseText) {
  if (name.ends_with(".tmp")) name.remove_suffix(4);
  if (!name.ends_with(".csv") && !name.ends_with(".png")) return false;
  return caseText.find(tomlString(name.substr(0, name.size() - 4))) != std::string::npos;
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

void RunDirectory::requireForeign(const fs::path& file, std::string_view option) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(file, error), folder = whole.parent_path();
  const auto isOf = [&](const fs::path& directory) {
    const RunDirectory run(directory);
    if (!run.holdsRun()) return false;
    const std::string name = whole.filename().string(), kind = whole.extension().string();
    if (folder != directory) return kind == ".vtp" || kind == ".pvtp" || kind == ".ply" || kind == ".csv";
    return name == "case.toml" || name == "run.log" || name == "checkpoint.h5" || name == "summary.json" ||
           kind == ".csv" || kind == ".pvd";
  };
  const bool inside = folder.filename() == "frames" || folder.filename() == "probes";
  if (fs::exists(whole, error) && (isOf(folder) || (inside && isOf(folder.parent_path()))))
    throw InputError(
        fmt::format("{} {}: a run has written this file; choose another name", option, file.string()));
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
  std::vector<fs::path> files{caseFile(),     history(),      balance(),       rigidBodies(),
                              summary(),      checkpoint(),   fluidIndex(),    wallsIndex(),
                              surfaceIndex(), finalPicture(), historyPicture()};
  for (std::size_t i = 0, named = files.size(); i < named; ++i)
    files.push_back(AtomicFile::temporaryName(files[i]));
  std::error_code error;
  const std::string caseText =
      holdsRun() && fs::exists(caseFile(), error) ? readTextFile(caseFile()) : std::string();
  for (const auto& entry : fs::directory_iterator(path_ / "frames", error))
    if (isFrameName(entry.path().filename().string())) files.push_back(entry.path());
  for (const auto& entry : fs::directory_iterator(path_ / "probes", error))
    if (isProbeName(entry.path().filename().string(), caseText)) files.push_back(entry.path());
  for (const fs::path& file : files) {
    fs::remove(file, error);
    if (error) unusable(path_, fmt::format("cannot remove {}: {}", file.string(), error.message()));
  }
}

void RunDirectory::makeRoomForProbes() const {
  std::error_code error;
  const fs::path probes = path_ / "probes";
  fs::create_directories(probes, error);
  if (error) throw RunError(fmt::format("cannot create {}: {}", probes.string(), error.message()));
}
fs::path RunDirectory::probe(std::string_view name) const { return path_ / fmt::format("probes/{}.csv", name); }
fs::path RunDirectory::probePicture(std::string_view name) const {
  return path_ / fmt::format("probes/{}.png", name);
}

fs::path RunDirectory::fluidFrame(std::size_t frame) const { return framePath("fluid", frame, fluidFrames_); }
fs::path RunDirectory::wallsFrame(std::size_t frame) const { return framePath("walls", frame, wallsFrames_); }
fs::path RunDirectory::fluidPiece(std::size_t frame, int rank) const {
  return path_ / frameName("fluid", frame, pieceExtension(rank));
}
fs::path RunDirectory::wallsPiece(std::size_t frame, int rank) const {
  return path_ / frameName("walls", frame, pieceExtension(rank));
}
fs::path RunDirectory::framePicture(std::size_t frame) const { return path_ / frameName("fluid", frame, "png"); }

fs::path RunDirectory::surfaceFile(std::size_t frame, SurfaceFormat format) const {
  return path_ / frameName("surface", frame, format == SurfaceFormat::Vtp ? "vtp" : "ply");
}

/// The index says which frames are in pieces.
fs::path RunDirectory::framePath(std::string_view group, std::size_t frame,
                                 const std::vector<PvdEntry>& written) const {
  const bool inPieces = frame < written.size() && written[frame].file.ends_with(".pvtp");
  return path_ / frameName(group, frame, inPieces ? "pvtp" : "vtp");
}

std::uint64_t RunDirectory::writeFrame(const Frame& fluid, const Frame& walls, const OutputSettings& settings) {
  const std::size_t frame = frameCount();
  const auto write = [&](const fs::path& path, const Frame& group) {
    return writeVtp(path, group, settings.fields, settings.precision, settings.compression);
  };
  const std::uint64_t bytes = write(fluidFrame(frame), fluid) + write(wallsFrame(frame), walls);
  addFrame(fluid.time, "vtp", "vtp");
  return bytes;
}

std::uint64_t RunDirectory::writeSurface(std::size_t frame, const FreeSurface& surface, SurfaceFormat format,
                                         OutputCompression compression) const {
  const fs::path path = surfaceFile(frame, format);
  if (format == SurfaceFormat::Ply) return writeSurfacePly(path, surface);
  const std::uint64_t bytes = writeSurfaceVtp(path, surface, compression);
  std::vector<PvdEntry> made;
  std::error_code error;
  for (std::size_t k = 0; k < frameCount(); ++k)
    if (fs::exists(surfaceFile(k, format), error)) made.push_back({frameTime(k), frameName("surface", k, "vtp")});
  writePvd(surfaceIndex(), made);
  return bytes;
}

void RunDirectory::joinPieces(const FramePieces& pieces) {
  const auto fluid = joinGroup("fluid", pieces, pieces.fluid), walls = joinGroup("walls", pieces, pieces.walls);
  addFrame(pieces.time, fluid, walls);
}

/// Returns the extension of what makes the group one.
std::string_view RunDirectory::joinGroup(std::string_view group, const FramePieces& pieces,
                                         const std::vector<int>& ranks) const {
  const std::size_t frame = frameCount();
  if (ranks.empty()) {
    Frame none;
    none.time = pieces.time, none.dimensions = pieces.dimensions;
    writeVtp(path_ / frameName(group, frame, "vtp"), none, {}, OutputPrecision::Single);
    return "vtp";
  }
  std::vector<std::string> names;
  for (const int rank : ranks) {
    const fs::path piece = path_ / frameName(group, frame, pieceExtension(rank));
    if (std::error_code error; !fs::exists(piece, error))
      throw RunError(fmt::format(
          "{} is not there, but rank {} has written it; expected a run directory on a file system that "
          "all processes have",
          piece.string(), rank));
    names.push_back(piece.filename().string());
  }
  writePvtp(path_ / frameName(group, frame, "pvtp"), names);
  return "pvtp";
}

void RunDirectory::addFrame(double time, std::string_view fluidExtension, std::string_view wallsExtension) {
  const std::size_t frame = frameCount();
  fluidFrames_.push_back({time, frameName("fluid", frame, fluidExtension)});
  wallsFrames_.push_back({time, frameName("walls", frame, wallsExtension)});
  try {
    // The index that makes a directory that of a run comes last.
    writePvd(wallsIndex(), wallsFrames_);
    writePvd(fluidIndex(), fluidFrames_);
  } catch (...) {
    fluidFrames_.pop_back(), wallsFrames_.pop_back();
    throw;
  }
}

}  // namespace treacle
