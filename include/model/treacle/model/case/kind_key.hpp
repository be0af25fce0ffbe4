#pragma once

#include "treacle/model/case/case.hpp"

#include <string_view>
#include <type_traits>
#include <utility>

namespace treacle {

/// The key of a table whose word decides on the other keys of the table, and the member that has its value. Tables
/// without one have none.
template <class Table, class Kind>
struct KindKey {
  std::string_view name;
  Kind Table::*member;
};
constexpr KindKey<ElasticMode, ElasticModel> kindKey(const ElasticMode*) { return {"model", &ElasticMode::model}; }
constexpr KindKey<MaterialState, StateLaw> kindKey(const MaterialState*) { return {"law", &MaterialState::law}; }
constexpr KindKey<Rheology, RheologyModel> kindKey(const Rheology*) { return {"model", &Rheology::model}; }
constexpr KindKey<ViscosityShift, ShiftModel> kindKey(const ViscosityShift*) {
  return {"model", &ViscosityShift::model};
}
constexpr KindKey<Nozzle, NozzleKind> kindKey(const Nozzle*) { return {"shape", &Nozzle::kind}; }
constexpr KindKey<Outflow, OutflowKind> kindKey(const Outflow*) { return {"shape", &Outflow::kind}; }
constexpr KindKey<Probe, ProbeKind> kindKey(const Probe*) { return {"type", &Probe::kind}; }

template <class Table>
concept HasKind = requires(const Table* table) {
  kindKey(table);
};

/// The type of that member.
template <HasKind Table>
using KindOf = std::remove_reference_t<decltype(std::declval<Table&>().*
                                                (kindKey(static_cast<const Table*>(nullptr)).member))>;

}  // namespace treacle
