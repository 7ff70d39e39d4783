// memcpy and memset by words: those of the small C library go byte by byte, and without unaligned access that
// is what this core's programs spend most of their time with.

#include <cstddef>
#include <cstdint>

namespace {

using Word = std::uint32_t __attribute__((may_alias));

bool aligned(const void* a, const void* b) {
  return ((reinterpret_cast<std::uintptr_t>(a) | reinterpret_cast<std::uintptr_t>(b)) & 3) == 0;
}

}  // namespace

extern "C" {
[[gnu::used]] void* memcpy(void* to, const void* from, std::size_t length) {
  auto* out = static_cast<std::uint8_t*>(to);
  const auto* in = static_cast<const std::uint8_t*>(from);
  if (aligned(to, from))
    for (; length >= 4; length -= 4, out += 4, in += 4)
      *reinterpret_cast<Word*>(out) = *reinterpret_cast<const Word*>(in);
  for (; length != 0; --length) *out++ = *in++;
  return to;
}
[[gnu::used]] void* memset(void* to, int value, std::size_t length) {
  auto* out = static_cast<std::uint8_t*>(to);
  const std::uint32_t byte = static_cast<std::uint8_t>(value);
  const std::uint32_t word = byte * 0x0101'0101;
  if (aligned(to, to))
    for (; length >= 4; length -= 4, out += 4) *reinterpret_cast<Word*>(out) = word;
  for (; length != 0; --length) *out++ = static_cast<std::uint8_t>(byte);
  return to;
}
}
