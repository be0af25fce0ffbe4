#include "treacle/model/particles/create.hpp"

#include "treacle/core/error.hpp"
#include "treacle/core/parallel.hpp"
#include "treacle/model/case/names.hpp"
#include "treacle/model/geometry/shape.hpp"
#include "treacle/model/geometry/side_map.hpp"
#include "treacle/model/geometry/wall_surface.hpp"

#include "filled.hpp"
#include "geometry/mesh_notes.hpp"
#include "geometry/point_boxes.hpp"
#include "lattice.hpp"
#include "overlap.hpp"
#include "reserve.hpp"
#include "treacle/model/geometry/point_grid.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

/// The points of all bodies of one kind, not yet freed of overlaps.
template <int D>
std::vector<Filled<D>> fillBodies(const Case& c, BodyKind kind, std::vector<std::string>& notes) {
  std::vector<Filled<D>> filled;
  for (const Body& body : c.bodies) {
    if (body.kind == BodyKind::Inflow) {
      filled.push_back({&body, nozzlePoints<D>(c, body, kind, notes)});
    } else if (body.kind == kind || (kind == BodyKind::Wall && body.isWall())) {
      filled.push_back({&body, bodyPoints<D>(c, body, notes)});
      noteMesh(c, body, notes);
    }
  }
  return filled;
}

/// Takes from each body that subtracts others what is closer to their particles than the radius.
template <int D>
void subtract(const Domain& domain, double radius, const std::vector<const std::vector<Filled<D>>*>& groups,
              std::vector<Filled<D>>& filled) {
  for (Filled<D>& f : filled) {
    if (f.body->subtract.empty()) continue;
    std::vector<const Filled<D>*> others;
    std::size_t count = 0;
    for (const auto* group : groups)
      for (const Filled<D>& other : *group)
        if (std::ranges::find(f.body->subtract, other.body->name) != f.body->subtract.end())
          others.push_back(&other), count += other.points.size();
    PointGrid<D> grid(domain, radius, count);
    for (const Filled<D>* other : others)
      for (const Vec<D>& x : other->points.place) grid.add(x, 0);
    f.points.filter([&](std::size_t k) { return grid.find(f.points.place[k]) == PointGrid<D>::none; });
  }
}

/// The nearest image of its centre must stay the same one as a wall turns. Errors: InputError for a wall that
/// would reach half a period from it.
template <int D>
void requireTurnable(const Domain& domain, double spacing, const Filled<D>& f) {
  if (!f.body->rotation) return;
  const Vec<3> axis = f.body->rotation->direction();
  for (int k = 0; k < D; ++k) {
    const double across = std::sqrt(std::max(0.0, 1 - axis[k] * axis[k]));
    if (!domain.periodic[static_cast<std::size_t>(k)] || across < 1e-6) continue;
    double reach = 0;
    for (const Vec<D>& x : f.points.place) {
      const Vec<3> d = resized<3>(x) - f.body->rotation->center;
      const double along = dot(d, axis), radius = norm(d - along * axis);
      reach = std::max(reach, std::abs(along * axis[k]) + radius * across);
    }
    if (f.body->kind == BodyKind::Inflow) reach += spacing;  // its layers go as far before they are set back
    if (const double half = (domain.max[k] - domain.min[k]) / 2; reach >= half)
      throw InputError(fmt::format(
          "rotating {} '{}' reaches {} along the periodic {} axis from its centre; expected less than half the "
          "domain, {}",
          nameOf(f.body->kind), f.body->name, lengthText(reach), "xyz"[k], lengthText(half)));
  }
}

/// A grid for those points of the bodies that may be too near others.
template <int D>
PointGrid<D> gridFor(const Domain& domain, double radius, const std::vector<Filled<D>>& filled,
                     const PointBoxes<D>& boxes) {
  std::size_t count = 0;
  for (const Filled<D>& f : filled)
    if (const auto near = boxes.near(f.body); !near.empty())
      count += static_cast<std::size_t>(
          std::ranges::count_if(f.points.place, [&](const Vec<D>& x) { return near.contain(x); }));
  return PointGrid<D>(domain, radius, count);
}

/// Thin sheets overlap with nothing.
template <int D>
PointBoxes<D> boxesOf(const Domain& domain, double radius,
                      const std::vector<const std::vector<Filled<D>>*>& groups) {
  PointBoxes<D> boxes(domain, radius);
  for (const auto* group : groups)
    for (const Filled<D>& f : *group)
      if (!f.body->shape.isThinSheet()) boxes.add(f.body, f.points.place);
  return boxes;
}

