#include "sample_case.hpp"
#include "support/sample_mesh.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/geometry/mesh.hpp"
#include "treacle/model/geometry/side_map.hpp"
#include "treacle/model/particles/create.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace treacle {
namespace {

using testing::HasSubstr;

Body lineBody(std::vector<Vec<2>> points) {
  Body body = test::makeBody("sheet", BodyKind::Wall, {});
  body.shape.kind = ShapeKind::Polyline;
  body.shape.points = std::move(points);
  return body;
}

/// Fluid in a box of 40 spacings, with a sheet in it.
Case planeCase(Body sheet) {
  Case c;
  c.dimensions = 2;
  c.spacing = 0.1;
  c.domain = {{-1, -1, 0}, {5, 5, 0}};
  c.materials.push_back({"honey", 1000, 1, 1000, 1e5});
  const Body fluid = test::makeBody("fluid", BodyKind::Fluid, test::box({}, {4, 4, 0}));
  c.bodies = {fluid, std::move(sheet)};
  return c;
}

Particles<2> made(const Case& c) {
  std::vector<std::string> notes;
  return createParticles<2>(c, notes);
}

TEST(Sides, OnlyOppositeSidesOfTheSameSheetAreParted) {
  using namespace sides;
  const std::uint32_t front = with(0, 0, Front), back = with(0, 0, Back), other = with(0, 1, Back);
  EXPECT_TRUE(seeEachOther(0, 0));
  EXPECT_TRUE(seeEachOther(front, 0));
  EXPECT_TRUE(seeEachOther(front, front));
  EXPECT_FALSE(seeEachOther(front, back));
  EXPECT_TRUE(seeEachOther(front, other));
  EXPECT_FALSE(seeEachOther(front | with(0, 1, Front), back | other));
  EXPECT_FALSE(seeEachOther(with(0, 12, Front), with(0, 12, Back)));
  // The particles of a sheet are for who is beside it, on their side.
  const std::uint32_t met = sheetParticle(0, Front);
  EXPECT_TRUE(seeEachOther(met, front));
  EXPECT_FALSE(seeEachOther(met, back));
  EXPECT_FALSE(seeEachOther(met, 0));
  EXPECT_FALSE(seeEachOther(met, other));
  EXPECT_TRUE(seeEachOther(met, met));
  EXPECT_FALSE(seeEachOther(met, sheetParticle(0, Back)));
  EXPECT_FALSE(seeEachOther(sheetParticle(12, Back), sheetParticle(0, Back)));
}

TEST(ThinSheet, HasFluidOnBothSidesAndItsEndsDivideNothing) {
  // From below to the middle, and then to the right: in the corner the front is inside of the angle.
  const Case c = planeCase(lineBody({{2, 0}, {2, 2}, {4, 2}}));
  const Particles<2> p = made(c);
  EXPECT_EQ(p.fluidCount, 1600u);
  const double reach = c.interactionRadius();
  const auto distanceTo = [](const Vec<2>& x, Vec<2> a, Vec<2> b) {
    const double s = std::clamp(dot(x - a, b - a) / norm2(b - a), 0.0, 1.0);
    return norm(x - a - (b - a) * s);
  };
  for (std::uint32_t i = 0; i < p.count; ++i) {
    const Vec<2>& x = p.position[i];
    const double d = std::min(distanceTo(x, {2, 0}, {2, 2}), distanceTo(x, {2, 2}, {4, 2}));
    const bool ends = x[1] < 0 || (x[0] > 4);
    const bool rightBelow = x[0] > 2 && x[1] < 2;
    const std::uint32_t side = sides::of(p.side[i], 0);
    if (i < p.fluidCount) {
      if (d < reach) {
        EXPECT_EQ(side, rightBelow ? sides::Front : sides::Back) << x[0] << ", " << x[1];
      }
      if (d > reach + 2 * c.spacing) {
        EXPECT_EQ(side, sides::None) << x[0] << ", " << x[1];
      }
    } else {  // met from the other side
      EXPECT_FALSE(ends);
      EXPECT_LE(d, reach * (1 + 1e-6));
      EXPECT_EQ(side, rightBelow ? sides::Back : sides::Front) << x[0] << ", " << x[1];
      const Vec<2> way = converted<double>(p.wallSurface[i - p.fluidCount].face[0]);
      EXPECT_NEAR(norm(way), d, 1e-6);
      EXPECT_NEAR(distanceTo(x + way, {2, 0}, {2, 2}) * distanceTo(x + way, {2, 2}, {4, 2}), 0, 1e-6);
    }
  }
}

TEST(ThinSheet, AConditionCutsASlot) {
  Body sheet = lineBody({{2, 0}, {2, 4}});
  sheet.where = "y < 1 || y > 3";
  const Particles<2> p = made(planeCase(sheet));
  for (std::uint32_t i = 0; i < p.count; ++i) {
    const Vec<2>& x = p.position[i];
    const bool beside = std::abs(x[0] - 2) < 0.3 && (x[1] < 1 || x[1] > 3);
    if (i < p.fluidCount && std::abs(x[0] - 2) < 0.3) {
      EXPECT_EQ(sides::of(p.side[i], 0) != sides::None, beside) << x[0] << ", " << x[1];
    }
    if (i >= p.fluidCount) {
      EXPECT_TRUE(x[1] < 1 || x[1] > 3);
    }
  }
}

TEST(SideMap, FollowsASheetThatTurnsAndMoves) {
  Body sheet = lineBody({{1, 2}, {3, 2}});
  sheet.rotation = Rotation{{2, 2, 0}, {0, 0, 1}, 1};
  sheet.velocity = {0.1, 0, 0};
  const Case c = planeCase(sheet);
  const SideMap<2> map = makeSideMap<2>(c, c.bodies[1]);
  const double t = std::acos(0.0);  // a quarter
  const auto placed = placedSheet<2>(c, c.bodies[1], map, map.height.data(), t);
  const Vec<2> middle{2 + 0.1 * t, 2};
  EXPECT_EQ(placed.heightAt(middle + Vec<2>{0.3, 0.5}) > 0, placed.heightAt(middle + Vec<2>{0.2, -0.5}) > 0);
  EXPECT_LT(placed.heightAt(middle + Vec<2>{0.3, 0.5}) * placed.heightAt(middle + Vec<2>{-0.3, 0.5}), 0);
  EXPECT_NEAR(std::abs(placed.heightAt(middle + Vec<2>{0.3, 0})), 3 * 16, 5);
  EXPECT_EQ(placed.heightAt(middle + Vec<2>{0, 1.2}), 0);
  EXPECT_EQ(placed.heightAt(middle + Vec<2>{1.2, 0}), 0);
}

TEST(SideMap, WhatIsPushedALittleIntoTheSheetStaysOnItsSide) {
  const std::uint32_t front = sides::with(0, 3, sides::Front), back = sides::with(0, 3, sides::Back);
  EXPECT_EQ(movedSide(front, 3, 20), front);
  EXPECT_EQ(movedSide(front, 3, -5), front);
  EXPECT_EQ(movedSide(front, 3, -20), back);
  EXPECT_EQ(movedSide(front, 3, 0), 0u);
  EXPECT_EQ(movedSide(0, 3, -5), back);
}

void expectRefused(const Case& c, const std::string& text) {
  try {
    made(c);
    FAIL() << "expected: " << text;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(text));
  }
}

