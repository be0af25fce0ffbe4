#include "gas_pockets.hpp"

#include "treacle/model/case/flow_scales.hpp"
#include "treacle/step/flow/gas_cells.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

namespace treacle {
namespace {

constexpr double correction = 0.05;   // by how much of its error a volume is corrected in a step
constexpr double leastVolume = 0.05;  // of the volume that a pocket has at the pressure of the air

/// The rows next to a pocket lack neighbours. In MPH-I their densities are too low for them to have a pressure,
/// and a high pressure moves them together. But layers that the force does not act on fall around a bubble as a
/// film would, so there are none where the pressure is low. Surface tension acts on the same rows and is balanced
/// there.
constexpr double lowPressure = 30, highPressure = 130;  // over the weight of a row

/// The weight of a row of the heaviest fluid over its area, or nothing where no layers are wanted [Pa].
std::optional<double> rowWeight(const Case& c) {
  if (c.method.kind != MethodKind::MphI || c.hasSurfaceTension()) return std::nullopt;
  double density = 0;
  for (const Body& body : c.bodies)
    if (body.holdsFluid())
      density = std::max(density, c.materials[static_cast<std::size_t>(body.material)].density);
  return density * flowScales(c).acceleration * c.spacing;
}

}  // namespace

template <int D>
GasPockets<D>::GasPockets(const Case& c)
    : gas_(*c.gas),
      spacing_(c.spacing),
      particle_(std::pow(c.spacing, D)),
      cell_(1),
      rowWeight_(rowWeight(c)),
      grid_(c) {
  for (int k = 0; k < D; ++k) cell_ *= grid_.edge[k];
}

template <int D>
bool GasPockets<D>::find(const Processes& processes, std::span<const Vec<D>> position, std::uint32_t fluid,
                         GasState& state) {
  sort(position);
  findEmpty(processes, position);
  const auto found = components();
  const bool isNew = inherit(found, state);
  setDepths(state);
  widen(found);
  measure(processes, position, fluid);
  setVolumes(state);
  share();
  meet(position, fluid);
  return isNew;
}

/// Particles by cells.
template <int D>
void GasPockets<D>::sort(std::span<const Vec<D>> position) {
  std::vector<std::uint32_t> cell(position.size());
  start_.assign(grid_.cellCount() + 1, 0);
  for (std::size_t i = 0; i < position.size(); ++i) {
    cell[i] = static_cast<std::uint32_t>(grid_.linear(grid_.cellOf(position[i])));
    ++start_[cell[i] + 1];
  }
  for (std::size_t c = 0; c + 1 < start_.size(); ++c) start_[c + 1] += start_[c];
  items_.resize(position.size());
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < position.size(); ++i) items_[next[cell[i]]++] = static_cast<std::uint32_t>(i);
}

template <int D>
void GasPockets<D>::findEmpty(const Processes& processes, std::span<const Vec<D>> position) {
  empty_.assign(grid_.cellCount(), 1);
  const double least2 = spacing_ * spacing_;
  for (std::size_t cell = 0; cell < empty_.size(); ++cell) {
    if (start_[cell + 1] > start_[cell]) {
      empty_[cell] = 0;
      continue;
    }
    const Vec<D> x = grid_.centerOf(cell);
    grid_.forEachAround(cell, [&](std::size_t other) {
      for (std::uint32_t k = start_[other]; k < start_[other + 1] && empty_[cell]; ++k) {
        if (norm2(grid_.difference(x, position[items_[k]])) < least2) empty_[cell] = 0;
      }
    });
  }
  if (!processes.communicator) return;
  for (std::uint8_t& cell : empty_) cell = 1 - cell;
  processes.communicator->anyOf(empty_);
  for (std::uint8_t& cell : empty_) cell = 1 - cell;
}

/// Gives a label to all empty cells without one that hang together with these.
template <int D>
void GasPockets<D>::spread(std::vector<std::size_t> from, std::uint32_t label) {
  while (!from.empty()) {
    const std::size_t cell = from.back();
    from.pop_back();
    grid_.forEachNext(cell, [&](std::size_t next) {
      if (!empty_[next] || label_[next] != nobody) return;
      label_[next] = label;
      from.push_back(next);
    });
  }
}

