#include "treacle/io/frames/pvtp.hpp"

#include "files/text_file.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/files/atomic_file.hpp"
#include "treacle/io/frames/vtp.hpp"
#include "vtk_xml.hpp"
#include "vtp_contents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>

namespace treacle {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view fileEnd = "</VTKFile>\n";

/// "FILE: time 1 s in place of 2 s ...", empty where the two are of one frame.
template <class A, class B>
std::string strangeness(const fs::path& piece, const A& one, const B& first) {
  if (one.time == first.time && one.dimensions == first.dimensions) return {};
  return fmt::format("{}: {} dimensions at t = {} s, other pieces of the frame have {} at t = {} s",
                     piece.string(), one.dimensions, one.time, first.dimensions, first.time);
}

std::string arrayTag(const VtpContents::Array& a) {
  return fmt::format("      <PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n", a.type, a.name,
                     a.components);
}

/// What all pieces say. Errors: InputError.
VtpContents commonContents(const fs::path& folder, const std::vector<std::string>& pieces) {
  std::optional<VtpContents> common;
  for (const std::string& name : pieces) {
    const fs::path path = folder / name;
    VtpContents piece = readVtpContents(path);
    if (piece.particles == 0) throw InputError(fmt::format("{}: no particles", path.string()));
    if (!common) common = piece;
    if (const std::string strange = strangeness(path, piece, *common); !strange.empty()) throw InputError(strange);
    if (piece.pointData != common->pointData || piece.positionType != common->positionType)
      throw InputError(fmt::format("{}: other arrays than those of other pieces", path.string()));
  }
  return *common;
}

/// The names of the pieces. Errors: InputError.
std::vector<std::string> readIndex(const fs::path& path) {
  const std::string xml = readTextFile(path);
  const auto fail = [&](const std::string& what) { throw InputError(fmt::format("{}: {}", path.string(), what)); };
  std::size_t from = 0;
  const auto file = nextTag(xml, "VTKFile", from);
  if (!file || attribute(*file, "type") != "PPolyData") fail("not an index of pieces written by treacle");
  if (!xml.ends_with(fileEnd)) fail("truncated: the file has no end");
  std::vector<std::string> pieces;
  while (const auto tag = nextTag(xml, "Piece", from)) {
    const auto source = attribute(*tag, "Source");
    if (!source || source->empty() || fs::path(*source).has_parent_path())
      fail(fmt::format("piece {}: expected the name of a file beside this one", pieces.size()));
    pieces.emplace_back(*source);
  }
  if (pieces.empty()) fail("it names no pieces");
  std::vector<std::string> sorted = pieces;
  std::ranges::sort(sorted);
  if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
    fail(fmt::format("the piece {} is named twice", *twice));
  return pieces;
}

void append(const fs::path& path, const Frame& piece, Frame& whole) {
  if (const std::string strange = strangeness(path, piece, whole); !strange.empty()) throw InputError(strange);
  if (piece.position.empty()) return;
  const bool first = whole.position.empty();
  forEachFrameField([&](std::string_view name, auto member) {
    const auto& from = piece.*member;
    auto& to = whole.*member;
    if (!first && from.empty() != to.empty())
      throw InputError(fmt::format("{}: '{}' is not in all pieces of the frame", path.string(), name));
    to.insert(to.end(), from.begin(), from.end());
  });
  if (first) whole.states.resize(piece.states.size());
  for (std::size_t k = 0; k < whole.states.size(); ++k) {
    FrameState& to = whole.states[k];
    if (k >= piece.states.size() || (!first && piece.states[k].name != to.name))
      throw InputError(fmt::format("{}: '{}' is not in all pieces of the frame", path.string(), to.name));
    to.name = piece.states[k].name;
    to.values.insert(to.values.end(), piece.states[k].values.begin(), piece.states[k].values.end());
  }
}

}  // namespace

void writePvtp(const fs::path& path, const std::vector<std::string>& pieces) {
  VtpContents contents;
  try {
    contents = commonContents(path.parent_path(), pieces);
  } catch (const InputError& e) {
    throw RunError(fmt::format("cannot write {}: its piece {}", path.string(), e.what()));
  }
  std::string xml = fmt::format(R"(<?xml version="1.0"?>
<VTKFile type="PPolyData" version="1.0" byte_order="{}" header_type="UInt64">
  <PPolyData GhostLevel="0">
    <PPointData>
)",
                                vtkByteOrder);
  for (const VtpContents::Array& a : contents.pointData) xml += arrayTag(a);
  xml +=
      "    </PPointData>\n    <PPoints>\n" + arrayTag({contents.positionType, "position", 3}) + "    </PPoints>\n";
  for (const std::string& piece : pieces) xml += fmt::format("    <Piece Source=\"{}\"/>\n", piece);
  writeFile(path, xml + "  </PPolyData>\n" + std::string(fileEnd));
}

Frame readPvtp(const fs::path& path) {
  std::optional<Frame> whole;
  for (const std::string& name : readIndex(path)) {
    const fs::path piece = path.parent_path() / name;
    Frame part = readVtp(piece);
    if (whole)
      append(piece, part, *whole);
    else
      whole = std::move(part);
  }
  return std::move(*whole);
}

Frame readFrame(const fs::path& path) { return path.extension() == ".pvtp" ? readPvtp(path) : readVtp(path); }

}  // namespace treacle
