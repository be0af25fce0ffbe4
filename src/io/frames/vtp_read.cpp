#include "files/parse_number.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/frames/vtp.hpp"
#include "vtk_blocks.hpp"
#include "vtk_xml.hpp"
#include "vtp_contents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <type_traits>

namespace treacle {

namespace {

constexpr std::size_t largestHeader = 1 << 16;  // [B] ours are about 2 KiB

/// Reader of one file: the XML part is held as text, arrays are read from the stream one by one.
class VtpReader {
 public:
  explicit VtpReader(const std::filesystem::path& path) : path_(path) {
    std::error_code error;
    fileSize_ = std::filesystem::file_size(path, error);
    if (error) fail(error.message());
    stream_.open(path, std::ios::binary);  // not before: who opens a pipe waits for a writer
    if (!stream_) fail("cannot be opened");
    readHeader();
    requireEnd();
  }

  Frame frame() {
    Frame frame;
    frame.time = time(), frame.dimensions = dimensions();
    readVectors("position", frame.position);
    if (frame.position.size() != count_) foreign("no particle positions");
    readVectors("velocity", frame.velocity);
    readScalars("pressure", frame.pressure);
    readScalars("number_density", frame.numberDensity);
    readScalars("dynamic_viscosity", frame.dynamicViscosity);
    readScalars("shear_rate", frame.shearRate);
    readScalars("temperature", frame.temperature);
    readScalars("viscosity_factor", frame.viscosityFactor);
    readScalars("nearest_distance", frame.nearestDistance);
    readScalars("material", frame.material);
    readScalars("body", frame.body);
    readScalars("id", frame.id);
    readStates(frame);
    return frame;
  }

  VtpContents contents() const {
    VtpContents contents{count_, time(), dimensions(), {}, {}};
    const std::size_t begin = header_.find("<PointData>"), end = header_.find("</PointData>");
    std::size_t from = std::min(begin, header_.size());
    while (const auto tag = nextTag(header_, "DataArray", from)) {
      if (from > end) break;
      const auto type = attribute(*tag, "type"), name = attribute(*tag, "Name");
      const auto components = parseNumber<int>(attribute(*tag, "NumberOfComponents").value_or(""));
      if (!type || !name || !components) foreign("an array without type, name or number of components");
      contents.pointData.push_back({std::string(*type), std::string(*name), *components});
    }
    std::size_t points = 0;
    const auto tag = findArray("position", points);
    contents.positionType = tag ? attribute(*tag, "type").value_or("") : "";
    return contents;
  }

 private:
  double time() const {
    const auto time = fieldValue<double>("TimeValue");
    if (!std::isfinite(time)) foreign("'TimeValue' is not finite");
    return time;
  }
  int dimensions() const {
    const int dimensions = fieldValue<int>("dimensions");
    if (dimensions != 2 && dimensions != 3) foreign("'dimensions' is neither 2 nor 3");
    return dimensions;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw InputError(fmt::format("{}: {}", path_.string(), what));
  }
  [[noreturn]] void foreign(std::string_view what) const {
    fail(fmt::format("not a particle file written by treacle ({})", what));
  }
  [[noreturn]] void truncated() const { fail("truncated: the file ends before its data does"); }

  void readHeader() {
    header_.resize(std::min<std::uint64_t>(largestHeader, fileSize_));
    stream_.read(header_.data(), static_cast<std::streamsize>(header_.size()));
    constexpr std::string_view opening = "<AppendedData encoding=\"raw\">";
    const std::size_t appended = header_.find(opening);
    std::size_t from = 0;
    const auto file = nextTag(header_, "VTKFile", from);
    if (!file || attribute(*file, "type") != "PolyData") foreign("no VTK PolyData");
    if (const auto compressor = attribute(*file, "compressor")) {
      isCompressed_ = true;
      if (*compressor != vtkZlibCompressor)
        foreign(fmt::format("expected the compressor {} or none, found {}", vtkZlibCompressor, *compressor));
    }
    if (attribute(*file, "byte_order") != vtkByteOrder || attribute(*file, "header_type") != "UInt64")
      foreign(fmt::format("expected byte order {} and UInt64 headers", vtkByteOrder));
    if (appended == header_.npos) {
      if (fileSize_ <= largestHeader) truncated();
      foreign("no raw appended data");
    }
    const std::size_t underscore = header_.find('_', appended + opening.size());
    if (underscore == header_.npos) truncated();
    dataBegin_ = underscore + 1;
    header_.resize(appended);

    from = 0;
    const auto piece = nextTag(header_, "Piece", from);
    const auto points = piece ? attribute(*piece, "NumberOfPoints") : std::nullopt;
    const auto count = points ? parseNumber<std::uint64_t>(*points) : std::nullopt;
    if (!count) foreign("no number of points");
    count_ = *count;
    // Checked before anybody reserves memory for that many particles, or multiplies their number.
    const std::uint64_t most = isCompressed_ ? std::numeric_limits<std::uint32_t>::max()
                                             : (fileSize_ - dataBegin_) / sizeof(Vec<3, float>);
    if (count_ > most) truncated();
  }