/// The cells of each pocket, ascending. All other empty cells are air.
template <int D>
std::vector<std::vector<std::size_t>> GasPockets<D>::components() {
  label_.assign(empty_.size(), nobody);
  std::vector<std::size_t> open;
  const auto add = [&](std::size_t cell) {
    if (!empty_[cell] || label_[cell] != nobody) return;
    label_[cell] = air;
    open.push_back(cell);
  };
  for (std::size_t cell = 0; cell < empty_.size(); ++cell) {
    const Vec<D, int> i = grid_.cellAt(cell);
    for (int k = 0; k < D; ++k)
      if (!grid_.periodic[k] && (i[k] == 0 || i[k] + 1 == grid_.count[k])) add(cell);
    if (gas_.vents.empty() || !empty_[cell]) continue;
    const Vec<D> x = grid_.centerOf(cell);
    for (const Vent& vent : gas_.vents) {
      bool inside = true;
      for (int k = 0; k < D; ++k) inside = inside && x[k] >= vent.min[k] && x[k] <= vent.max[k];
      if (inside) add(cell);
    }
  }
  spread(std::move(open), air);
  std::vector<std::vector<std::size_t>> found;
  for (std::size_t cell = 0; cell < empty_.size(); ++cell) {
    if (!empty_[cell]) continue;
    if (label_[cell] == nobody) {
      label_[cell] = static_cast<std::uint32_t>(found.size());
      spread({cell}, label_[cell]);
      found.emplace_back();
    }
    if (label_[cell] != air) found[label_[cell]].push_back(cell);
  }
  return found;
}

/// The content of a pocket goes to those that have its cells, in proportion; with cells that are air now, it is
/// gone. Pockets that are new and small are none. Returns whether the pockets are other ones than before.
template <int D>
bool GasPockets<D>::inherit(const std::vector<std::vector<std::size_t>>& found, GasState& state) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> shared;  // of pockets before and now: cells
  std::vector<double> kept(state.pockets.size());
  for (std::size_t k = 0; k < state.cells.size(); ++k) {
    const std::uint32_t now = label_[static_cast<std::size_t>(state.cells[k])];
    if (now == nobody) continue;
    const auto before = static_cast<std::uint32_t>(state.labels[k]);
    ++kept[before];
    if (now != air) ++shared[{before, now}];
  }
  std::vector<GasState::Pocket> pockets(found.size());
  std::vector<int> parents(found.size());
  for (const auto& [which, cells] : shared) {
    const double part = cells / kept[which.first];
    const GasState::Pocket& before = state.pockets[which.first];
    pockets[which.second].content += part * before.content;
    pockets[which.second].volume += part * before.volume;
    pockets[which.second].pressure = before.pressure;
    ++parents[which.second];
  }
  std::size_t least = static_cast<std::size_t>(std::pow(3.0, D));
  if (found.size() > mostGasPockets) {
    std::vector<std::size_t> sizes;
    for (const auto& cells : found) sizes.push_back(cells.size());
    std::ranges::nth_element(sizes, sizes.begin() + mostGasPockets, std::greater<>());
    least = std::max(least, sizes[mostGasPockets] + 1);
  }
  std::vector<std::uint32_t> number(found.size(), nobody);
  GasState next;
  bool same = found.size() == state.pockets.size();
  for (std::uint32_t k = 0; k < found.size(); ++k) {
    if (found[k].size() < (parents[k] > 0 && found.size() <= mostGasPockets ? 1 : least)) continue;
    number[k] = static_cast<std::uint32_t>(next.pockets.size());
    if (parents[k] == 0) pockets[k] = {};
    same = same && parents[k] == 1 && shared.contains({number[k], k});
    next.pockets.push_back(pockets[k]);
    for (const std::size_t cell : found[k]) {
      next.cells.push_back(static_cast<double>(cell));
      next.labels.push_back(number[k]);
    }
  }
  same = same && next.pockets.size() == state.pockets.size();
  for (std::size_t cell = 0; cell < empty_.size(); ++cell)
    if (label_[cell] < nobody) label_[cell] = number[label_[cell]];
  state = std::move(next);
  return !same;
}

/// By how much the force of each pocket acts behind the layers.
template <int D>
void GasPockets<D>::setDepths(const GasState& state) {
  depth_.assign(state.pockets.size(), 0);
  if (rowWeight_)
    for (std::size_t k = 0; k < depth_.size(); ++k) {
      const double pressure = std::abs(state.pockets[k].pressure);  // without weight any one is high
      const double low = lowPressure * *rowWeight_, high = highPressure * *rowWeight_;
      if (pressure > low) depth_[k] = pressure < high ? (pressure - low) / (high - low) : 1;
    }
  deepest_ = depth_.empty() ? 0 : std::ranges::max(depth_);
}

