#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/case/key.hpp"

namespace treacle::keys {

void visit(auto& v, Like<Oscillation> auto& o, const Case&) {
  v({"amplitude", "How far the wall goes to either side, along which axis", required, "m"}, o.amplitude);
  v({"period", "Time of one oscillation", required, "s", positive}, o.period);
  v({"phase", "Where in its oscillation the wall starts", optional, "rad"}, o.phase);
}

void visit(auto& v, Like<Rotation> auto& r, const Case& c) {
  v({"center", "A point of the axis, at the start; it goes along with all other motion", required, "m"}, r.center);
  v({"speed", "Speed of the rotation, positive counter-clockwise seen from the end of the axis", optional,
     "rad/s"},
    r.speed);
  v({"angle", "How far it has turned, in place of a speed", optional, "rad"}, r.angle);
  if (c.dimensions == 3)
    v({"axis", "Direction of the axis, of any length but zero", required, "any unit"}, r.axis);
}

void visit(auto& v, Like<Transform> auto& t, const Case& c) {
  v({"scale", "Factor that the shape is scaled by; 1e-3 takes a file in millimetres", optional, "", positive},
    t.scale);
  if (c.dimensions == 3)
    v({"axis", "Axis that the shape is turned about by angle, of any length but zero", optional, "any unit"},
      t.axis);
  v({"angle", "Angle that the shape is turned by, counter-clockwise seen from the end of the axis", optional,
     "deg"},
    t.angle);
  if (c.dimensions == 3)
    v({"angles", "Angles about the axes x, y and z of the case, in this order, in place of angle", optional,
       "deg"},
      t.angles);
  v({"center", "Point that scaling and turning leave where it is", optional, "m"}, t.center);
  v({"translate", "Way that the shape is moved by, after scaling and turning", optional, "m"}, t.translate);
}

/// The coordinates of a shape, which stand among the keys of its body.
void visit(auto& v, Like<Shape> auto& s, const Case& c) {
  const auto radii = [&] {
    v({"radius", "Radius; of a torus that of its circle", required, "m", positive}, s.radius);
    v({"inner_radius", "Hollow inside this radius; of a torus its tube is", optional, "m", notNegative},
      s.innerRadius);
  };
  const auto axis = [&] {
    v({"start", "One end of the axis", required, "m"}, s.start);
    v({"end", "The other end of the axis", required, "m"}, s.end);
  };
  const auto content = [&] {
    v({"file",
       "File of the shape, relative to the case file: .stl, .obj or .ply of a mesh, .vtp, .pvtp or .csv of "
       "particles",
       required},
      s.file.path, keys::file);
    v({"checksum",
       "What the checksum of the file must be; a run writes it, so that a file that has changed is noticed"},
      s.file.checksum);
  };
  const auto filling = [&] {
    v({"fill",
       "Which side of the boundary is filled: all of the inside, the inside up to thickness, a layer outside, a "
       "sheet on both sides, or, of a wall, a thin sheet without a thickness"},
      s.fill);
    if (s.fill == FillKind::ThinSheet) return;
    v({"thickness",
       "Thickness of a shell, of a layer outside or of a sheet; 0: as far as particles act on each other",
       optional, "m", notNegative},
      s.thickness);
  };
  switch (s.kind) {
    case ShapeKind::Box:
      v({"min", "Corner of the box with the least coordinates", required, "m"}, s.min);
      v({"max", "Corner of the box with the largest coordinates", required, "m"}, s.max);
      break;
    case ShapeKind::Sphere:
      v({"center", "Centre", required, "m"}, s.center);
      radii();
      break;
    case ShapeKind::Cylinder:
      axis();
      radii();
      break;
    case ShapeKind::Cone:
      axis();
      v({"start_radius", "Radius at the start of the axis; 0 is a tip", required, "m", notNegative},
        s.startRadius);
      v({"end_radius", "Radius at the end of the axis; 0 is a tip", required, "m", notNegative}, s.endRadius);
      v({"inner_start_radius", "Hollow inside this radius at the start of the axis", optional, "m", notNegative},
        s.innerStartRadius);
      v({"inner_end_radius", "Hollow inside this radius at the end of the axis", optional, "m", notNegative},
        s.innerEndRadius);
      break;
    case ShapeKind::Torus:
      v({"center", "Centre of the circle", required, "m"}, s.center);
      if (c.dimensions == 3)
        v({"axis", "Direction of the axis, of any length but zero", optional, "any unit"}, s.axis);
      v({"tube_radius", "Radius of the tube, less than radius", required, "m", positive}, s.tubeRadius);
      radii();
      break;
    case ShapeKind::Polygon:
    case ShapeKind::Polyline:
      v({"points",
         "Corners in order, of a polygon from 3 to 10,000 and either way round, of a polyline from 2; sides meet "
         "nowhere else",
         required, "m"},
        s.points);
      if (c.dimensions == 3) {
        v({"bottom", "Where the prism of a polygon or the ribbon of a polyline begins along z", required, "m"},
          s.bottom);
        v({"top", "Where it ends along z", required, "m"}, s.top);
      }
      if (s.kind == ShapeKind::Polygon) filling();
      break;
    case ShapeKind::Mesh:
      content();
      v({"flip", "Turns inside and outside of the mesh round"}, s.flip);
      filling();
      break;
    case ShapeKind::Particles:
      content();
      break;
  }
  v({"transform", "The shape is scaled, turned and moved"}, s.transform);
}

void visit(auto& v, Like<Nozzle> auto& n, const Case& c) {
  v({"shape", "Shape of the opening", required}, n.kind);
  v({"center", "Centre of the opening", required, "m"}, n.center);
  v({"direction", "Direction in which fluid comes into the case, of any length", required, "any unit"},
    n.direction);
  if (n.kind == NozzleKind::Disc) {
    v({"radius", "Radius of the disc, in two dimensions half the width of the opening", required, "m", positive},
      n.radius);
    v({"inner_radius", "Radius of the hole of a ring", optional, "m", notNegative}, n.innerRadius);
    return;
  }
  if (n.kind == NozzleKind::Rectangle) {
    v({"width", "Width of the rectangle", required, "m", positive}, n.width);
    if (c.dimensions == 3) v({"height", "Height of the rectangle", required, "m", positive}, n.height);
  } else {
    v({"points", "Corners in order, from the centre: along the width, which is direction x up, and along up",
       required, "m"},
      n.points);
  }
  if (c.dimensions == 3)
    v({"up", "Vector that the height is along, as far as it is across the direction; zero: any", optional,
       "any unit"},
      n.up);
}

/// What an inflow has in place of a shape, among the keys of its body.
void visit(auto& v, Like<Inflow> auto& i, const Case& c) {
  v({"nozzle", "The opening that fluid comes out of", required}, i.nozzle);
  v({"speed", "Speed of the fluid relative to the nozzle, in place of a flow rate", optional, "m/s", notNegative},
    i.speed);
  v({"flow_rate", "Flow through all of the opening, in place of a speed", optional,
     c.dimensions == 2 ? "m2/s" : "m3/s", notNegative},
    i.flowRate);
  v({"profile",
     "How the speed differs over the opening: \"plug\", not at all, \"parabolic\", as in a steady viscous flow, "
     "or an expression of the place at the start, which is divided by its mean"},
    i.profile);
  v({"start", "When the flow begins", optional, "s", notNegative}, i.start);
  v({"end", "When the flow ends; 0: it does not", optional, "s", notNegative}, i.end);
}

void visit(auto& v, Like<Outflow> auto& o, const Case&) {
  v({"name", "Name of the outflow, unique among them", required}, o.name);
  v({"shape", "Whether fluid leaves in a box or beyond a plane", required}, o.kind);
  if (o.kind == OutflowKind::Box) {
    v({"min", "Corner of the box with the least coordinates", required, "m"}, o.min);
    v({"max", "Corner of the box with the largest coordinates", required, "m"}, o.max);
    return;
  }
  v({"point", "A point of the plane", required, "m"}, o.point);
  v({"normal", "Normal of the plane, of any length; what is beyond the plane in this direction is taken out",
     required, "any unit"},
    o.normal);
}

void visit(auto& v, Like<Opening> auto& o, const Case& c) {
  v({"name", "Name of the opening, unique among them", required}, o.name);
  v({"material", "Name of the material of fluid that comes in, which some body has", required}, o.material,
    material);
  v({"face", "Where fluid goes in or out; its direction leads into the case", required}, o.face);
  v({"pressure", "Pressure at the centre of the face, above that of the air", optional, "Pa"}, o.pressure);
  v({"flow_rate", "Flow into the case through the face, in place of a pressure", optional,
     c.dimensions == 2 ? "m2/s" : "m3/s"},
    o.flowRate);
  if (c.heat) v({"temperature", "Temperature of fluid that comes in", required, "K", positive}, o.temperature);
  if (c.method.kind == MethodKind::MphI)
    v({"viscosity_factor", "By what the viscosity of fluid that comes in is multiplied; 0: 1", optional, "",
       notNegative},
      o.viscosityFactor);
}

void visit(auto& v, Like<Spring> auto& s, const Case& c) {
  const bool plane = c.dimensions == 2;
  v({"name", "Name of the spring, unique among those of the body", required}, s.name);
  v({"to", "Name of the rigid body that its other end is on; empty: it is at rest"}, s.to);
  v({"anchor",
     "Where its other end is at rest, or on the body that `to` names, the way from that body's centre of mass as "
     "it "
     "stands at the start",
     required, "m"},
    s.anchor);
  v({"arm", "From this body's centre of mass to its end there, as the body stands at the start", optional, "m"},
    s.arm);
  v({"length", "Its length without a load", optional, "m", notNegative}, s.length);
  v({"stiffness", "Force over the change of its length", optional, plane ? "N/m2" : "N/m", notNegative},
    s.stiffness);
  v({"damping", "Force over the speed of that change, against it", optional, plane ? "N s/m2" : "N s/m",
     notNegative},
    s.damping);
}

void visit(auto& v, Like<Hinge> auto& h, const Case& c) {
  v({"point", "A point of the axis", required, "m"}, h.point);
  if (c.dimensions == 3)
    v({"axis", "Direction of the axis, of any length but zero", required, "any unit"}, h.axis);
}

/// What a rigid body has among the keys of its body.
void visit(auto& v, Like<RigidSettings> auto& r, const Case& c) {
  const bool plane = c.dimensions == 2;
  v({"mass", "Mass of the body; 0: that of its particles with the density of its material", optional,
     plane ? "kg/m" : "kg", notNegative},
    r.mass);
  v({"translates", "Along which axes the body may move; along others it keeps its velocity"}, r.translates);
  if (plane) {
    v({"angular_velocity", "Angular velocity at the start", optional, "rad/s"}, r.angularVelocity[2]);
    v({"rotates", "Whether the body may turn"}, r.rotates[2]);
  } else {
    v({"angular_velocity", "Angular velocity at the start", optional, "rad/s"}, r.angularVelocity);
    v({"rotates", "About which axes the body may turn"}, r.rotates);
  }
  v({"hinge", "An axis at rest that the body turns about, and nothing else"}, r.hinge);
  v({"release", "When the body is let go; it stands still until then", optional, "s", notNegative}, r.release);
  v({"force", "Force on its centre of mass, beside those of the fluid, gravity and contacts", optional,
     plane ? "N/m" : "N"},
    r.force);
  const Key torque{"torque", "Torque about its centre of mass, likewise", optional, plane ? "N" : "N m"};
  if (plane)
    v(torque, r.torque[2]);
  else
    v(torque, r.torque);
  v({"damping", "Force over its speed, against it", optional, plane ? "kg/(m s)" : "kg/s", notNegative},
    r.damping);
  v({"angular_damping", "Torque over its angular velocity, against it", optional, plane ? "kg m/s" : "kg m2/s",
     notNegative},
    r.angularDamping);
  v({"springs", "Springs to the body from places at rest or from other bodies", optional, "", {0, maxSprings}},
    r.springs);
}

void visit(auto& v, Like<StateStart> auto& s, const Case&) {
  v({"name", "Name of a state of the body's material", required}, s.name);
  v({"value", "What it starts with", required}, s.value, s.expression);
}

void visit(auto& v, Like<Body> auto& b, const Case& c) {
  v({"name", "Name of the body, unique among them", required}, b.name);
  v({"type", "Fluid, a wall, an inflow, or a rigid body, a wall that the fluid moves", required}, b.kind);
  v({"material", "Name of the material", required}, b.material, material);
  if (b.kind == BodyKind::Inflow) {
    v({"velocity", "Velocity of the nozzle", optional, "m/s"}, b.velocity);
    v({"oscillation", "The nozzle swings to and fro"}, b.oscillation);
    v({"displacement", "How far the nozzle is displaced in time, along each axis", optional, "m"}, b.displacement);
    v({"rotation", "The nozzle turns, on top of all other motion"}, b.rotation);
    if (c.heat)
      v({"temperature", "Temperature of the fluid that comes in", required, "K", positive}, b.temperature);
    if (c.method.kind == MethodKind::MphI)
      v({"viscosity_factor", "By what the viscosity of the fluid that comes in is multiplied; 0: 1", optional, "",
         notNegative},
        b.viscosityFactor);
    return visit(v, b.inflow, c);
  }
  v({"shape", "Shape that is filled with particles", required}, b.shape.kind);
  v({"where", "Only those particles are made at which this is not zero"}, b.where, expression);
  v({"subtract", "Names of bodies whose places it leaves to them, so that its particles do not overlap theirs"},
    b.subtract);
  const Key velocity{"velocity", "Velocity: of a fluid or rigid body at the start, of a wall for the whole run",
                     optional, "m/s"};
  if (b.kind == BodyKind::Fluid)
    v(velocity, b.velocity, b.velocityExpression);
  else
    v(velocity, b.velocity);
  if (b.kind == BodyKind::Fluid)
    v({"disorder", "How far its particles stand off the lattice at the start, at random, along each axis at most",
       optional, "spacings", disorder},
      b.disorder);
  const bool ofFile = b.kind == BodyKind::Fluid && b.shape.kind == ShapeKind::Particles;
  if (ofFile)
    v({"file_velocities", "Whether particles have the velocities of the file, on top of that of the body"},
      b.fileVelocities);
  if (b.kind == BodyKind::Fluid && c.method.kind == MethodKind::MphI)
    v({"viscosity_factor",
       "By what viscosities of its particles are multiplied, each keeping its own; 0: 1, or none where no body "
       "has "
       "any",
       optional, "", notNegative},
      b.viscosityFactor, b.viscosityFactorExpression);
  if (b.kind == BodyKind::Fluid && c.method.kind == MethodKind::MphI)
    v({"state", "States that the fluid starts with, where not as the material says", optional, "", {0, maxStates}},
      b.states);
  if (b.kind == BodyKind::Rigid) {
    visit(v, b.rigid, c);
  } else if (b.kind == BodyKind::Wall) {
    v({"oscillation", "The wall swings to and fro, on top of its velocity"}, b.oscillation);
    v({"displacement",
       "How far the wall is displaced in time, along each axis, on top of its velocity and oscillation", optional,
       "m"},
      b.displacement);
    v({"rotation", "The wall turns, on top of all other motion"}, b.rotation);
  }
  if (b.isWall())
    v({"friction",
       "Coefficient of Coulomb friction where rigid bodies touch; of two bodies the geometric mean counts",
       optional, "", notNegative},
      b.friction);
  if (b.isWall())
    v({"restitution",
       "Speed after an impact of rigid bodies over that before; of two bodies the geometric mean counts",
       optional,
       "",
       {0, 1}},
      b.restitution);
  if (c.heat) {
    const bool fluid = b.kind == BodyKind::Fluid;
    if (ofFile)
      v({"file_temperatures", "Whether particles have the temperatures of the file, in place of temperature"},
        b.fileTemperatures);
    const Key temperature{"temperature",
                          "Of a fluid at the start; of a wall that of its surface, or with wall_conductance that "
                          "behind it, 0 being an adiabatic wall",
                          fluid, "K", fluid ? positive : notNegative};
    if (fluid && !b.fileTemperatures) v(temperature, b.temperature, b.temperatureExpression);
    if (!fluid) v(temperature, b.temperature);
    if (!fluid)
      v({"wall_conductance", "Conductivity of the wall over its thickness; 0: its surface has the temperature",
         optional, "W/(m2 K)", notNegative},
        b.wallConductance);
  }
  visit(v, b.shape, c);
}

}  // namespace treacle::keys
