#include "core/device_link.hpp"

#include "core/cuda_check.hpp"
#include "treacle/core/error.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace treacle {
namespace {

/// By MPI, on copies in the host's memory; where MPI takes addresses of the device, only sums need them.
class HostLink final : public DeviceLink {
 public:
  HostLink(const Communicator& job, const Context<Cuda>& context) : job_(job), context_(context) {}

  void exchange(std::span<const Communicator::Message> sent,
                std::span<const Communicator::Message> received) override {
    if (job_.takesDeviceMemory()) {
      context_.synchronize();
      return job_.exchange(sent, received);
    }
    std::vector<Communicator::Message> from(sent.begin(), sent.end()), to(received.begin(), received.end());
    std::byte* next = makeRoom(sent, received);
    for (auto* messages : {&from, &to})
      for (Communicator::Message& m : *messages) m.data = std::exchange(next, next + padded(m.bytes));
    for (std::size_t k = 0; k < sent.size(); ++k)
      copyBytesToHost(context_, sent[k].data, from[k].data, sent[k].bytes);
    context_.synchronize();  // also where nothing is sent: what is received must not come too early
    job_.exchange(from, to);
    for (std::size_t k = 0; k < received.size(); ++k)
      copyBytesToDevice(context_, to[k].data, received[k].data, received[k].bytes);
  }

  void sum(double* values, std::size_t count) override { sumOf(values, count); }
  void sum(float* values, std::size_t count) override { sumOf(values, count); }
  void sum(std::uint32_t* values, std::size_t count) override { sumOf(values, count); }
  void max(std::uint8_t* flags, std::size_t count) override {
    onHost(flags, count, [&](std::span<std::uint8_t> host) { job_.anyOf(host); });
  }

  std::string name() const override { return "MPI"; }

 private:
  template <class T>
  void sumOf(T* values, std::size_t count) {
    onHost(values, count, [&](std::span<T> host) { job_.sum(host); });
  }
  template <class T, class F>
  void onHost(T* values, std::size_t count, F&& f) {
    std::vector<T> host(count);
    copyBytesToHost(context_, values, host.data(), count * sizeof(T));
    f(std::span(host));
    copyBytesToDevice(context_, host.data(), values, count * sizeof(T));
  }

  /// One piece of memory for all messages, registered with the device once it has the size that is needed.
  std::byte* makeRoom(std::span<const Communicator::Message> sent,
                      std::span<const Communicator::Message> received) {
    std::size_t bytes = 0;
    for (const auto& messages : {sent, received})
      for (const Communicator::Message& m : messages) bytes += padded(m.bytes);
    if (bytes > memory_.size()) {
      pinned_ = {};
      memory_.resize(2 * bytes);
      pinned_ = PinnedMemory(memory_.data(), memory_.size());
    }
    return memory_.data();
  }

  const Communicator& job_;
  const Context<Cuda>& context_;
  Buffer<std::byte> memory_;
  PinnedMemory pinned_;
};

/// Whether no two processes use the same device.
bool haveOneEach(const Communicator& job) {
  int device = 0;
  TREACLE_CUDA_CHECK(cudaGetDevice(&device));
  cudaDeviceProp properties;
  TREACLE_CUDA_CHECK(cudaGetDeviceProperties(&properties, device));
  std::array<char, sizeof(properties.uuid.bytes)> id;
  std::copy_n(properties.uuid.bytes, id.size(), id.begin());
  const auto all = job.all(id);
  return std::set(all.begin(), all.end()).size() == all.size();
}

}  // namespace

std::unique_ptr<DeviceLink> DeviceLink::make(const Communicator& job, const Context<Cuda>& context) {
  const char* const asked = std::getenv("TREACLE_LINK");
  std::string wanted = asked ? asked : "";
  wanted = job.first(wanted).text;  // the same for all
  if (!wanted.empty() && wanted != "peer" && wanted != "nccl" && wanted != "mpi")
    throw InputError("TREACLE_LINK = '" + wanted + "': expected 'peer', 'nccl' or 'mpi'");
  if (haveOneEach(job) && wanted != "mpi") {
    if (wanted != "nccl")
      if (auto link = makePeerLink(job, context)) return link;
    if (auto link = makeNcclLink(job, context)) return link;
  }
  return std::make_unique<HostLink>(job, context);
}

#ifndef TREACLE_HAS_NCCL
std::unique_ptr<DeviceLink> makeNcclLink(const Communicator&, const Context<Cuda>&) { return nullptr; }
#endif

}  // namespace treacle
