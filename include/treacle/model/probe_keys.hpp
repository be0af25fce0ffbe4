#pragma once

#include "treacle/model/case.hpp"
#include "treacle/model/key.hpp"

namespace treacle::keys {

inline constexpr Bound places{0, 1e6};

void visit(auto& v, Like<ProbeBox> auto& b, const Case&) {
  v({"min", required, "m"}, b.min);
  v({"max", required, "m"}, b.max);
}

void visit(auto& v, Like<Probe> auto& p, const Case&) {
  v({"name", required}, p.name);
  v({"type", required}, p.kind);
  v({"interval", optional, "s", notNegative}, p.interval);
  switch (p.kind) {
    case ProbeKind::Point:
      v({"point", required, "m"}, p.point);
      break;
    case ProbeKind::Line:
    case ProbeKind::Height:
      v({"from", required, "m"}, p.from);
      v({"to", required, "m"}, p.to);
      if (p.kind == ProbeKind::Line) v({"count", optional, "", places}, p.count);
      break;
    case ProbeKind::Plane:
      v({"corner", required, "m"}, p.corner);
      v({"along", required, "m"}, p.along);
      v({"up", required, "m"}, p.up);
      v({"columns", optional, "", places}, p.columns);
      v({"rows", optional, "", places}, p.rows);
      break;
    case ProbeKind::Flow:
    case ProbeKind::Region: {
      const bool isFlow = p.kind == ProbeKind::Flow;
      v({"point", isFlow, "m"}, p.point);
      v({"normal", isFlow, "any unit"}, p.normal);
      v({"box"}, p.box);
      v({"material"}, p.material);
      break;
    }
    case ProbeKind::Load:
      v({"body", required}, p.body);
      break;
  }
}

}  // namespace treacle::keys
