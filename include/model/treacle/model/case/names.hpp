#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/case/width.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace treacle {

/// The word that stands for a value in case files, on the command line and in summaries.
template <class E>
struct Named {
  std::string_view name;
  E value;
};

/// All words of an enumeration, the default first.
template <class E>
inline constexpr std::span<const Named<E>> namesOf{};

namespace names {
inline constexpr Named<ShapeKind> shape[] = {
    {"box", ShapeKind::Box},           {"sphere", ShapeKind::Sphere}, {"cylinder", ShapeKind::Cylinder},
    {"cone", ShapeKind::Cone},         {"torus", ShapeKind::Torus},   {"polygon", ShapeKind::Polygon},
    {"polyline", ShapeKind::Polyline}, {"mesh", ShapeKind::Mesh},     {"particles", ShapeKind::Particles}};
inline constexpr Named<FillKind> fill[] = {{"inside", FillKind::Inside},
                                           {"shell", FillKind::Shell},
                                           {"outside", FillKind::Outside},
                                           {"sheet", FillKind::Sheet},
                                           {"thin-sheet", FillKind::ThinSheet}};
inline constexpr Named<BodyKind> body[] = {{"fluid", BodyKind::Fluid},
                                           {"wall", BodyKind::Wall},
                                           {"inflow", BodyKind::Inflow},
                                           {"rigid", BodyKind::Rigid}};
inline constexpr Named<NozzleKind> nozzle[] = {
    {"disc", NozzleKind::Disc}, {"rectangle", NozzleKind::Rectangle}, {"polygon", NozzleKind::Polygon}};
inline constexpr Named<OutflowKind> outflow[] = {{"box", OutflowKind::Box}, {"plane", OutflowKind::Plane}};
inline constexpr Named<ProbeKind> probe[] = {
    {"point", ProbeKind::Point}, {"line", ProbeKind::Line},
    {"plane", ProbeKind::Plane}, {"height", ProbeKind::Height},
    {"flow", ProbeKind::Flow},   {"region", ProbeKind::Region},
    {"load", ProbeKind::Load},   {"wall-pressure", ProbeKind::WallPressure}};
inline constexpr Named<MethodKind> method[] = {{"mph-i", MethodKind::MphI}, {"isph", MethodKind::Isph}};
inline constexpr Named<SchemeKind> scheme[] = {{"accurate", SchemeKind::Accurate},
                                               {"published", SchemeKind::Published}};
inline constexpr Named<KernelKind> kernel[] = {{"cubic-spline", KernelKind::CubicSpline},
                                               {"wendland-c2", KernelKind::WendlandC2}};
inline constexpr Named<WallSlip> slip[] = {{"no-slip", WallSlip::NoSlip}, {"free-slip", WallSlip::FreeSlip}};
inline constexpr Named<ViscousStep> viscous[] = {
    {"auto", ViscousStep::Auto}, {"explicit", ViscousStep::Explicit}, {"implicit", ViscousStep::Implicit}};
inline constexpr Named<RheologyModel> rheology[] = {{"power-law", RheologyModel::PowerLaw},
                                                    {"cross", RheologyModel::Cross},
                                                    {"carreau-yasuda", RheologyModel::CarreauYasuda},
                                                    {"bingham", RheologyModel::Bingham},
                                                    {"herschel-bulkley", RheologyModel::HerschelBulkley},
                                                    {"casson", RheologyModel::Casson}};
inline constexpr Named<ShiftModel> shift[] = {{"arrhenius", ShiftModel::Arrhenius},
                                              {"vft", ShiftModel::Vft},
                                              {"wlf", ShiftModel::Wlf},
                                              {"table", ShiftModel::Table}};
inline constexpr Named<StateLaw> stateLaw[] = {{"expression", StateLaw::Expression},
                                               {"kamal-sourour", StateLaw::KamalSourour},
                                               {"houska", StateLaw::Houska},
                                               {"roussel", StateLaw::Roussel}};
inline constexpr Named<ElasticModel> elastic[] = {{"oldroyd-b", ElasticModel::OldroydB},
                                                  {"giesekus", ElasticModel::Giesekus},
                                                  {"linear-ptt", ElasticModel::LinearPtt},
                                                  {"exponential-ptt", ElasticModel::ExponentialPtt}};
inline constexpr Named<KrylovKind> krylov[] = {{"cg", KrylovKind::Cg}, {"cr", KrylovKind::Cr}};
inline constexpr Named<PreconditionerKind> preconditioner[] = {
    {"projected-multigrid", PreconditionerKind::ProjectedMultigrid},
    {"bucket-multigrid", PreconditionerKind::BucketMultigrid},
    {"block-jacobi", PreconditionerKind::BlockJacobi},
    {"hat-multigrid", PreconditionerKind::HatMultigrid},
    {"cell-multigrid", PreconditionerKind::CellMultigrid},
    {"jacobi", PreconditionerKind::Jacobi},
    {"none", PreconditionerKind::None}};
inline constexpr Named<OperatorKind> operators[] = {{"matrix-free", OperatorKind::MatrixFree},
                                                    {"assembled", OperatorKind::Assembled}};
inline constexpr Named<Precision> precision[] = {{"mixed", Precision::Mixed}, {"double", Precision::Double}};
inline constexpr Named<SmootherDiagonal> diagonal[] = {{"jacobi", SmootherDiagonal::Jacobi},
                                                       {"extended-jacobi", SmootherDiagonal::ExtendedJacobi}};
inline constexpr Named<NeighbourKind> neighbours[] = {{"lists", NeighbourKind::Lists},
                                                      {"ranges", NeighbourKind::Ranges}};
inline constexpr Named<CoarseKind> coarse[] = {
    {"auto", CoarseKind::Auto}, {"direct", CoarseKind::Direct}, {"spgemm", CoarseKind::Spgemm}};
inline constexpr Named<FirstGuess> firstGuess[] = {
    {"quadratic", FirstGuess::Quadratic}, {"linear", FirstGuess::Linear}, {"last", FirstGuess::Last}};
inline constexpr Named<Coordinate> coordinate[] = {
    {"x", Coordinate::X}, {"y", Coordinate::Y}, {"z", Coordinate::Z}};
inline constexpr Named<OutputFormat> format[] = {{"vtp", OutputFormat::Vtp}};
inline constexpr Named<OutputPrecision> output[] = {{"single", OutputPrecision::Single},
                                                    {"double", OutputPrecision::Double}};
inline constexpr Named<OutputCompression> compression[] = {{"zlib", OutputCompression::Zlib},
                                                           {"none", OutputCompression::None}};
inline constexpr Named<OutputPieces> pieces[] = {
    {"auto", OutputPieces::Auto}, {"one", OutputPieces::One}, {"each", OutputPieces::Each}};
}  // namespace names

