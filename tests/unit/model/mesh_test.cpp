#include "treacle/model/geometry/mesh.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/particles/create.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sample_case.hpp"
#include "support/sample_mesh.hpp"
#include "support/temporary_directory.hpp"

namespace treacle::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double ball = 4 * std::numbers::pi / 3;  // volume of that of radius 1

/// A ball of fluid of radius 10.3 m, spacing 1 m, made of 5120 triangles.
Case ballCase(const Triangles& triangles, FillKind fill = FillKind::Inside, double thickness = 0) {
  Case c = emptyCase(3);
  for (int k = 0; k < 3; ++k) c.domain.min[k] = -20.25, c.domain.max[k] = 19.75;  // lattice points at quarters
  c.bodies = {makeBody("ball", BodyKind::Fluid, meshShape(triangles, fill, thickness))};
  return c;
}
Triangles sampleBall() { return ballMesh(10.3, 4); }

std::vector<Vec<3>> placesOf(const Case& c, std::vector<std::string>& notes) {
  const Particles<3> p = createParticles<3>(c, notes);
  return {p.position.span().begin(), p.position.span().end()};
}

/// All points of the lattice for which within(distance from the origin) holds.
std::vector<Vec<3>> lattice(const std::function<bool(double)>& within) {
  std::vector<Vec<3>> points;
  for (int z = 0; z < 40; ++z)
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x)
        if (const Vec<3> p{x - 19.75, y - 19.75, z - 19.75}; within(norm(p))) points.push_back(p);
  return points;
}

TEST(Mesh, enclosesAsMuchAsABall) {
  const Mesh mesh(sampleBall());
  const MeshFacts& facts = mesh.facts();
  EXPECT_EQ(facts.triangles, 5120u);
  EXPECT_TRUE(facts.closed());
  const double r = 10.3;
  EXPECT_NEAR(facts.volume, ball * r * r * r, 3e-3 * facts.volume);  // 2.2e-3 less, by the triangles
  EXPECT_LT(facts.volume, ball * r * r * r);
  EXPECT_NEAR(facts.area, 3 * ball * r * r, 2e-3 * facts.area);
  EXPECT_EQ(mesh.findCrossings().pairs, 0u);
}

TEST(Mesh, fillsABallAsTheBallItself) {
  std::vector<std::string> notes;
  const auto points = placesOf(ballCase(sampleBall()), notes);
  EXPECT_THAT(notes, IsEmpty());
  // The triangles are up to 0.012 m inside; no point of the lattice is there.
  EXPECT_TRUE(points == lattice([](double r) { return r <= 10.29; }));
  EXPECT_TRUE(points == lattice([](double r) { return r <= 10.3; }));
  EXPECT_NEAR(static_cast<double>(points.size()), ball * std::pow(10.3, 3), 0.01 * ball * std::pow(10.3, 3));
}

TEST(Mesh, holesAndDoubledFacesDoNotMatter) {
  const auto whole = lattice([](double r) { return r <= 10.3; });
  Triangles torn = sampleBall();
  torn.corners.erase(torn.corners.begin() + 100, torn.corners.begin() + 102);
  torn.corners.erase(torn.corners.begin() + 3000);
  std::vector<std::string> notes;
  EXPECT_TRUE(placesOf(ballCase(torn), notes) == whole);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes[0], HasSubstr("body 'ball': /sample.stl: the mesh is open at 9 edges, the first at ("));

  Triangles doubled = sampleBall();
  for (std::size_t k = 200; k < 900; ++k) {
    auto corners = doubled.corners[k];
    std::rotate(corners.begin(), corners.begin() + k % 3, corners.end());
    doubled.corners.push_back(corners);
  }
  notes.clear();
  EXPECT_TRUE(placesOf(ballCase(doubled), notes) == whole);
  EXPECT_THAT(notes,
              ElementsAre("body 'ball': /sample.stl: 700 faces left out that an earlier one is the same as, "
                          "the first is face 5121"));
}

TEST(Mesh, verticesNeedNotBeShared) {
  Triangles apart;
  const Triangles whole = sampleBall();
  for (const auto& corners : whole.corners) {
    const auto first = static_cast<std::uint32_t>(apart.vertices.size());
    for (const std::uint32_t c : corners) apart.vertices.push_back(whole.vertices[c]);
    apart.corners.push_back({first, first + 1, first + 2});
  }
  EXPECT_TRUE(Mesh(apart).facts().closed());
  // Nor be rounded in the same way.
  const double size = norm(Mesh(whole).facts().max - Mesh(whole).facts().min);
  double sign = 1;
  for (Vec<3>& x : apart.vertices) x[0] += (sign = -sign) * 2e-7 * size, x[2] -= sign * 2e-7 * size;
  EXPECT_TRUE(Mesh(apart).facts().closed());
  EXPECT_EQ(Mesh(apart).facts().flat, 0u);
  for (Vec<3>& x : apart.vertices) x[1] += (sign = -sign) * 1e-4 * size;
  EXPECT_FALSE(Mesh(apart).facts().closed()) << "a gap is one";
}

