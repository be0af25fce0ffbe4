// Indices of frames in pieces, beside which there are pieces that fit, and one that does not.

#include "treacle/io/frames/pvtp.hpp"
#include "input_file.hpp"
#include "treacle/io/frames/vtp.hpp"

#include <cstdio>
#include <fstream>

using namespace treacle;

namespace {

/// A folder with the pieces, gone with the program.
struct Folder {
  std::filesystem::path path;

  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "pieces-XXXXXX").string();
    if (!::mkdtemp(name.data())) std::abort();
    path = name;
    Frame piece;
    piece.position = {Vec<3>{1, 2, 3}, Vec<3>{4, 5, 6}};
    piece.id = {0, 1};
    for (const char* file : {"a.p0.vtp", "a.p1.vtp"}) writeVtp(path / file, piece, {}, OutputPrecision::Single);
    piece.id.clear();
    writeVtp(path / "a.p2.vtp", piece, {}, OutputPrecision::Single);
  }
  ~Folder() { std::filesystem::remove_all(path); }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  const std::filesystem::path index = folder.path / "a.pvtp";
  std::ofstream(index, std::ios::binary) << fuzz::textOf(data, size);
  fuzz::accept([&] {
    const Frame frame = readFrame(index);
    const std::size_t count = frame.position.size();
    if (count == 0 || count % 2 != 0) std::abort();
    if (!frame.id.empty() && frame.id.size() != count) std::abort();
  });
  return 0;
}
