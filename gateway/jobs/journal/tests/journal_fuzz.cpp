// Any bytes as a journal: what is read is whole records only, and written again it reads the same.

#include <cstdint>
#include <cstdlib>
#include <vector>

#include "gateway/jobs/journal/journal_codec.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinebus;
  const auto decoded = journal::decode({data, size});
  if (decoded.bytes > size) std::abort();
  std::vector<std::uint8_t> again;
  std::uint32_t number = 0;
  for (const journal::Record& record : decoded.state.records()) journal::encode(record, number++, again);
  const auto read = journal::decode(again);
  if (read.records != number || !(read.state == decoded.state)) std::abort();
  return 0;
}
