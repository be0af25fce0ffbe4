#include "vtk_blocks.hpp"

#include "treacle/core/parallel.hpp"

#include <fmt/format.h>
#include <libdeflate.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

namespace treacle {
namespace {

constexpr int level = 2;  // the next ones make frames hardly smaller (docs/notes/output.md)

/// No deflated byte stands for more than this.
constexpr std::uint64_t mostExpansion = 1032;

using Compressor = std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)>;
using Decompressor = std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>;

/// A block on its way into a file.
struct Slot {
  std::vector<char> raw, packed;
  std::uint64_t bytes = 0;  // of what is to be written
  Compressor compressor{nullptr, libdeflate_free_compressor};

  Slot(std::uint64_t size, bool compress) : raw(size) {
    if (!compress) return;
    compressor.reset(libdeflate_alloc_compressor(level));
    if (!compressor) throw std::bad_alloc();
    packed.resize(libdeflate_zlib_compress_bound(compressor.get(), size));
  }

  void fill(const ArrayBytes& array, std::uint64_t begin, std::uint64_t end) {
    bytes = end - begin;
    array.copy(begin, end, raw.data());
    if (compressor)
      bytes = libdeflate_zlib_compress(compressor.get(), raw.data(), bytes, packed.data(), packed.size());
  }
  const char* data() const { return compressor ? packed.data() : raw.data(); }
};

/// Writes the blocks of an array, which threads fill as they come to it, in their order.
class BlockWriter {
 public:
  BlockWriter(AtomicFile& file, const ArrayBytes& array, bool compress) : file_(file), array_(array) {
    const std::uint64_t threads = compress ? static_cast<unsigned>(omp_get_max_threads()) : 1;
    sizes_.reserve(blocks());
    slots_.reserve(threads);
    while (slots_.size() < std::min(threads, blocks()))
      slots_.emplace_back(std::min(vtkBlock, array.size), compress);
  }

  /// Returns the bytes of each in the file.
  const std::vector<std::uint64_t>& write() {
    parallelFor(slots_.size(), 2, [this](std::size_t k) { work(slots_[k]); });
    if (failure_) std::rethrow_exception(failure_);
    return sizes_;
  }

 private:
  std::uint64_t blocks() const { return (array_.size + vtkBlock - 1) / vtkBlock; }

  void work(Slot& slot) {
    for (std::uint64_t k; (k = next_.fetch_add(1)) < blocks();) {
      slot.fill(array_, k * vtkBlock, std::min((k + 1) * vtkBlock, array_.size));
      std::unique_lock lock(mutex_);
      written_.wait(lock, [&] { return sizes_.size() == k || failure_; });
      if (failure_) return;
      try {
        file_.write(slot.data(), slot.bytes);
      } catch (...) {
        failure_ = std::current_exception();
      }
      sizes_.push_back(slot.bytes);
      written_.notify_all();
    }
  }

  AtomicFile& file_;
  const ArrayBytes& array_;
  std::vector<Slot> slots_;
  std::atomic<std::uint64_t> next_{0};
  std::mutex mutex_;  // of all below
  std::condition_variable written_;
  std::vector<std::uint64_t> sizes_;
  std::exception_ptr failure_;
};

using Sink = std::function<void(std::uint64_t, std::uint64_t, const char*)>;

bool readBytes(std::istream& stream, void* to, std::uint64_t bytes) {
  return static_cast<bool>(stream.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes)));
}

std::string readRaw(std::istream& stream, std::uint64_t size, std::uint64_t room,
                    const std::function<void()>& reserve, const Sink& sink) {
  std::uint64_t stored = 0;
  if (room < sizeof stored || !readBytes(stream, &stored, sizeof stored)) return "no size";
  if (stored != size) return fmt::format("{} bytes, expected {}", stored, size);
  if (room - sizeof stored < size) return "an end beyond that of the file";
  reserve();
  std::vector<char> block(std::min(size, vtkBlock));
  for (std::uint64_t begin = 0; begin < size; begin += vtkBlock) {
    const std::uint64_t end = std::min(begin + vtkBlock, size);
    if (!readBytes(stream, block.data(), end - begin)) return "bytes that cannot be read";
    sink(begin, end, block.data());
  }
  return {};
}

