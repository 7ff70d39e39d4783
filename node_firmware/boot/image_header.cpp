#include "node_firmware/boot/image_header.hpp"

namespace kinebus {

ImageCheck check_header(std::span<const std::uint8_t> image, std::size_t room, const ImageTarget& board) {
  if (image.size() < ImageHeader::kOffset + ImageHeader::kBytes) return ImageCheck::kNone;
  const ImageHeader h = decode_image_header(image);
  if (h.magic != ImageHeader::kMagic) return ImageCheck::kNone;
  if (h.format != ImageHeader::kFormat || h.product_code != board.product_code ||
      h.hardware != board.hardware)
    return ImageCheck::kOtherDevice;
  if (h.length < ImageHeader::kOffset + ImageHeader::kBytes || h.length > room || h.length % 4 != 0)
    return ImageCheck::kLength;
  return ImageCheck::kGood;
}

ImageCheck check_image(std::span<const std::uint8_t> flash, const ImageTarget& board) {
  const ImageCheck header = check_header(flash, flash.size(), board);
  if (header != ImageCheck::kGood) return header;
  const ImageHeader h = decode_image_header(flash);
  return image_crc(flash.first(h.length)) == h.crc ? ImageCheck::kGood : ImageCheck::kCrc;
}

}  // namespace kinebus
