#include "changed_bodies.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/geometry/point_grid.hpp"
#include "treacle/model/motion/carried_probe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>

namespace treacle {
namespace {

/// The bodies of a case among those of a state, by their names, and the other way round.
struct BodyMap {
  std::vector<std::optional<std::size_t>> inCase, inState;

  BodyMap(const std::vector<std::string>& ofState, const std::vector<std::string>& ofCase)
      : inCase(places(ofState, ofCase)), inState(places(ofCase, ofState)) {}

  static std::vector<std::optional<std::size_t>> places(const std::vector<std::string>& names,
                                                        const std::vector<std::string>& among) {
    std::vector<std::optional<std::size_t>> result;
    for (const std::string& name : names) {
      const auto found = std::ranges::find(among, name);
      result.push_back(found == among.end() ? std::nullopt : std::optional<std::size_t>(found - among.begin()));
    }
    return result;
  }
};

/// Particles of a state and of what the case makes, in the order that they shall have.
struct Chosen {
  std::vector<std::uint32_t> kept, added;

  std::uint32_t count() const { return static_cast<std::uint32_t>(kept.size() + added.size()); }
};

/// Copies the chosen ones of two fields, one behind the other, to a place in a third.
template <class T>
void copyChosen(const Chosen& chosen, std::span<const T> kept, std::span<const T> added, T* to) {
  for (const std::uint32_t i : chosen.kept) *to++ = kept[i];
  for (const std::uint32_t i : chosen.added) *to++ = added.empty() ? T{} : added[i];
}

/// Ids from `first` on, in the order of those that they had.
template <int D>
void numberByIds(const Particles<D>& from, std::span<const std::uint32_t> chosen, std::uint32_t first,
                 std::uint32_t* id) {
  std::vector<std::uint32_t> order(chosen.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::sort(order, {}, [&](std::uint32_t k) { return from.id[chosen[k]]; });
  for (const std::uint32_t k : order) id[k] = first++;
}

template <int D>
class BodyChange {
 public:
  BodyChange(const Case& c, const std::filesystem::path& file, const MadeParticles& made,
             const Particles<D>& created, Checkpoint<D>& state)
      : case_(c),
        file_(file),
        made_(made),
        created_(created),
        state_(state),
        map_(state.names.bodies, StateNames::of(c).bodies) {}

  void make(std::vector<std::string>& notes) {
    if (case_.isOpen() || state_.particles.flow.nextId > 0)
      refuse("with inflows, outflows or openings bodies must have the names and the order of the run");
    if (case_.hasThinSheets() || state_.particles.has.sides)
      refuse("with thin sheets bodies must have the names and the order of the run");
    if (!made_.part.isAll()) refuse("other bodies than those of the run; start once with one process");
    choose();
    requireSameWalls();
    requireRoom();
    note(notes);
    build();
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(fmt::format("--resume {}: {}", file_.string(), why));
  }

  void choose() {
    const Particles<D>& p = state_.particles;
    for (std::uint32_t i = 0; i < p.count; ++i)
      if (p.body[i] < map_.inCase.size() && map_.inCase[p.body[i]])
        (i < p.fluidCount ? fluid_ : walls_).kept.push_back(i);
    for (std::uint32_t i = 0; i < created_.count; ++i)
      if (!map_.inState[created_.body[i]]) (i < created_.fluidCount ? fluid_ : walls_).added.push_back(i);
    if (fluid_.kept.empty())
      refuse(fmt::format("its bodies are '{}', but the case has '{}': none of its fluid would be left",
                         fmt::join(state_.names.bodies, "', '"), fmt::join(StateNames::of(case_).bodies, "', '")));
  }

  void requireSameWalls() const {
    std::vector<std::uint32_t> before(case_.bodies.size());
    for (const std::uint32_t i : walls_.kept) ++before[*map_.inCase[state_.particles.body[i]]];
    for (std::size_t b = 0; b < before.size(); ++b)
      if (const std::uint32_t now = made_.ofBodies[b].wall; map_.inState[b] && now != before[b])
        refuse(fmt::format(
            "body '{}' has {} wall particles in the run and {} in the case; expected the same shape, or "
            "another name for another body",
            case_.bodies[b].name, before[b], now));
  }

  /// Nothing is added where fluid is, and no fluid where anything is.
  void requireRoom() const {
    const Particles<D>& p = state_.particles;
    PlacesOf fluid(case_, fluid_.kept.size()), walls(case_, walls_.kept.size());
    for (const std::uint32_t i : fluid_.kept) fluid.add(p.position[i]);
    for (const std::uint32_t i : walls_.kept) walls.add(p.position[i]);
    const auto require = [&](std::uint32_t j, const PlacesOf& others, const char* what) {
      const Vec<D> x = placeNow(j);
      if (others.has(x))
        refuse(fmt::format("body '{}' is added where {} of the run is, at ({:g}, {:g}{})",
                           case_.bodies[created_.body[j]].name, what, x[0], x[1],
                           D == 3 ? fmt::format(", {:g}", x[D - 1]) : ""));
    };
    for (const std::uint32_t j : walls_.added) require(j, fluid, "fluid");
    for (const std::uint32_t j : fluid_.added) require(j, fluid, "fluid"), require(j, walls, "a wall");
  }

  /// Of a particle that is added: walls are where their motion has put them.
  Vec<D> placeNow(std::uint32_t j) const {
    const Body& body = case_.bodies[created_.body[j]];
    if (body.kind != BodyKind::Wall) return created_.position[j];
    const Probe there{.point = resized<3>(created_.position[j]), .movesWith = body.name};
    return resized<D>(carriedProbe(there, case_, {}, state_.time).point);
  }

  void note(std::vector<std::string>& notes) const {
    for (std::size_t b = 0; b < map_.inCase.size(); ++b)
      if (!map_.inCase[b])
        notes.push_back(fmt::format("--resume: body '{}' of the run is left out", state_.names.bodies[b]));
    for (std::size_t b = 0; b < map_.inState.size(); ++b)
      if (!map_.inState[b]) notes.push_back(fmt::format("--resume: body '{}' is added", case_.bodies[b].name));
  }

  void build() {
    const Particles<D>& from = state_.particles;
    Particles<D> to;
    ParticleNumbers numbers{fluid_.count(), walls_.count()};
    numbers.has = from.has;
    to.resize(numbers);
    const std::uint32_t n = to.fluidCount;
    forEachSharedFieldOf(
        [&]<class T>(const Buffer<T>& kept, const Buffer<T>& added, Buffer<T>& field) {
          copyChosen<T>(fluid_, kept.span(), added.span(), field.data());
          copyChosen<T>(walls_, kept.span(), added.span(), field.data() + n);
        },
        from, created_, to);
    // Fluid that is added remembers nothing.
    forEachFlowMemoryOf([&]<class T>(const Buffer<T>& kept,
                                     Buffer<T>& field) { copyChosen<T>(fluid_, kept.span(), {}, field.data()); },
                        from, to);
    if (to.has.temperatures)
      copyChosen<double>(fluid_, from.temperature.span(), created_.temperature.span(), to.temperature.data());
    if (to.has.viscosityFactors)
      copyChosen<double>(fluid_, from.viscosityFactor.span(), created_.viscosityFactor.span(),
                         to.viscosityFactor.data());
    for (std::size_t k = 0; k < to.has.elasticModes; ++k)
      copyChosen<SymmetricBlock<D>>(fluid_, from.conformation[k].span(), created_.conformation[k].span(),
                                    to.conformation[k].data());
    for (std::size_t k = 0; k < to.has.states; ++k)
      copyChosen<double>(fluid_, from.states[k].span(), created_.states[k].span(), to.states[k].data());
    for (std::uint32_t k = 0; k < fluid_.kept.size(); ++k) toCase(to.body[k]);
    for (std::uint32_t k = 0; k < walls_.kept.size(); ++k) toCase(to.body[n + k]);
    const auto firstAdded = static_cast<std::uint32_t>(fluid_.kept.size());
    numberByIds<D>(from, fluid_.kept, 0, to.id.data());
    numberByIds<D>(created_, fluid_.added, firstAdded, to.id.data() + firstAdded);
    numberWalls(to);
    for (std::uint32_t k = 0; k < walls_.added.size(); ++k)
      to.position[n + walls_.kept.size() + k] = placeNow(walls_.added[k]);
    to.steps = from.steps;
    to.bulk = from.bulk;
    to.rigid = rigidBodies();
    to.gas = from.gas;
    state_.particles = std::move(to);
    state_.names.bodies = StateNames::of(case_).bodies;
    state_.fluidOfAll = n, state_.wallsOfAll = state_.particles.wallCount(), state_.firstWall = n;
  }

  void toCase(std::uint8_t& body) const { body = static_cast<std::uint8_t>(*map_.inCase[body]); }

  /// As the case makes them, body by body.
  void numberWalls(Particles<D>& to) const {
    const std::uint32_t n = to.fluidCount;
    std::uint32_t first = n;
    for (std::size_t b = 0; b < case_.bodies.size(); ++b) {
      // The ids are still those of the state or of what the case makes, never of both in one body.
      std::vector<std::uint32_t> ofBody;
      for (std::uint32_t i = n; i < to.count; ++i)
        if (to.body[i] == b) ofBody.push_back(i);
      std::ranges::sort(ofBody, {}, [&](std::uint32_t i) { return to.id[i]; });
      for (const std::uint32_t i : ofBody) to.id[i] = first++;
    }
  }

  /// The state of each rigid body. MovingBodies fills in the bodies that are added, which have no mass here.
  RigidMotion rigidBodies() const {
    RigidMotion rigid;
    if (!case_.hasRigid()) return rigid;
    for (const auto& b : map_.inState)
      rigid.bodies.push_back(b && *b < state_.particles.rigid.bodies.size() ? state_.particles.rigid.bodies[*b]
                                                                            : RigidBody{});
    return rigid;
  }

  /// Places of particles, to ask whether one is within half a spacing.
  class PlacesOf {
   public:
    PlacesOf(const Case& c, std::size_t capacity) : grid_(c.domain, 0.5 * c.spacing, capacity) {}
    void add(const Vec<D>& x) { grid_.add(x, 0); }
    bool has(const Vec<D>& x) const { return grid_.find(x) != PointGrid<D>::none; }

   private:
    PointGrid<D> grid_;
  };

  const Case& case_;
  const std::filesystem::path& file_;
  const MadeParticles& made_;
  const Particles<D>& created_;
  Checkpoint<D>& state_;
  BodyMap map_;
  Chosen fluid_, walls_;
};

}  // namespace

template <int D>
void changeBodies(const Case& c, const std::filesystem::path& file, const MadeParticles& made,
                  const Particles<D>& created, Checkpoint<D>& state, std::vector<std::string>& notes) {
  BodyChange<D>(c, file, made, created, state).make(notes);
}

template void changeBodies<2>(const Case&, const std::filesystem::path&, const MadeParticles&, const Particles<2>&,
                              Checkpoint<2>&, std::vector<std::string>&);
template void changeBodies<3>(const Case&, const std::filesystem::path&, const MadeParticles&, const Particles<3>&,
                              Checkpoint<3>&, std::vector<std::string>&);

}  // namespace treacle
