// Checkpoints. The checksum is made anew, or none would be read.

#include "treacle/io/checkpoint/checkpoint.hpp"
#include "files/checksum.hpp"
#include "input_file.hpp"

using namespace treacle;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::InputFile file(fuzz::textOf(data, size));
  const ChecksumRecord record = ChecksumRecord::of(data, size);
  file.append(&record, sizeof record);
  fuzz::accept([&] { readCheckpoint<2>(file.path()); });
  fuzz::accept([&] { readCheckpoint<3>(file.path()); });
  return 0;
}
