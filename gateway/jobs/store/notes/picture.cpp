// Base64 in comments, and what a picture says of itself.

#include <cstdint>
#include <utility>

#include "gateway/jobs/store/notes/slicer_notes.hpp"

namespace kinebus {
namespace {

using namespace std::literals;

int value_of(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : -1;
}

/// Of the lines of a comment. nullopt: something else stands in it.
std::optional<std::string> decode_base64(std::string_view text) {
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int held = 0;
  std::size_t ends = 0;  // '=' at the end
  std::size_t digits = 0;
  for (const char c : text) {
    if (c == ';' || c == ' ' || c == '\r' || c == '\n') continue;
    ++digits;
    if (c == '=') {
      ++ends;
      continue;
    }
    const int value = value_of(c);
    if (value < 0 || ends > 0) return std::nullopt;
    bits = (bits << 6U | static_cast<std::uint32_t>(value)) & 0xFFFFFFU;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> static_cast<unsigned>(held) & 0xFFU);
  }
  if (digits % 4 != 0 || ends > 2) return std::nullopt;
  return bytes;
}

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes) value = value << 8U | static_cast<unsigned char>(c);
  return value;
}

using Size = std::pair<std::uint32_t, std::uint32_t>;

/// Of a PNG's first chunk, which tells its size.
std::optional<Size> png_size(std::string_view bytes) {
  static constexpr std::string_view kStart = "\x89PNG\r\n\x1A\n\0\0\0\rIHDR"sv;
  if (bytes.size() < kStart.size() + 8 || !bytes.starts_with(kStart)) return std::nullopt;
  bytes.remove_prefix(kStart.size());
  return Size{big_endian(bytes.substr(0, 4)), big_endian(bytes.substr(4, 4))};
}

/// Of a JPEG's start of frame, which follows segments that each tell their length.
std::optional<Size> jpeg_size(std::string_view bytes) {
  if (!bytes.starts_with("\xFF\xD8\xFF")) return std::nullopt;
  bytes.remove_prefix(2);
  while (bytes.size() >= 9 && bytes.front() == '\xFF') {
    const auto marker = static_cast<unsigned char>(bytes[1]);
    // Tables of Huffman codes, arithmetic coding and an extension have their numbers among the frames'.
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame) return Size{big_endian(bytes.substr(7, 2)), big_endian(bytes.substr(5, 2))};
    const std::size_t length = big_endian(bytes.substr(2, 2));
    if (length < 2 || length + 2 > bytes.size()) return std::nullopt;
    bytes.remove_prefix(length + 2);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> decode_picture(std::string_view text, const joblink::SlicerPicture& picture) {
  auto bytes = decode_base64(text);
  if (!bytes) return std::nullopt;
  const auto size = picture.jpeg() ? jpeg_size(*bytes) : png_size(*bytes);
  if (!size || *size != Size{picture.width_px(), picture.height_px()}) return std::nullopt;
  return bytes;
}

}  // namespace kinebus
