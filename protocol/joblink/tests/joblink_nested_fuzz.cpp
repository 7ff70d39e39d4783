// Right headers anywhere, within each other too, with right and wrong messages: the reader's work stays
// proportional to the bytes that come, and a frame behind all of it is found.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "protocol/bytes.hpp"
#include "protocol/canopen/crc.hpp"
#include "protocol/joblink/frame_codec.hpp"

namespace {

using namespace kinebus::joblink;

/// A header of a message of `length` bytes, whose CRC is `crc`.
std::string header(std::uint32_t length, std::uint32_t crc) {
  std::string text;
  append_frame(text, 1, 1, {});
  std::vector<std::uint8_t> bytes(text.begin(), text.end());
  kinebus::put_u32_le(std::span(bytes).subspan(4), length);
  kinebus::put_u32_le(std::span(bytes).subspan(16), crc);
  kinebus::Crc32 own;
  own.add(std::span<const std::uint8_t>(bytes).first(20));
  kinebus::put_u32_le(std::span(bytes).subspan(20), own.value());
  return {bytes.begin(), bytes.end()};
}

void must(bool right) {
  if (!right) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string stream;
  // Three bytes: what stands next, and how long it says it is.
  for (std::size_t i = 0; i + 3 <= size && stream.size() < (3U << 20); i += 3) {
    const std::uint32_t length = (data[i + 1] | static_cast<std::uint32_t>(data[i + 2]) << 8) * 20;
    switch (data[i] % 4) {
      case 0:
        stream += header(length, 0x12345678);
        break;
      case 1:
        for (int k = 0; k < data[i]; ++k) stream += header(length + 24U * static_cast<unsigned>(k), 1);
        break;
      case 2:
        append_frame(stream, 1, 1, std::string(std::min<std::size_t>(length, 5000), 'K'));
        break;
      default:
        stream.append(data[i], 'K');
    }
  }
  append_frame(stream, 2, 7, "last");
  FrameReader reader;
  bool last = false;
  const auto take = [&] {
    while (const auto frame = reader.next()) last = frame->session == 2 && frame->sequence == 7;
  };
  const std::span<const std::uint8_t> all(reinterpret_cast<const std::uint8_t*>(stream.data()),
                                          stream.size());
  for (std::size_t i = 0; i < all.size(); i += 65'536) {
    reader.add(all.subspan(i, std::min<std::size_t>(65'536, all.size() - i)));
    take();
  }
  reader.give_up();
  take();
  must(last);
  must(reader.counters().checked_bytes <= FrameReader::kMaxDebt + 8 * stream.size());
  return 0;
}
