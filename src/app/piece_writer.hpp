#pragma once

#include "output_thread.hpp"
#include "snapshot.hpp"
#include "treacle/core/communicator.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/frames/arrangement.hpp"
#include "treacle/io/tables/summary.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/step/run/any_simulation.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

namespace treacle {

/// A frame whose pieces are all on disk.
struct PiecedFrame {
  std::int64_t step = 0;
  FramePieces pieces;
  Arrangement arrangement;
  FrameCost cost;
};

/// Whether so many processes of a run that has so many particles write a piece of each frame each.
bool writesPieces(const Case& c, const ParticleNumbers& particles, std::uint64_t processes);

/// What the first process of those that share a run asks of all, itself included.
enum class PieceOrder : int { Take, Collect, Finish };

/// Writes the pieces of one process, its own particles, by a thread of its own. That thread tells the other
/// processes nothing: what has become of the pieces they learn when the first one asks.
class PieceWriter {
 public:
  /// `directory`: on a file system that all processes have.
  PieceWriter(const Case& c, RunDirectory directory, const Communicator& processes);

  /// Does what is asked; collective. Take: copies the own particles, to be written as a piece of that frame; waits
  /// while two are still to be written. Collect: the frames that have become whole since the last time, in their
  /// order. Finish: the same once all are. Errors: RunError, at all processes, where a piece could not be written;
  /// those of the frames that are not known to be whole are then removed.
  std::vector<PiecedFrame> answer(AnySimulation& simulation, PieceOrder order, std::size_t frame);

  /// Whether this process has written pieces that nobody has asked for yet: else asking would be in vain.
  bool hasNews() const { return hasNews_; }

 private:
  struct Piece {
    std::int64_t step = 0;
    double time = 0;                     // [s]
    std::uint32_t fluid = 0, walls = 0;  // particles
    ArrangementPart arrangement;
    FrameCost cost;
  };

  void take(AnySimulation& simulation, std::size_t frame);
  std::vector<PiecedFrame> collect();
  PiecedFrame joined(const Piece& own) const;
  void write(const Snapshot& snapshot);
  std::uint64_t writePiece(const std::filesystem::path& path, const Frame& piece) const;
  void removePieces();

  const Case& case_;
  RunDirectory directory_;
  const Communicator& processes_;
  std::deque<std::size_t> open_;  // frames that were taken and are not whole yet
  std::atomic<bool> hasNews_ = false;
  std::mutex mutex_;           // of the next two
  std::deque<Piece> written_;  // of the first open frames
  std::string failure_;
  OutputThread output_;  // last: it uses the others
};

}  // namespace treacle
