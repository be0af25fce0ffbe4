#include "color_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace treacle {

namespace {

/// Published values at t = 0, 0.1, … 1.
constexpr std::array<int, 11> anchors = {0x440154, 0x482576, 0x414487, 0x35608d, 0x2a788e, 0x21908c,
                                         0x22a884, 0x43bf71, 0x7ad151, 0xbbdf27, 0xfde725};

constexpr Rgb fromHex(int hex) {
  return {((hex >> 16) & 0xff) / 255.0, ((hex >> 8) & 0xff) / 255.0, (hex & 0xff) / 255.0};
}

}  // namespace

Rgb viridis(double t) {
  if (std::isnan(t)) return {0.5, 0.5, 0.5};
  const double place = std::clamp(t, 0.0, 1.0) * (anchors.size() - 1);
  const std::size_t below = std::min<std::size_t>(static_cast<std::size_t>(place), anchors.size() - 2);
  const double f = place - static_cast<double>(below);
  const Rgb a = fromHex(anchors[below]), b = fromHex(anchors[below + 1]);
  return {a.red + f * (b.red - a.red), a.green + f * (b.green - a.green), a.blue + f * (b.blue - a.blue)};
}

}  // namespace treacle
