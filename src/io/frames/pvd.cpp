#include "treacle/io/frames/pvd.hpp"

#include "files/parse_number.hpp"
#include "files/text_file.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/files/atomic_file.hpp"
#include "vtk_xml.hpp"

#include <fmt/format.h>

#include <cmath>

namespace treacle {

void writePvd(const std::filesystem::path& path, const std::vector<PvdEntry>& entries) {
  std::string xml = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"{}\">\n  <Collection>\n",
      vtkByteOrder);
  for (const PvdEntry& entry : entries)
    xml += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", entry.time, entry.file);
  writeFile(path, xml + "  </Collection>\n</VTKFile>\n");
}

std::vector<PvdEntry> readPvd(const std::filesystem::path& path) {
  const std::string xml = readTextFile(path);
  const auto foreign = [&] {
    return InputError(fmt::format("{}: not an index written by treacle", path.string()));
  };
  std::size_t from = 0;
  const auto file = nextTag(xml, "VTKFile", from);
  if (!file || attribute(*file, "type") != "Collection") throw foreign();

  std::vector<PvdEntry> entries;
  while (const auto tag = nextTag(xml, "DataSet", from)) {
    const auto time = parseNumber<double>(attribute(*tag, "timestep").value_or(""));
    const auto name = attribute(*tag, "file");
    if (!time || !name) throw foreign();
    if (!std::isfinite(*time) || (!entries.empty() && *time <= entries.back().time))
      throw InputError(
          fmt::format("{}: time {} of {}: expected finite times that ascend", path.string(), *time, *name));
    entries.push_back({*time, std::string(*name)});
  }
  return entries;
}

}  // namespace treacle
