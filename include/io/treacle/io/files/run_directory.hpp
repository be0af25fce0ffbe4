#pragma once

#include "treacle/io/frames/frame.hpp"
#include "treacle/io/frames/pvd.hpp"
#include "treacle/io/surface/free_surface.hpp"
#include "treacle/model/case/case.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace treacle {

/// The files that make a frame: the ranks of the processes that have written pieces of each group, those that have
/// no particles of it apart.
struct FramePieces {
  double time = 0;  // [s]
  int dimensions = 3;
  std::vector<int> fluid, walls;
};

/// The directory that holds all files of one run; the only place that knows their names.
class RunDirectory {
 public:
  /// Makes the directory (and its parents). One that holds anything is taken only with `force`; the files of an
  /// older run are then removed, and nothing else. The log is locked while the object, or a copy of it, lives.
  /// Errors: InputError if it is not empty (without force), not writable or no directory, if it holds a
  /// case.toml but no run (that file is the user's and would be overwritten), or if another run writes into it.
  static RunDirectory create(const std::filesystem::path& path, bool force);

  /// The directory of a run that another process has created, for those that share the run with it.
  static RunDirectory joined(std::filesystem::path path) { return RunDirectory(std::move(path)); }

  /// Opens the directory of an existing run. Errors: InputError if there is none.
  static RunDirectory open(const std::filesystem::path& path);

  /// Errors: InputError if a file that somebody chose for a picture or a table is one that a run has written: what
  /// it needs to be read again, or continued. `option`: that named the file.
  static void requireForeign(const std::filesystem::path& file, std::string_view option);

  /// Makes the directory of the files of probes. Errors: RunError.
  void makeRoomForProbes() const;

  /// Writes fluid and walls as the next frame and brings both indices up to date. Returns the size of the two
  /// files [B]. Errors: RunError.
  std::uint64_t writeFrame(const Frame& fluid, const Frame& walls, const OutputSettings& settings);
  /// Makes these pieces, which stand under the names below, the next frame. A group that nobody has particles of
  /// has one file, as in writeFrame. Errors: RunError, also if a piece is not there.
  void joinPieces(const FramePieces& pieces);
  /// Writes the surface of the fluid in a frame; those in .vtp that are there have an index. Returns the size of
  /// the file [B]. Errors: RunError.
  std::uint64_t writeSurface(std::size_t frame, const FreeSurface& surface, SurfaceFormat format,
                             OutputCompression compression) const;
  std::size_t frameCount() const { return fluidFrames_.size(); }
  double frameTime(std::size_t frame) const { return fluidFrames_.at(frame).time; }  // [s]

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path caseFile() const { return path_ / "case.toml"; }
  std::filesystem::path log() const { return path_ / "run.log"; }
  std::filesystem::path history() const { return path_ / "history.csv"; }
  std::filesystem::path balance() const { return path_ / "balance.csv"; }
  std::filesystem::path rigidBodies() const { return path_ / "rigid_bodies.csv"; }
  std::filesystem::path probe(std::string_view name) const;
  std::filesystem::path probePicture(std::string_view name) const;
  std::filesystem::path summary() const { return path_ / "summary.json"; }
  std::filesystem::path checkpoint() const { return path_ / "checkpoint.h5"; }
  std::filesystem::path fluidIndex() const { return path_ / "fluid.pvd"; }
  std::filesystem::path wallsIndex() const { return path_ / "walls.pvd"; }
  std::filesystem::path fluidFrame(std::size_t frame) const;
  std::filesystem::path wallsFrame(std::size_t frame) const;
  /// The part of a frame that the process of this rank writes.
  std::filesystem::path fluidPiece(std::size_t frame, int rank) const;
  std::filesystem::path wallsPiece(std::size_t frame, int rank) const;

  std::filesystem::path surfaceIndex() const { return path_ / "surface.pvd"; }
  std::filesystem::path surfaceFile(std::size_t frame, SurfaceFormat format) const;

  std::filesystem::path finalPicture() const { return path_ / "final.png"; }
  std::filesystem::path historyPicture() const { return path_ / "history.png"; }
  std::filesystem::path framePicture(std::size_t frame) const;

 private:
  explicit RunDirectory(std::filesystem::path path) : path_(std::move(path)) {}
  bool holdsRun() const;
  void lock();
  void removeRun() const;
  std::filesystem::path framePath(std::string_view group, std::size_t frame,
                                  const std::vector<PvdEntry>& written) const;
  /// Brings both indices up to date.
  void addFrame(double time, std::string_view fluidExtension, std::string_view wallsExtension);
  std::string_view joinGroup(std::string_view group, const FramePieces& pieces,
                             const std::vector<int>& ranks) const;

  std::filesystem::path path_;
  std::vector<PvdEntry> fluidFrames_, wallsFrames_;
  std::shared_ptr<void> lock_;
};

}  // namespace treacle
