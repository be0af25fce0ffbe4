#include "sample_case.hpp"
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

}  // namespace
}  // namespace treacle
