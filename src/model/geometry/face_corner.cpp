#include "face_corner.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

template <int D, int N>
using Faces = std::array<const Face<D>*, N>;

/// Whether the normals are independent; then `share` are those multiples of them whose sum has the given products
/// with them.
template <int D, int N>
bool solve(const Vec<D>* normal, const Vec<N>& product, Vec<N>& share) {
  constexpr double least = 1e-6;
  if constexpr (N == 2) {
    const double cosine = dot(normal[0], normal[1]), det = 1 - cosine * cosine;
    if (det < least) return false;
    share = {(product[0] - cosine * product[1]) / det, (product[1] - cosine * product[0]) / det};
  } else {
    const Vec<D> c[3] = {cross(normal[1], normal[2]), cross(normal[2], normal[0]), cross(normal[0], normal[1])};
    const double det = dot(normal[0], c[0]);
    if (det * det < least) return false;
    Vec<D> sum{};
    for (int i = 0; i < 3; ++i) sum += c[i] * (product[i] / det);
    for (int i = 0; i < 3; ++i) share[i] = dot(sum, c[i]) / det;
  }
  return true;
}

/// Moves a point onto all the faces, if they meet near it, by their tangent planes.
template <int D, int N>
bool meet(Vec<D>& point, const Faces<D, N>& faces, double precision, Vec<D>* normal) {
  for (int k = 0; k < 20; ++k) {
    Vec<N> share{};
    double height = 0;
    for (int i = 0; i < N; ++i) {
      const auto at = faces[static_cast<std::size_t>(i)]->at(point);
      normal[i] = at.normal;
      share[i] = -at.height;
      height = std::max(height, std::abs(at.height));
    }
    if (height < precision) return true;
    if (!solve<D, N>(normal, Vec<N>(share), share)) return false;
    for (int i = 0; i < N; ++i) point += normal[i] * share[i];
  }
  return false;
}

/// Moves a point along the curve in which two faces meet to where it is nearest to x.
bool approach(const Vec<3>& x, Vec<3>& point, const Faces<3, 2>& faces, double reach, double precision,
              Vec<3>* normal) {
  double slope = 1, before = 0, moved = 0;
  for (int k = 0; k < 40; ++k) {
    Vec<3> along = cross(normal[0], normal[1]);
    along *= 1 / norm(along);
    const double ahead = dot(x - point, along);  // of x
    if (std::abs(ahead) < precision) return true;
    // By how much that falls on a way of one: 1 where the curve is straight.
    if (moved != 0) slope = std::clamp((before - ahead) / moved, 0.2, 20.0);
    before = ahead, moved = std::clamp(ahead / slope, -reach / 4, reach / 4);
    point += along * moved;
    if (!meet<3, 2>(point, faces, precision, normal)) return false;
  }
  return false;
}

template <int D, int N>
bool findCorner(const Vec<D>& x, Vec<D> point, const Faces<D, N>& faces, double reach, double spacing,
                FaceCorner<D>& corner) {
  const double precision = 1e-9 * spacing;
  if (!meet<D, N>(point, faces, precision, corner.normal)) return false;
  if constexpr (N < D)
    if (!approach(x, point, faces, reach, precision, corner.normal)) return false;
  corner.way = point - x;
  if (norm(corner.way) > reach) return false;
  // The way is a sum of outward normals, or one of the faces leads on to a nearer point. Right beside a sharp
  // corner what is a little beyond a face is covered by the other: there the corner stands for the point of the
  // face.
  Vec<N> product{}, share{};
  for (int i = 0; i < N; ++i) product[i] = dot(corner.normal[i], corner.way);
  if (!solve<D, N>(corner.normal, product, share)) return false;
  for (int i = 0; i < N; ++i)
    if (share[i] < -0.01 * spacing) return false;
  // Above all faces alike: where the corner is sharp, neither the way nor the sum of the normals leads out.
  if (!solve<D, N>(corner.normal, Vec<N>::filled(1), share)) return false;
  corner.out = {};
  for (int i = 0; i < N; ++i) corner.out += corner.normal[i] * share[i];
  corner.out *= 1 / norm(corner.out);
  return true;
}

}  // namespace

template <int D, int N>
void findCorners(const Vec<D>& x, const std::array<const Face<D>*, N>& faces, double reach, double spacing,
                 std::vector<FaceCorner<D>>& corners) {
  FaceCorner<D> corner{};
  const auto tryFrom = [&](const Vec<D>& start) {
    if (findCorner<D, N>(x, start, faces, reach, spacing, corner)) corners.push_back(corner);
  };
  tryFrom(x);
  if (std::ranges::all_of(faces, &Face<D>::flat)) return;
  for (int k = 0; k < D; ++k)
    for (const double aside : {-reach, reach}) {
      Vec<D> start = x;
      start[k] += aside;
      tryFrom(start);
    }
}

template void findCorners<2, 2>(const Vec<2>&, const std::array<const Face<2>*, 2>&, double, double,
                                std::vector<FaceCorner<2>>&);
template void findCorners<3, 2>(const Vec<3>&, const std::array<const Face<3>*, 2>&, double, double,
                                std::vector<FaceCorner<3>>&);
template void findCorners<3, 3>(const Vec<3>&, const std::array<const Face<3>*, 3>&, double, double,
                                std::vector<FaceCorner<3>>&);

}  // namespace treacle
