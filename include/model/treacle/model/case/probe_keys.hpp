#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/case/key.hpp"

namespace treacle::keys {

inline constexpr Bound places{0, 1e6};

void visit(auto& v, Like<ProbeBox> auto& b, const Case&) {
  v({"min", "Corner of the box with the least coordinates", required, "m"}, b.min);
  v({"max", "Corner of the box with the largest coordinates", required, "m"}, b.max);
}

void visit(auto& v, Like<Probe> auto& p, const Case& c) {
  v({"name", "Name of the probe and of its file: letters, digits and . _ - +", required}, p.name);
  v({"type", "What is measured", required}, p.kind);
  v({"interval", "Time between two readings; 0: one after every step", optional, "s", notNegative}, p.interval);
  if (!p.isOnWall())
    v({"moves_with",
       "Name of a wall or rigid body that carries the probe. Places are those at the start; with a rigid body "
       "they "
       "are ways from its centre of mass as it stands at the start"},
      p.movesWith);
  switch (p.kind) {
    case ProbeKind::Point:
      v({"point", "Place at which the fields are read", required, "m"}, p.point);
      break;
    case ProbeKind::Line:
    case ProbeKind::Height:
      v({"from", "Where the line begins", required, "m"}, p.from);
      v({"to", "Where the line ends", required, "m"}, p.to);
      if (p.kind == ProbeKind::Line)
        v({"count", "Number of places along the line; 0: about one per spacing", optional, "", places}, p.count);
      break;
    case ProbeKind::Plane:
      v({"corner", "A corner of the rectangle", required, "m"}, p.corner);
      v({"along", "One edge of the rectangle, from the corner", required, "m"}, p.along);
      v({"up", "The other edge, at a right angle to the first", required, "m"}, p.up);
      v({"columns", "Number of places along the first edge; 0: about one per spacing", optional, "", places},
        p.columns);
      v({"rows", "Number of places along the other edge; 0: about one per spacing", optional, "", places}, p.rows);
      break;
    case ProbeKind::Flow:
    case ProbeKind::Region: {
      const bool isFlow = p.kind == ProbeKind::Flow;
      v({"point", "A point of the plane", isFlow, "m"}, p.point);
      v({"normal", "Normal of the plane, of any length: downstream of a flow, away from what counts of a region",
         isFlow, "any unit"},
        p.normal);
      v({"box", "Only what lies in this box counts"}, p.box);
      v({"material", "Only fluid of this material counts"}, p.material);
      break;
    }
    case ProbeKind::Load:
      v({"body", "Name of the wall or rigid body whose load is measured", required}, p.body);
      break;
    case ProbeKind::WallPressure:
      v({"body", "Name of the wall or rigid body, with which the patch moves", required}, p.body);
      v({"corner",
         "A corner of the patch, on the surface of the wall; with a rigid body as the way from its centre of mass",
         required, "m"},
        p.corner);
      v({"along", "One edge of the patch, from the corner", required, "m"}, p.along);
      v({"up", "In three dimensions the other edge, at a right angle to the first", c.dimensions == 3, "m"}, p.up);
      break;
  }
}

}  // namespace treacle::keys