/// What drives an inflow needs all its room. Errors: InputError for walls of which one is that of an inflow.
template <int D>
void requireNoNozzle(const Body& a, const Body& b, const Vec<D>& x) {
  if (a.kind != BodyKind::Inflow && b.kind != BodyKind::Inflow) return;
  const bool first = a.kind == BodyKind::Inflow;
  throw InputError(fmt::format(
      "inflow '{}' and {} '{}' overlap at {}: an inflow needs the room of its nozzle, and as much behind it as "
      "particles act on each other",
      first ? a.name : b.name, nameOf((first ? b : a).kind), first ? b.name : a.name,
      positionText(resized<3>(x), D)));
}

/// Union in file order: drops points that are in the place of an earlier body, and says so.
template <int D>
void unite(const Case& c, BodyKind kind, const Overlap<D>& overlap, std::vector<Filled<D>>& filled,
           std::vector<std::string>& notes) {
  const bool shapes = kind == BodyKind::Fluid || c.hasRigid() || c.hasInflow();  // which count beside particles
  const double radius = shapes ? overlap.reach() : overlap.radius();
  const PointBoxes<D> boxes = boxesOf<D>(c.domain, radius, {&filled});
  PointGrid<D> grid = gridFor(c.domain, radius, filled, boxes);
  for (std::uint32_t b = 0; b < filled.size(); ++b) {
    auto& points = filled[b].points;
    const auto near = boxes.near(filled[b].body);
    if (near.empty()) continue;
    const std::size_t all = points.size();
    std::uint32_t other = PointGrid<D>::none;
    points.filter([&](std::size_t k) {
      const Vec<D>& x = points.place[k];
      if (!near.contain(x)) return true;
      const auto taken = [&](std::uint32_t tag, const Vec<D>& point, const Vec<D>& image) {
        if (overlap.areClose(point, image)) return true;
        const Body &later = *filled[b].body, &earlier = *filled[tag].body;
        if (kind == BodyKind::Fluid) return tag != b && overlap.isInside(earlier, image);
        return overlap.isTaken(later, image, earlier, point - (image - x));
      };
      if (const std::uint32_t tag = grid.find(x, taken); tag != PointGrid<D>::none) {
        other = tag;
        if (kind == BodyKind::Wall) requireNoNozzle(*filled[b].body, *filled[other].body, x);
        return false;
      }
      grid.add(x, b);
      return true;
    });
    if (points.size() == 0 && all > 0 && filled[b].body->kind == BodyKind::Rigid)
      throw InputError(
          fmt::format("rigid body '{}' has no particles: the place of all {} is taken by {} '{}'; move "
                      "one of the two, or leave one out",
                      filled[b].body->name, all, nameOf(filled[other].body->kind), filled[other].body->name));
    if (points.size() < all)
      notes.push_back(fmt::format("body '{}': {} of {} particles left out, their place is taken by body '{}'",
                                  filled[b].body->name, all - points.size(), all, filled[other].body->name));
  }
}

/// An inflow neither subtracts nor is subtracted.
std::string adviceForRoom(const Body& fluid, const Body& wall) {
  if (fluid.kind == BodyKind::Inflow)
    return fmt::format(
        "the nozzle needs a spacing of room in front of it: move it, or shape '{}' so that it leaves "
        "the room, such as by its where",
        wall.name);
  if (wall.kind == BodyKind::Inflow)
    return fmt::format(
        "the nozzle needs its room: move it, or shape '{}' so that it leaves the room, such as by its "
        "where",
        fluid.name);
  return fmt::format("subtract = [\"{}\"] of '{}' leaves it the room", wall.name, fluid.name);
}