/// Rings of cells around the pockets that are not empty get the label of the pocket that is nearest.
template <int D>
void GasPockets<D>::widen(const std::vector<std::vector<std::size_t>>& found) {
  near_.clear(), rings_.assign(1, 0);
  for (const auto& cells : found)
    for (const std::size_t cell : cells)
      if (label_[cell] != nobody) near_.push_back(static_cast<std::uint32_t>(cell));
  for (int ring = 0; ring < reach + (deepest_ > 0 ? layers : 0); ++ring) {
    const std::size_t first = rings_.back(), last = near_.size();
    rings_.push_back(static_cast<std::uint32_t>(last));
    for (std::size_t k = first; k < last; ++k)
      grid_.forEachNext(near_[k], [&](std::size_t next) {
        if (empty_[next] || label_[next] != nobody) return;
        label_[next] = label_[near_[k]];
        near_.push_back(static_cast<std::uint32_t>(next));
      });
  }
  rings_.push_back(static_cast<std::uint32_t>(near_.size()));
}

/// What particles fill of the cells of pockets and around them.
template <int D>
void GasPockets<D>::measure(const Processes& processes, std::span<const Vec<D>> position, std::uint32_t fluid) {
  filled_.assign(empty_.size(), 0), walls_.assign(empty_.size(), 0);
  for (const std::uint32_t cell : near_)
    for (std::uint32_t k = start_[cell]; k < start_[cell + 1]; ++k)
      grid_.forEachWeight(position[items_[k]], [&](std::size_t to, double weight, const Vec<D>&) {
        filled_[to] += weight * particle_ / cell_;
        if (items_[k] >= fluid) walls_[to] += weight * particle_ / cell_;
      });
  if (!processes.communicator) return;
  std::vector<double> sums;
  for (const std::uint32_t cell : near_) sums.push_back(filled_[cell]), sums.push_back(walls_[cell]);
  sumOverProcesses(processes, std::span(sums));
  filled_.assign(empty_.size(), 0), walls_.assign(empty_.size(), 0);
  for (std::size_t k = 0; k < near_.size(); ++k)
    filled_[near_[k]] = sums[2 * k], walls_[near_[k]] = sums[2 * k + 1];
}

/// What is empty of the cells of a pocket and next to it. A volume that is known from the step before is drawn
/// towards it.
template <int D>
void GasPockets<D>::setVolumes(GasState& state) const {
  std::vector<double> volume(state.pockets.size());
  for (std::size_t k = 0; k < rings_[rim + 1]; ++k) volume[label_[near_[k]]] += (1 - filled_[near_[k]]) * cell_;
  const double k = gas_.exponent;
  for (std::size_t p = 0; p < volume.size(); ++p) {
    GasState::Pocket& pocket = state.pockets[p];
    if (pocket.content == 0)
      pocket = {std::pow(gas_.pressure, 1 / k) * volume[p], volume[p], 0};
    else
      pocket.volume += correction * (volume[p] - pocket.volume);
  }
}

/// The mean of a field over neighbours, in the cells of pockets and around them; value(cell, of): the field in a
/// cell, asked for one of these.
template <int D>
template <class F>
std::vector<double> GasPockets<D>::mean(F&& value) const {
  std::vector<double> result(near_.size());
  for (std::size_t k = 0; k < near_.size(); ++k) {
    const Vec<D, int> middle = grid_.cellAt(near_[k]);
    grid_.forEachAround(near_[k], [&](std::size_t other) {
      const Vec<D, int> i = grid_.cellAt(other);
      double weight = 1;
      for (int a = 0; a < D; ++a) weight *= i[a] == middle[a] ? 0.5 : 0.25;
      result[k] += weight * value(other, near_[k]);
    });
  }
  return result;
}

/// Takes the mean twice.
template <int D>
void GasPockets<D>::smooth(std::vector<double>& field) const {
  for (int pass = 0; pass < 2; ++pass) {
    const std::vector<double> next = mean([&](std::size_t cell, std::size_t) { return field[cell]; });
    for (std::size_t k = 0; k < near_.size(); ++k) field[near_[k]] = next[k];
  }
}

/// I of the fluid: `factor` times the part of the space between walls that is empty, so that walls beside a
/// surface do not change it.
template <int D>
void GasPockets<D>::shareFluid(double factor) {
  for (const std::uint32_t cell : near_)
    ofFluid_[cell] = open_[cell] > 0.05 ? factor * ofWalls_[cell] / open_[cell] : 0;
}