/// The table before the blocks of a compressed array.
struct BlockTable {
  std::uint64_t blockSize = 0;            // [B], uncompressed, of all but perhaps the last
  std::vector<std::uint64_t> compressed;  // [B], of each block

  /// Returns what is wrong, as readAppended.
  std::string read(std::istream& stream, std::uint64_t size, std::uint64_t room, std::uint64_t item) {
    std::array<std::uint64_t, 3> head{};
    if (room < sizeof head || !readBytes(stream, head.data(), sizeof head)) return "no table of blocks";
    const auto [blocks, length, last] = head;
    const bool fits = size == 0 ? blocks == 0
                                : length > 0 && length % item == 0 && size % length == last &&
                                      size / length + (last > 0 ? 1 : 0) == blocks;
    if (!fits)
      return fmt::format("{} blocks of {} bytes, the last of {}, expected {} bytes", blocks, length, last, size);
    room -= sizeof head;
    if (blocks > room / sizeof(std::uint64_t)) return "more blocks than the file";
    blockSize = length;
    compressed.resize(blocks);
    if (!readBytes(stream, compressed.data(), blocks * sizeof(std::uint64_t))) return "no table of blocks";
    room -= blocks * sizeof(std::uint64_t);
    std::uint64_t packed = 0;
    for (const std::uint64_t block : compressed) {
      if (block > room - packed) return "blocks that end beyond the file";
      packed += block;
    }
    return size / mostExpansion > packed ? fmt::format("{} bytes, too few for {}", packed, size) : std::string{};
  }
};

std::string readCompressed(std::istream& stream, const BlockTable& table, std::uint64_t size, const Sink& sink) {
  const Decompressor decompressor(libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (!decompressor) throw std::bad_alloc();
  std::vector<char> raw(std::min(table.blockSize, size)), packed;
  std::uint64_t begin = 0;
  for (const std::uint64_t bytes : table.compressed) {
    const std::uint64_t end = std::min(begin + table.blockSize, size);
    packed.resize(bytes);
    if (!readBytes(stream, packed.data(), bytes)) return "bytes that cannot be read";
    // Fails where a block holds more or less than it is to.
    if (libdeflate_zlib_decompress(decompressor.get(), packed.data(), bytes, raw.data(), end - begin, nullptr) !=
        LIBDEFLATE_SUCCESS)
      return "a block that is none of zlib's";
    sink(begin, end, raw.data());
    begin = end;
  }
  return {};
}

}  // namespace

void appendRaw(AtomicFile& file, const ArrayBytes& array) {
  file.write(&array.size, sizeof array.size);
  BlockWriter(file, array, false).write();
}

void appendCompressed(AtomicFile& file, const ArrayBytes& array) {
  const std::uint64_t blocks = (array.size + vtkBlock - 1) / vtkBlock;
  std::vector<std::uint64_t> table{blocks, vtkBlock, array.size % vtkBlock};
  table.resize(3 + blocks);
  const std::uint64_t place = file.size(), bytes = table.size() * sizeof table[0];
  file.write(table.data(), bytes);
  std::ranges::copy(BlockWriter(file, array, true).write(), table.begin() + 3);
  file.overwrite(place, table.data(), bytes);
}

std::string readAppended(std::istream& stream, bool isCompressed, std::uint64_t size, std::uint64_t room,
                         std::uint64_t item, const std::function<void()>& reserve, const Sink& sink) {
  if (!isCompressed) return readRaw(stream, size, room, reserve, sink);
  BlockTable table;
  if (std::string problem = table.read(stream, size, room, item); !problem.empty()) return problem;
  reserve();
  return readCompressed(stream, table, size, sink);
}

}  // namespace treacle