template <>
inline constexpr std::span<const Named<ShapeKind>> namesOf<ShapeKind>{names::shape};
template <>
inline constexpr std::span<const Named<FillKind>> namesOf<FillKind>{names::fill};
template <>
inline constexpr std::span<const Named<BodyKind>> namesOf<BodyKind>{names::body};
template <>
inline constexpr std::span<const Named<NozzleKind>> namesOf<NozzleKind>{names::nozzle};
template <>
inline constexpr std::span<const Named<OutflowKind>> namesOf<OutflowKind>{names::outflow};
template <>
inline constexpr std::span<const Named<ProbeKind>> namesOf<ProbeKind>{names::probe};
template <>
inline constexpr std::span<const Named<MethodKind>> namesOf<MethodKind>{names::method};
template <>
inline constexpr std::span<const Named<SchemeKind>> namesOf<SchemeKind>{names::scheme};
template <>
inline constexpr std::span<const Named<KernelKind>> namesOf<KernelKind>{names::kernel};
template <>
inline constexpr std::span<const Named<WallSlip>> namesOf<WallSlip>{names::slip};
template <>
inline constexpr std::span<const Named<ViscousStep>> namesOf<ViscousStep>{names::viscous};
template <>
inline constexpr std::span<const Named<RheologyModel>> namesOf<RheologyModel>{names::rheology};
template <>
inline constexpr std::span<const Named<ElasticModel>> namesOf<ElasticModel>{names::elastic};
template <>
inline constexpr std::span<const Named<StateLaw>> namesOf<StateLaw>{names::stateLaw};
template <>
inline constexpr std::span<const Named<ShiftModel>> namesOf<ShiftModel>{names::shift};
template <>
inline constexpr std::span<const Named<KrylovKind>> namesOf<KrylovKind>{names::krylov};
template <>
inline constexpr std::span<const Named<PreconditionerKind>> namesOf<PreconditionerKind>{names::preconditioner};
template <>
inline constexpr std::span<const Named<OperatorKind>> namesOf<OperatorKind>{names::operators};
template <>
inline constexpr std::span<const Named<Precision>> namesOf<Precision>{names::precision};
template <>
inline constexpr std::span<const Named<SmootherDiagonal>> namesOf<SmootherDiagonal>{names::diagonal};
template <>
inline constexpr std::span<const Named<NeighbourKind>> namesOf<NeighbourKind>{names::neighbours};
template <>
inline constexpr std::span<const Named<CoarseKind>> namesOf<CoarseKind>{names::coarse};
template <>
inline constexpr std::span<const Named<FirstGuess>> namesOf<FirstGuess>{names::firstGuess};
template <>
inline constexpr std::span<const Named<Coordinate>> namesOf<Coordinate>{names::coordinate};
template <>
inline constexpr std::span<const Named<OutputFormat>> namesOf<OutputFormat>{names::format};
template <>
inline constexpr std::span<const Named<OutputPrecision>> namesOf<OutputPrecision>{names::output};
template <>
inline constexpr std::span<const Named<OutputCompression>> namesOf<OutputCompression>{names::compression};
template <>
inline constexpr std::span<const Named<OutputPieces>> namesOf<OutputPieces>{names::pieces};