/// I: at the surface of a pocket 1, and behind it 0. It falls to 0 within some three spacings of the surface or,
/// where its pressure is high, within six spacings behind the layers.
template <int D>
void GasPockets<D>::share() {
  open_.assign(empty_.size(), 1);
  ofFluid_.assign(empty_.size(), 0), ofWalls_.assign(empty_.size(), 0);
  for (const std::uint32_t cell : near_) open_[cell] = std::max(0.0, 1 - walls_[cell]);
  for (std::size_t k = 0; k < rings_[rim + 1]; ++k)
    ofWalls_[near_[k]] = std::clamp(1 - filled_[near_[k]], 0.0, 1.0);
  smooth(ofWalls_);
  smooth(open_);
  shareFluid(2);
  if (deepest_ > 0) deepen();
  for (const std::uint32_t cell : near_) ofWalls_[cell] *= 2;
}

/// Counts layers of fluid next to a pocket as empty, one after the other, but not those near the air and other
/// pockets: a thin film between them has no other rows that could bear the pressure.
template <int D>
void GasPockets<D>::deepen() {
  std::vector<double> fluid = ofFluid_, walls = ofWalls_, others(empty_.size());
  const std::vector<double> next = mean(
      [&](std::size_t cell, std::size_t of) { return empty_[cell] && label_[cell] != label_[of] ? 2.0 : 0.0; });
  for (std::size_t k = 0; k < near_.size(); ++k) others[near_[k]] = next[k];
  smooth(others);
  for (int layer = 1; layer <= layers; ++layer) {
    for (const std::uint32_t cell : near_)
      ofWalls_[cell] =
          std::max(0.0, std::min(1.0, ofFluid_[cell]) - others[cell]) * std::max(0.0, 1 - walls_[cell]);
    smooth(ofWalls_);
    shareFluid(layer < layers ? 2 : 1);
  }
  for (const std::uint32_t cell : near_) {
    const double depth = depth_[label_[cell]];
    ofFluid_[cell] = std::lerp(fluid[cell], std::max(ofFluid_[cell], std::min(1.0, fluid[cell])), depth);
    ofWalls_[cell] = std::lerp(walls[cell], std::max(ofWalls_[cell], walls[cell]), depth);
  }
}

/// The areas -V grad I of particles. Gas presses on a wall along its normal alone: where fluid meets the wall, I
/// falls along it as well, by what is the fluid's.
template <int D>
void GasPockets<D>::meet(std::span<const Vec<D>> position, std::uint32_t fluid) {
  contacts_.clear();
  for (const std::uint32_t cell : near_)
    for (std::uint32_t k = start_[cell]; k < start_[cell + 1]; ++k) {
      const std::uint32_t i = items_[k];
      const std::vector<double>& share = i < fluid ? ofFluid_ : ofWalls_;
      Vec<D> area{}, normal{};
      double value = 0;
      grid_.forEachWeight(position[i], [&](std::size_t to, double weight, const Vec<D>& gradient) {
        value += weight * share[to];
        area = area - (particle_ * share[to]) * gradient;
        normal += open_[to] * gradient;
      });
      if (i >= fluid && norm2(normal) > 0) area = (dot(area, normal) / norm2(normal)) * normal;
      if (value > 0) contacts_.push_back({i, label_[cell], area, value});
    }
  std::ranges::sort(contacts_, {}, &GasContact<D>::particle);
}

template <int D>
double GasPockets<D>::pressure(const GasState::Pocket& pocket, double volume) const {
  const double k = gas_.exponent, atAir = pocket.content / std::pow(gas_.pressure, 1 / k);
  return gas_.pressure * (std::pow(atAir / std::max(volume, leastVolume * atAir), k) - 1);
}

template <int D>
std::size_t GasPockets<D>::bytes() const {
  return empty_.capacity() +
         sizeof(std::uint32_t) * (label_.capacity() + start_.capacity() + items_.capacity() + near_.capacity()) +
         sizeof(double) * (filled_.capacity() + walls_.capacity() + open_.capacity() + ofFluid_.capacity() +
                           ofWalls_.capacity()) +
         sizeof(GasContact<D>) * contacts_.capacity();
}

std::uint64_t gasCells(const Case& c) {
  return c.dimensions == 2 ? GasGrid<2>(c).cellCount() : GasGrid<3>(c).cellCount();
}

template class GasPockets<2>;
template class GasPockets<3>;

}  // namespace treacle