  /// The arrays at the end of the file are none that anybody reads here: without its last tag they may be cut.
  void requireEnd() {
    constexpr std::string_view end = "</VTKFile>\n";
    std::string tail(end.size(), '\0');
    if (fileSize_ < dataBegin_ + end.size()) truncated();
    stream_.seekg(static_cast<std::streamoff>(fileSize_ - end.size()));
    stream_.read(tail.data(), static_cast<std::streamsize>(tail.size()));
    if (!stream_ || tail != end) truncated();
  }

  /// The tag of the array of that name; `from` is behind it afterwards.
  std::optional<std::string_view> findArray(std::string_view name, std::size_t& from) const {
    while (const auto tag = nextTag(header_, "DataArray", from))
      if (attribute(*tag, "Name") == name) return tag;
    return std::nullopt;
  }

  template <class T>
  T fieldValue(std::string_view name) const {
    std::size_t begin = 0;
    if (!findArray(name, begin)) foreign(fmt::format("no field '{}'", name));
    const std::string_view text = std::string_view(header_).substr(begin, header_.find('<', begin) - begin);
    const auto value = parseNumber<T>(text);
    if (!value) foreign(fmt::format("field '{}' is no number", name));
    return *value;
  }

  /// Fields of one number each that no frame has by itself.
  void readStates(Frame& frame) {
    for (const VtpContents::Array& array : contents().pointData) {
      bool known = array.components != 1;
      forEachFrameField([&](std::string_view name, auto) { known = known || name == array.name; });
      if (!known) readScalars(array.name, frame.states.emplace_back(FrameState{array.name, {}}).values);
    }
  }

  /// Moves the stream to an array; returns how many bytes the file has from there on.
  std::uint64_t seekArray(std::string_view name, std::string_view tag) {
    const auto text = attribute(tag, "offset");
    const auto offset = text ? parseNumber<std::uint64_t>(*text) : std::nullopt;
    if (!offset) foreign(fmt::format("array '{}' is not appended", name));
    const std::uint64_t room = fileSize_ - dataBegin_;
    if (*offset > room) truncated();
    stream_.seekg(static_cast<std::streamoff>(dataBegin_ + *offset));
    return room - *offset;
  }

  template <class T, class Reserve, class Sink>
  void readValues(std::string_view name, std::string_view tag, std::uint64_t count, Reserve reserve, Sink sink) {
    const std::uint64_t room = seekArray(name, tag);
    const auto take = [&](std::uint64_t begin, std::uint64_t end, const char* bytes) {
      for (std::uint64_t k = begin / sizeof(T); k < end / sizeof(T); ++k, bytes += sizeof(T)) {
        T value;
        std::memcpy(&value, bytes, sizeof(T));
        sink(k, value);
      }
    };
    const std::string problem =
        readAppended(stream_, isCompressed_, count * sizeof(T), room, sizeof(T), reserve, take);
    if (!problem.empty())
      fail(fmt::format("damaged, or not written by treacle: the array '{}' has {}", name, problem));
  }

  /// Fields that the file does not hold stay empty.
  template <class Value, class Sink>
  void readArray(std::string_view name, std::uint64_t components, std::vector<Value>& out, Sink sink) {
    std::size_t from = 0;
    const auto tag = findArray(name, from);
    if (!tag) return;
    const auto type = attribute(*tag, "type");
    const std::uint64_t count = count_ * components;
    const auto reserve = [&] { out.resize(count_); };
    if (type == vtkType<float>()) return readValues<float>(name, *tag, count, reserve, sink);
    if (type == vtkType<double>()) return readValues<double>(name, *tag, count, reserve, sink);
    if (type == vtkType<std::int32_t>()) return readValues<std::int32_t>(name, *tag, count, reserve, sink);
    if (type == vtkType<std::uint32_t>()) return readValues<std::uint32_t>(name, *tag, count, reserve, sink);
    foreign(fmt::format("array '{}' has an unexpected type", name));
  }

  void readVectors(std::string_view name, std::vector<Vec<3>>& out) {
    readArray(name, 3, out, [&](std::size_t k, auto value) { out[k / 3].v[k % 3] = static_cast<double>(value); });
  }

  template <class T>
  void readScalars(std::string_view name, std::vector<T>& out) {
    readArray(name, 1, out, [&](std::size_t k, auto value) {
      if constexpr (std::is_integral_v<T>) requireWhole<T>(name, static_cast<double>(value));
      out[k] = static_cast<T>(value);
    });
  }

  /// Another program may have written any numbers.
  template <class T>
  void requireWhole(std::string_view name, double value) const {
    constexpr double least = std::numeric_limits<T>::min(), most = std::numeric_limits<T>::max();
    if (!(value >= least && value <= most && value == std::trunc(value)))
      foreign(fmt::format("array '{}' has the value {}, expected whole numbers from {:.0f} to {:.0f}", name, value,
                          least, most));
  }

  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t fileSize_ = 0;   // [B]
  std::uint64_t dataBegin_ = 0;  // [B] where the appended block starts
  std::uint64_t count_ = 0;      // particles
  bool isCompressed_ = false;
  std::string header_;
};

}  // namespace

Frame readVtp(const std::filesystem::path& path) { return VtpReader(path).frame(); }

VtpContents readVtpContents(const std::filesystem::path& path) { return VtpReader(path).contents(); }

}  // namespace treacle
