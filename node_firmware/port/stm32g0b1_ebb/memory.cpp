// Products of 64 bits, which are most of what this core does in the main loop, in half of the time that the
// compiler's own take; and memcpy and memset by words: those of the small C library go byte by byte, and
// without unaligned access that is what this core's programs spend most of their time with.

#include <cstddef>
#include <cstdint>

namespace {

using Word = std::uint32_t __attribute__((may_alias));

bool aligned(const void* a, const void* b) {
  return ((reinterpret_cast<std::uintptr_t>(a) | reinterpret_cast<std::uintptr_t>(b)) & 3) == 0;
}

}  // namespace

extern "C" {
/// r1:r0 times r3:r2.
[[gnu::used, gnu::naked]] std::uint64_t __aeabi_lmul(std::uint64_t, std::uint64_t) {
  asm volatile(
      ".syntax unified\n"
      "muls r1, r2\n"
      "muls r3, r0\n"
      "adds r1, r1, r3\n"
      "push {r4, r5}\n"
      // The lower words by their halves.
      "lsrs r3, r0, #16\n"
      "lsrs r4, r2, #16\n"
      "uxth r0, r0\n"
      "uxth r2, r2\n"
      "movs r5, r0\n"
      "muls r5, r4\n"
      "muls r4, r3\n"
      "muls r0, r2\n"
      "muls r3, r2\n"
      "adds r1, r1, r4\n"
      "movs r2, #0\n"
      "adds r3, r3, r5\n"
      "adcs r2, r2\n"
      "lsls r2, r2, #16\n"
      "adds r1, r1, r2\n"
      "lsls r4, r3, #16\n"
      "lsrs r5, r3, #16\n"
      "adds r0, r0, r4\n"
      "adcs r1, r5\n"
      "pop {r4, r5}\n"
      "bx lr\n");
}
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