TEST(Mesh, flatTurnedAndCuttingFacesAreNoted) {
  Triangles m = sampleBall();
  m.corners.push_back({5, 5, 7});
  std::swap(m.corners[0][1], m.corners[0][2]);
  append(m, boxMesh({9, -2, -2}, {14, 2, 2}));
  std::vector<std::string> notes;
  const auto points = placesOf(ballCase(m), notes);
  const auto both = [](const Vec<3>& x) {
    return norm(x) <= 10.3 || (x[0] > 9 && x[0] < 14 && std::abs(x[1]) < 2 && std::abs(x[2]) < 2);
  };
  EXPECT_EQ(std::ranges::count_if(lattice([](double) { return true; }), both),
            static_cast<std::ptrdiff_t>(points.size()));
  ASSERT_EQ(notes.size(), 3u);
  EXPECT_THAT(notes[0],
              HasSubstr("faces on both sides of 3 edges do not agree on where outside is, the first at"));
  EXPECT_THAT(notes[1], HasSubstr("1 face without an area left out, the first is face 5121"));
  EXPECT_THAT(notes[2], HasSubstr("pairs of faces cut each other, the first are the faces "));
}

TEST(Mesh, insideOutIsRefusedWithTheWayOut) {
  Triangles turned = sampleBall();
  for (auto& corners : turned.corners) std::swap(corners[0], corners[1]);
  Case c = ballCase(turned);
  std::vector<std::string> notes;
  EXPECT_THAT(messageOf<InputError>([&] { placesOf(c, notes); }),
              HasSubstr("body 'ball': /sample.stl is inside-out: its faces, whose corners must go round "
                        "counter-clockwise seen from outside, enclose -4"));
  EXPECT_THAT(messageOf<InputError>([&] { placesOf(c, notes); }), HasSubstr("turn them round with flip = true"));
  c.bodies[0].shape.flip = true;
  EXPECT_TRUE(placesOf(c, notes) == lattice([](double r) { return r <= 10.3; }));
  c.bodies[0].shape.file.mesh.value = std::make_shared<const Mesh>(sampleBall());
  EXPECT_THAT(messageOf<InputError>([&] { placesOf(c, notes); }), HasSubstr("; leave out flip"));
}

TEST(Mesh, withoutContentOrAreaIsRefused) {
  Triangles flat;
  flat.vertices = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  flat.corners = {{0, 1, 2}};
  Case c = ballCase(flat);
  std::vector<std::string> notes;
  EXPECT_EQ(messageOf<InputError>([&] { placesOf(c, notes); }), "body 'ball': no face of /sample.stl has an area");
  c.bodies[0].shape.file.mesh.value.reset();
  EXPECT_EQ(messageOf<InputError>([&] { placesOf(c, notes); }),
            "body 'ball': its mesh has not been read from /sample.stl");
}

/// The triangles are up to 0.012 m inside of the ball.
void expectBetween(const std::vector<Vec<3>>& points, double least, double most) {
  constexpr double margin = 0.02;
  for (const Vec<3>& x : points) EXPECT_TRUE(norm(x) > least - margin && norm(x) < most + margin) << norm(x);
  const auto surely = lattice([&](double r) { return r > least + margin && r < most - margin; });
  for (const Vec<3>& x : surely) EXPECT_TRUE(std::ranges::find(points, x) != points.end()) << norm(x);
}

TEST(Mesh, fillsLayersOnEitherSide) {
  std::vector<std::string> notes;
  const auto filled = [&](FillKind fill, double thickness) {
    return placesOf(ballCase(sampleBall(), fill, thickness), notes);
  };
  expectBetween(filled(FillKind::Shell, 2.1), 8.2, 10.3);
  expectBetween(filled(FillKind::Outside, 2.1), 10.3, 12.4);
  expectBetween(filled(FillKind::Sheet, 2.1), 9.25, 11.35);
  expectBetween(filled(FillKind::Outside, 0), 10.3, 13.8);  // h_v
  EXPECT_THAT(notes, IsEmpty());
}

TEST(Mesh, ofAnotherUnitIsRefused) {
  Case c = ballCase(ballMesh(10300, 2));
  std::vector<std::string> notes;
  EXPECT_THAT(messageOf<InputError>([&] { placesOf(c, notes); }),
              testing::AllOf(HasSubstr("body 'ball' is far larger than the domain: it reaches from (-10300, "),
                             HasSubstr("transform.scale")));
  c.bodies[0].shape.transform = Transform{.scale = 1e-3};
  EXPECT_GT(placesOf(c, notes).size(), 4000u);
  c.bodies[0].shape.transform->translate[0] = 100;
  EXPECT_THAT(messageOf<InputError>([&] { placesOf(c, notes); }), HasSubstr("is outside of the domain"));
}

TEST(Mesh, transformsMoveIt) {
  Case c = ballCase(boxMesh({0, 0, 0}, {4, 2, 6}));
  std::vector<std::string> notes;
  // Turned about z to the left, made twice as large and moved.
  c.bodies[0].shape.transform = Transform{.scale = 2, .angle = 90, .translate = {5, -3, 1}};
  std::size_t found = 0;
  for (const Vec<3>& x : placesOf(c, notes)) {
    EXPECT_TRUE(x[0] > 1 && x[0] < 5 && x[1] > -3 && x[1] < 5 && x[2] > 1 && x[2] < 13);
    ++found;
  }
  EXPECT_EQ(found, 4u * 8 * 12);
}

}  // namespace
}  // namespace treacle::test
