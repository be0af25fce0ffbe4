#include "sum_chunks.hpp"
#include "treacle/linear/each_number.hpp"
#include "treacle/linear/each_row.hpp"

namespace treacle {

template <int D, class T, class Backend>
void applyBlockDiagonal(Context<Backend>&, std::span<const Block<D, T>> inverse, std::span<const Vec<D>> r,
                        std::span<Vec<D>> z) {
  parallelFor(r.size(), reductionChunk,
              [&](std::size_t i) { z[i] = converted<double>(inverse[i] * converted<T>(r[i])); });
}

template <class T, class Backend>
void lanczosFinish(Context<Backend>&, const LanczosScalars* scalars, double margin, T* largest) {
  if (scalars->count == 0) {
    *largest = 1;
    return;
  }
  double lower, upper;
  scalars->bounds(lower, upper);
  for (int halving = 0; halving < 45; ++halving) {
    const double middle = (lower + upper) / 2;
    (scalars->reaches(middle) ? lower : upper) = middle;
  }
  *largest = static_cast<T>(margin * upper);
}

TREACLE_EACH_NUMBER(Cpu)
TREACLE_EACH_ROW(Cpu)

}  // namespace treacle
