#pragma once

#include "treacle/core/communicator.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/processes.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

namespace treacle {

/// What the processes of a job tell each other from device to device. All members are collective, and in the order
/// of the context's stream: what was launched before is done before, and the host need not wait. Addresses are
/// those of device memory. Errors: DeviceFailure.
class DeviceLink {
 public:
  /// The quickest there is. Where every process has a device of its own: the memory of the others, if all are on
  /// one host and their devices reach each other; else NCCL, if the build has it. Otherwise MPI by way of the
  /// host's memory, for which the host waits. The environment variable TREACLE_LINK, "peer", "nccl" or "mpi",
  /// leaves out what is quicker than that. Collective. The communicator and the context must outlive it. Errors:
  /// InputError for another value of it, DeviceFailure.
  static std::unique_ptr<DeviceLink> make(const Communicator& job, const Context<Cuda>& context);
  virtual ~DeviceLink() = default;
  /// The last thing that all processes do with it. Without it, where one of them has met an error that the others
  /// have not, nobody waits for them.
  virtual void close() {}

  /// Sends and receives at once; between two processes messages keep their order.
  virtual void exchange(std::span<const Communicator::Message> sent,
                        std::span<const Communicator::Message> received) = 0;

  /// So many values of a field are for another process: those with these indices.
  struct Gathered {
    int rank;
    const std::uint32_t* index;
    std::size_t count;
  };
  /// As exchange(), where values of `size` bytes are sent from where they stand. Returns false, and has done
  /// nothing, where the link does not do that.
  virtual bool exchangeGathered(const void* /*field*/, std::size_t /*size*/, std::span<const Gathered> /*sent*/,
                                std::span<const Communicator::Message> /*received*/) {
    return false;
  }

  /// values[k] = sum of what all processes have there, the same bits everywhere; equally many everywhere.
  virtual void sum(double* values, std::size_t count) = 0;
  virtual void sum(float* values, std::size_t count) = 0;
  virtual void sum(std::uint32_t* values, std::size_t count) = 0;
  /// flags[k]: the largest.
  virtual void max(std::uint8_t* flags, std::size_t count) = 0;

  /// Whether graphs may have what it does, in the bodies of loops, too.
  virtual bool canBeRecorded() const { return false; }
  /// What it has sent and what it has taken of the device's time so far; zero for what the communicator counts.
  struct Spent {
    std::uint64_t bytes = 0, calls = 0;
    double seconds = 0;  // in exchanges and sums [s]
    double waiting = 0;  // of that, for others [s]
  };
  virtual Spent spent() const { return {}; }
  /// "peer memory", "NCCL 2.28.9" or "MPI"
  virtual std::string name() const = 0;
};

/// values[k] = sum over the processes that share the simulation, number by number; nothing where it is alone. `V`:
/// a number, or a matrix of doubles.
template <class V>
void sumOverDevices(const Context<Cuda>& context, std::span<V> values) {
  using T = std::conditional_t<std::is_arithmetic_v<V>, V, double>;
  static_assert(std::is_trivially_copyable_v<V> && sizeof(V) % sizeof(T) == 0);
  if (context.link && !values.empty())
    context.link->sum(reinterpret_cast<T*>(values.data()), values.size_bytes() / sizeof(T));
}

/// The same of values in the backend's memory, for code that is written for both backends.
template <class T, class Backend>
void sumOverSharing(const Context<Backend>& context, std::span<T> values) {
  if constexpr (std::is_same_v<Backend, Cpu>)
    sumOverProcesses(context, values);
  else
    sumOverDevices(context, values);
}
/// flags[k]: the largest of all processes.
template <class Backend>
void anyOverSharing(const Context<Backend>& context, std::span<std::uint8_t> flags) {
  if (!context.communicator) return;
  if constexpr (std::is_same_v<Backend, Cpu>)
    context.communicator->anyOf(flags);
  else
    context.link->max(flags.data(), flags.size());
}

}  // namespace treacle
