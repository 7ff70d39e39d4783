#pragma once
// What a program image says of itself, at a fixed place behind its vectors: for which board it is, how long
// it is, and its CRC. The CRC covers the whole image but its own four bytes.

#include <array>
#include <cstdint>
#include <span>

#include "protocol/bytes.hpp"
#include "protocol/canopen/board_facts.hpp"
#include "protocol/canopen/crc.hpp"

namespace kinebus {

/// For what an image is.
struct ImageTarget {
  std::uint32_t product_code = 0, hardware = 0, revision = 0;
};
constexpr ImageTarget image_target(const BoardFacts& board) {
  return {board.product_code, board.hardware, board.revision};
}

/// As words in the image, little endian.
struct ImageHeader {
  static constexpr std::size_t kOffset = 0x200;
  static constexpr std::size_t kBytes = 32;
  static constexpr std::uint32_t kMagic = 0x5746'424B;  // "KBFW"
  static constexpr std::uint32_t kFormat = 1;

  std::uint32_t magic = kMagic;
  std::uint32_t format = kFormat;
  std::uint32_t product_code = 0;  ///< these three as ImageTarget has them
  std::uint32_t hardware = 0;
  std::uint32_t revision = 0;
  std::uint32_t length = 0;  ///< bytes from the first vector on, a multiple of 4
  std::uint32_t crc = 0;
  /// 1018h:2 of the node that the program is, where that is not the board's own: kAsBoard: it is.
  std::uint32_t node_product = kAsBoard;
  static constexpr std::uint32_t kAsBoard = 0xFFFF'FFFF;
  constexpr std::uint32_t node_product_code() const {
    return node_product == kAsBoard ? product_code : node_product;
  }
};
static_assert(sizeof(ImageHeader) == ImageHeader::kBytes);
inline constexpr std::size_t kCrcOffset = ImageHeader::kOffset + 24;

/// Of a program that is not sealed yet.
constexpr ImageHeader image_header_for(const ImageTarget& target,
                                       std::uint32_t node_product = ImageHeader::kAsBoard) {
  return {.product_code = target.product_code,
          .hardware = target.hardware,
          .revision = target.revision,
          .node_product = node_product};
}

/// That of the program that runs; sealed after linking.
extern const ImageHeader kImageHeader;

constexpr ImageHeader decode_image_header(std::span<const std::uint8_t> image) {
  const auto word = [&](std::size_t i) { return get_u32_le(image.subspan(ImageHeader::kOffset + 4 * i)); };
  return {word(0), word(1), word(2), word(3), word(4), word(5), word(6), word(7)};
}
constexpr void encode_image_header(const ImageHeader& h, std::span<std::uint8_t> image) {
  const std::array<std::uint32_t, 8> words{h.magic,    h.format, h.product_code, h.hardware,
                                           h.revision, h.length, h.crc,          h.node_product};
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
ImageCheck check_header(std::span<const std::uint8_t> image, std::size_t room, const ImageTarget& board);
/// `flash`: the program's whole room.
ImageCheck check_image(std::span<const std::uint8_t> flash, const ImageTarget& board);

}  // namespace kinebus
