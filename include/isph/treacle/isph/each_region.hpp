#pragma once

#include "treacle/core/atomic.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/core/processes.hpp"
#include "treacle/isph/closed_regions.hpp"

#include <algorithm>
#include <utility>

namespace treacle {

// closed_regions.hpp for the sources of both backends, which instantiate it. Each has, beside forEach, sumEach and
// listWhere,
//
//   leastWhere(context, x, label, of): the least x whose label is `of`, of own particles; infinity where none is
//
// A label is 1 + the index of one of the region's particles, or 0 for regions with a free surface. Where regions
// turn out to be one, the lesser label wins.

/// Replaces each label by that of the particle it names until nothing changes.
template <class Backend>
void followParents(Context<Backend>& context, ClosedRegions<Backend>& regions) {
  const std::size_t n = regions.parent.size();
  double changed = 1;
  while (changed > 0) {
    const std::span<const std::uint32_t> parent = regions.parent.span();
    const std::span<std::uint32_t> next = regions.next.span();
    changed = sumEach<1>(context, n, [=] TREACLE_HD(std::size_t i, double* sum) {
      const std::uint32_t of = parent[i];
      next[i] = of == 0 ? 0 : parent[of - 1];
      if (next[i] != of) *sum += 1;
    })[0];
    std::swap(regions.parent, regions.next);
  }
}

/// Each particle below the surface names one above it, or itself where none is: a top. Returns the tops of all
/// processes. A particle whose higher neighbours are other processes' is no top, and names itself.
template <int D, class Backend>
double nameParents(Context<Backend>& context, const IsphPairs<D>& pairs, std::span<const std::uint8_t> surface,
                   std::span<std::uint32_t> parent) {
  Vec<D> up = -1.0 * pairs.frame.gravity;
  if (norm2(up) == 0) up[D - 1] = 1;
  const NeighbourRowsView rows = pairs.fluidOfFluid;
  const std::span<const Vec<D>> position = pairs.position;
  return sumEach<1>(context, parent.size(), [=] TREACLE_HD(std::size_t k, double* tops) {
    const auto i = static_cast<std::uint32_t>(k);
    parent[i] = surface[i] ? 0 : i + 1;
    if (surface[i]) return;
    const double height = dot(position[i], up);  // not the difference: ways must end in periodic domains
    for (const std::uint64_t section : {std::uint64_t{i}, std::uint64_t{rows.count} + i})
      for (std::uint64_t entry = rows.start[section]; entry < rows.start[section + 1]; ++entry) {
        const std::uint32_t j = rows.column[entry];
        if (!(dot(position[j], up) > height)) continue;
        if (j < rows.count) parent[i] = j + 1;
        return;
      }
    *tops += 1;
  })[0];
}

/// Joins the regions of a process that touch.
template <class Backend>
void joinRegions(Context<Backend>& context, const NeighbourRowsView& rows, ClosedRegions<Backend>& regions) {
  double changed = 1;
  while (changed > 0) {
    followParents(context, regions);
    copyValues(context, std::span<const std::uint32_t>(regions.parent), regions.next.data());
    const std::span<const std::uint32_t> parent = regions.parent.span();
    const std::span<std::uint32_t> next = regions.next.span();
    changed = sumEach<1>(context, parent.size(), [=] TREACLE_HD(std::size_t i, double* sum) {
      const std::uint32_t own = parent[i];
      std::uint32_t least = own;
      if (own == 0) return;
      rows.forEachPlace(static_cast<std::uint32_t>(i), [&](std::uint64_t k) {
        const std::uint32_t j = rows.column[k];
        if (j < rows.count && parent[j] < least) least = parent[j];
      });
      if (least == own) return;
      lowerAtomically(next[own - 1], least);
      *sum += 1;
    })[0];
    std::swap(regions.parent, regions.next);
  }
}

/// Joins those of several processes: labels count over all of them now. `first`: the index of the first own
/// particle among all.
template <class Backend>
void joinOverProcesses(Context<Backend>& context, const NeighbourRowsView& rows, std::uint32_t first,
                       ClosedRegions<Backend>& regions) {
  const std::span<const std::uint32_t> parent = regions.parent.span();
  const std::span<std::uint32_t> next = regions.next.span();  // per region, at the particle that its label names
  const std::span<std::uint32_t> label = regions.label.span();
  forEach(context, next.size(),
          [=] TREACLE_HD(std::size_t i) { next[i] = first + static_cast<std::uint32_t>(i) + 1; });
  double changed = 1;
  while (changed > 0) {
    forEach(context, parent.size(),
            [=] TREACLE_HD(std::size_t i) { label[i] = parent[i] == 0 ? 0 : next[parent[i] - 1]; });
    fillGhosts(context, Held::Fluid, label.data());
    changed = sumEach<1>(context, parent.size(), [=] TREACLE_HD(std::size_t i, double* sum) {
      std::uint32_t least = label[i];
      if (least == 0) return;
      rows.forEachPlace(static_cast<std::uint32_t>(i), [&](std::uint64_t k) {
        const std::uint32_t j = rows.column[k];
        if (j >= rows.count && label[j] < least) least = label[j];
      });
      if (least == label[i]) return;
      lowerAtomically(next[parent[i] - 1], least);
      *sum += 1;
    })[0];
  }
}

template <int D, class Backend>
void findClosedRegions(Context<Backend>& context, const IsphPairs<D>& pairs, std::span<const std::uint8_t> surface,
                       ClosedRegions<Backend>& regions) {
  const std::uint32_t n = pairs.ownFluid();
  regions.labels.clear();
  regions.parent.resize(context, n);
  if (nameParents(context, pairs, surface, regions.parent.span()) == 0) return;
  regions.next.resize(context, n);
  regions.label.resize(context, pairs.fluidCount);
  joinRegions(context, pairs.fluidOfFluid, regions);
  const std::uint32_t first = context.halo ? static_cast<std::uint32_t>(context.halo->fluidBefore) : 0;
  if (context.halo)
    joinOverProcesses(context, pairs.fluidOfFluid, first, regions);
  else
    copyValues(context, std::span<const std::uint32_t>(regions.parent), regions.label.data());
  const std::span<const std::uint32_t> label = regions.label.span();
  const std::uint32_t count = listWhere(
      context, 0, n, [=] TREACLE_HD(std::uint32_t i) { return label[i] == first + i + 1; }, regions.next.data());
  std::vector<std::uint32_t> labels(count);
  copyToHost(context, std::span<const std::uint32_t>(regions.next).first(count), labels.data());
  for (std::uint32_t& i : labels) i += first + 1;
  regions.labels = joinedLists(context, std::move(labels));
}

template <class Backend>
void takeLevels(Context<Backend>& context, const ClosedRegions<Backend>& regions, Level level,
                std::span<double> x) {
  const std::span<const std::uint32_t> label = regions.label.span().first(regions.some() ? x.size() : 0);
  for (const std::uint32_t of : regions.labels) {
    double zero = 0;
    if (level == Level::Mean) {
      const auto sums = sumEach<2>(context, label.size(), [=] TREACLE_HD(std::size_t i, double* sum) {
        if (label[i] == of) sum[0] += x[i], sum[1] += 1;
      });
      zero = sums[0] / sums[1];
    } else {
      zero = joinedOverProcesses(context, leastWhere(context, x, label, of),
                                 [](double a, double b) { return std::min(a, b); });
    }
    forEach(context, label.size(), [=] TREACLE_HD(std::size_t i) {
      if (label[i] == of) x[i] -= zero;
    });
  }
}

template <class Backend>
void fillRegions(Context<Backend>& context, const ClosedRegions<Backend>& regions, std::span<float> missing) {
  const std::span<const std::uint32_t> label = regions.label.span();
  if (regions.some())
    forEach(context, missing.size(), [=] TREACLE_HD(std::size_t i) {
      if (label[i] != 0) missing[i] = 0;
    });
}

#define TREACLE_EACH_REGION(Backend)                                                                     \
  template void findClosedRegions(Context<Backend>&, const IsphPairs<2>&, std::span<const std::uint8_t>, \
                                  ClosedRegions<Backend>&);                                              \
  template void findClosedRegions(Context<Backend>&, const IsphPairs<3>&, std::span<const std::uint8_t>, \
                                  ClosedRegions<Backend>&);                                              \
  template void takeLevels(Context<Backend>&, const ClosedRegions<Backend>&, Level, std::span<double>);  \
  template void fillRegions(Context<Backend>&, const ClosedRegions<Backend>&, std::span<float>);

}  // namespace treacle
