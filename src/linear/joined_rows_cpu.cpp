#include "treacle/linear/joined_rows.hpp"

#include "treacle/core/processes.hpp"

#include <algorithm>
#include <vector>

namespace treacle {

template <int D>
void joinRows(Context<Cpu>& context, const BlockCsr<D>& part, const JoinedRows& place, BlockCsr<D>& whole) {
  std::vector<std::uint32_t> entries(place.rows);
  for (std::uint32_t r = 0; r < place.own; ++r)
    entries[place.number[r]] = static_cast<std::uint32_t>(part.rowStart[r + 1] - part.rowStart[r]);
  sumOverProcesses(context, std::span(entries));
  whole.rowStart.resize(std::size_t{place.rows} + 1);
  whole.rowStart[0] = 0;
  for (std::uint32_t r = 0; r < place.rows; ++r) whole.rowStart[r + 1] = whole.rowStart[r] + entries[r];

  whole.column.resize(whole.rowStart[place.rows]);
  std::fill(whole.column.begin(), whole.column.end(), 0u);
  for (std::uint32_t r = 0; r < place.own; ++r) {
    std::uint32_t* const row = &whole.column[whole.rowStart[place.number[r]]];
    const std::uint64_t begin = part.rowStart[r], count = part.rowStart[r + 1] - begin;
    for (std::uint64_t k = 0; k < count; ++k) row[k] = place.number[part.column[begin + k]];
    std::sort(row, row + count);
  }
  sumOverProcesses(context, whole.column.span());

  whole.value.resize(whole.column.size());
  std::fill(whole.value.begin(), whole.value.end(), Block<D>{});
  for (std::uint32_t r = 0; r < part.rows(); ++r) {
    const std::uint32_t number = place.number[r];
    const auto begin = whole.column.begin() + whole.rowStart[number];
    const auto end = whole.column.begin() + whole.rowStart[number + 1];
    for (std::uint64_t k = part.rowStart[r]; k < part.rowStart[r + 1]; ++k) {
      const auto at = std::lower_bound(begin, end, place.number[part.column[k]]);
      whole.value[at - whole.column.begin()] = part.value[k];
    }
  }
  sumOverProcesses(context, std::span(reinterpret_cast<double*>(whole.value.data()), whole.value.size() * D * D));
}

template void joinRows<1>(Context<Cpu>&, const BlockCsr<1>&, const JoinedRows&, BlockCsr<1>&);
template void joinRows<2>(Context<Cpu>&, const BlockCsr<2>&, const JoinedRows&, BlockCsr<2>&);
template void joinRows<3>(Context<Cpu>&, const BlockCsr<3>&, const JoinedRows&, BlockCsr<3>&);

}  // namespace treacle