TEST(ThinSheet, MayNotFaceItsOwnBack) {
  // One and a half turns, with the outside of one round before the inside of the next.
  std::vector<Vec<2>> spiral;
  for (int k = 0; k <= 54; ++k) {
    const double angle = k * 0.1745, r = 0.8 + 0.08 * angle;
    spiral.push_back({2 + r * std::cos(angle), 2 + r * std::sin(angle)});
  }
  expectRefused(planeCase(lineBody(spiral)), "thin sheet 'sheet' has its front face its back at (");
}

Case meshCase(Triangles triangles) {
  Case c;
  c.dimensions = 3;
  c.spacing = 0.1;
  c.domain = {{-1, -1, -1}, {2, 2, 2}};
  c.materials.push_back({"honey", 1000, 1, 1000, 1e5});
  const Body fluid = test::makeBody("fluid", BodyKind::Fluid, test::box({}, {1, 1, 1}));
  Body sheet = test::makeBody("sheet", BodyKind::Wall, {});
  sheet.shape.kind = ShapeKind::Mesh;
  sheet.shape.fill = FillKind::ThinSheet;
  sheet.shape.file.mesh.value = std::make_shared<const Mesh>(std::move(triangles));
  c.bodies = {fluid, sheet};
  return c;
}

TEST(ThinSheet, IsASurfaceWithTwoSides) {
  Triangles branch;
  branch.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -1, 0}, {0.5, 0, 1}};
  branch.corners = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  std::vector<std::string> notes;
  const auto refusal = [&](const Triangles& triangles) -> std::string {
    try {
      createParticles<3>(meshCase(triangles), notes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_THAT(refusal(branch), HasSubstr("3 of its faces meet at"));
  Triangles turned = branch;
  turned.corners = {{0, 1, 2}, {0, 1, 3}};
  EXPECT_THAT(refusal(turned), HasSubstr("do not agree on which side is the front"));
  Triangles sound = branch;
  sound.corners = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(refusal(sound), "none");
}

/// A polygon that is a thin sheet, or the outline of a thin solid.
Body outlineBody(std::vector<Vec<2>> points) {
  Body body = lineBody(std::move(points));
  body.shape.kind = ShapeKind::Polygon;
  body.shape.fill = FillKind::ThinSheet;
  return body;
}

/// The largest distance of the points where the particles of a sheet see it from a middle at 0, by `height`.
template <int D, class Height>
double farthest(const Particles<D>& p, Height&& height) {
  double most = 0;
  for (std::uint32_t i = p.fluidCount; i < p.count; ++i)
    most = std::max(most,
                    std::abs(height(p.position[i] + converted<double>(p.wallSurface[i - p.fluidCount].face[0]))));
  return most;
}

TEST(ThinSheet, IsInTheMiddleOfAThinCup) {
  // A cup without a lid, 0.4 spacings thick, with fluid in it and around it.
  const Particles<2> p = made(
      planeCase(outlineBody({{1, 1}, {3, 1}, {3, 3}, {2.96, 3}, {2.96, 1.04}, {1.04, 1.04}, {1.04, 3}, {1, 3}})));
  ASSERT_GT(p.count, p.fluidCount);
  const auto height = [](const Vec<2>& x) {
    return std::max({1.02 - x[1], 1.02 - x[0], x[0] - 2.98});  // 0 along the middle, as far as it goes
  };
  EXPECT_LT(farthest(p, height), 1e-6);
  std::uint32_t inside = sides::None, outside = sides::None;
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
    const std::uint32_t side = sides::of(p.side[i], 0);
    if (std::abs(height(p.position[i])) > 0.3 || p.position[i][1] > 2.9) continue;
    ASSERT_NE(side, sides::None);
    std::uint32_t& all = height(p.position[i]) < 0 ? inside : outside;
    if (all == sides::None) all = side;
    EXPECT_EQ(side, all);
  }
  EXPECT_NE(inside, outside);
}

TEST(ThinSheet, OfAThinSolidEndsInTheMiddleOfItsRim) {
  // A wedge, whose sides meet in sharp edges, and a bent strip with round ends.
  const Particles<2> wedge = made(planeCase(outlineBody({{1, 2}, {2, 1.95}, {3, 2}, {2, 2.05}})));
  EXPECT_LT(farthest(wedge, [](const Vec<2>& x) { return x[1] - 2; }),
            1e-3);  // half a way at right angles to a side
  std::vector<Vec<2>> strip;
  const auto addEnd = [&](const Vec<2>& middle, double angle) {
    for (int k = 0; k <= 8; ++k) {
      const double a = angle + (k - 4) * std::acos(-1.0) / 8;
      strip.push_back(middle + Vec<2>{0.1 * std::cos(a), 0.1 * std::sin(a)});
    }
  };
  addEnd({1, 2}, std::acos(-1.0));
  strip.push_back({2.1, 1.9}), addEnd({2, 3}, std::acos(-1.0) / 2), strip.push_back({1.9, 2.1});
  const Particles<2> bent = made(planeCase(outlineBody(strip)));
  const auto height = [](const Vec<2>& x) { return std::max(x[0] - 2, 2 - x[1]); };
  EXPECT_LT(farthest(bent, height), 1e-6);
  double left = 4, top = 0;
  for (std::uint32_t i = bent.fluidCount; i < bent.count; ++i)
    left = std::min(left, bent.position[i][0]), top = std::max(top, bent.position[i][1]);
  EXPECT_NEAR(left, 1, 0.06);
  EXPECT_NEAR(top, 3, 0.06);
}

TEST(ThinSheet, IsInTheMiddleOfAThinMesh) {
  // A bowl with a foot: a disc, a cylinder and a rounded rim, 0.3 spacings thick.
  constexpr double r = 0.4, t = 0.03;
  std::vector<Vec<2>> outline{{0, 0.2}, {r + t, 0.2}};
  for (int k = 0; k <= 6; ++k) {
    const double angle = k * std::acos(-1.0) / 6;
    outline.push_back({r + t / 2 + t / 2 * std::cos(angle), 0.8 + t / 2 * std::sin(angle)});
  }
  outline.insert(outline.end(), {{r, 0.2 + t}, {0, 0.2 + t}});
  Case c = meshCase(test::turnedMesh(outline, 96));
  Transform transform;
  transform.translate = {0.5, 0.5, 0};
  c.bodies[1].shape.transform = transform;
  std::vector<std::string> notes;
  const Particles<3> p = createParticles<3>(c, notes);
  ASSERT_GT(p.count, p.fluidCount);
  const auto height = [](const Vec<3>& x) {
    return std::max(0.2 + t / 2 - x[2], std::hypot(x[0] - 0.5, x[1] - 0.5) - r - t / 2);
  };
  EXPECT_LT(farthest(p, height), 0.001);  // a chord is up to 0.0003 away from the circle
  for (std::uint32_t i = 0; i < p.fluidCount; ++i)
    if (std::abs(height(p.position[i])) < 0.3 && p.position[i][2] < 0.7) {
      EXPECT_NE(sides::of(p.side[i], 0), sides::None);
    }
}

TEST(ThinSheet, OfAThickSolidIsItsWholeSurface) {
  const Particles<2> p = made(planeCase(outlineBody({{1, 1}, {3, 1}, {3, 3}, {1, 3}})));
  const auto height = [](const Vec<2>& x) { return std::max(std::abs(x[0] - 2), std::abs(x[1] - 2)) - 1; };
  EXPECT_LT(farthest(p, height), 1e-6);
}

TEST(ThinSheet, NeedsADomainOnBothSides) {
  const auto notes = [](double height) {
    std::vector<std::string> found;
    createParticles<2>(planeCase(lineBody({{1, height}, {3, height}})), found);
    return found;
  };
  EXPECT_THAT(notes(-0.6), testing::IsEmpty());
  EXPECT_THAT(notes(-0.8),
              testing::ElementsAre(HasSubstr("thin sheet 'sheet': 14 % of its particles are left out")));
}

TEST(ThinSheet, MayNotBranchNorBeThickInPlaces) {
  expectRefused(planeCase(outlineBody(
                    {{1, 1}, {3, 1}, {3, 1.04}, {2.02, 1.04}, {2.02, 3}, {1.98, 3}, {1.98, 1.04}, {1, 1.04}})),
                "thin sheet 'sheet' is a thin solid that branches at (");
  expectRefused(planeCase(outlineBody({{1, 1}, {2, 1}, {2, 2}, {1.04, 2}, {1.04, 4}, {1, 4}})),
                "make the thick part a body of its own");
}

}  // namespace
}  // namespace treacle
