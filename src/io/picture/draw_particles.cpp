#include "draw_particles.hpp"

#include "surface/surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace treacle {

namespace {

/// [px] Small discs overlap, up to covering the diagonal of a lattice and whole pixels: gaps would make patterns.
double discRadius(const View& view, double spacing) {
  const double diameter = spacing * view.scale;
  return std::max(0.5 * diameter, std::min(0.72 * std::max(diameter, 1.6), 1.5));
}

/// Far to near.
std::vector<std::uint32_t> depthOrder(const View& view, const std::vector<Particle>& particles) {
  std::vector<float> depth(particles.size());
  for (std::size_t i = 0; i < depth.size(); ++i)
    depth[i] = static_cast<float>(dot(view.toViewer, particles[i].position));
  std::vector<std::uint32_t> order(particles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return depth[a] < depth[b]; });
  return order;
}

std::vector<SurfacePoint> surfaceOf(const std::vector<Particle>& particles, double spacing) {
  std::vector<Vec<3>> position(particles.size());
  std::transform(particles.begin(), particles.end(), position.begin(),
                 [](const Particle& p) { return p.position; });
  return surfacePoints(position, spacing);
}

/// Brightness of a surface: light from above, left of the viewer. Mild, for colours have to be read off the bar.
double brightness(const View& view, const Vec<3>& normal) {
  const Vec<3> light = 0.80 * view.up + 0.50 * view.toViewer - 0.33 * view.right;
  return 0.82 + 0.22 * dot(normal, light);
}

}  // namespace

void drawFlat(Canvas& canvas, const View& view, const std::vector<Particle>& particles, double spacing) {
  const double radius = discRadius(view, spacing);
  for (const Particle& p : particles) canvas.disc(view(p.position), radius, p.color);
}

void drawSolid(Canvas& canvas, const View& view, const std::vector<Particle>& particles, double spacing) {
  const double radius = 1.1 * discRadius(view, spacing);
  const double relief = radius > 2.5 ? 0.4 : 0;
  const std::vector<SurfacePoint> surface = surfaceOf(particles, spacing);
  for (const std::uint32_t i : depthOrder(view, particles)) {
    const Rgb color = particles[i].color.scaled(brightness(view, surface[i].normal));
    canvas.disc(view(particles[i].position), radius, color, relief);
  }
}

void drawOpened(Canvas& canvas, const View& view, const std::vector<Particle>& particles, double spacing) {
  constexpr double facing = 0.15;
  const double radius = 1.4 * discRadius(view, spacing);  // a single layer has to be closed
  const std::vector<SurfacePoint> surface = surfaceOf(particles, spacing);
  std::vector<std::uint32_t> order = depthOrder(view, particles);
  std::reverse(order.begin(), order.end());
  for (const std::uint32_t i : order)
    if (surface[i].outermost && dot(surface[i].normal, view.toViewer) > facing)
      canvas.disc(view(particles[i].position), radius,
                  particles[i].color.scaled(brightness(view, surface[i].normal)));
}

}  // namespace treacle
