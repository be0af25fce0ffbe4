#include "mode_keeper.hpp"

#include "treacle/model/case/case.hpp"

#include <algorithm>
#include <new>

namespace treacle {
namespace {

static_assert(maxModes == ModeMatrix::maxModes);

template <int D, class Backend>
std::span<float> flat(SolverModes<D, Backend>& modes) {
  return {reinterpret_cast<float*>(modes.vectors.data()), modes.vectors.size() * D};
}

}  // namespace

/// A solve that modes are taken of is not deflated: those that it would be deflated by could not be seen in it.
/// Where there are none yet, and in three dimensions there never may be, it is first looked whether they pay.
template <int D, class Backend>
Deflation<Backend>& ModeKeeper<D, Backend>::prepare(Context<Backend>& context, SolverModes<D, Backend>& modes,
                                                    std::size_t particles, int most) {
  particles_ = particles;
  const std::size_t unknowns = D * particles;
  const std::span<const float> all = flat(modes);
  solve_ = !modes.age.isDue()                           ? Kind::Deflated
           : all.empty() && !modes.age.areWorthTaking() ? Kind::Looked
                                                        : Kind::Recorded;
  try {
    if (solve_ == Kind::Recorded) deflation_.record(context, unknowns);
  } catch (const std::bad_alloc&) {  // then without modes
    modes.drop();
    modes.age.taken();
    solve_ = Kind::Deflated;
  }
  if (solve_ == Kind::Looked) deflation_.recordNumbers(context);
  if (solve_ == Kind::Deflated)
    deflation_.deflateBy(flat(modes).first(std::min(flat(modes).size(), most * unknowns)), unknowns);
  return deflation_;
}

template <int D, class Backend>
void ModeKeeper<D, Backend>::finish(Context<Backend>& context, SolverModes<D, Backend>& modes,
                                    const SolveReport& report, int most) {
  if (report.status != SolveStatus::Converged) return modes.drop();
  if (solve_ == Kind::Deflated) return modes.age.solved(report.iterations);
  const RitzVectors ritz = deflation_.ritzVectors(context, report.iterations, most);
  if (solve_ == Kind::Looked && ritz.modes > 0) return modes.age.foundWorthTaking();
  modes.age.taken();
  if (ritz.modes > 0) try {
      modes.vectors.resize(context, ritz.modes * particles_);
      return deflation_.takeModes(context, ritz, flat(modes));
    } catch (const std::bad_alloc&) {  // then without modes, too
    }
  modes.vectors = {};
  deflation_.release();
}

#define TREACLE_INSTANTIATE(Backend)     \
  template class ModeKeeper<1, Backend>; \
  template class ModeKeeper<2, Backend>; \
  template class ModeKeeper<3, Backend>;
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
