#include "treacle/linear/joined_rows.hpp"

#include "core/launch.hpp"
#include "core/scan.hpp"
#include "treacle/core/copy_values.hpp"
#include "treacle/core/device_link.hpp"

namespace treacle {

/// Three loops, one thread per row; columns stand in the order of the part that the row is own in; atomics no.
template <int D>
void joinRows(Context<Cuda>& context, const BlockCsr<D, double, Cuda>& part, const JoinedRows& place,
              BlockCsr<D, double, Cuda>& whole) {
  const BlockCsrView<D> from = viewOf(part);
  const std::uint32_t* const number = place.number.data();
  Buffer<std::uint32_t, Cuda> entries(context, place.rows);
  clearValues(context, entries.span());
  forEach(context, place.own, [from, number, entries = entries.data()] __device__(std::size_t r) {
    entries[number[r]] = static_cast<std::uint32_t>(from.rowStart[r + 1] - from.rowStart[r]);
  });
  sumOverDevices(context, entries.span());
  whole.rowStart.resize(context, std::size_t{place.rows} + 1);
  forEach(context, place.rows,
          [entries = entries.data(), start = whole.rowStart.data()] __device__(std::size_t r) {
            start[r] = entries[r];
          });
  const std::uint64_t count = startRows(context, whole.rowStart);

  whole.column.resize(context, count);
  clearValues(context, whole.column.span());
  forEach(context, place.own,
          [from, number, start = whole.rowStart.data(), column = whole.column.data()] __device__(std::size_t r) {
            std::uint32_t* to = column + start[number[r]];
            for (std::uint64_t k = from.rowStart[r]; k < from.rowStart[r + 1]; ++k) *to++ = number[from.column[k]];
          });
  sumOverDevices(context, whole.column.span());

  whole.value.resize(context, count);
  clearValues(context, whole.value.span());
  forEach(context, from.rows,
          [from, number, start = whole.rowStart.data(), column = whole.column.data(),
           value = whole.value.data()] __device__(std::size_t r) {
            for (std::uint64_t k = from.rowStart[r]; k < from.rowStart[r + 1]; ++k) {
              std::uint64_t at = start[number[r]];
              while (column[at] != number[from.column[k]]) ++at;
              value[at] = from.value[k];
            }
          });
  sumOverDevices(context, whole.value.span());
}

template void joinRows<1>(Context<Cuda>&, const BlockCsr<1, double, Cuda>&, const JoinedRows&,
                          BlockCsr<1, double, Cuda>&);
template void joinRows<2>(Context<Cuda>&, const BlockCsr<2, double, Cuda>&, const JoinedRows&,
                          BlockCsr<2, double, Cuda>&);
template void joinRows<3>(Context<Cuda>&, const BlockCsr<3, double, Cuda>&, const JoinedRows&,
                          BlockCsr<3, double, Cuda>&);

}  // namespace treacle
