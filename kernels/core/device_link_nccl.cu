#include "core/cuda_check.hpp"
#include "core/device_link.hpp"

#include <nccl.h>

#include <string>
#include <utility>

namespace treacle {
namespace {

void check(ncclResult_t status, ncclComm_t nccl) {
  if (status == ncclSuccess) return;
  throw DeviceFailure(std::string("NCCL: ") + ncclGetErrorString(status) + " (" + ncclGetLastError(nccl) + ")");
}

class NcclLink final : public DeviceLink {
 public:
  NcclLink(const Communicator& job, const Context<Cuda>& context) : job_(job), context_(context) {
    ncclUniqueId id{};
    if (job.rank() == 0) check(ncclGetUniqueId(&id), nullptr);
    job.broadcast(id);
    check(ncclCommInitRank(&nccl_, job.size(), id, job.rank()), nullptr);
  }
  ~NcclLink() override {
    if (nccl_) ncclCommAbort(nccl_);
  }
  void close() override {
    context_.synchronize();
    check(ncclCommDestroy(std::exchange(nccl_, nullptr)), nullptr);
  }

  void exchange(std::span<const Communicator::Message> sent,
                std::span<const Communicator::Message> received) override {
    if (sent.empty() && received.empty()) return;
    std::size_t bytes = 0;
    check(ncclGroupStart(), nccl_);
    for (const Communicator::Message& m : sent) {
      if (m.bytes > 0) check(ncclSend(m.data, m.bytes, ncclChar, m.rank, nccl_, context_.stream()), nccl_);
      bytes += m.bytes;
    }
    for (const Communicator::Message& m : received)
      if (m.bytes > 0) check(ncclRecv(m.data, m.bytes, ncclChar, m.rank, nccl_, context_.stream()), nccl_);
    check(ncclGroupEnd(), nccl_);
    job_.note(bytes);
  }

  void sum(double* values, std::size_t count) override {
    reduce(values, count, ncclDouble, ncclSum, sizeof(double));
  }
  void sum(float* values, std::size_t count) override { reduce(values, count, ncclFloat, ncclSum, sizeof(float)); }
  void sum(std::uint32_t* values, std::size_t count) override {
    reduce(values, count, ncclUint32, ncclSum, sizeof(std::uint32_t));
  }
  void max(std::uint8_t* flags, std::size_t count) override { reduce(flags, count, ncclUint8, ncclMax, 1); }

  std::string name() const override {
    int version = 0;
    check(ncclGetVersion(&version), nccl_);
    return "NCCL " + std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
           std::to_string(version % 100);
  }

 private:
  void reduce(void* values, std::size_t count, ncclDataType_t type, ncclRedOp_t op, std::size_t size) {
    check(ncclAllReduce(values, values, count, type, op, nccl_, context_.stream()), nccl_);
    job_.note(count * size);
  }

  const Communicator& job_;
  const Context<Cuda>& context_;
  ncclComm_t nccl_ = nullptr;
};

}  // namespace

std::unique_ptr<DeviceLink> makeNcclLink(const Communicator& job, const Context<Cuda>& context) {
  return std::make_unique<NcclLink>(job, context);
}

}  // namespace treacle
