#pragma once
// What a program image says of itself, at a fixed place behind its vectors: for which board it is, how long
// it is, and its CRC. The CRC covers the whole image but its own four bytes.

#include <array>
#include <cstdint>
#include <span>

#include "protocol/bytes.hpp"
#include "protocol/canopen/crc.hpp"
#include "protocol/canopen/object_addresses.hpp"

namespace kinebus {

/// As words in the image, little endian.
struct ImageHeader {
  static constexpr std::size_t kOffset = 0x200;
  static constexpr std::size_t kBytes = 32;
  static constexpr std::uint32_t kMagic = 0x5746'424B;  // "KBFW"
  static constexpr std::uint32_t kFormat = 1;
  /// STM32F405 dual-stepper board, pin map of board.hpp.
  static constexpr std::uint32_t kHardware = 0x0405'0001;

  std::uint32_t magic = kMagic;
  std::uint32_t format = kFormat;
  std::uint32_t product_code = kProductCode;
  std::uint32_t hardware = kHardware;
  std::uint32_t revision = kRevisionNumber;
  std::uint32_t length = 0;  ///< bytes from the first vector on, a multiple of 4
  std::uint32_t crc = 0;
  std::uint32_t reserved = 0xFFFF'FFFF;
};
static_assert(sizeof(ImageHeader) == ImageHeader::kBytes);
inline constexpr std::size_t kCrcOffset = ImageHeader::kOffset + 24;

/// That of the program that runs; sealed after linking.
extern const ImageHeader kImageHeader;

constexpr ImageHeader decode_image_header(std::span<const std::uint8_t> image) {
  const auto word = [&](std::size_t i) { return get_u32_le(image.subspan(ImageHeader::kOffset + 4 * i)); };
  return {word(0), word(1), word(2), word(3), word(4), word(5), word(6), word(7)};
}
constexpr void encode_image_header(const ImageHeader& h, std::span<std::uint8_t> image) {
  const std::array<std::uint32_t, 8> words{h.magic,    h.format, h.product_code, h.hardware,
                                           h.revision, h.length, h.crc,          h.reserved};
  for (std::size_t i = 0; i < words.size(); ++i)
    put_u32_le(image.subspan(ImageHeader::kOffset + 4 * i), words[i]);
}
constexpr std::uint32_t image_crc(std::span<const std::uint8_t> image) {
  Crc32 crc;
  crc.add(image.first(kCrcOffset));
  crc.add(image.subspan(kCrcOffset + 4));
  return crc.value();
}

enum class ImageCheck : std::uint8_t {
  kGood,
  kNone,         ///< no header: blank, or no image
  kOtherDevice,  ///< for another product, board, or a later format
  kLength,       ///< longer than the room, or shorter than its header
  kCrc,
};

/// The header alone: may this image be written at all? `image`: its first bytes; `room`: of the flash.
constexpr ImageCheck check_header(std::span<const std::uint8_t> image, std::size_t room) {
  if (image.size() < ImageHeader::kOffset + ImageHeader::kBytes) return ImageCheck::kNone;
  const ImageHeader h = decode_image_header(image);
  if (h.magic != ImageHeader::kMagic) return ImageCheck::kNone;
  if (h.format != ImageHeader::kFormat || h.product_code != kProductCode ||
      h.hardware != ImageHeader::kHardware)
    return ImageCheck::kOtherDevice;
  if (h.length < ImageHeader::kOffset + ImageHeader::kBytes || h.length > room || h.length % 4 != 0)
    return ImageCheck::kLength;
  return ImageCheck::kGood;
}
/// `flash`: the program's whole room.
constexpr ImageCheck check_image(std::span<const std::uint8_t> flash) {
  const ImageCheck header = check_header(flash, flash.size());
  if (header != ImageCheck::kGood) return header;
  const ImageHeader h = decode_image_header(flash);
  return image_crc(flash.first(h.length)) == h.crc ? ImageCheck::kGood : ImageCheck::kCrc;
}

}  // namespace kinebus
