#include "piece_writer.hpp"

#include "treacle/core/error.hpp"
#include "treacle/core/timer.hpp"
#include "treacle/io/frames/vtp.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <span>
#include <system_error>
#include <utility>

namespace treacle {
namespace {

constexpr std::uint64_t manyParticles = 2'000'000;  // of a frame: 110 MB in single precision, uncompressed

/// Ghosts, and the walls near the own particles.
template <int D>
std::vector<Vec<3>> positionsOfOthers(const Particles<D>& p) {
  std::vector<Vec<3>> positions;
  positions.reserve(p.count - p.fluidCount);
  for (std::uint32_t i = p.fluidCount; i < p.count; ++i)
    if (!p.has.sides || !(p.side[i] & sides::ofSheet)) positions.push_back(resized<3>(p.position[i]));
  return positions;
}

}  // namespace

bool writesPieces(const Case& c, const ParticleNumbers& particles, std::uint64_t processes) {
  if (processes <= 1 || c.output.pieces == OutputPieces::One || c.output.surface) return false;
  return c.output.pieces == OutputPieces::Each || particles.fluid + particles.wall >= manyParticles;
}

PieceWriter::PieceWriter(const Case& c, RunDirectory directory, const Communicator& processes)
    : case_(c),
      directory_(std::move(directory)),
      processes_(processes),
      // OpenMP forgets in a new thread how many it was given.
      output_([this, threads = omp_get_max_threads()](const Snapshot& snapshot) {
        omp_set_num_threads(threads);
        write(snapshot);
      }) {}

std::vector<PiecedFrame> PieceWriter::answer(AnySimulation& simulation, PieceOrder order, std::size_t frame) {
  if (order == PieceOrder::Take) {
    take(simulation, frame);
    return {};
  }
  if (order == PieceOrder::Finish) output_.wait();
  return collect();
}

void PieceWriter::take(AnySimulation& simulation, std::size_t frame) {
  Snapshot& snapshot = output_.next();
  snapshot.ownWalls = simulation.copyOwnParticles(snapshot.particles);
  snapshot.step = simulation.step(), snapshot.time = simulation.time();
  snapshot.number = frame;
  open_.push_back(frame);
  output_.handOver();
}

std::vector<PiecedFrame> PieceWriter::collect() {
  std::deque<Piece> whole;
  std::string failure;
  {
    const std::lock_guard lock(mutex_);
    whole = written_;
    failure = std::exchange(failure_, {});
    hasNews_ = false;
  }
  if (const Communicator::RankText first = processes_.first(failure); !first.text.empty()) {
    removePieces();
    throw RunError(fmt::format("rank {}: {}", first.rank, first.text));
  }
  const std::vector<std::size_t> counts = processes_.all(whole.size());
  whole.resize(*std::ranges::min_element(counts));
  std::vector<PiecedFrame> frames;
  for (const Piece& own : whole) frames.push_back(joined(own));
  open_.erase(open_.begin(), open_.begin() + static_cast<std::ptrdiff_t>(frames.size()));
  const std::lock_guard lock(mutex_);
  written_.erase(written_.begin(), written_.begin() + static_cast<std::ptrdiff_t>(frames.size()));
  hasNews_ = !written_.empty();
  return frames;
}

PiecedFrame PieceWriter::joined(const Piece& own) const {
  struct Part {
    std::uint32_t fluid, walls;
    double least, density;
    std::uint64_t close, places;
    FrameCost cost;
  };
  const ArrangementPart& a = own.arrangement;
  const std::vector<Part> parts =
      processes_.all(Part{own.fluid, own.walls, a.least, a.density, a.close, a.places, own.cost});
  PiecedFrame frame{own.step, {own.time, case_.dimensions, {}, {}}, {}, {}};
  ArrangementPart all;
  for (int rank = 0; const Part& part : parts) {
    if (part.fluid > 0) frame.pieces.fluid.push_back(rank);
    if (part.walls > 0) frame.pieces.walls.push_back(rank);
    all.least = std::min(all.least, part.least);
    frame.cost.bytes += part.cost.bytes;
    frame.cost.seconds = std::max(frame.cost.seconds, part.cost.seconds);
    all.density += part.density, all.close += part.close, all.places += part.places;
    ++rank;
  }
  all.distances = a.distances;
  processes_.sum(std::span(all.distances));
  frame.arrangement = arrangementOf(all);
  return frame;
}

/// Called by the output thread. What fails is for all processes to know, who learn it in collect().
void PieceWriter::write(const Snapshot& s) {
  Timer timer;
  Piece piece{s.step, s.time, 0, 0, {}, {}};
  std::string failure;
  try {
    s.particles.visit([&](const auto& p) {
      const std::uint32_t begin = p.wallBegin();
      piece.fluid = p.fluidCount;
      Frame fluid = makeFrame(p, 0, p.fluidCount, s.time);
      addViscosities(case_, fluid);
      piece.arrangement = measureArrangementPart(fluid, positionsOfOthers(p), case_.domain, case_.spacing);
      const Frame walls = makeFrame(p, begin, begin + s.ownWalls, s.time);
      piece.walls = static_cast<std::uint32_t>(walls.position.size());
      piece.cost.bytes = writePiece(directory_.fluidPiece(s.number, processes_.rank()), fluid) +
                         writePiece(directory_.wallsPiece(s.number, processes_.rank()), walls);
    });
    piece.cost.seconds = timer.lap();
  } catch (const std::bad_alloc&) {
    failure = "memory exhausted";
  } catch (const std::exception& e) {
    failure = e.what();
  }
  const std::lock_guard lock(mutex_);
  if (failure.empty() && failure_.empty()) written_.push_back(std::move(piece));
  if (failure_.empty()) failure_ = std::move(failure);
  hasNews_ = true;
}

std::uint64_t PieceWriter::writePiece(const std::filesystem::path& path, const Frame& piece) const {
  const OutputSettings& settings = case_.output;
  if (piece.position.empty()) return 0;
  return writeVtp(path, piece, settings.fields, settings.precision, settings.compression);
}

void PieceWriter::removePieces() {
  output_.wait();
  std::error_code error;  // what cannot be removed stays
  for (const std::size_t frame : open_) {
    std::filesystem::remove(directory_.fluidPiece(frame, processes_.rank()), error);
    std::filesystem::remove(directory_.wallsPiece(frame, processes_.rank()), error);
  }
  open_.clear();
  const std::lock_guard lock(mutex_);
  written_.clear();
  failure_.clear();
  hasNews_ = false;
}

}  // namespace treacle