/// Errors: InputError for the first wall that shares places with the fluid.
template <int D>
void requireApart(const Case& c, const Overlap<D>& overlap, const std::vector<Filled<D>>& fluid,
                  const std::vector<Filled<D>>& walls) {
  const PointBoxes<D> boxes = boxesOf<D>(c.domain, overlap.reach(), {&fluid, &walls});
  PointGrid<D> grid = gridFor(c.domain, overlap.reach(), fluid, boxes);
  for (std::uint32_t b = 0; b < fluid.size(); ++b)
    if (const auto near = boxes.near(fluid[b].body); !near.empty())
      for (const Vec<D>& x : fluid[b].points.place)
        if (near.contain(x)) grid.add(x, b);
  for (const Filled<D>& wall : walls) {
    const auto near = boxes.near(wall.body);
    if (near.empty()) continue;
    std::vector<std::pair<std::uint32_t, Vec<D>>> hits;
    bool close = true;
    for (const Vec<D>& x : wall.points.place) {
      if (!near.contain(x)) continue;
      const auto shared = [&](std::uint32_t tag, const Vec<D>& point, const Vec<D>& image) {
        if (overlap.areClose(point, image)) return true;
        const bool is = overlap.sharePlace(*fluid[tag].body, point - (image - x), *wall.body, image);
        close = close && !is;
        return is;
      };
      if (const std::uint32_t tag = grid.find(x, shared); tag != PointGrid<D>::none) hits.push_back({tag, x});
    }
    if (hits.empty()) continue;
    const Body& in = *fluid[hits[0].first].body;
    throw InputError(
        fmt::format("{} '{}' and {} '{}' overlap: {} wall particle{} {}the fluid, the first at {}; {}",
                    in.kind == BodyKind::Inflow ? "inflow" : "fluid body", in.name,
                    wall.body->kind == BodyKind::Inflow ? "inflow" : "wall body", wall.body->name, hits.size(),
                    hits.size() == 1 ? "" : "s", close ? "closer than half a spacing to " : "in the place of ",
                    positionText(resized<3>(hits[0].second), D), adviceForRoom(in, *wall.body)));
  }
}

/// The ids that become particles, [first, end); the id of the next point; and where the next particle is to stand.
struct Place {
  std::uint32_t first, end, id = 0, at = 0;
};

template <int D>
void append(const Case& c, BodyKind kind, const std::vector<Filled<D>>& filled, Particles<D>& particles,
            Place& next) {
  const std::uint32_t first = next.first, end = next.end;
  std::uint32_t &id = next.id, &at = next.at;
  for (const Filled<D>& f : filled) {
    const auto body = static_cast<std::uint8_t>(f.body - c.bodies.data());
    const auto count = static_cast<std::uint32_t>(f.points.size());
    const std::uint32_t begin = std::clamp(first, id, id + count) - id,
                        made = std::clamp(end, id, id + count) - id;
    const InitialState<D> initial(c, *f.body);
    const bool warm = c.heat && kind == BodyKind::Fluid,
               factors = particles.has.viscosityFactors && kind == BodyKind::Fluid;
    const std::size_t states = kind == BodyKind::Fluid ? particles.has.states : 0,
                      elasticModes = kind == BodyKind::Fluid ? particles.has.elasticModes : 0;
    const auto place = [&](std::size_t k) {
      const std::size_t i = at + k;
      particles.id[i] = static_cast<std::uint32_t>(id + begin + k);
      particles.position[i] = initial.placeOf(f.points, begin + k, particles.id[i]);
      particles.velocity[i] = initial.velocityAt(f.points, begin + k);
      if (warm) particles.temperature[i] = initial.temperatureAt(f.points, begin + k);
      if (factors) particles.viscosityFactor[i] = initial.viscosityFactorAt(f.points.place[begin + k]);
      for (std::size_t s = 0; s < states; ++s)
        particles.states[s][i] = initial.stateAt(s, f.points.place[begin + k]);
      for (std::size_t m = 0; m < elasticModes; ++m) particles.conformation[m][i] = SymmetricBlock<D>::identity();
      particles.pressure[i] = 0;
      particles.heldPressure[i] = 0;
      particles.numberDensity[i] = 0;
      particles.material[i] = static_cast<std::uint8_t>(f.body->material);
      particles.body[i] = body;
    };
    const std::uint32_t size = made - begin;
    if (initial.hasExpressions())
      for (std::size_t k = 0; k < size; ++k) place(k);
    else
      parallelFor(size, parallelGrain, place);
    id += count, at += size;
  }
}

/// How large fluid bodies are that hold no particle: a mesh in metres may have been taken for one in millimetres.
std::string sizesOfFluid(const Case& c) {
  std::string text;
  for (const Body& body : c.bodies) {
    if (body.kind != BodyKind::Fluid) continue;
    const Extent box = boundingBox(body.shape, c.dimensions);
    const Vec<3> size = box.max - box.min;
    text += fmt::format("; '{}' is {:.3g} m x {:.3g} m", body.name, size[0], size[1]);
    if (c.dimensions == 3) text += fmt::format(" x {:.3g} m", size[2]);
    text += " large";
    if (!body.where.empty()) text += fmt::format(", of which where = \"{}\" leaves nothing", body.where);
    if (!body.subtract.empty()) text += fmt::format(", less '{}'", fmt::join(body.subtract, "', '"));
  }
  return text.empty() ? text : fmt::format("{}, and the spacing is {:.3g} m", text, c.spacing);
}