/// The word for a value, e.g. "bucket-multigrid".
template <class E>
constexpr std::string_view nameOf(E value) {
  for (const Named<E>& n : namesOf<E>)
    if (n.value == value) return n.name;
  return {};
}

/// The value that a word stands for.
template <class E>
constexpr std::optional<E> valueNamed(std::string_view word) {
  for (const Named<E>& n : namesOf<E>)
    if (n.name == word) return n.value;
  return std::nullopt;
}

/// "'a', 'b' or 'c'".
std::string listOf(const std::vector<std::string_view>& words);
/// "expected 'a', 'b' or 'c', found 'd'".
std::string wrongWord(const std::vector<std::string_view>& words, std::string_view found);

/// The words for the fields of frames, in the order of the files.
struct OutputFieldName {
  std::string_view name;
  bool OutputFields::*flag;
};
inline constexpr OutputFieldName outputFieldNames[] = {{"velocity", &OutputFields::velocity},
                                                       {"pressure", &OutputFields::pressure},
                                                       {"number_density", &OutputFields::numberDensity},
                                                       {"nearest_distance", &OutputFields::nearestDistance},
                                                       {"material", &OutputFields::material},
                                                       {"body", &OutputFields::body},
                                                       {"id", &OutputFields::id},
                                                       {"dynamic_viscosity", &OutputFields::dynamicViscosity},
                                                       {"shear_rate", &OutputFields::shearRate},
                                                       {"temperature", &OutputFields::temperature},
                                                       {"viscosity_factor", &OutputFields::viscosityFactor}};

}  // namespace treacle