/// For the velocities that fluid meets at walls, and for the gaps of rigid bodies.
bool needsWallSurfaces(const Case& c) {
  return c.method.scheme == SchemeKind::Accurate || (c.method.kind == MethodKind::Isph && c.hasRigid());
}

}  // namespace

template <int D>
Particles<D> createParticles(const Case& c, std::vector<std::string>& notes, std::vector<BodyCount>* bodyCounts,
                             ParticlePart part) {
  auto fluid = fillBodies<D>(c, BodyKind::Fluid, notes);
  auto walls = fillBodies<D>(c, BodyKind::Wall, notes);
  const Overlap<D> overlap(c);
  const double radius = overlap.radius();
  subtract<D>(c.domain, radius, {&fluid, &walls}, fluid);
  subtract<D>(c.domain, radius, {&fluid, &walls}, walls);
  requireReserves<D>(c, overlap, notes);
  clearBehindReserves<D>(c, fluid, notes);
  if (total(fluid) == 0 && !c.hasInflow())
    throw InputError("the case has no fluid: no body of type \"fluid\" holds a particle" + sizesOfFluid(c));
  if (total(fluid) + total(walls) > maxParticles)
    throw InputError(fmt::format("the case would have {} particles, more than the limit of {}",
                                 total(fluid) + total(walls), maxParticles));
  for (const auto& f : walls) requireTurnable(c.domain, c.spacing, f);

  unite<D>(c, BodyKind::Fluid, overlap, fluid, notes);
  unite<D>(c, BodyKind::Wall, overlap, walls, notes);
  requireApart<D>(c, overlap, fluid, walls);

  const auto fluidCount = static_cast<std::uint32_t>(total(fluid)),
             wallCount = static_cast<std::uint32_t>(total(walls));
  const std::uint32_t n = part.size(fluidCount), count = part.size(wallCount);
  Particles<D> particles;
  ParticleNumbers numbers{n, count};
  numbers.has.temperatures = c.heat.has_value(), numbers.has.viscosityFactors = c.hasViscosityFactors();
  numbers.has.states = static_cast<std::uint8_t>(c.stateNames().size());
  numbers.has.elasticModes = static_cast<std::uint8_t>(c.elasticModes());
  particles.resize(numbers);
  Place next{part.begin(fluidCount), part.end(fluidCount)};
  append(c, BodyKind::Fluid, fluid, particles, next);
  next.first = fluidCount + part.begin(wallCount), next.end = fluidCount + part.end(wallCount);
  append(c, BodyKind::Wall, walls, particles, next);
  if (needsWallSurfaces(c)) {
    std::vector<std::string> untold;
    // What the notes say is about the viscosity of MPH-I at walls.
    const bool tell = part.isAll() && c.method.kind == MethodKind::MphI;
    const auto surfaces = createWallSurfaces<D>(c, particles.position.span().subspan(n, count),
                                                particles.body.span().subspan(n, count), tell ? notes : untold);
    particles.wallSurface.resize(count);
    std::copy(surfaces.begin(), surfaces.end(), particles.wallSurface.begin());
  }
  if (c.hasThinSheets()) createSides<D>(c, particles);
  if (bodyCounts) {
    bodyCounts->assign(c.bodies.size(), {});
    const auto countOf = [&](const std::vector<Filled<D>>& group, std::uint32_t BodyCount::*ofKind) {
      for (const Filled<D>& f : group)
        (*bodyCounts)[static_cast<std::size_t>(f.body - c.bodies.data())].*ofKind =
            static_cast<std::uint32_t>(f.points.size());
    };
    countOf(fluid, &BodyCount::fluid);
    countOf(walls, &BodyCount::wall);
  }
  return particles;
}

AnyParticles createParticles(const Case& c, std::vector<std::string>& notes, std::vector<BodyCount>* bodyCounts,
                             ParticlePart part) {
  if (c.dimensions == 2) return createParticles<2>(c, notes, bodyCounts, part);
  return createParticles<3>(c, notes, bodyCounts, part);
}

template Particles<2> createParticles<2>(const Case&, std::vector<std::string>&, std::vector<BodyCount>*,
                                         ParticlePart);
template Particles<3> createParticles<3>(const Case&, std::vector<std::string>&, std::vector<BodyCount>*,
                                         ParticlePart);

}  // namespace treacle
